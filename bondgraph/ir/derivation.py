"""How a residual came about, as a person follows it: one step of algebra after the other."""

from __future__ import annotations

from typing import Literal

from bondgraph.ir.equation_system import Equation
from bondgraph.ir.expr import Expr, Pool, Symbol
from bondgraph.text.tuples import NamedTuple

#: solve: an equation for an unknown; invert: one that is not linear in it; differentiate: one
#: whose unknown is the rate of a state; integrate: a state from its rate; iterate: an equation
#: without a closed solution; tear: take an unknown for known; row: an equation that holds torn
#: unknowns only; rise: differentiate such a row; untear: solve it for its torn unknown; put: that
#: into another row; lower: a derivative of a torn unknown out of a row, by another row; close: what
#: is known into the equation that was left over; free: differentiate a relation so that an
#: undeclared start drops out of it; since: what has not changed since its declared start, of which
#: the relation is the derivative; cancel: what drops out; scale: what stands before it goes;
#: shift: to the time of the log.
Move = Literal[
    "solve", "invert", "differentiate", "integrate", "iterate", "tear", "row", "rise", "untear",
    "put", "lower", "close", "free", "since", "cancel", "scale", "shift",
]  # fmt: skip


class DerivationStep(NamedTuple):
    """One step: `zero` = 0 becomes `unknown` = `value`, or a relation `value` = 0.

    `number` counts from 1, `equation` is the one of the bond graph that is used here for the first
    time. `value` is in earlier unknowns, `closed` in known signals, of the steps that it `uses`.
    `gone` are names that the relation no longer holds. `divisors` hold signals: the step is right
    while they are not zero. `times` says how often something is differentiated, `row` is the step
    of the other row that `lower` takes a derivative from. `factor` is what `scale` and `free`
    divide by.
    """

    number: int
    move: Move
    equation: Equation | None
    zero: Expr
    unknown: Expr | None
    value: Expr
    closed: Expr
    uses: tuple[int, ...] = ()
    gone: tuple[str, ...] = ()
    divisors: tuple[Expr, ...] = ()
    times: int = 0
    row: int = 0
    factor: Expr | None = None


class Derivation(NamedTuple):
    """All steps from the equations of the bond graph to a residual.

    Expressions of the steps are of `pool`. `arr` is the residual of the compiler, in the plant's
    own time, `factor` what it has to be multiplied with to be the last relation, or 0 where that
    could not be derived, and `stopped` then says why. `switches` are the positions of switches in
    which this is the derivation: a relation that each of them has from other equations has one
    derivation a position.
    """

    residual: str
    pool: Pool
    steps: tuple[DerivationStep, ...]
    arr: Expr
    factor: Expr
    starts: dict[Symbol, Expr]
    stopped: str = ""
    switches: tuple[tuple[str, bool], ...] = ()
