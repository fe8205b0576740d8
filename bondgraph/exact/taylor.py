"""The Taylor series of all variables of a plant around a random consistent point.

Beyond the point every order is one linear system with the same matrix, the Jacobian of Pryce's
Sigma-method (2001); it is factored once. A plant whose Jacobian is singular because its entries
cancel is solved as one large system of all coefficients instead.
"""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import NamedTuple, TypeAlias

from bondgraph.exact.assembly import Assembly
from bondgraph.exact.evaluate import evaluate
from bondgraph.exact.forms import ORDERS
from bondgraph.exact.known import KnownSample, gradient
from bondgraph.exact.offsets import Offsets, offsets
from bondgraph.exact.plant_equations import Equation, Setting, coefficient_row, signature
from bondgraph.exact.point import STRIDE, Point
from bondgraph.exact.rest import settled
from bondgraph.field.numbers import Number
from bondgraph.field.series import Series
from bondgraph.field.sparse import CONSTANT, Contradiction, Factors, Row, Singular

#: What finds the series of all variables: assembly, equations, setting, random numbers, order.
Solver: TypeAlias = Callable[[Assembly, list[Equation], Setting, Random, int], list[Series]]


_MARGIN = 4  # orders to spare for what follows by differentiation


class OverDetermined(Exception):
    """An equation that no variable is left for; `node` is the index in the graph."""

    def __init__(self, node: int) -> None:
        super().__init__("over-determined")
        self.node = node


class _System(NamedTuple):
    """Equations with offsets; `given` are variables that are free functions of time."""

    equations: list[Equation]
    offsets: Offsets
    given: list[int]


def _structure(plant: Assembly, equations: list[Equation]) -> _System:
    free = frozenset((*plant.free, *plant.unknown))
    found = offsets([signature(plant.place, free, e) for e in equations], plant.count_of)
    if found.unmatched:
        raise OverDetermined(equations[found.unmatched[0]].node)
    return _System(equations, found, found.free)


def solve(
    plant: Assembly, equations: list[Equation], setting: Setting, random: Random, order: int
) -> list[Series]:
    """The series of every variable to the given order, one list of coefficients a variable.

    Raises `OverDetermined`, `Contradiction` or `Undefined` (another random point may do),
    `Singular` if the equations do not determine the variables.
    """
    system, point = _begun(plant, equations, setting, random)
    equations = system.equations
    c, d = system.offsets.equations, system.offsets.variables
    try:
        point.nonlinear(equations, c)
    except Contradiction as failure:
        raise Contradiction(failure.row, equations[failure.row].node) from None
    given = set(system.given)
    length = [size + 1 for size in d]
    found = point.complete(
        [
            j * STRIDE + k
            for j, size in enumerate(length)
            for k in range(order + 1 if j in given else size)
        ]
    )
    for column in found:
        j, k = divmod(column, STRIDE)
        if j in given:  # a free function: what nothing asks for is zero
            length[j] = max(length[j], k + 1)
    values: list[Series] = [
        [found.get(j * STRIDE + k, 0) for k in range(size)] for j, size in enumerate(length)
    ]
    try:
        _continue(system, plant, setting, values, order)
    except Singular:
        return _all_at_once(plant, system, setting, random, order)
    return values


def _begun(
    plant: Assembly, equations: list[Equation], setting: Setting, random: Random
) -> tuple[_System, Point]:
    """The structure and a point that satisfies the linear equations, what rests made linear."""
    while True:
        failure: OverDetermined | None = None
        times = [_MARGIN] * len(equations)
        try:
            system = _structure(plant, equations)
            times = system.offsets.equations
        except OverDetermined as reason:
            failure = reason
        point = Point(plant.place, setting, random)
        point.linear(equations, times)
        found = equations
        if any(e.rest is not None for e in equations):
            found = settled(plant, equations, setting, point)
        if failure is not None and found is equations:
            found = _independent(plant, equations, setting, random)
            if len(found) == len(equations):
                raise failure
        if found is equations:
            return system, point
        equations = found


