"""Where the three robots are, or what their sensors show: desired, virtual and real."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from bondgraph.ir.equation_system import EquationSystem
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation import courses
from bondgraph.runtime.simulation.dead_reckoning import Desired, Reckoning
from bondgraph.runtime.simulation.parameters import Values
from bondgraph.runtime.simulation.scenario import Scenario

Pose = list[float | None]


class Places:
    """Poses [x, y, heading] (m, m, rad) in the plane of a scenario, where it has one.

    The real one by dead reckoning from its samples, the desired one from the setpoints, the
    virtual one as it is. `lacking` says why one of them is not known.
    """

    def __init__(self, system: EquationSystem, scenario: Scenario, values: Values) -> None:
        plane = scenario.plane
        self.names = () if plane is None else tuple(n for n in plane if n is not None)
        self.lacking: dict[str, str] = {}
        self._real = Reckoning(system, self.names, values)
        self._goal = Reckoning(system, self.names, values, counts=False)
        self._desired = Desired(system, scenario, values)
        pool, told = system.graph.pool, {**scenario.inputs, **scenario.modes}
        self._told = {n: courses.function(c, pool, values) for n, c in told.items()}
        if self._real.lacking:
            what = next(iter(self._real.lacking.values()))
            self.lacking["real"] = f"no sensor tells {what}"
        known = {*self._desired.names, *self._told}
        unknown = [n for n in self._goal.signals if n not in known]
        if self._real.lacking or unknown:
            what = unknown[0] if unknown else "where to go"
            self.lacking["desired"] = f"the scenario does not say what {what} should be"

    @property
    def wanted(self) -> tuple[str, ...]:
        """The sensors of which the scenario says what they should show."""
        return self._desired.names

    def restart(self) -> None:
        """Everyone at the origin."""
        self._real.restart()
        self._goal.restart()
        self._desired.restart()

    def real(self, time: Array, signals: Mapping[str, Array]) -> Pose:
        """Where the real one is after further samples."""
        if not self.names or "real" in self.lacking:
            return []
        lost = [n for n in self._real.signals if n not in signals]
        nothing = np.full(len(time), math.nan)
        found = self._real.feed(time, {**dict.fromkeys(lost, nothing), **signals})
        return self._pose(found)

    def desired(self, time: Array) -> tuple[Pose, dict[str, float]]:
        """Where it should be, and what the sensors should show that the scenario speaks of."""
        given = self._desired.at(time)
        show = {n: float(c[-1]) for n, c in given.items()}
        if not self.names or "desired" in self.lacking:
            return [], show
        for name in self._goal.signals:
            if name not in given:
                told = self._told[name]
                given[name] = np.array([told(t) for t in time.tolist()])
        return self._pose(self._goal.feed(time, given)), show

    def virtual(self, rows: Sequence[Mapping[str, float]]) -> Pose:
        """Where the virtual one is."""
        if not self.names or not rows:
            return []
        return [_finite(rows[-1].get(name, math.nan)) for name in self.names]

    def _pose(self, found: Mapping[str, Array]) -> Pose:
        return [_finite(float(found[n][-1])) for n in self.names]


def _finite(value: float) -> float | None:
    return float(f"{value:.6g}") if math.isfinite(value) else None
