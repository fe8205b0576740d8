"""Random exact behaviour of a bond graph, healthy or faulty: what its sensors would show.

A trajectory draws all parameters, initial values and inputs at random from the field and gives
the Taylor series of every signal. The oracle shares nothing with the elimination that it checks.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from random import Random

from bondgraph.exact import series
from bondgraph.exact.algebra import Mixed, Waves
from bondgraph.exact.assembly import Assembly, Parts, assemble
from bondgraph.exact.equations import Setting, Writer, written
from bondgraph.exact.evaluate import (
    ONSET,
    evaluate,
    highest_order,
    holds_root,
    integral_depth,
)
from bondgraph.exact.field import Functions, P, Undefined
from bondgraph.exact.known import KnownSample
from bondgraph.exact.linear import Contradiction, Singular
from bondgraph.exact.series import Series
from bondgraph.exact.taylor import OverDetermined, Solver, solve
from bondgraph.exact.trajectory import ATTEMPTS, Trajectory
from bondgraph.exact.waves import WaveSample, amplitudes, linear, tell
from bondgraph.ir.expr import Expr, Kind, Op, Symbol, topological
from bondgraph.ir.graph import BondGraph

_STILL = 5  # points that are tried with factors at rest, where there are no others
_LOOSE = 6  # nonlinear elements that are left out, one after the other, where these fail too
_LARGE = 4000  # coefficients of a trajectory that are many
_EXTRA = 16  # coefficients of time-varying parameters beyond the order asked for


class ExactUnavailable(Exception):
    """The oracle has no exact trajectory of this plant; the message is a reason for people."""


class Contradictory(ExactUnavailable):
    """No plant could behave like this: the equations are more than what they could determine.

    `node` is the number of the node at which one is too many, -1 if it is nobody's.
    """

    def __init__(self, message: str, node: int) -> None:
        super().__init__(message)
        self.node = node


class Plant:
    """The oracle of one bond graph.

    >>> # plant = Plant(graph); t = plant.trajectory(seed=1, order=4, fault="R")
    """

    def __init__(self, graph: BondGraph) -> None:
        self.graph = graph
        self.assembly: Assembly = assemble(graph)
        self._parts: Parts | None = None
        roots = [
            *[law for _, law in self.assembly.laws],
            *[r.value for r in self.assembly.rates],
            *[reads for _, _, reads in self.assembly.readings],
            *[s.reads for s in graph.sensors],
            *[n.when for n in graph.nodes if n.when is not None],
        ]
        self._roots = tuple(roots)
        roots += [v.symbol for v in graph.values] + [i.symbol for i in graph.inputs if i.mode]
        constant = (Kind.PARAM, Kind.CONST, Kind.INITIAL, Kind.FREE)
        found = [n for n in topological(roots) if n.op is Op.SYM]
        self.modes = [n for n in found if n.symbol.kind is Kind.MODE]
        symbols = {v.name: v.symbol for v in graph.sensors}
        symbols |= {v.name: v.symbol for v in graph.inputs}
        symbols |= {v.name: v.symbol for v in graph.values}
        self._names = {name: symbols[name] for name in graph.faults}
        self._reach = highest_order([s.reads for s in graph.sensors])
        self._inputs = {i.name: i.symbol for i in graph.inputs if i.known and not i.mode}
        self._reads = {s.symbol: s.reads for s in graph.sensors if s.same_as is None}
        self._read = {name for name, _, _ in self.assembly.readings}
        self._starts: dict[Expr, Expr] = {}  # initial value to the variable that it is one of
        for node in graph.nodes:
            for port in node.ports:
                if port.state is not None:
                    name = f"{port.state.symbol.name}.0"  # of one that nobody declared
                    start = port.initial or graph.pool.symbol(name, Kind.FREE)
                    self._starts[start] = port.state
        for item in graph.integrals:
            if item.initial.op is Op.SYM:
                self._starts[item.initial] = item.symbol
        self.constants = [n for n in found if n.symbol.kind in constant and n not in self._starts]
        self._samples: dict[object, Trajectory | WaveSample] = {}
        #: Parts whose laws no second point was found for once their constants were drawn.
        self.momentary: list[Assembly] = []

    @cached_property
    def _private(self) -> frozenset[Expr]:
        """Constants that a single law uses, and that may be retuned to satisfy it."""
        uses: dict[Expr, int] = {}
        for root in self._roots:
            for part in topological([root]):
                uses[part] = uses.get(part, 0) + 1
        return frozenset(v for v in self.constants if uses.get(v) == 1)

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
        onset: bool = False,
    ) -> Trajectory:
        """A random trajectory to Taylor coefficient `order`; the same for equal arguments.

        `fault` and `faults` name faults that act at once, each as a random function of time.
        `modes` fixes known booleans, the others are random. With a `part` (see `part_for`) only
        that part of the plant is simulated. At the `onset` faults are zero still. Where no point
        satisfies all laws, elements of laws that contradict the others are left out: what holds
        without them holds with them. Raises `ExactUnavailable`, KeyError for an unknown fault.
        """
        acting = (*faults, *([] if fault is None else [fault]))
        for name in acting:
            self._names[name]
        failure: Exception | None = None
        plant, left_out = part or self.assembly, 0
        for attempt in range(ATTEMPTS + _STILL * (1 + _LOOSE)):
            if attempt >= ATTEMPTS + _STILL * (1 + left_out):
                node = failure.node if isinstance(failure, Contradiction) else -1
                if node < 0:
                    break
                plant = plant._replace(laws=tuple(law for law in plant.laws if law[0] != node))
                left_out += 1
            functions = Functions(seed * ATTEMPTS + attempt)
            try:
                constants = self.draw_constants(seed, attempt, modes or {})
                return self.draw(
                    seed * ATTEMPTS + attempt,
                    order,
                    acting,
                    constants,
                    functions,
                    plant,
                    tunable=True,
                    solver=solver,
                    onset=onset,
                    still=attempt >= ATTEMPTS,
                )
            except (Undefined, Contradiction, Singular) as found:
                failure = found
        raise ExactUnavailable(self._reason(failure))

    def wave(
        self,
        seed: int,
        faults: Iterable[str] = (),
        modes: Mapping[Expr, int] | None = None,
        part: Assembly | None = None,
    ) -> WaveSample:
        """The plant with all signals exponentials of one random exponent, for any size.

        Faults are random constants on parameters and random exponentials on signals. Raises
        `Mixed` if the plant is not linear with constant coefficients, `ExactUnavailable`.
        """
        failure: Exception | None = None
        for attempt in range(ATTEMPTS):
            functions = Functions(seed * ATTEMPTS + attempt)
            random = Random(seed * 2011 + attempt)
            algebra = Waves(functions, random.randrange(2, P), random.randrange(2, P))
            try:
                constants = self.draw_constants(seed, attempt, modes or {})
                acting = tuple(faults)
                return self._wave(algebra, random, acting, constants, part or self.assembly)
            except (Undefined, Contradiction) as found:
                failure = found
        raise ExactUnavailable(self._reason(failure))

    def _wave(
        self,
        algebra: Waves,
        random: Random,
        faults: Sequence[str],
        constants: Mapping[Expr, Series],
        plant: Assembly,
    ) -> WaveSample:
        true = dict(constants)
        errors = {self._names[name]: random.randrange(1, P) for name in faults}
        if any(self._names[name] in errors for name in self._read):
            raise Mixed("a law that uses a faulty reading")
        for symbol, error in errors.items():
            if symbol in true:
                true[symbol] = [(true[symbol][0] + error) % P]
        equations = Writer(plant, Setting(true, algebra.functions, 1, frozenset(), {})).all({})
        if not linear(equations):
            raise Mixed("a law that is not linear")
        found = amplitudes(plant, equations, algebra.s, random)
        sample = WaveSample(algebra, plant.place, constants, found, {})
        inside = frozenset(plant.active)
        reads = {symbol: reads for _, symbol, reads in self._shown(plant)}
        errors = {
            v: e
            for v, e in errors.items()
            if v in reads or (v in plant.place and plant.place[v][0] in inside)
        }
        tell(sample, reads, errors)
        return sample

    def sample(
        self,
        roots: Sequence[Expr],
        seed: int,
        n: int = 1,
        *,
        faults: Iterable[str] = (),
        modes: Mapping[Expr, int] | None = None,
    ) -> Trajectory | WaveSample:
        """A point on which `n` coefficients of all roots can be evaluated.

        A trajectory where that is affordable; exponentials where the orders are many and the
        plant and the roots are linear. A healthy point is remembered. Faults set in at the point
        where iteration has to find a value: of several solutions in the field it is to find the
        one that was there before. Raises `ExactUnavailable`.
        """
        acting = tuple(faults)
        if acting or modes:
            return self._sample(roots, seed, n, acting, modes)
        key = (tuple(roots), seed, n)
        if key not in self._samples:
            self._samples[key] = self._sample(roots, seed, n, (), None)
        return self._samples[key]

    def _sample(
        self,
        roots: Sequence[Expr],
        seed: int,
        n: int,
        faults: tuple[str, ...],
        modes: Mapping[Expr, int] | None,
    ) -> Trajectory | WaveSample:
        order = highest_order(roots, n)
        part = self.part_for(roots)
        if order * len(part.active) > _LARGE and not integral_depth(roots):
            try:
                found = self.wave(seed, faults, modes, part)
                evaluate(roots, found)
                return found
            except (Mixed, Undefined):
                pass  # a trajectory can be had where exponentials cannot
        onset = bool(faults) and holds_root(roots)
        return self.trajectory(seed, order, faults=faults, modes=modes, part=part, onset=onset)

    def draw_constants(
        self, seed: int, attempt: int, modes: Mapping[Expr, int]
    ) -> dict[Expr, Series]:
        """Random parameters, and modes where they are not given."""
        random = Random(seed * 1009 + attempt)
        out: dict[Expr, Series] = {}
        for symbol in self.constants:
            out[symbol] = [random.randrange(2, P)]
        for symbol in self.modes:
            out[symbol] = [modes.get(symbol, random.getrandbits(1))]
        return out

    def draw(
        self,
        seed: int,
        order: int,
        faults: Sequence[str],
        constants: Mapping[Expr, Series],
        functions: Functions,
        part: Assembly,
        tunable: bool = False,
        solver: Solver = solve,
        onset: bool = False,
        still: bool = False,
    ) -> Trajectory:
        """A trajectory with these constants; raises `Undefined` and others if there is none.

        The plant's own parameters are the constants plus the faults that act. If they are
        `tunable`, a law that nothing else can satisfy is satisfied by a parameter of its own.
        """
        random = Random(seed * 7 + 3)
        n = order + self._reach + 1 + _EXTRA
        errors = {name: [random.randrange(1, P) for _ in range(n)] for name in faults}
        if onset:
            errors = {name: [0] * ONSET + error[ONSET:] for name, error in errors.items()}
        true = dict(constants)
        readings = {name: x for name, x in errors.items() if name in self._read}
        for name, error in errors.items():
            symbol = self._names[name]
            if symbol in true:
                true[symbol] = series.add(true[symbol], error)
        private = self._private if tunable else frozenset()
        setting = Setting(true, functions, n, private, {}, still)
        try:
            plant, equations = written(part, setting, readings, random)
            values = solver(plant, equations, setting, random, order + self._reach)
        except OverDetermined as failure:
            raise Contradictory(self._over(failure.node), failure.node) from None
        except Mixed as failure:
            raise ExactUnavailable(f"a law of the model holds {failure}") from None
        truth = KnownSample(plant.place, setting, values)
        told = dict(constants)
        for symbol, value in setting.tuned.items():
            told[symbol] = [(constants[symbol][0] + value) % P, *constants[symbol][1:]]
        inside = frozenset(plant.active)
        for name, symbol in self._inputs.items():
            if name in errors and part.place[symbol][0] in inside:
                wrong = series.scale(-1, errors[name])
                told[symbol] = series.add(truth.value(symbol), wrong)
        for name, symbol, reads in self._shown(plant):
            reading = evaluate([reads], truth, order + 1)[0]
            told[symbol] = series.add(reading, errors.get(name, [0]))
        starts: dict[Symbol, int] = {}
        for initial, state in self._starts.items():
            if plant.place[state][0] in inside:
                starts[initial.symbol] = truth.value(state)[0]
                told.setdefault(initial, [starts[initial.symbol]])
        return Trajectory(self, seed, order, tuple(faults), told, truth, starts, part, still)

    def _shown(self, plant: Assembly) -> list[tuple[str, Expr, Expr]]:
        """The sensors of a part of the plant whose readings no law uses: name, symbol, reads."""
        inside, place = frozenset(plant.active), plant.place
        return [
            (s.name, s.symbol, s.reads)
            for s in self.graph.sensors
            if s.same_as is None and s.name not in self._read
            if all(place[n][0] in inside for n in topological([s.reads]) if n in place)
        ]

    def part_for(self, roots: Sequence[Expr]) -> Assembly:
        """The part of the plant that shows the signals in the roots."""
        if self._parts is None:
            self._parts = Parts(self.assembly)
        seen: dict[Expr, None] = {}
        found = list(roots)
        while found:
            found = [n for n in topological(found) if n.op is Op.SYM and n not in seen]
            seen.update(dict.fromkeys(found))
            found = [self._reads[n] for n in found if n in self._reads]
        starts = {i.symbol: state for i, state in self._starts.items()}
        for node in topological(roots):
            if node.op is Op.INT and node.symbol in starts:
                seen[starts[node.symbol]] = None
        seen.update((self._starts[n], None) for n in list(seen) if n in self._starts)
        return self._parts.about(list(seen))

    # ------------------------------------------------------------------------ explanations

    def _over(self, node: int) -> str:
        where = f" at {self.graph.nodes[node].path}" if node >= 0 else ""
        return f"the equations are more than the variables{where}"

    def _reason(self, failure: Exception | None) -> str:
        if isinstance(failure, Singular):
            return "the equations do not determine all variables at a random point"
        if isinstance(failure, Contradiction):
            return "its nonlinear laws could not be satisfied together at a random point"
        return f"no random point was found where all laws have a value ({failure})"
