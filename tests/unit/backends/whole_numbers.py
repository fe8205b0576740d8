"""A program in whole numbers run in Python, and its C; and the same samples in real numbers."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

from bondgraph.algebra.cubic_tanh import cubic_tanh
from bondgraph.algebra.interpreter import Interpreter
from bondgraph.backends.blocks import blocks
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import load
from bondgraph.ir.fixed_program import (
    Accumulate,
    Count,
    Divide,
    FixedProgram,
    Instruction,
    Multiply,
    Sigmoid,
    SignedRoot,
    Window,
)
from bondgraph.ir.program import Program, Ref
from tests.unit.backends.compilers import WARNINGS, compiler, run

WORD = 2**31
SANITIZED = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all")


class Whole:
    """The step of a program in whole numbers, as its instructions say; asserts what is proven."""

    def __init__(self, fixed: FixedProgram) -> None:
        self.fixed = fixed
        self.values: dict[Ref, int] = {}
        self.counted = {k.name for k in fixed.program.knowns if k.counts is not None}
        self.last: dict[tuple[int, str], int] = {}
        self.age = [0] * len(fixed.blocks)
        self.wide = {g.state for b in fixed.blocks for g in b.guards if g.wide}

    def step(self, samples: Mapping[str, int]) -> dict[str, tuple[int, bool]]:
        """By residual its value and whether it is valid; a sample by name."""
        fixed, found = self.fixed, {}
        held = {n: self._held(n, x) for n, x in samples.items() if n not in self.counted}
        settle = {r.name: s for r, s in zip(fixed.program.residuals, fixed.settle, strict=True)}
        for at, block in enumerate(fixed.blocks):
            self.values |= {Ref("known", n): x for n, x in held.items()}
            good = all(held[n] == samples[n] for n in block.knowns if n not in self.counted)
            for n in self.counted & set(block.knowns):
                turned = samples[n] - self.last.get((at, n), 0) if self.age[at] else 0
                turned = (turned + WORD) % (2 * WORD) - WORD
                self.last[at, n] = samples[n]
                scaled = self._held(n, turned) << fixed.samples[n].bits
                self.values[Ref("increment", n)] = scaled
                good = good and turned == self._held(n, turned)
            for explained in block.step if self.age[at] else block.first:
                target = explained.instruction.target
                value = self._value(explained.instruction)
                assert abs(value) < (2**63 if target in self.wide else WORD), target
                self.values[target] = value
            good = good and all(abs(self.values[g.state]) <= g.limit for g in block.guards)
            self.age[at] = self.age[at] + 1 if good else 0
            for name in block.residuals:
                value, wait = self.values[Ref("residual", name)], settle[name]
                assert wait is not None
                found[name] = (value if good else 0, self.age[at] > wait)
        return found

    def _held(self, name: str, value: int) -> int:
        own = self.fixed.samples.get(name)
        return value if own is None else min(max(value, own.least), own.most)

    def _value(self, one: Instruction) -> int:
        of = self.values
        match one:
            case Accumulate():
                total = one.offset + sum(p.value * of[p.variable] for p in one.products)
                assert abs(total) < 2**63
                total >>= one.shift
                for positive, ref in (*one.plain, (True, None)):
                    assert abs(total) < WORD, one.target
                    total += 0 if ref is None else of[ref] if positive else -of[ref]
                return total + one.constant
            case Count(_, terms):
                return sum(n * of[ref] for n, ref in terms)
            case Window(_, terms, limit, shift):
                return min(max(sum(n * of[ref] for n, ref in terms), -limit), limit) >> shift
            case Multiply(_, left, right, shift):
                return of[left] * of[right] >> shift
            case Divide(_, above, below, shift):
                return math.trunc(Fraction(of[above] << shift, of[below]))
            case SignedRoot(_, argument, shift):
                root = math.isqrt(abs(of[argument]) << shift)
                return -root if of[argument] < 0 else root
            case Sigmoid(_, argument, bits):
                return cubic_tanh(of[argument], bits)


class InC:
    """The generated C in whole numbers, sanitized."""

    def __init__(self, fixed: FixedProgram, folder: Path, stem: str) -> None:
        self.fixed, self.stem = fixed, stem
        library = folder / "fixed.so"
        options = ("-O1", *WARNINGS, "-fsanitize=undefined", "-fno-sanitize-recover=all")
        files = ("-shared", "-fPIC", "-o", library, f"{stem}.c")
        run(*compiler("gcc"), *options, "-static-libubsan", *files, cwd=folder)
        self.library = ctypes.CDLL(str(library))
        spelling, program = Spelling(fixed.program, load("c")), fixed.program
        self.names = {k.name: spelling.knowns[k.name] for k in program.knowns}
        count = len(program.residuals)
        self.Samples: Any = type("Samples", (ctypes.Structure,), {
            "_fields_": [(name, ctypes.c_int32) for name in self.names.values()]})  # fmt: skip
        self.Residuals: Any = type("Residuals", (ctypes.Structure,), {
            "_fields_": [("value", ctypes.c_int32 * count), ("valid", ctypes.c_bool * count)]
        })  # fmt: skip
        self.memory = ctypes.create_string_buffer(1 << 16)
        self.coefficients = ctypes.c_char.in_dll(
            self.library, f"{stem}_nominal_coefficients"
        )
        self.reset()

    def reset(self) -> None:
        """Forget all samples."""
        getattr(self.library, f"{self.stem}_reset")(self.memory)

    def step(self, samples: Mapping[str, int]) -> dict[str, tuple[int, bool]]:
        """By residual its value and whether it is valid."""
        given = self.Samples(**{self.names[n]: x for n, x in samples.items()})
        out = self.Residuals()
        function = getattr(self.library, f"{self.stem}_step")
        function(
            ctypes.byref(self.coefficients), self.memory, ctypes.byref(given), ctypes.byref(out)
        )
        names = [r.name for r in self.fixed.program.residuals]
        return {n: (out.value[k], out.valid[k]) for k, n in enumerate(names)}


class Real:
    """The same step in double, from `Program.first` and `Program.step` themselves."""

    def __init__(self, program: Program) -> None:
        self.program = program
        self.blocks = blocks(program)
        self.runs = [Interpreter(program) for _ in self.blocks]
        for one in self.runs:
            one.configure()
        self.begun = [False] * len(self.blocks)
        self.last: dict[str, float] = {}

    def step(self, samples: Mapping[str, float]) -> dict[str, float]:
        """By residual its value."""
        found = {}
        for at, (block, one) in enumerate(zip(self.blocks, self.runs, strict=True)):
            one.values |= {Ref("known", n): x for n, x in samples.items()}
            for n, x in samples.items():
                step = x - self.last[n] if self.begun[at] else 0.0
                one.values[Ref("increment", n)] = step
            one.run(block.step if self.begun[at] else block.first)
            found |= {r: float(one.values[Ref("residual", r)]) for r in block.residuals}
            self.begun[at] = True
        self.last = dict(samples)
        return found


def rows(fixed: FixedProgram, count: int, seed: int) -> Iterator[dict[str, int]]:
    """Samples within their limits: at rest, at their ends, in jumps, and as they come.

    Of an encoder that is what it turns; it has the sum of that.
    """
    sums = {k.name: 0 for k in fixed.program.knowns if k.counts is not None}
    for row in _rows(fixed, count, seed):
        sums = {n: total + row[n] for n, total in sums.items()}
        yield row | sums


def _rows(fixed: FixedProgram, count: int, seed: int) -> Iterator[dict[str, int]]:
    import random

    draw = random.Random(seed)
    samples = fixed.samples.items()
    hold = {n: 0 for n, _ in samples}
    kind = 0
    for k in range(count):
        if k % 97 == 0:
            kind = draw.randrange(4)
            hold = {n: draw.choice((own.least, own.most)) for n, own in samples}
            if kind == 1:
                hold = {n: draw.randint(own.least, own.most) for n, own in samples}
        if kind == 2:
            hold = {n: draw.choice((own.least, own.most)) for n, own in samples}
        if kind == 3:
            hold = {n: draw.randint(own.least, own.most) for n, own in samples}
        yield hold


def largest_error(
    fixed: FixedProgram, given: Sequence[Mapping[str, int]]
) -> dict[str, float]:
    """By residual how far whole numbers are from double, over rows that are within limits."""
    whole, real = Whole(fixed), Real(fixed.program)
    worst = dict.fromkeys(fixed.residuals, 0.0)
    for row in given:
        exact = {
            n: x if n in whole.counted else math.ldexp(x, -fixed.samples[n].bits)
            for n, x in row.items()
        }
        wanted, found = real.step(exact), whole.step(row)
        real.begun = [age > 0 for age in whole.age]  # an integral may have run away
        for name in (n for b, on in zip(fixed.blocks, real.begun, strict=True) if on
                     for n in b.residuals):  # fmt: skip
            value, own = found[name][0], fixed.residuals[name]
            worst[name] = max(worst[name], abs(math.ldexp(value, -own.bits) - wanted[name]))
    return worst
