"""Unit tests of the exact oracle."""
