"""Solve two equations for the two unknowns that a turned frame mixes, without dividing by a sine.

Park's transformation, or the axes of a vehicle, are written as modulated transformers: what goes
in at one side is x cos(a) - y sin(a) and x sin(a) + y cos(a). Taken one after the other, x and y
are divided by sin(a) or cos(a), and a relation would be multiplied by what is zero again and again
while the frame turns. The determinant of the two does not depend on the angle.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence

from bondgraph.algebra.zero import is_zero
from bondgraph.ir.expr import Expr, Op, Pool, topological
from bondgraph.ir.nodes import constant
from bondgraph.passes.elimination.linear_block import LinearEquation
from bondgraph.text.tuples import NamedTuple


class Pair(NamedTuple):
    """Two unknowns in terms of what is known, and the numbers of the two equations."""

    values: dict[Expr, Expr]
    equations: tuple[int, int]


def angular(expr: Expr) -> bool:
    """Whether an expression holds a sine or a cosine."""
    return any(n.op is Op.FN and n.name in ("sin", "cos") for n in topological([expr]))


def turned_pair(
    pool: Pool, lines: Sequence[LinearEquation], vanishes: Callable[[Expr], bool]
) -> Pair | None:
    """The first two unknowns that two of the equations give together, whatever an angle is.

    What stands for another unknown, as y = cos(a)*x at a transformer, is put in first. `vanishes`
    tells a coefficient that must not be divided by.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); x, y = p.symbol("x", Kind.FLOW), p.symbol("y", Kind.FLOW)
    >>> i, j, a = (p.symbol(n, Kind.SENSOR) for n in "ija")
    >>> sine, cosine = p.fn("sin", a), p.fn("cos", a)
    >>> one = LinearEquation(0, {x: cosine, y: p.neg(sine)}, p.neg(i))
    >>> two = LinearEquation(1, {x: sine, y: cosine}, p.neg(j))
    >>> turned_pair(p, [one, two], lambda _: False).values
    {x: j*sin(a) + i*cos(a), y: j*cos(a) - i*sin(a)}
    """
    links = _Links(pool, vanishes)
    folded: dict[frozenset[Expr], list[LinearEquation]] = {}
    for line in links.taken(lines):
        if len(line.entries) == 2 and any(map(angular, line.entries.values())):
            folded.setdefault(frozenset(line.entries), []).append(line)
    for same in folded.values():
        for one, other in itertools.combinations(same, 2):
            values = _together(pool, one, other, vanishes)
            if values is not None:
                return Pair(values, (one.number, other.number))
    return None


class _Link(NamedTuple):
    """An unknown is `slope` times another one, and `rest`."""

    other: Expr
    slope: Expr
    rest: Expr


class _Links:
    """Unknowns that stand for others: the flows of a transformer, the two sides of a junction."""

    def __init__(self, pool: Pool, vanishes: Callable[[Expr], bool]) -> None:
        self.pool = pool
        self.vanishes = vanishes
        self.found: dict[Expr, _Link] = {}  # none leads to another

    def taken(self, lines: Sequence[LinearEquation]) -> list[LinearEquation]:
        """The equations that are no links, in the unknowns that are left."""
        left = sorted(lines, key=lambda line: not any(map(angular, line.entries.values())))
        count = -1
        while count != len(self.found):
            count = len(self.found)
            left = [line for line in map(self.put_in, left) if not self.link(line)]
        return left

    def put_in(self, line: LinearEquation) -> LinearEquation:
        """An equation with what unknowns stand for."""
        pool = self.pool
        entries: dict[Expr, Expr] = {}
        rest = line.rest
        for variable, coefficient in line.entries.items():
            link = self.found.get(variable)
            if link is not None:
                rest = pool.add((1, rest), (1, pool.mul(coefficient, link.rest)))
                variable, coefficient = link.other, pool.mul(coefficient, link.slope)
            entries[variable] = pool.add((1, entries.get(variable, pool.zero)), (1, coefficient))
        left = {v: c for v, c in entries.items() if c is not pool.zero}
        return LinearEquation(line.number, left, rest)

    def link(self, line: LinearEquation) -> bool:
        """Whether an equation of two unknowns gives one of them, which stands for the other now."""
        line = self.put_in(line)
        if len(line.entries) != 2:
            return False
        for own, other in itertools.permutations(line.entries):
            pool, coefficient = self.pool, line.entries[own]
            if not constant(coefficient) or self.vanishes(coefficient):
                continue
            slope, rest = (
                pool.neg(pool.div(e, coefficient)) for e in (line.entries[other], line.rest)
            )
            if not (angular(slope) or slope in (pool.one, pool.neg(pool.one))):
                continue  # the law of an element: a flow is not to be had by its resistance
            for variable, link in self.found.items():
                if link.other is own:
                    moved = pool.add((1, link.rest), (1, pool.mul(link.slope, rest)))
                    self.found[variable] = _Link(other, pool.mul(link.slope, slope), moved)
            self.found[own] = _Link(other, slope, rest)
            return True
        return False


def _together(
    pool: Pool, one: LinearEquation, other: LinearEquation, vanishes: Callable[[Expr], bool]
) -> dict[Expr, Expr] | None:
    """The two unknowns by Cramer's rule; None where the determinant depends on an angle."""
    x, y = one.entries
    determinant = pool.sub(
        pool.mul(one.entries[x], other.entries[y]), pool.mul(one.entries[y], other.entries[x])
    )
    upright = {
        n: pool.zero if n.name == "sin" else pool.one
        for n in topological([determinant]) if n.op is Op.FN and n.name in ("sin", "cos")
    }  # fmt: skip
    if not upright:
        return None
    plain = pool.substitute([determinant], upright)[0]
    if vanishes(plain) or is_zero(plain) or not is_zero(pool.sub(determinant, plain)):
        return None
    upper = {
        x: ((1, pool.mul(one.entries[y], other.rest)), (-1, pool.mul(other.entries[y], one.rest))),
        y: ((1, pool.mul(other.entries[x], one.rest)), (-1, pool.mul(one.entries[x], other.rest))),
    }
    return {v: pool.div(pool.add(*terms), plain) for v, terms in upper.items()}
