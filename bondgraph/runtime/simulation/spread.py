"""Machines differ: parameters drawn inside their tolerances."""

from __future__ import annotations

import numpy as np

from bondgraph.ir.graph import BondGraph
from bondgraph.runtime.simulation.parameters import Values
from bondgraph.runtime.simulation.scenario import Scenario


def spread(graph: BondGraph, scenario: Scenario) -> dict[str, float]:
    """The numbers of one machine out of many; nothing where the scenario wants the nominal one.

    Every parameter with a tolerance is drawn evenly between its limits, from the seed of the
    scenario; one that the scenario gives is left alone.
    """
    if scenario.spread == "none":
        return {}
    values = Values(graph, scenario.parameters)
    drawn = {}
    for k, value in enumerate(graph.values):
        if value.tolerance is None or value.name in scenario.parameters:
            continue
        draw = np.random.default_rng([scenario.seed, 4, k])
        share = float(value.tolerance) * draw.uniform(-1.0, 1.0)
        drawn[value.name] = values.number(value.symbol) * (1.0 + float(share))
    return drawn
