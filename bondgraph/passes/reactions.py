"""Which symbols move an expression: at free signals, and on healthy trajectories of the plant.

The derivatives are taken by reverse mode over a prime field at random points. Parameters are
functions of time here, so that a fault is found whatever its course.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, TypeVar

from bondgraph.exact.evaluate import (
    Sensitivity,
    evaluate,
    highest_order,
    sensitivities,
    telling,
)
from bondgraph.exact.field import Undefined
from bondgraph.exact.free import FreeSample
from bondgraph.exact.modes import assignments, modes_of
from bondgraph.exact.plant import ExactUnavailable, Plant
from bondgraph.exact.trajectory import Trajectory
from bondgraph.ir.expr import Expr, Kind, Op, symbols, topological

T = TypeVar("T")

#: Points at which a relation is tried: one is enough for a rational relation (it errs with a
#: probability of about its degree / 2**61), a branch not taken at one point is taken at another.
_POINTS, _POINTS_WITH_BRANCHES = 1, 12
_TURNS = 5  # points at which faults act, where laws of the plant have branches
_TRIES = 40  # a point where a square root has no value is drawn again


class Reactions:
    """What expressions of known signals react to in one plant, in given modes or in any."""

    def __init__(self, plant: Plant, seed: int, modes: Mapping[Expr, int] | None = None) -> None:
        self.plant = plant
        self.seed = seed
        self.modes = modes
        graph = plant.graph
        laws = [law for _, law in plant.assembly.laws]
        self.turns = _TURNS if _points(laws, dict.fromkeys(plant.modes, 0)) > 1 else 1
        self.faults = {symbol: name for name, symbol in graph.fault_symbols().items()}

    def at_free_signals(self, expr: Expr) -> Sensitivity:
        """What the relation depends on when its signals are independent of each other."""
        found = Sensitivity(dict.fromkeys(symbols(expr), False), {}, frozenset(), (), frozenset())
        for point in range(_points([expr], None)):
            try:
                here = self.draw(
                    lambda n: sensitivities(expr, FreeSample.of(expr, n)), 1000 * self.seed + point
                )
            except ExactUnavailable:
                return _by_presence(expr)
            found = _union(found, here) if point else here
        return found

    def on_trajectories(
        self, exprs: list[Expr], lost: Sequence[Sequence[Expr]] = ()
    ) -> list[set[Expr]]:
        """The symbols that each relation reacts to in the healthy plant.

        One trajectory serves all relations; where the plant as a whole has none, each relation is
        tried on the part of the plant that it is about. `lost` are for each relation symbols that
        have cancelled out of it.
        """
        if not exprs:
            return []
        lost = lost or [()] * len(exprs)
        try:
            return self.sensed(exprs, lost)
        except ExactUnavailable:
            if len(exprs) > 1:
                both = zip(exprs, lost, strict=True)
                return [self.on_trajectories([e], [gone])[0] for e, gone in both]
            return [self.without_slopes(exprs[0])]

    def without_slopes(self, expr: Expr) -> set[Expr]:
        """The symbols that move a relation where its derivatives do not exist on the plant."""
        try:
            return {s for s in symbols(expr) if self.moves(expr, s)}
        except ExactUnavailable:
            return {s for s, hit in self.at_free_signals(expr).depends.items() if hit}

    def sensed(self, exprs: list[Expr], lost: Sequence[Sequence[Expr]] = ()) -> list[set[Expr]]:
        """The symbols that each relation reacts to, over enough points to meet every branch.

        Where the modes are not given, they take all their values in turn; one in which the plant
        has no behaviour is passed over.
        """
        reacts: list[set[Expr]] = [set() for _ in exprs]
        lasting: list[set[Expr]] = [set() for _ in exprs]
        failure: ExactUnavailable | None = None
        met = False
        hopeless: list[Mapping[Expr, int] | None] = []
        for point, modes in enumerate(self.settings(exprs)):
            if modes in hopeless:
                continue
            try:
                attempt = partial(self.at_trajectory, exprs, modes)
                parts = self.draw(attempt, 1000 * self.seed + point)
            except ExactUnavailable as reason:
                failure = reason
                hopeless.append(modes)
                continue
            met = True
            for seen, sure, part in zip(reacts, lasting, parts, strict=True):
                seen.update(s for s, hit in part.depends.items() if hit)
                sure.update(part.lasting)
        if not met and failure is not None:
            raise failure
        gone = lost or [()] * len(exprs)
        for seen, sure, expr, others in zip(reacts, lasting, exprs, gone, strict=True):
            unseen = [s for s in dict.fromkeys((*symbols(expr), *others)) if s not in seen]
            seen.update(self.movers(expr, [s for s in unseen if s in self.faults]))
            # told a parameter that moves, a relation may show what no plant would make it show
            doubtful = [s for s in seen if s.symbol.kind is Kind.PARAM and s not in sure]
            seen.difference_update(s for s in doubtful if not self.moves(expr, s))
        return reacts

    def movers(self, expr: Expr, candidates: list[Expr]) -> list[Expr]:
        """Those of the faults that move a relation; asked one by one only if all together do."""
        try:
            if len(candidates) > 1 and not self.moves(expr, *candidates):
                return []
        except ExactUnavailable:
            pass  # so many faults at once leave no plant to speak of
        return [s for s in candidates if self.moves(expr, s)]

    def at_trajectory(
        self, exprs: list[Expr], modes: Mapping[Expr, int] | None, number: int
    ) -> list[Sensitivity]:
        """Derivatives of all relations at one healthy trajectory."""
        sample = self.plant.sample(exprs, number, telling(exprs), modes=modes)
        return [sensitivities(expr, sample) for expr in exprs]

    def settings(self, exprs: list[Expr]) -> list[Mapping[Expr, int] | None]:
        """The modes at each of the points that are tried."""
        free = [] if self.modes is not None else modes_of(self.plant.graph, exprs)
        if not free:
            return [self.modes] * _points(exprs, self.modes)
        tried = assignments(free)
        rounds = -(-_POINTS_WITH_BRANCHES // len(tried))
        return [*tried] * rounds

    def moves(self, expr: Expr, *acting: Expr) -> bool:
        """Whether faults of the plant that act at once, none of them small, move a relation.

        A machine at rest, without any input, hides a parameter from the derivative that a change
        of finite size shows; and a parameter may cancel out of a relation only while it is
        constant.
        """
        faults = tuple(self.faults[s] for s in acting if s in self.faults)
        if not faults:
            return False
        size = telling([expr])

        def value(modes: Mapping[Expr, int] | None, number: int) -> Any:
            sample = self.plant.sample([expr], number, size, faults=faults, modes=modes)
            found = evaluate([expr], sample, size)[0]
            if isinstance(sample, Trajectory) and sample.still and any(found):
                raise ExactUnavailable("no point was found at which all its laws hold")
            return found

        free = [] if self.modes is not None else modes_of(self.plant.graph, [expr])
        failure: ExactUnavailable | None = None
        met = False
        known = assignments(free) if free else [self.modes]
        turns = max(1, self.turns // len(known))
        for turn, modes in [(turn, modes) for turn in range(turns) for modes in known]:
            try:
                found = self.draw(partial(value, modes), 3000 * self.seed + turn)
            except ExactUnavailable as reason:
                failure = reason
                continue
            met = True
            if any(found) if isinstance(found, list) else found.amplitude:
                return True
        if not met and failure is not None:
            raise failure
        return False

    def draw(self, attempt: Callable[[int], T], number: int) -> T:
        """The result at a random point; points where something has no value are drawn again."""
        for turn in range(_TRIES):
            try:
                return attempt(number + 100_000 * turn)
            except Undefined:
                continue
        raise ExactUnavailable("no point was found at which every law has a value")


def _by_presence(expr: Expr) -> Sensitivity:
    """What a relation may depend on, where it has no value at any random point."""
    inside = symbols(expr)
    signals = [s for s in inside if s.symbol.kind in (Kind.INPUT, Kind.SENSOR)]
    order = highest_order([expr])
    orders = dict.fromkeys(signals, order)
    everything = frozenset(inside)
    return Sensitivity(dict.fromkeys(inside, True), orders, frozenset(), (), everything)


def _points(exprs: list[Expr], modes: Mapping[Expr, int] | None) -> int:
    """Several points where an expression takes branches that the modes do not decide."""
    decided: dict[Expr, bool] = {}
    for n in topological(exprs):
        if n.op is Op.SYM:
            decided[n] = modes is not None and n in modes
            branches = n.symbol.kind is Kind.MODE and not decided[n]
        else:
            decided[n] = all(decided[a] for a in n.args)
            branches = (n.op is Op.IF and not decided[n.args[0]]) or _branching(n)
        if branches:
            return _POINTS_WITH_BRANCHES
    return _POINTS


def _branching(node: Expr) -> bool:
    """Whether a node is a function of several branches, or iteration goes through one."""
    if node.op is Op.ROOT:
        inside = topological([node.root.zero])
        return any(n.op is Op.IF or _branching(n) for n in inside)
    return node.op is Op.FN and node.name in ("sign", "min", "max", "abs")


def _union(a: Sensitivity, b: Sensitivity) -> Sensitivity:
    return Sensitivity(
        {s: hit or b.depends[s] for s, hit in a.depends.items()},
        {s: max(a.orders.get(s, -2), b.orders.get(s, -2)) for s in {**a.orders, **b.orders}},
        a.dead & b.dead,
        tuple(dict.fromkeys((*a.starts, *b.starts))),
        a.lasting | b.lasting,
    )
