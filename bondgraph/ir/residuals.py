"""Analytical redundancy relations: expressions of known signals that vanish while all is well."""

from __future__ import annotations

from typing import Literal

from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import Expr
from bondgraph.text.diagnostic import Diagnostic
from bondgraph.text.tuples import NamedTuple

#: What residuals are made of, see `Options`: in one form, or observers where they are named.
Form = Literal["derivative", "observer"] | tuple[str, ...]

How = Literal["solved", "inverted", "differentiated", "integrated", "loop", "known"]


class Step(NamedTuple):
    """One step of the elimination: `variable` = `value`, from `equation`, by `how`.

    `value` is written in earlier variables (as a person follows it), `closed` in known signals.
    """

    variable: Expr
    value: Expr
    closed: Expr
    equation: Equation
    how: How


class Residual(NamedTuple):
    """One ARR: `expr` is in known signals, parameters, D and Int only.

    `closing` is the equation that was left over and became the relation, `steps` the elimination
    steps that it rests on, in order: the causal path from the known signals to the closing
    equation. `differentiated` counts how often the relation was differentiated because an initial
    value is not declared; it is -1 where one of rates alone was integrated from declared ones.
    `free_of` names the fault that it was made to be free of. `raw`, `loop` and `each` are as in
    `Closing`; `orders` has the highest derivative of each known signal that the residual holds (-1:
    only under an integral).
    """

    name: str
    expr: Expr
    closing: Equation
    steps: tuple[Step, ...]
    differentiated: int
    free_of: str | None
    raw: Expr
    orders: dict[str, int]
    loop: tuple[Equation, ...] = ()
    each: tuple[InPosition, ...] = ()


class Observer(NamedTuple):
    """A relation solved for its states: x' = `rates` + `entry` w, and y = `output`.

    w is the value of the relation, so that it is zero on a healthy machine. `rates`, `output` and
    `entry` are in the `states`, in parameters and in known signals that nothing differentiates;
    `measured` is the known signal y, of the sensor called `sensor`. `starts` are the states of a
    machine at rest, in known signals and parameters.
    """

    sensor: str
    measured: Expr
    states: tuple[Expr, ...]
    rates: tuple[Expr, ...]
    output: Expr
    entry: tuple[Expr, ...]
    starts: tuple[Expr, ...]

    @property
    def exprs(self) -> tuple[Expr, ...]:
        """All that a step of the observer may ask for."""
        return (self.measured, *self.rates, self.output, *self.entry, *self.starts)


class Missing(NamedTuple):
    """A relation that the model has but that could not be had.

    `about` is the equation that would have become the relation, `elements` the names of what stands
    in the way, `equations` what the relation would rest on, as far as that is known. `finding` says
    why, where and what to do: an error, which it is only where no relation at all is had, or a
    warning where no reason is known.
    """

    about: Equation
    elements: tuple[str, ...]
    equations: tuple[Equation, ...]
    finding: Diagnostic

    @property
    def explained(self) -> bool:
        """Whether it is known why the relation could not be had."""
        return self.finding.severity == "error"


class ResidualSet(NamedTuple):
    """All ARRs in stable order; `unsolved` are the variables that no sensor reaches.

    `unmonitored` are the equations of the part that has no redundancy, `missing` the relations that
    could not be had.
    """

    system: EquationSystem
    residuals: tuple[Residual, ...]
    unsolved: tuple[Expr, ...]
    unmonitored: tuple[Equation, ...]
    missing: tuple[Missing, ...] = ()


class Closing(NamedTuple):
    """An equation that was left over when all its variables had been computed: `expr` = 0.

    `steps` are what its variables rest on, in the order of the elimination; `differentiated` as
    in `Residual`. `raw` is the same relation before derivatives were moved past parameters: equal
    while these are constant, it shows what a parameter does that moves. `free_of` as in
    `Residual`. `loop` are the other equations that had all their variables computed, some from
    torn ones, and that were combined with this one so that these drop out. Where the relation was
    had in each position of some switches by itself, `each` has what it is there.
    """

    equation: Equation
    expr: Expr
    steps: tuple[Step, ...]
    differentiated: int
    raw: Expr
    free_of: str | None = None
    loop: tuple[Equation, ...] = ()
    each: tuple[InPosition, ...] = ()


class InPosition(NamedTuple):
    """What a relation is while modes are on or off; its equations are those of that position."""

    setting: tuple[tuple[Expr, bool], ...]
    closing: Closing


class ReducedSystem(NamedTuple):
    """The equations after elimination, before what cancels is taken out.

    `steps` give every variable that was reached, once, in the order of the elimination; in `closed`
    a torn variable may still stand for itself, which the steps of a closing have resolved as far as
    that is possible. Of a plant that was eliminated in each mode they are chosen by the mode.
    `unsolved` are variables that no sensor reaches, `unmonitored` the equations that hold them.
    `missing` are relations that exist but could not be brought to known signals.
    """

    system: EquationSystem
    steps: tuple[Step, ...]
    closings: tuple[Closing, ...]
    unsolved: tuple[Expr, ...]
    unmonitored: tuple[Equation, ...]
    missing: tuple[Missing, ...]
