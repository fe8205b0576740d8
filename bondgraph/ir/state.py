"""State equations: how the rates of the states follow from states, inputs and parameters."""

from __future__ import annotations

from bondgraph.ir.expr import Expr
from bondgraph.ir.graph import BondGraph
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple


class Block(NamedTuple):
    """Variables that are found together, once all blocks before are.

    A single one with a closed form has its `value`; else all `zeros` vanish, where `slopes[i][j]`
    is the derivative of zero i by unknown j. Of a linear block `rests` are the zeros without the
    terms in the unknowns, of another one nothing. `names` and `origins` are the elements whose laws
    these are.
    """

    unknowns: tuple[Expr, ...]
    value: Expr | None
    names: tuple[str, ...]
    origins: tuple[Span, ...]
    zeros: tuple[Expr, ...] = ()
    slopes: tuple[tuple[Expr, ...], ...] = ()
    rests: tuple[Expr, ...] = ()


class State(NamedTuple):
    """One state: `symbol` with symbol' = `rate`, both variables, and where it starts.

    `initial` is the symbol of the declared initial value, None where the model declares none.
    `capacities` are how much of it goes with a unit of an effort or flow, by the laws that it is in
    (the C of a linear capacitance, the I of an inertia), up to the sign; none for what is no
    storage.
    """

    name: str
    symbol: Expr
    rate: Expr
    initial: Expr | None
    capacities: tuple[Expr, ...]


class Disturbance(NamedTuple):
    """How something may be other than told: acting value = `gain` * told value + `bias`."""

    name: str
    gain: Expr
    bias: Expr


class Impulse(NamedTuple):
    """A storage whose state follows from others (derivative causality), and how to hit it.

    `signal` is added to the rate of its `state`, called `name`: what it gets from outside is shared
    out among all the storages that it moves with. `storage` is the path of the element.
    """

    storage: str
    name: str
    state: Expr
    signal: Expr
    initial: Expr | None


class StateEquations(NamedTuple):
    """A bond graph ready for integration, in one mode of its switches.

    `blocks` in order of computation give every variable that is determined, sensors included.
    `dependent` are the storages that are no states, `static` those taken as being at rest.
    `disturbances` are the signals by which something may be wrong, `modes`
    the setting of the switches.
    """

    graph: BondGraph
    states: tuple[State, ...]
    blocks: tuple[Block, ...]
    dependent: tuple[Impulse, ...]
    static: tuple[str, ...]
    disturbances: tuple[Disturbance, ...]
    modes: tuple[tuple[str, bool], ...]
