"""Linear plants of any size: every signal an exponential X e^(s t), found by one sparse solve.

In a linear plant with constant coefficients all signals may share one random s; the derivative is
then a multiplication, and what would be a series of a thousand coefficients is one number.
"""

from __future__ import annotations

from collections.abc import Mapping
from random import Random

from bondgraph.exact.assembly import Assembly
from bondgraph.exact.evaluate import evaluate
from bondgraph.exact.forms import ORDERS
from bondgraph.exact.plant_equations import Equation
from bondgraph.exact.signal_algebra import Exponential, Exponentials, Mixed
from bondgraph.field.numbers import Number, Numbers
from bondgraph.field.series import Series
from bondgraph.field.sparse import CONSTANT, Row, back_substitute, eliminate
from bondgraph.ir.expr import KNOWN_SIGNALS, Expr, Symbol


def linear(equations: list[Equation]) -> bool:
    """Whether all equations are linear and homogeneous with constant coefficients."""
    return all(
        e.rest is None and CONSTANT not in e.form and all(len(w) == 1 for w in e.form.values())
        for e in equations
    )


def amplitudes(
    numbers: Numbers, plant: Assembly, equations: list[Equation], s: Number, random: Random
) -> dict[int, Number]:
    """The amplitude of every variable; free ones are random.

    Raises `Contradiction` if the equations are more than the variables.
    """
    powers: list[Number] = [1]
    for _ in range(ORDERS):
        powers.append(powers[-1] * s)
    rows = []
    for equation in equations:
        row: Row = {}
        for key, weights in equation.form.items():
            variable, derivative = divmod(key, ORDERS)
            x = row.get(variable, 0) + weights[0] * powers[derivative]
            if x:
                row[variable] = x
            else:
                del row[variable]
        rows.append(row)
    pivots = eliminate(numbers, rows)
    determined = {p.column for p in pivots}
    values = {j: numbers.any(random) for j in range(plant.count_of) if j not in determined}
    back_substitute(pivots, values)
    return values


class ExponentialSample:
    """Told signals and constants as exponentials; what is not told is what the plant shows."""

    def __init__(
        self,
        algebra: Exponentials,
        place: Mapping[Expr, tuple[int, int]],
        constants: Mapping[Expr, Series],
        found: Mapping[int, Number],
        told: dict[Expr, Exponential],
    ) -> None:
        self.algebra = algebra
        self._place = place
        self._constants = constants
        self._found = found
        self._told = told

    def value(self, symbol: Expr) -> Exponential:
        """What a residual is told about a symbol."""
        known = self._told.get(symbol)
        if known is not None:
            return known
        constant = self._constants.get(symbol)
        if constant is not None:
            return (constant[0], 0)
        if symbol not in self._place:
            raise Mixed("the initial value of a state")
        variable, sign = self._place[symbol]
        return (self._found[variable] * sign, 1)

    def start(self, initial: Symbol) -> Number:
        """Exponentials have no integrals from an initial value."""
        raise Mixed("an integral from an initial value")

    def earlier(self, steps: int) -> ExponentialSample:
        """Linear residuals look the same at every time."""
        return self

    def tell(self, symbol: Expr, amplitude: Number) -> None:
        """Say what a residual is told about a signal."""
        self._told[symbol] = (amplitude, 1)


def tell(
    sample: ExponentialSample, readings: Mapping[Expr, Expr], errors: Mapping[Expr, Number]
) -> None:
    """Fill in what sensors show, and the errors of sensors and known inputs."""
    for symbol, reads in readings.items():
        amplitude, degree = evaluate([reads], sample)[0]
        if amplitude and degree != 1:
            raise Mixed("a sensor that is not linear")
        sample.tell(symbol, amplitude + errors.get(symbol, 0))
    for symbol, error in errors.items():
        if symbol.symbol.kind in KNOWN_SIGNALS and symbol not in readings:
            sample.tell(symbol, sample.value(symbol)[0] - error)
