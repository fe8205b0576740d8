"""Compiled residuals: built once, found again, whole or not at all; Python where that fails."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
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
    assert len(list(cache.glob("*.so"))) == 2


def test_a_library_of_another_model_is_made_anew(cache: Path) -> None:
    """Its content is sound, but it says itself what it was made of."""
    _runs(_start(native=True))
    (good,) = cache.glob("*.so")
    start(runnable(programs.motor()._replace(digest="another")), native=True)
    (other,) = set(cache.glob("*.so")) - {good}
    wrong = cache / f"{good.name.split('.')[0]}.{other.name.split('.')[1]}.so"
    good.unlink()
    other.rename(wrong)
    _runs(_start(native=True))
    assert good.exists()


def _truncated(data: bytes) -> bytes:
    return data[: len(data) // 2]


def _flipped(data: bytes) -> bytes:
    middle = len(data) // 2
    return data[:middle] + bytes([data[middle] ^ 1]) + data[middle + 1 :]


DAMAGES: dict[str, Callable[[bytes], bytes]] = {
    "empty": lambda data: b"",
    "no library": lambda data: b"text",
    "truncated": _truncated,
    "truncated in its last page": lambda data: data[:-1],
    "a flipped bit": _flipped,
    "longer": lambda data: data + b"\0",
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_library_is_made_anew(cache: Path, root: Path, damage: str) -> None:
    """In a process of its own: a loader that meets the end of a file kills it (SIGBUS)."""
    command = [sys.executable, "-c", _START]

    def run() -> str:
        return subprocess.run(
            command, cwd=root, stdout=subprocess.PIPE, text=True, check=True, timeout=60
        ).stdout

    expected = run()
    (kept,) = cache.glob("*.so")
    good = kept.read_bytes()
    kept.write_bytes(DAMAGES[damage](good))
    assert run() == expected
    assert [p.read_bytes() for p in cache.glob("*.so")] == [good]


def test_many_processes_at_once(cache: Path, root: Path) -> None:
    command = [sys.executable, "-c", _START]
    running = [
        subprocess.Popen(command, cwd=root, stdout=subprocess.PIPE, text=True) for _ in range(4)
    ]
    told = {process.communicate(timeout=60)[0] for process in running}
    assert len(told) == 1 and "[[" in told.pop()
    assert sorted({p.suffix for p in cache.iterdir()}) == [".so", ".template"]


def test_without_a_folder_for_the_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(blocked))
    _runs(_start(native=True))
    assert blocked.read_text() == ""


def test_old_libraries_go(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("bondgraph.cache._KEPT", 2)
    for digest in "abcd":
        start(runnable(programs.motor()._replace(digest=digest)), native=True)
    assert len(list(cache.glob("*.so"))) == 2


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


def test_a_cache_that_others_can_write_to_is_not_used(cache: Path) -> None:
    cache.mkdir()
    cache.chmod(0o777)
    told: list[str] = []
    _runs(_start(native=True, tell=told.append))
    assert len(told) == 1 and "others can write" in told[0] and "\n" not in told[0]
    assert list(cache.glob("*.so")) == []
    with pytest.warns(RuntimeWarning, match=f"chmod go-w {cache}"):
        _runs(_start())
