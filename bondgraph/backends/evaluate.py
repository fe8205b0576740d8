"""The residual program run with 40 digits, each value with the sum of the terms it came from.

This is the reference that the self-test of the generated code compares with: an error of the
code is measured in units of that sum, because cancelling terms leave nothing else to measure by.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from decimal import Context, Decimal, localcontext
from itertools import pairwise
from typing import NamedTuple, assert_never

from bondgraph.backends.walk import integer_power
from bondgraph.ir.program import (
    Assign,
    Choice,
    Compare,
    Condition,
    Const,
    Dot,
    Expression,
    Function,
    Logic,
    Mode,
    NewtonBlock,
    PolynomialTape,
    Product,
    Program,
    Ref,
    Sum,
)
from bondgraph.passes.lowering.newton import newton, or_nan

_CONTEXT = Context(prec=40, Emax=99999, Emin=-99999)
_BUMP = 1e-7
_MANY = 100_000  # terms of a tape; more would take longer than the rest of the compiler
#: How much of the terms that it came from still counts where a value is used again.
_KEPT = {"coef": 1e-3, "state": 0.05}


class Value(NamedTuple):
    """A number and the sum of the absolute values of the terms that it was added up from."""

    number: Decimal
    size: float


#: A value by space, name and order, as in `Ref`.
Values = dict[Ref, Value]


def value(number: float | Decimal) -> Value:
    """A number that is exact."""
    return Value(Decimal(number), abs(float(number)))


class Evaluation:
    """Runs the procedures of a program; `given` holds what its statements may read.

    Raises ArithmeticError or ValueError where a law has no value.
    """

    def __init__(self, program: Program, modes: Mapping[str, bool]) -> None:
        self.modes = dict(modes)
        self._program = program
        self.given: Values = {}
        self._tables = dict(program.tables)
        self._roots = {block.name: block for block in program.roots}

    def run(self, statements: Iterable[Assign | Dot | PolynomialTape]) -> None:
        """Run a procedure; its results are in `given` afterwards."""
        with localcontext(_CONTEXT):
            for statement in statements:
                match statement:
                    case Assign():
                        found = self._value(statement.value)
                        self.given[statement.target] = _settled(statement.target, found)
                    case Dot():
                        self.given[statement.target] = self._dot(statement)
                    case PolynomialTape():
                        self._tape(statement)
                    case _:
                        assert_never(statement)

    # ---------------------------------------------------------------------- values

    def _value(self, node: Expression) -> Value:
        match node:
            case Const():
                return value(node.value)
            case Ref():
                return self.given[node]
            case Sum():
                number, size = Decimal(0), 0.0
                for positive, term in node.terms:
                    found = self._value(term)
                    number = number + found.number if positive else number - found.number
                    size += found.size
                return Value(number, size)
            case Product():
                return self._product(node.factors, node.divisors)
            case Function():
                return self._function(node)
            case Choice():
                return self._value(node.yes if self._holds(node.condition) else node.no)
            case _:
                assert_never(node)

    def _product(self, factors: tuple[Expression, ...], divisors: tuple[Expression, ...]) -> Value:
        number, size = Decimal(1), 1.0
        for factor in factors:
            found = self._value(factor)
            number *= found.number
            size *= found.size
        for divisor in divisors:
            found = self._value(divisor)
            number /= found.number
            size *= found.size / float(found.number) / float(found.number)
        return Value(number, abs(size))

    def _function(self, node: Function) -> Value:
        args = [self._value(a) for a in node.args]
        power = integer_power(node)
        if power is not None:
            result = args[0].number ** power
            wide = abs(power) * args[0].size / abs(float(args[0].number)) if power else 1.0
            return Value(result, abs(float(result)) * max(1.0, wide))
        function = self._plain(node.name)
        numbers = [float(a.number) for a in args]
        result_float = function(*numbers)
        size = abs(result_float)
        for at, arg in enumerate(args):  # how much the result moves with each argument
            moved = list(numbers)
            moved[at] -= math.copysign(_BUMP * arg.size, moved[at])
            size += abs(function(*moved) - result_float) / _BUMP
        return Value(Decimal(result_float), size)

    def _plain(self, name: str) -> Callable[..., float]:
        if name.startswith("table:"):
            points = self._tables[name.removeprefix("table:")]
            return lambda x: _interpolate(points, x)
        if name.startswith("root:"):
            block = self._roots[name.removeprefix("root:")]
            return lambda *args: self._root(block, args)
        return _FUNCTIONS[name] if name in _FUNCTIONS else getattr(math, name)

    def _root(self, block: NewtonBlock, args: tuple[float, ...]) -> float:
        inside = Evaluation(self._program, self.modes)
        inside.given = {
            Ref("local", name): value(x) for name, x in zip(block.arguments, args, strict=True)
        }

        def part(statements: tuple[Assign, ...], result: Expression) -> float:
            inside.run(statements)
            return float(inside._value(result).number)

        def look(x: float) -> tuple[float, float]:
            inside.given[Ref("local", "x")] = value(x)
            number = or_nan(lambda: part(block.body, block.value))
            return number, or_nan(lambda: part(block.further, block.slope))

        found = newton(look, block.rising, block.guess, block.most)
        if math.isnan(found):
            raise ValueError(f"no root {block.name}")
        return found

    def _dot(self, node: Dot) -> Value:
        number, size = Decimal(0), 0.0
        for term in node.terms:
            for k in range(term.length):
                factor = self.given[Ref("coef", term.array, k)]
                signal = self.given[Ref("known", term.signal, k)]
                number += factor.number * signal.number
                size += factor.size * signal.size
        return Value(number, size)

    def _tape(self, tape: PolynomialTape) -> None:
        scales = [self._value(s) for s in tape.scales]
        work = sum(op.length for op in tape.ops)
        rows = _rows(tape, scales) if work <= _MANY else _rows_in_double(tape, scales)
        for output in tape.outputs:
            for k in range(output.length):
                self.given[Ref("coef", output.array, k)] = rows[output.row][k]

    # ------------------------------------------------------------------ conditions

    def _holds(self, node: Condition) -> bool:
        match node:
            case Mode():
                return self.modes[node.name]
            case Compare():
                left, right = self._value(node.left).number, self._value(node.right).number
                if node.op == "==":
                    return left == right
                return left < right if node.op == "<" else left <= right
            case Logic():
                if node.op == "not":
                    return not self._holds(node.args[0])
                held = [self._holds(a) for a in node.args]
                return all(held) if node.op == "and" else any(held)
            case _:
                assert_never(node)


def _settled(target: Ref, found: Value) -> Value:
    """What is computed once, or decays, does not add up: its own size counts, and some of terms."""
    kept = _KEPT.get(target.space)
    if kept is None:
        return found
    return Value(found.number, abs(float(found.number)) + kept * found.size)


def _rows(tape: PolynomialTape, scales: list[Value]) -> list[list[Value]]:
    zero = Value(Decimal(0), 0.0)
    rows = [[zero] * tape.length for _ in range(tape.rows)]
    rows[0][0] = value(1.0)
    for op in tape.ops:
        if op.fresh:
            rows[op.target] = [zero] * tape.length
        row, source, scale = rows[op.target], rows[op.source], scales[op.scale]
        for k in range(op.length):
            old, new = row[k + op.shift], source[k]
            row[k + op.shift] = Value(
                old.number + scale.number * new.number, old.size + scale.size * new.size
            )
    return rows


def _rows_in_double(tape: PolynomialTape, scales: list[Value]) -> list[list[Value]]:
    """The same for millions of terms: rounded as in the generated code, operation by operation."""
    import numpy as np

    numbers = np.zeros((tape.rows, tape.length))
    sizes = np.zeros((tape.rows, tape.length))
    numbers[0, 0] = sizes[0, 0] = 1.0
    factors = [(float(s.number), s.size) for s in scales]
    for op in tape.ops:
        factor, size = factors[op.scale]
        to = slice(op.shift, op.shift + op.length)
        if op.fresh:
            numbers[op.target] = sizes[op.target] = 0.0
        numbers[op.target, to] += factor * numbers[op.source, : op.length]
        sizes[op.target, to] += size * sizes[op.source, : op.length]
    return [
        [Value(Decimal(n), s) for n, s in zip(row.tolist(), wide.tolist(), strict=True)]
        for row, wide in zip(numbers, sizes, strict=True)
    ]


def _interpolate(points: tuple[tuple[float, float], ...], x: float) -> float:
    if x <= points[0][0]:
        return points[0][1]
    for (x0, y0), (x1, y1) in pairwise(points):
        if x <= x1:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return points[-1][1]


def _sign(x: float) -> float:
    return (x > 0) - (x < 0) + 0.0


_FUNCTIONS: dict[str, Callable[..., float]] = {
    "abs": abs,
    "sign": _sign,
    "ssqrt": lambda x: math.copysign(math.sqrt(abs(x)), x),
    "ssq": lambda x: x * abs(x),
    "min": min,
    "max": max,
}
