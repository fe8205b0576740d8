"""Steady operation of a plant: a random point at which every effort and flow stays as it is.

Stores neither fill nor empty, known and unknown inputs are constant; only what a model writes as
an integral (an angle that turns on) may grow. A linear plant has a linear space of such points.
A mechanism whose parts move with its position has none in motion, but it can be held: its position
stays, while currents of its coils go on. What has not even that can stand at rest.
"""

from __future__ import annotations

from random import Random

from bondgraph.exact.assembly import Assembly
from bondgraph.exact.forms import ORDERS
from bondgraph.exact.plant_equations import Equation, Setting
from bondgraph.exact.point import STRIDE, Point
from bondgraph.field.series import Series
from bondgraph.ir.expr import Kind

_TOP = 3  # coefficients that are solved for: an integral of an integral of a constant has as many
_HELD = frozenset({Kind.READING})
_MAY_GROW = frozenset({Kind.STATE, Kind.INTEGRAL, *_HELD})


def steady(
    plant: Assembly, equations: list[Equation], setting: Setting, random: Random, order: int
) -> list[Series]:
    """The series of every variable, as `taylor.solve` gives them: most have one coefficient.

    Efforts and flows are constant.
    Raises `Contradiction` where the plant cannot stand still at this random choice of its
    parameters (another choice may do), `Undefined` where a law has no value.
    """
    return _with(_still(plant), plant, equations, setting, random)


def held(
    plant: Assembly, equations: list[Equation], setting: Setting, random: Random, order: int
) -> list[Series]:
    """The same for a plant that stays where it is: what is written as an integral is constant."""
    return _with(_still(plant, _HELD), plant, equations, setting, random)


def rest(
    plant: Assembly, equations: list[Equation], setting: Setting, random: Random, order: int
) -> list[Series]:
    """The same for a plant that stands: all flows are zero, under whatever efforts."""
    flows = {v for s, (v, _) in plant.place.items() if s.symbol.kind is Kind.FLOW}
    zero = [Equation(-1, {v * ORDERS: [1]}, None) for v in sorted(flows)]
    return _with([*_still(plant), *zero], plant, equations, setting, random)


def _still(plant: Assembly, may_grow: frozenset[Kind] = _MAY_GROW) -> list[Equation]:
    grows = {v for s, (v, _) in plant.place.items() if s.symbol.kind in may_grow}
    stays = [v for v in range(plant.count_of) if v not in grows]
    return [Equation(-1, {v * ORDERS + 1: [1]}, None) for v in stays]


def _with(
    extra: list[Equation],
    plant: Assembly,
    equations: list[Equation],
    setting: Setting,
    random: Random,
) -> list[Series]:
    """A point that satisfies all equations and their first derivatives."""
    point = Point(plant.place, setting, random)
    both = [*equations, *extra]
    times = [_TOP] * len(both)
    point.linear(both, times)
    point.nonlinear(both, times)
    found = point.complete([v * STRIDE + k for v in range(plant.count_of) for k in range(_TOP + 1)])
    values: list[Series] = []
    for v in range(plant.count_of):
        series = [found[v * STRIDE + k] for k in range(_TOP + 1)]
        while len(series) > 1 and not setting.numbers.nonzero(series[-1]):
            series.pop()
        values.append(series)
    return values
