"""Solve loops: a torn variable is taken as known, and the relations left over give it back.

Equations that hold torn variables are rows of a linear system whose entries are polynomials in
D = d/dt with constant coefficients. A row that holds a torn variable without derivative gives it
(an algebraic loop); from rows that hold only derivatives operator elimination takes the variable
(a differential loop, `operators`). What is left without torn variables is a relation.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress

from bondgraph.algebra.affine import affine
from bondgraph.algebra.implicit import invert
from bondgraph.algebra.nominal import Nominal
from bondgraph.algebra.operators import LinearRow, Operators
from bondgraph.algebra.solve import ITERATED, Solution, solve
from bondgraph.algebra.zero import is_zero
from bondgraph.ir.expr import CONSTANTS, Expr, Kind, Op, Pool, symbols, topological
from bondgraph.ir.nodes import constant, holding
from bondgraph.text.tuples import NamedTuple


class _Row(NamedTuple):
    """An equation in torn variables: `rows` are the equations it was combined from."""

    rows: tuple[int, ...]
    expr: Expr


class _Pivot(NamedTuple):
    """A row, a torn variable of it, its value, and how many signals that is divided by."""

    item: _Row
    symbol: Expr
    value: Expr
    divisors: int = 0


class _Knot(NamedTuple):
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
        self.gentle: dict[Expr, _Pivot | None] = {}  # row to the pivot that it offers
        self.unsolvable: set[tuple[Expr, Expr]] = set()
        self.identities = 0  # relations that hold whatever the machine does
        self.raised = False  # whether a derivative was put into another row

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
        """Give a value to every torn variable that some row holds without derivative."""
        while self.pending:
            gentle = self._gentlest() if self.patient else None
            harsh = self.patient and (gentle is None or gentle.divisors)
            if harsh and self._lower(self._knots()[0]):
                continue
            found = gentle or self._first(self._pivot) or self._first(self._nested)
            if found is None:
                return
            self.pending.remove(found.item)
            self._record(found.symbol, _Row(found.item.rows, found.value))

    def _first(self, attempt: Callable[[_Row], tuple[Expr, Expr] | None]) -> _Pivot | None:
        pivots = ((item, attempt(item)) for item in self.pending)
        return next((_Pivot(item, *pivot) for item, pivot in pivots if pivot is not None), None)

    def _gentlest(self) -> _Pivot | None:
        """The row that gives a torn variable while it is divided by the fewest signals."""
        best: _Pivot | None = None
        for item in self.pending:
            if item.expr not in self.gentle:
                self.gentle[item.expr] = self._gentle(item)
            found = self.gentle[item.expr]
            if found is not None and (best is None or found.divisors < best.divisors):
                best = found._replace(item=item)
                if not best.divisors:
                    return best
        return best

    def _gentle(self, item: _Row) -> _Pivot | None:
        """The torn variable that a row linear in it gives with the fewest signals as divisors."""
        pivots = []
        for symbol in self._tears(item.expr):
            parts = affine(self.pool, item.expr, symbol)
            if parts is None or self._tears(parts[0]) or is_zero(parts[0]):
                continue
            found = solve(self.pool, item.expr, symbol, self.nominal.vanishes)
            if found is not None:
                pivots.append(_Pivot(item, symbol, found.value, _signals(parts[0])))
        return min(pivots, key=lambda p: p.divisors, default=None)

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
        self.solve_algebraic()
        knots, linear = self._knots()
        while self._lower([knot for knot in knots if knot.surplus]):
            self.solve_algebraic()
            knots, linear = self._knots()
        found = [(item.rows, item.expr) for item in self.plain] + self.operators.relations(linear)
        for knot in knots:
            alone = self.operators.relations(knot.linear)
            found += alone
            surplus = knot.surplus - len(alone)
            if surplus > 0:
                items = [self.pending[at] for at in knot.members]
                rows = tuple(r for item in items for r in item.rows)
                self.lost.append(Lost(rows, tuple(i.rows[-1] for i in items[-surplus:])))
        telling = [(rows, expr) for rows, expr in found if not is_zero(expr)]
        self.identities = len(found) - len(telling)
        return telling

    def _knots(self) -> tuple[list[_Knot], list[LinearRow]]:
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
        knots = []
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
            knots.append(_Knot(members, max(0, len(members) - variables), inside))
        return knots, [f for at, f in enumerate(forms) if f is not None and at not in held]

    def _lower(self, knots: list[_Knot]) -> bool:
        """Take a derivative out of a row of each knot; False if there is none to take."""
        done = False
        for knot in knots:
            items = [self.pending[at] for at in knot.members]
            found = self.operators.lowered([item.expr for item in items])
            if found is not None:
                rows = tuple(dict.fromkeys((*items[found.by].rows, *items[found.row].rows)))
                self.pending[knot.members[found.row]] = _Row(rows, found.expr)
                self.raised = done = True
        self.plain += [item for item in self.pending if not self._tears(item.expr)]
        self.pending = [item for item in self.pending if self._tears(item.expr)]
        return done


def _signals(expr: Expr) -> int:
    """How many signals and derivatives an expression holds."""
    return sum(
        n.op is Op.DER or (n.op is Op.SYM and n.symbol.kind not in CONSTANTS)
        for n in topological([expr])
    )


def _differentiated(expr: Expr, symbol: Expr) -> bool:
    """Whether a derivative or an integral holds the symbol."""
    return any(n.op in (Op.DER, Op.INT) for n in holding([expr], lambda n: n is symbol))
