"""Numbers that solve an equation without a closed solution, and their series.

On a healthy plant the solution is known: it is the variable that the root stands for, and it has
to solve the equation. Where a fault acts it is found between two numbers at which the equation
has different signs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from random import Random
from typing import Any

from bondgraph.exact import evaluate
from bondgraph.exact.signal_algebra import Mixed, Taylor, Waves
from bondgraph.field.balls import zero_of
from bondgraph.field.numbers import Number, Numbers, Undefined
from bondgraph.field.series import Series
from bondgraph.ir.expr import Expr, Symbol, topological


class _Inside:
    """The sample on which the equation of a root is looked at."""

    def __init__(self, algebra: Any, values: Mapping[Expr, Any]) -> None:
        self.algebra = algebra
        self._values = values

    def value(self, symbol: Expr) -> Any:
        return self._values[symbol]

    def start(self, initial: Symbol) -> Number:
        raise Mixed("an integral inside a root")


def root_value(node: Expr, args: Sequence[Any], sample: Any, n: int) -> Any:
    """The root as a series: its value at the point, then one coefficient after the other.

    A sample of a field without a plant (it has no `truly`) gets a random number, as if an
    argument were free to make the equation true. Raises `Undefined` where no solution is found,
    `Mixed` for exponentials.
    """
    algebra = sample.algebra
    if not isinstance(algebra, Taylor):
        if isinstance(algebra, Waves) and all(not a.degree for a in args):
            raise Undefined("a root of constants among exponentials")
        raise Mixed("an equation without a closed solution")
    root = node.root
    inside = dict(zip(root.places, args, strict=True))
    nodes = topological([root.zero])

    def zero(x: Series, size: int) -> tuple[Series, dict[Expr, Any]]:
        point = _Inside(algebra, {**inside, root.unknown: x})
        found, failures = evaluate.values_of(nodes, dict.fromkeys(nodes, size), point)
        if root.zero in failures:
            raise failures[root.zero]
        return found[root.zero], found

    lead = _lead(node, [a[0] for a in args], sample, lambda x: zero([x], 1)[0][0])
    series = [lead]
    if n > 1 and any(len(a) > 1 for a in args):
        steep = tangent(root.zero, root.unknown, zero(series, 1)[1], algebra, 1)[0]
        factor = -algebra.numbers.inverse(steep)
        for k in range(1, n):
            value = zero(series, k + 1)[0]
            series.append(value[k] * factor if k < len(value) else 0)
    return series


def root_slopes(node: Expr, value: Any, args: Sequence[Any], algebra: Any, n: int) -> list[Any]:
    """The partial derivatives of a root, by the theorem of the implicit function."""
    root = node.root
    point = _Inside(algebra, {**dict(zip(root.places, args, strict=True)), root.unknown: value})
    nodes = topological([root.zero])
    found, failures = evaluate.values_of(nodes, dict.fromkeys(nodes, n), point)
    if root.zero in failures:
        raise failures[root.zero]
    steep = tangent(root.zero, root.unknown, found, algebra, n)
    out = []
    for place in root.places:
        above = tangent(root.zero, place, found, algebra, n)
        out.append(algebra.combine([(-1, algebra.product([(above, 1), (steep, -1)], n))], n))
    return out


def tangent(root: Expr, wrt: Expr, values: dict[Expr, Any], algebra: Any, n: int) -> Any:
    """The partial derivative of an expression without D and Int, forwards."""
    slopes: dict[Expr, Any] = {wrt: algebra.number(1)}
    for node in topological([root]):
        if node is wrt or not any(a in slopes for a in node.args):
            continue
        parts = [
            (1, algebra.product([(slope, 1), (slopes[a], 1)], n))
            for a, slope in evaluate.slopes(node, values, algebra, n, False)
            if a in slopes
        ]
        slopes[node] = algebra.combine(parts, n) if parts else algebra.number(0)
    return slopes.get(root, algebra.number(0))


# ---------------------------------------------------------------------- the value at the point


def _lead(
    node: Expr, leads: list[Number], sample: Any, zero: Callable[[Number], Number]
) -> Number:
    """The solution at the point."""
    numbers: Numbers = sample.algebra.numbers
    truly = getattr(sample, "truly", None)
    if truly is None and not numbers.real:
        key = (node.root.zero, *leads)
        if key not in numbers.roots:
            numbers.roots[key] = numbers.any(Random(len(numbers.roots)))
        return numbers.roots[key]
    found: Number | None = truly(node.root.variable) if truly else None
    if found is not None and not numbers.nonzero(zero(found)):
        return found
    if truly and sample.healthy:
        raise Undefined("a variable of the plant that does not solve its equation")
    if not numbers.real:
        raise Mixed("an equation without a closed solution in a field")
    start = numbers.fraction(node.root.guess) if found is None else numbers.number(1) * found
    return zero_of(zero, start)


def solve(
    numbers: Numbers,
    zero: Expr,
    fixed: Mapping[Expr, Series],
    lines: Mapping[Expr, tuple[Number, Number]],
    outside: tuple[Number, Number],
    random: Random,
) -> Number:
    """A real number z at which `zero` + `outside` vanishes; raises `Undefined` without one.

    The symbols of `zero` are `fixed`, or straight `lines` in z: value at zero and slope, as
    `outside` is. Of several solutions a random one.
    """
    algebra = Taylor(numbers)
    nodes = topological([zero])
    need = dict.fromkeys(nodes, 1)

    def value(z: Number) -> Number:
        at = {symbol: [start + slope * z] for symbol, (start, slope) in lines.items()}
        found, failures = evaluate.values_of(nodes, need, _Inside(algebra, {**fixed, **at}))
        if zero in failures:
            raise failures[zero]
        return found[zero][0] + outside[0] + outside[1] * z

    return zero_of(value, numbers.number(0), random)
