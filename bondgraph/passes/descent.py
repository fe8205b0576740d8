"""Take derivatives of torn variables out of rows, where another row gives them in known signals.

A row whose only unknown is D(u*x) says what D(u*x) is. Put into the other rows it may leave x
there without derivative, so that an algebraic loop gives it: as the stator of an induction motor
gives the rate of the rotor's current, and the rotor then the current itself.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols, topological
from bondgraph.ir.normal import Term
from bondgraph.passes.normalise import normalise

_LIMIT = 300  # coefficient operations of a row that is still worth writing out


class Lowered(NamedTuple):
    """Row `row` has become `expr` by what row `by` says of a derivative."""

    row: int
    by: int
    expr: Expr


class Descent:
    """Rows that vanish, each brought to its normal form once."""

    def __init__(self, pool: Pool, vanishes: Callable[[Expr], bool] = lambda _: False) -> None:
        self.pool = pool
        self.vanishes = vanishes
        self._forms: dict[Expr, tuple[Term, ...]] = {}

    def lowered(self, rows: Sequence[Expr]) -> Lowered | None:
        """A row that another one frees of a derivative of torn variables; None without any.

        With the row that gives the derivative the new one is equivalent to the old, and it holds
        fewer derivatives. A coefficient that `vanishes` at the nominal parameters is not divided
        by.

        >>> p = Pool(); x, y = p.symbol("x", Kind.TEAR), p.symbol("y", Kind.SENSOR)
        >>> z = p.mul(y, x)
        >>> Descent(p).lowered([p.sub(p.der(z), y), p.add((1, x), (2, p.der(z)))]).expr
        x + 2*y
        """
        for by, giving in enumerate(rows):
            torn = [term for term in self._form(giving) if _torn(term.atom)]
            if len(torn) != 1 or torn[0].order < 1 or self.vanishes(torn[0].coefficient):
                continue
            for row, other in enumerate(rows):
                if row != by and any(_above(term, torn[0]) for term in self._form(other)):
                    return Lowered(row, by, self._freed(other, giving, torn[0]))
        return None

    def _freed(self, row: Expr, giving: Expr, pivot: Term) -> Expr:
        """The row with the value of the pivot's derivative in place of it and its derivatives."""
        pool = self.pool
        rest = [(-1, self._written(term)) for term in self._form(giving) if term is not pivot]
        value = pool.div(pool.add(*rest), pivot.coefficient)
        parts = []
        for term in self._form(row):
            part = self._written(term)
            if _above(term, pivot):
                part = pool.mul(term.coefficient, self._derived(value, term.order - pivot.order))
            parts.append((1, part))
        return pool.add(*parts)

    def _form(self, row: Expr) -> tuple[Term, ...]:
        """The row as a sum of derivatives; empty where it is too long or holds integrals."""
        if row not in self._forms:
            whole = all(n.op is not Op.INT for n in topological([row]))
            self._forms[row] = normalise(self.pool, row, _LIMIT).terms if whole else ()
        return self._forms[row]

    def _written(self, term: Term) -> Expr:
        return self.pool.mul(term.coefficient, self._derived(term.atom, term.order))

    def _derived(self, expr: Expr, times: int) -> Expr:
        for _ in range(times):
            expr = self.pool.der(expr)
        return expr


def _above(term: Term, pivot: Term) -> bool:
    return term.atom is pivot.atom and term.order >= pivot.order


def _torn(expr: Expr) -> bool:
    return any(s.symbol.kind is Kind.TEAR for s in symbols(expr))
