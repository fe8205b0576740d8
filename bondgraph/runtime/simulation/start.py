"""What every storage of a machine holds before it starts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from bondgraph.ir.graph import BondGraph
from bondgraph.runtime.simulation.integrate import SimulationError
from bondgraph.runtime.simulation.machine import Machine
from bondgraph.runtime.simulation.scenario import Scenario
from bondgraph.runtime.simulation.steady import NoSteadyState, steady


def start(
    machine: Machine,
    graph: BondGraph,
    scenario: Scenario,
    first: Sequence[float],
    before: Sequence[float],
) -> dict[str, float]:
    """The content of each storage by the name of its q or p.

    One that nothing is said of is empty; a dependent one is as the states say that it is, while
    what acts on the machine is as `before` the start. In the steady state it is that for what acts
    `first`. Raises `SimulationError` where there is none.
    """
    stated = {**machine.start(), **scenario.initial}
    x = [stated.get(name, 0.0) for name in machine.states]
    names = [i.name for i in machine.equations.dependent]
    if scenario.start == "steady" and machine.states:
        try:
            found = steady(machine, first, np.array(x))
        except NoSteadyState as error:
            raise SimulationError(f"{error}") from error
        held = [*found.tolist(), *machine.content(0.0, found.tolist(), first).tolist()]
        return dict(zip((*machine.states, *names), held, strict=True))
    rest = machine.content(0.0, x, before).tolist()
    ports = [p for node in graph.nodes for p in node.ports if p.state is not None]
    every = {p.state.symbol.name: 0.0 for p in ports if p.state is not None}
    following = {n: v for n, v in zip(names, rest, strict=True) if v == v}
    return {**every, **dict(zip(machine.states, x, strict=True)), **following, **stated}
