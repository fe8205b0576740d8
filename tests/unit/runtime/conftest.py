"""A drive of the robot that several rooms look at; models that commands compile once."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import pytest

import bondgraph
from bondgraph.cli import options
from bondgraph.compilation import Compilation
from bondgraph.runtime.log import Log
from tests.unit.runtime.monitoring.watch import ROOT


@pytest.fixture(scope="session")
def robot() -> Log:
    """The robot with two encoders a drive, on its errands."""
    compilation = bondgraph.compile(ROOT / "models" / "khepera_encoders.bg")
    scenario = compilation.scenario(ROOT / "models" / "scenarios" / "errands.toml")
    return compilation.simulate(scenario._replace(duration=6.0)).log


_compiled = cache(bondgraph.compile)


@pytest.fixture
def kept_models(monkeypatch: pytest.MonkeyPatch) -> None:
    """Commands in this process compile a model of `models` once, not each of them anew."""

    def kept(model: str, **asked: Any) -> Compilation:
        shipped = Path(model).resolve().parent == ROOT / "models"
        return (_compiled if shipped else bondgraph.compile)(model, **asked)

    monkeypatch.setattr(options, "compile", kept)
