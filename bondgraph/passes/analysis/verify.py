"""Check residuals and signatures against an exact simulation of the bond graph.

Healthy plants must give residuals that are exactly zero: at the declared numbers and at others
near them. Every entry of the signature matrix is decided again, at other points, by a plant that
is assembled anew (translation validation: Pnueli, Siegel and Singerman, 1998).
"""

from __future__ import annotations

from contextlib import suppress

from bondgraph.exact.dependence import Forward, sensitivities
from bondgraph.exact.evaluate import Sample, evaluate, terms_needed
from bondgraph.exact.from_start import from_start
from bondgraph.exact.outline import outline
from bondgraph.exact.plant import Plant
from bondgraph.exact.reactions import Reactions, branches
from bondgraph.exact.switch_modes import assignments, modes_of
from bondgraph.exact.trajectory import Contradictory, ExactUnavailable, Trajectory
from bondgraph.exact.verification import Verification
from bondgraph.field.numbers import Undefined
from bondgraph.ir.expr import Expr, Kind
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.residuals import Observer, Residual, ResidualSet
from bondgraph.ir.signature_matrix import SignatureMatrix
from bondgraph.passes.analysis import unanswerable
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Span

_BRANCHES = 6  # healthy plants where a law or a residual decides something, else one
_TRIES = 20  # points at which a residual or a law may have no value, drawn again
_APART = 499  # the seed of other points than those that the signatures were decided at


def verify(
    graph: BondGraph,
    residuals: ResidualSet,
    signatures: SignatureMatrix,
    report: Report,
    seed: int = 1,
    plant: Plant | None = None,
) -> Verification:
    """Check every residual and every entry of the fault signature matrix, exactly.

    Reports `verification-failed` (an error, and a bug of the compiler) with a residual that does
    not vanish on a healthy plant, `signature-unconfirmed` (a warning) with an entry that other
    points contradict, or `verification-unavailable` (a warning) with the reason.
    """
    return _Check(graph, residuals, signatures, report, seed, plant or Plant(graph)).run()


def follows(
    residual: Residual, observer: Observer, plant: Plant, report: Report, seed: int = 1
) -> bool:
    """Whether a healthy plant moves as an observer says; `verification-failed` where it does not.

    The states are taken from the elimination, which knows them from derivatives. True, too, where
    the oracle has no trajectory that they could be looked at on.
    """
    pool = plant.graph.pool
    closed = {step.variable: step.closed for step in residual.steps}
    exprs = [
        pool.sub(pool.der(closed[x]), pool.substitute([rate], closed)[0])
        for x, rate in zip(observer.states, observer.rates, strict=True)
    ]
    exprs.append(pool.sub(observer.measured, pool.substitute([observer.output], closed)[0]))
    size = terms_needed(exprs)

    def moved(number: int) -> bool:
        sample = plant.sample(exprs, number, size)
        still = isinstance(sample, Trajectory) and sample.still
        return not still and any(map(sample.algebra.moves, evaluate(exprs, sample, size)))

    try:
        wrong = Reactions(plant, seed).draw(moved, 1000 * (seed + _APART))
    except ExactUnavailable:
        return True
    if wrong:
        what = f"the observer of {residual.name} does not move as the healthy model does"
        _failed(report, what, residual)
    return not wrong


def _failed(report: Report, what: str, residual: Residual) -> None:
    report.error(
        "verification-failed",
        what,
        residual.closing.origin,
        help="This is a mistake of the compiler, not of the model: nothing was written. "
        "Please report it with the model.",
    )


