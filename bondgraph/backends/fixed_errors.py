"""How far each residual of a block in whole numbers is from real numbers.

Each rounding is one more input of the recursion, and its peak gains say what it does to a residual
(Lopez, Hilaire and Didier, 2014).
"""

from __future__ import annotations

import math

from bondgraph.algebra import cubic_tanh
from bondgraph.backends.fixed_ranges import SAMPLED, Ranges
from bondgraph.backends.fixed_scales import Scales
from bondgraph.backends.straight_line import Call, Linear, Operation, Unrepresentable
from bondgraph.ir.fixed_program import Deviation
from bondgraph.ir.program import Ref
from bondgraph.text.tuples import NamedTuple

_DOUBLE = 1.0 + 1e-3  # of a bound, for the roundings of double that it is compared with


class Bound(NamedTuple):
    """An error: at any time, and more for each hour since the start."""

    fixed: float
    hourly: float

    def plus(self, factor: float, other: Bound) -> Bound:
        """The sum with a multiple of another one."""
        return Bound(self.fixed + factor * other.fixed, self.hourly + factor * other.hourly)


_NONE = Bound(0.0, 0.0)


class Errors:
    """Bounds of the errors of values of one block, once it has `scales`."""

    def __init__(self, ranges: Ranges, scales: Scales) -> None:
        self._ranges, self._scales = ranges, scales
        self._known: dict[Ref, Bound] = {}

    def deviation(self, residual: Ref) -> Deviation:
        """The scale of a residual, and how far it is from real numbers."""
        error = self._of(residual)
        return Deviation(
            self._scales.bits[residual],
            error.fixed * _DOUBLE,
            error.hourly * _DOUBLE,
            max(map(abs, self._ranges.span(residual))),
        )

    def _of(self, ref: Ref) -> Bound:
        if ref.space in SAMPLED:
            return _NONE
        if ref in self._known:
            return self._known[ref]
        row, found = self._ranges.gains[ref], _NONE
        if ("n", ref) in row:
            for operation in self._ranges.by_target[ref]:
                own = self._made_by(operation)
                found = Bound(max(found.fixed, own.fixed), max(found.hourly, own.hourly))
        else:
            for atom, gain in row.items():
                if atom[0] == "e":
                    found = found.plus(gain, Bound(self._scales.rounding.get(atom[1], 0.0), 0.0))
                elif atom[0] == "n":
                    found = found.plus(gain, self._of(atom[1]))
                elif atom[0] == "g" and atom[1] != ref:
                    found = found.plus(gain, self._of_integral(atom[1]))
        self._known[ref] = found
        return found

    def _made_by(self, operation: Operation) -> Bound:
        """The error of a function or a product of what is not exact, with its own rounding."""
        unit = Bound(math.ldexp(1.0, -self._scales.bits[operation.target]), 0.0)
        if isinstance(operation, Linear):  # of an integral
            found = unit
            for number, variable, _ in operation.terms:
                error = self._of_integral(variable) if variable in self._ranges.wide else (
                    self._of(variable)
                )
                found = found.plus(abs(number), error)
            return found
        if isinstance(operation, Call):
            error = self._of(operation.argument)
            if operation.function == "near_tanh":
                return Bound(cubic_tanh.BOUND + 1e-8, 0.0).plus(1.0, error)
            if error.hourly:
                raise Unrepresentable("takes a root of an integral", operation.origin)
            return unit.plus(1.0, Bound(math.sqrt(2.0 * error.fixed), 0.0))
        left, right = self._of(operation.left), self._of(operation.right)
        if operation.what == "*":
            found = unit.plus(self._ranges.reach(operation.left), right)
            return found.plus(self._ranges.reach(operation.right), left)
        least = min(map(abs, self._ranges.allowed(operation.right)))
        found = unit.plus(1.0 / least, left)
        return found.plus(self._ranges.reach(operation.left) / least**2, right)

    def _of_integral(self, integral: Ref) -> Bound:
        """What the roundings of its summands sum up to, an hour at the rate of the samples."""
        if integral not in self._ranges.wide:
            each_sample = self._of(integral).fixed
            return Bound(each_sample, each_sample * 3600.0 * self._ranges.rate)
        each = [0.0, 0.0]
        for at, procedure in enumerate((self._ranges.first, self._ranges.step)):
            for operation in procedure:
                if operation.target == integral and isinstance(operation, Linear):
                    for number, variable, _ in operation.terms:
                        if variable != integral:
                            each[at] += abs(number) * self._of(variable).fixed
        return Bound(each[0], each[1] * 3600.0 * self._ranges.rate)
