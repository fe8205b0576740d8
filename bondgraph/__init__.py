"""Compile bond graphs into analytical redundancy relations and the code that evaluates them."""
