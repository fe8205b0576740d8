"""Kinds of numbers: a prime field, balls around real numbers; series, sparse elimination."""
