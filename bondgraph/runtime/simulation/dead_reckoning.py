"""Where a machine is by dead reckoning: its `let`s from what is known of it, sample by sample."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.expr import KNOWN_SIGNALS, VARIABLES, ZERO_START, Expr, Kind, Op, topological
from bondgraph.passes.elimination.chaining import Chain
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation import courses
from bondgraph.runtime.simulation.code import Code
from bondgraph.runtime.simulation.parameters import Values
from bondgraph.runtime.simulation.scenario import Scenario

_COUNTER = 2.0**32  # an encoder's counter may run over


class Reckoning:
    """Computes `let`s (or sensors, or any named signal) of a model from its known signals.

    What is not measured follows from what is by forward elimination, as in a residual. A
    derivative is the difference over the last sample interval, an integral the sum of interval
    times integrand there (the midpoint rule), from its declared initial value, else from zero: a
    speed from an encoder is the difference of its counts, and the way gone is what was counted.
    With `counts` encoders come in whole counts, and the first count is where they are zero;
    otherwise in rad.

    `names` are those of the wanted that can be computed, `lacking` says of the others what is
    missing, `signals` are what `feed` reads. Raises KeyError for a `let` that is none, and with the
    name of a parameter without a value.

    >>> import bondgraph, numpy as np
    >>> from bondgraph.text.source import Source
    >>> c = bondgraph.Compilation(Source("cart.bg", '''bg 1
    ... model Cart {
    ...     input F : N
    ...     1:v { <- Se:F; -> I:m = 2 kg; -> Df:speed }
    ...     let x = int(v.f)
    ... }'''))
    >>> t = np.linspace(0, 2, 201)
    >>> x = Reckoning(c.equations, ["x"], Values(c.graph)).feed(t, {"speed": 3 * t})["x"]
    >>> f"{x[-1]:.2f} m"
    '6.00 m'
    """

    def __init__(
        self,
        system: EquationSystem,
        wanted: Iterable[str],
        values: Values,
        counts: bool = True,
    ) -> None:
        graph = system.graph
        lets = {x.name: x.value for x in graph.lets}
        roots = {name: lets[name] for name in wanted}
        closed = _closed(system)
        self.lacking: dict[str, str] = {}
        chosen: dict[str, Expr] = {}
        for name, value in roots.items():
            known = graph.pool.substitute([value], system.shared | closed)
            found = graph.pool.logged(known)[0]
            unknown = _unknown(found)
            if unknown is None:
                chosen[name] = found
            else:
                self.lacking[name] = unknown
        self.names = tuple(chosen)
        nodes = list(topological(chosen.values()))
        symbols = [n for n in nodes if n.kind in KNOWN_SIGNALS]
        self.signals = tuple(n.symbol.name for n in symbols)
        turns = {s.name: values.number(s.counts) for s in graph.sensors if s.counts is not None}
        self._unit = [2 * math.pi / turns[s] if counts and s in turns else 1.0
                      for s in self.signals]  # fmt: skip
        self._counted = [counts and s in turns for s in self.signals]
        self._start: list[float] = []
        self._tracked: list[tuple[bool, int, Callable[..., list[float]]]] = []
        leaves: dict[Expr, str] = {n: f"w[{k}]" for k, n in enumerate(symbols)}
        self._derived = 0
        for node in nodes:
            if node.op is Op.DER:
                self._tracked.append(
                    (True, self._derived, _compiled(graph.pool, leaves, values, [node.args[0]]))
                )
                leaves[node] = f"d[{self._derived}]"
                self._derived += 1
            elif node.op is Op.INT:
                place = len(self._start)
                self._tracked.append(
                    (False, place, _compiled(graph.pool, leaves, values, [node.args[0]]))
                )
                leaves[node] = f"s[{place}]"
                self._start.append(_initial(node, values))
        self._values = _compiled(graph.pool, leaves, values, list(chosen.values()))
        self.restart()

    def restart(self) -> None:
        """Begin anew at the origin with the next sample."""
        self._time: float | None = None
        self._zero = [math.nan] * len(self.signals)
        self._raw = [math.nan] * len(self.signals)
        self._w = [0.0] * len(self.signals)
        self._a = [0.0] * self._derived  # what is differentiated, at the last sample
        self._d = [0.0] * self._derived
        self._s = list(self._start)

    def feed(self, time: Array, signals: Mapping[str, Array]) -> dict[str, Array]:
        """Each of `names` at further samples, (n,) in SI units; times (n,) in s, ascending.

        A sample in which a needed signal is NaN, or whose time does not go on, gives what the one
        before gave (NaN where there is none). Raises KeyError for a signal that is not there.
        """
        table = np.empty((len(time), len(self.names)))
        columns = [signals[name].tolist() for name in self.signals]
        rows: Iterable[tuple[float, ...]] = zip(*columns, strict=True)
        if not columns:
            rows = [()] * len(time)
        for k, (t, row) in enumerate(zip(time.tolist(), rows, strict=True)):
            table[k] = self._sample(t, row)
        return {name: table[:, k] for k, name in enumerate(self.names)}

    def _sample(self, t: float, row: Sequence[float]) -> Sequence[float]:
        before = self._time
        whole = all(map(math.isfinite, row))
        if whole and (before is None or t > before):
            self._advance(t, self._read(row))
        elif self._time is None:
            return [math.nan] * len(self.names)
        try:
            return self._values(self._w, self._d, self._s)
        except (ArithmeticError, ValueError):
            return [math.nan] * len(self.names)

    def _read(self, row: Sequence[float]) -> list[float]:
        """Signals in SI units; encoders from their first count on, over the ends of a counter."""
        found = []
        for k, value in enumerate(row):
            if self._counted[k]:
                if math.isnan(self._zero[k]):
                    self._zero[k] = value
                else:
                    turns = round((value - self._raw[k]) / _COUNTER)
                    self._zero[k] += turns * _COUNTER
                self._raw[k] = value
                value -= self._zero[k]
            found.append(value * self._unit[k])
        return found

    def _advance(self, t: float, w: list[float]) -> None:
        """One interval: derivatives and integrals in the order in which they rest on each other."""
        first = self._time is None
        step = 0.0 if first else t - (self._time or 0.0)
        middle = w if first else [(a + b) / 2 for a, b in zip(self._w, w, strict=True)]
        ahead = list(self._s)
        half = list(self._s)
        for is_rate, k, look in self._tracked:
            try:
                value = (look(w, self._d, ahead) if is_rate else look(middle, self._d, half))[0]
            except (ArithmeticError, ValueError):
                continue  # the law has no value here: as before
            if is_rate:
                self._d[k] = 0.0 if first else (value - self._a[k]) / step
                self._a[k] = value
            else:
                ahead[k] += step * value
                half[k] = (self._s[k] + ahead[k]) / 2
        self._time, self._w, self._s = t, w, ahead


class Desired:
    """What sensors should show, by the controllers' setpoints and the `[desired]` of a scenario.

    Angles and places that a speed loop is to follow are the integral of its setpoint, from zero.
    """

    def __init__(self, system: EquationSystem, scenario: Scenario, values: Values) -> None:
        pool = system.graph.pool
        self._direct: dict[str, Callable[[float], float]] = {}
        self._speeds: dict[str, Callable[[float], float]] = {}
        for controller in scenario.controllers:
            kept = self._speeds if controller.speed else self._direct
            kept[controller.measures] = courses.function(controller.setpoint, pool, values)
        for name, course in scenario.desired.items():
            self._direct[name] = courses.function(course, pool, values)
            self._speeds.pop(name, None)
        self.names = (*self._direct, *self._speeds)
        self.restart()

    def restart(self) -> None:
        """Begin anew; the time of the next sample is the start of all integrals."""
        self._time: float | None = None
        self._sum = dict.fromkeys(self._speeds, 0.0)

    def at(self, time: Array) -> dict[str, Array]:
        """The value of each sensor at further samples, (n,), encoders in rad; times in s."""
        found = {n: np.array([f(t) for t in time.tolist()]) for n, f in self._direct.items()}
        if not len(time):
            return found | {n: np.empty(0) for n in self._speeds}
        begin = float(time[0]) if self._time is None else self._time
        grid = np.concatenate([[begin], time])
        middle = (grid[1:] + grid[:-1]) / 2
        for name, speed in self._speeds.items():
            grown = np.array([speed(t) for t in middle.tolist()]) * np.diff(grid)
            found[name] = self._sum[name] + np.cumsum(grown)
            self._sum[name] = float(found[name][-1])
        self._time = float(time[-1])
        return found


# ------------------------------------------------------------------------------ helpers


def _closed(system: EquationSystem) -> dict[Expr, Expr]:
    """Every variable that forward elimination reaches, in known signals."""
    chain = Chain(system)
    chain.start()
    chain.run()
    return chain.closed


def _unknown(expr: Expr) -> str | None:
    """The first variable of an expression that nobody knows."""
    for node in topological([expr]):
        if node.op is Op.ROOT:
            return "a root"
        if node.kind in VARIABLES:
            return node.symbol.name
    return None


def _initial(node: Expr, values: Values) -> float:
    """Where an integral starts: as declared, else at zero."""
    symbol = node.symbol
    if symbol.name == ZERO_START or symbol.kind is Kind.FREE:
        return 0.0
    return values.number(values.graph.pool.symbol(symbol.name, symbol.kind))


def _compiled(
    pool: Any, leaves: Mapping[Expr, str], values: Values, wanted: list[Expr]
) -> Callable[..., list[float]]:
    code = Code(pool, leaves, values.constant)
    result = f"[{', '.join(code.text(wanted))}]"
    return code.function("reckoned", "w, d, s", result)
