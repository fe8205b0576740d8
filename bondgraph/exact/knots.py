"""Nonlinear laws that hold each other, satisfied at once: Newton's method from a random point.

The diodes of a rectifier are an example: the currents of all of them balance, so that none can be
taken at random once the others are. A step is the shortest that satisfies the laws made linear, cut
while the next one would not be shorter (the natural test of monotony; Deuflhard, Newton Methods for
Nonlinear Problems, 2004, section 3.3).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import factorial
from random import Random
from typing import Protocol

from flint import arb, arb_mat, ctx

from bondgraph.exact.evaluate import evaluate
from bondgraph.exact.forms import Form
from bondgraph.exact.known import KnownSample, gradient
from bondgraph.exact.plant_equations import Equation, Setting, reach
from bondgraph.field.numbers import Number, Numbers, Undefined
from bondgraph.field.sparse import CONSTANT, Row
from bondgraph.ir.expr import Expr

_SHORTEST_RUN = 32  # evaluations of the laws: where there is a way, most runs need 6 to 16
_SHORTEST = arb(2) ** -14  # share of a step below which there is no way on
_CLOSE = arb(2) ** -160  # of a step to the point: what follows is shorter, or it is rounding


class Begun(Protocol):
    """A point of which the linear equations are satisfied, see `bondgraph.exact.point.Point`."""

    place: Mapping[Expr, tuple[int, int]]
    setting: Setting
    numbers: Numbers
    random: Random

    def row(self, form: Form) -> Row:
        """The value of a form, in columns."""
        ...

    def reduce(self, row: Row) -> Row:
        """The row in columns that are not determined by others."""
        ...


def budget(attempt: int) -> int:
    """How often an attempt to find a point may evaluate the laws; 0 if it solves one by one.

    Every second one has a run by the universal sequence 1, 1, 2, 1, 1, 2, 4, 1, ...: whatever runs
    need, this takes longer than giving up at the best time by a factor that grows with the
    logarithm of that only (Luby, Sinclair and Zuckerman, Optimal Speedup of Las Vegas Algorithms,
    1993, section 3).

    >>> [budget(2 * k + 1) // 32 for k in range(15)]
    [1, 1, 2, 1, 1, 2, 4, 1, 1, 2, 1, 1, 2, 4, 8]
    """
    if attempt % 2 == 0:
        return 0
    at = attempt // 2 + 1
    while at & (at + 1):  # the sequence up to 2**k - 1 is twice that up to 2**(k - 1) - 1 before
        at -= (1 << (at.bit_length() - 1)) - 1
    return _SHORTEST_RUN * (at + 1) // 2


def together(
    point: Begun, equations: Sequence[Equation], stride: int, evaluations: int
) -> dict[int, Number]:
    """Values of the open columns at which these laws hold, in balls; raises `Undefined`."""
    laws = _Laws(point, equations, stride)
    x = [point.numbers.any(point.random) for _ in laws.columns]
    value, slopes = laws.at(x)
    while True:
        step = _step(slopes, value)
        size, whole = _norm(step), 1 + _norm(x)
        radius = (whole * arb(2) ** (64 - ctx.prec)).upper()
        if size < radius / 4:
            return {c: arb(a, radius) for c, a in zip(laws.columns, x, strict=True)}
        close = size < _CLOSE * whole
        share = arb(1)
        while True:
            if not evaluations:
                raise Undefined("laws that were not satisfied together")
            evaluations -= 1
            moved = [(a + share * d).mid() for a, d in zip(x, step, strict=True)]
            try:
                value, found = laws.at(moved)
                if close or _norm(_step(slopes, value)) < (1 - share / 4) * size:
                    break
            except Undefined:
                pass  # no value there: nearer
            share /= 2
            if close or not share > _SHORTEST:
                raise Undefined("laws that no step satisfies together")
        x, slopes = moved, found


def _step(slopes: arb_mat, value: arb_mat) -> list[Number]:
    """The shortest step that takes away `value` where all is straight."""
    across = slopes.transpose()
    try:
        found = across * (slopes * across).solve(value)
    except ZeroDivisionError:
        raise Undefined("laws whose slopes depend on each other") from None
    return [-d.mid() for d in found.entries()]


def _norm(x: Sequence[Number]) -> Number:
    return sum((a * a for a in x), arb(0)).mid().sqrt()


class _Laws:
    """Laws as functions of what is open, with their slopes."""

    def __init__(self, point: Begun, equations: Sequence[Equation], stride: int) -> None:
        self._point = point
        self._stride = stride
        self._laws = []
        self._reduced: dict[int, Row] = {}
        for equation in equations:
            assert equation.rest is not None
            counts = {v: top + 1 for v, top in reach(point.place, equation.rest).items()}
            for column in [v * stride + k for v, count in counts.items() for k in range(count)]:
                self._reduced.setdefault(column, point.reduce({column: 1}))
            form = point.reduce(point.row(equation.form))
            self._laws.append((form, equation.rest, counts))
        rows = [*self._reduced.values(), *[form for form, _, _ in self._laws]]
        self.columns = sorted({c for row in rows for c in row if c != CONSTANT})

    def at(self, x: Sequence[Number]) -> tuple[arb_mat, arb_mat]:
        """What the laws are off by, and their slopes; raises `Undefined` where they have none."""
        point = self._point
        here = dict(zip(self.columns, x, strict=True))
        known = {column: _dot(row, here) for column, row in self._reduced.items()}
        off, slopes = [], []
        for form, rest, counts in self._laws:
            series = {
                v: [known[v * self._stride + k] for k in range(count)]
                for v, count in counts.items()
            }
            sample = KnownSample(point.place, point.setting, series)
            off.append([_dot(form, here) + (evaluate([rest], sample, 1)[0] or [0])[0]])
            row = {c: arb(v) for c, v in form.items()}
            for (variable, k), slope in gradient(rest, sample, point.place).items():
                for c, share in self._reduced[variable * self._stride + k].items():
                    row[c] = row.get(c, 0) + slope * factorial(k) * share
            slopes.append([row.get(c, 0) for c in self.columns])
        return arb_mat(off), arb_mat(slopes)


def _dot(row: Row, values: dict[int, Number]) -> Number:
    return sum((c * values[k] for k, c in row.items() if k != CONSTANT), row.get(CONSTANT, 0))
