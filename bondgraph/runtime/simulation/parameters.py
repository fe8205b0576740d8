"""The numbers of a machine: parameters, constants, initial values; some replaced or drawn."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from bondgraph.algebra.nominal import Nominal
from bondgraph.ir.expr import Expr, Op, topological
from bondgraph.ir.graph import BondGraph
from bondgraph.runtime.simulation.scenario import Scenario


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


def drawn(graph: BondGraph, scenario: Scenario) -> Values:
    """The numbers of the machine of a scenario.

    With a `spread` it is one out of many: every parameter with a tolerance is drawn evenly between
    its limits, from the seed of the scenario; one that the scenario gives is left alone.
    """
    values = Values(graph, scenario.parameters)
    if scenario.spread == "none":
        return values
    replaced = dict(scenario.parameters)
    for k, value in enumerate(graph.values):
        if value.tolerance is None or value.name in scenario.parameters:
            continue
        draw = np.random.default_rng([scenario.seed, 4, k])
        share = float(value.tolerance) * draw.uniform(-1.0, 1.0)
        replaced[value.name] = values.number(value.symbol) * (1.0 + float(share))
    return Values(graph, replaced)


def units(graph: BondGraph) -> dict[str, str]:
    """The unit of every value, input and sensor as the model writes it, "" for none."""
    found = {v.name: v.unit or "" for v in graph.values}
    found |= {i.name: i.unit or "" for i in graph.inputs}
    return found | {s.name: s.unit or "" for s in graph.sensors}
