"""The generated C compiles everywhere without a word, and its self-test passes."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from bondgraph.compilation import Compilation
from bondgraph.text.source import Source
from tests.unit.backends import programs
from tests.unit.backends.compilers import (
    COMPILERS,
    INCLUDES,
    WARNINGS,
    compiler,
    generate,
    python_self_test,
    run,
    self_test,
    sources,
)
from tests.unit.backends.test_unused import LINEAR, made

_SAMPLE = pytest.mark.parametrize("make", programs.ALL, ids=lambda m: m.__name__)


@pytest.mark.parametrize("name", COMPILERS)
@_SAMPLE
def test_no_warning(make: programs.Maker, name: str, tmp_path: Path) -> None:
    command = compiler(name)
    stem = generate(make(), tmp_path)
    for real in ("", f"-D{stem.upper()}_FLOAT"):
        options = [*WARNINGS, "-O1", *INCLUDES, *filter(None, [real])]
        files = (*sources(stem), "tests/selftest.c", "example/example.c")
        run(*command, *options, "-c", *files, cwd=tmp_path)


@_SAMPLE
def test_selftest_in_c(make: programs.Maker, tmp_path: Path) -> None:
    stem = generate(make(), tmp_path)
    sanitizers = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all")
    for options in (("-ffp-contract=off", *sanitizers), (f"-D{stem.upper()}_FLOAT",)):
        told = self_test(tmp_path, stem, "-O1", *options)
        assert told.endswith("PASS\n") and "FAIL" not in told
        assert "PASS exact r1" in told and "PASS step r1" in told


@_SAMPLE
def test_example_is_quiet_on_a_machine_at_rest(make: programs.Maker, tmp_path: Path) -> None:
    program = make()
    stem = generate(program, tmp_path)
    files = ("example/example.c", f"{stem}.c", "-lm")
    run(*compiler("gcc"), "-I.", *files, "-o", "watch", cwd=tmp_path)
    assert "5000 samples" in run(tmp_path / "watch")


@_SAMPLE
def test_only_constants_and_its_own_functions(make: programs.Maker, tmp_path: Path) -> None:
    """No heap, no data that changes, no library but the one that a law needs."""
    if shutil.which("nm") is None:
        pytest.skip("nm is not installed")
    program = make()
    stem = generate(program, tmp_path)
    run(*compiler("gcc"), "-O2", "-c", f"{stem}.c", "-o", "out.o", cwd=tmp_path)
    symbols = [line.split()[-2:] for line in run("nm", tmp_path / "out.o").splitlines()]
    kinds = {kind for kind, _ in symbols}
    assert kinds <= {"T", "t", "r", "R", "U"}, symbols
    needed = {name for kind, name in symbols if kind == "U"}
    if make is programs.functions:
        assert not needed & {"malloc", "calloc", "printf"}
    else:
        assert needed <= {"_GLOBAL_OFFSET_TABLE_", "memset", "memcpy", "__stack_chk_fail"}
    visible = {name for kind, name in symbols if kind == "T"}
    assert visible and all(name.startswith(f"{stem}_") for name in visible)


@_SAMPLE
def test_float_build_has_no_double(make: programs.Maker, tmp_path: Path) -> None:
    """After the preprocessor every literal has its f, and no name of a double is left."""
    stem = generate(make(), tmp_path)
    text = run(
        *compiler("gcc"), "-E", "-P", f"-D{stem.upper()}_FLOAT", f"{stem}.c", cwd=tmp_path
    )
    own = text[text.index(f"{stem}_real;") :]
    own = re.sub(r"extern [^;]*;", "", own)
    own = own[own.index("finite_number") :]
    literals = re.findall(r"(?<![\w.])\d+\.\d*(?:[eE][+-]?\d+)?\w*", own)
    assert all(literal.lower().endswith("f") for literal in literals), literals
    assert not re.search(r"\bdouble\b(?! *\w*\()", re.sub(r"\"[^\"]*\"", "", own))


def test_cmake_builds_and_tests(tmp_path: Path) -> None:
    if shutil.which("cmake") is None:
        pytest.skip("cmake is not installed")
    compiler("gcc")
    generate(programs.functions(), tmp_path)
    run("cmake", "-S", tmp_path, "-B", tmp_path / "build")
    run("cmake", "--build", tmp_path / "build")
    told = run("ctest", "--test-dir", tmp_path / "build")
    assert "100% tests passed" in told and "out of 2" in told


def _frames(folder: Path, stem: str) -> dict[str, int]:
    """The bytes that each function takes of the stack."""
    found = {}
    for source in sources(stem):
        run(*compiler("gcc"), *INCLUDES, "-O1", "-fstack-usage", "-c", source, cwd=folder)
    for file in sorted(folder.glob("*.su")):
        for line in file.read_text().splitlines():
            place, size, _ = line.split("\t")
            found[place.rpartition(":")[2]] = int(size)
    return found


def test_configure_takes_no_stack(tmp_path: Path) -> None:
    """Cells that each have parameters of their own: 120 of them."""
    stem = generate(made(LINEAR, 120, tmp_path), tmp_path)
    frames = _frames(tmp_path, stem)
    assert max(frames.values()) <= 1024, frames
    assert {f"{stem}_configure", f"{stem}_exact_configure"} <= frames.keys()
    assert self_test(tmp_path, stem, "-O1").endswith("PASS\n")


_CABLE = """bg 1
import Cable from "MODELS/khepera.bg"
model Long { Se:Uin -> Cable:line(n = COUNT) -> 0:out; out { -> C:Cs = line.C; -> De:Us } }
"""


def test_equal_cells_are_a_loop(tmp_path: Path, root: Path) -> None:
    """What grows with the cells is the number of its turns."""
    sizes = []
    for cells in (30, 150):
        text = _CABLE.replace("MODELS", str(root / "models")).replace("COUNT", str(cells))
        program = Compilation(Source(str(tmp_path / "long.bg"), text)).program
        folder = tmp_path / str(cells)
        folder.mkdir()
        stem = generate(program, folder)
        told = self_test(folder, stem, "-O1", "-ffp-contract=off")
        assert told.endswith("PASS\n") and "PASS exact r1" in told
        assert python_self_test(folder).endswith("PASS\n")
        sizes.append([(folder / name).stat().st_size for name in sources(stem)])
    assert all(large < 1.1 * small for small, large in zip(*sizes, strict=True)), sizes
