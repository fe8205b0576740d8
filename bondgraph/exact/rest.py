"""Signals that are zero whatever happens, and the laws that hold because everything rests there.

Two transformers with different ratios between the same junctions leave no effort there but zero; a
resistor at that junction then has no flow, whatever its law, as long as the law allows rest. No
random point would ever satisfy such a law, so that it is replaced by what it says: zero.
"""

from __future__ import annotations

from contextlib import suppress

from bondgraph.exact.assembly import Assembly
from bondgraph.exact.evaluate import evaluate
from bondgraph.exact.forms import ORDERS, Form
from bondgraph.exact.known import KnownSample
from bondgraph.exact.offsets import square_part
from bondgraph.exact.plant_equations import Equation, FormSample, Setting, made_linear, reach
from bondgraph.exact.point import STRIDE, Point
from bondgraph.exact.signal_algebra import Mixed
from bondgraph.field import series
from bondgraph.field.numbers import Undefined
from bondgraph.field.sparse import CONSTANT, Row, add_multiple
from bondgraph.ir.expr import Expr, symbols

_Key = tuple[int, int]  # variable, derivative


def settled(
    plant: Assembly, equations: list[Equation], setting: Setting, point: Point
) -> list[Equation]:
    """The equations without what is known to be zero; the same list if there is nothing.

    `point` holds the linear equations and nothing random yet. Where several solutions exist for
    laws that allow rest, rest is taken.
    """
    zero = {s: plant.pool.zero for s in _nonlinear_symbols(equations) if _vanishes(plant, point, s)}
    out = [_without(plant, setting, e, zero) if e.rest is not None else e for e in equations]
    found = _at_rest(plant, out, setting, point)
    for number, form in found.items():
        out[number] = out[number]._replace(form=form, rest=None)
    changed = any(a is not b for a, b in zip(out, equations, strict=True))
    if not changed and setting.still:
        return _without_factor(plant, equations, point)
    return out if changed else equations


def _without_factor(plant: Assembly, equations: list[Equation], point: Point) -> list[Equation]:
    """The equations, the first law that is a product with one signal replaced by its rest.

    A transformer of changing ratio beside a bond asks for (1 - m(x)) e = 0: the effort rests, as
    the ratio cannot be the same at all times.
    """
    for number, equation in enumerate(equations):
        if equation.rest is None or equation.form:
            continue
        alike: dict[tuple[tuple[int, object], ...], list[Expr]] = {}  # multiples of one another
        for symbol in symbols(equation.rest):
            if symbol in plant.place:
                row = point.reduce({plant.place[symbol][0] * STRIDE: 1})
                if row and CONSTANT not in row:
                    factor = point.numbers.inverse(row[min(row)])
                    label = point.numbers.label
                    key = tuple((c, label(row[c] * factor)) for c in sorted(row))
                    alike.setdefault(key, []).append(symbol)
        for factors in alike.values():
            zero = dict.fromkeys(factors, plant.pool.zero)
            with suppress(ZeroDivisionError):
                if plant.pool.substitute([equation.rest], zero)[0] is plant.pool.zero:
                    at = plant.place[factors[0]][0]
                    replaced = Equation(equation.node, {at * ORDERS: [1]}, None)
                    return [*equations[:number], replaced, *equations[number + 1 :]]
    return equations


def _nonlinear_symbols(equations: list[Equation]) -> list[Expr]:
    return symbols(*[e.rest for e in equations if e.rest is not None])


def _vanishes(plant: Assembly, point: Point, symbol: Expr) -> bool:
    """Whether the linear equations leave a variable no value but zero.

    It is then zero at all times: the point and its parameters are those of any time.
    """
    where = plant.place.get(symbol)
    return where is not None and not point.reduce({where[0] * STRIDE: 1})


def _without(
    plant: Assembly, setting: Setting, equation: Equation, zero: dict[Expr, Expr]
) -> Equation:
    """The equation with zero for variables; what it determines is not asked anew."""
    assert equation.rest is not None
    if not any(s in zero for s in symbols(equation.rest)):
        return equation
    try:
        rest = plant.pool.substitute([equation.rest], zero)[0]
    except ZeroDivisionError:
        return equation
    sample = FormSample(plant.place, setting)
    return made_linear(equation._replace(rest=rest), sample, setting.n)


def _at_rest(
    plant: Assembly, equations: list[Equation], setting: Setting, point: Point
) -> dict[int, Form]:
    """Laws that together allow nothing but rest, each with a form that is zero there.

    Laws that hold at rest and have no more independent signals than there are laws.
    """
    laws = {
        number: keys
        for number, e in enumerate(equations)
        if e.rest is not None and (keys := _resting(plant, e, setting, point)) is not None
    }
    basis = _Basis(point)
    supports = [sorted({b for key in keys for b in basis.support(key)}) for keys in laws.values()]
    numbers = list(laws)
    out: dict[int, Form] = {}
    for at, column in square_part([dict.fromkeys(s, 0) for s in supports], len(basis.keys)):
        form: Form = {}
        if column >= 0:
            variable, derivative = basis.keys[column]
            form = {variable * ORDERS + derivative: [1]}
        out[numbers[at]] = form
    return out


def _resting(
    plant: Assembly, equation: Equation, setting: Setting, point: Point
) -> list[_Key] | None:
    """The signals of a law that holds when all of them are zero, and that all may be zero."""
    assert equation.rest is not None
    if CONSTANT in equation.form:
        return None
    keys: dict[_Key, None] = {}
    for key in equation.form:
        keys[divmod(key, ORDERS)] = None
    for variable, highest in reach(plant.place, equation.rest).items():
        keys.update(dict.fromkeys((variable, k) for k in range(highest + 1)))
    if any(CONSTANT in point.reduce({v * STRIDE + k: 1}) for v, k in keys):
        return None
    still = KnownSample(plant.place, setting, [[0]] * plant.count_of)
    try:
        value = evaluate([equation.rest], still)[0]
    except (Undefined, Mixed):
        return None
    return None if series.moves(setting.numbers, value) else list(keys)


class _Basis:
    """Signals that the others are linear in, taken from the laws themselves, in their order."""

    def __init__(self, point: Point) -> None:
        self.keys: list[_Key] = []
        self._point = point
        self._pivots: list[tuple[int, Row]] = []

    def support(self, key: _Key) -> list[int]:
        """The numbers of the basis signals that a signal depends on."""
        numbers = self._point.numbers
        row = dict(self._point.reduce({key[0] * STRIDE + key[1]: 1}))
        for column, pivot in self._pivots:
            x = row.pop(column, None)
            if x is not None:
                add_multiple(numbers, row, -x, pivot)
        open_columns = [c for c in row if c >= 0]
        if not open_columns:
            return [-2 - c for c in row]
        number = len(self.keys)
        self.keys.append(key)
        row[-2 - number] = -1
        column = min(open_columns)
        scaled: Row = {}
        add_multiple(numbers, scaled, numbers.inverse(row.pop(column)), row)
        self._pivots.append((column, scaled))
        return [number]
