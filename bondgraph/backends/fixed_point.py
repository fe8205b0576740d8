"""Fixed-point scaling: a residual program in 32-bit integers, with proof and bound of its error.

Each value gets the largest range that it can have while the samples are in theirs: what is a sum of
samples past and present by its peak gains, what a function makes of that by interval arithmetic.
Its scale is the finest power of two at which that range, and every sum on the way there, fits. Each
rounding is then one more input of the same recursion, and its peak gains say what it does to a
residual (Lopez, Hilaire and Didier, 2014). What is not bounded, or has no form, is refused.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from hashlib import sha256
from typing import TYPE_CHECKING, TypeAlias

from bondgraph.algebra import cubic_tanh
from bondgraph.algebra.peak_gain import Unstable, peak_gains
from bondgraph.backends.blocks import Block, blocks
from bondgraph.backends.nominal_coefficients import nominal
from bondgraph.backends.parts import begun, step_part
from bondgraph.backends.straight_line import (
    Call,
    Linear,
    Operation,
    Term,
    Unrepresentable,
    operands,
    straight_line,
)
from bondgraph.ir.fixed_program import (
    SAMPLE_BITS,
    Accumulate,
    Count,
    Deviation,
    Divide,
    Explained,
    Factor,
    FixedBlock,
    FixedProgram,
    Guard,
    Instruction,
    Limits,
    Multiply,
    Sigmoid,
    SignedRoot,
    Window,
)
from bondgraph.ir.groups import Groups
from bondgraph.ir.program import Known, Program, Ref
from bondgraph.text.diagnostic import Report
from bondgraph.text.numerals import joined
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

if TYPE_CHECKING:
    from bondgraph.algebra.peak_gain import Matrix

#: An input of the recursion: a state at the start of a step (x), a sample (u), what a function or a
#: product is (n), the rounding of a sum (e), an integral (g), or the number 1.
Atom: TypeAlias = tuple[str, Ref]
Row: TypeAlias = dict[Atom, float]

_SAMPLED = frozenset({"known", "increment"})
_WORD = 31
_MOST = (1 << _WORD) - 1  # of a whole number of 32 bits
_WIDE = 61  # bits of an integral of 64 beside its sign, less room for a step
_FINEST = 60
_SLACK = 1.0 + 2.0**-8  # of a range, for the errors in it
_SMALL = 2.0**-16  # of the largest range of those that have one scale, room for errors in each
_DOUBLE = 1.0 + 1e-3  # of a bound, for the roundings of double that it is compared with
_TURN = 16.0  # where tanh is 1 to the last bit of a double
_TRIES = 12
_TOO_ROUGH = (
    "loses more by rounding than its range leaves room for",
    None,
    "A wider filter (`--bandwidth`) remembers less.",
)
_ONE: Atom = ("1", Ref("local", "1"))


class Bound(NamedTuple):
    """An error: at any time, and more for each hour since the start."""

    fixed: float
    hourly: float

    def plus(self, factor: float, other: Bound) -> Bound:
        """The sum with a multiple of another one."""
        return Bound(self.fixed + factor * other.fixed, self.hourly + factor * other.hourly)


_NONE = Bound(0.0, 0.0)


def fixed_point(
    program: Program, ranges: Mapping[str, tuple[float, float]], report: Report
) -> FixedProgram | None:
    """`step` of a program in integers; `ranges` by path of a signal, or by name of an integral.

    None, with all reasons in the report, where it cannot be had or a range is missing.
    """
    part = begun(step_part(program))
    try:
        _check_program(part)
    except Unrepresentable as error:
        _refuse(error, f"The residuals of {program.name}", report)
        return None
    samples = _samples(part, ranges, report)
    return None if report.failed else _fixed(part, samples, ranges, report)


def _refuse(error: Unrepresentable, whose: str, report: Report) -> None:
    labels = [error.origin] if error.origin is not None else []
    report.error(
        "no-fixed-point",
        f"{whose} {error.why}: not to be had in fixed point.",
        *labels,
        help=error.remedy or "Without `--real fixed` the code computes it in double or float.",
    )


def _samples(
    part: Program, ranges: Mapping[str, tuple[float, float]], report: Report
) -> dict[str, Limits]:
    """The limits of all signals that are read; the report says which have no range."""
    read = {name for block in blocks(part) for name in block.knowns}
    found = {}
    for known in part.knowns:
        if known.name in read:
            try:
                found[known.name] = _limits(known, ranges)
            except Unrepresentable as error:
                _refuse(error, f"The signal `{known.path}`", report)
    return found


def _fixed(
    part: Program,
    samples: dict[str, Limits],
    ranges: Mapping[str, tuple[float, float]],
    report: Report,
) -> FixedProgram | None:
    known = nominal(part)
    if known is None:
        wanting = Unrepresentable("have parameters without a value, or too many coefficients")
        _refuse(wanting, f"The residuals of {part.name}", report)
        return None
    coefficients = {
        Ref("coef", field.name, k): value
        for field, values in zip(part.coefs, known.coefficients, strict=True)
        for k, value in enumerate(values)
    }
    origins = {r.name: r.origin for r in part.residuals}
    found = []
    residuals: dict[str, Deviation] = {}
    bits = _sample_bits(samples)
    for block in blocks(part):
        try:
            scaling = _Scaling(part, block, coefficients, samples, ranges)
            found.append(scaling.block())
        except Unrepresentable as error:
            error.origin = error.origin or origins[block.residuals[0]]
            _refuse(error, f"The residual {joined([f'`{r}`' for r in block.residuals])}", report)
            continue
        for name in block.residuals:
            residuals[name] = scaling.deviation(Ref("residual", name))
        bits |= scaling.bits
    if report.failed:
        return None
    scaled = f"{part.digest} {sorted(samples.items())}".encode()
    part = part._replace(digest=sha256(scaled).hexdigest()[: len(part.digest)])
    return FixedProgram(part, tuple(found), samples, residuals, bits, known.settle)


def _check_program(part: Program) -> None:
    for known in part.knowns:
        if known.kind == "mode":
            raise Unrepresentable(f"read the switch `{known.path}`", known.origin)
    for what, there in (
        ("remember past samples for a delay", part.delayed),
        ("start anew where switches turn", part.openings),
        ("solve equations at each sample", part.roots),
    ):
        if there:
            raise Unrepresentable(what)
    if not blocks(part):
        raise Unrepresentable("are none that `step` ever has")


def _limits(known: Known, ranges: Mapping[str, tuple[float, float]]) -> Limits:
    """What a sample may be: where it has both signs, to the next power of two."""
    path, unit = known.path, known.unit
    if known.counts is not None:
        unit = "counts from one sample to the next"
    if path not in ranges:
        raise Unrepresentable(
            "has no range",
            known.origin,
            f"Say `--range {path}=LOW..HIGH`{f' in {unit}' if unit else ''}, or give a log in"
            " which it is not always 0 with `--ranges LOG`.",
        )
    low, high = ranges[path]
    largest = max(abs(low), abs(high))
    if known.counts is not None:
        if largest > 2.0**SAMPLE_BITS:
            raise Unrepresentable(f"has a range of more than 2^{SAMPLE_BITS} counts", known.origin)
        bits = SAMPLE_BITS - math.frexp(largest)[1]
        return Limits(bits, math.ceil(low), math.floor(high), low, high)
    power = math.frexp(largest)[1] - (math.frexp(largest)[0] == 0.5)
    bits = SAMPLE_BITS - power
    if low < 0.0 < high:
        size = 2.0**power
        return Limits(bits, -(1 << SAMPLE_BITS), (1 << SAMPLE_BITS) - 1, -size, size)
    least, most = math.ceil(math.ldexp(low, bits)), math.floor(math.ldexp(high, bits))
    return Limits(bits, least, most, low, high)


class _Scaling:
    """Ranges, scales and errors of one block."""

    def __init__(
        self,
        program: Program,
        block: Block,
        coefficients: Mapping[Ref, float],
        samples: Mapping[str, Limits],
        ranges: Mapping[str, tuple[float, float]],
    ) -> None:
        self.of = block
        self.rate = program.rate
        self.docs = {Ref("state", s.name): s.doc for s in program.states}
        self.paths = {Ref("known", k.name): k.path for k in program.knowns}
        self.samples = samples
        self.ranges = ranges
        at_rest = {Ref("increment", name): 0.0 for name in block.knowns}
        self.first = straight_line(block.first, {**coefficients, **at_rest}, "start")
        self.step = straight_line(block.step, coefficients)
        self.by_target: dict[Ref, list[Operation]] = {}
        for procedure in (self.first, self.step):
            for operation in procedure:
                self.by_target.setdefault(operation.target, []).append(operation)
        self.states = [Ref("state", name) for name in block.states]
        self.integrals: frozenset[Ref] = frozenset()
        self.wide: frozenset[Ref] = frozenset()
        self.integrals = self._not_fading()
        self._check_states()
        self.wide = self._counted()
        self.gains = self._gains()
        self._arguments = {
            ref
            for o in (*self.first, *self.step)
            if not isinstance(o, Linear)
            for ref in operands(o)
            if ref in self.gains
        }
        self.groups = self._groups()
        self.bits: dict[Ref, int] = {}
        self.rounding: dict[Ref, float] = {}
        self._spans: dict[Ref, tuple[float, float]] = {}
        self._errors: dict[Ref, Bound] = {}
        self._open: set[Ref] = set()
        self._lowered: dict[Ref, int] = {}
        self._least: dict[Ref, float] = {}
        self._windows: dict[Ref, float] = {}

    # ------------------------------------------------------------------ the recursion

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
            if self._read_integrals(operation) or not isinstance(operation, Linear):
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
        if variable.space in _SAMPLED:
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
        for operation in (*self.first, *self.step):
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

    # -------------------------------------------------------------------------- ranges

    def _size(self, atom: Atom) -> float:
        kind, of = atom
        if kind == "1":
            return 1.0
        if kind == "u":
            limits = self.samples[of.name]
            return max(abs(limits.low), abs(limits.high))
        if kind == "n":
            return self._reach(of)
        if kind == "g":
            return self._declared(of, None)
        raise AssertionError(kind)

    def _reach(self, ref: Ref) -> float:
        """What a value of whole numbers stays within, both ways."""
        if ref.space in _SAMPLED:
            return self._size(("u", ref))
        return max(map(abs, self._allowed(ref))) + self._least.get(ref, 0.0)

    def _allowed(self, ref: Ref) -> tuple[float, float]:
        """The same as an interval, without the roundings of what is larger at the same scale."""
        low, high = self._span(ref)
        if ref.space in _SAMPLED:
            return low, high
        room = (_SLACK - 1.0) * max(-low, high)
        return low - room, high + room

    def _span(self, ref: Ref) -> tuple[float, float]:
        """What a value stays within while sums are not rounded, but all else is."""
        if ref.space in _SAMPLED:
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
            if self._read_integrals(operation):
                limit = self._window(operation)
                return -limit, limit
            if any(t.variable.space == "state" for t in operation.terms):
                return -math.inf, math.inf  # the peak gain says it
            return _sum_of(operation, self._summand)
        if isinstance(operation, Call):
            low, high = self._allowed(operation.argument)
            if operation.function == "near_tanh":
                return math.tanh(low), math.tanh(high)
            return _root(low), _root(high)
        left, right = self._allowed(operation.left), self._allowed(operation.right)
        if operation.what == "/":
            if right[0] <= 0.0 <= right[1]:
                below = self.paths.get(operation.right)
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
        return self._allowed(ref) if made else self._span(ref)

    def _window(self, operation: Linear) -> float:
        """How far what reads an integral is looked at."""
        found = self._windows.get(operation.target)
        if found is None:
            found = self._windows[operation.target] = self._new_window(operation)
        return found

    def _new_window(self, operation: Linear) -> float:
        readers = [o for o in (*self.first, *self.step) if operation.target in operands(o)]
        declared = [t.variable for t in operation.terms if t.variable in self.wide]
        if all(isinstance(r, Call) and r.function == "near_tanh" for r in readers):
            return _TURN
        total = 0.0
        for number, variable, _ in operation.terms:
            if variable in declared:
                total += abs(number) * self._declared(variable, operation.origin)
            else:
                total += abs(number) * self._reach(variable)
        return total

    def _declared(self, integral: Ref, origin: Span | None) -> float:
        own = self.ranges.get(integral.name)
        if own is None:
            raise Unrepresentable(
                f"takes an integral that the ranges of the samples do not bound"
                f" ({self.docs[integral]})",
                origin,
                f"Say how far it can go: `--range {integral.name}=LOW..HIGH`; beyond that the"
                " residual starts anew.",
            )
        return max(map(abs, own))

    # -------------------------------------------------------------------------- scales

    def _groups(self) -> Groups[Ref]:
        """The values that are added as they are, and so have one scale."""
        groups = Groups[Ref]()
        for operation in (*self.first, *self.step):
            if not isinstance(operation, Linear):
                continue
            target = operation.target
            if self._read_integrals(operation):
                ends = [t.variable for t in operation.terms]
            elif target in self.wide:
                ends = [target, *(t.variable for t in operation.terms)]
            elif self._own_scale(target):
                ends = []
            else:
                ends = [target, *(t.variable for t in operation.terms if abs(t.number) == 1.0)]
            ends = [e for e in ends if e.space not in _SAMPLED and not self._own_scale(e)]
            for end in ends[1:]:
                groups.join(ends[0], end)
        return groups

    def _own_scale(self, ref: Ref) -> bool:
        """Whether a value has a scale of its own: one that no sum made."""
        return any(
            not isinstance(o, Linear) or bool(self._read_integrals(o))
            for o in self.by_target.get(ref, ())
        )

    def _scale(self) -> None:
        """The finest scale of each group at which all its values fit."""
        members: dict[Ref, list[Ref]] = {}
        for ref in self.by_target:
            members.setdefault(self.groups.find(ref), []).append(ref)
        takes = {
            o.argument
            for o in (*self.first, *self.step)
            if isinstance(o, Call) and o.function == "near_tanh"
        }
        self.bits = _sample_bits(self.samples)
        widest: dict[Ref, int] = {}  # what 64 bits have room for
        for operation in (*self.first, *self.step):
            for integral in self._read_integrals(operation):
                assert isinstance(operation, Linear)
                room = _WIDE - math.frexp(self._window(operation))[1]
                root = self.groups.find(integral)
                widest[root] = min(widest.get(root, room), room)
        for root, refs in members.items():
            spans = [max(map(abs, self._span(r))) for r in refs if r not in self.wide]
            if len(spans) > 1:  # what is small beside the others has their roundings
                self._least |= dict.fromkeys(refs, _SMALL * max(spans))
            own = [_finest(self._reach(r)) for r in refs if r not in self.wide]
            found = min([*own, widest.get(root, _FINEST)]) - self._lowered.get(root, 0)
            for ref in refs:
                self.bits[ref] = found
        for ref in takes:
            self.bits[ref] = min(self.bits[ref], cubic_tanh.MOST_BITS - 1)
        for operation in (*self.first, *self.step):
            if isinstance(operation, Call) and operation.function == "near_tanh":
                self.bits[operation.target] = cubic_tanh.BITS
            for integral in self._read_integrals(operation):
                finest = self.bits[operation.target], self.bits[integral]
                self.bits[operation.target] = min(finest)

    def _read_integrals(self, operation: Operation) -> list[Ref]:
        """The integrals of 64 bits that a sum makes a number of 32 of."""
        if operation.target in self.wide:
            return []
        return [ref for ref in operands(operation) if ref in self.wide]

    # ------------------------------------------------------------------- instructions

    def block(self) -> FixedBlock:
        """The block in whole numbers."""
        for ref in self.by_target:
            if ref not in self.wide:
                self._span(ref)
        for _ in range(_TRIES):
            self._scale()
            self.rounding = {}
            done = [[self._explained(o) for o in p] for p in (self.first, self.step)]
            too_fine = self._overflowing(i.instruction for p in done for i in p)
            if not too_fine:
                break
            for ref in too_fine:
                root = self.groups.find(ref)
                self._lowered[root] = self._lowered.get(root, 0) + 1
        else:
            raise Unrepresentable("has sums that no scale keeps from overflow")
        return FixedBlock(
            self.of.name,
            self.of.residuals,
            self.of.knowns,
            self.of.states,
            tuple(done[0]),
            tuple(done[1]),
            tuple(
                Guard(q, self._guard(q), q in self.wide) for q in self.states if q in self.integrals
            ),
        )

    def _guard(self, integral: Ref) -> int:
        own = self.ranges.get(integral.name)
        if own is None:
            return 1 << _WIDE
        return min(1 << _WIDE, int(math.ldexp(max(map(abs, own)), self.bits[integral])))

    def _explained(self, operation: Operation) -> Explained:
        return Explained(self._instruction(operation), operation.comment, operation.origin)

    def _instruction(self, operation: Operation) -> Instruction:
        bits, target = self.bits, operation.target
        if isinstance(operation, Linear):
            wide = self._read_integrals(operation)
            if not wide and target not in self.wide:
                return self._accumulated(operation)
            counts = tuple((int(t.number), t.variable) for t in operation.terms)
            if len({bits[ref] for _, ref in counts}) > 1:
                raise Unrepresentable("integrates a sample as it comes", operation.origin)
            if target in self.wide:
                return Count(target, counts)
            shift = bits[wide[0]] - bits[target]
            limit = int(math.ldexp(self._window(operation), bits[wide[0]]))
            return Window(target, counts, min(limit, _MOST << shift), shift)
        if isinstance(operation, Call):
            argument = operation.argument
            if operation.function == "near_tanh":
                if bits[argument] < cubic_tanh.LEAST_BITS:
                    raise Unrepresentable("needs tanh of a number that is too large")
                return Sigmoid(target, argument, bits[argument])
            return SignedRoot(target, argument, self._root_shift(target, argument))
        left, right = operation.left, operation.right
        if operation.what == "*":
            shift = bits[left] + bits[right] - bits[target]
            return Multiply(target, left, right, _within(shift, 0, 62, operation.origin))
        shift = bits[target] + bits[right] - bits[left]
        return Divide(target, left, right, _within(shift, 0, 32, operation.origin))

    def _root_shift(self, target: Ref, argument: Ref) -> int:
        shift = 2 * self.bits[target] - self.bits[argument]
        if shift > 32:
            self.bits[target] = (32 + self.bits[argument]) // 2
            shift = 2 * self.bits[target] - self.bits[argument]
        return _within(shift, 0, 32, None)

    def _accumulated(self, operation: Linear) -> Accumulate:
        """A sum: what is at its own scale as it is, the rest as products of 64 bits."""
        target, bits = operation.target, self.bits
        own = bits[target]
        plain: list[tuple[bool, Ref]] = []
        rest: list[Term] = []
        for term in operation.terms:
            same = term.variable.space not in _SAMPLED and bits[term.variable] == own
            if abs(term.number) == 1.0 and bits[term.variable] == own:
                plain.append((term.number > 0.0, term.variable))
            elif same and 0.5 <= abs(term.number) < 1.5:
                sign = math.copysign(1.0, term.number)
                plain.append((sign > 0.0, term.variable))
                rest.append(Term(term.number - sign, term.variable, f"{term.name}_rest"))
            else:
                rest.append(term)
        if not rest:
            constant = round(math.ldexp(operation.constant, own))
            error = abs(operation.constant - math.ldexp(constant, -own))
            self._round(target, error)
            return Accumulate(target, (), 0, 0, tuple(plain), constant)
        at = own + 32
        for number, variable, _ in rest:
            # the largest whole number of 31 bits for each
            at = min(at, bits[variable] + _WORD - math.frexp(abs(number))[1])
        exact = not operation.constant and all(
            abs(scaled := math.ldexp(number, own - bits[variable])) < 2.0**_WORD
            and scaled == int(scaled)
            for number, variable, _ in rest
        )
        at = own if exact else max(at, own)  # small multiples need no rounding
        products = tuple(
            Factor(round(math.ldexp(number, at - bits[variable])), variable, name,
                   at - bits[variable])
            for number, variable, name in rest
        )  # fmt: skip
        offset = round(math.ldexp(operation.constant, at))
        error = abs(operation.constant - math.ldexp(offset, -at))
        for product, (number, variable, _) in zip(products, rest, strict=True):
            off = abs(math.ldexp(product.value, bits[variable] - at) - number)
            error += off * self._reach(variable)
        integrated = target in self.integrals or any(
            target in operands(o) for q in self.integrals for o in self.by_target[q]
        )
        half = 0 if at == own else 1 << (at - own - 1) if integrated else 0
        error += 0.0 if at == own else math.ldexp(0.5 if half else 1.0, -own)
        self._round(target, error)
        return Accumulate(target, products, offset + half, at - own, tuple(plain), 0)

    def _round(self, target: Ref, error: float) -> None:
        self.rounding[target] = max(self.rounding.get(target, 0.0), error)

    # ------------------------------------------------------------------- what is proven

    def _overflowing(self, instructions: Iterable[Instruction]) -> list[Ref]:
        """The targets that a value, or a sum on its way, does not fit at its scale."""
        found: dict[Ref, None] = {}
        for ref in self._arguments:
            if self._largest(ref) > max(map(abs, self._allowed(ref))):
                raise Unrepresentable(*_TOO_ROUGH)
        for instruction in instructions:
            target = instruction.target
            if target in self.wide:
                continue
            if isinstance(instruction, Accumulate) and not self._fits(instruction):
                found[target] = None
            if self._largest(target) > min(
                self._reach(target), math.ldexp(_MOST, -self.bits[target])
            ):
                if self._largest(target) > self._reach(target):
                    raise Unrepresentable(*_TOO_ROUGH)
                found[target] = None
        return list(found)

    def _fits(self, instruction: Accumulate) -> bool:
        wide = abs(instruction.offset)
        for product in instruction.products:
            if not -_MOST <= product.value <= _MOST:
                return False
            wide += abs(product.value) * self._whole(product.variable)
        if wide >= 1 << 62:
            return False
        so_far = (wide >> instruction.shift) + 1 if instruction.products else 0
        for _, variable in instruction.plain:
            if so_far > _MOST:
                return False
            so_far += self._whole(variable)
        return so_far + abs(instruction.constant) <= _MOST

    def _whole(self, ref: Ref) -> int:
        """The largest whole number that a variable can be, both ways."""
        return min(_MOST, int(math.ldexp(self._reach(ref), self.bits[ref])) + 1)

    def _largest(self, ref: Ref) -> float:
        """The largest value, with all that rounding does to it."""
        row = self.gains[ref]
        if ("n", ref) in row:
            return max(map(abs, self._span(ref))) + math.ldexp(2.0, -self.bits[ref])
        total = max(map(abs, self._span(ref)))
        for atom, gain in row.items():
            if atom[0] == "e":
                total += gain * self.rounding.get(atom[1], 0.0)
        return total

    def deviation(self, residual: Ref) -> Deviation:
        """The scale of a residual, and how far it is from real numbers."""
        error = self._error(residual)
        return Deviation(
            self.bits[residual],
            error.fixed * _DOUBLE,
            error.hourly * _DOUBLE,
            max(map(abs, self._span(residual))),
        )

    def _error(self, ref: Ref) -> Bound:
        if ref.space in _SAMPLED:
            return _NONE
        if ref in self._errors:
            return self._errors[ref]
        row, found = self.gains[ref], _NONE
        if ("n", ref) in row:
            for operation in self.by_target[ref]:
                own = self._made_by(operation)
                found = Bound(max(found.fixed, own.fixed), max(found.hourly, own.hourly))
        else:
            for atom, gain in row.items():
                if atom[0] == "e":
                    found = found.plus(gain, Bound(self.rounding.get(atom[1], 0.0), 0.0))
                elif atom[0] == "n":
                    found = found.plus(gain, self._error(atom[1]))
                elif atom[0] == "g" and atom[1] != ref:
                    found = found.plus(gain, self._error_of_integral(atom[1]))
        self._errors[ref] = found
        return found

    def _made_by(self, operation: Operation) -> Bound:
        """The error of a function or a product of what is not exact, with its own rounding."""
        unit = Bound(math.ldexp(1.0, -self.bits[operation.target]), 0.0)
        if isinstance(operation, Linear):  # of an integral
            found = unit
            for number, variable, _ in operation.terms:
                error = self._error_of_integral(variable) if variable in self.wide else (
                    self._error(variable)
                )
                found = found.plus(abs(number), error)
            return found
        if isinstance(operation, Call):
            error = self._error(operation.argument)
            if operation.function == "near_tanh":
                return Bound(cubic_tanh.BOUND + 1e-8, 0.0).plus(1.0, error)
            if error.hourly:
                raise Unrepresentable("takes a root of an integral", operation.origin)
            return unit.plus(1.0, Bound(math.sqrt(2.0 * error.fixed), 0.0))
        left, right = self._error(operation.left), self._error(operation.right)
        if operation.what == "*":
            found = unit.plus(self._reach(operation.left), right)
            return found.plus(self._reach(operation.right), left)
        least = min(map(abs, self._allowed(operation.right)))
        found = unit.plus(1.0 / least, left)
        return found.plus(self._reach(operation.left) / least**2, right)

    def _error_of_integral(self, integral: Ref) -> Bound:
        """What the roundings of its summands sum up to, an hour at the rate of the samples."""
        if integral not in self.wide:
            each_sample = self._error(integral).fixed
            return Bound(each_sample, each_sample * 3600.0 * self.rate)
        each = [0.0, 0.0]
        for at, procedure in enumerate((self.first, self.step)):
            for operation in procedure:
                if operation.target == integral and isinstance(operation, Linear):
                    for number, variable, _ in operation.terms:
                        if variable != integral:
                            each[at] += abs(number) * self._error(variable).fixed
        return Bound(each[0], each[1] * 3600.0 * self.rate)


def _sample_bits(samples: Mapping[str, Limits]) -> dict[Ref, int]:
    """The scale of each sample; encoders are read by what they have turned."""
    return {Ref(s, n): own.bits for n, own in samples.items() for s in ("known", "increment")}


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


def _finest(reach: float) -> int:
    """The most bits behind the point at which so much fits in 31."""
    if reach <= 0.0:
        return SAMPLE_BITS
    return max(-_FINEST, min(_FINEST, _WORD - math.frexp(reach * (1.0 + 2.0**-30))[1]))


def _within(shift: int, least: int, most: int, origin: Span | None) -> int:
    if not least <= shift <= most:
        raise Unrepresentable("multiplies or divides what differs too much in size", origin)
    return shift
