"""A table that is read from y to x: no value where it stays at its end, in every form of code."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
import sympy

from bondgraph.cli.result import result
from bondgraph.compilation import Compilation
from bondgraph.ir.program import Ref
from bondgraph.runtime.batch import Lanes
from bondgraph.text.source import Source
from tests.sampled import Sampled
from tests.unit.backends.compilers import (
    COMPILERS,
    WARNINGS,
    InC,
    compiler,
    exact_module,
    generate,
    python_module,
    run,
)

_X, _Y = (0.0, 4.0, 10.0), (3.0, 3.4, 4.2)
_ROWS = "0,3\n4,3.4\n10,4.2\n"
_RATE = 1000


def _compiled(folder: Path, body: str) -> Compilation:
    (folder / "curve.csv").write_text(_ROWS)
    model = folder / "m.bg"
    model.write_text(f"bg 1\nmodel M {{\n{body}\n}}\n")
    return Compilation(Source(str(model), model.read_text()))


def _battery(folder: Path) -> Compilation:
    law = 'e = table("curve.csv", q)'
    return _compiled(folder, f"  0:t {{ <- Sf:i; -> C:b(q0 = 5) {{ {law} }}; -> De:u }}")


def _valve(folder: Path) -> Compilation:
    """A tank of 2 that a valve f = table(e) empties: i - y - 2 D(e), with e read off y."""
    law = 'f = table("curve.csv", e)'
    valve = f"1:s {{ -> R:v {{ {law} }}; -> Df:y }}"
    return _compiled(folder, f"  param b = 2\n  0:n {{ <- Sf:i; -> C:b; -> {valve} }}")


def _expected(y: float) -> float:
    """i - y - 2 D(e) for i = 1 and D(y) = 0.1, by hand; NaN where the table stays at an end."""
    if not _Y[0] < y < _Y[-1]:
        return np.nan
    slope = (4 - 0) / (3.4 - 3) if y < 3.4 else (10 - 4) / (4.2 - 3.4)
    return 1 - y - 2 * slope * 0.1


@pytest.mark.parametrize("native", [True, False], ids=["C", "Python"])
def test_a_battery_charged_beyond_its_table_is_not_called_faulty(
    tmp_path: Path, native: bool
) -> None:
    # i = D(q) with q read off u: beyond 10 As u stays at 4.2 V while i goes on, and a table that
    # kept its last value would say 0 = i. Full at 2.5 s, too full until 5.5 s.
    t = np.arange(9 * _RATE) / _RATE
    current = np.where(t < 4, 2.0, -2.0)
    charge = 5 + np.where(t < 4, 2 * t, 16 - 2 * t)
    signals = {"i": current, "u": np.interp(charge, _X, _Y)}
    engine = _battery(tmp_path).engine(native=native)
    batch = engine.run(np.column_stack([signals[k.path] for k in engine.signals]))
    valid, value = batch.valid[:, 0], batch.value[:, 0]
    assert not valid[charge >= 10].any()
    assert valid[1000:2400].all() and valid[6100:].all()
    # at 4 As the slope changes within a sample, while the derivative takes the filter's time
    steady = valid & (np.abs(charge - 4) > 1)
    assert np.abs(value[steady]).max() < 1e-3 * 4  # of the terms: 2 A each, once settled


_FLOWS = (2.0, 3.0, 3.0001, 3.2, 3.39, 3.5, 4.0, 4.1999, 4.2, 7.0)


def test_c_python_and_our_own_runs_have_a_value_at_the_same_readings(tmp_path: Path) -> None:
    program = _valve(tmp_path).program
    stem = generate(program, tmp_path)
    c = InC(program, tmp_path, stem)
    assert c.configure(1 / _RATE, program.bandwidth, 1.0) == 0
    module = python_module(tmp_path, stem)
    apart = exact_module(tmp_path, stem, module)
    python = apart.Exact(module.Parameters())
    wide = Lanes(program, {})
    given = {("i", 0): 1.0, ("y", 0): np.array(_FLOWS), ("y", 1): 0.1}
    wide.values |= {Ref("known", *name): np.asarray(x)[()] for name, x in given.items()}
    with np.errstate(all="ignore"):
        wide.run(program.exact)
    for y, lane in zip(_FLOWS, wide.values[Ref("residual", "r1")], strict=True):
        own = Sampled(program).exact({"i": {0: 1.0}, "y": {0: y, 1: 0.1}})["r1"]
        one = c.exact(i=1.0, y=(y, 0.1))[0]
        other = python.residuals(apart.Derivatives(i=1.0, y=[y, 0.1])).r1
        for found in (own, one, other, lane):
            assert found == pytest.approx(_expected(y), abs=1e-9, nan_ok=True), y


@pytest.mark.parametrize("name", COMPILERS)
def test_the_gap_compiles_without_a_warning(tmp_path: Path, name: str) -> None:
    stem = generate(_valve(tmp_path).program, tmp_path)
    text = (tmp_path / f"{stem}.c").read_text()
    assert "NAN" in text and "csv_inverse" in text
    run(*compiler(name), *WARNINGS, "-c", tmp_path / f"{stem}.c", "-o", tmp_path / "o")


def test_the_text_for_programs_has_no_value_from_the_ends_on(tmp_path: Path) -> None:
    arr = cast("list[dict[str, Any]]", result(_valve(tmp_path), ())["arrs"])[0]
    y = sympy.Symbol("y")
    # D stands for its argument here: SymPy takes the derivative of nan for zero
    names = {"i": 1, "y": y, "b": 2, "D": lambda x, _: x}
    expr = sympy.parse_expr(arr["expr"], local_dict=names)
    for at in _FLOWS:
        found = expr.subs({y: sympy.Rational(str(at))})
        value = float("nan") if found is sympy.nan else float(found)
        drop = np.interp(at, _Y, _X) if _Y[0] < at < _Y[-1] else np.nan
        assert value == pytest.approx(1 - at - 2 * drop, abs=1e-12, nan_ok=True), at


def test_the_signature_is_that_of_the_machine_within_the_table(tmp_path: Path) -> None:
    c = _valve(tmp_path)
    assert c.verification.method.startswith("exact")
    assert set(c.signatures.signature("r1")) == {"i", "b", "y"}
