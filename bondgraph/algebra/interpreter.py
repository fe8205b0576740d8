"""Residual programs on any kind of number: the walk is written once, a number is a table."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from copy import copy
from functools import partial
from typing import Any, NamedTuple, assert_never

from bondgraph.algebra.interpolation import Points, interpolation
from bondgraph.algebra.near import near_tanh
from bondgraph.algebra.numeric import DOUBLES
from bondgraph.ir.program import (
    Assign,
    Assignment,
    Branch,
    Choice,
    Compare,
    Condition,
    Const,
    Dot,
    Expression,
    First,
    Function,
    Logic,
    Mode,
    NewtonBlock,
    PolynomialTape,
    Product,
    Program,
    Ref,
    Statement,
    Sum,
    integer_power,
)
from bondgraph.ir.tables import backwards

#: Anything with + - * / and comparisons: float, numpy.float32, Fraction, an array, a ball.
Real = Any
#: A bracket this narrow, next to the widest step, ends the search: at a jump across zero.
_NARROW = 1e-36


def _branch(holds: Any, yes: Callable[[], Real], no: Callable[[], Real]) -> Real:
    return yes() if holds else no()


class Number(NamedTuple):
    """One kind of number: what it can do besides + - * / and comparisons.

    `real` makes one of a double, `power` takes an integer power, `choose` the value of one of two
    branches, of which the other need not have one.
    """

    real: Callable[[float], Real] = float
    functions: Mapping[str, Callable[..., Real]] = DOUBLES
    power: Callable[[Real, int], Real] = pow
    table: Callable[[Points, bool], Callable[..., Real]] = interpolation
    choose: Callable[[Any, Callable[[], Real], Callable[[], Real]], Real] = _branch


DOUBLE = Number()


class Interpreter:
    """Runs the procedures of a program; `values` holds what statements may read, and have written.

    Whatever a number raises where a law has no value goes to the caller.
    """

    def __init__(self, program: Program, number: Number = DOUBLE) -> None:
        self.program = program
        self.number = number
        self.values: dict[Ref, Real] = {}
        self.modes: Mapping[str, bool] = {}
        self._tables = {n: number.table(rows, backwards(n)) for n, rows in program.tables}
        self._roots = {block.name: block for block in program.roots}
        self._constants: dict[float, Real] = {}

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

    def run(self, statements: Iterable[Statement]) -> None:
        """Run a procedure, or a part of it."""
        for statement in statements:
            match statement:
                case Assign():
                    self.put(statement.target, self._value(statement.value))
                case Branch(target, (condition, x, y), yes, no):
                    sides = partial(self._after, yes, x), partial(self._after, no, y)
                    self.put(target, self.number.choose(self._holds(condition), *sides))
                case Dot():
                    self.put(statement.target, self._dot(statement))
                case PolynomialTape():
                    rows = self._rows(statement, [self._value(s) for s in statement.scales])
                    for output in statement.outputs:
                        for k in range(output.length):
                            self.values[Ref("coef", output.array, k)] = rows[output.row][k]
                case _:
                    assert_never(statement)

    def _after(self, statements: tuple[Assignment, ...], value: Expression) -> Real:
        self.run(statements)
        return self._value(value)

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
            case Product():
                product = self._value(node.factors[0])
                for factor in node.factors[1:]:
                    product = product * self._value(factor)
                for divisor in node.divisors:
                    product = product / self._value(divisor)
                return product
            case Sum():
                total: Real = None
                for positive, term in node.terms:
                    x = self._value(term)
                    if total is None:
                        total = x if positive else -x
                    else:
                        total = total + x if positive else total - x
                return self.number.real(0.0) if total is None else total
            case Const():
                found = self._constants.get(node.value)
                if found is None:
                    found = self.number.real(node.value)
                    if node.value:  # zeros of either sign are equal
                        self._constants[node.value] = found
                return found
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
            return self._tables[name](*args)
        if kind == "root":
            return self._root(self._roots[name], args)
        power = integer_power(node)
        if power is not None:
            return self.number.power(args[0], power)
        if node.name == "near_tanh":
            return near_tanh(args[0], self.number.real, self.number.choose)
        return self.number.functions[node.name](*args)

    def _holds(self, node: Condition) -> Any:
        """Whether a condition holds: a truth value, or an array of them."""
        match node:
            case Mode():
                return self.modes[node.name]
            case First():
                raise ValueError("what runs first has a procedure of its own")
            case Compare():
                left, right = self._value(node.left), self._value(node.right)
                if node.op == "==":
                    return left == right
                return left < right if node.op == "<" else left <= right
            case Logic():
                found = self._holds(node.args[0])
                if node.op == "not":
                    return found ^ True
                whole, choose = node.op == "and", self.number.choose
                for arg in node.args[1:]:
                    further = partial(self._holds, arg)
                    found = (
                        choose(found, further, lambda: False)
                        if whole
                        else choose(found, lambda: True, further)
                    )
                return found
        assert_never(node)

    def _root(self, block: NewtonBlock, args: Sequence[Real]) -> Real:
        """Newton's method of a block, as generated code does it."""
        inside = copy(self)
        inside.values = {
            Ref("local", name): x for name, x in zip(block.arguments, args, strict=True)
        }

        def part(statements: tuple[Assignment, ...], value: Expression) -> float:
            return float(inside._after(statements, value))

        def look(x: float) -> tuple[float, float]:
            inside.values[Ref("local", "x")] = self.number.real(x)
            value = or_nan(lambda: part(block.body, block.value))
            return value, or_nan(lambda: part(block.further, block.slope))

        return self.number.real(newton(look, block.rising, block.guess, block.most))


def newton(
    look: Callable[[float], tuple[float, float]], rising: bool, guess: float, most: int
) -> float:
    """The zero of a function that grows (or falls) everywhere; NaN if `most` steps find none.

    `look(x)` gives value and slope, NaN where there is none; a value that is NaN sends the search
    back towards the guess. A step of Newton that leaves the bracket, or does not halve the value,
    is replaced by a bisection, or while one side is open by a step twice as wide as the last
    (Press et al., Numerical Recipes, 2007, section 9.4). Where the function jumps across zero, the
    jump is the answer: friction that stands still.

    >>> round(newton(lambda x: (x**3 + x - 10, 3 * x**2 + 1), True, 0.0, 200), 12)
    2.0
    """
    x, low, high, wide, last = guess, -math.inf, math.inf, 1.0, math.inf
    for _ in range(most):
        value, slope = look(x)
        if value == 0.0:
            return x
        up = x > guess if math.isnan(value) else (value > 0.0) == rising
        low, high = (low, x) if up else (x, high)
        after = x - value / slope if slope and math.isfinite(slope) else math.nan
        slow = not abs(value) <= 0.5 * last
        if not low < after < high or (slow and math.isfinite(low) and math.isfinite(high)):
            if math.isfinite(low) and math.isfinite(high):
                after = low + 0.5 * (high - low)
            else:
                after = x - wide if up else x + wide
                wide *= 2.0
        last = abs(value)
        if x + 0.125 * (after - x) == x or high - low <= _NARROW * wide:
            return after
        x = after
    return math.nan


def or_nan(compute: Callable[[], float]) -> float:
    """A number, or NaN where there is none."""
    try:
        return compute()
    except (ArithmeticError, ValueError):
        return math.nan
