"""Decide which faults a residual sees for as long as they last, and which only in transients."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from functools import cached_property, partial
from random import Random
from typing import Any

from bondgraph.exact.dependence import sensitivities
from bondgraph.exact.evaluate import Incremental, Sample, evaluate
from bondgraph.exact.exponentials import ExponentialSample
from bondgraph.exact.outline import highest_order, integral_depth
from bondgraph.exact.plant import Plant
from bondgraph.exact.reactions import Reactions
from bondgraph.exact.signal_algebra import Mixed
from bondgraph.exact.steady_operation import held, rest, steady
from bondgraph.exact.taylor import Solver
from bondgraph.exact.trajectory import ExactUnavailable, Trajectory
from bondgraph.field.numbers import Number, Undefined
from bondgraph.ir.expr import KNOWN_SIGNALS, Expr, Op, Symbol, topological
from bondgraph.ir.residuals import ResidualSet
from bondgraph.ir.signature_matrix import Detectability, SignatureMatrix

_TRIES = 12  # points at which a residual or a law may have no value, drawn again
_SIZES = 5  # of a constant error, until one leaves all laws a value


def detectability(
    residuals: ResidualSet, matrix: SignatureMatrix, plant: Plant, seed: int = 1
) -> Detectability:
    """Strong and weak detectability of every fault in every residual, exactly.

    A fault is strongly detectable in a residual if a constant fault (a parameter off by a
    constant, a sensor or known input with a constant error) keeps the residual away from zero in
    steady operation: every effort and flow of the machine is constant, known and unknown inputs
    are, and what the model writes as an integral may grow. So is a constant error of a signal
    that shows as long as the machine moves, as behind the derivative of a nonlinear law. It is
    weakly detectable if the residual reacts, but not so (Chen and Patton, 1999; Nyberg, 2002). So
    r = U - R i - L i' sees R strongly and L weakly, a residual that had to be differentiated sees
    no constant error of a sensor for long, and an integral keeps what it has once taken up. Of a
    machine with switches or branches it is enough that one mode or branch shows the fault.

    Decided at the declared numbers, as the signatures are. Where the machine has no steady
    operation in motion it is held where it is (its positions stay, its currents go on), else at
    rest (no flow), and without that the answer is None.
    """
    sees = matrix.sees
    items = [(r.expr, sees[r.name]) for r in residuals.residuals]
    columns = _strong(items, plant, seed)
    strong = tuple(
        tuple([None if own is None else fault in own for own in columns])
        for fault in matrix.faults
    )
    return Detectability(matrix.residuals, matrix.faults, strong, matrix)


def _strong(
    items: list[tuple[Expr, tuple[str, ...]]], plant: Plant, seed: int
) -> list[frozenset[str] | None]:
    """For each relation, which of its faults hold it away from zero; None where none can be told.

    One point serves all relations; where the plant as a whole cannot stand still, each relation
    is tried on the part of the plant that it is about.
    """
    exprs = [expr for expr, _ in items]
    left = [dict.fromkeys(faults) for _, faults in items]
    found: list[list[str]] = [[] for _ in items]
    symbols = plant.graph.fault_symbols()
    decided = False
    hopeless: list[Mapping[Expr, int] | None] = []  # many choices have been tried there already
    for number, modes in enumerate(Reactions(plant, seed).settings(exprs)):
        if not any(left):
            break
        if modes in hopeless:
            continue
        point = _point(exprs, plant, 1000 * seed + number, modes)
        if point is None:
            hopeless.append(modes)
            continue
        decided = True
        for at, expr in enumerate(exprs):
            relation = _Relation(expr, point)
            for fault in list(left[at]):
                if relation.held(symbols[fault]):
                    found[at].append(fault)
                    del left[at][fault]
    if decided or not any(left):
        return [frozenset(own) for own in found]
    if len(items) > 1:
        return [_strong([item], plant, seed)[0] for item in items]
    return [None]


class _Point:
    """Steady operation, and on demand the same plant in motion."""

    def __init__(
        self, still: Trajectory, move: Callable[[], Trajectory | ExponentialSample]
    ) -> None:
        self.still = still
        self._move = move

    @cached_property
    def moving(self) -> Trajectory | ExponentialSample:
        """The plant in motion."""
        return self._move()


def _point(
    exprs: list[Expr], plant: Plant, number: int, modes: Mapping[Expr, int] | None
) -> _Point | None:
    """A point of steady operation; for one relation one that is held or at rest if need be."""
    found = _at(exprs, plant, number, modes, steady)
    for stiller in (held, rest) if len(exprs) == 1 else ():
        if found is None:
            found = _at(exprs, plant, number, modes, stiller)
    return found


def _at(
    exprs: list[Expr], plant: Plant, number: int, modes: Mapping[Expr, int] | None, solver: Solver
) -> _Point | None:
    n = integral_depth(exprs) + 2
    order = highest_order(exprs, n)
    part = plant.structure.part_for(exprs)
    for turn in range(_TRIES):
        at = number + 100_000 * turn
        try:
            still = plant.trajectory(at, order, modes=modes, part=part, solver=solver, roots=exprs)
            evaluate(exprs, still, n)
        except Undefined:
            continue
        except (ExactUnavailable, Mixed):
            return None
        if still.part is not part:  # a law is left out: another machine
            return None
        return _Point(still, partial(plant.sample, exprs, at, n, modes=modes))
    return None


class _Relation:
    """A residual that is told constantly wrong values at one point."""

    def __init__(self, expr: Expr, point: _Point) -> None:
        self._point = point
        self._expr = expr
        self._integrals = [node for node in topological([expr]) if node.op is Op.INT]
        self._size = integral_depth([expr]) + 2
        self._evaluated: dict[tuple[Expr, Sample], Incremental] = {}

    @cached_property
    def _sloped(self) -> frozenset[Expr]:
        """What has a slope in steady operation: a small constant error already shows.

        All symbols at once, by one sweep back through the relation. What an integral has taken up
        is no error of steady operation.
        """
        if self._integrals:
            return frozenset()
        try:
            return sensitivities(self._expr, self._point.still).lasting
        except (Undefined, Mixed):
            return frozenset()

    def held(self, symbol: Expr) -> bool:
        """Whether a residual that is told a constantly wrong value stays away from zero.

        For a parameter in steady operation, for a signal also in motion: a constant error that the
        derivative of a nonlinear law lets through shows as long as the machine moves.
        """
        if symbol in self._sloped or self._shows(symbol, self._point.still):
            return True
        if symbol.symbol.kind not in KNOWN_SIGNALS:
            return False
        try:
            moving = self._point.moving
        except (ExactUnavailable, Undefined):
            return False
        return isinstance(moving, Trajectory) and self._shows(symbol, moving)

    def _shows(self, symbol: Expr, at: Trajectory) -> bool:
        """Whether a constant error moves a residual; of several sizes one that it takes."""
        for turn in range(_SIZES):
            taken_up: set[Symbol] = set()
            for node in self._integrals:
                if self._differs(node.args[0], symbol, turn, taken_up):
                    taken_up.add(node.symbol)
            wrong = _Wrong(at, symbol, turn, taken_up)
            changed = [symbol, *[n for n in self._integrals if n.symbol in taken_up]]
            try:
                return at.algebra.moves(self._at(self._expr, at).anew(changed, wrong))
            except (Undefined, Mixed):
                continue
        return False

    def _differs(self, expr: Expr, symbol: Expr, turn: int, taken_up: set[Symbol]) -> bool:
        """Whether an integrand is wrong while the machine moves."""
        changed = [symbol, *[n for n in self._integrals if n.symbol in taken_up]]
        try:
            right = self._point.moving
            wrong = _Wrong(right, symbol, turn, taken_up)
            found = self._at(expr, right)
            one, other = found.anew((), right), found.anew(changed, wrong)
            algebra: Any = right.algebra
            return bool(algebra.moves(algebra.combine([(1, one), (-1, other)], 1)))
        except (ExactUnavailable, Undefined, Mixed):
            return True

    def _at(self, expr: Expr, point: Sample) -> Incremental:
        size = self._size if expr is self._expr else 1
        found = self._evaluated.get((expr, point))
        if found is None:
            found = self._evaluated[expr, point] = Incremental(expr, point, size)
        return found


class _Wrong:
    """A point at which one symbol is told wrong by a constant, and integrals by what they hold."""

    def __init__(
        self, point: Sample, symbol: Expr, turn: int, taken_up: Collection[Symbol]
    ) -> None:
        self.algebra = point.algebra
        self._point = point
        self._symbol = symbol
        self._taken_up = taken_up
        self._numbers = point.algebra.numbers
        true = point.value(symbol)
        error = self._numbers.any(Random(f"{turn}:{symbol.symbol.name}"))
        if self._numbers.nonzero(true[0]):
            error = error * true[0]
        self._told: Any = [true[0] + error * self._numbers.inverse(4**turn), *true[1:]]

    def value(self, symbol: Expr) -> Any:
        """What the residual is told."""
        return self._told if symbol is self._symbol else self._point.value(symbol)

    def start(self, initial: Symbol) -> Number:
        """Where an integral stands."""
        start: Number = self._point.start(initial)
        if initial in self._taken_up:
            start += self._numbers.any(Random(initial.name))
        return start

    def earlier(self, steps: int) -> Sample:
        """Not asked for: nothing is differentiated here."""
        raise NotImplementedError
