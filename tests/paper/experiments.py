"""The numbers of docs/experiments.md: python -m tests.paper.experiments --write."""

from __future__ import annotations

import argparse
import math
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

import bondgraph
from bondgraph.backends.report.episode import Episode
from bondgraph.cli.reporting.scenarios import played
from bondgraph.compilation import Compilation
from bondgraph.runtime.simulation.scenario import Fault, Scenario
from tests import measured

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "experiments.md"
COMMAND = "python -m tests.paper.experiments"
_SETTLED = 10.5  # s: the faults set in at 8 s, and the speed loops have answered


class Experiment(NamedTuple):
    """What the page calls it, its scenario, and the fault if it is another one than there."""

    name: str
    scenario: str
    fault: Fault | None = None


_BEARING = Fault("m[2].fs", "*=", 3.0, 8.0, math.inf, 0.0, 0.0, 1.0, "bearing of wheel 2")
EXPERIMENTS = (
    Experiment("normal run", "normal"),
    Experiment("amplifier of drive 2 gives 55 %", "actuator"),
    Experiment("bearing of wheel 2: three times the friction", "normal", _BEARING),
    Experiment("100 Ohm in the cable, 20 mA drawn", "cable"),
)


@cache
def _robot() -> Compilation:
    return bondgraph.compile(ROOT / "models" / "khepera_encoders.bg")


def episode(experiment: Experiment) -> Episode:
    """The run of an experiment, as the page of `make demo` shows it."""
    folder = ROOT / "models" / "scenarios"
    scenario: Scenario = _robot().scenario(folder / f"paper_{experiment.scenario}.toml")
    if experiment.fault is not None:
        scenario = scenario._replace(faults=(experiment.fault,))
    return played(_robot(), _robot().simulate(scenario))


def shares(run: Episode) -> str:
    """The largest share of its threshold that each residual reaches once the fault has set in."""
    cells = []
    for trace in run.residuals:
        assert trace.bound is not None and trace.valid is not None
        seen = (run.time >= _SETTLED) & trace.valid
        share = float(np.max(np.abs(trace.value[seen]) / trace.bound[seen]))
        text = f"{share:.2f}" if share < 1.0 else f"{share:.3g}"
        cells.append(f"**{text}**" if share > 1.0 else text)
    return " | ".join(cells)


def row(experiment: Experiment, run: Episode) -> str:
    """One of the page."""
    said = "; ".join(
        f"{s.start:.3f} s: {s.text}" for s in run.said if s.kind == "fault" and s.start < _SETTLED
    )
    return f"| {experiment.name} | {shares(run)} | {said} |"


def main() -> None:
    """Run them all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="put the table into its page")
    options = parser.parse_args()
    runs = [(e, episode(e)) for e in EXPERIMENTS]
    names = " | ".join(t.name for t in runs[0][1].residuals)
    head = [f"| | {names} | said until {_SETTLED} s |", "|---" * (names.count("|") + 3) + "|"]
    text = "\n".join([*head, *(row(e, run) for e, run in runs)])
    print(text)
    if options.write:
        measured.write(PAGE, COMMAND, text)


if __name__ == "__main__":
    main()
