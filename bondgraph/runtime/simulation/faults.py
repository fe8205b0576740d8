"""How faults come and go: each target's acting value is gain times told value plus bias."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence

from bondgraph.runtime.simulation.scenario import Fault

_EDGES = 10_000  # of an intermittent fault


class Wrong:
    """All faults of one target, in the order given.

    >>> from bondgraph.runtime.simulation.scenario import Fault
    >>> low = Fault("U", "*=", 0.5, 1.0, math.inf, 2.0, 0.0, 1.0, "weak battery")
    >>> Wrong([low]).at(2.0)
    (0.75, 0.0)
    """

    def __init__(self, faults: Sequence[Fault]) -> None:
        self.faults = tuple(faults)
        self._held: dict[int, float] = {}

    def hold(self, t: float, value: Callable[[], float]) -> None:
        """At the onset of a fault that sticks: remember the value of the moment."""
        for k, fault in enumerate(self.faults):
            if fault.op == "stuck" and k not in self._held and t >= fault.at:
                self._held[k] = value()

    def at(self, t: float) -> tuple[float, float]:
        """Gain and bias at time t, in s."""
        gain, bias = 1.0, 0.0
        for k, fault in enumerate(self.faults):
            share = strength(fault, t)
            g, b = self._own(k, fault, share)
            gain, bias = g * gain, g * bias + b
        return gain, bias

    def slope(self, t: float) -> tuple[float, float]:
        """How gain and bias change, per s; only ramps do."""
        step = 1e-6
        before, after = self.at(t - step), self.at(t + step)
        if not any(f.ramp and f.at <= t <= f.at + f.ramp for f in self.faults):
            return 0.0, 0.0
        return (after[0] - before[0]) / (2 * step), (after[1] - before[1]) / (2 * step)

    def missing(self, t: float) -> bool:
        """Whether no sample arrives."""
        return any(f.op == "missing" and strength(f, t) > 0 for f in self.faults)

    def _own(self, k: int, fault: Fault, share: float) -> tuple[float, float]:
        match fault.op:
            case "+=":
                return 1.0, share * fault.value
            case "*=":
                return 1.0 + share * (fault.value - 1.0), 0.0
            case "=":
                return 1.0 - share, share * fault.value
            case "stuck":
                return (0.0, self._held.get(k, 0.0)) if share > 0 else (1.0, 0.0)
            case "missing":
                return 1.0, 0.0


def strength(fault: Fault, t: float) -> float:
    """How much of a fault is there at time t: 0 to 1."""
    if not fault.at <= t < fault.until:
        return 0.0
    since = t - fault.at
    if fault.period and math.fmod(since, fault.period) >= fault.duty * fault.period:
        return 0.0
    return min(1.0, since / fault.ramp) if fault.ramp else 1.0


def edges(faults: Iterable[Fault], end: float) -> list[float]:
    """The moments at which a fault jumps or bends, before `end`."""
    found: set[float] = set()
    for fault in faults:
        found |= {fault.at, fault.until}
        if fault.ramp:
            found.add(fault.at + fault.ramp)
        if fault.period:
            stop = min(fault.until, end)
            count = min(_EDGES, int((stop - fault.at) / fault.period) + 1)
            for k in range(max(count, 0)):
                found |= {fault.at + k * fault.period, fault.at + (k + fault.duty) * fault.period}
    return sorted(t for t in found if 0 < t < end)
