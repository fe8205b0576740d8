"""The values of tables on any kind of number: straight between knots, constant beyond the ends."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Sequence
from typing import Any

from bondgraph.ir.tables import columns, is_map, knots, opened

Points = Sequence[Sequence[Any]]


def interpolation(rows: Points, backwards: bool = False) -> Callable[..., Any]:
    """A table as a function; one of two inputs is bilinear: at any y it is a table of x.

    One of them that is read `backwards` gives x at a value z and y, NaN where the value is at an
    end of the table of x; the rows of a table of one input say themselves where it has none.

    >>> table = interpolation(((0.0, 1.0), (2.0, 5.0)))
    >>> table(0.5), table(9.0)
    (2.0, 5.0)
    >>> rows = (0.0, 10.0, 20.0), (1.0, 5.0, 7.0), (3.0, 9.0, 15.0)
    >>> interpolation(rows)(2.0, 15.0), interpolation(rows, True)(9.0, 15.0)
    (9.0, 2.0)
    """
    if not is_map(rows):
        return _curve(rows)
    xs, ys = knots(rows)
    lines = [_curve(list(zip(ys, line, strict=True))) for line in zip(*columns(rows), strict=True)]

    def table(x: Any, y: Any) -> Any:
        if backwards:
            points = [(line(y), a) for line, a in zip(lines, xs, strict=True)]
            return _curve(opened(sorted(points)))(x)
        k = min(max(bisect_right(xs, x), 1), len(xs) - 1)
        return _curve([(xs[j], lines[j](y)) for j in (k - 1, k)])(x)

    return table


def _curve(points: Points) -> Callable[[Any], Any]:
    xs, ys = zip(*points, strict=True)
    last = len(xs) - 1

    def table(x: Any) -> Any:
        if x <= xs[0]:
            return ys[0]
        if x >= xs[last]:
            return ys[last]
        k = min(bisect_right(xs, x), last)
        return ys[k - 1] + (ys[k] - ys[k - 1]) * (x - xs[k - 1]) / (xs[k] - xs[k - 1])

    return table
