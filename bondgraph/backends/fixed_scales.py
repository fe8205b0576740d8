"""The scale of each value of a block, the finest at which it and every sum on its way fits.

Scales are powers of two, and values that are added as they are have one.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

from bondgraph.algebra import cubic_tanh
from bondgraph.backends.fixed_ranges import SAMPLED, Ranges
from bondgraph.backends.straight_line import (
    Call,
    Linear,
    Operation,
    Term,
    Unrepresentable,
    operands,
)
from bondgraph.ir.fixed_program import (
    SAMPLE_BITS,
    Accumulate,
    Count,
    Divide,
    Explained,
    Factor,
    FixedBlock,
    Guard,
    Instruction,
    Limits,
    Multiply,
    Sigmoid,
    SignedRoot,
    Window,
)
from bondgraph.ir.groups import Groups
from bondgraph.ir.program import Ref
from bondgraph.text.source import Span

_WORD = 31
_MOST = (1 << _WORD) - 1  # of a whole number of 32 bits
_WIDE = 61  # bits of an integral of 64 beside its sign, less room for a step
_FINEST = 60
_SMALL = 2.0**-16  # of the largest range of those that have one scale, room for errors in each
_TRIES = 12
_TOO_ROUGH = (
    "loses more by rounding than its range leaves room for",
    None,
    "A wider filter (`--bandwidth`) remembers less.",
)


class Scales:
    """Scales of one block, and its instructions.

    `bits` behind the point by value, `rounding` what each sum loses at most; both are those of the
    last `block`.
    """

    def __init__(self, ranges: Ranges) -> None:
        self._ranges = ranges
        self._arguments = {
            ref
            for o in ranges.operations
            if not isinstance(o, Linear)
            for ref in operands(o)
            if ref in ranges.gains
        }
        self._groups = self._joined()
        self.bits: dict[Ref, int] = {}
        self.rounding: dict[Ref, float] = {}
        self._lowered: dict[Ref, int] = {}

    def block(self) -> FixedBlock:
        """The block in whole numbers."""
        own = self._ranges
        for ref in own.by_target:
            if ref not in own.wide:
                own.span(ref)
        for _ in range(_TRIES):
            self._scale()
            self.rounding = {}
            done = [[self._explained(o) for o in p] for p in (own.first, own.step)]
            too_fine = self._overflowing(i.instruction for p in done for i in p)
            if not too_fine:
                break
            for ref in too_fine:
                root = self._groups.find(ref)
                self._lowered[root] = self._lowered.get(root, 0) + 1
        else:
            raise Unrepresentable("has sums that no scale keeps from overflow")
        return FixedBlock(
            own.of.name,
            own.of.residuals,
            own.of.knowns,
            own.of.states,
            tuple(done[0]),
            tuple(done[1]),
            tuple(
                Guard(q, self._guard(q), q in own.wide) for q in own.states if q in own.integrals
            ),
        )

    def _guard(self, integral: Ref) -> int:
        limit = self._ranges.limit(integral)
        if limit is None:
            return 1 << _WIDE
        return min(1 << _WIDE, int(math.ldexp(limit, self.bits[integral])))

    def _explained(self, operation: Operation) -> Explained:
        return Explained(self._instruction(operation), operation.comment, operation.origin)

    def _instruction(self, operation: Operation) -> Instruction:
        bits, target = self.bits, operation.target
        if isinstance(operation, Linear):
            wide = self._ranges.read_integrals(operation)
            if not wide and target not in self._ranges.wide:
                return self._accumulated(operation)
            counts = tuple((int(t.number), t.variable) for t in operation.terms)
            if len({bits[ref] for _, ref in counts}) > 1:
                raise Unrepresentable("integrates a sample as it comes", operation.origin)
            if target in self._ranges.wide:
                return Count(target, counts)
            shift = bits[wide[0]] - bits[target]
            limit = int(math.ldexp(self._ranges.window(operation), bits[wide[0]]))
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
            same = term.variable.space not in SAMPLED and bits[term.variable] == own
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
            error += off * self._ranges.reach(variable)
        integrals, by_target = self._ranges.integrals, self._ranges.by_target
        integrated = target in integrals or any(
            target in operands(o) for q in integrals for o in by_target[q]
        )
        half = 0 if at == own else 1 << (at - own - 1) if integrated else 0
        error += 0.0 if at == own else math.ldexp(0.5 if half else 1.0, -own)
        self._round(target, error)
        return Accumulate(target, products, offset + half, at - own, tuple(plain), 0)

    def _round(self, target: Ref, error: float) -> None:
        self.rounding[target] = max(self.rounding.get(target, 0.0), error)

    def _joined(self) -> Groups[Ref]:
        """The values that are added as they are, and so have one scale."""
        groups = Groups[Ref]()
        for operation in self._ranges.operations:
            if not isinstance(operation, Linear):
                continue
            target = operation.target
            if self._ranges.read_integrals(operation):
                ends = [t.variable for t in operation.terms]
            elif target in self._ranges.wide:
                ends = [target, *(t.variable for t in operation.terms)]
            elif self._own_scale(target):
                ends = []
            else:
                ends = [target, *(t.variable for t in operation.terms if abs(t.number) == 1.0)]
            ends = [e for e in ends if e.space not in SAMPLED and not self._own_scale(e)]
            for end in ends[1:]:
                groups.join(ends[0], end)
        return groups

    def _own_scale(self, ref: Ref) -> bool:
        """Whether a value has a scale of its own: one that no sum made."""
        return any(
            not isinstance(o, Linear) or bool(self._ranges.read_integrals(o))
            for o in self._ranges.by_target.get(ref, ())
        )

    def _scale(self) -> None:
        """The finest scale of each group at which all its values fit."""
        members: dict[Ref, list[Ref]] = {}
        for ref in self._ranges.by_target:
            members.setdefault(self._groups.find(ref), []).append(ref)
        takes = {
            o.argument
            for o in self._ranges.operations
            if isinstance(o, Call) and o.function == "near_tanh"
        }
        self.bits = sample_bits(self._ranges.samples)
        widest: dict[Ref, int] = {}  # what 64 bits have room for
        for operation in self._ranges.operations:
            for integral in self._ranges.read_integrals(operation):
                assert isinstance(operation, Linear)
                room = _WIDE - math.frexp(self._ranges.window(operation))[1]
                root = self._groups.find(integral)
                widest[root] = min(widest.get(root, room), room)
        for root, refs in members.items():
            whole = [r for r in refs if r not in self._ranges.wide]
            spans = [max(map(abs, self._ranges.span(r))) for r in whole]
            if len(spans) > 1:  # what is small beside the others has their roundings
                self._ranges.make_room(refs, _SMALL * max(spans))
            own = [_finest(self._ranges.reach(r)) for r in whole]
            found = min([*own, widest.get(root, _FINEST)]) - self._lowered.get(root, 0)
            for ref in refs:
                self.bits[ref] = found
        for ref in takes:
            self.bits[ref] = min(self.bits[ref], cubic_tanh.MOST_BITS - 1)
        for operation in self._ranges.operations:
            if isinstance(operation, Call) and operation.function == "near_tanh":
                self.bits[operation.target] = cubic_tanh.BITS
            for integral in self._ranges.read_integrals(operation):
                finest = self.bits[operation.target], self.bits[integral]
                self.bits[operation.target] = min(finest)

    def _overflowing(self, instructions: Iterable[Instruction]) -> list[Ref]:
        """The targets that a value, or a sum on its way, does not fit at its scale."""
        found: dict[Ref, None] = {}
        for ref in self._arguments:
            if self._largest(ref) > max(map(abs, self._ranges.allowed(ref))):
                raise Unrepresentable(*_TOO_ROUGH)
        for instruction in instructions:
            target = instruction.target
            if target in self._ranges.wide:
                continue
            if isinstance(instruction, Accumulate) and not self._fits(instruction):
                found[target] = None
            if self._largest(target) > min(
                self._ranges.reach(target), math.ldexp(_MOST, -self.bits[target])
            ):
                if self._largest(target) > self._ranges.reach(target):
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
        return min(_MOST, int(math.ldexp(self._ranges.reach(ref), self.bits[ref])) + 1)

    def _largest(self, ref: Ref) -> float:
        """The largest value, with all that rounding does to it."""
        row = self._ranges.gains[ref]
        if ("n", ref) in row:
            return max(map(abs, self._ranges.span(ref))) + math.ldexp(2.0, -self.bits[ref])
        total = max(map(abs, self._ranges.span(ref)))
        for atom, gain in row.items():
            if atom[0] == "e":
                total += gain * self.rounding.get(atom[1], 0.0)
        return total


def sample_bits(samples: Mapping[str, Limits]) -> dict[Ref, int]:
    """The scale of each sample; encoders are read by what they have turned."""
    return {Ref(s, n): own.bits for n, own in samples.items() for s in ("known", "increment")}


def _finest(reach: float) -> int:
    """The most bits behind the point at which so much fits in 31."""
    if reach <= 0.0:
        return SAMPLE_BITS
    return max(-_FINEST, min(_FINEST, _WORD - math.frexp(reach * (1.0 + 2.0**-30))[1]))


def _within(shift: int, least: int, most: int, origin: Span | None) -> int:
    if not least <= shift <= most:
        raise Unrepresentable("multiplies or divides what differs too much in size", origin)
    return shift
