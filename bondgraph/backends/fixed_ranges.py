"""How far each value of a block can go while the samples are in their ranges.

What is a sum of samples past and present goes as far as its peak gains say, what a function makes
of that by interval arithmetic.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

from bondgraph.algebra.peak_gain import Unstable, peak_gains
from bondgraph.backends.blocks import Block
from bondgraph.backends.straight_line import (
    Call,
    Linear,
    Operation,
    Unrepresentable,
    operands,
    straight_line,
)
from bondgraph.ir.fixed_program import Limits
from bondgraph.ir.program import Program, Ref
from bondgraph.text.source import Span

if TYPE_CHECKING:
    from bondgraph.algebra.peak_gain import Matrix

#: An input of the recursion: a state at the start of a step (x), a sample (u), what a function or a
#: product is (n), the rounding of a sum (e), an integral (g), or the number 1.
Atom: TypeAlias = tuple[str, Ref]
Row: TypeAlias = dict[Atom, float]

SAMPLED = frozenset({"known", "increment"})  #: The spaces of samples.
_SLACK = 1.0 + 2.0**-8  # of a range, for the errors in it
_TURN = 16.0  # where tanh is 1 to the last bit of a double
_ONE: Atom = ("1", Ref("local", "1"))


class Ranges:
    """The recursion of one block, and the range of each value in it.

    `samples` are the limits of the signals that are read, `declared` what is said of integrals, by
    name.
    """

    def __init__(
        self,
        program: Program,
        block: Block,
        coefficients: Mapping[Ref, float],
        samples: Mapping[str, Limits],
        declared: Mapping[str, tuple[float, float]],
    ) -> None:
        self.of, self.rate = block, program.rate
        self._docs = {Ref("state", s.name): s.doc for s in program.states}
        self._paths = {Ref("known", k.name): k.path for k in program.knowns}
        self._declared, self.samples = declared, samples
        at_rest = {Ref("increment", name): 0.0 for name in block.knowns}
        self.first = straight_line(block.first, {**coefficients, **at_rest}, "start")
        self.step = straight_line(block.step, coefficients)
        self.operations = (*self.first, *self.step)
        self.by_target: dict[Ref, list[Operation]] = {}
        for operation in self.operations:
            self.by_target.setdefault(operation.target, []).append(operation)
        self.states = [Ref("state", name) for name in block.states]
        self.integrals: frozenset[Ref] = frozenset()
        self.wide: frozenset[Ref] = frozenset()
        self.integrals = self._not_fading()
        self._check_states()
        self.wide = self._counted()
        self.gains = self._gains()
        self._spans: dict[Ref, tuple[float, float]] = {}
        self._open: set[Ref] = set()
        self._least: dict[Ref, float] = {}
        self._windows: dict[Ref, float] = {}

    def _check_states(self) -> None:
        """Each state has a start, and one value after each step; an integral is summed besides."""
        starts = [o.target for o in self.first]
        steps = [o.target for o in self.step]
        for state in self.states:
            if state not in starts or steps.count(state) > 1:
                raise Unrepresentable(f"does not set `{state.name}` at its start, and once a step")

    def _rows(self, procedure: Sequence[Operation]) -> dict[Ref, Row]:
        """What each value is of the atoms, by the end of the procedure."""
        rows: dict[Ref, Row] = {}
        for target, row in self._rows_in_order(procedure):
            rows[target] = row
        return rows

    def _rows_in_order(self, procedure: Sequence[Operation]) -> Iterator[tuple[Ref, Row]]:
        """The same after each operation: a start may set a state, and step from there."""
        rows: dict[Ref, Row] = {}
        for operation in procedure:
            target = operation.target
            if target in self.wide:
                continue
            if self.read_integrals(operation) or not isinstance(operation, Linear):
                rows[target] = {("n", target): 1.0}
                yield target, rows[target]
                continue
            row: Row = {("e", target): 1.0}
            if operation.constant:
                row[_ONE] = operation.constant
            for number, variable, _ in operation.terms:
                for atom, factor in self._row(variable, rows).items():
                    row[atom] = row.get(atom, 0.0) + number * factor
            rows[target] = row
            yield target, row

    def _row(self, variable: Ref, rows: Mapping[Ref, Row]) -> Row:
        if variable in rows:
            return rows[variable]
        if variable.space in SAMPLED:
            return {("u", variable): 1.0}
        kind = "g" if variable in self.integrals else "x"
        return {(kind, variable): 1.0}

    def _not_fading(self) -> frozenset[Ref]:
        """The integrals: states that are kept as they are, and added to."""
        rows = self._rows(self.step)
        return frozenset(
            s for s in self.states if abs(rows.get(s, {}).get(("x", s), 0.0)) >= 1.0 - 1e-12
        )

    def _counted(self) -> frozenset[Ref]:
        """The integrals that are summed in small whole numbers of what is integrated.

        Nothing of such a sum is lost, and 64 bits hold it; others are rounded like any state.
        """
        rounded = set[Ref]()
        for operation in self.operations:
            if not (isinstance(operation, Linear) and _counts(operation)):
                rounded.update((operation.target, *operands(operation)))
        return self.integrals - rounded

    def _gains(self) -> dict[Ref, Row]:
        """By value and atom how much of the atom it can have at most."""
        import numpy as np

        first, step = self._rows(self.first), self._rows(self.step)
        states = [s for s in self.states if s not in self.integrals]
        inputs = sorted(
            {a for rows in (first, step) for row in rows.values() for a in row if a[0] != "x"},
            key=lambda a: (a[0], a[1].space, a[1].name),
        )
        values = list(step)
        x = {("x", s): k for k, s in enumerate(states)}
        u = {a: k for k, a in enumerate(inputs)}

        def matrix(rows: Sequence[Row], columns: Mapping[Atom, int]) -> Matrix:
            found = np.zeros((len(rows), len(columns)))
            for k, row in enumerate(rows):
                for atom, factor in row.items():
                    if atom in columns:
                        found[k, columns[atom]] = factor
            return found

        after = [step.get(s, {("x", s): 1.0}) for s in states]
        begin, out = [first[s] for s in states], list(step.values())
        try:
            peaks = peak_gains(
                matrix(after, x), matrix(after, u), matrix(out, x), matrix(out, u),
                matrix(begin, u),
            )  # fmt: skip
        except (Unstable, np.linalg.LinAlgError) as error:
            raise Unrepresentable(
                "remembers what does not fade: its range is not bounded by those of the samples",
                None,
                "Residuals of the form `derivative` have filters that fade: leave `--form` out.",
            ) from error
        found: dict[Ref, Row] = {}
        for value, row in self._rows_in_order(self.first):
            own = found.setdefault(value, {})
            for atom, factor in row.items():
                own[atom] = max(own.get(atom, 0.0), abs(factor))
        for value, gains in zip(values, peaks, strict=True):
            own = found.setdefault(value, {})
            for atom, gain in zip(inputs, map(float, gains), strict=True):
                if gain:
                    own[atom] = max(own.get(atom, 0.0), gain)
        return found

    def _size(self, atom: Atom) -> float:
        kind, of = atom
        if kind == "1":
            return 1.0
        if kind == "u":
            limits = self.samples[of.name]
            return max(abs(limits.low), abs(limits.high))
        if kind == "n":
            return self.reach(of)
        if kind == "g":
            return self._far(of, None)
        raise AssertionError(kind)

    def reach(self, ref: Ref) -> float:
        """What a value of whole numbers stays within, both ways."""
        if ref.space in SAMPLED:
            return self._size(("u", ref))
        return max(map(abs, self.allowed(ref))) + self._least.get(ref, 0.0)

    def allowed(self, ref: Ref) -> tuple[float, float]:
        """The same as an interval, without the roundings of what is larger at the same scale."""
        low, high = self.span(ref)
        if ref.space in SAMPLED:
            return low, high
        room = (_SLACK - 1.0) * max(-low, high)
        return low - room, high + room

    def span(self, ref: Ref) -> tuple[float, float]:
        """What a value stays within while sums are not rounded, but all else is."""
        if ref.space in SAMPLED:
            limits = self.samples[ref.name]
            return limits.low, limits.high
        if ref in self._spans:
            return self._spans[ref]
        if ref in self._open:
            raise Unrepresentable("feeds a product or a function back into itself")
        self._open.add(ref)
        row = self.gains[ref]
        peak = sum(gain * self._size(a) for a, gain in row.items() if a[0] not in "en")
        peak += sum(g * self._size(a) for a, g in row.items() if a[0] == "n" and a[1] != ref)
        spans = [self._of_operation(operation) for operation in self.by_target[ref]]
        low, high = min(s[0] for s in spans), max(s[1] for s in spans)
        if ("n", ref) not in row:
            low, high = max(low, -peak), min(high, peak)
        self._open.discard(ref)
        self._spans[ref] = low, high
        return low, high

    def _of_operation(self, operation: Operation) -> tuple[float, float]:
        """The interval that an operation makes of those of its operands."""
        if isinstance(operation, Linear):
            if self.read_integrals(operation):
                limit = self.window(operation)
                return -limit, limit
            if any(t.variable.space == "state" for t in operation.terms):
                return -math.inf, math.inf  # the peak gain says it
            return _sum_of(operation, self._summand)
        if isinstance(operation, Call):
            low, high = self.allowed(operation.argument)
            if operation.function == "near_tanh":
                return math.tanh(low), math.tanh(high)
            return _root(low), _root(high)
        left, right = self.allowed(operation.left), self.allowed(operation.right)
        if operation.what == "/":
            if right[0] <= 0.0 <= right[1]:
                below = self._paths.get(operation.right)
                what = f"by `{below}`" if below else f"in {operation.comment}"
                raise Unrepresentable(
                    f"divides {what}, which ranges do not keep from 0",
                    operation.origin,
                    "Give ranges of the signals in it that do not hold 0.",
                )
            right = 1.0 / right[1], 1.0 / right[0]
        products = [a * b for a in left for b in right]
        return min(products), max(products)

    def _summand(self, ref: Ref) -> tuple[float, float]:
        """What a sum has to reckon with: the roundings of other sums are counted by themselves."""
        made = self.gains.get(ref, {}).get(("n", ref), 0.0)
        return self.allowed(ref) if made else self.span(ref)

    def window(self, operation: Linear) -> float:
        """How far what reads an integral is looked at."""
        found = self._windows.get(operation.target)
        if found is None:
            found = self._windows[operation.target] = self._new_window(operation)
        return found

    def _new_window(self, operation: Linear) -> float:
        readers = [o for o in self.operations if operation.target in operands(o)]
        declared = [t.variable for t in operation.terms if t.variable in self.wide]
        if all(isinstance(r, Call) and r.function == "near_tanh" for r in readers):
            return _TURN
        total = 0.0
        for number, variable, _ in operation.terms:
            if variable in declared:
                total += abs(number) * self._far(variable, operation.origin)
            else:
                total += abs(number) * self.reach(variable)
        return total

    def _far(self, integral: Ref, origin: Span | None) -> float:
        """How far an integral has to be reckoned with."""
        own = self.limit(integral)
        if own is None:
            raise Unrepresentable(
                f"takes an integral that the ranges of the samples do not bound"
                f" ({self._docs[integral]})",
                origin,
                f"Say how far it can go: `--range {integral.name}=LOW..HIGH`; beyond that the"
                " residual starts anew.",
            )
        return own

    def limit(self, integral: Ref) -> float | None:
        """How far an integral may go, both ways, None where that is not declared."""
        own = self._declared.get(integral.name)
        return None if own is None else max(map(abs, own))

    def make_room(self, refs: Iterable[Ref], size: float) -> None:
        """Values that have the scale of a larger one have its roundings."""
        self._least |= dict.fromkeys(refs, size)

    def read_integrals(self, operation: Operation) -> list[Ref]:
        """The integrals of 64 bits that a sum makes a number of 32 of."""
        if operation.target in self.wide:
            return []
        return [ref for ref in operands(operation) if ref in self.wide]


def _sum_of(
    operation: Linear, span: Callable[[Ref], tuple[float, float]]
) -> tuple[float, float]:
    """The interval of a sum."""
    low = high = operation.constant
    for number, variable, _ in operation.terms:
        ends = sorted(number * end for end in span(variable))
        low, high = low + ends[0], high + ends[1]
    return low, high


def _counts(operation: Linear) -> bool:
    """Whether a sum has small whole factors only."""
    numbers = [t.number for t in operation.terms]
    return not operation.constant and all(abs(n) <= 1024.0 and n == int(n) for n in numbers)


def _root(value: float) -> float:
    return math.copysign(math.sqrt(abs(value)), value)
