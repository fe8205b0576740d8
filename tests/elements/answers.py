"""The models of the catalogue and what the compiler says of them, each compiled once."""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Any

import bondgraph
from bondgraph.cli.result import result
from bondgraph.compilation import Compilation
from tests.adversary.plant import HERE

ROOT = Path(__file__).resolve().parents[2]


def path(model: str) -> Path:
    """The model, of the adversary or of `models/`."""
    here = HERE / "models" / f"{model}.bg"
    return here if here.is_file() else ROOT / "models" / f"{model}.bg"


@functools.cache
def compilation(model: str) -> Compilation:
    """The compilation for code in C."""
    return bondgraph.compile(path(model), targets=("c",))


@functools.cache
def answer(model: str) -> dict[str, Any]:
    """The JSON of the compilation; nobody may change it."""
    found: dict[str, Any] = json.loads(json.dumps(result(compilation(model), [])))
    return found
