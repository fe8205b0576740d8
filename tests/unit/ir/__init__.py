"""Unit tests of the nouns."""
