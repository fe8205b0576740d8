"""The form of a relation: cleared of its divisors, and the causal path that led to it."""
