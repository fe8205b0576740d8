"""What the compiler says of a model: its JSON, from the command as a user runs it."""

from __future__ import annotations

import contextlib
import io
import json
import os
import signal
import tempfile
import traceback
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest.mock import patch

import bondgraph
from bondgraph.cli.main import main
from bondgraph.cli.result import result
from bondgraph.text.diagnostic import CompileError
from tests.real.build import Model


class Slow(Exception):
    """The compiler or the judge has had its time."""


@contextlib.contextmanager
def limited(seconds: int) -> Iterator[None]:
    """Raises `Slow` after so many seconds of processor time."""

    def ring(*_: object) -> None:
        raise Slow

    before = signal.signal(signal.SIGPROF, ring)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


@contextlib.contextmanager
def _written(model: Model) -> Iterator[Path]:
    """The model and its tables in a folder of their own."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "model.bg"
        path.write_text(model.text, encoding="utf-8")
        for name, text in model.files.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        yield path


def answer(model: Model, seconds: int = 30) -> dict[str, Any]:
    """The object that `compile --json` prints; an exception gives a status and a traceback."""
    out = io.StringIO()
    with patch.dict(os.environ, BONDGRAPH_TRACEBACK="1"), _written(model) as path:
        words = ["compile", str(path), "--json", "--target", "python", "-o", f"{path.parent}/out"]
        try:
            with limited(seconds), contextlib.redirect_stdout(out):
                main(words)
        except Slow:
            return {"status": "slow"}
        except Exception:
            return {"status": "exception", "message": traceback.format_exc(limit=-4)}
    found: dict[str, Any] = json.loads(out.getvalue())
    return found


def unverified(model: Model, seconds: int = 30) -> dict[str, Any]:
    """The same without the compiler's own check: what it refused as a mistake of its own."""
    with _written(model) as path:
        try:
            with limited(seconds):
                compilation = bondgraph.compile(str(path))
                found: dict[str, Any] = json.loads(json.dumps(result(compilation, ())))
        except (Slow, CompileError) as reason:
            return {"status": str(reason) or "slow", "arrs": []}
    return found
