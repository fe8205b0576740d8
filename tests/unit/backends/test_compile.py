"""The generated C compiles everywhere without a word, and its self-test passes."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from tests.unit.backends import programs
from tests.unit.backends.compilers import COMPILERS, WARNINGS, compiler, generate, run

_SAMPLE = pytest.mark.parametrize("make", programs.ALL, ids=lambda m: m.__name__)


@pytest.mark.parametrize("name", COMPILERS)
@_SAMPLE
def test_no_warning(make: programs.Maker, name: str, tmp_path: Path) -> None:
    command = compiler(name)
    stem = generate(make(), tmp_path)
    for real in ("", f"-D{stem.upper()}_FLOAT"):
        for source in (f"{stem}_residuals.c", "selftest.c", "example.c"):
            options = [*WARNINGS, "-O1", *filter(None, [real])]
            run(*command, *options, "-c", source, "-o", "out.o", cwd=tmp_path)


@_SAMPLE
def test_selftest_in_c(make: programs.Maker, tmp_path: Path) -> None:
    stem = generate(make(), tmp_path)
    gcc = compiler("gcc")
    sources = ("selftest.c", f"{stem}_residuals.c", "-lm")
    sanitizers = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all")
    for options in (("-ffp-contract=off", *sanitizers), (f"-D{stem.upper()}_FLOAT",)):
        run(*gcc, "-O1", *options, *sources, "-o", "selftest", cwd=tmp_path)
        told = run(tmp_path / "selftest")
        assert told.endswith("PASS\n") and "FAIL" not in told
        assert "PASS exact r1" in told and "PASS step r1" in told


@_SAMPLE
def test_example_is_quiet_on_a_machine_at_rest(make: programs.Maker, tmp_path: Path) -> None:
    program = make()
    stem = generate(program, tmp_path)
    sources = ("example.c", f"{stem}_residuals.c", "-lm")
    run(*compiler("gcc"), *sources, "-o", "example", cwd=tmp_path)
    assert "5000 samples" in run(tmp_path / "example")


@_SAMPLE
def test_only_constants_and_its_own_functions(make: programs.Maker, tmp_path: Path) -> None:
    """No heap, no data that changes, no library but the one that a law needs."""
    if shutil.which("nm") is None:
        pytest.skip("nm is not installed")
    program = make()
    stem = generate(program, tmp_path)
    run(*compiler("gcc"), "-O2", "-c", f"{stem}_residuals.c", "-o", "out.o", cwd=tmp_path)
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
        *compiler("gcc"), "-E", "-P", f"-D{stem.upper()}_FLOAT", f"{stem}_residuals.c", cwd=tmp_path
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
