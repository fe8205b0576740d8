"""Tests over models/: each model against equations that were written by hand."""
