"""Solve a large block of linear equations with constant coefficients by sparse elimination.

Gauss's method: the variable that the fewest equations hold is eliminated by the shortest of them
(Markowitz, 1957), among those whose coefficient is not small next to the others at the nominal
values, so that the emitted code is as accurate as a numeric solver (Duff, Erisman and Reid, 1986).
Coefficients are shared nodes and are never expanded.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Container, Mapping, Sequence

from bondgraph.algebra.affine import affine
from bondgraph.algebra.zero import Constants
from bondgraph.ir.equation_system import Equation
from bondgraph.ir.expr import Expr, Pool
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
    pool: Pool, lines: Sequence[LinearEquation], size: Callable[[Expr], float]
) -> Block | None:
    """The values of all variables of the equations, in known signals.

    There may be more equations than variables. `size` gives the nominal value of a coefficient,
    zero for one that must not be divided by. None where the equations do not determine every
    variable at these values.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); e, f = p.symbol("e", Kind.EFFORT), p.symbol("f", Kind.FLOW)
    >>> R, u = p.symbol("R", Kind.PARAM), p.symbol("u", Kind.INPUT)
    >>> ohm = LinearEquation(0, {e: p.one, f: p.neg(R)}, p.zero)
    >>> twice = LinearEquation(1, {e: p.num(2)}, p.neg(u))
    >>> block = solve_block(p, [ohm, twice], lambda coefficient: 1.0)
    >>> [(s.variable, s.value) for s in block.solved]
    [(e, u/2), (f, u/(2*R))]
    """
    elimination = _Elimination(pool, lines, size)
    if not elimination.run():
        return None
    left = [(line.number, line.rest) for line in elimination.rows.values()]
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


class _Row:
    """An equation at work: the coefficients of its variables, and their nominal values."""

    __slots__ = ("entries", "number", "rest", "sizes")

    def __init__(self, line: LinearEquation, sizes: dict[Expr, float]) -> None:
        self.number = line.number
        self.entries = dict(line.entries)
        self.rest = line.rest
        self.sizes = sizes


class _Elimination:
    def __init__(
        self, pool: Pool, lines: Sequence[LinearEquation], size: Callable[[Expr], float]
    ) -> None:
        self.pool = pool
        self.constants = Constants()
        self.rows = {
            at: _Row(line, {v: size(c) for v, c in line.entries.items()})
            for at, line in enumerate(lines)
        }
        _balance([row.sizes for row in self.rows.values()])
        self.holders: dict[Expr, dict[int, None]] = {}
        for at, row in self.rows.items():
            for variable in row.entries:
                self.holders.setdefault(variable, {})[at] = None
        self.heap = [(len(rows), v.id, v) for v, rows in self.holders.items()]
        heapq.heapify(self.heap)
        self.pivots: list[tuple[Expr, _Row]] = []

    def run(self) -> bool:
        """Eliminate every variable; False if one is left without an equation."""
        while self.heap:
            count, _, variable = heapq.heappop(self.heap)
            holders = self.holders.get(variable)
            if holders is None or len(holders) != count:
                continue  # an entry of the heap that has been overtaken
            sizes = {at: abs(self.rows[at].sizes[variable]) for at in holders}
            least = _THRESHOLD * max(sizes.values(), default=0.0)
            if not least:
                return False
            fit = [at for at, size in sizes.items() if size >= least]
            self.take(min(fit, key=lambda at: (len(self.rows[at].entries), at)), variable)
        return True

    def take(self, at: int, variable: Expr) -> None:
        """Eliminate a variable from all other equations by one of them."""
        pool = self.pool
        own = self.rows.pop(at)
        for other in own.entries:
            del self.holders[other][at]
        inverse = pool.power(own.entries[variable], -1)
        scale = 1.0 / own.sizes[variable]
        others = [(v, c, own.sizes[v]) for v, c in own.entries.items() if v is not variable]
        for number in self.holders.pop(variable):
            row = self.rows[number]
            factor = pool.neg(pool.mul(row.entries.pop(variable), inverse))
            size = -row.sizes.pop(variable) * scale
            for other, coefficient, weight in others:
                self.add(number, row, other, pool.mul(factor, coefficient), size * weight)
            if own.rest is not pool.zero:
                row.rest = pool.add((1, row.rest), (1, pool.mul(factor, own.rest)))
        for other, _, _ in others:
            heapq.heappush(self.heap, (len(self.holders[other]), other.id, other))
        self.pivots.append((variable, own))

    def add(self, number: int, row: _Row, variable: Expr, term: Expr, size: float) -> None:
        """Add to the coefficient of a variable in an equation."""
        old = row.entries.get(variable)
        if old is None:
            row.entries[variable] = term
            row.sizes[variable] = size
            self.holders[variable][number] = None
            return
        new = self.pool.add((1, old), (1, term))
        sum_ = row.sizes[variable] + size
        small = abs(sum_) <= _CANCELLED * abs(size)
        if small and self.constants.vanishes(new):
            del row.entries[variable], row.sizes[variable], self.holders[variable][number]
        else:
            row.entries[variable] = new
            row.sizes[variable] = sum_ if abs(sum_) > 1e-12 * abs(size) else 0.0

    def back(self) -> list[Solved]:
        """The values, from the last pivot to the first."""
        pool = self.pool
        values: dict[Expr, Expr] = {}
        found = []
        for variable, row in reversed(self.pivots):
            terms = [(-1, row.rest)]
            for other, coefficient in row.entries.items():
                if other is not variable:
                    terms.append((-1, pool.mul(coefficient, values[other])))
            values[variable] = pool.div(pool.add(*terms), row.entries[variable])
            found.append(Solved(variable, values[variable], row.number))
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
