"""The oracle of a bond graph: exact behaviour, drawn at random until every law holds.

A trajectory has the declared parameters, random initial values and inputs, and gives the Taylor
series of every signal: in real numbers, or modulo a prime where the plant is rational. The oracle
starts from the bonds and shares only arithmetic with the elimination that it checks: no
derivative, inverse, branch or monotony of a function.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from random import Random
from typing import NamedTuple

from bondgraph.exact.assembly import Assembly
from bondgraph.exact.evaluate import evaluate
from bondgraph.exact.exponentials import ExponentialSample, tell
from bondgraph.exact.knots import budget
from bondgraph.exact.outline import highest_order, integral_depth
from bondgraph.exact.plant_draws import ATTEMPTS, Draws, LinearDraw
from bondgraph.exact.plant_structure import PlantStructure, symbols_of
from bondgraph.exact.signal_algebra import Mixed
from bondgraph.exact.taylor import Solver, solve
from bondgraph.exact.trajectory import Contradictory, ExactUnavailable, Trajectory
from bondgraph.field.balls import Precision, Reals
from bondgraph.field.numbers import Numbers, Undefined
from bondgraph.field.prime import PrimeField
from bondgraph.field.sparse import Contradiction, Singular
from bondgraph.ir.expr import Expr
from bondgraph.ir.graph import BondGraph

_STILL = 5  # points that are tried with factors at rest, where there are no others
_LOOSE = 6  # nonlinear elements that are left out, one after the other, where these fail too
_SMALL, _USUAL, _GREAT = (-3, 0), (0, 0), (0, 1.3)  # powers of ten: the sizes of signals
_SIZES = (_SMALL, _SMALL, _USUAL, _GREAT)
_FULL_SIZE = 4  # points that are tried with signals of any size, before small ones only are
_MODULAR = 6  # points that are tried in a prime field, before real ones are
_LARGE = 4000  # coefficients of a trajectory that are many
_HIGH = 8  # derivatives that are many


class _Wanted(NamedTuple):
    """A trajectory that is asked for."""

    seed: int
    order: int
    faults: tuple[str, ...]
    modes: Mapping[Expr, int]
    part: Assembly
    solver: Solver
    read: frozenset[Expr] | None
    turned: bool

    @property
    def kind(self) -> object:
        """What trajectories have in common that differ in their random numbers alone."""
        modes = tuple(self.modes.items())
        return self.faults, modes, id(self.part), self.solver, self.read, self.turned


class _Drawn(NamedTuple):
    """Where the search for a trajectory begins: what fails before has failed for another one."""

    attempt: int
    part: Assembly
    left_out: int


class Plant:
    """Random behaviour of one bond graph, healthy or faulty: what its sensors would show.

    >>> # plant = Plant(graph); t = plant.trajectory(seed=1, order=4, fault="R")
    """

    def __init__(
        self,
        graph: BondGraph,
        structure: PlantStructure | None = None,
        apart: frozenset[Expr] = frozenset(),
        precision: Precision | None = None,
    ) -> None:
        self.graph = graph
        self.structure = structure or PlantStructure(graph)
        self._draws = Draws(self.structure, apart)
        self._precision = precision or Precision()
        self._samples: dict[object, Trajectory | ExponentialSample] = {}
        self._linear: dict[object, LinearDraw] = {}
        self._hopeless: dict[object, str] = {}  # no trajectory was found, and why
        self._drawn: dict[object, _Drawn] = {}  # by the kind of a trajectory, see `_Wanted`

    def apart(self, constants: Iterable[Expr] | None = None) -> Plant:
        """The same plant with some constants (None: all) away from their declared numbers.

        Each trajectory draws them anew, over the reals within a factor of two.
        """
        apart = frozenset(self.structure.declared if constants is None else constants)
        return Plant(self.graph, self.structure, apart, self._precision)

    def holding(self, starts: Mapping[Expr, Expr]) -> Plant:
        """The plant with some states at constant values instead of the rates that they have."""
        held = self.structure.holding(starts)
        return Plant(self.graph, held, self._draws.apart, self._precision)

    def trajectory(
        self,
        seed: int,
        order: int,
        fault: str | None = None,
        *,
        faults: Iterable[str] = (),
        modes: Mapping[Expr, int] | None = None,
        part: Assembly | None = None,
        solver: Solver = solve,
        roots: Iterable[Expr] = (),
        turned: bool = False,
    ) -> Trajectory:
        """A random trajectory to Taylor coefficient `order`; the same for equal arguments.

        `fault` and `faults` name faults that act at once, each as a random function of time.
        Where they are `turned` a faulty parameter has the other sign, of several every second one.
        `modes` fixes known booleans, the others are random. With a `part` (of its structure) only
        that part of the plant is simulated. Numbers are those of a prime field where the plant
        and the `roots`, which are to be evaluated on it, are rational, else real. Where roots are
        given, only the sensors in them have to have a value. Raises `ExactUnavailable`, KeyError
        for an unknown fault.
        """
        acting = (*faults, *([] if fault is None else [fault]))
        for name in acting:
            self.structure.faults[name]
        roots = list(roots)
        read = frozenset(symbols_of(roots)) if roots else None
        inside = part or self.structure.assembly
        wanted = _Wanted(seed, order, acting, modes or {}, inside, solver, read, turned)
        if self.structure.rational(wanted.part, roots):
            with suppress(ExactUnavailable):
                return self._tried(wanted, real=False)
        key = (id(wanted.part), tuple(wanted.modes.items()), solver)
        if key in self._hopeless:
            raise ExactUnavailable(self._hopeless[key])
        try:
            return self._tried(wanted, real=True)
        except ExactUnavailable as reason:
            if not acting and not isinstance(reason, Contradictory):
                self._hopeless[key] = str(reason)
            raise

    def _tried(self, wanted: _Wanted, real: bool) -> Trajectory:
        """A trajectory over one kind of numbers, drawn again until all laws can be satisfied.

        Where no real one is found, elements of laws that contradict the others are left out: what
        holds without them holds with them. A machine that could only be drawn at rest, or so, the
        first time is not tried in motion again: that costs most, and fails as it did.
        """
        failure: Exception | None = None
        last = ATTEMPTS + _STILL * (1 + _LOOSE) if real else _MODULAR
        read = wanted.read
        used = None if read is None else read | self.structure.reached(wanted.part)
        kind = (wanted.kind, real)
        first, plant, left_out = self._drawn.get(kind, _Drawn(0, wanted.part, 0))
        for attempt in range(first, last):
            if attempt >= ATTEMPTS + _STILL * (1 + left_out):
                node = failure.node if isinstance(failure, Contradiction) else -1
                if node < 0:
                    break
                plant = plant._replace(laws=tuple(law for law in plant.laws if law[0] != node))
                left_out += 1
            seed = wanted.seed * ATTEMPTS + attempt
            numbers = self._numbers(seed, attempt if real else None)
            try:
                found = self._draws.trajectory(
                    seed,
                    wanted.order,
                    wanted.faults,
                    self._draws.constants(wanted.seed, attempt, wanted.modes, numbers, used),
                    numbers,
                    plant,
                    solver=wanted.solver,
                    still=attempt >= ATTEMPTS,
                    joint=budget(attempt) if real else 0,
                    read=read,
                    turned=wanted.turned,
                )
            except (Undefined, Contradiction, Singular) as reason:
                failure = reason
                continue
            begin = ATTEMPTS + _STILL * left_out if attempt >= ATTEMPTS else 0
            self._drawn.setdefault(kind, _Drawn(begin, plant, left_out))
            return found
        raise ExactUnavailable(_reason(failure))

    def _numbers(self, seed: int, attempt: int | None) -> Numbers:
        """A prime field, or for an attempt the real numbers, with small, usual or large signals.

        A law that saturates has an inverse only near zero, one side of zero may have no other, and
        what a large signal alone shows lies beyond a limit.
        """
        if attempt is None:
            return PrimeField(seed)
        draw = Random(seed)
        low, high = draw.choice(_SIZES) if attempt < _FULL_SIZE else _SMALL
        scale = 10.0 ** draw.uniform(low, high)
        return Reals(self.graph.pool.tables, self._precision, scale)

    def exponential(
        self,
        seed: int,
        faults: Iterable[str] = (),
        modes: Mapping[Expr, int] | None = None,
        part: Assembly | None = None,
    ) -> ExponentialSample:
        """The plant with all signals exponentials of one random exponent, for any size.

        Faults are random constants on parameters and random exponentials on signals. Raises
        `Mixed` if the plant is not linear with constant coefficients, `ExactUnavailable`.
        """
        structure = self.structure
        plant, acting = part or structure.assembly, [structure.faults[name] for name in faults]
        if any(structure.faults[name] in acting for name in structure.readings):
            raise Mixed("a law that uses a faulty reading")
        inside = {*structure.constants, *structure.modes}
        changed = tuple(symbol for symbol in acting if symbol in inside)
        key = (seed, tuple((modes or {}).items()), id(plant), changed)
        found = self._linear.get(key)
        if found is None:
            found = self._drawn_linear(seed, modes or {}, changed, plant)
            if not changed:  # only a healthy plant is asked for again
                self._linear[key] = found
        algebra, constants, amplitudes = found
        reads = {symbol: reads for _, symbol, reads in plant.shown}
        random = Random(f"{seed}:errors")
        told = [s for s in acting if s in reads or (s in plant.place and s not in changed)]
        sample = ExponentialSample(algebra, plant.place, constants, amplitudes, {})
        tell(sample, reads, {symbol: algebra.numbers.any(random) for symbol in told})
        return sample

    def _drawn_linear(
        self, seed: int, modes: Mapping[Expr, int], changed: Sequence[Expr], part: Assembly
    ) -> LinearDraw:
        """Amplitudes while some constants have changed, drawn again until all have a value."""
        failure: Exception | None = None
        for attempt in range(ATTEMPTS):
            numbers = PrimeField(seed * ATTEMPTS + attempt)
            try:
                return self._draws.linear(seed, attempt, modes, changed, numbers, part)
            except (Undefined, Contradiction) as reason:
                failure = reason
        raise ExactUnavailable(_reason(failure))

    def many(self, roots: Sequence[Expr], n: int, part: Assembly) -> bool:
        """Whether a trajectory has so many coefficients that exponentials are tried first.

        Only where the order is what makes them many: exponentials are what the inputs force, and
        do not show what begins differently in machines that are alike.
        """
        order = highest_order(roots, n)
        large = order > _HIGH and order * part.count_of > _LARGE and not integral_depth(roots)
        return large and self.structure.rational(part, roots)

    def sample(
        self,
        roots: Sequence[Expr],
        seed: int,
        n: int = 1,
        *,
        faults: Iterable[str] = (),
        modes: Mapping[Expr, int] | None = None,
        part: Assembly | None = None,
        turned: bool = False,
    ) -> Trajectory | ExponentialSample:
        """A point on which `n` coefficients of all roots can be evaluated.

        A trajectory where that is affordable; exponentials where the orders are many and the
        plant and the roots are linear. A healthy point is remembered. Raises `ExactUnavailable`.
        """
        acting = tuple(faults)
        inside = part or self.structure.part_for(roots)
        if acting or modes:
            return self._sample(roots, seed, n, acting, modes, inside, turned)
        key = (tuple(roots), seed, n, id(inside))
        if key not in self._samples:
            self._samples[key] = self._sample(roots, seed, n, (), None, inside, False)
        return self._samples[key]

    def _sample(
        self,
        roots: Sequence[Expr],
        seed: int,
        n: int,
        faults: tuple[str, ...],
        modes: Mapping[Expr, int] | None,
        part: Assembly,
        turned: bool,
    ) -> Trajectory | ExponentialSample:
        order = highest_order(roots, n)
        if self.many(roots, n, part):
            try:
                found = self.exponential(seed, faults, modes, part)
                evaluate(roots, found)
                return found
            except (Mixed, Undefined):
                pass  # a trajectory can be had where exponentials cannot
        return self.trajectory(
            seed, order, faults=faults, modes=modes, part=part, roots=roots, turned=turned
        )


def _reason(failure: Exception | None) -> str:
    """Why no random point was found, for people."""
    if isinstance(failure, Singular):
        return "the equations do not determine all variables at a random point"
    if isinstance(failure, Contradiction):
        return "its nonlinear laws could not be satisfied together at a random point"
    return f"no random point was found where all laws have a value ({failure})"
