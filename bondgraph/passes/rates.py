"""Take the rate of a torn variable out of rows, where another row says what it is.

A hidden state whose equation signals multiply, as the voltage inside a capacitor with losses
behind a duty cycle: one row gives its rate, x' = a x + b. Put into the other rows it leaves x
there without derivative, however signals stand around it, so that an algebraic loop gives x. This
is the reduction of the index by one, a state at a time (Gear, 1988).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols, topological
from bondgraph.passes.descent import Lowered
from bondgraph.passes.lowering.derivative import Jets, TooManyOperations
from bondgraph.passes.solve import affine, constant
from bondgraph.passes.summands import summands
from bondgraph.passes.zero import is_zero

_LARGE = 3000  # new nodes that one row is worth
_TURNS = 8  # a derivative of a derivative of a rate holds rates again


class Rates:
    """Rows that vanish, with their derivatives moved inwards to the torn variables."""

    def __init__(self, pool: Pool, vanishes: Callable[[Expr], bool] = lambda _: False) -> None:
        self.pool = pool
        self.vanishes = vanishes
        self._jets = Jets(pool)

    def lowered(self, rows: Sequence[Expr]) -> Lowered | None:
        """A row that another one frees of the derivatives of a torn variable; None without any.

        With the row that gives the rate the new one is equivalent to the old. A rate that only a
        constant divides is preferred.

        >>> p = Pool(); x, y = p.symbol("x", Kind.TEAR), p.symbol("y", Kind.SENSOR)
        >>> rows = [p.add((1, p.der(x)), (3, x)), p.add((1, p.der(p.mul(y, x))), (-1, y))]
        >>> Rates(p).lowered(rows).expr
        x*D(y) - y - 3*x*y
        """
        inward = [self._inward(row) for row in rows]
        for plain in (True, False):
            for by, giving in enumerate(inward):
                found = None if giving is None else self._rate(giving, plain)
                if found is None:
                    continue
                for row, other in enumerate(inward):
                    if row == by or other is None or not _at_least(other, found[0]):
                        continue
                    freed = self._freed(other, *found)
                    if freed is not None:
                        return Lowered(row, by, freed)
        return None

    def _inward(self, row: Expr) -> Expr | None:
        """The row with D on symbols only; None where an integral holds a torn variable."""
        nodes = topological([row])
        if any(n.op in (Op.INT, Op.ROOT) and _torn(n) for n in nodes):
            return None
        try:
            return self._jets.of(row, 0, _LARGE)
        except TooManyOperations:
            return None

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

    def _freed(self, row: Expr, rate: Expr, value: Expr) -> Expr | None:
        """The row with the rate, and what is derived from it, replaced by its value."""
        for _ in range(_TURNS):
            high = _at_least(row, rate)
            if not high:
                return _whole(self.pool, row)
            try:
                values = {n: self._jets.of(value, _order(n) - _order(rate), _LARGE) for n in high}
            except TooManyOperations:
                return None
            row = self.pool.substitute([row], values)[0]
        return None


def _whole(pool: Pool, row: Expr) -> Expr:
    """The row times what divides its terms, so that nothing has to be divided by a modulus."""
    terms = summands(row)
    divisors: dict[Expr, int] = {}
    for term in terms:
        if term.op is Op.MUL:
            for base, power in zip(term.args, term.exponents, strict=True):
                if power < 0 and not constant(base) and not _torn(base):
                    divisors[base] = max(divisors.get(base, 0), -power)
    factor = pool.mul(*[pool.power(base, power) for base, power in divisors.items()])
    return pool.add(*[(c, pool.mul(term, factor)) for term, c in terms.items()])


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
