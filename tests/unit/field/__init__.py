"""Unit tests of the kinds of numbers."""
