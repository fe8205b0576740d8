"""Solve loops: a torn variable is taken as known, and the relations left over give it back.

Equations that hold torn variables are rows of a linear system whose entries are polynomials in
D = d/dt with constant coefficients. A row that holds a torn variable without derivative gives it
(an algebraic loop); rows that hold only derivatives are combined crosswise, so that the variable
drops out (a differential loop). What is left without torn variables is a relation.
"""

from __future__ import annotations

from contextlib import suppress
from typing import NamedTuple

from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols, topological
from bondgraph.passes.fractions import monomials, without_common_divisor
from bondgraph.passes.implicit import invert
from bondgraph.passes.nominal import Nominal
from bondgraph.passes.solve import ITERATED, Solution, affine, constant, solve
from bondgraph.passes.zero import is_zero, share_factor

Polynomial = list[Expr]  # coefficients of D**0, D**1, ...

#: Parameters, and terms, up to which two polynomials are divided in expanded form.
_FEW, _SHORT = 5, 60


class _Row(NamedTuple):
    """An equation in torn variables: `rows` are the equations it was combined from."""

    rows: tuple[int, ...]
    expr: Expr


class _LinearRow(NamedTuple):
    """sum of polynomial(D) tear + rest = 0."""

    rows: tuple[int, ...]
    entries: dict[Expr, Polynomial]
    rest: Expr


