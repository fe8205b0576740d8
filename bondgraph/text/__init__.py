"""Source text, places in it, and diagnostics about it; imports nothing of the project."""
