"""The faults of the campaign: times the smallest size that `tune` tells of other machines."""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

from bondgraph.runtime.diagnosis.calibration import tune
from bondgraph.runtime.diagnosis.shown_sizes import Shown
from bondgraph.runtime.diagnosis.tuning import bandwidth_for
from bondgraph.runtime.simulation.scenario import Change, Fault
from tests.campaign.machines import Machine, compiled, run

TIMES = 3.0  # the smallest size
KINDS = 10  # of faults a machine
_LONG = {1.0: (1000.0, 500.0), 100.0: (300.0, 150.0)}  # duration and onset (s), by the rate
_SHORT = 60.0, 30.0
_MOST = 5.0  # times the value that a fault changes
_TRIED = 1, 2, 3  # seeds of the machines that sizes are taken from


class Kind(NamedTuple):
    """A fault: what changes how, and in words."""

    of: str
    change: Change
    value: float
    words: str


def span(machine: Machine) -> tuple[float, float]:
    """How long a run with a fault is, and when the fault sets in, in s."""
    return _LONG.get(machine.rate, _SHORT)


def lasting(machine: Machine, kind: Kind) -> Fault:
    """The fault from its onset on, for ever."""
    onset = span(machine)[1]
    return Fault(kind.of, kind.change, kind.value, onset, math.inf, 0.0, 0.0, 1.0, kind.words)


@cache
def _shown(machine: Machine, times: float) -> tuple[tuple[float, Kind], ...]:
    """Each fault that shows, in the way that shows first, with its size beside what it changes."""
    c = compiled(machine)
    duration, _ = span(machine)
    logs = [run(machine, seed, duration) for seed in _TRIED]
    bandwidth = bandwidth_for(machine.rate, len(logs[0]))
    engine = c.engine().configured(bandwidth=bandwidth)
    shown = tune(engine, c.diagnosis_model, logs, "", 1.0, 40.0 / bandwidth).shown
    found: dict[str, tuple[float, Kind]] = {}
    for one in shown:
        share, kind = _kind(machine, one, times)
        if share < found.get(one.hypothesis.fault, (math.inf,))[0]:
            found[one.hypothesis.fault] = share, kind
    return tuple(sorted(found.values(), key=lambda x: x[0]))


def kinds(machine: Machine, times: float = TIMES) -> tuple[Kind, ...]:
    """The faults of so many times their smallest size, those smallest beside their value.

    At most one of each parameter or signal, and none that has to be more than five times its value.
    """
    return tuple(kind for share, kind in _shown(machine, times) if share < _MOST)[:KINDS]


def every_kind(machine: Machine) -> tuple[Kind, ...]:
    """All faults that show, however large they have to be."""
    return tuple(kind for _, kind in _shown(machine, TIMES))


def _kind(machine: Machine, shown: Shown, times: float) -> tuple[float, Kind]:
    """A fault of so many times the size, and how large that is beside what it changes."""
    one, size = shown.hypothesis, times * (shown.size or math.inf)
    if one.kind == "gain":
        value = 1.0 - size if size < 0.9 else 1.0 + size
        return size, Kind(one.fault, "*=", value, f"{one.fault} {100.0 * (value - 1.0):+.3g} %")
    if one.kind == "drift":
        return math.inf, Kind(one.fault, "+=", size, "")
    nominal = compiled(machine).diagnosis_model.faults.get(one.fault)
    words = f"{one.fault} {size:+.3g} {one.unit}".rstrip()
    if nominal:
        words += f" ({100.0 * size / abs(nominal):+.3g} %)"
    share = size / abs(nominal) if nominal else 1.0
    return share, Kind(one.fault, "+=", size, words)
