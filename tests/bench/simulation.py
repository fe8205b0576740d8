"""Runs of the virtual machine, from scenario to log: in processor time of `import sympy`."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

import numpy as np

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.runtime.simulation.scenario import Course, Sampling, Scenario
from tests.bench.whole import processor

MODELS = Path(__file__).parents[2] / "models"


class Case(NamedTuple):
    """A model and what it is run through; `promised` is a multiple of `import sympy`.

    `before` is the multiple that it took when rates and the loop of the integrator ran in Python.
    """

    title: str
    machine: Compilation
    scenario: Scenario
    promised: float
    before: float


def recorded(rate: float, seconds: float) -> Course:
    """A rough road as a log has it: a point a sample, in straight lines between them."""
    draw = np.random.default_rng(1)
    heights = 0.0004 * np.cumsum(draw.normal(size=round(rate * seconds)))
    return Course(None, tuple((k / rate, y) for k, y in enumerate(heights.tolist())))


def cases() -> list[Case]:
    """A robot that two drives control, and a car on a road of 30 000 points; 60 s each."""
    robot = bondgraph.compile(MODELS / "khepera_encoders.bg")
    errands = robot.scenario(MODELS / "scenarios" / "errands.toml")._replace(duration=60.0)
    car = bondgraph.compile(MODELS / "quarter_car.bg")
    road = Scenario(
        "road", duration=60.0, inputs={"road": recorded(500, 60)}, sampling=Sampling(500.0)
    )
    return [Case("robot, 60 s", robot, errands, 6, 20), Case("road, 60 s", car, road, 3, 8)]


def processor_time(case: Case, native: bool = True) -> float:
    """Seconds of processor time of one run; that of the compiler with it, if it is not kept."""
    before = os.times()
    case.machine.simulate(case.scenario, native=native)
    return sum(os.times()[:4]) - sum(before[:4])


def report(short: bool) -> None:
    """A line a case: its time, the multiple of the yardstick's beside it, what is promised."""
    for case in cases():
        case.machine.simulate(case.scenario._replace(duration=0.1))  # state equations, once
        pairs = []
        for _ in range(1 if short else 3):
            yardstick = processor("-c", "import sympy")
            own = processor_time(case)
            pairs.append((own / yardstick, own, yardstick))
        ratio, own, yardstick = sorted(pairs)[len(pairs) // 2]
        print(f"{'simulate ' + case.title:24} {own:8.2f} s  import sympy {yardstick:5.2f} s "
              f"{ratio:7.2f}x  <= {case.promised:g}x (in Python {case.before:g}x)",
              flush=True)  # fmt: skip
