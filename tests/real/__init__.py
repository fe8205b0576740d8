"""Random real plants, simulated in multiple precision, against the verdicts of the compiler."""
