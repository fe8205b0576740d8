"""Compiled residuals: built once, found again, whole or not at all; Python where that fails."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from bondgraph.backends.runnable import runnable
from bondgraph.runtime.monitoring.engine import Engine, PythonEngine
from bondgraph.runtime.monitoring.native import NativeEngine, NativeError, start
from tests.unit.backends import programs

_START = """
from bondgraph.backends.runnable import runnable
from bondgraph.runtime.monitoring.native import start
from tests.unit.backends import programs
print(start(runnable(programs.motor()), native=True).run([[1.0, 2.0, 3.0, 4.0]] * 9).value.tolist())
"""


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "bondgraph"


def _start(**options: object) -> Engine:
    return start(runnable(programs.motor()), **options)  # type: ignore[arg-type]


def _runs(engine: Engine) -> None:
    samples = np.ones((5, len(engine.signals)))
    expected = start(runnable(programs.motor()), native=False).run(samples)
    np.testing.assert_allclose(engine.run(samples).value, expected.value, rtol=1e-12)


def test_it_is_compiled_once(cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    calls, compiler = tmp_path / "calls", tmp_path / "my cc"
    compiler.write_text(f'#!/bin/sh\necho "$@" >> {calls}\nexec cc "$@"\n')
    compiler.chmod(0o755)
    monkeypatch.setenv("CC", f"'{compiler}' -DONE")
    for _ in range(2):
        _runs(_start(native=True))
    compiled = [c for c in calls.read_text().splitlines() if "-shared" in c]
    assert len(compiled) == 1 and "-DONE" in compiled[0]
    monkeypatch.setenv("CC", f"'{compiler}' -DTWO")  # other flags, another library
    _runs(_start(native=True))
    assert len(list(cache.iterdir())) == 2


@pytest.mark.parametrize("damage", ["empty", "no library", "of another model"])
def test_a_library_that_is_none_of_this_model_is_made_anew(
    cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, damage: str
) -> None:
    _runs(_start(native=True))
    (good,) = cache.iterdir()
    start(runnable(programs.motor()._replace(digest="another")), native=True)
    (other,) = set(cache.iterdir()) - {good}
    bad = {"empty": b"", "no library": b"text", "of another model": other.read_bytes()}[damage]
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "second"))  # a path not loaded before
    kept = tmp_path / "second" / "bondgraph" / good.name
    kept.parent.mkdir(parents=True)
    kept.write_bytes(bad)
    _runs(_start(native=True))
    assert len(kept.read_bytes()) > 1000 and kept.read_bytes() != bad


def test_many_processes_at_once(cache: Path, root: Path) -> None:
    command = [sys.executable, "-c", _START]
    running = [
        subprocess.Popen(command, cwd=root, stdout=subprocess.PIPE, text=True) for _ in range(4)
    ]
    told = {process.communicate(timeout=60)[0] for process in running}
    assert len(told) == 1 and "[[" in told.pop()
    assert [p.suffix for p in cache.iterdir()] == [".so"]


def test_without_a_folder_for_the_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(blocked))
    _runs(_start(native=True))
    assert blocked.read_text() == ""


def test_old_libraries_go(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("bondgraph.runtime.monitoring.native._KEPT", 2)
    for digest in "abcd":
        start(runnable(programs.motor()._replace(digest=digest)), native=True)
    assert len(list(cache.iterdir())) == 2


@pytest.mark.parametrize(
    ("compiler", "why"), [("no-such-compiler", "no C compiler"), ("false", "does not compile")]
)
def test_python_takes_over_with_one_warning(
    cache: Path, monkeypatch: pytest.MonkeyPatch, compiler: str, why: str
) -> None:
    monkeypatch.setenv("CC", compiler)
    told: list[str] = []
    engine = _start(tell=told.append)
    assert isinstance(engine, PythonEngine) and isinstance(engine.configured(), PythonEngine)
    assert len(told) == 1 and why in told[0] and "Python" in told[0] and "\n" not in told[0]
    _runs(engine)
    with pytest.warns(RuntimeWarning, match=why):
        _start()
    with pytest.raises(NativeError, match=why):
        _start(native=True)
    assert isinstance(_start(native=False), PythonEngine)


def test_what_is_compiled_shares_its_library(cache: Path) -> None:
    engine = _start(native=True)
    assert isinstance(engine, NativeEngine)
    fleet = [engine.configured() for _ in range(100)]
    assert {id(e._library) for e in fleet} == {id(engine._library)}
