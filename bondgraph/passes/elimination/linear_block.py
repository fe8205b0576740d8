"""Solve a large block of linear equations with constant coefficients by sparse elimination.

Gauss's method: the variable that the fewest equations hold is eliminated by the shortest of them
(Markowitz, 1957), among those whose coefficient is not small next to the others at the nominal
values, so that the emitted code is as accurate as a numeric solver (Duff, Erisman and Reid, 1986).
Where each variable has an equation of its own, as the effort of a junction has the balance of that
junction, that one eliminates it: the equations of a network are symmetric then (Tellegen, 1952) and
stay so, and half of the coefficients are the other half. Coefficients are shared nodes and are
never expanded.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Container, Mapping, Sequence

from bondgraph.algebra.affine import affine
from bondgraph.algebra.zero import Constants
from bondgraph.ir.equation_system import Equation
from bondgraph.ir.expr import Expr, Pool, Rational
from bondgraph.ir.nodes import constant
from bondgraph.text.tuples import NamedTuple

#: More products than this in one block are not written out: a gigabyte, and minutes of a compiler.
LARGEST = 1_000_000

#: A pivot is at least this part of the largest coefficient of its variable.
_THRESHOLD = 0.1

#: A sum this small next to its terms may be zero: its value over a prime field decides.
_CANCELLED = 1e-6


class LinearEquation(NamedTuple):
    """0 = sum of coefficient times variable, plus `rest`; `number` is the caller's name for it."""

    number: int
    entries: dict[Expr, Expr]
    rest: Expr


class Solved(NamedTuple):
    """A variable with its value in known signals, and the number of the equation that gave it."""

    variable: Expr
    value: Expr
    equation: int


class Block(NamedTuple):
    """What a block gives: its variables, and the equations left over as (number, expression)."""

    solved: list[Solved]
    left: list[tuple[int, Expr]]


def linear_equation(
    pool: Pool,
    number: int,
    zero: Expr,
    variables: Sequence[Expr],
    known: Callable[[Expr], Expr],
    fits: Callable[[Expr], bool] = constant,
) -> LinearEquation | None:
    """An equation in `variables`, None where it is not linear or a coefficient does not fit.

    `known` puts in the values of all other variables.
    """
    entries: dict[Expr, Expr] = {}
    for variable in variables:
        parts = affine(pool, zero, variable)
        if parts is None:
            return None
        slope, zero = parts
        slope = known(slope)
        if not fits(slope):
            return None
        if slope is not pool.zero:
            entries[variable] = slope
    return LinearEquation(number, entries, known(zero))


def linear_equations(
    pool: Pool,
    equations: Mapping[int, Equation],
    closed: Container[Expr],
    known: Callable[[Expr], Expr],
) -> list[LinearEquation] | None:
    """Numbered equations in the variables that are not `closed`; None as `linear_equation`."""
    found = []
    for number, equation in equations.items():
        free = [v for v in equation.variables if v not in closed]
        line = linear_equation(pool, number, equation.zero, free, known)
        if line is None:
            return None
        found.append(line)
    return found


def solve_block(
    pool: Pool,
    lines: Sequence[LinearEquation],
    size: Callable[[Expr], float],
    own: Mapping[int, Expr] | None = None,
) -> Block | None:
    """The values of all variables of the equations, in known signals.

    There may be more equations than variables. `size` gives the nominal value of a coefficient,
    zero for one that must not be divided by. `own` has, by the number of an equation, the variable
    that it is to eliminate if it can. None where the equations do not determine every variable at
    these values.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); e, f = p.symbol("e", Kind.EFFORT), p.symbol("f", Kind.FLOW)
    >>> R, u = p.symbol("R", Kind.PARAM), p.symbol("u", Kind.INPUT)
    >>> ohm = LinearEquation(0, {e: p.one, f: p.neg(R)}, p.zero)
    >>> twice = LinearEquation(1, {e: p.num(2)}, p.neg(u))
    >>> block = solve_block(p, [ohm, twice], lambda coefficient: 1.0)
    >>> [(s.variable, s.value) for s in block.solved]
    [(e, u/2), (f, u/(2*R))]
    """
    elimination = _Elimination(pool, lines, size, own or {})
    if not elimination.run():
        return None
    left = [(row.number, pool.add(*row.rest)) for row in elimination.rows.values()]
    return Block(elimination.back(), left)


def products(lines: Sequence[LinearEquation], most: int) -> int:
    """About how many products `solve_block` forms; stops counting above `most`.

    Counts on the pattern alone, which takes a fraction of the time and of the memory.
    """
    rows = [dict.fromkeys(line.entries) for line in lines]
    holders: dict[Expr, dict[int, None]] = {}
    for at, row in enumerate(rows):
        for variable in row:
            holders.setdefault(variable, {})[at] = None
    heap = [(len(at), v.id, v) for v, at in holders.items()]
    heapq.heapify(heap)
    count = 0
    while heap and count <= most:
        degree, _, variable = heapq.heappop(heap)
        if variable not in holders or len(holders[variable]) != degree or not degree:
            continue  # overtaken
        others = holders.pop(variable)
        pivot = min(others, key=lambda at: (len(rows[at]), at))
        del others[pivot], rows[pivot][variable]
        for at in others:
            del rows[at][variable]
            rows[at].update(rows[pivot])
            count += len(rows[pivot])
        for other in rows[pivot]:
            del holders[other][pivot]
            holders[other].update(others)
            heapq.heappush(heap, (len(holders[other]), other.id, other))
    return count


#: Terms of a sum that is not made before it is asked for.
_Terms = list[tuple[Rational, Expr]]


