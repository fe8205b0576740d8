"""Unit tests of the calculus on expressions."""
