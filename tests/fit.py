"""Whether the truth is in the stated intervals of `bondgraph fit`: machines simulated with noise.

    python -m tests.fit 20 [--write]     # so many logs of each machine

Each sensor has noise of 1 % of the root mean square of its signal; the filter is the one that the
command chooses. With `--write` the table goes into `docs/fit.md`.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

import bondgraph
from bondgraph import Course, Instrument, Sampling, Scenario
from tests.measured import ROOT, write

PAGE = ROOT / "docs" / "fit.md"
NOISE = 0.01


class Machine(NamedTuple):
    """A model (its file without .bg), and the machine: `truth` by name of what is fitted.

    Inputs are a constant with sines (amplitude, rad/s); `modes` stay as they are.
    """

    model: str
    rate: float
    duration: float
    truth: Mapping[str, float]
    inputs: Mapping[str, tuple[float, tuple[tuple[float, float], ...]]]
    modes: Mapping[str, float] = {}


MACHINES = (
    Machine("models/dc_motor", 1000.0, 10.0, {"R": 15.0, "k": 3.9e-3, "f": 1.0e-5},
            {"U": (4.0, ((3.0, 2.0), (2.0, 11.0), (1.5, 31.0)))}),
    Machine("models/two_tanks", 10.0, 400.0,
            {"A1": 0.016, "A2": 0.015, "k12": 1.1e-6, "kout": 1.1e-6},
            {"Q": (8e-5, ((3e-5, 0.05), (3e-5, 0.21)))}),
    Machine("models/oven", 10.0, 1000.0, {"Ch": 130.0, "Co": 850.0, "Gh": 3.8, "Go": 0.85},
            {"P": (300.0, ((200.0, 0.02), (100.0, 0.11))), "Ta": (293.0, ())}, {"on": 1.0}),
    Machine("models/hydraulic_actuator", 1000.0, 10.0, {"kv": 3.2e-8, "m": 28.0, "b": 350.0},
            {"ps": (1e7, ()), "spool": (0.3, ((0.25, 3.0), (0.2, 17.0))), "load": (1000.0, ())}),
    Machine("models/quarter_car", 500.0, 20.0, {"ks": 17e3, "cs": 1100.0},
            {"road": (0.0, ((0.2, 3.0), (0.2, 9.0), (0.3, 40.0)))}),
    Machine("tests/campaign/series_motor", 500.0, 20.0, {"R": 0.9, "k": 0.033, "f": 0.018},
            {"U": (24.0, ((8.0, 1.3), (5.0, 7.0))), "load": (1.0, ())}),
    Machine("tests/campaign/vehicle", 200.0, 100.0, {"R": 0.14, "m": 450.0, "drag": 0.5},
            {"duty": (0.5, ((0.2, 0.1), (0.15, 0.7))), "slope": (20.0, ((60.0, 0.23),))}),
    Machine("tests/adversary/models/dc_w", 100.0, 100.0, {"R": 1.0, "k": 1.2, "f": 0.45},
            {"U": (1.0, ((2.0, 0.7), (2.0, 2.9))), "T": (0.0, ((0.5, 1.7),))}),
    Machine("tests/adversary/models/helmholtz", 100.0, 100.0, {"ra": 0.35, "Ca": 1.0},
            {"sound": (0.0, ((1.0, 0.6), (1.0, 1.3), (0.5, 2.6)))}),
    Machine("tests/adversary/models/heated_rod", 50.0, 200.0, {"C1": 1.3, "G12": 0.65},
            {"P": (2.0, ((1.0, 0.2), (1.0, 0.9))), "Ta": (0.0, ((0.5, 0.13),))}),
    Machine("tests/adversary/models/three_tanks", 50.0, 200.0,
            {"k12": 0.55, "k23": 0.55, "ko": 0.45},
            {"Q": (0.6, ((0.2, 0.1), (0.2, 0.47)))}),
    Machine("tests/adversary/models/drag_abs", 50.0, 100.0, {"m": 0.9, "c": 0.5},
            {"F": (2.0, ((3.0, 0.5), (2.0, 2.1))), "slope": (0.0, ((0.1, 0.3),))}),
    Machine("tests/adversary/models/loudspeaker", 200.0, 60.0, {"R": 1.0, "Bl": 1.2, "b": 0.6},
            {"U": (0.0, ((1.0, 0.9), (1.0, 2.3), (0.7, 5.1)))}),
)  # fmt: skip


class Row(NamedTuple):
    """One parameter of one machine: in how many of the logs its truth was in the interval.

    `wide` is half of that, relative to the truth, `off` how far the fitted value was, both as root
    mean squares.
    """

    model: str
    name: str
    logs: int
    inside: int
    wide: float
    off: float


def course(mean: float, sines: tuple[tuple[float, float], ...], machine: Machine) -> Course:
    """An input at all samples, with straight lines between them."""
    time = np.arange(round(machine.duration * machine.rate) + 2) / machine.rate
    value = mean + sum((a * np.sin(w * time) for a, w in sines), np.zeros(len(time)))
    return Course(None, tuple(zip(time.tolist(), value.tolist(), strict=True)))


def rows(machine: Machine, logs: int) -> list[Row]:
    """Fit so many logs of a machine."""
    c = bondgraph.compile(ROOT / f"{machine.model}.bg", rate=machine.rate)
    scenario = Scenario(
        "healthy",
        duration=machine.duration,
        parameters=machine.truth,
        inputs={n: course(mean, sines, machine) for n, (mean, sines) in machine.inputs.items()},
        modes={n: Course.constant(on) for n, on in machine.modes.items()},
        sampling=Sampling(machine.rate),
    )
    clean = c.simulate(scenario).log
    sensors = [s.name for s in c.graph.sensors]
    size = {n: NOISE * math.sqrt(float(np.mean(clean.columns[n] ** 2))) for n in sensors}
    noisy = scenario._replace(instruments={n: Instrument(noise=x) for n, x in size.items()})
    found: dict[str, list[tuple[float, float]]] = {n: [] for n in machine.truth}
    for seed in range(logs):
        log = c.simulate(noisy._replace(seed=seed)).log
        for p in c.fit({"healthy": log}, list(machine.truth)).parameters:
            off, wide = p.value / machine.truth[p.name] - 1.0, p.interval or 0.0
            found[p.name].append((abs(off), wide / machine.truth[p.name]))
    return [
        Row(Path(machine.model).name, name, logs, sum(off <= wide for off, wide in one),
            *(math.sqrt(float(np.mean([x[k] ** 2 for x in one]))) for k in (1, 0)))
        for name, one in found.items()
    ]  # fmt: skip


def table(found: list[Row]) -> str:
    """The rows, and all together."""
    lines = ["| Model | Parameter | truth inside | +- (95 %) | off by |", "|---|---|---|---|---|"]
    for row in found:
        lines.append(
            f"| `{row.model}` | `{row.name}` | {row.inside} of {row.logs} |"
            f" {100 * row.wide:.2g} % | {100 * row.off:.2g} % |"
        )
    inside, logs = sum(r.inside for r in found), sum(r.logs for r in found)
    lines.append(f"| all | {len(found)} | {inside} of {logs}, {100 * inside / logs:.1f} % | | |")
    return "\n".join(lines)


def main() -> int:
    """The command."""
    logs, *options = sys.argv[1:]
    text = table([row for machine in MACHINES for row in rows(machine, int(logs))])
    print(text)
    if "--write" in options:
        write(PAGE, f"python -m tests.fit {logs}", text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
