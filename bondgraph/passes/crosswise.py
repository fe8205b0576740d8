"""Combine rows that hold derivatives of torn variables crosswise, so that these drop out.

The rows are linear in the torn variables, with polynomials in D = d/dt that have constant
coefficients: a differential loop.
"""

from __future__ import annotations

from typing import NamedTuple

from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols, topological
from bondgraph.passes.fractions import monomials, without_common_divisor
from bondgraph.passes.nominal import Nominal
from bondgraph.passes.solve import constant
from bondgraph.passes.zero import is_zero, share_factor

Polynomial = list[Expr]  # coefficients of D**0, D**1, ...

#: Parameters, and terms, up to which two polynomials are divided in expanded form.
_FEW, _SHORT = 5, 60


class LinearRow(NamedTuple):
    """sum of polynomial(D) tear + rest = 0, combined from the equations `rows`."""

    rows: tuple[int, ...]
    entries: dict[Expr, Polynomial]
    rest: Expr


class Crosswise:
    """The differential loops of one elimination."""

    def __init__(self, pool: Pool, nominal: Nominal) -> None:
        self.pool = pool
        self.nominal = nominal
        self.spent: dict[Expr, tuple[int, ...]] = {}  # tear symbol to the rows it dropped out of
        self._forms: dict[Expr, tuple[dict[Expr, Polynomial], Expr] | None] = {}

    def linear(self, rows: tuple[int, ...], expr: Expr) -> LinearRow | None:
        """The row as polynomials in D; None if it is not linear in its torn variables."""
        if expr not in self._forms:
            self._forms[expr] = self._form(expr)
        form = self._forms[expr]
        return None if form is None else LinearRow(rows, *form)

    def _form(self, expr: Expr) -> tuple[dict[Expr, Polynomial], Expr] | None:
        pool = self.pool
        tears = [s for s in symbols(expr) if s.symbol.kind is Kind.TEAR]
        forms: dict[Expr, tuple[dict[tuple[Expr, int], Expr], Expr]] = {
            t: ({(t, 0): pool.one}, pool.zero) for t in tears
        }
        for node in topological([expr]):
            inside = [a for a in node.args if a in forms]
            if node in forms or not inside:
                continue
            if node.op is Op.ADD:
                entries: dict[tuple[Expr, int], list[Expr]] = {}
                rests = []
                for c, arg in zip(node.coefficients, node.args, strict=True):
                    part, rest = forms.get(arg, ({}, arg))
                    rests.append((c, rest))
                    for key, value in part.items():
                        entries.setdefault(key, []).append(pool.scale(c, value))
                total = {k: pool.add(*[(1, v) for v in vs]) for k, vs in entries.items()}
                forms[node] = total, pool.add(*rests)
            elif node.op is Op.MUL and len(inside) == 1:
                others = pool.mul(
                    *[
                        pool.power(a, e)
                        for a, e in zip(node.args, node.exponents, strict=True)
                        if a is not inside[0]
                    ]
                )
                if node.exponents[node.args.index(inside[0])] != 1:
                    return None
                part, rest = forms[inside[0]]
                forms[node] = (
                    {k: pool.mul(v, others) for k, v in part.items()},
                    pool.mul(rest, others),
                )
            elif node.op is Op.DER:
                part, rest = forms[inside[0]]
                if not all(constant(v) for v in part.values()):
                    return None
                forms[node] = {(t, k + 1): v for (t, k), v in part.items()}, pool.der(rest)
            elif node.op is Op.INT:  # of the torn variable from zero, of the rest from its start
                part, rest = forms[inside[0]]
                if not all(constant(v) for v in part.values()):
                    return None
                forms[node] = (
                    {(t, k - 1): v for (t, k), v in part.items()},
                    pool.rebuild(node, (rest,)),
                )
            else:
                return None
        part, rest = forms[expr]
        if not all(constant(v) for v in part.values()):
            return None
        lowest = min((k for _, k in part), default=0)
        if lowest < 0:  # differentiated until no integral holds a torn variable
            part = {(t, k - lowest): v for (t, k), v in part.items()}
            for _ in range(-lowest):
                rest = pool.der(rest)
        polynomials: dict[Expr, Polynomial] = {}
        for (t, k), value in part.items():
            polynomial = polynomials.setdefault(t, [])
            polynomial.extend([pool.zero] * (k + 1 - len(polynomial)))
            polynomial[k] = pool.add((1, polynomial[k]), (1, value))
        return _trim(polynomials), rest

    def relations(self, rows: list[LinearRow]) -> list[tuple[tuple[int, ...], Expr]]:
        """Combine rows crosswise until each torn variable has dropped out of the others."""
        found = []
        while rows:
            rows.sort(key=lambda r: (len(r.entries), max(map(len, r.entries.values()), default=0)))
            pivot = rows.pop(0)
            if not pivot.entries:
                found.append((pivot.rows, pivot.rest))
                continue
            symbol = min(pivot.entries, key=lambda t: (len(pivot.entries[t]), t.id))
            self.spent[symbol] = pivot.rows
            rows = [self._combine(r, pivot, symbol) if symbol in r.entries else r for r in rows]
        return found

    def remainder(self, rows: list[LinearRow | None]) -> tuple[int, LinearRow] | None:
        """A row of lower degree for one of two rows in the same torn variable: where, and what.

        One step of Euclid's algorithm. Repeated, it gives the variable itself where the two
        polynomials have no common factor. None where no two rows hold one and the same variable
        alone, or the step divides by what is zero at the nominal parameters.
        """
        alone: dict[Expr, list[int]] = {}
        for at, row in enumerate(rows):
            if row is not None and len(row.entries) == 1:
                (symbol,) = row.entries
                alone.setdefault(symbol, []).append(at)
        for symbol, places in alone.items():
            degrees = sorted((len(row.entries[symbol]), at) for at in places if (row := rows[at]))
            if len(degrees) < 2 or degrees[0][0] < 2:
                continue
            at = degrees[1][1]
            low, high = rows[degrees[0][1]], rows[at]
            assert low is not None and high is not None
            lead = low.entries[symbol][-1]
            if not self.nominal.vanishes(lead):
                return at, self._divided(high, low, symbol)
        return None

    def _divided(self, high: LinearRow, low: LinearRow, symbol: Expr) -> LinearRow:
        """The higher row less the lower one, differentiated and scaled so that the top goes."""
        pool = self.pool
        a, b = high.entries[symbol], low.entries[symbol]
        shift = len(a) - len(b)
        factor = pool.div(a[-1], b[-1])
        scaled = [pool.zero] * shift + [pool.mul(factor, c) for c in b]
        rest = low.rest
        for _ in range(shift):
            rest = pool.der(rest)
        entries = _trim({symbol: self._minus(a[:-1], scaled[:-1])})
        rows = tuple(dict.fromkeys((*low.rows, *high.rows)))
        return LinearRow(rows, entries, pool.sub(high.rest, pool.mul(factor, rest)))

    def written(self, row: LinearRow) -> Expr:
        """The row as one expression."""
        parts = [self._apply(polynomial, t) for t, polynomial in row.entries.items()]
        return self.pool.add(*[(1, part) for part in (*parts, row.rest)])

    def _combine(self, row: LinearRow, pivot: LinearRow, symbol: Expr) -> LinearRow:
        """pivot's polynomial times `row` minus row's polynomial times `pivot`."""
        own, other = self._reduced(row.entries[symbol], pivot.entries[symbol])
        entries: dict[Expr, Polynomial] = {}
        for t in dict.fromkeys([*row.entries, *pivot.entries]):
            if t is not symbol:
                left = self._times(other, row.entries.get(t, []))
                right = self._times(own, pivot.entries.get(t, []))
                entries[t] = self._minus(left, right)
        rest = self.pool.sub(self._apply(other, row.rest), self._apply(own, pivot.rest))
        return LinearRow((*pivot.rows, *row.rows), _trim(entries), rest)

    def _reduced(self, a: Polynomial, b: Polynomial) -> tuple[Polynomial, Polynomial]:
        """Both polynomials without a common factor in D."""
        if len(a) > 1 and len(b) > 1 and share_factor(a, b):
            if len(symbols(*a, *b)) > _FEW or monomials([*a, *b]) > _SHORT:
                return without_common_divisor(self.pool, a, b, self.nominal.vanishes)
            from bondgraph.passes.solve_symbolic import without_common_factor

            return without_common_factor(self.pool, a, b)
        shift = min(_lowest(a), _lowest(b))
        return a[shift:], b[shift:]

    def _times(self, a: Polynomial, b: Polynomial) -> Polynomial:
        if not a or not b:
            return []
        terms: list[list[Expr]] = [[] for _ in range(len(a) + len(b) - 1)]
        for i, x in enumerate(a):
            for j, y in enumerate(b):
                terms[i + j].append(self.pool.mul(x, y))
        return [self.pool.add(*[(1, t) for t in ts]) for ts in terms]

    def _minus(self, a: Polynomial, b: Polynomial) -> Polynomial:
        zero = self.pool.zero
        size = max(len(a), len(b))
        a, b = a + [zero] * (size - len(a)), b + [zero] * (size - len(b))
        return [self.pool.sub(x, y) for x, y in zip(a, b, strict=True)]

    def _apply(self, polynomial: Polynomial, expr: Expr) -> Expr:
        terms = []
        for coefficient in polynomial:
            terms.append((1, self.pool.mul(coefficient, expr)))
            expr = self.pool.der(expr)
        return self.pool.add(*terms)


def _trim(entries: dict[Expr, Polynomial]) -> dict[Expr, Polynomial]:
    """Without leading coefficients, and without entries, that are identically zero."""
    kept = {}
    for t, polynomial in entries.items():
        size = len(polynomial)
        while size and is_zero(polynomial[size - 1]):
            size -= 1
        if size:
            kept[t] = polynomial[:size]
    return kept


def _lowest(polynomial: Polynomial) -> int:
    return next(k for k, c in enumerate(polynomial) if not is_zero(c))
