"""The element kinds as data: ports, laws, causal preferences, units."""
