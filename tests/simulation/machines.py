"""Opens models and scenarios written as text, and runs them."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import numpy as np
import numpy.typing as npt

from bondgraph.compilation import Compilation
from bondgraph.compile_options import Options
from bondgraph.runtime.simulation.read_scenario import read_scenario
from bondgraph.runtime.simulation.run import Run
from bondgraph.runtime.simulation.scenario import Scenario
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source

Array = npt.NDArray[np.float64]
MODELS = Path(__file__).resolve().parents[2] / "models"


def opened(text: str) -> Compilation:
    """A model written as the statements inside of its braces."""
    return Compilation(Source("m.bg", f"bg 1\nmodel M {{\n{text}\n}}\n"), None, Options())


def example(name: str) -> Compilation:
    """A model of models/."""
    path = MODELS / f"{name}.bg"
    return Compilation(Source(str(path), path.read_text(encoding="utf-8")), None, Options())


def read(machine: Compilation, scenario: str) -> Scenario:
    """A scenario from its text, which has to be right."""
    report = Report()
    found = read_scenario(Source("s.toml", dedent(scenario)), machine.graph, report)
    assert found is not None, [d.message for d in report.diagnostics]
    return found


def run(machine: Compilation | str, scenario: str) -> Run:
    """A run of a model (or of its text) through a scenario."""
    compilation = opened(machine) if isinstance(machine, str) else machine
    return compilation.simulate(read(compilation, scenario))


def near(one: Array, other: Array, share: float = 1e-5) -> bool:
    """Whether two signals differ by no more than a share of what the second one varies over."""
    size = float(np.max(np.abs(other))) or 1.0
    return bool(np.max(np.abs(one - other)) <= share * size)
