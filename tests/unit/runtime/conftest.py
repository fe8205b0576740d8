"""A drive of the robot that several rooms look at."""

from __future__ import annotations

import pytest

import bondgraph
from bondgraph.runtime.log import Log
from tests.unit.runtime.monitoring.watch import ROOT


@pytest.fixture(scope="session")
def robot() -> Log:
    """The robot with two encoders a drive, on its errands."""
    compilation = bondgraph.compile(ROOT / "models" / "khepera_encoders.bg")
    scenario = compilation.scenario(ROOT / "models" / "scenarios" / "errands.toml")
    return compilation.simulate(scenario._replace(duration=6.0)).log
