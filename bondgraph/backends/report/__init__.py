"""What is known of a model as one HTML page that needs nothing else."""
