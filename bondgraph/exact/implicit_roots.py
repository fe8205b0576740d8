"""The value of a root: a number at which its equation holds, then a coefficient after the other.

On a healthy plant the number is known: it is the variable that the root stands for, and it has to
solve the equation. Where a fault acts it is found between two numbers at which the equation has
different signs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from random import Random
from typing import Any, TypeAlias

from bondgraph.exact.signal_algebra import Exponentials, Mixed, Taylor
from bondgraph.field.balls import zero_of
from bondgraph.field.numbers import Number, Numbers, Undefined
from bondgraph.field.series import Series
from bondgraph.ir.expr import Root

#: The value of an equation to so many coefficients: what stands in its places, then its unknown.
Zero: TypeAlias = Callable[[Sequence[Series], Series, int], Series]


def root_value(root: Root, args: Sequence[Any], sample: Any, n: int, zero: Zero) -> Series:
    """The root as a series, from the values of what stands in its places.

    Raises `Undefined` where no solution is found, `Mixed` for exponentials.
    """
    algebra = sample.algebra
    if not isinstance(algebra, Taylor):
        if isinstance(algebra, Exponentials) and not any(degree for _, degree in args):
            raise Undefined("a root of constants among exponentials")
        raise Mixed("an equation without a closed solution")
    here = [a[:1] for a in args]
    lead = _lead(root, [a[0] for a in args], sample, lambda x: zero(here, [x], 1)[0])
    series = [lead]
    if n > 1 and any(len(a) > 1 for a in args):
        factor = -algebra.numbers.inverse(_coefficient(zero(here, [lead, 1], 2), 1))
        for k in range(1, n):
            series.append(_coefficient(zero(args, series, k + 1), k) * factor)
    return series


def _coefficient(series: Series, k: int) -> Number:
    return series[k] if k < len(series) else 0


def _lead(root: Root, leads: list[Number], sample: Any, zero: Callable[[Number], Number]) -> Number:
    """The solution at the point.

    A sample of a field without a plant (it has no `truly`) gets a random number, as if an
    argument were free to make the equation true.
    """
    numbers: Numbers = sample.algebra.numbers
    truly = getattr(sample, "truly", None)
    if truly is None and not numbers.real:
        key = (root.zero, *leads)
        if key not in numbers.roots:
            numbers.roots[key] = numbers.any(Random(len(numbers.roots)))
        return numbers.roots[key]
    found: Number | None = truly(root.variable) if truly else None
    if found is not None and not numbers.nonzero(zero(found)):
        return found
    if truly and sample.healthy:
        raise Undefined("a variable of the plant that does not solve its equation")
    if not numbers.real:
        raise Mixed("an equation without a closed solution in a field")
    start = numbers.fraction(root.guess) if found is None else numbers.number(1) * found
    return zero_of(zero, start)
