"""The unknowns eliminated: equations, chaining, tearing, linear blocks, operator elimination."""