class Loops:
    """The torn variables of one elimination and the rows that hold them."""

    def __init__(self, pool: Pool, nominal: Nominal) -> None:
        self.pool = pool
        self.nominal = nominal
        self.variable: dict[Expr, Expr] = {}  # tear symbol to the variable it stands for
        self.solved: dict[Expr, _Row] = {}  # tear symbol to its value and rows
        self.spent: dict[Expr, tuple[int, ...]] = {}  # tear symbol to the rows it dropped out of
        self.pending: list[_Row] = []
        self.plain: list[_Row] = []
        self.lost: list[tuple[int, ...]] = []
        self.unsolvable: set[tuple[Expr, Expr]] = set()
        self.identities = 0  # relations that hold whatever the machine does

    def tear(self, variable: Expr) -> Expr:
        """Take a variable as known: the symbol that stands for its value."""
        symbol = self.pool.symbol(f"{variable.symbol.name}?", Kind.TEAR)
        self.variable[symbol] = variable
        return symbol

    def row(self, row: int, expr: Expr) -> None:
        """An equation all of whose variables have been computed, some from torn ones."""
        solved = [t for t in self._tears(expr) if t in self.solved]
        rows = [r for t in solved for r in self.solved[t].rows]
        if solved:
            values = self.solutions()
            if any(t not in values for t in solved):
                raise ZeroDivisionError  # by what the loop makes zero: the count will miss it
            expr = self.pool.substitute([expr], values)[0]
        item = _Row((*dict.fromkeys(rows), row), expr)
        (self.pending if self._tears(expr) else self.plain).append(item)

    def open_in(self, expr: Expr) -> bool:
        """Whether an expression holds a torn variable that has no value yet."""
        return any(t not in self.solved for t in self._tears(expr))

    def rows_for(self, variable: Expr) -> tuple[int, ...]:
        """The equations that gave a torn variable its value, or that it dropped out of."""
        symbol = self.pool.symbol(f"{variable.symbol.name}?", Kind.TEAR)
        if symbol in self.solved:
            return self.solved[symbol].rows
        return self.spent.get(symbol, ())

    def refused(self) -> list[tuple[int, ...]]:
        """The equations of each loop that could not be solved and so cost a relation."""
        return self.lost

    def solutions(self) -> dict[Expr, Expr]:
        """The value of each solved tear, free of solved tears; none where it divides by zero."""
        final: dict[Expr, Expr] = {}
        for symbol in reversed(self.solved):  # a value holds only tears that were solved later
            with suppress(ZeroDivisionError):
                final[symbol] = self.pool.substitute([self.solved[symbol].expr], final)[0]
        return final

    def _tears(self, expr: Expr) -> list[Expr]:
        if not self.variable:
            return []
        return [s for s in symbols(expr) if s.symbol.kind is Kind.TEAR]

    # -------------------------------------------------------- algebraic loops

    def solve_algebraic(self) -> None:
        """Give a value to every torn variable that some row holds without derivative."""
        while self.pending:
            pivots = (
                (item, pivot)
                for attempt in (self._pivot, self._nested)
                for item in self.pending
                if (pivot := attempt(item)) is not None
            )
            found = next(pivots, None)
            if found is None:
                return
            item, (symbol, value) = found
            self.pending.remove(item)
            self._record(symbol, _Row(item.rows, value))

    def _nested(self, item: _Row) -> tuple[Expr, Expr] | None:
        """A torn variable that a nonlinear row gives in terms of other torn ones."""
        for symbol in self._tears(item.expr):
            if not _differentiated(item.expr, symbol):
                found = self._solve(item.expr, symbol)
                if found is not None:
                    return symbol, found.value
        return None

    def _solve(self, zero: Expr, symbol: Expr) -> Solution | None:
        """The value of a torn variable, by iteration where there is no closed form."""
        if (zero, symbol) in self.unsolvable:
            return None
        found = solve(self.pool, zero, symbol, self.nominal.vanishes)
        if found is None and affine(self.pool, zero, symbol) is None:
            value = invert(self.pool, zero, symbol, self.nominal.value, self.variable[symbol])
            found = None if value is None else Solution(value, ITERATED, True)
        if found is None:
            self.unsolvable.add((zero, symbol))
        return found

    def _pivot(self, item: _Row) -> tuple[Expr, Expr] | None:
        """A torn variable of the row and its value from it."""
        tears = self._tears(item.expr)
        fallback = None
        for symbol in tears:
            parts = affine(self.pool, item.expr, symbol)
            if parts is None:
                if len(tears) == 1 and not _differentiated(item.expr, symbol):
                    found = self._solve(item.expr, symbol)
                    if found is not None:
                        return symbol, found.value
                continue
            slope = parts[0]
            if self._tears(slope) or is_zero(slope):
                continue
            found = solve(self.pool, item.expr, symbol, self.nominal.vanishes)
            if found is None:
                continue
            if constant(slope):
                return symbol, found.value
            fallback = fallback or (symbol, found.value)
        return fallback

    def _record(self, symbol: Expr, value: _Row) -> None:
        self.solved[symbol] = value
        still = []
        for item in self.pending:
            try:
                expr = self.pool.substitute([item.expr], {symbol: value.expr})[0]
            except ZeroDivisionError:
                continue  # it divides by what the loop makes zero: the count will miss it
            if expr is item.expr:
                still.append(item)
                continue
            combined = _Row(tuple(dict.fromkeys((*value.rows, *item.rows))), expr)
            (still if self._tears(expr) else self.plain).append(combined)
        self.pending = still

    # ----------------------------------------------------- differential loops

    def relations(self) -> tuple[list[tuple[tuple[int, ...], Expr]], int]:
        """All relations free of torn variables, with the equations each was combined from.

        The second value counts relations that exist but were lost in a nonlinear loop.
        """
        self.solve_algebraic()
        found = [(item.rows, item.expr) for item in self.plain]
        linear: list[_LinearRow] = []
        nonlinear: list[_Row] = []
        for item in self.pending:
            row = self._linear(item)
            if row is None:
                nonlinear.append(item)
            else:
                linear.append(row)
        stuck, free = self._stuck(nonlinear, linear)
        held = [item.rows for item in nonlinear] + [r.rows for r in linear if r not in free]
        found += self._cross(free)
        lost = max(0, len(held) - len(stuck))
        if lost:
            self.lost.append(tuple(r for rows in held for r in rows))
        telling = [(rows, expr) for rows, expr in found if not is_zero(expr)]
        self.identities = len(found) - len(telling)
        return telling, lost

    def _stuck(
        self, nonlinear: list[_Row], linear: list[_LinearRow]
    ) -> tuple[set[Expr], list[_LinearRow]]:
        """The torn variables tied to a nonlinear row, and the linear rows free of them."""
        stuck = {t for item in nonlinear for t in self._tears(item.expr)}
        free = list(linear)
        while tied := [r for r in free if any(t in stuck for t in r.entries)]:
            stuck.update(t for r in tied for t in r.entries)
            free = [r for r in free if r not in tied]
        return stuck, free

    def _linear(self, item: _Row) -> _LinearRow | None:
        """The row as polynomials in D; None if it is not linear in its torn variables."""
        pool = self.pool
        tears = set(self._tears(item.expr))
        forms: dict[Expr, tuple[dict[tuple[Expr, int], Expr], Expr]] = {
            t: ({(t, 0): pool.one}, pool.zero) for t in tears
        }
        for node in topological([item.expr]):
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
            else:
                return None
        part, rest = forms[item.expr]
        if not all(constant(v) for v in part.values()):
            return None
        polynomials: dict[Expr, Polynomial] = {}
        for (t, k), value in part.items():
            polynomial = polynomials.setdefault(t, [])
            polynomial.extend([pool.zero] * (k + 1 - len(polynomial)))
            polynomial[k] = pool.add((1, polynomial[k]), (1, value))
        return _LinearRow(item.rows, _trim(polynomials), rest)

    def _cross(self, rows: list[_LinearRow]) -> list[tuple[tuple[int, ...], Expr]]:
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

    def _combine(self, row: _LinearRow, pivot: _LinearRow, symbol: Expr) -> _LinearRow:
        """pivot's polynomial times `row` minus row's polynomial times `pivot`."""
        own, other = self._reduced(row.entries[symbol], pivot.entries[symbol])
        entries: dict[Expr, Polynomial] = {}
        for t in dict.fromkeys([*row.entries, *pivot.entries]):
            if t is not symbol:
                left = self._times(other, row.entries.get(t, []))
                right = self._times(own, pivot.entries.get(t, []))
                entries[t] = self._minus(left, right)
        rest = self.pool.sub(self._apply(other, row.rest), self._apply(own, pivot.rest))
        return _LinearRow((*pivot.rows, *row.rows), _trim(entries), rest)

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


def _differentiated(expr: Expr, symbol: Expr) -> bool:
    """Whether a derivative or an integral holds the symbol."""
    holding = set()
    for node in topological([expr]):
        if node is symbol or any(a in holding for a in node.args):
            if node.op in (Op.DER, Op.INT):
                return True
            holding.add(node)
    return False
