"""What acts on a virtual machine that gets the commands of another one, from its samples."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np

from bondgraph.ir.graph import BondGraph
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation import courses
from bondgraph.runtime.simulation.faults import Wrong, edges
from bondgraph.runtime.simulation.machine import Machine
from bondgraph.runtime.simulation.parameters import Values
from bondgraph.runtime.simulation.scenario import Course, Fault, Scenario

_JUMP = 0.02  # of the largest value so far: a bend from which on it is a jump


class Fed:
    """Commands as straight lines between samples; what is not in the samples is as in the scenario.

    Switches keep the position of the sample before. `inject` makes something wrong.
    """

    def __init__(self, graph: BondGraph, scenario: Scenario, values: Values) -> None:
        self.graph = graph
        self.wrong: dict[str, Wrong] = {}
        self.faults: list[Fault] = []
        self.modes = tuple(i.name for i in graph.inputs if i.mode)
        self.names = tuple(i.name for i in graph.inputs)
        zero = Course.constant(0.0)
        written = {**scenario.inputs, **scenario.modes}
        self._courses = {n: written.get(n, zero) for n in self.names}
        self._values = values
        self._course = {
            n: courses.function(c, graph.pool, values) for n, c in self._courses.items()
        }
        self.restart()

    def restart(self) -> None:
        """The samples begin anew."""
        self._times: list[float] = []
        self._rows: dict[str, list[float]] = {n: [] for n in self.names}
        self._largest = dict.fromkeys(self.names, 0.0)

    # --------------------------------------------------------------------- samples

    def feed(self, time: Array, columns: Mapping[str, Array]) -> list[float]:
        """Take further samples; the moments at which something jumps or bends, and the last one.

        `columns` by name, NaN: as before.
        """
        first = not self._times
        begin = float(time[0]) if first else self._times[-1]
        own = {n: self._column(n, time, columns.get(n)) for n in self.names}
        before = {n: own[n][0] if first else self._rows[n][-1] for n in self.names}
        self._times = [begin, *time.tolist()]
        self._rows = {n: [before[n], *own[n]] for n in self.names}
        end = self._times[-1]
        found = {t for t in edges(self.faults, end) if begin < t < end} | {end}
        for name in self.names:
            found |= self._jumps(name)
        return sorted(found)

    def _column(self, name: str, time: Array, given: Array | None) -> list[float]:
        if given is None or np.isnan(given).all():
            if self._rows[name] and given is not None and self._seen(name):
                return [self._rows[name][-1]] * len(time)
            return [self._course[name](t) for t in time.tolist()]
        last = self._rows[name][-1] if self._rows[name] else 0.0
        out = []
        for value in given.tolist():
            last = last if math.isnan(value) else value
            out.append(last)
        self._largest[name] = max(self._largest[name], *(abs(v) for v in out))
        return out

    def _seen(self, name: str) -> bool:
        return self._largest[name] > 0.0

    def _jumps(self, name: str) -> set[float]:
        """Where a command bends so much that an integrator has to begin anew."""
        row, times = self._rows[name], self._times
        if name in self.modes:
            return {times[k] for k in range(1, len(row)) if (row[k] != 0) != (row[k - 1] != 0)}
        limit = _JUMP * self._largest[name]
        if not limit:
            return set()
        bends = np.abs(np.diff(row, n=2)) > limit
        return {times[int(k) + 1] for k in np.flatnonzero(bends)}

    # ---------------------------------------------------------------------- faults

    def inject(self, fault: Fault) -> None:
        """Something more goes wrong."""
        self.faults.append(fault)
        self._sort()

    def clear(self) -> None:
        """All is well again."""
        for fault in self.faults:
            self.wrong[fault.target] = Wrong(())
        self.faults = []

    def _sort(self) -> None:
        targets: Iterable[str] = dict.fromkeys([*self.wrong, *(f.target for f in self.faults)])
        for target in targets:
            own = [f for f in self.faults if f.target == target]
            if tuple(own) != getattr(self.wrong.get(target), "faults", None):
                self.wrong[target] = Wrong(own)

    def sticking(self) -> list[str]:
        """The targets that are to keep a value."""
        return [n for n, w in self.wrong.items() if any(f.op == "stuck" for f in w.faults)]

    # ---------------------------------------------------------------------- acting

    def told(self, name: str, t: float) -> float:
        """A command at time t, in s."""
        return self._line(name)(t)

    def setting(self, t: float) -> tuple[bool, ...]:
        """The position of the switches: that of the sample before."""
        return tuple(self._held(name, t) != 0 for name in self.modes)

    def inputs(self, machine: Machine) -> Callable[[float], Sequence[float]]:
        """What `machine.signals` are, as a function of time."""
        made = [self._signal(*signal) for signal in machine.signals]
        return lambda t: [f(t) for f in made]

    def before(self, machine: Machine) -> list[float]:
        """What they were before the start: nothing told, nothing wrong."""
        return [float(s.name.startswith("gain of ") and s.order == 0) for s in machine.signals]

    def _signal(self, name: str, order: int) -> Callable[[float], float]:
        if name in self._course:
            if order == 0:
                return self._line(name)
            return self._slope(name) if order == 1 else _nothing
        what, _, target = name.partition(" of ")
        if what not in ("gain", "bias") or order > 1:
            return _nothing
        which = ("gain", "bias").index(what)
        if order:
            return lambda t: self.wrong[target].slope(t)[which]
        return lambda t: self.wrong[target].at(t)[which]

    def _held(self, name: str, t: float) -> float:
        if not self._times:
            return self._course[name](t)
        return self._rows[name][max(bisect_right(self._times, t) - 1, 0)]

    def _line(self, name: str) -> Callable[[float], float]:
        if name in self.modes:
            return lambda t: self._held(name, t)

        def line(t: float) -> float:
            times = self._times
            if not times:
                return self._course[name](t)
            row = self._rows[name]
            k = bisect_right(times, t)
            if k == 0 or k == len(times):
                return row[min(k, len(row) - 1)]
            step = times[k] - times[k - 1]
            return row[k - 1] + (row[k] - row[k - 1]) * (t - times[k - 1]) / step

        return line

    def _slope(self, name: str) -> Callable[[float], float]:
        def slope(t: float) -> float:
            times, row = self._times, self._rows[name]
            k = bisect_right(times, t)
            if k == 0 or k >= len(times) or times[k] == times[k - 1]:
                return 0.0
            return (row[k] - row[k - 1]) / (times[k] - times[k - 1])

        return slope


def _nothing(_: float) -> float:
    return 0.0
