"""What watches a running machine: samples in, verdicts out."""
