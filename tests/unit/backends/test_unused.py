"""Nothing is computed that nobody reads: no unused local in C or Python, whatever the model."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import bondgraph
from bondgraph.ir.program import Program, Ref
from tests.unit.backends.compilers import (
    INCLUDES,
    WARNINGS,
    compiler,
    generate,
    run,
    self_test,
    sources,
)

CELLS = """bg 1
model Cell { port a : in any; port b : out any; param R = 1.1; param L = 0.3
    a -> 1:i -> 0:n -> b; i -> R:r LAW; n -> C:L }
model M { Cell:c[COUNT]; Se:U -> c[1..COUNT] -> 0:o; o -> R:x = 1; o -> De:y }
"""

LINEAR, ORIFICE = "= R", "{ f = R*ssqrt(e) }"

#: Law and number of cells: short enough for everything; without step; a tape without step, and
#: neither exact nor step.
MODELS = ((LINEAR, 3), (LINEAR, 20), (LINEAR, 120), (ORIFICE, 3), (ORIFICE, 15), (ORIFICE, 40))


def made(law: str, count: int, folder: Path) -> Program:
    """The program of a chain of cells."""
    path = folder / "cells.bg"
    path.write_text(CELLS.replace("LAW", law).replace("COUNT", str(count)))
    return bondgraph.compile(path).program


def reads(value: object) -> list[Ref]:
    """All names in an expression."""
    if isinstance(value, Ref):
        return [value]
    return [r for part in value for r in reads(part)] if isinstance(value, tuple) else []


@pytest.mark.parametrize(("law", "count"), MODELS)
def test_no_unused_local(law: str, count: int, tmp_path: Path) -> None:
    program = made(law, count, tmp_path)
    stem = generate(program, tmp_path)
    for name in ("gcc", "clang"):
        if name == "gcc" or count < 15:
            for real in ((), (f"-D{stem.upper()}_FLOAT",)):
                options = (*compiler(name), *WARNINGS, *real, "-O0", "-c", "-o", "out.o")
                for source in (*sources(stem), "tests/selftest.c"):
                    run(*options, *INCLUDES, source, cwd=tmp_path)
    files = [tmp_path / f"{stem}.py", tmp_path / "exact" / f"{stem}_exact.py"]
    trees = [ast.parse(file.read_text()) for file in files]
    for function in (n for t in trees for n in ast.walk(t) if isinstance(n, ast.FunctionDef)):
        names = [n for n in ast.walk(function) if isinstance(n, ast.Name)]
        stored = {n.id for n in names if isinstance(n.ctx, ast.Store)}
        assert stored <= {n.id for n in names if isinstance(n.ctx, ast.Load)} | {"_"}, function.name


@pytest.mark.parametrize(("law", "count"), MODELS)
def test_every_coefficient_and_parameter_is_read(law: str, count: int, tmp_path: Path) -> None:
    program = made(law, count, tmp_path)
    configured = [r for s in program.configure for r in reads(tuple(s)[1:])]
    run_time = [
        r for s in (*program.exact, *program.first, *program.step) for r in reads(tuple(s)[1:])
    ]
    arrays = {t.array for s in program.exact for t in getattr(s, "terms", ())}
    read = {r.name for r in (*configured, *run_time) if r.space == "coef"} | arrays
    assert {c.name for c in program.coefs} == read
    assert {p.name for p in program.params} == {r.name for r in configured if r.space == "param"}


def test_a_residual_too_long_for_exact_says_so(tmp_path: Path) -> None:
    program = made(ORIFICE, 40, tmp_path)
    (info,) = program.residuals
    assert info.unwritten == "written out it takes more than 20000 operations"
    assert info.unavailable == "its order 40 is above 12" and info.order == 40
    assert program.exact == () and program.params == () and program.coefs == ()
    stem = generate(program, tmp_path)
    for file in ("README.md", f"{stem}.h", f"{stem}.py"):
        assert info.unwritten in " ".join((tmp_path / file).read_text().split())
    assert "PASS exact r1" in self_test(tmp_path, stem)


def test_a_long_chain_of_laws_is_written_and_right(tmp_path: Path) -> None:
    program = made(ORIFICE, 16, tmp_path)
    assert program.residuals[0].unwritten == "" and program.residuals[0].order == 16
    stem = generate(program, tmp_path)
    assert "PASS exact r1" in self_test(tmp_path, stem)
