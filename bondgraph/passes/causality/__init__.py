"""The parts of causal assignment: rules, propagation, exact repair, and what to say about it."""