class _Row:
    """An equation at work: the coefficients of its variables, and their nominal values."""

    __slots__ = ("entries", "number", "rest", "sizes")

    def __init__(self, line: LinearEquation, sizes: dict[Expr, float]) -> None:
        self.number = line.number
        self.entries: dict[Expr, _Terms] = {v: [(1, c)] for v, c in line.entries.items()}
        self.rest: _Terms = [(1, line.rest)]
        self.sizes = sizes


class _Pivot(NamedTuple):
    """A variable, the coefficients of the equation that eliminated it, what is known there."""

    variable: Expr
    entries: dict[Expr, Expr]
    rest: Expr
    number: int


class _Elimination:
    def __init__(
        self,
        pool: Pool,
        lines: Sequence[LinearEquation],
        size: Callable[[Expr], float],
        own: Mapping[int, Expr],
    ) -> None:
        self.pool = pool
        self.constants = Constants()
        self.rows = {
            at: _Row(line, {v: size(c) for v, c in line.entries.items()})
            for at, line in enumerate(lines)
        }
        self.own = {own[r.number]: at for at, r in self.rows.items() if r.number in own}
        self.owned = set(self.own.values())
        _balance([row.sizes for row in self.rows.values()])
        self.holders: dict[Expr, dict[int, None]] = {}
        for at, row in self.rows.items():
            for variable in row.entries:
                self.holders.setdefault(variable, {})[at] = None
        self.heap = [(len(rows), v.id, v) for v, rows in self.holders.items()]
        heapq.heapify(self.heap)
        self.late: list[tuple[int, int, Expr]] = []  # what its own equation does not give yet
        self.pivots: list[_Pivot] = []

    def run(self) -> bool:
        """Eliminate every variable; False if one is left without an equation."""
        while self.heap or self.late:
            early = bool(self.heap)
            entry = heapq.heappop(self.heap or self.late)
            count, _, variable = entry
            holders = self.holders.get(variable)
            if holders is None or len(holders) != count:
                continue  # an entry of the heap that has been overtaken
            sizes = {at: abs(self.rows[at].sizes[variable]) for at in holders}
            least = _THRESHOLD * max(sizes.values(), default=0.0)
            fit = [at for at, size in sizes.items() if size >= least > 0.0]
            own = self.own.get(variable)
            if early and own in self.rows and own not in fit:
                heapq.heappush(self.late, entry)
                continue
            if not fit:
                return False
            self.take(min(fit, key=lambda at: self.rank(at, own)), variable)
        return True

    def rank(self, at: int, own: int | None) -> tuple[bool, bool, int, int]:
        """An equation as one to eliminate by: its own one first, that of another variable last."""
        return at != own, at in self.owned, len(self.rows[at].entries), at

    def take(self, at: int, variable: Expr) -> None:
        """Eliminate a variable from all other equations by one of them."""
        pool = self.pool
        row = self.rows.pop(at)
        for other in row.entries:
            del self.holders[other][at]
        entries = {v: pool.add(*terms) for v, terms in row.entries.items()}
        own = _Pivot(variable, entries, pool.add(*row.rest), row.number)
        inverse = pool.power(entries[variable], -1)
        scale = 1.0 / row.sizes[variable]
        others = [(v, c, row.sizes[v]) for v, c in entries.items() if v is not variable]
        for number in self.holders.pop(variable):
            row = self.rows[number]
            factor = pool.mul(pool.add(*row.entries.pop(variable)), inverse)
            size = -row.sizes.pop(variable) * scale
            for other, coefficient, weight in others:
                self.subtract(number, other, pool.mul(factor, coefficient), size * weight)
            if own.rest is not pool.zero:
                row.rest.append((-1, pool.mul(factor, own.rest)))
        for other, _, _ in others:
            heapq.heappush(self.heap, (len(self.holders[other]), other.id, other))
        self.pivots.append(own)

    def subtract(self, number: int, variable: Expr, term: Expr, size: float) -> None:
        """Subtract from the coefficient of a variable in an equation, which grows by `size`."""
        row = self.rows[number]
        terms = row.entries.setdefault(variable, [])
        terms.append((-1, term))
        if len(terms) == 1:
            row.sizes[variable] = size
            self.holders[variable][number] = None
            return
        sum_ = row.sizes[variable] + size
        small = abs(sum_) <= _CANCELLED * abs(size)
        if small and self.constants.vanishes(self.pool.add(*terms)):
            del row.entries[variable], row.sizes[variable], self.holders[variable][number]
        else:
            row.sizes[variable] = sum_ if abs(sum_) > 1e-12 * abs(size) else 0.0

    def back(self) -> list[Solved]:
        """The values, from the last pivot to the first."""
        pool = self.pool
        values: dict[Expr, Expr] = {}
        found = []
        for variable, entries, rest, number in reversed(self.pivots):
            terms = [(-1, rest)]
            for other, coefficient in entries.items():
                if other is not variable:
                    terms.append((-1, pool.mul(coefficient, values[other])))
            values[variable] = pool.div(pool.add(*terms), entries[variable])
            found.append(Solved(variable, values[variable], number))
        return found


def _balance(rows: list[dict[Expr, float]]) -> None:
    """Scale rows and columns until coefficients in different units can be compared.

    Each by the square root of its largest coefficient, a few times (Ruiz, 2001).
    """
    for _ in range(5):
        largest: dict[Expr, float] = {}
        for row in rows:
            for variable, value in row.items():
                largest[variable] = max(largest.get(variable, 0.0), abs(value))
        for row in rows:
            own = max(map(abs, row.values()), default=0.0)
            for variable in row:
                if row[variable]:
                    row[variable] /= (own * largest[variable]) ** 0.5
