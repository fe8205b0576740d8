"""Calculus on expressions: solving, derivatives, fractions, monotony, normal form, operators."""
