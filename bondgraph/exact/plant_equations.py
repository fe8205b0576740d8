"""The plant's equations at one choice of modes and parameters, with their linear parts as numbers.

An equation is linear form + rest = 0, where the rest is an expression only if it is nonlinear.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from random import Random
from typing import NamedTuple

from bondgraph.exact.assembly import Assembly
from bondgraph.exact.evaluate import evaluate, values_of, weighed
from bondgraph.exact.forms import ORDERS, Form, Forms
from bondgraph.exact.outline import demands, plan
from bondgraph.exact.signal_algebra import Mixed
from bondgraph.field.numbers import Number, Numbers
from bondgraph.field.series import Series
from bondgraph.field.sparse import CONSTANT, Row
from bondgraph.ir.expr import Expr, Op, Symbol, symbols, topological


class Equation(NamedTuple):
    """form + rest = 0. `node` is the index of the bond graph's node, -1 for none."""

    node: int
    form: Form
    rest: Expr | None


class Setting(NamedTuple):
    """Constants of one trajectory: params, consts and modes as series, `n` coefficients.

    `shown` is what sensors read. With `still` a law may be satisfied by a factor that is zero at
    all times, see `bondgraph.exact.rest`; laws that hold each other are satisfied at once, in
    at most `joint` evaluations, see `bondgraph.exact.knots`; one after the other if it is 0.
    """

    values: dict[Expr, Series]
    numbers: Numbers
    n: int
    shown: tuple[Expr, ...] = ()
    still: bool = False
    joint: int = 0


def constant(values: Mapping[Expr, Series], symbol: Expr) -> Series:
    """The value of a constant; raises `Mixed` for an initial value, which is none of the plant."""
    found = values.get(symbol)
    if found is None:
        raise Mixed(f"the initial value {symbol.symbol.name}")
    return found


class FormSample:
    """Every variable is an unknown of its own; constants are what the setting says."""

    def __init__(self, place: Mapping[Expr, tuple[int, int]], setting: Setting) -> None:
        self.algebra = Forms(setting.numbers)
        self._place = place
        self._values = setting.values

    def value(self, symbol: Expr) -> Form:
        """A constant or an unknown."""
        where = self._place.get(symbol)
        if where is None:
            return {CONSTANT: constant(self._values, symbol)}
        return {where[0] * ORDERS: [where[1]]}

    def start(self, initial: Symbol) -> Number:
        """Laws have their integrals as variables."""
        raise Mixed("an integral in a law")


class Writer:
    """Writes the equations; raises `Undefined` if a constant has no value here."""

    def __init__(self, assembly: Assembly, setting: Setting) -> None:
        self.assembly = assembly
        self.setting = setting
        self.sample = FormSample(assembly.place, setting)

    def all(self, readings: Mapping[str, Series]) -> list[Equation]:
        """The equations; `readings` are errors that faulty sensors add to what they read."""
        plant = self.assembly
        out = [Equation(-1, {v * ORDERS: [1]}, None) for v in plant.silent]
        for node, terms, when, common in plant.balances:
            if when is not None and not self.holds(when):
                out.append(Equation(node, {common * ORDERS: [1]}, None))
            elif terms:
                out.append(Equation(node, {v * ORDERS: [c] for v, c in terms}, None))
        parts: list[tuple[int, Form, Expr]] = [(node, {}, zero) for node, zero in plant.laws]
        for node, variable, value in plant.rates:
            parts.append((node, {variable * ORDERS + 1: [-1]}, value))
        for name, variable, reads in plant.readings:
            form: Form = {variable * ORDERS: [-1]}
            if name in readings:
                form[CONSTANT] = readings[name]
            parts.append((-1, form, reads))
        values: dict[Expr, Form] = {}
        rests = []
        for _, _, rest in parts:
            flat = self.flat(rest)
            if flat is None:
                rests.append(rest)
            else:
                values[rest] = flat
        nodes = topological(rests)
        others, failures = values_of(nodes, demands(nodes, rests, self.setting.n), self.sample)
        values.update(others)
        for node, form, rest in parts:
            failure = failures.get(rest)
            if failure is None:
                found = values[rest]
                if form:
                    found = self.sample.algebra.combine([(1, found), (1, form)], self.setting.n)
                out.append(Equation(node, found, None))
            elif isinstance(failure, Mixed):
                out.append(Equation(node, form, rest))
            else:
                raise failure
        return out

    def holds(self, when: Expr) -> bool:
        """Whether a switched junction is on."""
        return self.setting.numbers.nonzero(
            *self.sample.algebra.leads(evaluate([when], self.sample)[0])
        )

    def flat(self, law: Expr) -> Form | None:
        """A law that is linear as it is written; None for any other, and where constants move."""
        terms, place, values = _terms(law), self.assembly.place, self.setting.values
        if terms is None:
            return None
        numbers, form = self.setting.numbers, dict[int, Number]()
        for coefficient, factors in terms:
            weight = weighed(numbers, coefficient)
            key = CONSTANT
            for symbol, exponent, order in factors:
                where = place.get(symbol)
                if where is not None:
                    if key != CONSTANT or exponent != 1:
                        return None
                    key = where[0] * ORDERS + order
                    weight *= where[1]
                    continue
                value = values.get(symbol)
                if value is None or order or len(value) > 1:
                    return None
                x = value[0] if exponent > 0 else numbers.inverse(value[0])
                weight *= x if exponent in (1, -1) else x ** abs(exponent)
            form[key] = form.get(key, 0) + weight
        return {key: [x] for key, x in form.items() if numbers.nonzero(x)}


