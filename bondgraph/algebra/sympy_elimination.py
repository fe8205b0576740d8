"""The steps of an elimination in SymPy: solve for an unknown, put in, lower, compare.

Differential elimination is the division of Ritt (Differential Algebra, 1950): of two rows that hold
an unknown, the one of lower order gives its highest derivative, and takes it out of the other.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import product
from typing import Any, NamedTuple

import sympy as sp

from bondgraph.algebra.symbolic import t
from bondgraph.algebra.sympy_signals import name_of, taken, undone
from bondgraph.ir.functions import FUNCTIONS

_SWITCHES = 6  # conditions in each of whose positions relations are compared
_LARGE = 4000  # operations of a row that nobody would follow


class Unshown(Exception):
    """A step that this algebra does not have; says why."""


class Change(NamedTuple):
    """What happens to row `row` of a loop, which becomes `expr` = 0 unless it is used up.

    It gives `unknown` = `expr` for good (`solved`); or it is differentiated `times` times, so that
    no integral holds a torn unknown; or what row `by` says is put in, `times` differentiated: of
    the unknown, or of its highest derivative (`lowered`).
    """

    row: int
    by: int
    unknown: Any
    expr: Any
    times: int = 0
    solved: bool = False
    lowered: bool = False


def put_in(expr: Any, values: Mapping[Any, Any]) -> Any:
    """The expression with values for unknowns, its derivatives taken."""
    return taken(expr.xreplace(dict(values))) if values else expr


def solve_for(zero: Any, unknown: Any) -> Any:
    """The value of an unknown at which `zero` vanishes; raises `Unshown` where there is no one.

    >>> e, f = (sp.Function(n, real=True)(t) for n in "ef")
    >>> solve_for(e - 2*f, f)
    e(t)/2
    """
    x = sp.Dummy("x", real=True)
    found = zero.xreplace({unknown: x})
    if any(x in d.free_symbols for d in found.atoms(sp.Derivative, sp.Integral)):
        raise Unshown("the equation holds its unknown and a derivative of it")
    return _solved(found, x)


def linear(zero: Any, unknown: Any) -> bool:
    """Whether an equation holds an unknown once, times something that no condition changes."""
    slope = sp.diff(zero.xreplace({unknown: (x := sp.Dummy("x", real=True))}), x)
    return not slope.has(x) and not slope.has(sp.Piecewise)


def _solved(zero: Any, x: Any) -> Any:
    slope = sp.diff(zero, x)
    if not slope.has(x) and not slope.has(sp.Piecewise):
        if slope == 0:
            raise Unshown("the unknown has dropped out of its equation")
        rest = zero.xreplace({x: sp.Integer(0)})
        return sp.expand(-rest / slope) if slope.is_number else -rest / slope
    condition = _condition([zero])
    if condition is not None and not condition.has(x):
        yes, no = (_solved(in_position(zero, {condition: at}), x) for at in (True, False))
        return sp.Piecewise((yes, condition), (no, True))
    found = _peeled(zero, x)
    if found is None:
        found = _polynomial(zero, x)
    if found is None:
        raise Unshown("the equation has no closed solution")
    return found


def _peeled(value: Any, x: Any) -> Any:
    """A chain of one-to-one functions turned around, from the outside to the unknown."""
    target: Any = sp.Integer(0)
    while value != x:
        inside = [a for a in value.args if a.has(x)]
        if len(inside) != 1:
            return None
        at = value.args.index(inside[0])
        if value.is_Add:
            target = target - (value - inside[0])
        elif value.is_Mul:
            target = target / (value / inside[0])
        elif value.is_Pow and at == 0 and value.exp in (-1, 2, sp.Rational(1, 2)):
            if value.exp == 2:
                return None
            target = target ** (1 / value.exp)
        else:
            target = undone(value, at, target)
            if target is None:
                return None
        value = inside[0]
    return target


def _polynomial(zero: Any, x: Any) -> Any:
    """The value where the numerator is linear in the unknown."""
    above = sp.fraction(sp.together(zero))[0]
    if not above.is_polynomial(x):
        return None
    found = sp.Poly(above, x)
    if found.degree() != 1:
        return None
    slope, rest = found.all_coeffs()
    return sp.factor_terms(-rest / slope)


def order(expr: Any, unknown: Any) -> int:
    """The highest derivative of an unknown in an expression; -1 where it is not there.

    Raises `Unshown` where it stands in an integral.
    """
    if any(i.has(unknown) for i in expr.atoms(sp.Integral)):
        raise Unshown("an integral holds a torn unknown")
    orders = [int(d.derivative_count) for d in expr.atoms(sp.Derivative) if d.expr == unknown]
    return max(orders, default=0 if expr.has(unknown) else -1)


class Loop:
    """Rows that hold torn unknowns; the rows that are left hold none."""

    def __init__(self, rows: Sequence[Any], unknowns: Sequence[Any]) -> None:
        self.rows = dict(enumerate(rows))
        self.unknowns = list(unknowns)
        self.below: list[Any] = []  # what rows were multiplied with

    def changes(self) -> Iterator[Change]:
        """Take the unknowns out of the rows, one after the other; raises `Unshown`."""
        for at in self.rows:
            while any(i.has(u) for i in self.rows[at].atoms(sp.Integral) for u in self.unknowns):
                self.rows[at] = taken(sp.diff(self.rows[at], t))
                yield Change(at, at, None, self.rows[at], 1)
        while self.unknowns:
            plain = self._plain()
            if plain is None:
                rank = {u: max(order(e, u) for e in self.rows.values()) for u in self.unknowns}
                yield from self._divided(min(self.unknowns, key=lambda u: rank[u]))
            else:
                yield from self._solved(*plain)

    def _plain(self) -> tuple[int, Any] | None:
        """A row that holds an unknown without a derivative and gives it, the plainest first."""
        found: list[tuple[Any, int, Any]] = []
        for unknown in self.unknowns:
            for at, row in self.rows.items():
                if order(row, unknown) == 0:
                    slope = sp.diff(row.xreplace({unknown: (x := sp.Dummy("x", real=True))}), x)
                    nested = any(slope.has(u) for u in self.unknowns)
                    rank = (slope.has(x), nested, slope.has(t), len(found))
                    found.append((rank, at, unknown))
        for _, at, unknown in sorted(found, key=lambda f: f[0]):
            with suppress(Unshown):
                solve_for(self.rows[at], unknown)
                return at, unknown
        return None

    def _solved(self, at: int, unknown: Any) -> Iterator[Change]:
        """An unknown from a row, put into the others."""
        value = solve_for(self.rows.pop(at), unknown)
        self.unknowns.remove(unknown)
        yield Change(at, at, unknown, value, solved=True)
        for other, row in self.rows.items():
            if row.has(unknown):
                self.rows[other] = self._short(put_in(row, {unknown: value}))
                yield Change(other, at, unknown, self.rows[other])

    def _divided(self, unknown: Any) -> Iterator[Change]:
        """An unknown out of all rows but one, which is left out then."""
        while True:
            orders = {at: order(row, unknown) for at, row in self.rows.items()}
            holders = sorted([at for at, n in orders.items() if n >= 0], key=lambda at: orders[at])
            by, *others = holders or (-1,)
            if not others:
                self.rows.pop(by, None)
                self.unknowns.remove(unknown)
                return
            if orders[by] == 0:
                yield from self._solved(by, unknown)
                return
            at = others[-1]
            x, top = sp.Dummy("x", real=True), sp.Derivative(unknown, (t, orders[by]))
            times = orders[at] - orders[by]
            value = _solved(self.rows[by].xreplace({top: x}), x)
            risen = taken(sp.diff(value, (t, times))) if times else value
            highest = sp.Derivative(unknown, (t, orders[at]))
            self.rows[at] = self._short(taken(self.rows[at].xreplace({highest: risen})))
            yield Change(at, by, unknown, self.rows[at], times, lowered=True)


    def _short(self, row: Any) -> Any:
        """The numerator of a row, as one sum."""
        if row.count_ops() > _LARGE:
            raise Unshown("the rows of the loop become too long to be followed")
        if row.has(sp.Piecewise):
            return row
        above, below = sp.fraction(sp.cancel(sp.together(row)))
        self.below.append(below)
        return sp.expand(above)


# ------------------------------------------------------------------------------ comparison


def factor_of(derived: Any, wanted: Any, below: Sequence[Any] = ()) -> Any:
    """By what a derived relation is a multiple of another; None where it is none.

    A factor is made of parameters, of numbers and of what either relation is divided by, or was on
    the way (`below`): what may vanish on its own is none. In each position of a switch there may be
    another one. Whatever is there is a multiple of a relation that is zero in some position.

    >>> y, u = (sp.Function(n, real=True)(t) for n in "yu"); a, b = sp.symbols("a b")
    >>> factor_of(y/a - u/b, b*y - a*u), factor_of(y - u, y + u)
    (1/(a*b), None)
    """
    positions = _positions([derived, wanted])
    found = []
    for setting in positions:
        own = _factor(*[in_position(e, setting) for e in (derived, wanted, *below)])
        if own is None:
            return None
        found.append(own)
    told = [f for f in found if f is not sp.nan]
    if not told:
        return None
    if all(f == told[0] for f in told):
        return told[0]
    pieces = [
        (f, sp.And(*[c if on else sp.Not(c) for c, on in setting.items()]))
        for f, setting in zip(found, positions, strict=True)
        if f is not sp.nan
    ]
    return sp.Piecewise(*pieces[:-1], (pieces[-1][0], True))


def _factor(derived: Any, wanted: Any, *below: Any) -> Any:
    """The factor in one position of all switches; nan where any will do."""
    atoms = _Atoms()
    one, other = (sp.fraction(sp.cancel(sp.together(atoms.plain(e)))) for e in (derived, wanted))
    if other[0] == 0:
        return sp.nan
    if one[0] == 0:
        return None
    ratio = sp.cancel((one[0] * other[1]) / (other[0] * one[1]))
    divided = sp.Mul(one[1], other[1], *atoms.below, *[atoms.plain(e) for e in below])
    for part in sp.fraction(ratio):
        for base, _ in sp.factor_list(part)[1]:
            moving = base.free_symbols & atoms.moving
            if moving and not _divides(base, divided):
                return None
    return atoms.back(ratio)


def _divides(base: Any, product_: Any) -> bool:
    return bool(sp.fraction(sp.cancel(product_ / base))[1].is_number)


def _positions(exprs: Sequence[Any]) -> list[dict[Any, bool]]:
    """All positions of the conditions that expressions hold."""
    conditions: list[Any] = []
    rest = list(exprs)
    while (condition := _condition(rest)) is not None:
        conditions.append(condition)
        if len(conditions) > _SWITCHES:
            raise Unshown(f"it has more than {_SWITCHES} conditions")
        rest = [in_position(e, {condition: at}) for e in rest for at in (True, False)]
    settings = product((True, False), repeat=len(conditions))
    return [dict(zip(conditions, setting, strict=True)) for setting in settings]


def _condition(exprs: Iterable[Any]) -> Any:
    """A condition that chooses something outside of integrals, None where nothing is chosen."""
    for expr in exprs:
        walk = sp.preorder_traversal(expr)
        for node in walk:
            if isinstance(node, sp.Integral):
                walk.skip()
            elif isinstance(node, sp.Piecewise):
                found = node.args[0].cond
                while isinstance(found, (sp.And, sp.Or, sp.Not)):
                    found = found.args[0]
                return sp.Not(found) if isinstance(found, sp.Ne) else found
    return None


def in_position(expr: Any, setting: Mapping[Any, bool]) -> Any:
    """What an expression is while conditions hold or do not."""
    both = {c: sp.true if on else sp.false for c, on in setting.items()}
    both |= {sp.Not(c): sp.false if on else sp.true for c, on in setting.items()}
    return expr.xreplace(both)


class _Atoms:
    """Expressions as quotients of polynomials in symbols, equal parts as equal ones.

    `moving` are the symbols that stand for what changes with time, `below` what is divided by
    inside of functions.
    """

    def __init__(self) -> None:
        self.symbols: dict[Any, Any] = {}
        self.moving: set[Any] = set()
        self.below: list[Any] = []

    def plain(self, value: Any) -> Any:
        """The expression in symbols for all that is no arithmetic."""
        if value.is_Number or value.is_Symbol:
            return value
        if value.is_Add or value.is_Mul:
            return value.func(*[self.plain(a) for a in value.args])
        if value.is_Pow and value.exp.is_Integer:
            if value.exp < 0 and value.base.has(t):
                self.below.append(self.plain(value.base))
            return self.plain(value.base) ** value.exp
        if value.is_Pow and value.exp.is_Rational and value.exp.q == 2:
            return self.atom(sp.sqrt(self.normal(value.base))) ** value.exp.p
        if isinstance(value, sp.Integral):
            return self.integral(value)
        if isinstance(value, (sp.Derivative, sp.core.function.AppliedUndef)):
            return self.atom(value)
        args = [self.normal(a) for a in value.args]
        record = FUNCTIONS.get(name_of(value) or "")
        if record is not None and record.parity:  # of f(x) and f(-x) one form
            args, turned = [args[0]], [self.normal(-args[0])]
            if sp.default_sort_key(turned[0]) < sp.default_sort_key(args[0]):
                return record.parity * self.atom(value.func(*turned, evaluate=False))
        return self.atom(value.func(*args, evaluate=False))

    def integral(self, value: Any) -> Any:
        """The integral of a sum is a sum, with what is constant in front."""
        terms = []
        for term in sp.Add.make_args(sp.expand(self.normal(value.function))):
            still, moving = term.as_independent(t)
            terms.append(self.plain(still) * self.atom(sp.Integral(moving, *value.limits)))
        return sp.Add(*terms)

    def normal(self, value: Any) -> Any:
        """The argument of a function in the one form of all that are equal to it."""
        if isinstance(value, (sp.Basic,)) and not isinstance(value, sp.Expr):
            return value.func(*[self.normal(a) for a in value.args]) if value.args else value
        return self.back(sp.cancel(sp.together(self.plain(value))))

    def atom(self, value: Any) -> Any:
        if value not in self.symbols:
            symbol = sp.Symbol(f"a{len(self.symbols)}", real=True)
            self.symbols[value] = symbol
            if value.has(t):
                self.moving.add(symbol)
        return self.symbols[value]

    def back(self, value: Any) -> Any:
        """The expression that the symbols stand for."""
        return value.xreplace({s: v for v, s in self.symbols.items()})
