"""One random exact behaviour of a plant, as told and as it truly is, or why there is none."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import TypeAlias

from bondgraph.exact.assembly import Assembly
from bondgraph.exact.known import KnownSample
from bondgraph.exact.signal_algebra import Mixed
from bondgraph.field.numbers import Number
from bondgraph.field.series import Series
from bondgraph.ir.expr import CONSTANTS, Expr, Kind, Symbol

#: What draws the same healthy plant with the same constants at another time, if it can be found.
Again: TypeAlias = "Callable[[Trajectory, int, dict[Expr, Series]], Trajectory | None]"


class ExactUnavailable(Exception):
    """The oracle has no exact trajectory of this plant; the message is a reason for people."""


class Contradictory(ExactUnavailable):
    """No plant could behave like this: the equations are more than what they could determine.

    `node` is the number of the node at which one is too many, -1 if it is nobody's.
    """

    def __init__(self, message: str, node: int) -> None:
        super().__init__(message)
        self.node = node


class Trajectory:
    """One random behaviour: what a residual is told, and what truly happens.

    `faults` are the names of the faults that act. `value` gives what a residual is told: readings
    and inputs with their errors, parameters without. `truths` gives what truly happens, `truth`
    the true series of one symbol. `part` is the machine that it is of, without the laws that were
    left out. On a `still` one a law is satisfied by a factor that rests, or left out: what does not
    vanish there may still vanish on the plant.
    """

    def __init__(
        self,
        again: Again,
        seed: int,
        order: int,
        faults: tuple[str, ...],
        told: dict[Expr, Series],
        truth: KnownSample,
        starts: dict[Symbol, Number],
        part: Assembly,
        still: bool = False,
        read: frozenset[Expr] | None = None,
    ) -> None:
        self.read = read
        self._again = again
        self.part = part
        self.still = still
        self.seed = seed
        self.order = order
        self.faults = faults
        self.algebra = truth.algebra
        self._told = told
        self.truths = truth
        self._starts = starts
        self._earlier: dict[int, Trajectory] = {}

    def value(self, symbol: Expr) -> Series:
        """What a residual is told about a symbol, at least `order` + 1 Taylor coefficients."""
        found = self._told.get(symbol)
        if found is None:
            found = self._told[symbol] = self.truths.value(symbol)
        return found

    def truth(self, symbol: Expr) -> Series:
        """The true series of a variable, an input or a parameter."""
        return self.truths.value(symbol)

    @property
    def healthy(self) -> bool:
        """Whether no fault acts."""
        return not self.faults

    def truly(self, variable: Expr) -> Number | None:
        """The true value of a variable at the point; None for one that the plant has not."""
        try:
            return self.truths.value(variable)[0]
        except Mixed:  # not one of the plant's variables
            return None

    def start(self, initial: Symbol) -> Number:
        """The value from which integrals with this initial value begin; random if undeclared."""
        found = self._starts.get(initial)
        if found is None:
            draw = Random(f"{self.seed}:{initial.name}")
            found = self._starts[initial] = self.algebra.numbers.any(draw)
        return found

    def earlier(self, steps: int) -> Trajectory:
        """The same healthy plant with the same constants at another time.

        Constants (parameters, declared initial values) are the same, all signals different; an
        integral begins there with its value of that time. Where no other point can be found that
        satisfies the nonlinear laws with these constants, the present one stands for it: what
        cancels at any two times does so there, too.
        """
        found = self._earlier.get(steps)
        if found is None:
            constants = {s: v for s, v in self._told.items() if s.symbol.kind in CONSTANTS}
            constants.update((s, v) for s, v in self._told.items() if s.symbol.kind is Kind.MODE)
            found = self._again(self, steps, constants) or self
            self._earlier[steps] = found
        return found
