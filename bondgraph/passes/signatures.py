"""Find which fault moves which relation, exactly, and take out of the relations what cancels.

A relation is differentiated with respect to every parameter and signal by reverse mode, over a
prime field, at a random point: once at free signals, which shows what cancels for every signal
(the backlash torque in the drives' first relation), and once on a healthy trajectory of the
plant, which decides the signature. Parameters are functions of time here, so that a fault is
found whatever its course. Presence of a symbol proves nothing; a derivative that vanishes does.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from bondgraph.exact.evaluate import (
    Sensitivity,
    evaluate,
    highest_order,
    integral_depth,
    sensitivities,
)
from bondgraph.exact.field import Undefined
from bondgraph.exact.free import FreeSample
from bondgraph.exact.plant import ExactUnavailable, Plant
from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols, topological
from bondgraph.ir.residuals import Closing, ReducedSystem, Residual, ResidualSet
from bondgraph.ir.signatures import SignatureMatrix
from bondgraph.passes.present import upright
from bondgraph.text.diagnostic import Report

T = TypeVar("T")

#: Points at which a relation is tried: one is enough for a rational relation (it errs with a
#: probability of about its degree / 2**61), a branch not taken at one point is taken at another.
_POINTS, _POINTS_WITH_BRANCHES = 1, 12
_LONG = 2000  # nodes
_TRIES = 40  # a point where a square root has no value is drawn again


def signatures(
    reduced: ReducedSystem, report: Report, seed: int = 1, plant: Plant | None = None
) -> tuple[ResidualSet, SignatureMatrix]:
    """The relations, named in the order of the model, and their fault signature matrix.

    Exact up to a probability below 1e-12 (Schwartz and Zippel). Where no trajectory of the plant
    can be had, the signatures are those at free signals and the verification says so.
    """
    return _Analysis(reduced, report, seed, plant or Plant(reduced.system.graph)).run()


class _Analysis:
    def __init__(self, reduced: ReducedSystem, report: Report, seed: int, plant: Plant) -> None:
        self.reduced = reduced
        self.graph = reduced.system.graph
        self.pool = self.graph.pool
        self.report = report
        self.seed = seed
        self.plant = plant
        self.faults = {self.graph.fault_symbol(f): f for f in self.graph.faults}

    def run(self) -> tuple[ResidualSet, SignatureMatrix]:
        relations: list[tuple[Closing, Expr, dict[Expr, int]]] = []
        for closing in self.reduced.closings:
            free = self.at_free_signals(closing.expr)
            if any(v and s.symbol.kind is not Kind.CONST for s, v in free.depends.items()):
                own = pruned(self.pool, closing, free)
                relations.append((own, upright(self.pool, own.expr), free.orders))
        reacts = self.on_trajectories([_with_moving_parameters(c, e) for c, e, _ in relations])
        names = [f"r{i + 1}" for i in range(len(relations))]
        residuals = tuple(
            Residual(name, expr, c.equation, c.steps, c.differentiated)
            for name, (c, expr, _) in zip(names, relations, strict=True)
        )
        faults = self.graph.faults
        rows = []
        for fault in faults:
            symbol = self.graph.fault_symbol(fault)
            rows.append(tuple(symbol in seen for seen in reacts))
        orders = tuple({s.symbol.name: k for s, k in own.items()} for _, _, own in relations)
        reduced = self.reduced
        return (
            ResidualSet(reduced.system, residuals, reduced.unsolved, reduced.unmonitored),
            SignatureMatrix(tuple(names), faults, tuple(rows), orders),
        )

    # ------------------------------------------------------------------ points

    def at_free_signals(self, expr: Expr) -> Sensitivity:
        """What the relation depends on when its signals are independent of each other."""
        found = Sensitivity(dict.fromkeys(symbols(expr), False), {}, frozenset(), ())
        for point in range(_points([expr])):
            try:
                here = self.draw(
                    lambda n: sensitivities(expr, FreeSample.of(expr, n)), 1000 * self.seed + point
                )
            except ExactUnavailable:
                return _by_presence(expr)
            found = _union(found, here) if point else here
        return found

    def on_trajectories(self, exprs: list[Expr]) -> list[set[Expr]]:
        """The symbols that each relation reacts to in the healthy plant.

        One trajectory serves all relations; where the plant as a whole has none, each relation is
        tried on the part of the plant that it is about.
        """
        if not exprs:
            return []
        try:
            return self.sensed(exprs)
        except ExactUnavailable:
            if len(exprs) > 1:
                return [self.on_trajectories([e])[0] for e in exprs]
            return [self.without_slopes(exprs[0])]

    def without_slopes(self, expr: Expr) -> set[Expr]:
        """The symbols that move a relation where its derivatives do not exist on the plant."""
        try:
            return {s for s in symbols(expr) if self.moves(expr, s)}
        except ExactUnavailable:
            return {s for s, hit in self.at_free_signals(expr).depends.items() if hit}

    def sensed(self, exprs: list[Expr]) -> list[set[Expr]]:
        """The symbols that each relation reacts to, over enough points to meet every branch."""
        reacts: list[set[Expr]] = [set() for _ in exprs]
        for point in range(_points(exprs)):
            parts = self.draw(lambda n: self.at_trajectory(exprs, n), 1000 * self.seed + point)
            for seen, part in zip(reacts, parts, strict=True):
                seen.update(s for s, hit in part.depends.items() if hit)
        for seen, expr in zip(reacts, exprs, strict=True):
            seen.update(s for s in symbols(expr) if s not in seen and self.moves(expr, s))
        return reacts

    def at_trajectory(self, exprs: list[Expr], number: int) -> list[Sensitivity]:
        """Derivatives of all relations at one healthy trajectory."""
        sample = self.plant.sample(exprs, number, integral_depth(exprs) + 1)
        return [sensitivities(expr, sample) for expr in exprs]

    def moves(self, expr: Expr, symbol: Expr) -> bool:
        """Whether a fault that is not small moves a relation that small ones leave alone.

        A machine at rest, without any input, hides a parameter from the derivative that a change
        of finite size shows.
        """
        fault = self.faults.get(symbol)
        if fault is None:
            return False
        size = integral_depth([expr]) + 1

        def value(number: int) -> Any:
            sample = self.plant.sample([expr], number, size, faults=(fault,))
            return evaluate([expr], sample, size)[0]

        found = self.draw(value, 3000 * self.seed)
        return any(found) if isinstance(found, list) else bool(found.amplitude)

    def draw(self, attempt: Callable[[int], T], number: int) -> T:
        """The result at a random point; points where something has no value are drawn again."""
        for turn in range(_TRIES):
            try:
                return attempt(number + 100_000 * turn)
            except Undefined:
                continue
        raise ExactUnavailable("no point was found at which every law has a value")


def _with_moving_parameters(closing: Closing, expr: Expr) -> Expr:
    """The form of a relation that shows what a parameter does that moves.

    Differentiating takes an undeclared initial value away only while its parameter is constant.
    A long relation is left as it is: there the random points are exponentials, without integrals.
    """
    nodes = topological([closing.raw])
    moved = any(n.op is Op.INT and n.symbol.kind is Kind.FREE for n in nodes)
    return closing.raw if moved and len(nodes) <= _LONG else expr


def _by_presence(expr: Expr) -> Sensitivity:
    """What a relation may depend on, where it has no value at any random point."""
    inside = symbols(expr)
    signals = [s for s in inside if s.symbol.kind in (Kind.INPUT, Kind.SENSOR)]
    order = highest_order([expr])
    return Sensitivity(dict.fromkeys(inside, True), dict.fromkeys(signals, order), frozenset(), ())


def _points(exprs: list[Expr]) -> int:
    branches = any(
        n.op is Op.IF
        or (n.op is Op.FN and n.name in ("sign", "min", "max", "abs"))
        or (n.op is Op.SYM and n.symbol.kind is Kind.MODE)
        for n in topological(exprs)
    )
    return _POINTS_WITH_BRANCHES if branches else _POINTS


def _union(a: Sensitivity, b: Sensitivity) -> Sensitivity:
    return Sensitivity(
        {s: hit or b.depends[s] for s, hit in a.depends.items()},
        {s: max(a.orders.get(s, -2), b.orders.get(s, -2)) for s in {**a.orders, **b.orders}},
        a.dead & b.dead,
        tuple(dict.fromkeys((*a.starts, *b.starts))),
    )


def pruned(pool: Pool, closing: Closing, free: Sensitivity) -> Closing:
    """The relation without the parts that cancel whatever the signals are.

    A part cancels when the relation's derivative with respect to it vanishes; the relation keeps
    its value when the part is put to zero. (What decides between branches counts as influence.)
    """
    nodes = topological([closing.expr])
    dead = {n: pool.zero for n in nodes if n in free.dead and n.op is not Op.NUM}
    if not dead:
        return closing
    try:
        expr, *values = pool.substitute([closing.expr, *[s.closed for s in closing.steps]], dead)
    except ZeroDivisionError:
        return closing
    steps = [s._replace(closed=v) for s, v in zip(closing.steps, values, strict=True)]
    return closing._replace(expr=expr, steps=tuple(steps))
