"""The numbers of a machine: parameters, constants and initial values, some of them replaced."""

from __future__ import annotations

from collections.abc import Mapping

from bondgraph.algebra.nominal import Nominal
from bondgraph.ir.expr import Expr, Op, topological
from bondgraph.ir.graph import BondGraph


class Values:
    """Parameter values of a machine, in SI units; `replaced` by name takes precedence."""

    def __init__(self, graph: BondGraph, replaced: Mapping[str, float] | None = None) -> None:
        self.graph = graph
        names = {v.name for v in graph.values}
        self.replaced = {n: float(v) for n, v in (replaced or {}).items() if n in names}
        self._nominal = Nominal(graph, self.replaced)

    def number(self, expr: Expr) -> float:
        """The value of an expression of parameters; raises KeyError with the name of a parameter
        that has none."""
        found = self.constant(expr)
        if found is None:
            missing = [
                n.symbol.name
                for n in topological([expr])
                if n.op is Op.SYM and self.constant(n) is None
            ]
            raise KeyError(missing[0] if missing else repr(expr))
        return found

    def constant(self, expr: Expr) -> float | None:
        """The value, None where a signal or a parameter without a number is in it."""
        return self._nominal.value(expr)
