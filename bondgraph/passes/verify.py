"""Check residuals and signatures against an exact simulation that shares nothing with them.

Healthy plants must give residuals that are exactly zero. A plant in which all faults act at once
that a residual is said not to see must leave it exactly zero. Every single fault that a residual
is said to see must move it (translation validation: Pnueli, Siegel and Singerman, 1998).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from random import Random
from typing import Any

from bondgraph.exact.algebra import Mixed, Wave
from bondgraph.exact.evaluate import Sample, evaluate, holds_root, sensitivities, telling
from bondgraph.exact.field import P, Undefined
from bondgraph.exact.modes import assignments, modes_of
from bondgraph.exact.plant import Contradictory, ExactUnavailable, Plant
from bondgraph.exact.result import Verification
from bondgraph.exact.trajectory import Trajectory
from bondgraph.ir.expr import KNOWN_SIGNALS, Expr, Kind, Op, symbols, topological
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.residuals import ResidualSet
from bondgraph.ir.signatures import SignatureMatrix
from bondgraph.passes import unanswerable
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Span

_BRANCHES = 6  # healthy plants where a law or a residual decides something, else one
_ELSEWHERE = 40  # more of them, for an entry of the matrix that these do not confirm
_WORK = 200_000  # nodes or variables that may be computed for faults, before they are sampled
_TRIES = 20  # points at which a residual or a law may have no value, drawn again


def verify(
    graph: BondGraph,
    residuals: ResidualSet,
    signatures: SignatureMatrix,
    report: Report,
    seed: int = 1,
    plant: Plant | None = None,
) -> Verification:
    """Check every residual and every entry of the fault signature matrix, exactly.

    Reports `verification-failed` (an error, and a bug of the compiler) with the residual and the
    fault, or `verification-unavailable` (a warning) with the reason. The probability of passing
    something wrong is below 1e-12 for each entry tried.
    """
    return _Check(graph, residuals, signatures, report, seed, plant or Plant(graph)).run()


class _Failed(Exception):
    """An entry that is not as the matrix says."""

    def __init__(self, residual: int, fault: str | None, message: str) -> None:
        super().__init__(message)
        self.residual = residual
        self.fault = fault


class _Check:
    def __init__(
        self,
        graph: BondGraph,
        residuals: ResidualSet,
        signatures: SignatureMatrix,
        report: Report,
        seed: int,
        plant: Plant,
    ) -> None:
        self.graph = graph
        self.residuals = residuals.residuals
        self.exprs = [r.expr for r in self.residuals]
        self.signatures = signatures
        self.report = report
        self.seed = seed
        self.plant = plant
        self.terms = telling(self.exprs)
        self.trajectories = 0
        self.points: list[Sample] = []  # healthy ones
        self.tried: dict[str, None] = {}
        self.waves = False
        self.further: list[Sample | None] = []
        self.sampled = False
        self.modes = modes_of(graph, self.exprs)
        laws = [law.zero for node in graph.nodes for law in node.laws]
        self.decides = any(map(_decides, topological([*self.exprs, *laws])))

    def run(self) -> Verification:
        """Everything, in the order of cost; the first thing found wrong is reported."""
        for residual in self.residuals:
            if all(s.symbol.kind is not Kind.SENSOR for s in symbols(residual.expr)):
                closing = residual.closing  # what the sources alone must satisfy is no residual
                unanswerable.contradictory(self.report, closing.name, closing.origin)
                return self.result("not verified: a relation without a sensor")
        try:
            if self.exprs:
                unanswerable.divides_by_nothing(self.graph, self.exprs)
                points = self.healthy()
                self.unmoved()
                self.moved(points)
        except Contradictory as reason:
            node = self.graph.nodes[reason.node] if reason.node >= 0 else None
            where = (node.path, node.origin) if node else ("", self.place()[0])
            unanswerable.contradictory(self.report, *where)
            return self.result(f"not verified: {reason}")
        except unanswerable.Resting as reason:
            unanswerable.resting(self.report, self.residuals[reason.residual], reason.divisor)
            return self.result(f"not verified: {reason}")
        except ExactUnavailable as reason:
            unanswerable.unavailable(self.report, str(reason), *self.place())
            return self.result(f"not verified: {reason}")
        except _Failed as failure:
            residual = self.residuals[failure.residual]
            points = self.points if failure.fault else self.points[-1:]
            divisor = unanswerable.divided_away(self.graph.pool, points, residual)
            if divisor is not None:
                unanswerable.resting(self.report, residual, divisor)
                return self.result("not verified: a step divides by zero")
            self.report.error(
                "verification-failed",
                str(failure),
                residual.closing.origin,
                help="This is a mistake of the compiler, not of the model: nothing was written. "
                "Please report it with the model.",
            )
            return self.result("failed")
        return self.result(self.method())

    def result(self, method: str) -> Verification:
        done = len(self.exprs) if method != "failed" and not method.startswith("not") else 0
        return Verification(
            self.trajectories, done, len(self.tried), len(self.signatures.faults), method
        )

    def method(self) -> str:
        if not self.exprs:
            return "nothing to verify: the model has no residual"
        kind = "exponentials" if self.waves else "Taylor series"
        faults = f"{len(self.tried)} of {len(self.signatures.faults)} faults"
        sampled = " tried one by one (a sample)" if self.sampled else ""
        return f"exact {kind} modulo a 61-bit prime; {faults}{sampled}"

    def place(self) -> tuple[Span, ...]:
        return (self.residuals[0].closing.origin,) if self.residuals else ()

    # ------------------------------------------------------------------------- the parts

    def healthy(self) -> list[Sample]:
        """Every residual vanishes on healthy plants; returns these."""
        points = self.points
        failure: ExactUnavailable | None = None
        for number, modes in enumerate(self.assignments()):
            try:
                point, values = self.at(self.exprs, number, (), modes)
            except ExactUnavailable as reason:
                if failure is None or isinstance(failure, Contradictory):
                    failure = reason  # not every combination of switches leaves a plant
                continue
            points.append(point)
            for at, value in enumerate(values):
                if _moves(value):
                    name = self.residuals[at].name
                    raise _Failed(at, None, f"residual {name} is not zero on the healthy model")
        if not points:
            raise failure or ExactUnavailable("no mode of the model has a trajectory")
        return points

    def unmoved(self) -> None:
        """No residual sees what it is said not to see, all of that acting at once."""
        groups: dict[tuple[str, ...], list[int]] = {}
        for at in range(len(self.exprs)):
            blind = tuple(
                f
                for f, row in zip(self.signatures.faults, self.signatures.rows, strict=True)
                if not row[at]
            )
            if blind:
                groups.setdefault(blind, []).append(at)
        work = sum(
            len(self.plant.part_for([self.exprs[at] for at in members]).active)
            for members in groups.values()
        )
        step = 1 + work // _WORK
        self.sampled = step > 1
        for faults, members in [*groups.items()][::step]:
            exprs = [self.exprs[at] for at in members]
            for modes, values in self.faulty(exprs, faults):
                for at, value in zip(members, values, strict=True):
                    if _moves(value):
                        self.single_out(at, faults, modes)

    def faulty(
        self, exprs: list[Expr], faults: Sequence[str], first: int = 100
    ) -> Iterator[tuple[dict[Expr, int] | None, list[Any]]]:
        """The values of the expressions under faults, in each mode that has a trajectory.

        Random points are numbered from `first`.
        """
        failure: ExactUnavailable | None = None
        found = False
        for number, modes in enumerate(self.assignments() if self.modes else [None]):
            try:
                values = self.at(exprs, first + number, faults, modes)[1]
            except ExactUnavailable as reason:
                failure = reason
                continue
            found = True
            yield modes, values
        if not found:
            raise failure or ExactUnavailable("no mode of the model has a trajectory")

    def single_out(self, at: int, faults: Sequence[str], modes: dict[Expr, int] | None) -> None:
        """Name the fault that moves a residual which should not see it."""
        name = self.residuals[at].name
        for fault in faults:
            values = self.at([self.exprs[at]], 100, (fault,), modes)[1]
            if _moves(values[0]):
                raise _Failed(at, fault, f"residual {name} sees {fault}, its signature does not")
        # several at once may move a product of residuals, which no single one does

    def moved(self, points: list[Sample]) -> None:
        """Every residual sees each fault that it is said to see."""
        size = [len(topological([e])) for e in self.exprs]
        entries = [
            (fault, at)
            for fault, row in zip(self.signatures.faults, self.signatures.rows, strict=True)
            for at, hit in enumerate(row)
            if hit
        ]
        work = sum(size[at] for _, at in entries)
        step = 1 + work // _WORK
        self.sampled = self.sampled or step > 1
        for fault, at in entries[::step]:
            rooted = holds_root([self.exprs[at]])
            shows = self.inclined if rooted else self.told_moves
            if not (
                any(shows(at, fault, p) for p in points)
                or self.acts(at, fault)
                or any(shows(at, fault, p) for p in self.elsewhere())
                or any(self.inclined(at, fault, p) for p in points)
            ):
                name = self.residuals[at].name
                raise _Failed(at, fault, f"residual {name} does not see {fault}, as it should")
            self.tried[fault] = None
        if not self.sampled:
            self.tried.update(dict.fromkeys(self.signatures.faults))

    def elsewhere(self) -> Iterator[Sample]:
        """More healthy plants, for a branch that none of those before has met."""
        for number in range(_ELSEWHERE if self.decides else 0):
            while len(self.further) <= number:
                modes = self.assignments()
                at = len(self.further)
                point: Sample | None = None
                with suppress(ExactUnavailable):
                    point = self.at(self.exprs, 200 + at, (), modes[at % len(modes)])[0]
                self.further.append(point)
            found = self.further[number]
            if found is not None:
                yield found

    def told_moves(self, at: int, fault: str, point: Sample) -> bool:
        """Whether a constant error moves a residual: the healthy plant, and a wrong value told.

        That is the same as a plant with the error and the right value told.
        """
        symbol = self.graph.fault_symbol(fault)
        told = _Told(point, symbol, self.seed)
        try:
            return _moves(evaluate([self.exprs[at]], told, self.terms)[0])
        except (Undefined, Mixed):
            return False

    def inclined(self, at: int, fault: str, point: Sample) -> bool:
        """Whether a small error of a fault moves a residual that holds roots of equations.

        With an error of any size its equations may have another solution in the field, or none.
        """
        symbol = self.graph.fault_symbol(fault)
        try:
            return sensitivities(self.exprs[at], point).depends.get(symbol, False)
        except (Undefined, Mixed):
            return False

    def acts(self, at: int, fault: str) -> bool:
        """Whether a fault in the plant, any function of time, moves a residual."""
        turns = max(1, _BRANCHES // len(self.assignments())) if self.decides else 1
        return any(
            _moves(values[0])
            for turn in range(turns)
            for _, values in self.faulty([self.exprs[at]], (fault,), 100 + 300 * turn)
        )

    # --------------------------------------------------------------------------- helpers

    def at(
        self, exprs: list[Expr], number: int, faults: Iterable[str], modes: dict[Expr, int] | None
    ) -> tuple[Sample, list[Any]]:
        """A point with these faults and the values of the expressions there."""
        faults = tuple(faults)
        for turn in range(_TRIES):
            point: Sample = self.plant.sample(
                exprs,
                self.seed * 1000 + number + 5000 * turn,
                self.terms,
                faults=faults,
                modes=modes,
            )
            try:
                values = evaluate(exprs, point, self.terms)
            except Undefined:
                continue
            if isinstance(point, Trajectory) and point.still and any(map(_moves, values)):
                raise ExactUnavailable("no point was found at which all its laws hold")
            self.trajectories += 1
            self.waves = self.waves or not isinstance(values[0], list)
            return point, values
        if not faults:
            unanswerable.blame(exprs, point, self.terms)
        raise ExactUnavailable("no random point was found where all residuals have a value")

    def assignments(self) -> list[dict[Expr, int] | None]:
        """Modes to try, all of them if they are few."""
        if not self.modes:
            return [None] * (_BRANCHES if self.decides else 1)
        return [*assignments(self.modes)]


class _Told:
    """A point at which one symbol is told wrong."""

    def __init__(self, point: Sample, symbol: Expr, seed: int) -> None:
        self.algebra = point.algebra
        self._point = point
        self._symbol = symbol
        true = point.value(symbol)
        random = Random(seed)
        error: Any
        if symbol.symbol.kind not in KNOWN_SIGNALS:
            error = self.algebra.number(random.randrange(1, P))
        elif isinstance(true, Wave):
            error = Wave(random.randrange(1, P), 1)
        else:
            error = [random.randrange(1, P) for _ in true]
        size = len(true) if isinstance(true, list) else 1
        self._told = self.algebra.combine([(1, true), (1, error)], size)

    def value(self, symbol: Expr) -> Any:
        return self._told if symbol is self._symbol else self._point.value(symbol)

    healthy = False

    def truly(self, variable: Expr) -> int | None:
        return self._point.truly(variable) if isinstance(self._point, Trajectory) else None

    def start(self, initial: Any) -> int:
        return self._point.start(initial)


def _decides(node: Expr) -> bool:
    """Whether a node takes one of several branches."""
    branching = ("abs", "sign", "min", "max", "ssq", "ssqrt")
    if node.op is Op.ROOT:
        return any(map(_decides, topological([node.root.zero])))
    return node.op is Op.IF or (node.op is Op.FN and node.name in branching)


def _moves(value: Any) -> bool:
    """Whether a value is not zero in any of its coefficients."""
    return any(value) if isinstance(value, list) else value.amplitude != 0
