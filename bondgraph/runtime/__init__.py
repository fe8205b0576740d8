"""What runs after compiling: residual programs in Python, with any type of number."""
