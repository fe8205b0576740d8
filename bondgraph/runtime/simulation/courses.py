"""Signals over time as functions, with their derivatives and the moments at which they jump."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable

from bondgraph.algebra.derivative import Jets
from bondgraph.algebra.interpolation import interpolation
from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological
from bondgraph.ir.functions import FUNCTIONS
from bondgraph.ir.tables import knots
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation.code import Code
from bondgraph.runtime.simulation.parameters import Values
from bondgraph.runtime.simulation.scenario import Course

TIME = "t"
_MANY = 200  # points of a recording, rather than of a table that a person wrote


def time_symbol(pool: Pool) -> Expr:
    """The symbol that stands for time in the expressions of a scenario."""
    return pool.symbol(TIME, Kind.INPUT)


def function(
    course: Course, pool: Pool, values: Values, order: int = 0
) -> Callable[[float], float]:
    """The course, or its derivative of some order, as a function of time in s; NaN where undefined.

    Raises KeyError with the name of a parameter that has no value.
    """
    if course.expr is None:
        return _through(course, order)
    time = time_symbol(pool)
    expr = derived(course.expr, pool, order)
    number = values.constant(expr)
    if number is not None:
        return lambda _: number
    for node in topological([expr]):
        if node.op is Op.SYM and node is not time:
            values.number(node)  # says which one has no value
    code = Code(pool, {time: "t"}, values.constant)
    found = code.function("course", "t", *code.text([expr]))

    def defined(t: float) -> float:
        try:
            return float(found(t))
        except (ArithmeticError, ValueError):
            return math.nan

    return defined


def derived(expr: Expr, pool: Pool, order: int) -> Expr:
    """The derivative by time of an expression of `t`, of some order."""
    time = time_symbol(pool)
    expr = Jets(pool).of(expr, order)
    rates = {pool.der(time): pool.one}
    for _ in range(order):
        rates[pool.der(next(reversed(rates)))] = pool.zero
    return pool.substitute([expr], rates)[0]


def _through(course: Course, order: int) -> Callable[[float], float]:
    xs = [p[0] for p in course.points]
    ys = [p[1] for p in course.points]
    if len(ys) == 1:
        only = 0.0 if order else ys[0]
        return lambda _: only

    def held(t: float) -> float:
        return ys[max(bisect_right(xs, t) - 1, 0)]

    def slope(t: float) -> float:
        k = bisect_right(xs, t)
        if k == 0 or k == len(xs):
            return 0.0
        return (ys[k] - ys[k - 1]) / (xs[k] - xs[k - 1])

    if course.hold:
        return held if order == 0 else lambda _: 0.0
    return (interpolation(course.points), slope)[order] if order < 2 else lambda _: 0.0


def bends(course: Course, end: float) -> list[float]:
    """The moments before `end` at which a course of points jumps or bends.

    None for a long recording in straight lines: `smooth` says that it has to be followed closely.
    """
    if course.expr is not None or (len(course.points) > _MANY and not course.hold):
        return []
    return [t for t, _ in course.points if 0 < t < end]


def smooth(course: Course) -> bool:
    """Whether a course may change anywhere, not at its `bends` and `jumps` alone."""
    if course.expr is None:
        return len(course.points) > _MANY and not course.hold
    return any(n.op is Op.SYM and n.symbol.name == TIME for n in topological([course.expr]))


def moves(course: Course, order: int) -> bool:
    """Whether a course, or its derivative of some order, changes between its bends and jumps."""
    if course.expr is None:
        return order < 2 and len(course.points) > 1 and not course.hold
    return smooth(course)


def jumps(course: Course, pool: Pool, values: Values, times: Array) -> list[float]:
    """The moments at which an expression jumps or bends, between the first and the last time.

    That is where a condition, a `sign`, `abs`, `min` or `max` in it changes sides. They are looked
    for at the given times, and between them where a side comes near to changing; then halved to
    the rounding of time. An integrator that takes long steps would run past a short pulse.
    """
    if course.expr is None:
        return []
    found: list[float] = []
    for margin in _margins(course.expr, pool):
        if values.constant(margin) is not None:
            continue
        code = Code(pool, {time_symbol(pool): "t"}, values.constant)
        side = code.function("margin", "t", *code.text([margin]))
        found += _crossings(side, times)
    return found


def _margins(expr: Expr, pool: Pool) -> list[Expr]:
    """Expressions that vanish where this one jumps or bends."""
    found: dict[Expr, None] = {}
    for node in topological([expr]):
        bends = node.op is Op.FN and node.name in FUNCTIONS and FUNCTIONS[node.name].bends
        if node.op is Op.CMP or bends:  # where its argument is zero, or its arguments are equal
            found[pool.sub(*node.args) if len(node.args) == 2 else node.args[0]] = None
        elif node.op is Op.FN and node.name.startswith("table:"):
            for arg, numbers in zip(node.args, knots(pool.tables[node.name[6:]]), strict=True):
                if len(numbers) <= _MANY:
                    found |= {pool.sub(arg, pool.num(x)): None for x in numbers}
    return list(found)


def _crossings(side: Callable[[float], float], times: Array) -> list[float]:
    """Where a function changes its sign; zero counts as negative."""

    def value(t: float) -> float:
        try:
            return side(t)
        except (ArithmeticError, ValueError):
            return math.nan

    found = []
    at = times.tolist()
    seen = [value(t) for t in at]
    for k, (t, now) in enumerate(zip(at, seen, strict=True)):
        if k and (now > 0) != (seen[k - 1] > 0):
            found.append(_change(value, at[k - 1], t, seen[k - 1] > 0))
        if not 0 < k < len(at) - 1:
            continue
        steps = abs(now - seen[k - 1]), abs(now - seen[k + 1])
        near = abs(now) <= min(abs(seen[k - 1]), abs(seen[k + 1])) and abs(now) <= 2 * max(steps)
        if near and (seen[k - 1] > 0) == (now > 0) == (seen[k + 1] > 0):
            dip = _nearest(value, at[k - 1], at[k + 1])
            if (value(dip) > 0) != (now > 0):
                found.append(_change(value, at[k - 1], dip, now > 0))
                found.append(_change(value, dip, at[k + 1], now <= 0))
    return found


def _nearest(side: Callable[[float], float], a: float, b: float) -> float:
    """Where a function that keeps its sign at a and b comes nearest to changing it between."""
    from scipy.optimize import minimize_scalar

    away = 1.0 if side(a) > 0 else -1.0
    return float(minimize_scalar(lambda t: away * side(t), bounds=(a, b), method="bounded").x)


def _change(side: Callable[[float], float], a: float, b: float, positive: bool) -> float:
    """The moment after a, and up to b, at which a function no longer has the sign it had at a."""
    for _ in range(60):
        middle = (a + b) / 2
        if middle in (a, b):
            break
        if (side(middle) > 0) == positive:
            a = middle
        else:
            b = middle
    return b
