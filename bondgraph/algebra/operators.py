"""Operator elimination: torn variables whose derivatives stand in rows drop out of them.

Rows that are linear in them, with polynomials in D = d/dt of constant coefficients, are multiplied
by what the polynomials do not share: the polynomial null space (Frisk and Nyberg, 2001).
In any other row the highest derivative of a variable is replaced by what another row says it is:
the division of Ore (1933), which reduces the index by one (Gear, 1988).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from bondgraph.algebra.affine import affine
from bondgraph.algebra.cleared import below_terms, cleared
from bondgraph.algebra.derivative import Jets, TooManyOperations
from bondgraph.algebra.fractions import monomials, trimmed, without_common_divisor
from bondgraph.algebra.normalise import normalise
from bondgraph.algebra.zero import is_zero, share_factor
from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols, topological
from bondgraph.ir.nodes import constant, has, linear_terms
from bondgraph.text.tuples import NamedTuple

Polynomial = list[Expr]  # coefficients of D**0, D**1, ...

#: Parameters, and terms, up to which two polynomials are divided in expanded form.
_FEW, _SHORT = 5, 60

_LIMIT = 300  # coefficient operations of a row that is worth writing as a sum of derivatives
_LARGE = 3000  # new nodes that one row is worth
_TURNS = 8  # a derivative of a derivative of a rate holds rates again


class LinearRow(NamedTuple):
    """sum of polynomial(D) tear + rest = 0, combined from the equations `rows`."""

    rows: tuple[int, ...]
    entries: dict[Expr, Polynomial]
    rest: Expr


class Lowered(NamedTuple):
    """Row `row` has become `expr` by what row `by` says of a derivative."""

    row: int
    by: int
    expr: Expr


class Operators:
    """The differential loops of one elimination.

    A coefficient that `vanishes` at the nominal parameters is not divided by.
    """

    def __init__(self, pool: Pool, vanishes: Callable[[Expr], bool] = lambda _: False) -> None:
        self.pool = pool
        self.vanishes = vanishes
        self.spent: dict[Expr, tuple[int, ...]] = {}  # tear symbol to the rows it dropped out of
        self._forms: dict[Expr, tuple[dict[Expr, Polynomial], Expr] | None] = {}
        self._jets = Jets(pool)
        self._summed: dict[Expr, Expr | None] = {}
        self._moved_in: dict[Expr, Expr | None] = {}

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
            own = [forms.get(a, ({}, a)) for a in node.args]
            terms = linear_terms(node, forms)
            if terms is not None:
                entries: dict[tuple[Expr, int], list[Expr]] = {}
                for term in [t for t in terms if t.arg in forms]:
                    factor = term.factor(pool)
                    for key, value in forms[term.arg][0].items():
                        entries.setdefault(key, []).append(pool.mul(factor, value))
                part = {k: pool.add(*[(1, v) for v in vs]) for k, vs in entries.items()}
            elif node.order:  # an integral: of the torn variable from zero
                inner = own[0][0]
                began = node.op is Op.INT and any(k > 0 for _, k in inner)  # int(x') knows where
                if began or not all(constant(v) for v in inner.values()):
                    return None
                part = {(t, k + node.order): v for (t, k), v in inner.items()}
            else:
                return None
            forms[node] = part, pool.rebuild(node, tuple([rest for _, rest in own]))
        part, rest = forms[expr]
        if not all(constant(v) for v in part.values()):
            return None
        lowest = min((k for _, k in part), default=0)
        if lowest < 0:  # differentiated until no integral holds a torn variable
            part = {(t, k - lowest): v for (t, k), v in part.items()}
            rest = pool.der(rest, -lowest)
        polynomials: dict[Expr, Polynomial] = {}
        for (t, k), value in part.items():
            polynomial = polynomials.setdefault(t, [])
            polynomial.extend([pool.zero] * (k + 1 - len(polynomial)))
            polynomial[k] = pool.add((1, polynomial[k]), (1, value))
        return _trim(polynomials), rest

    def relations(self, rows: list[LinearRow]) -> list[tuple[tuple[int, ...], Expr]]:
        """Combine rows by cross products until each torn variable has dropped out of the others."""
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

    # ------------------------------------------------- rows that are not linear, or not constant

    def lowered(self, rows: Sequence[Expr]) -> Lowered | None:
        """A row that another one frees of derivatives of a torn variable; None without any.

        A row whose torn variables are differentiated in one place alone says what stands there:
        D(u*x) as a whole, or, with D moved inwards to the variables, the rate of x. With that row
        the new one is equivalent to the old. What only a constant divides is preferred.

        >>> p = Pool(); x, y = p.symbol("x", Kind.TEAR), p.symbol("y", Kind.SENSOR)
        >>> z = p.mul(y, x)
        >>> work = Operators(p)
        >>> work.lowered([p.sub(p.der(z), y), p.add((1, x), (2, p.der(z)))]).expr
        x + 2*y
        >>> work.lowered([p.add((1, p.der(x)), (3, x)), p.add((1, p.der(z)), (-1, y))]).expr
        (x*D(y) - 3*x*y) - y
        """
        known = [n for n in topological(rows) if n.op is Op.INT and not _torn(n)]
        atoms = {n: self.pool.symbol(f"int#{n.id}", Kind.SENSOR) for n in known}
        rows = self.pool.substitute(rows, atoms)  # its derivative is what it is the integral of
        integrals = {atom: n for n, atom in atoms.items()}
        for form in (self._sum, self._inward):
            shaped = [form(row) for row in rows]
            for plain in (True, False):
                for by, giving in enumerate(shaped):
                    found = None if giving is None else self._rate(giving, plain)
                    if found is None:
                        continue
                    for row, other in enumerate(shaped):
                        if row == by or other is None or not _at_least(other, found[0]):
                            continue
                        freed = self._freed(other, *found, form)
                        if freed is not None:
                            return Lowered(row, by, self.pool.substitute([freed], integrals)[0])
        return None

    def _sum(self, row: Expr) -> Expr | None:
        """The row as a sum of derivatives; None where it is too long or holds a torn integral."""
        if row not in self._summed:
            pool = self.pool
            try:
                terms = () if has([row], Op.INT) else normalise(pool, row, _LIMIT).terms
            except ZeroDivisionError:  # by the derivative of a constant
                terms = ()
            parts = [pool.mul(t.coefficient, pool.der(t.atom, t.order)) for t in terms]
            self._summed[row] = pool.add(*[(1, part) for part in parts]) if parts else None
        return self._summed[row]

    def _inward(self, row: Expr) -> Expr | None:
        """The row with D on symbols only; None where an integral holds a torn variable."""
        if row not in self._moved_in:
            held = any(n.op in (Op.INT, Op.ROOT) and _torn(n) for n in topological([row]))
            try:
                self._moved_in[row] = None if held else self._jets.of(row, 0, _LARGE)
            except (TooManyOperations, ZeroDivisionError):
                self._moved_in[row] = None
        return self._moved_in[row]

    def _rate(self, row: Expr, plain: bool) -> tuple[Expr, Expr] | None:
        """The only derivative of torn variables in a row, and its value from it."""
        rates = [n for n in topological([row]) if n.op is Op.DER and _torn(n)]
        top = max(rates, key=_order, default=None)
        if top is None or any(_base(rate) is not _base(top) for rate in rates):
            return None
        parts = affine(self.pool, row, top)
        if parts is None or _torn(parts[0]) or constant(parts[0]) != plain or is_zero(parts[0]):
            return None
        if plain and self.vanishes(parts[0]):
            return None
        return top, self.pool.neg(self.pool.div(parts[1], parts[0]))

    def _freed(
        self, row: Expr, rate: Expr, value: Expr, form: Callable[[Expr], Expr | None]
    ) -> Expr | None:
        """The row with the rate, and what is derived from it, replaced by its value."""
        for _ in range(_TURNS):
            high = _at_least(row, rate)
            if not high:
                below = [d for d in below_terms(row) if not _torn(d)]
                return cleared(self.pool, row, below, inside=False)
            values = {n: self.pool.der(value, _order(n) - _order(rate)) for n in high}
            shaped = form(self.pool.substitute([row], values)[0])
            if shaped is None:
                return None
            row = shaped
        return None

    # ------------------------------------------------------------------------- polynomials

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
        before = [r for r in pivot.rows if r not in row.rows]
        return LinearRow((*before, *row.rows), _trim(entries), rest)

    def _reduced(self, a: Polynomial, b: Polynomial) -> tuple[Polynomial, Polynomial]:
        """Both polynomials without a common factor in D."""
        if len(a) > 1 and len(b) > 1 and share_factor(a, b):
            if len(symbols(*a, *b)) > _FEW or monomials([*a, *b]) > _SHORT:
                return without_common_divisor(self.pool, a, b, self.vanishes)
            from bondgraph.algebra.solve_symbolic import without_common_factor

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
        left = trimmed(polynomial)
        if left:
            kept[t] = left
    return kept


def _lowest(polynomial: Polynomial) -> int:
    return next(k for k, c in enumerate(polynomial) if not is_zero(c))


def _torn(expr: Expr) -> bool:
    return any(s.symbol.kind is Kind.TEAR for s in symbols(expr))


def _base(node: Expr) -> Expr:
    while node.op is Op.DER:
        node = node.args[0]
    return node


def _order(node: Expr) -> int:
    order = 0
    while node.op is Op.DER:
        order, node = order + 1, node.args[0]
    return order


def _at_least(row: Expr, rate: Expr) -> list[Expr]:
    """The derivatives in a row of the variable of a rate, of its order or above."""
    found = [n for n in topological([row]) if n.op is Op.DER and _base(n) is _base(rate)]
    return [n for n in found if _order(n) >= _order(rate)]
