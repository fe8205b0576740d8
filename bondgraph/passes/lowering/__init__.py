"""Helpers of the pass `lower`: from normal forms to the statements of a residual program."""
