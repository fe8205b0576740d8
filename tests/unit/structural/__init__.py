"""Unit tests of the graphs of equations."""
