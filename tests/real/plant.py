"""A plant as equations, and its trajectories: all signals as power series at a random point.

Newton's method works on all coefficients of all unknowns at once, so that nothing has to be known
of the index of the equations (constraints between states show in their derivatives, which are
coefficients too). Unknowns that an equation gives explicitly are computed; the others are torn.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cache
from math import perm
from random import Random
from typing import Any, NamedTuple

import numpy as np
import scipy.linalg
from flint import arb, arb_series, ctx

from tests.real.nodes import Node, der, names, ordered, sym
from tests.real.series import Program, constant, exact, tangents

_EXACT = 1e-55  # a defect that is none, at 90 digits
_FLOAT = 1e-7  # where Newton's method ends and its last slopes are kept
_STEPS = 30
_RANK = 1e-11  # of the largest pivot: below this a row says nothing new
_LARGEST = 1e8  # a coefficient beyond this is no trajectory that anything can be told from
_ROOM = 4  # coefficients beyond those asked for, which constraints between states take


class Equation(NamedTuple):
    """`zero` vanishes; `solved` has what it gives explicitly for some of its variables."""

    zero: Node
    solved: Mapping[str, Node]


class Plant(NamedTuple):
    """The physics of one model.

    `declared` are numbers by name, of which `params` may be faulty. `sensors` and `sources` (those
    whose law holds readings) are variables; what is wrong with a name N is a known signal `N~`.
    `starts`: declared initial values of variables.
    """

    equations: tuple[Equation, ...]
    declared: Mapping[str, Fraction]
    params: tuple[str, ...]
    inputs: tuple[str, ...]
    unknown: tuple[str, ...]
    sensors: tuple[str, ...]
    sources: tuple[str, ...]
    states: tuple[str, ...]
    starts: Mapping[str, Fraction]

    def laws(self) -> list[Node]:
        """All that vanishes."""
        return [equation.zero for equation in self.equations]

    @property
    def faults(self) -> tuple[str, ...]:
        return (*self.params, *self.inputs, *self.sensors, *self.sources)


def wrong(name: str) -> str:
    """The signal that is what is wrong with a sensor, an input or a source."""
    return name + "~"


class Order(NamedTuple):
    """`given` are explicit in this order, `torn` are found by iteration on the zeros `left`."""

    given: Mapping[str, Node]
    torn: tuple[str, ...]
    left: tuple[Node, ...]


def order(plant: Plant) -> Order:
    """Which variables equations give, and which have to be torn: states first, then the busiest."""
    zero = {x for x, v in plant.declared.items() if v == 0}
    open_: list[tuple[Equation, set[str]]] = []
    every: dict[str, int] = {}
    outside = {*plant.declared, *plant.inputs, *plant.unknown}
    outside |= {wrong(x) for x in plant.faults}
    for equation in plant.equations:
        own = names(equation.zero) - outside
        open_.append((equation, own))
        for x in sorted(own):
            every[x] = every.get(x, 0) + 1
    given: dict[str, Node] = {}
    torn: list[str] = []
    left: list[Node] = []
    known: set[str] = set()

    def settle(name: str) -> None:
        known.add(name)
        for _, own in open_:
            own.discard(name)

    while open_:
        ready = next((k for k, (_, own) in enumerate(open_) if not own), None)
        if ready is not None:
            left.append(open_.pop(ready)[0].zero)
            continue
        found = None
        for k, (equation, own) in enumerate(open_):
            if len(own) == 1:
                x = next(iter(own))
                how = equation.solved.get(x)
                if how is not None and not _divides(how, zero):
                    found = k, x, how
                    break
        if found is not None:
            k, x, how = found
            open_.pop(k)
            given[x] = how
            settle(x)
            continue
        rest = sorted({x for _, own in open_ for x in own})
        x = max(rest, key=lambda name: (name in plant.states, every[name]))
        torn.append(x)
        settle(x)
    return Order(given, tuple(torn), tuple(left))


def _divides(root: Node, zero: set[str]) -> bool:
    """Whether an expression divides by something that is declared as zero."""
    below = [n.args[1] for n in ordered([root]) if n.op == "div"]
    return any(n.op == "sym" and n.data in zero for n in below)


def _needed(given: Mapping[str, Node], zeros: list[Node]) -> dict[str, Node]:
    """Those given variables that the zeros hold, or that these are given by."""
    found = names(*zeros)
    for x in reversed(given):
        if x in found:
            found |= names(given[x])
    return {x: how for x, how in given.items() if x in found}


class Point(NamedTuple):
    """A trajectory near a point: the torn unknowns, and the value of every name."""

    torn: tuple[Any, ...]
    signals: Mapping[str, Any]
    known: Mapping[str, Any]


class NoPoint(Exception):
    """No trajectory was found from a start."""


class Simulator:
    """Finds trajectories of a plant with `length` coefficients that can be trusted."""

    def __init__(self, plant: Plant, length: int) -> None:
        self.plant = plant
        self.length = length + _ROOM
        self.order = order(plant)
        given = self.order.given
        starts = [sym(x) - v for x, v in plant.starts.items()]
        self.starts = len(starts)
        zeros = [*self.order.left, *starts]
        self.program = Program(zeros, _needed(given, zeros))
        self.rest = Program([], given)
        self.unknown = {x: k for k, x in enumerate(self.order.torn)}

    def known(
        self,
        declared: Mapping[str, Fraction],
        random: Random,
        sign: int = 0,
        scale: float = 1,
        near: Sequence[float] = (),
    ) -> dict[str, Any]:
        """Random inputs, declared numbers, and nothing wrong; some inputs `near` given values."""
        plant = self.plant
        out = {x: constant(exact(v)) for x, v in declared.items()}
        for x in (*plant.inputs, *plant.unknown):
            lead = scale * _lead(random, sign)
            if near and random.random() < 0.4:
                lead = random.choice(near) + random.choice((-1, 1)) * 10 ** random.uniform(-2, 0.5)
            out[x] = course(random, lead, self.length)
        zero = constant(0)
        out.update((wrong(x), zero) for x in (*plant.inputs, *plant.sensors, *plant.sources))
        return out

    def start(self, random: Random, scale: float = 1) -> list[Any]:
        """Random torn unknowns, often all positive."""
        positive = random.random() < 0.6
        size = scale * 10 ** random.uniform(-0.7, 0.7)
        # now and then faster, so that rates take what they feed to other branches
        rate = 10 ** random.uniform(0, 1.3) if random.random() < 0.4 else 1.0
        out = []
        for _ in self.order.torn:
            lead = size * random.uniform(0.2, 2)
            if not positive and random.random() < 0.5:
                lead = -lead
            out.append(course(random, lead, self.length, rate))
        return out

    def solve(self, known: Mapping[str, Any], start: list[Any]) -> Point:
        """The trajectory with these known signals next to a start."""
        found = _Newton(self, known).run(list(start))
        signals = {**known, **dict(zip(self.order.torn, found, strict=True))}
        values = self.rest.values(signals)
        signals.update((x, values[k]) for x, k in self.rest.bound.items())
        return Point(tuple(found), signals, known)


def _lead(random: Random, sign: int) -> float:
    return (sign or random.choice((-1, 1))) * 10.0 ** random.uniform(-0.5, 0.7)


def course(random: Random, lead: float, length: int, rate: float = 1) -> Any:
    """A smooth signal: a random series that begins with `lead`."""
    size = rate * max(abs(lead), 0.1)
    tail = [random.uniform(-1, 1) * 0.6**k * size for k in range(1, length)]
    return arb_series([arb(lead), *[arb(x) for x in tail]], ctx.cap)


class _Newton:
    """One search: damped steps in floating point, then corrections with kept slopes."""

    def __init__(self, simulator: Simulator, known: Mapping[str, Any]) -> None:
        self.simulator = simulator
        self.known = known
        self.torn = simulator.order.torn
        self.length = simulator.length
        self.values: list[Any] = []

    def run(self, x: list[Any]) -> list[Any]:
        defects = self.defects(x)
        if _largest(defects) < _EXACT:
            return x
        for _ in range(_STEPS):
            if _largest(defects) < _FLOAT:
                return self.refined(x, defects)
            step = _Factors(self.slopes()).solved(_floats(defects))
            x, defects = self.stepped(x, defects, step)
        raise NoPoint

    def stepped(self, x: list[Any], defects: list[Any], step: Any) -> tuple[list[Any], list[Any]]:
        before = self.weighed(defects)
        for turn in range(7):
            tried = self.moved(x, step, 0.5**turn)
            try:
                found = self.defects(tried)
            except NoPoint:
                continue
            if self.weighed(found) < before * (1 - 0.2 * 0.5**turn) or _largest(found) < _FLOAT:
                return tried, found
        raise NoPoint

    def refined(self, x: list[Any], defects: list[Any]) -> list[Any]:
        """The same to 55 digits; what the equations do not decide stays as it is."""
        slopes = _Factors(self.slopes())
        last, count = _largest(defects), len(defects)
        for _ in range(30):
            if last < _EXACT:
                return x
            scaled = np.array([float(c / arb(last)) for c in defects])
            x = self.moved(x, slopes.solved(scaled), last)
            defects = self.defects(x)
            size = _largest(defects)
            if size > last / 4 or len(defects) != count:  # on another branch: another matrix
                raise NoPoint
            last = size
        raise NoPoint

    def moved(self, x: list[Any], step: Any, factor: float) -> list[Any]:
        n = self.length
        scale = arb(factor)
        out = []
        for j, s in enumerate(x):
            move = [arb(float(c)) * scale for c in step[j * n : (j + 1) * n]]
            out.append(arb_series([(s[k] - move[k]).mid() for k in range(n)], ctx.cap))
        return out

    def defects(self, x: list[Any]) -> list[Any]:
        """All coefficients of what should vanish."""
        program = self.simulator.program
        self.values = program.values({**self.known, **dict(zip(self.torn, x, strict=True))})
        out: list[Any] = []
        first = len(program.roots) - self.simulator.starts
        for k, root in enumerate(program.roots):
            s = self.values[root]
            out += [s[i].mid() for i in range(min(s.prec, self.length) if k < first else 1)]
            if not all(c.is_finite() for c in s.coeffs()):
                raise NoPoint
        if any(abs(c) > _LARGEST for s in x for c in s.coeffs()):
            raise NoPoint
        return out

    def weighed(self, defects: list[Any]) -> float:
        """The size of defects, in which high orders count less."""
        total, at = 0.0, 0
        program = self.simulator.program
        first = len(program.roots) - self.simulator.starts
        for k, root in enumerate(program.roots):
            n = min(self.values[root].prec, self.length) if k < first else 1
            total += sum(float(abs(c)) * 0.2**i for i, c in enumerate(defects[at : at + n]))
            at += n
        return total

    def slopes(self) -> Any:
        """The matrix of derivatives of all coefficients by all coefficients."""
        program, n = self.simulator.program, self.length
        all_tangents = tangents(program, self.values, self.simulator.unknown)
        first = len(program.roots) - self.simulator.starts
        rows = [
            min(self.values[r].prec, n) if k < first else 1 for k, r in enumerate(program.roots)
        ]
        out = np.zeros((sum(rows), n * len(self.torn)))
        at = 0
        for root, height in zip(program.roots, rows, strict=True):
            for (j, k), factor in all_tangents[root].items():
                own = np.zeros(2 * n + 1)  # behind the coefficients the zeros above the diagonal
                own[:n] = [float(factor[i].mid()) for i in range(n)]
                where, falling = _shifted(n, k)
                with np.errstate(all="ignore"):  # what overflows is no point, see below
                    part = (own[where] * falling)[:height]
                    out[at : at + height, j * n : (j + 1) * n] += part
            at += height
        if not np.all(np.isfinite(out)):
            raise NoPoint
        return out


@cache
def _shifted(n: int, order: int) -> tuple[Any, Any]:
    """Where the coefficients of a factor stand in its product with a derivative, and times what.

    Coefficient r of a(t) d^k/dt^k x is the sum over c of a[r - c + k] c!/(c - k)! x[c].
    """
    places = np.arange(n)[:, None] - np.arange(n)[None, :] + order
    places = np.where((places < 0) | (places >= n), 2 * n, places)
    return places, np.array([float(perm(c, order)) for c in range(n)])[None, :]


class _Factors:
    """A matrix of any rank as Q R P; what its rows do not decide does not move."""

    def __init__(self, matrix: Any) -> None:
        self.q, self.r, self.pivots = scipy.linalg.qr(
            matrix, mode="economic", pivoting=True, check_finite=False
        )
        sizes = np.abs(np.diag(self.r))
        self.rank = int(np.sum(sizes > _RANK * max(sizes[:1], default=0.0)))
        self.columns = matrix.shape[1]

    def solved(self, right: Any) -> Any:
        k = self.rank
        out = np.zeros(self.columns)
        out[self.pivots[:k]] = scipy.linalg.solve_triangular(
            self.r[:k, :k], self.q[:, :k].T @ right, check_finite=False
        )
        return out


def _largest(defects: list[Any]) -> float:
    return max((float(abs(c)) for c in defects), default=0.0)


def _floats(defects: list[Any]) -> Any:
    return np.array([float(c) for c in defects])


def state_equation(state: str, flow: str) -> Equation:
    """flow = d/dt state."""
    rate = der(sym(state))
    return Equation(sym(flow) - rate, {flow: rate})
