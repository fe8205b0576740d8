"""One random draw of a plant, healthy or faulty: constants, then a behaviour with them.

Constants have the declared numbers, initial values and inputs are random. Faults are of finite
size: on a parameter a function of time that is off from the start, on a signal an error.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from random import Random
from typing import NamedTuple

from bondgraph.exact.assembly import Assembly
from bondgraph.exact.evaluate import evaluate
from bondgraph.exact.exponentials import amplitudes, linear
from bondgraph.exact.knots import budget
from bondgraph.exact.known import KnownSample
from bondgraph.exact.plant_equations import Setting, Writer, written
from bondgraph.exact.plant_structure import PlantStructure
from bondgraph.exact.signal_algebra import Exponentials, Mixed, Taylor
from bondgraph.exact.taylor import OverDetermined, Solver, solve
from bondgraph.exact.trajectory import Contradictory, ExactUnavailable, Trajectory
from bondgraph.field import series
from bondgraph.field.numbers import Number, Numbers, Undefined
from bondgraph.field.series import Series
from bondgraph.field.sparse import Contradiction, Singular
from bondgraph.ir.expr import Expr, Kind, Op, Symbol

#: Random points that are tried before a plant is said to have none.
ATTEMPTS = 40
_EXTRA = 16  # coefficients of time-varying parameters beyond the order asked for


class LinearDraw(NamedTuple):
    """Constants of a linear plant, and the amplitude of every variable with them."""

    algebra: Exponentials
    constants: dict[Expr, Series]
    amplitudes: dict[int, Number]


class _Declared:
    """The numbers that a model declares, with random ones where it declares none."""

    def __init__(
        self,
        declared: Mapping[Expr, Expr | None],
        apart: Collection[Expr],
        numbers: Numbers,
        random: Random,
    ) -> None:
        self.algebra = Taylor(numbers)
        self._declared = declared
        self._apart = apart
        self._random = random
        self._known: dict[Expr, Series] = {}

    def value(self, symbol: Expr) -> Series:
        """The number of one constant."""
        if symbol not in self._known:
            numbers, declared = self.algebra.numbers, self._declared.get(symbol)
            if declared is None:
                value = numbers.around(self._random, numbers.number(1))
            else:
                value = evaluate([declared], self)[0][0]
                if symbol in self._apart and declared.op is Op.NUM:
                    value = numbers.around(self._random, value)
            self._known[symbol] = [value]
        return self._known[symbol]

    def start(self, initial: Symbol) -> Number:
        """Constants have no integrals."""
        raise Mixed("an integral in a constant")


def _changed(
    symbol: Expr,
    numbers: Numbers,
    random: Random,
    value: Series,
    n: int,
    turn: bool,
    compared: bool = False,
) -> Series:
    """A parameter with a fault of finite size, a function of time; a switch turned over."""
    if symbol.symbol.kind is Kind.MODE:
        return [1 - value[0]]
    first = numbers.off(random, value[0], turn, compared)
    return [first, *[numbers.any(random) * (first - value[0]) for _ in range(n - 1)]]


def _error(
    numbers: Numbers, random: Random, value: Series, n: int, limits: Sequence[Number]
) -> Series:
    """What a faulty sensor or input adds to a signal, a function of time."""
    at = value[0] if value else numbers.number(0)
    return [numbers.error(random, at, () if k else limits) for k in range(n)]


class Draws:
    """What can be drawn of one plant, with the constants `apart` away from their declared numbers.

    Each draw takes its own ones anew, over the reals within a factor of two.
    """

    def __init__(self, structure: PlantStructure, apart: frozenset[Expr] = frozenset()) -> None:
        self.structure = structure
        self.apart = apart
        self._constants = frozenset(structure.constants)
        # parts whose laws no second point was found for once their constants were drawn
        self._momentary: list[Assembly] = []

    def constants(
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
        declared = _Declared(self.structure.declared, self.apart, numbers, random)
        constants: Collection[Expr] = self.structure.constants
        if used is not None:
            constants = sorted(used & self._constants, key=lambda symbol: symbol.id)
        out: dict[Expr, Series] = {symbol: declared.value(symbol) for symbol in constants}
        for symbol in self.structure.modes:
            out[symbol] = [modes.get(symbol, random.getrandbits(1))]
        return out

    def trajectory(
        self,
        seed: int,
        order: int,
        faults: Sequence[str],
        constants: Mapping[Expr, Series],
        numbers: Numbers,
        part: Assembly,
        solver: Solver = solve,
        *,
        still: bool,
        joint: int,
        read: frozenset[Expr] | None = None,
        turned: bool = False,
    ) -> Trajectory:
        """A trajectory with these constants; raises `Undefined` and others if there is none.

        The plant's own parameters are the constants plus the faults that act. Only sensors among
        those to be `read` (None: all) are told.
        """
        structure = self.structure
        random = Random(seed * 7 + 3)
        n = order + structure.reach + 1 + _EXTRA
        true = dict(constants)
        limits = [
            numbers.fraction(x.number) if x.op is Op.NUM else constants[x][0]
            for x in (structure.limits if faults else ()) if x.op is Op.NUM or x in constants
        ]  # fmt: skip
        readings: dict[str, Series] = {}
        for name in faults:
            symbol = structure.faults[name]
            if symbol in true:
                turn = turned and (len(faults) == 1 or random.random() < 0.5)
                true[symbol] = _changed(
                    symbol, numbers, random, true[symbol], n, turn, symbol in structure.limits
                )
            elif name in structure.readings:
                readings[name] = _error(numbers, random, [], n, limits)
        sensors = [s for s in part.shown if read is None or s[1] in read]
        shown: tuple[Expr, ...] = ()
        if numbers.real:
            asked = structure.inside(part, structure.asked)
            shown = (*[reads for _, _, reads in sensors], *asked)
        setting = Setting(true, numbers, n, shown, still, joint)
        try:
            plant, equations = written(part, setting, readings, random, solver is solve)
            values = solver(plant, equations, setting, random, order + structure.reach)
        except OverDetermined as failure:
            raise Contradictory(self._over(failure.node), failure.node) from None
        except Mixed as failure:
            raise ExactUnavailable(f"a law of the model holds {failure}") from None
        truth = KnownSample(plant.place, setting, values)
        told = dict(constants)
        for name in faults:
            symbol = structure.faults[name]
            if name in structure.inputs and symbol in part.place:
                true_value = truth.value(symbol)
                told[symbol] = series.add(
                    true_value, _error(numbers, random, true_value, n, limits)
                )
        for name, symbol, reads in sensors:
            reading = evaluate([reads], truth, order + 1)[0]
            faulty = name in faults
            wrong = _error(numbers, random, reading, n, limits) if faulty else [0]
            told[symbol] = series.add(reading, wrong)
        starts: dict[Symbol, Number] = {}
        for state in plant.place:
            for initial in structure.initials(state):
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
        if any(part is now.part for part in self._momentary):
            return None
        numbers = now.algebra.numbers
        for attempt in range(ATTEMPTS):
            seed = (now.seed * 31 + steps) * ATTEMPTS + attempt
            with suppress(Undefined, Contradiction, Singular):
                return self.trajectory(
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
        self._momentary.append(now.part)
        return None

    def linear(
        self,
        seed: int,
        attempt: int,
        modes: Mapping[Expr, int],
        changed: Sequence[Expr],
        numbers: Numbers,
        part: Assembly,
    ) -> LinearDraw:
        """Constants, and the amplitudes of all variables while some constants have changed.

        Raises `Mixed` if the plant is not linear with constant coefficients.
        """
        random = Random(seed * 2011 + attempt)
        algebra = Exponentials(numbers, numbers.any(random), numbers.any(random), terms=0)
        constants = self.constants(seed, attempt, modes, numbers)
        true = dict(constants)
        for symbol in changed:
            true[symbol] = _changed(symbol, numbers, random, true[symbol], 1, False)
        equations = Writer(part, Setting(true, numbers, 1)).all({})
        if not linear(equations):
            raise Mixed("a law that is not linear")
        return LinearDraw(
            algebra, constants, amplitudes(numbers, part, equations, algebra.s, random)
        )

    def _over(self, node: int) -> str:
        where = f" at {self.structure.graph.nodes[node].path}" if node >= 0 else ""
        return f"the equations are more than the variables{where}"
