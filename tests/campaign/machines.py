"""Six machines that are watched, in operation that never repeats, with real instruments."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import cache
from typing import NamedTuple

import numpy as np

import bondgraph
from bondgraph import Course, Scenario
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation.scenario import Fault, Sampling
from tests.measured import ROOT

SPREAD = "3%"  # tolerance of each parameter that is not zero
BITS = 10  # of the converters
NOISE = (0.005, 0.01)  # deviation of the noise, relative to the root mean square of a signal


class Machine(NamedTuple):
    """A model with its rate (Hz) and what drives it.

    `inputs` draws courses of so many seconds; `slow` (s) is the longest memory of the noise of its
    sensors, which is drawn between one sample and that. `start` as in a scenario.
    """

    name: str
    model: str
    rate: float
    inputs: Callable[[np.random.Generator, Array], Mapping[str, Array]]
    slow: float
    start: str = "steady"
    own: bool = False  # tolerances, instruments and scenario of its own


def _wander(
    draw: np.random.Generator, time: Array, low: float, high: float, period: float
) -> Array:
    """Between two values: sines of random periods, from a third of `period` to three of them."""
    periods = period * 3.0 ** draw.uniform(-1.0, 1.0, 5)
    phases = draw.uniform(0.0, 2.0 * np.pi, 5)
    wave = np.sin(2.0 * np.pi * time[:, None] / periods + phases).sum(axis=1) / 5.0**0.5
    return low + (high - low) * np.clip(0.5 + 0.35 * wave, 0.0, 1.0)


def _steps(
    draw: np.random.Generator, time: Array, low: float, high: float, period: float
) -> Array:
    """Levels that stay for about a `period`, with ramps of a tenth of it between them."""
    count = int(time[-1] / period * 2) + 4
    turns = np.cumsum(draw.uniform(0.5, 1.5, count)) * period
    levels = draw.uniform(low, high, count + 1)
    at = np.concatenate([[0.0], np.repeat(turns, 2)])
    at[2::2] += 0.1 * period
    return np.interp(time, at, np.repeat(levels, 2)[:-1])


def _two_tanks(draw: np.random.Generator, time: Array) -> dict[str, Array]:
    return {"Q": _steps(draw, time, 4e-5, 1.1e-4, 120.0)}


def _three_tanks(draw: np.random.Generator, time: Array) -> dict[str, Array]:
    return {
        "Q1": _steps(draw, time, 4e-5, 1e-4, 150.0),
        "Q2": _steps(draw, time, 2e-5, 6e-5, 110.0),
    }


def _quarter_car(draw: np.random.Generator, time: Array) -> dict[str, Array]:
    count = len(time)
    step = float(time[1] - time[0])
    rough = np.empty(count)  # speed of a road: noise with a memory of 0.05 s
    keep = np.exp(-step / 0.05)
    white = draw.normal(0.0, 0.25 * np.sqrt(1.0 - keep**2), count)
    value = 0.0
    for k in range(count):
        value = rough[k] = keep * value + white[k]
    speed = _steps(draw, time, 0.2, 1.0, 20.0)  # of the car, over roads of this kind
    return {"road": rough * speed}


def _vehicle(draw: np.random.Generator, time: Array) -> dict[str, Array]:
    return {
        "duty": _steps(draw, time, 0.25, 0.85, 15.0),
        "slope": _wander(draw, time, -150.0, 250.0, 40.0),
    }


def _series_motor(draw: np.random.Generator, time: Array) -> dict[str, Array]:
    return {
        "U": _steps(draw, time, 20.0, 60.0, 4.0),
        "load": _wander(draw, time, 0.3, 3.0, 6.0),
    }


def _robot(draw: np.random.Generator, time: Array) -> dict[str, Array]:
    return {}


MACHINES = (
    Machine("two tanks", "models/two_tanks.bg", 1.0, _two_tanks, 20.0),
    Machine("three tanks", "tests/case_studies/three_tanks.bg", 1.0, _three_tanks, 20.0),
    Machine("quarter car", "models/quarter_car.bg", 500.0, _quarter_car, 0.05, "initial"),
    Machine("electric vehicle", "tests/campaign/vehicle.bg", 100.0, _vehicle, 0.5),
    Machine("series motor", "tests/campaign/series_motor.bg", 500.0, _series_motor, 0.1),
    Machine("robot", "models/khepera_encoders.bg", 1000.0, _robot, 0.0, "initial", own=True),
)


@cache
def compiled(machine: Machine) -> bondgraph.Compilation:
    """The model with its tolerances, for the rate of the machine."""
    path = ROOT / machine.model
    text = path.read_text(encoding="utf-8")
    if not machine.own:
        text = re.sub(r" \+- \S+", "", text)
        text = re.sub(r"^( +param \w+ = (?!0 )[^#\n]*?)( *)(#|$)", rf"\1 +- {SPREAD}\2\3", text,
                      flags=re.MULTILINE)  # fmt: skip
    return bondgraph.compile(path, text=text, rate=machine.rate)


def run(machine: Machine, seed: int, duration: float, faults: tuple[Fault, ...] = ()) -> Array:
    """The samples of one machine out of many, (n, signals) as its engine reads them."""
    c = compiled(machine)
    draw = np.random.default_rng([seed, 14])
    if machine.own:
        base = c.scenario(ROOT / "models/scenarios/errands.toml")
        scenario = base._replace(seed=seed, duration=duration, spread="uniform", faults=faults)
        log = c.simulate(scenario).log
        return np.column_stack([log.columns[k.path] for k in c.engine().signals])
    time = np.arange(round(duration * machine.rate) + 2) / machine.rate
    courses = {
        name: Course(None, tuple(zip(time.tolist(), values.tolist(), strict=True)))
        for name, values in machine.inputs(draw, time).items()
    }
    scenario = Scenario(
        machine.name, duration=duration, seed=seed, start=machine.start, spread="uniform",
        inputs=courses, sampling=Sampling(machine.rate), faults=faults, tolerance=1e-6,
    )  # fmt: skip
    log = c.simulate(scenario).log
    sensors = {s.name for s in c.graph.sensors}
    columns = []
    for known in c.engine().signals:
        column = log.columns[known.path]
        columns.append(_instrument(draw, column, machine) if known.path in sensors else column)
    return np.column_stack(columns)


def _instrument(draw: np.random.Generator, column: Array, machine: Machine) -> Array:
    """What a converter shows: noise with a memory, and 1024 levels over its range."""
    size = float(np.sqrt(np.mean(column**2)))
    memory = np.exp(draw.uniform(0.0, np.log(machine.slow * machine.rate)))  # samples
    keep = np.exp(-1.0 / memory)
    white = draw.normal(0.0, np.sqrt(1.0 - keep**2), len(column))
    noise = np.empty(len(column))
    value = draw.normal()
    for k, step in enumerate(white.tolist()):
        value = noise[k] = keep * value + step
    noisy = column + size * draw.uniform(*NOISE) * noise
    low, high = float(column.min()), float(column.max())
    span = 1.5 * max(abs(low), abs(high)) * (2.0 if low < 0.0 else 1.0)
    step = span / 2**BITS
    return np.asarray(np.round(noisy / step) * step)