@lru_cache(maxsize=1 << 14)
def _terms(law: Expr) -> Sequence[tuple[Fraction, Sequence[tuple[Expr, int, int]]]] | None:
    """A law as numbers times products of symbols, each to a power or differentiated; None if not.

    >>> from bondgraph.ir.expr import Kind, Pool
    >>> p = Pool(); e, f, R = [p.symbol(s, Kind.EFFORT) for s in "efR"]
    >>> _terms(p.sub(e, p.mul(R, p.der(f))))
    [(1, [(e, 1, 0)]), (-1, [(R, 1, 0), (f, 1, 1)])]
    """
    out = []
    for coefficient, term in law.terms:
        factors = []
        for base, exponent in term.factors:
            order = 0
            while base.op is Op.DER:
                base, order = base.args[0], order + 1
            if base.op is Op.NUM and not order and len(term.args) == 0:
                coefficient *= base.number
                continue
            if base.op is not Op.SYM:
                return None
            factors.append((base, exponent, order))
        out.append((coefficient, factors))
    return out


def signature(
    place: Mapping[Expr, tuple[int, int]], free: Collection[int], equation: Equation
) -> dict[int, int]:
    """The highest derivative of each variable in an equation, free ones left out."""
    out: dict[int, int] = {}
    for key in equation.form:
        variable, order = divmod(key, ORDERS)
        if key != CONSTANT:
            out[variable] = max(out.get(variable, 0), order)
    if equation.rest is not None:
        for variable, order in reach(place, equation.rest).items():
            out[variable] = max(out.get(variable, 0), order)
    return {v: order for v, order in out.items() if v not in free} if free else out


def reach(place: Mapping[Expr, tuple[int, int]], rest: Expr) -> dict[int, int]:
    """The highest derivative of each variable in an expression, free ones included."""
    nodes, need = plan(rest, 1)
    out: dict[int, int] = {}
    for v in nodes:
        if v.op is Op.SYM and v in place:
            variable = place[v][0]
            out[variable] = max(out.get(variable, 0), need[v] - 1)
    return out


def made_linear(equation: Equation, sample: FormSample, n: int) -> Equation:
    """The equation with its rest in the form, if the rest is linear after all."""
    if equation.rest is None:
        return equation
    try:
        rest = evaluate([equation.rest], sample, n)[0]
    except Mixed:
        return equation
    form = sample.algebra.combine([(1, rest), (1, equation.form)], n)
    return equation._replace(form=form, rest=None)


#: Functions with sides: what is on one of them says nothing of the other.
_SIDED = frozenset({"sign", "min", "max", "abs", "atan2"})


def has_sides(node: Expr) -> bool:
    """Whether a node is a function of several branches."""
    return node.op is Op.FN and (node.name in _SIDED or node.name.startswith("table:"))


def written(
    plant: Assembly,
    setting: Setting,
    readings: Mapping[str, Series],
    random: Random,
    moving: bool = True,
) -> tuple[Assembly, list[Equation]]:
    """The equations, and the plant that they are about.

    An input that a law uses in a product or a function is drawn here and is a constant of the
    setting from then on: a law must not be satisfied by the one value of an input that allows it.
    It moves unless the plant is in steady operation.
    One behind a function with sides, or in a condition, stays open at every second point, so that
    the function's argument can be drawn on any side: a controller whose set point is at random is
    at its limit.
    """
    equations = Writer(plant, setting).all(readings)
    given = _modulating(equations, plant, sided=random.random() < 0.5)
    if not given:
        return plant, equations
    size = setting.n if moving else 1
    for symbol in given:
        setting.values[symbol] = [setting.numbers.any(random) for _ in range(size)]
    place = {s: at for s, at in plant.place.items() if s not in given}
    plant = plant._replace(place=place)
    return plant, Writer(plant, setting).all(readings)


def _modulating(equations: list[Equation], plant: Assembly, sided: bool) -> list[Expr]:
    """The inputs that laws use in products and functions; those with sides only if asked."""
    free = frozenset((*plant.free, *plant.unknown))
    inputs = frozenset(s for s, (variable, _) in plant.place.items() if variable in free)

    def sides(node: Expr) -> bool:
        open_ = node.op is Op.IF and not inputs.isdisjoint(symbols(node.args[0]))
        return has_sides(node) or open_

    out: dict[Expr, None] = {}
    for equation in equations:
        if equation.rest is None:
            continue
        rest = equation.rest
        for node in topological([rest], stop=None if sided else sides):
            if not sided and sides(node):
                continue
            if node is not rest or node.op is not Op.ADD:
                out.update((a, None) for a in node.args if a in inputs)
    return list(out)


def coefficient_row(numbers: Numbers, form: Form, order: int, stride: int) -> Row:
    """The Taylor coefficient `order` of a form, in columns variable * stride + coefficient."""
    row: Row = {}
    for key, weights in form.items():
        if key == CONSTANT:
            if order < len(weights):
                row[CONSTANT] = weights[order]
            continue
        variable, derivative = divmod(key, ORDERS)
        for m, weight in enumerate(weights if len(weights) == 1 else weights[: order + 1]):
            if weight:
                low = order - m
                for k in range(low + 1, low + derivative + 1) if derivative else ():
                    weight *= k
                column = variable * stride + low + derivative
                row[column] = row[column] + weight if column in row else weight
    return {c: x for c, x in row.items() if numbers.nonzero(x)}
