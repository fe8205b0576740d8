"""Signals over time as functions, with their derivatives and the moments at which they jump."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological
from bondgraph.passes.lowering.derivative import Jets
from bondgraph.runtime.simulation.code import Code
from bondgraph.runtime.simulation.scenario import Course
from bondgraph.runtime.simulation.values import Values

TIME = "t"


def time_symbol(pool: Pool) -> Expr:
    """The symbol that stands for time in the expressions of a scenario."""
    return pool.symbol(TIME, Kind.INPUT)


def function(
    course: Course, pool: Pool, values: Values, order: int = 0
) -> Callable[[float], float]:
    """The course, or its derivative of some order, as a function of time in s.

    Raises KeyError with the name of a parameter that has no value.
    """
    if course.expr is None:
        return _through(course, order)
    time = time_symbol(pool)
    expr = Jets(pool).of(course.expr, order)
    rates = {pool.der(time): pool.one}
    for _ in range(order):
        rates[pool.der(next(reversed(rates)))] = pool.zero
    expr = pool.substitute([expr], rates)[0]
    number = values.constant(expr)
    if number is not None:
        return lambda _: number
    for node in topological([expr]):
        if node.op is Op.SYM and node is not time:
            values.number(node)  # says which one has no value
    code = Code(pool, {time: "t"}, values.constant)
    return code.function("course", "t", code.write(expr))  # type: ignore[no-any-return]


def _through(course: Course, order: int) -> Callable[[float], float]:
    xs = [p[0] for p in course.points]
    ys = [p[1] for p in course.points]

    def held(t: float) -> float:
        return ys[max(bisect_right(xs, t) - 1, 0)]

    def line(t: float) -> float:
        k = bisect_right(xs, t)
        if k == 0 or k == len(xs):
            return ys[min(k, len(ys) - 1)]
        return ys[k - 1] + (ys[k] - ys[k - 1]) * (t - xs[k - 1]) / (xs[k] - xs[k - 1])

    def slope(t: float) -> float:
        k = bisect_right(xs, t)
        if k == 0 or k == len(xs):
            return 0.0
        return (ys[k] - ys[k - 1]) / (xs[k] - xs[k - 1])

    if course.hold:
        return held if order == 0 else lambda _: 0.0
    return (line, slope)[order] if order < 2 else lambda _: 0.0


def bends(course: Course, end: float) -> list[float]:
    """The moments before `end` at which a course of points jumps or bends."""
    if course.expr is not None:
        return []
    return [t for t, _ in course.points if 0 < t < end]


def jumps(
    course: Course, pool: Pool, values: Values, times: npt.NDArray[np.float64], whole: bool
) -> list[float]:
    """The moments at which a condition in the expression changes, between the first and last time.

    Looked for at the given times and then halved to the rounding of time: an integrator that takes
    long steps would run past a short pulse. With `whole` the value itself is a condition.
    """
    if course.expr is None:
        return []
    time = time_symbol(pool)
    conditions = [n for n in topological([course.expr]) if n.op is Op.CMP]
    if whole and not conditions:
        conditions = [course.expr]
    found: list[float] = []
    for condition in conditions:
        code = Code(pool, {time: "t"}, values.constant)
        holds = code.function("holds", "t", code.condition(condition))
        before, truth = float(times[0]), bool(holds(float(times[0])))
        for t in times[1:].tolist():
            now = bool(holds(t))
            if now != truth:
                found.append(_change(holds, before, t, truth))
            before, truth = t, now
    return found


def _change(holds: Callable[[float], bool], a: float, b: float, truth: bool) -> float:
    """The moment after a, and up to b, at which a condition is no longer what it was at a."""
    for _ in range(60):
        middle = (a + b) / 2
        if middle in (a, b):
            break
        if bool(holds(middle)) == truth:
            a = middle
        else:
            b = middle
    return b
