"""Random exact behaviour of a bond graph, healthy or faulty: what its sensors would show.

A trajectory draws all parameters, initial values and inputs at random from the field and gives
the Taylor series of every signal. The oracle shares nothing with the elimination that it checks.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from random import Random

from bondgraph.exact import series
from bondgraph.exact.algebra import Mixed, Waves
from bondgraph.exact.assembly import Assembly, assemble
from bondgraph.exact.equations import Setting, Writer
from bondgraph.exact.evaluate import evaluate, highest_order, integral_depth
from bondgraph.exact.field import Functions, P, Undefined
from bondgraph.exact.linear import Contradiction, Singular
from bondgraph.exact.point import KnownSample
from bondgraph.exact.series import Series
from bondgraph.exact.taylor import OverDetermined, solve
from bondgraph.exact.waves import WaveSample, amplitudes, linear, tell
from bondgraph.ir.expr import CONSTANTS, Expr, Kind, Op, Symbol, topological
from bondgraph.ir.graph import BondGraph

_ATTEMPTS = 60
_LARGE = 4000  # coefficients of a trajectory that are many
_EXTRA = 16  # coefficients of time-varying parameters beyond the order asked for


class ExactUnavailable(Exception):
    """The oracle has no exact trajectory of this plant; the message is a reason for people."""


class Trajectory:
    """One random behaviour: what a residual is told, and what truly happens.

    `faults` are the names of the faults that act. `value` gives what a residual is told: readings
    and inputs with their errors, parameters without. `truth` gives the true series.
    """

    def __init__(
        self,
        plant: Plant,
        seed: int,
        order: int,
        faults: tuple[str, ...],
        told: dict[Expr, Series],
        truth: KnownSample,
        starts: dict[Symbol, int],
    ) -> None:
        self.plant = plant
        self.seed = seed
        self.order = order
        self.faults = faults
        self.algebra = truth.algebra
        self._told = told
        self._truth = truth
        self._starts = starts
        self._earlier: dict[int, Trajectory] = {}

    def value(self, symbol: Expr) -> Series:
        """What a residual is told about a symbol, at least `order` + 1 Taylor coefficients."""
        found = self._told.get(symbol)
        if found is None:
            found = self._told[symbol] = self._truth.value(symbol)
        return found

    def truth(self, symbol: Expr) -> Series:
        """The true series of a variable, an input or a parameter."""
        return self._truth.value(symbol)

    def start(self, initial: Symbol) -> int:
        """The value from which integrals with this initial value begin."""
        return self._starts[initial]

    def earlier(self, steps: int) -> Trajectory:
        """The same healthy plant with the same constants at another time.

        Constants (parameters, declared initial values) are the same, all signals different; an
        integral begins there with its value of that time.
        """
        found = self._earlier.get(steps)
        if found is None:
            constants = {s: v for s, v in self._told.items() if s.symbol.kind in CONSTANTS}
            constants.update((s, v) for s, v in self._told.items() if s.symbol.kind is Kind.MODE)
            found = self.plant.draw(
                self.seed * 31 + steps, self.order, (), constants, self.algebra.functions
            )
            self._earlier[steps] = found
        return found


class Plant:
    """The oracle of one bond graph.

    >>> # plant = Plant(graph); t = plant.trajectory(seed=1, order=4, fault="R")
    """

    def __init__(self, graph: BondGraph) -> None:
        self.graph = graph
        self.assembly: Assembly = assemble(graph)
        roots = [
            *[law for _, law in self.assembly.laws],
            *[r.value for r in self.assembly.rates],
            *[reads for _, _, reads in self.assembly.readings],
            *[s.reads for s in graph.sensors],
            *[n.when for n in graph.nodes if n.when is not None],
        ]
        roots += [v.symbol for v in graph.values] + [i.symbol for i in graph.inputs if i.mode]
        constant = (Kind.PARAM, Kind.CONST, Kind.INITIAL, Kind.FREE)
        found = [n for n in topological(roots) if n.op is Op.SYM]
        self.modes = [n for n in found if n.symbol.kind is Kind.MODE]
        symbols = {v.name: v.symbol for v in graph.sensors}
        symbols |= {v.name: v.symbol for v in graph.inputs}
        symbols |= {v.name: v.symbol for v in graph.values}
        self._names = {name: symbols[name] for name in graph.faults}
        self._reach = highest_order([s.reads for s in graph.sensors])
        self._read = {name for name, _, _ in self.assembly.readings}
        self._starts: dict[Expr, Expr] = {}  # initial value to the variable that it is one of
        for node in graph.nodes:
            for port in node.ports:
                if port.state is not None and port.initial is not None:
                    self._starts[port.initial] = port.state
        for item in graph.integrals:
            if item.initial.op is Op.SYM:
                self._starts[item.initial] = item.symbol
        self.constants = [n for n in found if n.symbol.kind in constant and n not in self._starts]

    def trajectory(
        self,
        seed: int,
        order: int,
        fault: str | None = None,
        *,
        faults: Iterable[str] = (),
        modes: Mapping[Expr, int] | None = None,
    ) -> Trajectory:
        """A random trajectory to Taylor coefficient `order`; the same for equal arguments.

        `fault` and `faults` name faults that act at once, each as a random function of time.
        `modes` fixes known booleans, the others are random. Raises `ExactUnavailable`, KeyError
        for an unknown fault.
        """
        acting = (*faults, *([] if fault is None else [fault]))
        for name in acting:
            self._names[name]
        failure: Exception | None = None
        for attempt in range(_ATTEMPTS):
            functions = Functions(seed * _ATTEMPTS + attempt)
            try:
                constants = self.draw_constants(seed, attempt, modes or {})
                return self.draw(seed * _ATTEMPTS + attempt, order, acting, constants, functions)
            except (Undefined, Contradiction, Singular) as found:
                failure = found
        raise ExactUnavailable(self._reason(failure))

    def wave(
        self, seed: int, faults: Iterable[str] = (), modes: Mapping[Expr, int] | None = None
    ) -> WaveSample:
        """The plant with all signals exponentials of one random exponent, for any size.

        Faults are random constants on parameters and random exponentials on signals. Raises
        `Mixed` if the plant is not linear with constant coefficients, `ExactUnavailable`.
        """
        failure: Exception | None = None
        for attempt in range(_ATTEMPTS):
            functions = Functions(seed * _ATTEMPTS + attempt)
            random = Random(seed * 2011 + attempt)
            algebra = Waves(functions, random.randrange(2, P), random.randrange(2, P))
            try:
                constants = self.draw_constants(seed, attempt, modes or {})
                return self._wave(algebra, random, tuple(faults), constants)
            except (Undefined, Contradiction) as found:
                failure = found
        raise ExactUnavailable(self._reason(failure))

    def _wave(
        self,
        algebra: Waves,
        random: Random,
        faults: Sequence[str],
        constants: Mapping[Expr, Series],
    ) -> WaveSample:
        true = dict(constants)
        errors = {self._names[name]: random.randrange(1, P) for name in faults}
        if any(self._names[name] in errors for name in self._read):
            raise Mixed("a law that uses a faulty reading")
        for symbol, error in errors.items():
            if symbol in true:
                true[symbol] = [(true[symbol][0] + error) % P]
        equations = Writer(self.assembly, Setting(true, algebra.functions, 1)).all({})
        if not linear(equations):
            raise Mixed("a law that is not linear")
        found = amplitudes(self.assembly, equations, algebra.s, random)
        sample = WaveSample(algebra, self.assembly.place, constants, found, {})
        reads = {
            s.symbol: s.reads
            for s in self.graph.sensors
            if s.same_as is None and s.name not in self._read
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
        plant and the roots are linear. Raises `ExactUnavailable`.
        """
        order = highest_order(roots, n)
        if order * self.assembly.count_of > _LARGE and not integral_depth(roots):
            try:
                found = self.wave(seed, faults, modes)
                evaluate(roots, found)
                return found
            except Mixed:
                pass
        return self.trajectory(seed, order, faults=faults, modes=modes)

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
    ) -> Trajectory:
        """A trajectory with these constants; raises `Undefined` and others if there is none.

        The plant's own parameters are the constants plus the faults that act.
        """
        random = Random(seed * 7 + 3)
        graph, plant = self.graph, self.assembly
        n = order + self._reach + 1 + _EXTRA
        errors = {name: [random.randrange(1, P) for _ in range(n)] for name in faults}
        true = dict(constants)
        readings = {name: x for name, x in errors.items() if name in self._read}
        for name, error in errors.items():
            symbol = self._names[name]
            if symbol in true:
                true[symbol] = series.add(true[symbol], error)
        setting = Setting(true, functions, n)
        try:
            equations = Writer(plant, setting).all(readings)
            values = solve(plant, equations, setting, random, order + self._reach)
        except OverDetermined as failure:
            raise ExactUnavailable(self._over(failure.node)) from None
        except Mixed as failure:
            raise ExactUnavailable(f"a law of the model holds {failure}") from None
        except KeyError as failure:
            raise ExactUnavailable(f"a law of the model rests on {failure}") from None
        truth = KnownSample(plant.place, setting, values)
        told = dict(constants)
        for item in graph.inputs:
            if item.known and not item.mode and item.name in errors:
                wrong = series.scale(-1, errors[item.name])
                told[item.symbol] = series.add(truth.value(item.symbol), wrong)
        for sensor in graph.sensors:
            if sensor.same_as is None and sensor.name not in self._read:
                reading = evaluate([sensor.reads], truth, order + 1)[0]
                told[sensor.symbol] = series.add(reading, errors.get(sensor.name, [0]))
        starts = {i.symbol: truth.value(state)[0] for i, state in self._starts.items()}
        for initial in self._starts:
            told.setdefault(initial, [starts[initial.symbol]])
        return Trajectory(self, seed, order, tuple(faults), told, truth, starts)

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
