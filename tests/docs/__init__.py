"""Tests of the documentation: its links lead somewhere, its examples work."""
