"""Replay in SymPy how a residual came about: each step of the elimination, done once more.

The order of the steps is that of the compiler; the algebra is SymPy's, from the equations of the
bond graph to the relation, and SymPy says in the end whether that is the compiler's.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy as sp

from bondgraph.algebra.in_mode import in_mode
from bondgraph.algebra.present import tidy
from bondgraph.algebra.symbolic import t
from bondgraph.algebra.sympy_elimination import (
    Change,
    Loop,
    Unshown,
    factor_of,
    in_position,
    linear,
    put_in,
    solve_for,
)
from bondgraph.algebra.sympy_signals import Signals, taken
from bondgraph.algebra.written_out import terms_written_out
from bondgraph.ir.derivation import Derivation, DerivationStep, Move
from bondgraph.ir.equation_system import Equation
from bondgraph.ir.expr import Expr, Kind, Op, symbols
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.nodes import has
from bondgraph.ir.residuals import Residual, Step
from bondgraph.notation.line import show

_DIFFERENTIATED = 12  # times that a relation is, at most
_TERMS = 50_000  # of a relation whose derivatives are taken; SymPy takes half a minute for 30 000
_LONG = 60  # operations of a value that is shown as one sum where that is shorter


def derive(residual: Residual, graph: BondGraph, shown: Residual) -> tuple[Derivation, ...]:
    """The derivation of a residual, which in the time of the log is `shown`.

    One derivation; of a relation that was had in each position of some switches by itself, one for
    each of these.
    """
    if not residual.each:
        return (_Replay(residual, graph, shown).run(),)
    return tuple([
        _Replay(
            residual._replace(closing=own.equation, steps=own.steps, loop=own.loop),
            graph,
            shown,
            setting,
        ).run()
        for setting, own in residual.each
    ])


class _Replay:
    """One derivation, while switches are in the positions of a `setting`."""

    def __init__(
        self,
        residual: Residual,
        graph: BondGraph,
        shown: Residual,
        setting: Sequence[tuple[Expr, bool]] = (),
    ) -> None:
        self.residual = residual
        self.graph = graph
        self.shown = shown
        self.setting = setting
        starts = graph.initial_values()
        like = [residual.expr, shown.expr, *[s.value for s in residual.steps]]
        self.signals = Signals(graph.pool, starts, like)
        self.steps: list[DerivationStep] = []
        self.values: dict[Any, Any] = {}  # of unknowns, in known signals and torn unknowns
        self.at: dict[Any, int] = {}  # the step that gave an unknown
        self.torn: dict[Any, None] = {}
        self.last = 0  # the step that gave the relation that is at work
        self.below: list[Any] = []  # signals that something was divided by

    def run(self) -> Derivation:
        """All steps, up to the one that cannot be shown if there is one."""
        factor, stopped = sp.Integer(0), ""
        own = self.signals
        try:
            if terms_written_out(self.residual.expr) > _TERMS:
                raise Unshown(
                    f"with its derivatives taken the relation has more than {_TERMS:,} terms,"
                    " before like ones are collected"
                )
            arr = self._there(own.sympy(self.residual.expr))
            for step in self._in_order():
                self._step(step)
            factor = self._closed(self._relations(), arr)
            self._shifted()
        except Unshown as error:
            stopped = str(error)
        return Derivation(
            self.residual.name,
            own.own,
            tuple(self.steps),
            self._arr(self.residual.expr),
            own.expr(factor),
            self.graph.initial_values(),
            stopped,
            tuple([(mode.symbol.name, on) for mode, on in self.setting]),
        )

    def _there(self, value: Any) -> Any:
        """What an expression is in the positions of the switches that this is about."""
        own = {sp.Eq(self.signals.sympy(mode), 1): on for mode, on in self.setting}
        return in_position(value, own)

    def _copied(self, expr: Expr) -> Expr:
        """An expression of the compiler, in these positions and in the pool of answers."""
        own = self.signals
        found = own.copies([expr, *[mode for mode, _ in self.setting]])
        modes = {copy: on for copy, (_, on) in zip(found[1:], self.setting, strict=True)}
        return in_mode(own.own, found[:1], modes)[0]

    def _arr(self, expr: Expr) -> Expr:
        """A relation of the compiler, as it is written for people."""
        return tidy(self.signals.own, self._copied(expr))[0]

    # ------------------------------------------------------------------- along the path

    def _in_order(self) -> list[Step]:
        """The steps, each behind those that give what its equation holds."""
        waiting, found = list(self.residual.steps), list[Step]()
        known = {s.variable for s in waiting if s.how == "loop"}
        given = {s.variable for s in waiting}
        while waiting:
            ready = [s for s in waiting if _inputs(s, given) <= known]
            if not ready:
                names = ", ".join(show(s.variable) for s in waiting[:3])
                raise Unshown(f"{names} and {len(waiting)} unknowns in all are solved for at once")
            found += ready
            known |= {s.variable for s in ready}
            waiting = [s for s in waiting if s not in ready]
        order = {s.variable: at for at, s in enumerate(self.residual.steps)}
        late = {s.variable: at for at, s in enumerate(found)}
        plain = all(
            late[v] < late[s.variable] or order[v] < order[s.variable]
            for s in found for v in _inputs(s, given)
        )  # fmt: skip
        return list(self.residual.steps) if plain and self._sorted(given) else found

    def _sorted(self, given: set[Expr]) -> bool:
        """Whether the compiler's own order is one in which a person can go."""
        known: set[Expr] = set()
        for step in self.residual.steps:
            if not _inputs(step, given) <= known:
                return False
            known.add(step.variable)
        return True

    def _step(self, step: Step) -> None:
        own = self.signals
        equation = step.equation
        unknown = own.sympy(step.variable)
        move: Move
        zero = self._there(own.sympy(equation.zero))
        if step.how == "loop":
            self.torn[unknown] = None
            self._add("tear", equation, unknown, unknown, unknown)
            return
        if step.how == "integrated":
            assert step.value.op is Op.INT
            move, value = "integrate", self._there(own.sympy(step.value))
        elif has([step.value], Op.ROOT):
            move, value = "iterate", self._there(own.sympy(step.value))
        else:
            move = "differentiate" if step.how == "differentiated" else "solve"
            try:
                value = solve_for(zero, unknown)
            except Unshown as error:
                raise Unshown(f"{equation.name} for {show(step.variable)}: {error}") from error
            if not linear(zero, unknown):
                move = "invert"
        closed, gone = self._tidied(put_in(value, self.values))
        self.values[unknown] = closed
        self.below += _divisors(closed)
        self._add(move, equation, unknown, value, closed, gone)
        self.at[unknown] = len(self.steps)

    def _relations(self) -> list[tuple[int, Any]]:
        """What is left over, free of torn unknowns, with its step; a loop may leave several."""
        rows = [*self.residual.loop, self.residual.closing]
        own: list[Any] = []
        for equation in rows:
            zero = self._there(self.signals.sympy(equation.zero))
            found, gone = self._tidied(put_in(zero, self.values))
            self._add("row" if self.torn else "close", equation, None, zero, found, gone)
            own.append(found)
        numbers = dict(enumerate(range(len(self.steps) - len(own) + 1, len(self.steps) + 1)))
        torn = [u for u in self.torn if any(e.has(u) for e in own)]
        loop = Loop(own, torn)
        for change in loop.changes():
            self._changed(change, numbers)
        self.below += loop.below
        return [(numbers[at], row) for at, row in loop.rows.items()][::-1]

    def _changed(self, change: Change, numbers: dict[int, int]) -> None:
        """A step on a row of the loop."""
        expr = self.signals.expr(change.expr)
        move: Move = "lower" if change.lowered else "untear" if change.solved else "put"
        if change.unknown is None:
            move = "rise"
        unknown = None if change.unknown is None else self.signals.expr(change.unknown)
        before = self.steps[numbers[change.row] - 1].closed
        number = len(self.steps) + 1
        divisors = tuple([self.signals.expr(d) for d in _divisors(change.expr, sums=True)])
        self.steps.append(
            DerivationStep(
                number, move, None, before, unknown, expr, expr, (numbers[change.row],),
                divisors=divisors, times=change.times, row=numbers[change.by],
            )
        )  # fmt: skip
        numbers[change.row] = number

    # -------------------------------------------------------------------- to the residual

    def _closed(self, relations: list[tuple[int, Any]], arr: Any) -> Any:
        """The relation without undeclared starts and what cancels; its factor."""
        if not relations:
            raise Unshown("the loop leaves no relation")
        since = self.residual.differentiated < 0
        wanted = taken(sp.diff(arr, t)) if since else arr
        for number, relation in relations:
            steps = list(self.steps)
            self.last = number
            own = self._free_of_starts(relation)
            factor = factor_of(own, wanted, self.below)
            if factor is not None:
                self._cancelled(own, wanted)
                if since:
                    self._then("since", self.signals.expr(factor * arr))
                same = self.steps[-1].closed is self._arr(self.residual.expr)
                if factor != 1 or self.torn or not same:
                    self._scaled(factor)
                return factor
            self.steps = steps
        raise Unshown("SymPy does not see that what is left is a multiple of the compiler's")

    def _free_of_starts(self, relation: Any) -> Any:
        """The relation, differentiated until no initial value is in it that nobody declared."""
        times = 0
        while starts := self._undeclared(relation):
            relation = sp.expand(relation)
            starts = [s for s in starts if relation.has(s)]
            if not starts:
                break  # all of them cancel
            if times == _DIFFERENTIATED:
                raise Unshown("differentiated, it still holds an undeclared initial value")
            slope = sp.diff(relation, starts[0])
            if slope.has(starts[0]):
                raise Unshown("an undeclared initial value stands inside a function")
            divided = taken(sp.diff(slope, t)) != 0
            if divided:
                relation = sp.expand(relation / slope)
                self.below.append(slope)
            relation = taken(sp.diff(relation, t))
            times += 1
            by = self.signals.expr(slope) if divided else None
            self._then("free", self.signals.expr(relation), by)
        return relation

    def _undeclared(self, relation: Any) -> list[Any]:
        found = [s for s in relation.free_symbols if s in self.signals.names]
        kinds = {s: self.signals.names[s] for s in found}
        return sorted([s for s in found if kinds[s].kind is Kind.FREE], key=str)

    def _cancelled(self, relation: Any, arr: Any) -> None:
        """What the relation holds and the compiler's does not."""
        if self._gone(relation, arr):
            flat = sp.expand(relation)
            if self._gone(flat, arr):
                flat = sp.cancel(sp.together(relation))
            gone = self._gone(relation, flat)
            self._then("cancel", self.signals.expr(flat))
            self.steps[-1] = self.steps[-1]._replace(gone=gone)

    def _scaled(self, factor: Any) -> None:
        """Divide by what stands before the relation."""
        found = self._arr(self.residual.expr)
        self._then("scale", found, factor=self.signals.expr(factor))

    def _shifted(self) -> None:
        """The relation as a log has it, where sensors or inputs are late."""
        if self.shown.expr is not self.residual.expr:
            self._then("shift", self._arr(self.shown.expr))

    def _then(self, move: Move, found: Expr, factor: Expr | None = None) -> None:
        """The last relation in another form."""
        before, number = self.steps[self.last - 1].closed, len(self.steps) + 1
        self.steps.append(
            DerivationStep(
                number, move, None, before, None, found, found, uses=(self.last,), factor=factor
            )
        )  # fmt: skip
        self.last = number

    def _tidied(self, value: Any) -> tuple[Any, tuple[str, ...]]:
        """A long value as one sum where that is shorter, and what drops out of it then."""
        flat = sp.expand(value)
        gone = self._gone(value, flat)
        shorter = value.count_ops() > _LONG and flat.count_ops() < value.count_ops()
        return (flat, gone) if gone or shorter else (value, ())

    def _gone(self, before: Any, now: Any) -> tuple[str, ...]:
        """The names that an expression no longer holds."""
        old, new = (symbols(self.signals.expr(e)) for e in (before, now))
        return tuple([s.symbol.name for s in old if s not in new])

    def _add(
        self, move: Move, equation: Equation, unknown: Any, value: Any, closed: Any,
        gone: tuple[str, ...] = (),
    ) -> None:  # fmt: skip
        """A step that uses an equation of the bond graph."""
        own = self.signals
        uses = [self.at[u] for u in self.at if value.has(u)] if value is not closed else []
        found = None if unknown is None else own.expr(unknown)
        below = tuple([own.expr(d) for d in _divisors(value)])
        self.steps.append(
            DerivationStep(
                len(self.steps) + 1, move, equation, self._copied(equation.zero), found,
                own.expr(value), own.expr(closed), tuple(uses), gone, below,
            )
        )  # fmt: skip


def _divisors(value: Any, sums: bool = False) -> list[Any]:
    """What is divided by and moves, with `sums` also what is constant but may be zero."""
    below = [p.base for p in value.atoms(sp.Pow) if p.exp.is_negative]
    found = [b for b in below if b.has(t) or (sums and b.is_Add)]
    return sorted(found, key=sp.default_sort_key)


def _inputs(step: Step, given: set[Expr]) -> set[Expr]:
    """The unknowns that a step takes from others."""
    equation = step.equation
    if step.how == "loop":
        return set()
    held = step.value if step.how == "integrated" else equation.zero
    return (given & set(symbols(held))) - {step.variable}
