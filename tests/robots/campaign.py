"""Many virtual robots through the monitor: false alarms, missed faults, wrong names."""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.runtime.diagnosis.calibration import Tuned, tune
from bondgraph.runtime.diagnosis.tuning import Tuning
from bondgraph.runtime.log import Log
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.runtime.simulation.scenario import Change, Course, Fault, Scenario

PLANT = "models/khepera_encoders.bg"
SCENARIO = "models/scenarios/errands.toml"
ONSET = 10.0  # s
_BLOCK = 1000  # samples that the monitor gets at a time


class Robot(NamedTuple):
    """The robot on its errands with the instruments that it has.

    `model` is the one that watches it; its encoders turn with the same shafts, however coarse they
    are. `load` says whether something draws a current through the cable.
    """

    name: str
    model: str
    load: bool


ENCODERS = Robot("two encoders a drive", PLANT, True)
BUILT = Robot("as built", "models/khepera_built.bg", False)


class Kind(NamedTuple):
    """A kind of fault: what changes by what, and which hypothesis of `tune` gives its size."""

    name: str
    target: str
    op: Change
    hypothesis: str
    sign: float


#: Eight kinds, on drives and cable, of four classes of the signature matrix on each side.
KINDS = (
    Kind("winding resistance", "m[1].el.Re", "+=", "value", 1.0),
    Kind("motor friction", "m[2].fe", "+=", "value", 1.0),
    Kind("amplifier gain", "U0[2]", "*=", "gain", -1.0),
    Kind("backlash", "m[1].tau0", "+=", "value", 1.0),
    Kind("wheel bearing", "m[2].fs", "+=", "value", 1.0),
    Kind("motor encoder misses counts", "m[1].motor", "*=", "gain", -1.0),
    Kind("cable resistance", "R_L", "+=", "value", 1.0),
    Kind("supply voltage sensor", "Us", "+=", "offset", 1.0),
)


class Seen(NamedTuple):
    """What the monitor said of one run; `delay` until the alarm, `naming` until the last name."""

    alarms: int
    delay: float | None
    naming: float | None
    named: tuple[tuple[str, ...], ...]
    last: tuple[str, ...]
    best: str


@cache
def compiled(model: str = PLANT) -> Compilation:
    """A model, compiled once a process."""
    return bondgraph.compile(model)


@cache
def engine(model: str = PLANT) -> Engine:
    """An engine of it."""
    return compiled(model).engine()


def errands(seed: int, duration: float, *faults: Fault, robot: Robot = ENCODERS) -> Scenario:
    """One robot out of many, on its errands."""
    chosen = compiled().scenario(SCENARIO)
    inputs = chosen.inputs if robot.load else {**chosen.inputs, "load": Course.constant(0.0)}
    return chosen._replace(
        seed=seed, duration=duration, spread="uniform", faults=faults, inputs=inputs
    )


def samples(log: Log, robot: Robot = ENCODERS) -> np.ndarray:
    """What the engine reads, from a log of the plant."""
    fine = {k.path: k.counts for k in engine().signals}
    columns = []
    for known in engine(robot.model).signals:
        column = log.columns[known.path]
        if known.counts != fine[known.path]:
            column = np.floor(column * (known.counts / fine[known.path]))
        columns.append(column)
    return np.column_stack(columns)


def tuned(seeds: range, duration: float, false_alarms: float, robot: Robot = ENCODERS) -> Tuned:
    """Limits from robots that nobody reports on."""
    own, watcher = engine(robot.model), compiled(robot.model)
    runs = (compiled().simulate(errands(seed, duration, robot=robot)).log for seed in seeds)
    logs = [samples(log, robot) for log in runs]
    return tune(own, watcher.diagnosis_model, logs, watcher.program.digest, false_alarms)


def fault(kind: Kind, size: float) -> Fault:
    """A fault of this size, that sets in at `ONSET` and stays."""
    change = kind.sign * size
    value = 1.0 + change if kind.op == "*=" else change
    return Fault(kind.target, kind.op, value, ONSET, math.inf, 0.0, 0.0, 1.0, kind.name)


def watched(scenario: Scenario, tuning: Tuning, robot: Robot = ENCODERS) -> list[Verdict]:
    """All that the monitor says of a run."""
    own = engine(robot.model)
    log = compiled().simulate(scenario).log
    rows = samples(log, robot)
    base, diagnosis = own.configured(), compiled(robot.model).diagnosis(own, tuning)
    said: list[Verdict] = []
    for k in range(0, len(rows), _BLOCK):
        part = rows[k : k + _BLOCK]
        said += diagnosis.update(log.time[k : k + _BLOCK], base.run(part), part)
    return said


def seen(said: list[Verdict], onset: float | None) -> Seen:
    """The verdicts of a run in numbers; an alarm before the onset is a false one."""
    alarms = [v for v in said if v.event == "fault"]
    false = [v for v in alarms if onset is None or v.time < onset]
    true = [v for v in alarms if onset is not None and v.time >= onset]
    named = [v for v in said if v.group and (onset is None or v.time >= onset)]
    best = [v.candidates[0].fault for v in said if v.candidates]
    last = named[-1].group if named else ()
    since = [v.time for v in named if v.group == last]
    return Seen(
        len(false),
        true[0].time - onset if true and onset is not None else None,
        since[0] - onset if since and onset is not None else None,
        tuple(v.group for v in named),
        last,
        best[-1] if best else "",
    )
