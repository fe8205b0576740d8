"""The residual program run with 40 digits, each value with the sum of the terms it came from.

This is the reference that the self-test of the generated code compares with: an error of the
code is measured in units of that sum, because cancelling terms leave nothing else to measure by.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from decimal import Context, Decimal, localcontext
from functools import partial

from bondgraph.algebra.interpolation import interpolation
from bondgraph.algebra.interpreter import Interpreter, Number
from bondgraph.algebra.numeric import DOUBLES
from bondgraph.ir.program import NewtonBlock, PolynomialTape, Program, Ref, Statement

_CONTEXT = Context(prec=40, Emax=99999, Emin=-99999)
_BUMP = 1e-7
_MANY = 100_000  # terms of a tape; more would take longer than the rest of the compiler
#: How much of the terms that it came from still counts where a value is used again.
_KEPT = {"coef": 1e-3, "state": 0.05}


class Value:
    """A number and the sum of the absolute values of the terms that it was added up from."""

    __slots__ = ("number", "size")

    def __init__(self, number: Decimal, size: float) -> None:
        self.number = number
        self.size = size

    def __float__(self) -> float:
        return float(self.number)

    def __neg__(self) -> Value:
        return Value(-self.number, self.size)

    def __add__(self, other: Value) -> Value:
        return Value(self.number + other.number, self.size + other.size)

    def __sub__(self, other: Value) -> Value:
        return Value(self.number - other.number, self.size + other.size)

    def __mul__(self, other: Value) -> Value:
        return Value(self.number * other.number, self.size * other.size)

    def __truediv__(self, other: Value) -> Value:
        divisor = abs(float(other))
        size = self.size * (other.size / divisor / divisor)
        return Value(self.number / other.number, size)

    def __pow__(self, exponent: int) -> Value:
        result = self.number**exponent
        slope = abs(exponent) * abs(float(self)) ** (exponent - 1) if exponent else 0.0
        return Value(result, max(abs(float(result)), slope * self.size))

    def __lt__(self, other: Value) -> bool:
        return self.number < other.number

    def __le__(self, other: Value) -> bool:
        return self.number <= other.number

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Value) and self.number == other.number


def value(number: float | Decimal) -> Value:
    """A number that is exact; raises ValueError for NaN."""
    if math.isnan(number):
        raise ValueError("not a number")
    return Value(_CONTEXT.create_decimal(number), abs(float(number)))


def _in_double(function: Callable[..., float], *args: Value) -> Value:
    """A function of doubles, with how much its result moves with each argument."""
    numbers = [float(a) for a in args]
    result = float(function(*numbers))
    size = abs(result)
    for at, arg in enumerate(args):
        size += _moved(function, numbers, result, at, arg.size)
    return Value(value(result).number, size)


def _moved(
    function: Callable[..., float], numbers: list[float], result: float, at: int, size: float
) -> float:
    """How much a result moves with one argument, on the side where the function has a value."""
    bump = math.copysign(_BUMP * size, numbers[at])
    for step in (-bump, bump):
        moved = [*numbers[:at], numbers[at] + step, *numbers[at + 1 :]]
        try:
            return abs(function(*moved) - result) / _BUMP
        except (ArithmeticError, ValueError):  # it ends here: a root of what is nearly nothing
            continue
    return 0.0


_SIZED = Number(
    value,
    {name: partial(_in_double, function) for name, function in DOUBLES.items()},
    table=lambda rows, backwards: partial(_in_double, interpolation(rows, backwards)),
)


class Evaluation(Interpreter):
    """Runs the procedures of a program on values with sizes; see `Interpreter`.

    Raises ArithmeticError or ValueError where a law has no value.
    """

    def __init__(self, program: Program) -> None:
        super().__init__(program, _SIZED)
        self._double = Interpreter(program)  # roots are looked for in doubles first

    def run(self, statements: Iterable[Statement]) -> None:
        """Run a procedure with 40 digits."""
        with localcontext(_CONTEXT):
            super().run(statements)

    def put(self, target: Ref, found: Value) -> None:
        """What is computed once, or decays, does not add up: its own size counts, and some of
        terms."""
        kept = _KEPT.get(target.space)
        if kept is not None:
            found = Value(found.number, abs(float(found)) + kept * found.size)
        self.values[target] = found

    def _root(self, block: NewtonBlock, args: Sequence[Value]) -> Value:
        found = _in_double(lambda *xs: float(self._double._root(block, xs)), *args)
        near = block._replace(guess=float(found.number))
        return Value(super()._root(near, [value(float(a)) for a in args]).number, found.size)

    def _rows(self, tape: PolynomialTape, scales: list[Value]) -> Sequence[Sequence[Value]]:
        if sum(op.length for op in tape.ops) <= _MANY:
            return super()._rows(tape, scales)
        return _rows_in_double(tape, scales)


def _rows_in_double(tape: PolynomialTape, scales: list[Value]) -> list[list[Value]]:
    """The same for millions of terms: rounded as in the generated code, operation by operation."""
    import numpy as np

    table = np.zeros((tape.rows, 2, tape.length))  # numbers, and beside them their sizes
    table[0, :, 0] = 1.0
    rows = list(table)
    factors = [np.array([[float(s)], [s.size]]) for s in scales]
    for target, source, shift, scale, length, fresh in tape.ops:
        if fresh:
            rows[target].fill(0.0)
        rows[target][:, shift : shift + length] += factors[scale] * rows[source][:, :length]
    found: list[list[Value]] = [[] for _ in range(tape.rows)]
    for row in {out.row for out in tape.outputs}:
        found[row] = [Value(Decimal(n), size) for n, size in zip(*rows[row].tolist(), strict=True)]
    return found
