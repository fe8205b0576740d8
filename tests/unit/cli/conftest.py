"""The command line as tests call it: in this process, with what it printed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import pytest

from bondgraph.cli.main import main

MODELS = Path(__file__).resolve().parents[3] / "models"


class Outcome(NamedTuple):
    """What a command did."""

    status: int
    out: str
    err: str


Command = Callable[..., Outcome]


@pytest.fixture
def bondgraph(capsys: pytest.CaptureFixture[str]) -> Command:
    """Runs a command line; wrong usage gives its exit status instead of leaving."""

    def run(*words: str | Path) -> Outcome:
        argv: Sequence[str] = [str(w) for w in words]
        try:
            status = main(argv)
        except SystemExit as leaving:
            status = int(leaving.code or 0)
        printed = capsys.readouterr()
        return Outcome(status, printed.out, printed.err)

    return run


@pytest.fixture
def model(tmp_path: Path) -> Callable[[str], Path]:
    """Writes a model file and gives its path."""

    def write(text: str) -> Path:
        path = tmp_path / "model.bg"
        path.write_text(text, encoding="utf-8")
        return path

    return write