def _independent(
    plant: Assembly, equations: list[Equation], setting: Setting, random: Random
) -> list[Equation]:
    """The equations without linear ones that follow from those before them.

    The balance of a junction does, when a loop of bonds has fixed already what it says.
    """
    point = Point(plant.place, setting, random)
    out = []
    for number, equation in enumerate(equations):
        if equation.rest is None:
            if not point.reduce(coefficient_row(setting.numbers, equation.form, 0, STRIDE)):
                continue
            for order in range(_MARGIN + 1):
                point.add(coefficient_row(setting.numbers, equation.form, order, STRIDE), number)
        out.append(equation)
    return out


def _continue(
    system: _System, plant: Assembly, setting: Setting, values: list[Series], order: int
) -> None:
    """Extend the series of every variable that is not given to the order.

    Raises `Singular` also where nothing is to be extended: the point itself may then miss what
    only further derivatives of the equations say.
    """
    c, d = system.offsets.equations, system.offsets.variables
    given = set(system.given)
    inner = [j for j in range(plant.count_of) if j not in given]
    position = {j: at for at, j in enumerate(inner)}
    slack = min((d[j] for j in inner), default=0)
    if not inner:
        return
    sample = KnownSample(plant.place, setting, values)
    numbers = setting.numbers
    matrix: list[Row] = []
    for i, equation in enumerate(system.equations):
        row: Row = {}
        for key, weights in equation.form.items():
            variable, derivative = divmod(key, ORDERS)
            if key != CONSTANT and variable in position and derivative + c[i] == d[variable]:
                row[position[variable]] = weights[0]
        if equation.rest is not None:
            for (variable, derivative), x in gradient(equation.rest, sample, plant.place).items():
                if variable in position and derivative + c[i] == d[variable]:
                    at = position[variable]
                    row[at] = row.get(at, 0) + x
        matrix.append({at: x for at, x in row.items() if numbers.nonzero(x)})
    factors = Factors(numbers, matrix)
    factorial = [1]
    for k in range(1, order + max(d, default=0) + max(c, default=0) + 2):
        factorial.append(factorial[-1] * k)
    below = [numbers.inverse(x) for x in factorial]
    for stage in range(1, order - slack + 1):
        right = []
        for i, equation in enumerate(system.equations):
            at = stage + c[i]
            right.append(-_residue(equation, at, values, sample) * factorial[at])
        for j, x in zip(inner, factors.solve(right), strict=True):
            values[j].append(x * below[stage + d[j]])


def _residue(equation: Equation, order: int, values: list[Series], sample: KnownSample) -> Number:
    """A Taylor coefficient of an equation, coefficients not known yet taken as zero."""
    total: Number = 0
    for key, weights in equation.form.items():
        if key == CONSTANT:
            total += weights[order] if order < len(weights) else 0
            continue
        variable, derivative = divmod(key, ORDERS)
        known = values[variable]
        for m, weight in enumerate(weights if len(weights) == 1 else weights[: order + 1]):
            at = order - m + derivative
            if at < len(known):
                for k in range(order - m + 1, at + 1) if derivative else ():
                    weight *= k
                total += weight * known[at]
    if equation.rest is not None:
        rest: Series = evaluate([equation.rest], sample, order + 1)[0]
        total += rest[order] if order < len(rest) else 0
    return total


def _all_at_once(
    plant: Assembly, system: _System, setting: Setting, random: Random, order: int
) -> list[Series]:
    """All coefficients as one system, with some orders to spare.

    The orders to spare hold what follows from the equations by differentiation.
    """
    c = system.offsets.equations
    top = order + max(c, default=0) + _MARGIN
    point = Point(plant.place, setting, random)
    point.linear(system.equations, [top] * len(c))
    point.nonlinear(system.equations, [order + i + 1 for i in c])
    wanted = [[j * STRIDE + k for k in range(order + 1)] for j in range(plant.count_of)]
    found = point.complete([column for columns in wanted for column in columns])
    return [[found[column] for column in columns] for columns in wanted]
