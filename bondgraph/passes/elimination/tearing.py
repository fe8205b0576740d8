"""Solve loops: a torn variable is taken as known, and the relations left over give it back.

Equations that hold torn variables are rows of a linear system whose entries are polynomials in
D = d/dt with constant coefficients. A row that holds a torn variable without derivative gives it
(an algebraic loop); from rows that hold only derivatives operator elimination takes the variable
(a differential loop, `operators`). What is left without torn variables is a relation.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from operator import attrgetter

from bondgraph.algebra.affine import affine
from bondgraph.algebra.cleared import cleared, divisors
from bondgraph.algebra.conjugates import TwoValued, norm, two_valued
from bondgraph.algebra.implicit import invert
from bondgraph.algebra.nominal import Nominal
from bondgraph.algebra.operators import LinearRow, Operators
from bondgraph.algebra.solve import solve
from bondgraph.algebra.zero import is_zero
from bondgraph.ir.expr import CONSTANTS, Expr, Kind, Op, Pool, symbols, topological
from bondgraph.ir.nodes import holding
from bondgraph.text.tuples import NamedTuple


class _Row(NamedTuple):
    """An equation in torn variables: `rows` are the equations it was combined from."""

    rows: tuple[int, ...]
    expr: Expr


class _Price(NamedTuple):
    """What is to be avoided in a pivot, the worst first.

    It may give a torn variable in terms of others although the row is not linear in it, turn a law
    around, divide by a difference of parameters that nearly cancels (threshold pivoting: Duff,
    Erisman and Reid 1986, 5.4), or by signals: so many of them and of their derivatives.
    """

    nested: bool
    inverted: bool
    cancelling: bool
    divisors: int

    @property
    def last(self) -> bool:
        """Whether any row without this comes first."""
        return self.nested or self.cancelling


class _Offer(NamedTuple):
    """A row and a torn variable that it holds without derivative."""

    price: _Price
    item: _Row
    symbol: Expr


class _Pivot(NamedTuple):
    """An offer with the value of the variable."""

    offer: _Offer
    value: Expr


_price = attrgetter("price")
_PLAIN = _Price(nested=False, inverted=False, cancelling=False, divisors=0)


class _Tied(NamedTuple):
    """Places of pending rows that torn variables tie to a nonlinear one.

    `surplus` is how many relations they would give if these variables could be computed, `linear`
    are those of the rows that are linear.
    """

    members: list[int]
    surplus: int
    linear: list[LinearRow]


class Lost(NamedTuple):
    """A loop that could not be solved: its equations, and those that it cost as relations."""

    rows: tuple[int, ...]
    about: tuple[int, ...]


class Loops:
    """The torn variables of one elimination and the rows that hold them.

    If `patient`, no row is divided by a signal while another one can be freed of a derivative.
    """

    def __init__(
        self, pool: Pool, nominal: Nominal, patient: bool = False
    ) -> None:
        self.pool = pool
        self.nominal = nominal
        self.patient = patient
        self.operators = Operators(pool, nominal.vanishes)
        self.variable: dict[Expr, Expr] = {}  # tear symbol to the variable it stands for
        self.solved: dict[Expr, _Row] = {}  # tear symbol to its value and rows
        self.pending: list[_Row] = []
        self.plain: list[_Row] = []
        self.lost: list[Lost] = []  # what cost a relation
        self.tears: dict[Expr, list[Expr]] = {}  # expression to the torn variables in it
        self.priced: dict[Expr, list[tuple[_Price, Expr]]] = {}  # row to what it could give
        self.unsolvable: set[tuple[Expr, Expr]] = set()
        self.two_valued: list[TwoValued] = []  # torn variables that are known up to a choice of two
        self.identities = 0  # relations that hold whatever the machine does
        self.raised = False  # whether a derivative was put into another row

    def tear(self, variable: Expr) -> Expr:
        """Take a variable as known: the symbol that stands for its value."""
        symbol = self.pool.symbol(f"{variable.symbol.name}?", Kind.TEAR)
        self.variable[symbol] = variable
        return symbol

    def give(self, variable: Expr, rows: tuple[int, ...], value: Expr) -> None:
        """Take a variable whose value some equations give together as torn and solved for."""
        self._record(self.tear(variable), self._row(rows, value))

    def row(self, row: int, expr: Expr) -> None:
        """An equation all of whose variables have been computed, some from torn ones."""
        item = self._row((row,), expr)
        (self.pending if self._tears(item.expr) else self.plain).append(item)

    def _row(self, rows: tuple[int, ...], expr: Expr) -> _Row:
        """An expression with the values of those torn variables in it that have one."""
        solved = [t for t in self._tears(expr) if t in self.solved]
        below = [r for t in solved for r in self.solved[t].rows]
        if solved:
            values = self.solutions()
            if any(t not in values for t in solved):
                raise ZeroDivisionError  # by what the loop makes zero: the count will miss it
            expr = self.pool.substitute([expr], values)[0]
        return _Row(tuple(dict.fromkeys((*below, *rows))), expr)

    def open_in(self, expr: Expr) -> bool:
        """Whether an expression holds a torn variable that has no value yet, or two."""
        two = {known.variable for known in self.two_valued}
        return any(t not in self.solved or self.solved[t].expr in two for t in self._tears(expr))

    def rows_for(self, variable: Expr) -> tuple[int, ...]:
        """The equations that gave a torn variable its value, or that it dropped out of."""
        symbol = self.pool.symbol(f"{variable.symbol.name}?", Kind.TEAR)
        if symbol in self.solved:
            return self.solved[symbol].rows
        return self.operators.spent.get(symbol, ())

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
        if expr not in self.tears:
            self.tears[expr] = [s for s in symbols(expr) if s.symbol.kind is Kind.TEAR]
        return self.tears[expr]

    # -------------------------------------------------------- algebraic loops

    def solve_algebraic(self) -> None:
        """Give a value to every torn variable that some row holds without derivative.

        Rows are freed of derivatives before one is divided by what nearly cancels: they may give
        the same variable.
        """
        while self.pending:
            found = self._cheapest()
            dear = found is None or found.offer.price > _PLAIN
            patient = self.patient or (found is not None and found.offer.price.cancelling)
            if patient and dear and self._lower(self._tied()[0]):
                continue
            if found is None:
                return
            item = found.offer.item
            self.pending.remove(item)
            self._record(found.offer.symbol, _Row(item.rows, found.value))

    def _cheapest(self) -> _Pivot | None:
        """The first offer that has a solution."""
        for offer in self._offers():
            value = self._value(offer.item.expr, offer.symbol)
            if value is not None:
                return _Pivot(offer, value)
        return None

    def _offers(self) -> Iterable[_Offer]:
        """What rows could give: row after row, if `patient` the cheapest of all of them first."""
        if self.patient:
            return sorted((o for item in self.pending for o in self._in(item)), key=_price)
        each = [(last, item) for last in (False, True) for item in self.pending]
        return (o for last, item in each for o in self._in(item) if o.price.last is last)

    def _in(self, item: _Row) -> list[_Offer]:
        """The torn variables that a row holds without derivative, the cheapest first."""
        if item.expr not in self.priced:
            prices = ((s, self._priced(item.expr, s)) for s in self._tears(item.expr))
            found = [(price, symbol) for symbol, price in prices if price is not None]
            self.priced[item.expr] = sorted(found, key=lambda offer: offer[0])
        return [_Offer(price, item, symbol) for price, symbol in self.priced[item.expr]]

    def _priced(self, zero: Expr, symbol: Expr) -> _Price | None:
        """What it would take to have a torn variable from a row; None where it cannot give it."""
        if _differentiated(zero, symbol):
            return None
        parts = affine(self.pool, zero, symbol)
        if parts is None:
            return _Price(len(self._tears(zero)) > 1, True, False, 0)
        if is_zero(parts[0]):
            return None
        cancelling = self.nominal.cancels(parts[0])
        return _Price(bool(self._tears(parts[0])), False, cancelling, _signals(parts[0]))

    def _value(self, zero: Expr, symbol: Expr) -> Expr | None:
        """The value of a torn variable, by iteration where there is no closed form."""
        if (zero, symbol) in self.unsolvable:
            return None
        solved = solve(self.pool, zero, symbol, self.nominal.vanishes)
        value = None if solved is None else solved.value
        if solved is None and affine(self.pool, zero, symbol) is None:
            value = invert(self.pool, zero, symbol, self.nominal.value, self.variable[symbol])
        if value is None:
            self.unsolvable.add((zero, symbol))
        return value

    def _record(self, symbol: Expr, value: _Row) -> None:
        self.solved[symbol] = value
        still = []
        for item in self.pending:
            if symbol not in self._tears(item.expr):
                still.append(item)
                continue
            try:
                expr = self.pool.substitute([item.expr], {symbol: value.expr})[0]
            except ZeroDivisionError:
                continue  # it divides by what the loop makes zero: the count will miss it
            combined = _Row(tuple(dict.fromkeys((*value.rows, *item.rows))), expr)
            (still if self._tears(expr) else self.plain).append(combined)
        self.pending = still

    # ----------------------------------------------------- differential loops

    def relations(self) -> list[tuple[tuple[int, ...], Expr]]:
        """All relations free of torn variables, with the equations each was combined from.

        Those that exist but are lost in a nonlinear loop are then in `lost`; what the linear rows
        among the others say of each other is not.
        """
        while True:
            self.solve_algebraic()
            groups, linear = self._tied()
            lacking = [group for group in groups if group.surplus]
            if not (
                self._lower(lacking) or self._clear(lacking) or self._take_two_valued(lacking)
            ):
                break
        found = [(item.rows, item.expr) for item in self.plain] + self.operators.relations(linear)
        for group in groups:
            alone = self.operators.relations(group.linear)
            found += alone
            surplus = group.surplus - len(alone)
            if surplus > 0:
                items = [self.pending[at] for at in group.members]
                rows = tuple(r for item in items for r in item.rows)
                self.lost.append(Lost(rows, tuple(i.rows[-1] for i in items[-surplus:])))
        if self.two_valued:
            whole = [(rows, self._norm(expr)) for rows, expr in found]
            self.lost += [Lost(rows, rows[-1:]) for rows, expr in whole if expr is None]
            found = [(rows, expr) for rows, expr in whole if expr is not None]
        relations = [(rows, expr) for rows, expr in found if not is_zero(expr)]
        self.identities = len(found) - len(relations)
        return relations

    def _clear(self, groups: list[_Tied]) -> bool:
        """Multiply rows with what torn variables divide in them; False where there is none.

        What is left may be linear in them, or a polynomial.
        """
        done = False
        for at in [at for group in groups for at in group.members]:
            item = self.pending[at]
            below = [d for d in divisors(topological([item.expr])) if self._tears(d)]
            expr = cleared(self.pool, item.expr, below)
            if expr is not item.expr:
                self.pending[at] = item._replace(expr=expr)
                done = True
        self._sort_out()
        return done

    def _take_two_valued(self, groups: list[_Tied]) -> bool:
        """Take a torn variable for known of which a row leaves two values; False without any.

        It stands for itself until the relations are complete, in which the choice is no matter.
        """
        for item in [self.pending[at] for group in groups for at in group.members]:
            tears = self._tears(item.expr)
            if len(tears) != 1:
                continue
            name = self.variable[tears[0]].symbol.name
            own = self.pool.symbol(f"±{name}", Kind.INPUT)
            zero = self.pool.substitute([item.expr], {tears[0]: own})[0]
            known = two_valued(self.pool, zero, own)
            if known is not None:
                self.two_valued.append(known)
                self.pending.remove(item)
                self._record(tears[0], _Row(item.rows, own))
                return True
        return False

    def _norm(self, expr: Expr) -> Expr | None:
        """A relation that holds for either value of what is known up to a choice of two."""
        for known in reversed(self.two_valued):
            found = norm(self.pool, expr, known)
            if found is None:
                return None
            expr = found
        return expr

    def _tied(self) -> tuple[list[_Tied], list[LinearRow]]:
        """Pending rows that are tied to a nonlinear one by torn variables, and the linear rest."""
        forms = [self.operators.linear(item.rows, item.expr) for item in self.pending]
        tears = [
            self._tears(item.expr) if form is None else list(form.entries)  # what has not cancelled
            for item, form in zip(self.pending, forms, strict=True)
        ]
        holders: dict[Expr, list[int]] = {}
        for at, names in enumerate(tears):
            for symbol in names:
                holders.setdefault(symbol, []).append(at)
        groups = []
        held: set[int] = set()
        for start, form in enumerate(forms):
            if form is not None or start in held:
                continue
            members = [start]
            held.add(start)
            variables = 0
            for at in members:  # grows on the way
                for symbol in tears[at]:
                    if symbol in holders:
                        variables += 1
                        tied = [r for r in holders.pop(symbol) if r not in held]
                        held.update(tied)
                        members += tied
            members.sort()
            inside = [form for at in members if (form := forms[at]) is not None]
            groups.append(_Tied(members, max(0, len(members) - variables), inside))
        return groups, [f for at, f in enumerate(forms) if f is not None and at not in held]

    def _lower(self, groups: list[_Tied]) -> bool:
        """Take a derivative out of a row of each group; False if there is none to take."""
        done = False
        for group in groups:
            items = [self.pending[at] for at in group.members]
            found = self.operators.lowered([item.expr for item in items])
            if found is not None:
                rows = tuple(dict.fromkeys((*items[found.by].rows, *items[found.row].rows)))
                self.pending[group.members[found.row]] = _Row(rows, found.expr)
                self.raised = done = True
        self._sort_out()
        return done

    def _sort_out(self) -> None:
        """Rows that torn variables have dropped out of are pending no more."""
        self.plain += [item for item in self.pending if not self._tears(item.expr)]
        self.pending = [item for item in self.pending if self._tears(item.expr)]


def _signals(expr: Expr) -> int:
    """How many signals and derivatives an expression holds."""
    return sum(
        n.op is Op.DER or (n.op is Op.SYM and n.symbol.kind not in CONSTANTS)
        for n in topological([expr])
    )


def _differentiated(expr: Expr, symbol: Expr) -> bool:
    """Whether a derivative or an integral holds the symbol."""
    return any(n.order for n in holding([expr], lambda n: n is symbol))
