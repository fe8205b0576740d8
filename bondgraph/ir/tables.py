"""Tables: measured laws of one or two inputs, and how they are read for any of their quantities.

The rows are those of the file. A table of one input has the points (x, z); a table of two, a map,
has the knots of its second input in its first row, behind a corner that means nothing, and then
rows of a knot of the first input with the values there.

A table relates its value to its inputs. By its own name it gives the value, with one mark behind
the name the first input, with two the second: `map.csv''(z, x)` is the y at which
`map.csv(x, y)` is z. What is given stands in the order value, first input, second input.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from math import nan
from typing import Any, TypeVar

X = TypeVar("X")
Rows = tuple[tuple[Fraction, ...], ...]

#: Of a table's range, at either end: what counts as beyond it where the table is read backwards,
#: far above what doubles lose, far below what a sensor tells.
ROUNDING = Fraction(1, 10**9)


def backwards(name: str) -> bool:
    """Whether a table is read for one of its inputs."""
    return name.endswith("'")


def reading(name: str, args: Sequence[X], value: X, at: int) -> tuple[str, tuple[X, ...]]:
    """The reading of a table for the argument number `at` of another one that gives `value`.

    >>> reading("map.csv", ("x", "y"), "z", 1)
    ("map.csv''", ('z', 'x'))
    >>> reading("map.csv''", ("z", "x"), "y", 0)
    ('map.csv', ('x', 'y'))
    """
    own = name.rstrip("'")
    given = len(name) - len(own)
    quantities = [*args[:given], value, *args[given:]]
    wanted = at + (at >= given)
    del quantities[wanted]
    return own + "'" * wanted, tuple(quantities)


def is_map(rows: Sequence[Sequence[Any]]) -> bool:
    """Whether a table has two inputs."""
    return len(rows[0]) > 2


def knots(rows: Sequence[Sequence[X]]) -> list[tuple[X, ...]]:
    """The numbers of each input at which the values are given."""
    first = tuple([row[0] for row in rows[is_map(rows) :]])
    return [first, tuple(rows[0][1:])] if is_map(rows) else [first]


def columns(rows: Sequence[Sequence[X]]) -> list[tuple[X, ...]]:
    """The values at the knots of the first input: a column for each knot of the second."""
    return list(zip(*[row[1:] for row in rows[is_map(rows) :]], strict=True))


def turned(rows: Rows) -> Rows:
    """A map with its inputs exchanged.

    >>> turned(((0, 5, 6, 7), (1, 10, 20, 30), (2, 40, 50, 60)))
    ((0, 1, 2), (5, 10, 40), (6, 20, 50), (7, 30, 60))
    """
    return tuple(zip(*rows, strict=True))


def read_backwards(rows: Rows, which: int) -> Rows | None:
    """The rows of a reading for the first or second input; None unless strictly monotone along it.

    A table of one input becomes the points (z, x); a map gets the input that is read for first.

    >>> read_backwards(((0, 8), (1, 4)), 1), read_backwards(((0, 8), (1, 8)), 1)
    (((4, 1), (8, 0)), None)
    """
    rows = turned(rows) if which == 2 else rows
    steps = [b - a for column in columns(rows) for a, b in pairwise(column)]
    if not steps or not (all(s > 0 for s in steps) or all(s < 0 for s in steps)):
        return None
    return rows if is_map(rows) else tuple(sorted((z, x) for x, z in rows))


def opened(points: Sequence[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """The points of a table that is read backwards, with no value, not a number, at its ends.

    Where `z = table(x)` stays at its end, `x` can be anything. What rounding takes for the end
    counts as beyond it.
    """
    (a, fa), (b, fb) = points[0], points[1]
    (c, fc), (d, fd) = points[-2], points[-1]
    margin = float(ROUNDING) * (d - a)
    low, high = a + margin, d - margin
    start = (low, fa + (fb - fa) * (low - a) / (b - a))
    end = (high, fd + (fc - fd) * (d - high) / (d - c))
    return ((low, nan), start, *[p for p in points if low < p[0] < high], end, (high, nan))
