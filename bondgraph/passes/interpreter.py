"""Residual programs run on any kind of number: the walk is written once, a number is a table."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Callable, Iterable, Mapping, Sequence
from copy import copy
from operator import itemgetter
from typing import Any, NamedTuple, assert_never

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
    integer_power,
)
from bondgraph.passes.lowering.newton import newton, or_nan

#: Anything with + - * / and comparisons: float, numpy.float32, Fraction, an array, a ball.
Real = Any
Points = Sequence[tuple[float, float]]
_X = itemgetter(0)


def interpolate(points: Points, x: Real) -> Real:
    """A table at x: straight between its points, which ascend in x, and constant beyond its ends.

    >>> interpolate(((0.0, 1.0), (2.0, 5.0)), 0.5), interpolate(((0.0, 1.0), (2.0, 5.0)), 9.0)
    (2.0, 5.0)
    """
    if x <= points[0][0]:
        return points[0][1]
    if x >= points[-1][0]:
        return points[-1][1]
    k = max(bisect_left(points, x, key=_X), 1)
    (x0, y0), (x1, y1) = points[k - 1], points[k]
    return y0 + (y1 - y0) * (x - x0) / (x1 - x0)


def _branch(holds: Any, yes: Callable[[], Real], no: Callable[[], Real]) -> Real:
    return yes() if holds else no()


#: The functions of `bondgraph.ir.expr` on doubles; some of them keep a fraction a fraction.
FUNCTIONS: dict[str, Callable[..., Any]] = {
    **{
        name: getattr(math, name)
        for name in "sqrt cbrt exp log sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh"
        " pow atan2".split()
    },
    "abs": abs,
    "min": min,
    "max": max,
    "sign": lambda x: 1 if x > 0 else -1 if x < 0 else x,
    "ssqrt": lambda x: math.copysign(math.sqrt(abs(x)), x),
    "ssq": lambda x: x * abs(x),
}


class Number(NamedTuple):
    """One kind of number: what it can do besides + - * / and comparisons.

    `real` makes one of a double, `power` takes an integer power, `choose` the value of one of two
    branches, of which the other need not have one.
    """

    real: Callable[[float], Real] = float
    functions: Mapping[str, Callable[..., Real]] = FUNCTIONS
    power: Callable[[Real, int], Real] = pow
    interpolate: Callable[[Points, Real], Real] = interpolate
    choose: Callable[[Any, Callable[[], Real], Callable[[], Real]], Real] = _branch


DOUBLES = Number()


class Interpreter:
    """Runs the procedures of a program; `values` holds what statements may read, and have written.

    Whatever a number raises where a law has no value goes to the caller.
    """

    def __init__(self, program: Program, number: Number = DOUBLES) -> None:
        self.program = program
        self.number = number
        self.values: dict[Ref, Real] = {}
        self.modes: Mapping[str, bool] = {}
        self._tables = dict(program.tables)
        self._roots = {block.name: block for block in program.roots}

    def configure(
        self, params: Mapping[str, Real] | None = None, options: Mapping[str, Real] | None = None
    ) -> None:
        """Run configure: `params` by identifier and `options` beside those that the model gives.

        Raises KeyError for a parameter that has no value.
        """
        program, real = self.program, self.number.real
        given = {f.name: real(f.default) for f in program.params if f.default is not None}
        for name, value in (given | dict(params or {})).items():
            self.values[Ref("param", name)] = value
        own = {
            "sample_time": real(1.0 / program.rate),
            "bandwidth": real(program.bandwidth),
            "time_unit": real(program.time_unit),
        }
        for name, value in (own | dict(options or {})).items():
            self.values[Ref("option", name)] = value
        self.run(program.configure)

    def run(self, statements: Iterable[Assign | Dot | PolynomialTape]) -> None:
        """Run a procedure, or a part of it."""
        for statement in statements:
            match statement:
                case Assign():
                    self.put(statement.target, self._value(statement.value))
                case Dot():
                    self.put(statement.target, self._dot(statement))
                case PolynomialTape():
                    rows = self._rows(statement, [self._value(s) for s in statement.scales])
                    for output in statement.outputs:
                        for k in range(output.length):
                            self.values[Ref("coef", output.array, k)] = rows[output.row][k]
                case _:
                    assert_never(statement)

    def put(self, target: Ref, value: Real) -> None:
        """Keep what a statement has computed."""
        self.values[target] = value

    def _dot(self, dot: Dot) -> Real:
        value = self.number.real(0.0)
        for term in dot.terms:
            for k in range(term.length):
                factor = self.values[Ref("coef", term.array, k)]
                value = value + factor * self.values[Ref("known", term.signal, k)]
        return value

    def _rows(self, tape: PolynomialTape, scales: list[Real]) -> Sequence[Sequence[Real]]:
        zero = self.number.real(0.0)
        rows = [[zero] * tape.length for _ in range(tape.rows)]
        rows[0][0] = self.number.real(1.0)
        for op in tape.ops:
            if op.fresh:
                rows[op.target] = [zero] * tape.length
            target, source, scale = rows[op.target], rows[op.source], scales[op.scale]
            for k in range(op.length):
                target[k + op.shift] = target[k + op.shift] + scale * source[k]
        return rows

    # ------------------------------------------------------------------------- values

    def _value(self, node: Expression) -> Real:
        match node:
            case Ref():
                return self.values[node]
            case Const():
                return self.number.real(node.value)
            case Sum():
                total: Real = None
                for positive, term in node.terms:
                    x = self._value(term)
                    if total is None:
                        total = x if positive else -x
                    else:
                        total = total + x if positive else total - x
                return self.number.real(0.0) if total is None else total
            case Product():
                product = self._value(node.factors[0])
                for factor in node.factors[1:]:
                    product = product * self._value(factor)
                for divisor in node.divisors:
                    product = product / self._value(divisor)
                return product
            case Function():
                return self._function(node)
            case Choice():
                return self.number.choose(
                    self._holds(node.condition),
                    lambda: self._value(node.yes),
                    lambda: self._value(node.no),
                )
        assert_never(node)

    def _function(self, node: Function) -> Real:
        args = [self._value(a) for a in node.args]
        kind, _, name = node.name.partition(":")
        if kind == "table":
            return self.number.interpolate(self._tables[name], args[0])
        if kind == "root":
            return self._root(self._roots[name], args)
        power = integer_power(node)
        if power is not None:
            return self.number.power(args[0], power)
        return self.number.functions[node.name](*args)

    def _holds(self, node: Condition) -> Any:
        """Whether a condition holds: a truth value, or an array of them."""
        match node:
            case Mode():
                return self.modes[node.name]
            case Compare():
                left, right = self._value(node.left), self._value(node.right)
                if node.op == "==":
                    return left == right
                return left < right if node.op == "<" else left <= right
            case Logic():
                first, *rest = [self._holds(a) for a in node.args]
                if node.op == "not":
                    return first ^ True
                for other in rest:
                    first = first & other if node.op == "and" else first | other
                return first
        assert_never(node)

    def _root(self, block: NewtonBlock, args: Sequence[Real]) -> Real:
        """Newton's method of a block, as generated code does it."""
        inside = copy(self)
        inside.values = {
            Ref("local", name): x for name, x in zip(block.arguments, args, strict=True)
        }

        def part(statements: tuple[Assign, ...], value: Expression) -> float:
            inside.run(statements)
            return float(inside._value(value))

        def look(x: float) -> tuple[float, float]:
            inside.values[Ref("local", "x")] = self.number.real(x)
            value = or_nan(lambda: part(block.body, block.value))
            return value, or_nan(lambda: part(block.further, block.slope))

        return self.number.real(newton(look, block.rising, block.guess, block.most))
