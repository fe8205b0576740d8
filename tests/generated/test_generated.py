"""Every model's code: as committed, without a warning, right in C and in Python."""

from __future__ import annotations

import re
import sys
from functools import cache
from pathlib import Path
from shutil import copytree
from tempfile import TemporaryDirectory

import pytest

import bondgraph
from bondgraph.backends.costs import CORES, missing
from bondgraph.backends.write import COSTS, MANIFEST
from bondgraph.backends.emit import EXTRAS
from bondgraph.backends.identifiers import snake
from bondgraph.ir.artifact import Artifact
from bondgraph.compilation import Compilation
from bondgraph.text.diagnostic import CompileError
from tests.generated.scale import waves, worst
from tests.unit.backends.compilers import (
    INCLUDES,
    WARNINGS,
    compiler,
    python_self_test,
    run,
    self_test,
)

_ROOT = Path(__file__).resolve().parent.parent.parent
_MODELS = [p.stem for p in sorted((_ROOT / "models").glob("*.bg"))]


@cache
def _compilation(model: str) -> Compilation:
    return bondgraph.compile(_ROOT / "models" / f"{model}.bg")


@cache
def _artifacts(model: str) -> tuple[str, tuple[Artifact, ...]]:
    compilation = _compilation(model)
    try:
        return snake(compilation.program.name), compilation.artifacts
    except CompileError:
        return "", ()  # a model that shows a refusal


@pytest.mark.parametrize("model", _MODELS)
def test_is_what_is_committed(model: str, update: bool) -> None:
    """`pytest --update` (or `make update`) writes it anew; look at the difference."""
    _, artifacts = _artifacts(model)
    folder = _ROOT / "generated" / model
    if update and artifacts:
        _compilation(model).with_options(costs=True).write(folder)
    kept = {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()} - {MANIFEST}
    assert kept == {a.path for a in artifacts}, "run `make update` and read the difference"
    for artifact in artifacts:
        path = folder / artifact.path
        assert COSTS.sub("", path.read_text(encoding="utf-8")) == artifact.text


def test_nothing_is_left_of_models_that_are_gone() -> None:
    kept = {p.name for p in (_ROOT / "generated").iterdir() if p.is_dir()}
    assert kept == {m for m in _MODELS if _artifacts(m)[1]}


@pytest.mark.parametrize("model", ["dc_motor", "khepera"])
def test_costs_are_those_that_are_committed(model: str) -> None:
    """To the instruction and to the byte, on all cores."""
    absent = [tool for core in CORES for tool in missing(core)]
    if absent:
        pytest.skip(f"{', '.join(absent)} not installed")
    found = {a.path: a.text for a in _compilation(model).with_options(costs=True).artifacts}
    ours, committed = (
        COSTS.findall(text)
        for text in (found["README.md"], (_ROOT / "generated" / model / "README.md").read_text())
    )
    assert len(committed) == 1 and "Not measured" not in committed[0]
    compilers = [re.findall(r"gcc [\d.]+", text[0]) for text in (ours, committed)]
    if compilers[0] != compilers[1]:
        pytest.skip(f"the table is of other compilers: {compilers[1]}")
    assert ours == committed


_WRITTEN = TemporaryDirectory()


@cache
def _written(model: str) -> Path:
    folder = Path(_WRITTEN.name) / model
    _compilation(model).write(folder, extras=EXTRAS)
    return folder


def _everything(model: str, folder: Path) -> str:
    """All files of a model, and its stem; none of one that shows a refusal."""
    stem, artifacts = _artifacts(model)
    if artifacts:
        copytree(_written(model), folder, dirs_exist_ok=True)
    return stem


@pytest.mark.parametrize("model", _MODELS)
def test_compiles_and_passes_its_own_test(model: str, tmp_path: Path) -> None:
    stem = _everything(model, tmp_path)
    if not stem:
        return
    vectors = (tmp_path / "tests" / "golden.h").read_text()
    assert not re.search(r"GOLDEN_\w+ = 0\b", vectors), "a test of nothing"
    assert python_self_test(tmp_path).endswith("PASS\n")
    assert "alarms" in run(sys.executable, "example/example.py", cwd=tmp_path)
    real = f"-D{stem.upper()}_FLOAT"
    sanitized = ("-ffp-contract=off", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
    for options in (sanitized, (real,)):
        told = self_test(tmp_path, stem, *WARNINGS, "-O1", *options)
        assert told.endswith("PASS\n") and "FAIL" not in told


@pytest.mark.parametrize("model", _MODELS)
@pytest.mark.parametrize("name", ["clang", "g++", "clang++", "arm", "riscv"])
def test_no_warning_from_any_compiler(name: str, model: str) -> None:
    command = compiler(name)
    stem, artifacts = _artifacts(model)
    if not artifacts:
        return
    folder = _written(model)  # only read here
    sources = sorted(folder.rglob("*.c"))
    for real in ((), (f"-D{stem.upper()}_FLOAT",)):
        run(*command, *WARNINGS, *INCLUDES, *real, "-fsyntax-only", *sources, cwd=folder)


_UNCERTAIN = ["dc_motor", "khepera", "two_tanks", "slider_crank"]


@pytest.mark.parametrize("model", _UNCERTAIN)
def test_thresholds_agree_in_every_language(model: str, tmp_path: Path) -> None:
    """The self-tests compare C, in double and in float, and Python with the same numbers."""
    stem = _everything(model, tmp_path)
    assert python_self_test(tmp_path, "_thresholds").endswith("PASS\n")
    for real in ((), (f"-D{stem.upper()}_FLOAT",)):
        options = (*WARNINGS, "-O1", "-ffp-contract=off", *real)
        told = self_test(tmp_path, stem, *options, of="_thresholds")
        assert told.endswith("PASS\n") and "FAIL" not in told
        assert "PASS step r1" in told


@pytest.mark.parametrize("model", _UNCERTAIN)
def test_thresholds_that_are_left_out_leave_nothing(model: str, tmp_path: Path) -> None:
    stem = _everything(model, tmp_path)
    for name, left_out in (("with", ()), ("without", (f"-D{stem.upper()}_NO_THRESHOLDS",))):
        options = ("-O1", *WARNINGS, *left_out, "-c", f"{stem}.c", "-o", f"{name}.o")
        run(*compiler("gcc"), *options, cwd=tmp_path)
    names = run("nm", "--defined-only", "without.o", cwd=tmp_path)
    assert "threshold" not in names and "bound_r1" not in names and f"{stem}_step" in names
    assert f"{stem}_threshold_step" in run("nm", "--defined-only", "with.o", cwd=tmp_path)


@pytest.mark.parametrize("model", _MODELS)
def test_arrays_through_c_and_through_python_give_the_same(model: str) -> None:
    """Within 1e-12 of the sum of the amounts of the terms of the step, a restart included."""
    if not _artifacts(model)[1]:
        return
    c = _compilation(model)
    samples = waves(c, 20_000 if model == "khepera" else 1_500)
    error = worst(c.engine(native=True), c.engine(native=False), samples, 100)
    assert error <= 1e-12