class _Failed(Exception):
    """A residual that does not vanish on a healthy plant."""

    def __init__(self, residual: int, message: str) -> None:
        super().__init__(message)
        self.residual = residual


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
        faults = graph.fault_symbols()
        self.faulty = frozenset(faults.values())
        self.seen = {r: {faults[f] for f in seen} for r, seen in signatures.sees.items()}
        self.report = report
        self.seed = seed + _APART
        self.plant = plant
        self.terms = terms_needed(self.exprs)
        self.trajectories = 0
        self.points: list[Sample] = []  # healthy ones
        self.faults = 0
        self.kinds: dict[str, None] = {}
        self.modes = modes_of(graph, self.exprs)
        laws = [law.zero for node in graph.nodes for law in node.laws]
        self.decides = branches([*self.exprs, *laws])

    def run(self) -> Verification:
        """Everything, in the order of cost; the first thing found wrong is reported."""
        for residual in self.residuals:
            if all(s.symbol.kind is not Kind.SENSOR for s in outline(residual.expr).symbols):
                closing = residual.closing  # what the sources alone must satisfy is no residual
                unanswerable.contradictory(self.report, closing.name, closing.origin)
                return self.result("not verified: a relation without a sensor")
        try:
            if self.exprs:
                unanswerable.divides_by_nothing(self.graph, self.exprs)
                self.healthy(self.plant)
                self.resting()
                self.healthy_elsewhere()
                self.entries()
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
            divisor = unanswerable.divided_away(self.graph.pool, self.points[-1:], residual)
            if divisor is not None:
                unanswerable.resting(self.report, residual, divisor)
                return self.result("not verified: a step divides by zero")
            _failed(self.report, str(failure), residual)
            return self.result("failed")
        return self.result(self.method())

    def result(self, method: str) -> Verification:
        done = len(self.exprs) if method != "failed" and not method.startswith("not") else 0
        return Verification(
            self.trajectories, done, self.faults, len(self.signatures.faults), method
        )

    def method(self) -> str:
        if not self.exprs:
            return "nothing to verify: the model has no residual"
        faults = f"{self.faults} of {len(self.signatures.faults)} faults"
        return f"exact {' and '.join(self.kinds)}; {faults}"

    def place(self) -> tuple[Span, ...]:
        return (self.residuals[0].closing.origin,) if self.residuals else ()

    # ------------------------------------------------------------------------- the parts

    def healthy(self, plant: Plant) -> None:
        """Every residual vanishes on healthy plants."""
        failure: ExactUnavailable | None = None
        met = False
        for number, modes in enumerate(self.assignments()):
            try:
                point, moved = self.at(plant, number, modes)
            except ExactUnavailable as reason:
                if failure is None or isinstance(failure, Contradictory):
                    failure = reason  # not every combination of switches leaves a plant
                continue
            met = True
            self.points.append(point)
            for at, moves in enumerate(moved):
                if moves:
                    name = self.residuals[at].name
                    raise _Failed(at, f"residual {name} is not zero on the healthy model")
        if not met:
            raise failure or ExactUnavailable("no mode of the model has a trajectory")

    def resting(self) -> None:
        """No relation was made by dividing by what is always zero.

        Such a relation may vanish all the same, whatever fault is there; looked at where a
        relation does not see all that it holds.
        """
        for at, residual in enumerate(self.residuals):
            seen = self.seen[residual.name]
            if any(s in self.faulty and s not in seen for s in outline(residual.expr).symbols):
                divisor = unanswerable.divided_away(self.graph.pool, self.points, residual)
                if divisor is not None:
                    raise unanswerable.Resting(at, divisor)

    def healthy_elsewhere(self) -> None:
        """The same with other parameters, where these leave a plant."""
        with suppress(ExactUnavailable):
            self.healthy(self.plant.apart())

    def entries(self) -> None:
        """Every residual sees what it is said to see and nothing else, at other points too.

        Where laws have branches, what these points do not show may have been seen in a branch
        that they do not take.
        """
        reactions = Reactions(from_start(self.plant), self.seed)
        forward = None if self.decides else Forward(self.exprs, self.points[0])
        for residual in self.residuals:
            name, expr, seen = residual.name, residual.expr, self.seen[residual.name]
            if name in self.signatures.unconfirmed:
                continue
            for symbol in reactions.movers(expr, reactions.faults, seen):
                self.contradicted(name, symbol, "sees", "at some points, its signature does not")
            unproved = [] if forward is None else self.unproved(expr, seen, forward)
            for symbol in sorted(unproved, key=lambda s: s.id):
                if not reactions.moves(expr, symbol):
                    self.contradicted(name, symbol, "does not see", "at some points, as it should")
        self.faults = len(self.signatures.faults)

    def unproved(self, expr: Expr, seen: set[Expr], forward: Forward) -> set[Expr]:
        """The faults along which a residual has no slope at the healthy point."""
        try:
            found = sensitivities(expr, self.points[0], forward=forward)
        except Undefined:
            return seen
        proved = {s for s, hit in found.depends.items() if hit}
        return seen - {s for s in proved if s.symbol.kind is not Kind.PARAM or s in found.lasting}

    def contradicted(self, residual: str, fault: Expr, does: str, where: str) -> None:
        """Say that other points contradict an entry of the matrix."""
        known = {symbol: name for name, symbol in self.graph.fault_symbols().items()}
        self.report.warning(
            "signature-unconfirmed",
            f"residual {residual} {does} {known[fault]} {where}",
            *self.place(),
            help="The fault shows only in a small part of what the machine does, in one branch of "
            "a law perhaps. Do not count on this residual to clear the fault.",
        )

    # --------------------------------------------------------------------------- helpers

    def at(
        self, plant: Plant, number: int, modes: dict[Expr, int] | None
    ) -> tuple[Sample, list[bool]]:
        """A healthy point, and which residuals do not vanish there."""
        for turn in range(_TRIES):
            number_ = self.seed * 1000 + number + 5000 * turn
            point: Sample = plant.sample(self.exprs, number_, self.terms, modes=modes)
            try:
                moved = list(map(point.algebra.moves, evaluate(self.exprs, point, self.terms)))
            except Undefined:
                continue
            still = isinstance(point, Trajectory) and point.still
            if still and any(moved):
                raise ExactUnavailable("no point was found at which all its laws hold")
            self.trajectories += 1
            self.kinds[point.algebra.kind] = None
            return point, moved
        unanswerable.blame(self.exprs, point, self.terms)
        raise ExactUnavailable("no random point was found where all residuals have a value")

    def assignments(self) -> list[dict[Expr, int] | None]:
        """Modes to try, all of them if they are few."""
        if not self.modes:
            return [None] * (_BRANCHES if self.decides else 1)
        return [*assignments(self.modes)]
