"""Random exact behaviour of a bond graph, healthy or faulty: what its sensors would show.

A trajectory has the declared parameters, random initial values and inputs, and gives the Taylor
series of every signal: in real numbers, or modulo a prime where the plant is rational. The oracle
starts from the bonds and shares only arithmetic with the elimination that it checks: no
derivative, inverse, branch or monotony of a function.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from copy import copy
from itertools import chain
from random import Random
from typing import NamedTuple

from bondgraph.exact.assembly import Assembly, Parts, assemble
from bondgraph.exact.evaluate import evaluate
from bondgraph.exact.exponentials import ExponentialSample, amplitudes, linear, tell
from bondgraph.exact.knots import budget
from bondgraph.exact.known import KnownSample
from bondgraph.exact.outline import highest_order, integral_depth, outline, rational
from bondgraph.exact.plant_equations import Setting, Writer, written
from bondgraph.exact.signal_algebra import Exponentials, Mixed, Taylor
from bondgraph.exact.taylor import OverDetermined, Solver, solve
from bondgraph.exact.trajectory import Trajectory
from bondgraph.field import series
from bondgraph.field.balls import Precision, Reals
from bondgraph.field.numbers import Number, Numbers, Undefined
from bondgraph.field.prime import PrimeField
from bondgraph.field.series import Series
from bondgraph.field.sparse import Contradiction, Singular
from bondgraph.ir.expr import Expr, Kind, Op, Symbol, topological
from bondgraph.ir.graph import BondGraph

#: Random points that are tried before a plant is said to have none.
ATTEMPTS = 40
_STILL = 5  # points that are tried with factors at rest, where there are no others
_LOOSE = 6  # nonlinear elements that are left out, one after the other, where these fail too
_SMALL, _USUAL, _GREAT = (-3, 0), (0, 0), (0, 1.3)  # powers of ten: the sizes of signals
_SIZES = (_SMALL, _SMALL, _USUAL, _GREAT)
_FULL_SIZE = 4  # points that are tried with signals of any size, before small ones only are
_MODULAR = 6  # points that are tried in a prime field, before real ones are
_LARGE = 4000  # coefficients of a trajectory that are many
_HIGH = 8  # derivatives that are many
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


class _Declared:
    """The numbers that a model declares, with random ones where it declares none."""

    def __init__(self, plant: Plant, numbers: Numbers, random: Random) -> None:
        self.algebra = Taylor(numbers)
        self._plant = plant
        self._random = random
        self._known: dict[Expr, Series] = {}

    def value(self, symbol: Expr) -> Series:
        """The number of one constant."""
        if symbol not in self._known:
            numbers, declared = self.algebra.numbers, self._plant._declared.get(symbol)
            if declared is None:
                value = numbers.around(self._random, numbers.number(1))
            else:
                value = evaluate([declared], self)[0][0]
                if symbol in self._plant._apart and declared.op is Op.NUM:
                    value = numbers.around(self._random, value)
            self._known[symbol] = [value]
        return self._known[symbol]

    def start(self, initial: Symbol) -> Number:
        """Constants have no integrals."""
        raise Mixed("an integral in a constant")


def _changed(
    symbol: Expr, numbers: Numbers, random: Random, value: Series, n: int, turn: bool
) -> Series:
    """A parameter with a fault of finite size, a function of time; a switch turned over."""
    if symbol.symbol.kind is Kind.MODE:
        return [1 - value[0]]
    first = numbers.off(random, value[0], turn)
    return [first, *[numbers.any(random) * (first - value[0]) for _ in range(n - 1)]]


def _error(numbers: Numbers, random: Random, value: Series, n: int) -> Series:
    """What a faulty sensor or input adds to a signal, a function of time."""
    at = value[0] if value else numbers.number(0)
    return [numbers.error(random, at) for _ in range(n)]


def _symbols(roots: Iterable[Expr]) -> Iterator[Expr]:
    """The symbols in some expressions, those of each by itself."""
    return chain.from_iterable(outline(root).symbols for root in roots)


class Plant:
    """The oracle of one bond graph.

    >>> # plant = Plant(graph); t = plant.trajectory(seed=1, order=4, fault="R")
    """

    def __init__(self, graph: BondGraph) -> None:
        self.graph = graph
        self.assembly: Assembly = assemble(graph)
        self._parts: Parts | None = None
        self._cones: dict[Expr, Assembly] = {}
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
        stuck = [i.name for i in graph.inputs if i.mode]  # in the position that they are not told
        self._names = {name: symbols[name] for name in (*graph.faults, *stuck)}
        self._reach = highest_order([s.reads for s in graph.sensors])
        self._inputs = {i.name: i.symbol for i in graph.inputs if i.known and not i.mode}
        self._reads = {s.symbol: s.reads for s in graph.sensors if s.same_as is None}
        self._read = {name for name, _, _ in self.assembly.readings}
        self._starts: dict[Expr, Expr] = {}  # initial value to the variable that it is one of
        self._start_of: dict[Expr, list[Expr]] = {}
        self._begins: dict[Symbol, Expr] = {}
        for node in graph.nodes:
            for port in node.ports:
                if port.state is not None:
                    name = f"{port.state.symbol.name}.0"  # of one that nobody declared
                    start = port.initial or graph.pool.symbol(name, Kind.FREE)
                    self._starts[start] = port.state
        for item in graph.integrals:
            if item.initial.op is Op.SYM:
                self._starts[item.initial] = item.symbol
        for start, state in self._starts.items():
            self._start_of.setdefault(state, []).append(start)
            self._begins[start.symbol] = state
        self.constants = [n for n in found if n.symbol.kind in constant and n not in self._starts]
        self._constants = frozenset(self.constants)
        self._samples: dict[object, Trajectory | ExponentialSample] = {}
        self._exponentials: dict[
            object, tuple[Exponentials, dict[Expr, Series], dict[int, Number]]
        ] = {}
        #: Parts whose laws no second point was found for once their constants were drawn.
        self.momentary: list[Assembly] = []
        self._declared = {v.symbol: v.value for v in graph.values}
        self._apart: frozenset[Expr] = frozenset()
        self.held: tuple[Expr, ...] = ()  # initial values that states keep, see `holding`
        self._asked: tuple[Expr, ...] = ()  # what has to have a value besides the sensors
        # by the identity of parts, which are kept
        self._rational: dict[int, bool] = {}
        self._precision = Precision()
        self._reached: dict[int, frozenset[Expr]] = {}
        self._hopeless: dict[object, str] = {}  # no trajectory was found, and why
        self._drawn: dict[object, _Drawn] = {}  # by the kind of a trajectory, see `_Wanted`

    def apart(self, constants: Iterable[Expr] | None = None) -> Plant:
        """The same plant with some constants (None: all) away from their declared numbers.

        Each trajectory draws them anew, over the reals within a factor of two.
        """
        other = copy(self)
        other._apart = frozenset(self._declared if constants is None else constants)
        other._samples, other._exponentials, other.momentary = {}, {}, []
        other._hopeless, other._drawn = {}, {}
        return other

    def declared_starts(self) -> list[tuple[Expr, Expr, Expr]]:
        """The declared initial values: the symbol, the state that it is one of, its value."""
        values = self.graph.initial_values()
        starts = self._starts.items()
        return [(s, state, values[s.symbol]) for s, state in starts if s.symbol in values]

    def holding(self, starts: Mapping[Expr, Expr]) -> Plant:
        """The plant with some states at constant values instead of the rates that they have."""
        whole, pool = self.assembly, self.graph.pool
        held = {whole.place[state][0] for state in starts}

        def put(expr: Expr) -> Expr:
            return pool.substitute([expr], starts)[0]

        rates = [rate for rate in whole.rates if rate.variable not in held]
        dropped = [put(rate.value) for rate in whole.rates if rate.variable in held]
        laws = [(node, put(law)) for node, law in whole.laws]
        laws += [(-1, pool.sub(state, value)) for state, value in starts.items()]
        other = copy(self)
        other.assembly = whole._replace(
            balances=tuple(
                b if b.when is None else b._replace(when=put(b.when)) for b in whole.balances
            ),
            laws=tuple(laws),
            rates=tuple(rate._replace(value=put(rate.value)) for rate in rates),
            readings=tuple((name, at, put(reads)) for name, at, reads in whole.readings),
        )
        other._asked = tuple(dropped)
        other.held = tuple(initial for initial, state in self._starts.items() if state in starts)
        other._parts, other._cones = None, {}
        other._rational, other._reached = {}, {}
        other._samples, other._exponentials, other.momentary = {}, {}, []
        other._hopeless, other._drawn = {}, {}
        return other

    def numbered(self, expr: Expr) -> list[Expr]:
        """The constants with a declared number that the plant or an expression uses."""
        used = dict.fromkeys((*self.constants, *outline(expr).symbols))
        numbers = [s for s in used if (v := self._declared.get(s)) is not None and v.op is Op.NUM]
        return sorted(numbers, key=lambda s: s.id)

    def reached(self, part: Assembly) -> frozenset[Expr]:
        """The symbols that a part of the plant is made of; no other fault can act in it."""
        found = self._reached.get(id(part))
        if found is None:
            roots = [law for _, law in part.laws] + [r.value for r in part.rates]
            roots += [reads for _, _, reads in (*part.readings, *part.shown)]
            roots += [b.when for b in part.balances if b.when is not None]
            own = [symbol for _, symbol, _ in part.shown]
            found = self._reached[id(part)] = frozenset((*_symbols(roots), *part.place, *own))
        return found

    def rational(self, part: Assembly, roots: Iterable[Expr] = ()) -> bool:
        """Whether a part of the plant, and what is asked of it, are rational.

        A prime field is then as good as the real numbers, and faster.
        """
        if id(part) not in self._rational:
            parts = [law for _, law in part.laws] + [r.value for r in part.rates]
            parts += [reads for _, _, reads in (*part.readings, *part.shown)]
            self._rational[id(part)] = rational(parts)
        return self._rational[id(part)] and rational(roots)

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
        `modes` fixes known booleans, the others are random. With a `part` (see `part_for`) only
        that part of the plant is simulated. Numbers are those of a prime field where the plant
        and the `roots`, which are to be evaluated on it, are rational, else real. Where roots are
        given, only the sensors in them have to have a value. Raises `ExactUnavailable`, KeyError
        for an unknown fault.
        """
        acting = (*faults, *([] if fault is None else [fault]))
        for name in acting:
            self._names[name]
        roots = list(roots)
        read = frozenset(_symbols(roots)) if roots else None
        inside = part or self.assembly
        wanted = _Wanted(seed, order, acting, modes or {}, inside, solver, read, turned)
        if self.rational(wanted.part, roots):
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
                found = self.draw(
                    seed,
                    wanted.order,
                    wanted.faults,
                    self.draw_constants(
                        wanted.seed,
                        attempt,
                        wanted.modes,
                        numbers,
                        None if wanted.read is None else wanted.read | self.reached(wanted.part),
                    ),
                    numbers,
                    plant,
                    solver=wanted.solver,
                    still=attempt >= ATTEMPTS,
                    joint=budget(attempt) if real else 0,
                    read=wanted.read,
                    turned=wanted.turned,
                )
            except (Undefined, Contradiction, Singular) as reason:
                failure = reason
                continue
            begin = ATTEMPTS + _STILL * left_out if attempt >= ATTEMPTS else 0
            self._drawn.setdefault(kind, _Drawn(begin, plant, left_out))
            return found
        raise ExactUnavailable(self._reason(failure))

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
        plant, acting = part or self.assembly, [self._names[name] for name in faults]
        if any(self._names[name] in acting for name in self._read):
            raise Mixed("a law that uses a faulty reading")
        inside = self._constants.union(self.modes)
        changed = tuple(symbol for symbol in acting if symbol in inside)
        key = (seed, tuple((modes or {}).items()), id(plant), changed)
        if key not in self._exponentials:
            self._exponentials[key] = self._exponential(seed, modes or {}, changed, plant)
        algebra, constants, found = self._exponentials[key]
        if changed:
            del self._exponentials[key]  # only a healthy plant is asked for again
        reads = {symbol: reads for _, symbol, reads in plant.shown}
        random = Random(f"{seed}:errors")
        told = [s for s in acting if s in reads or (s in plant.place and s not in changed)]
        sample = ExponentialSample(algebra, plant.place, constants, found, {})
        tell(sample, reads, {symbol: algebra.numbers.any(random) for symbol in told})
        return sample

    def _exponential(
        self, seed: int, modes: Mapping[Expr, int], changed: Sequence[Expr], plant: Assembly
    ) -> tuple[Exponentials, dict[Expr, Series], dict[int, Number]]:
        """Constants, and the amplitudes of all variables while some constants are others."""
        failure: Exception | None = None
        for attempt in range(ATTEMPTS):
            numbers = PrimeField(seed * ATTEMPTS + attempt)
            random = Random(seed * 2011 + attempt)
            algebra = Exponentials(numbers, numbers.any(random), numbers.any(random), terms=0)
            try:
                constants = self.draw_constants(seed, attempt, modes, numbers)
                true = dict(constants)
                for s in changed:
                    true[s] = _changed(s, numbers, random, true[s], 1, False)
                equations = Writer(plant, Setting(true, numbers, 1)).all({})
                if not linear(equations):
                    raise Mixed("a law that is not linear")
                found = amplitudes(numbers, plant, equations, algebra.s, random)
                return algebra, constants, found
            except (Undefined, Contradiction) as reason:
                failure = reason
        raise ExactUnavailable(self._reason(failure))

    def many(self, roots: Sequence[Expr], n: int, part: Assembly) -> bool:
        """Whether a trajectory has so many coefficients that exponentials are tried first.

        Only where the order is what makes them many: exponentials are what the inputs force, and
        do not show what begins differently in machines that are alike.
        """
        order = highest_order(roots, n)
        large = order > _HIGH and order * part.count_of > _LARGE and not integral_depth(roots)
        return large and self.rational(part, roots)

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
        inside = part or self.part_for(roots)
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

    def draw_constants(
        self,
        seed: int,
        attempt: int,
        modes: Mapping[Expr, int],
        numbers: Numbers,
        used: frozenset[Expr] | None = None,
    ) -> dict[Expr, Series]:
        """The declared parameters, random ones where none is declared, and modes if not given.

        Only those that are `used` (None: all).
        """
        random = Random(seed * 1009 + attempt)
        declared = _Declared(self, numbers, random)
        constants: Collection[Expr] = self.constants
        if used is not None:
            constants = sorted(used & self._constants, key=lambda symbol: symbol.id)
        out: dict[Expr, Series] = {symbol: declared.value(symbol) for symbol in constants}
        for symbol in self.modes:
            out[symbol] = [modes.get(symbol, random.getrandbits(1))]
        return out

    def draw(
        self,
        seed: int,
        order: int,
        faults: Sequence[str],
        constants: Mapping[Expr, Series],
        numbers: Numbers,
        part: Assembly,
        solver: Solver = solve,
        still: bool = False,
        joint: int = 0,
        read: frozenset[Expr] | None = None,
        turned: bool = False,
    ) -> Trajectory:
        """A trajectory with these constants; raises `Undefined` and others if there is none.

        The plant's own parameters are the constants plus the faults that act. Only sensors among
        those to be `read` (None: all) are told.
        """
        random = Random(seed * 7 + 3)
        n = order + self._reach + 1 + _EXTRA
        true = dict(constants)
        readings: dict[str, Series] = {}
        for name in faults:
            symbol = self._names[name]
            if symbol in true:
                turn = turned and (len(faults) == 1 or random.random() < 0.5)
                true[symbol] = _changed(symbol, numbers, random, true[symbol], n, turn)
            elif name in self._read:
                readings[name] = _error(numbers, random, [], n)
        told_sensors = [s for s in part.shown if read is None or s[1] in read]
        shown: tuple[Expr, ...] = ()
        if numbers.real:
            shown = (*[reads for _, _, reads in told_sensors], *self._inside(part, self._asked))
        setting = Setting(true, numbers, n, shown, still, joint)
        try:
            plant, equations = written(part, setting, readings, random, solver is solve)
            values = solver(plant, equations, setting, random, order + self._reach)
        except OverDetermined as failure:
            raise Contradictory(self._over(failure.node), failure.node) from None
        except Mixed as failure:
            raise ExactUnavailable(f"a law of the model holds {failure}") from None
        truth = KnownSample(plant.place, setting, values)
        told = dict(constants)
        for name in faults:
            symbol = self._names[name]
            if name in self._inputs and symbol in part.place:
                true_value = truth.value(symbol)
                told[symbol] = series.add(true_value, _error(numbers, random, true_value, n))
        for name, symbol, reads in told_sensors:
            reading = evaluate([reads], truth, order + 1)[0]
            wrong = _error(numbers, random, reading, n) if name in faults else [0]
            told[symbol] = series.add(reading, wrong)
        starts: dict[Symbol, Number] = {}
        for state in plant.place:
            for initial in self._start_of.get(state, ()):
                starts[initial.symbol] = truth.value(state)[0]
                told.setdefault(initial, [starts[initial.symbol]])
        acting = tuple(faults)
        return Trajectory(
            self._earlier, seed, order, acting, told, truth, starts, part, still, read
        )

    def _earlier(
        self, now: Trajectory, steps: int, constants: dict[Expr, Series]
    ) -> Trajectory | None:
        """A healthy trajectory with the same constants, of another time."""
        if any(part is now.part for part in self.momentary):
            return None
        numbers = now.algebra.numbers
        for attempt in range(ATTEMPTS):
            seed = (now.seed * 31 + steps) * ATTEMPTS + attempt
            with suppress(Undefined, Contradiction, Singular):
                return self.draw(
                    seed,
                    now.order,
                    (),
                    constants,
                    numbers,
                    now.part,
                    still=now.still,
                    joint=budget(attempt) if numbers.real else 0,
                    read=now.read,
                )
        self.momentary.append(now.part)
        return None

    def _inside(self, part: Assembly, exprs: Iterable[Expr]) -> list[Expr]:
        """Those of the expressions that rest on variables of a part alone."""
        whole = self.assembly.place
        return [e for e in exprs if all(s in part.place for s in outline(e).symbols if s in whole)]

    def part_for(self, roots: Sequence[Expr]) -> Assembly:
        """The part of the plant that shows the signals in the roots."""
        if self._parts is None:
            self._parts = Parts(self.assembly)
        seen: dict[Expr, None] = {}
        found = list(roots)
        while found:
            found = [n for n in dict.fromkeys(_symbols(found)) if n not in seen]
            seen.update(dict.fromkeys(found))
            found = [self._reads[n] for n in found if n in self._reads]
        for root in roots:
            for node in outline(root).nodes if Op.INT in outline(root).ops else ():
                if node.op is Op.INT and node.symbol in self._begins:
                    seen[self._begins[node.symbol]] = None
        seen.update((self._starts[n], None) for n in list(seen) if n in self._starts)
        return self._parts.about(seen)

    def cone(self, root: Expr) -> Assembly:
        """The sub-plant that a relation can rest on, and no more.

        What does not move the relation there does not move it on the plant.
        """
        if self._parts is None:
            self._parts = Parts(self.assembly)
        found = self._cones.get(root)
        if found is None:
            told = [self._reads.get(s, s) for s in outline(root).symbols]
            place = self.assembly.place
            values = [t for t in told if any(s in place for s in outline(t).symbols)]
            found = self._cones[root] = self._parts.resting_on(values)
        return found

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
