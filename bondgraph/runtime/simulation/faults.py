"""How faults come and go: each target's acting value is gain times told value plus bias."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from bondgraph.runtime.simulation.scenario import Fault


class Wrong:
    """All faults of one target, in the order given.

    >>> from bondgraph.runtime.simulation.scenario import Fault
    >>> low = Fault("U", "*=", 0.5, at=1.0, ramp=2.0, label="weak battery")
    >>> Wrong([low]).at(2.0)
    (0.75, 0.0)
    """

    def __init__(self, faults: Sequence[Fault], counts: bool = False) -> None:
        self.faults = tuple(faults)
        self._counts = counts  # an encoder that sticks goes on from where it stuck
        self._held: dict[int, float] = {}

    def hold(self, t: float, told: float) -> None:
        """At time t, where `told` is told: a fault that sticks keeps what acts at its onset."""
        for k, fault in enumerate(self.faults):
            if fault.op != "stuck":
                continue
            if strength(fault, t) == 0:
                self._held.pop(k, None)
            elif k not in self._held:
                gain, bias = self._composed(t, k)
                self._held[k] = gain * told + bias

    def stuck(self, t: float) -> bool:
        """Whether the value does not change any more."""
        return any(f.op == "stuck" and strength(f, t) > 0 for f in self.faults)

    def at(self, t: float) -> tuple[float, float]:
        """Gain and bias at time t, in s."""
        return self._composed(t, len(self.faults))

    def slope(self, t: float) -> tuple[float, float]:
        """How gain and bias change, per s; only ramps do.

        >>> from bondgraph.runtime.simulation.scenario import Fault
        >>> low = Fault("U", "*=", 0.5, at=1.0, ramp=2.0, label="weak battery")
        >>> Wrong([low]).slope(2.0)
        (-0.25, 0.0)
        """
        gain, bias, gain_rate, bias_rate = 1.0, 0.0, 0.0, 0.0
        for k, fault in enumerate(self.faults):
            share = strength(fault, t)
            g, b = self._own(k, fault, share)
            full, none = self._own(k, fault, 1.0), self._own(k, fault, 0.0)
            rate = 1 / fault.ramp if 0 < share < 1 else 0.0
            g_rate, b_rate = rate * (full[0] - none[0]), rate * (full[1] - none[1])
            gain_rate, bias_rate = (
                g_rate * gain + g * gain_rate,
                g_rate * bias + g * bias_rate + b_rate,
            )
            gain, bias = g * gain, g * bias + b
        return gain_rate, bias_rate

    def _composed(self, t: float, count: int) -> tuple[float, float]:
        """Gain and bias of the first faults together."""
        gain, bias = 1.0, 0.0
        for k, fault in enumerate(self.faults[:count]):
            g, b = self._own(k, fault, strength(fault, t))
            gain, bias = g * gain, g * bias + b
        return gain, bias

    def sets_in(self, t: float) -> bool:
        """Whether one of them is on its ramp."""
        return any(0 < strength(f, t) < 1 for f in self.faults)

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
                held = self._held.get(k)
                if held is None or not share:
                    return 1.0, 0.0
                return 0.0, 0.0 if self._counts else held
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
            count = int((stop - fault.at) / fault.period) + 1
            for k in range(max(count, 0)):
                found |= {fault.at + k * fault.period, fault.at + (k + fault.duty) * fault.period}
    return sorted(t for t in found if 0 < t < end)
