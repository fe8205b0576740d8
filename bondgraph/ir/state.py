"""State equations: how the rates of the states follow from states, inputs and parameters."""

from __future__ import annotations

from bondgraph.ir.expr import Expr
from bondgraph.ir.graph import BondGraph
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple


class Block(NamedTuple):
    """Variables that are found together, once all blocks before are.

    A single one with a closed form has its `value`; else all `zeros` vanish, where `slopes[i][j]`
    is the derivative of zero i by unknown j. A `linear` block has no unknown in its slopes.
    `names` and `origins` are the elements that the loop runs through.
    """

    unknowns: tuple[Expr, ...]
    value: Expr | None
    zeros: tuple[Expr, ...] = ()
    slopes: tuple[tuple[Expr, ...], ...] = ()
    linear: bool = False
    names: tuple[str, ...] = ()
    origins: tuple[Span, ...] = ()


class State(NamedTuple):
    """One state: `symbol` with symbol' = `rate`, both variables, and where it starts.

    `initial` is the symbol of the declared initial value, None where the model declares none.
    `capacity` is how much of it goes with a unit of the effort or flow of its storage (the C of a
    linear capacitance, the I of an inertia); None for what is no storage.
    """

    name: str
    symbol: Expr
    rate: Expr
    initial: Expr | None
    capacity: Expr | None


class Disturbance(NamedTuple):
    """How something may be other than told: acting value = `gain` * told value + `bias`."""

    name: str
    gain: Expr
    bias: Expr


class StateEquations(NamedTuple):
    """A bond graph ready for integration, in one mode of its switches.

    `blocks` in order of computation give every variable that is determined, sensors included.
    `dependent` are storages whose state follows from others (derivative causality), `static` those
    taken as being at rest. `disturbances` are the signals by which something may be wrong, `modes`
    the setting of the switches.
    """

    graph: BondGraph
    states: tuple[State, ...]
    blocks: tuple[Block, ...]
    dependent: tuple[str, ...]
    static: tuple[str, ...]
    disturbances: tuple[Disturbance, ...]
    modes: tuple[tuple[str, bool], ...]
