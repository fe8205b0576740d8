"""The virtual machine that gets the commands of the monitored one and shows what it should do."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Mapping
from functools import partial

import numpy as np

from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.graph import BondGraph
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation import courses
from bondgraph.runtime.simulation.faults import Wrong, edges
from bondgraph.runtime.simulation.given import Acting, nothing
from bondgraph.runtime.simulation.instruments import Readings
from bondgraph.runtime.simulation.parameters import Values, drawn
from bondgraph.runtime.simulation.scenario import Course, Fault, Scenario
from bondgraph.runtime.simulation.stepping import Stepper

_WINDOW = 2048  # samples for which noise is drawn together
_LONGEST = 5.0  # s without samples that it goes on through; after more it waits where it is
_JUMP = 0.02  # of the largest value so far: a bend from which on it is a jump


class Twin:
    """One virtual machine in step with the samples of another.

    It has the nominal parameters, instruments with noise of their own (another seed than the
    scenario's), and only those faults that are injected. Nothing of what it does depends on what
    the monitored machine reads, only on what that one is told.
    """

    def __init__(self, system: EquationSystem, integral: CausalGraph, scenario: Scenario) -> None:
        own = scenario._replace(spread="none", seed=scenario.seed + 1_000_003, faults=())
        self._scenario = own
        self._graph = system.graph
        self.fed = Fed(system.graph, own, drawn(system.graph, own))
        self.stepper = Stepper(system, integral, own, self.fed)
        self.restart()

    def restart(self) -> None:
        """Begin anew, with all well."""
        self.stepper.restart()
        self.fed.clear()
        self.fed.restart()
        self._readings = Readings(self._graph, self._scenario, self.fed.values, _WINDOW)
        self._at = self._readings.size  # of the window
        self._started = False

    @property
    def time(self) -> float:
        """Where it stands, in s."""
        return self.stepper.time

    @property
    def sensors(self) -> frozenset[str]:
        """The names of its sensors."""
        return self._readings.names

    def inject(self, fault: Fault) -> None:
        """Something goes wrong with it from now on; `at` and `until` count from now, in s."""
        now = self.time
        self.fed.inject(fault._replace(at=now + fault.at, until=now + fault.until))

    def clear(self) -> None:
        """All is well again; storages keep what they hold."""
        self.fed.clear()

    def advance(
        self, time: Array, told: Mapping[str, Array]
    ) -> tuple[list[dict[str, float]], dict[str, Array]]:
        """Go on to further samples of the monitored one: what is true there, and what is read.

        Times in s, (n,), ascending; `told` by name, (n,). Raises what `Stepper.advance` raises.
        """
        start = float(time[0])
        if not self._started or not 0.0 < start - self.time <= _LONGEST:
            self.stepper.jump(start)
            self.fed.restart()
            self._started = True
        rows: list[dict[str, float]] = []
        read: dict[str, list[Array]] = {}
        for b in self.fed.feed(time, told):
            done = len(rows)
            last = max(done, int(np.searchsorted(time, b, side="right")))
            self.fed.hold(self.time, partial(self.stepper.look, b))
            if b > self.time:
                rows += self.stepper.advance(b, time[done:last])
            elif last > done:  # the very first sample: nothing has moved yet
                rows += [self.stepper.look(b)] * (last - done)
            self._read(time[done:last], rows[done:last], read)
        return rows, {n: np.concatenate(parts) for n, parts in read.items()}

    def _read(
        self, time: Array, rows: list[dict[str, float]], read: dict[str, list[Array]]
    ) -> None:
        """What the instruments make of some samples, window after window."""
        start = 0
        while start < len(time):
            if self._at == self._readings.size:
                self._readings.renew()
                self._at = 0
            stop = min(len(time), start + self._readings.size - self._at)
            found = self._readings.all(self._at, time[start:stop], rows[start:stop], self.fed.wrong)
            for name, column in found.items():
                read.setdefault(name, []).append(column)
            self._at += stop - start
            start = stop




class Fed(Acting):
    """Commands as straight lines between samples; what is not in the samples is as in the scenario.

    Switches keep the position of the sample before. `inject` makes something wrong.
    """

    def __init__(self, graph: BondGraph, scenario: Scenario, values: Values) -> None:
        super().__init__(graph, values)
        self.faults: list[Fault] = []
        self.names = tuple(i.name for i in graph.inputs)
        zero = Course.constant(0.0)
        written = {**scenario.inputs, **scenario.modes}
        self._course = {
            n: courses.function(written.get(n, zero), graph.pool, values) for n in self.names
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
        own = [f for f in self.faults if f.target == fault.target]
        self.wrong[fault.target] = Wrong(own)

    def clear(self) -> None:
        """All is well again."""
        for fault in self.faults:
            self.wrong[fault.target] = Wrong(())
        self.faults = []

    # ---------------------------------------------------------------------- acting

    def told(self, name: str, t: float) -> float:
        """See `Acting`."""
        return self._line(name)(t)

    def command(self, name: str, order: int) -> Callable[[float], float] | None:
        """See `Acting`."""
        if name not in self._course:
            return None
        return (self._line(name), self._slope(name))[order] if order < 2 else nothing

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
