"""What stands behind the page of `bondgraph edit`: its file, and what is found while one types."""
