"""What the report of a model says, collected from its compilation."""
