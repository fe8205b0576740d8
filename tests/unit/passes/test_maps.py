"""Tables of two inputs against SciPy, forwards and read for either input, in every form of code."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
import sympy
from scipy.interpolate import RegularGridInterpolator
from scipy.optimize import brentq

from bondgraph.cli.result import result
from bondgraph.compilation import Compilation
from bondgraph.ir.program import Ref
from bondgraph.runtime.batch import Lanes
from bondgraph.text.source import Source
from tests.sampled import Sampled
from tests.simulation.machines import read
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

_E, _W = (0.0, 4.0, 10.0), (1.0, 2.0, 5.0)
_FLOW = ((1.0, 2.0, 3.0), (2.0, 4.0, 7.0), (5.0, 8.0, 14.0))  # a row for each of _E
_FILE = "pressure\\opening, 1, 2, 5\n0, 1, 2, 3\n4, 2, 4, 7\n10, 5, 8, 14\n"
_TURNED = ",0;4;10\n1 1 2 5\n2 2 4 8\n5 3 7 14\n"
_RISES = ",1,2,5\n0,-1,-2,-3\n4,-2,-4,-7\n10,-5,-8,-14\n"

_inside = RegularGridInterpolator((_E, _W), np.array(_FLOW))


def _flow(e: float, w: float) -> float:
    """What the map has to be, by SciPy; the last value is kept beyond the ends."""
    return float(_inside((np.clip(e, _E[0], _E[-1]), np.clip(w, _W[0], _W[-1])))[()])


def _pressure(y: float, w: float) -> float:
    """The pressure at which the flow is y; NaN where the map stays at an end."""
    if not _flow(_E[0], w) < y < _flow(_E[-1], w):
        return np.nan
    return float(brentq(lambda e: _flow(e, w) - y, _E[0], _E[-1], xtol=1e-15, rtol=1e-15))


def _compiled(folder: Path, text: str, body: str) -> Compilation:
    (folder / "map.csv").write_text(text)
    model = folder / "m.bg"
    model.write_text(f"bg 1\nmodel M {{\n{body}\n}}\n")
    return Compilation(Source(str(model), model.read_text()))


#: A tank of 2 that a valve with an opening w empties: the pressure e is read off the flow y.
_LAWS = {
    "first input": (_FILE, 'f = table("map.csv", e, w)'),
    "second input": (_TURNED, 'f = table("map.csv", w, e)'),
    "falling": (_RISES, 'f = -table("map.csv", e, w)'),
}
_laws = pytest.mark.parametrize("law", _LAWS)


def _valve(folder: Path, law: str) -> Compilation:
    text, equation = _LAWS[law]
    valve = f"1:s {{ -> R:v {{ {equation} }}; -> Df:y }}"
    return _compiled(
        folder, text, f"  param b = 2\n  input w\n  0:n {{ <- Sf:i; -> C:b; -> {valve} }}"
    )


def _outlet(folder: Path) -> Compilation:
    """The same with the pressure measured: 0 = i - b D(e) - f(e, w), the map as it stands."""
    law = 'f = table("map.csv", e, w)'
    return _compiled(
        folder, _FILE, f"  param b = 2\n  input w\n  0:n {{ <- Sf:i; -> C:b; -> R:v {{ {law} }}; "
        "-> De:y }"
    )  # fmt: skip


_STEP = 1e-6
_POINTS = list(product((1.5, 2.1, 3.01, 4.5, 6.7, 7.5, 13.0, 20.0), (0.5, 1.3, 2.7, 4.9, 8.0)))


def _drained(y: float, w: float) -> float:
    """i - y - 2 D(e) for i = 1, D(y) = 0.1, D(w) = 0.05, its derivative as a difference."""
    before, after = (_pressure(y + s * 0.1, w + s * 0.05) for s in (-_STEP, _STEP))
    return 1 - y - 2 * (after - before) / (2 * _STEP)


def _left(y: float, w: float) -> float:
    """i - 2 D(y) - f(y, w) for the same."""
    return 1 - 2 * 0.1 - _flow(y, w)


def _agree(c: Compilation, folder: Path, expected: Callable[[float, float], float]) -> None:
    """The exact forms of C, Python and both of our own at all points; C and Python bit for bit."""
    program = c.program
    stem = generate(program, folder)
    in_c = InC(program, folder, stem)
    assert in_c.configure(1e-3, program.bandwidth, 1.0) == 0
    module = python_module(folder, stem)
    apart = exact_module(folder, stem, module)
    python = apart.Exact(module.Parameters())
    wide = Lanes(program, {})
    y, w = np.array(_POINTS).T
    rates = {name: {k.name: k.highest for k in program.knowns}[name] > 0 for name in ("y", "w")}
    given: dict[tuple[str, int], Any] = {("i", 0): 1.0, ("y", 0): y, ("w", 0): w}
    given |= {(name, 1): x for name, x in (("y", 0.1), ("w", 0.05)) if rates[name]}
    wide.values |= {Ref("known", *name): np.asarray(x)[()] for name, x in given.items()}
    with np.errstate(all="ignore"):
        wide.run(program.exact)
    for at, lane in zip(_POINTS, wide.values[Ref("residual", "r1")], strict=True):
        known = {"i": {0: 1.0}, "y": {0: at[0], 1: 0.1}, "w": {0: at[1], 1: 0.05}}
        members = {
            "i": 1.0,
            "y": [at[0], 0.1] if rates["y"] else at[0],
            "w": [at[1], 0.05] if rates["w"] else at[1],
        }
        one = in_c.exact(**{n: tuple(x) if isinstance(x, list) else x for n, x in members.items()})
        other = python.residuals(apart.Derivatives(**members)).r1
        assert np.array_equal(one[0], other, equal_nan=True), at
        for found in (Sampled(program).exact(known)["r1"], other, lane):
            assert found == pytest.approx(expected(*at), rel=1e-7, abs=1e-7, nan_ok=True), at


@_laws
def test_a_map_is_read_for_either_input(tmp_path: Path, law: str) -> None:
    _agree(_valve(tmp_path, law), tmp_path, _drained)


def test_a_map_keeps_its_last_values_beyond_its_ends(tmp_path: Path) -> None:
    _agree(_outlet(tmp_path), tmp_path, _left)


@_laws
def test_every_compile_with_a_map_checks_itself(tmp_path: Path, law: str) -> None:
    c = _valve(tmp_path, law)
    assert c.verification.method.startswith("exact") and not c.report.diagnostics
    assert set(c.signatures.signature("r1")) == {"i", "b", "w", "y"}


@pytest.mark.parametrize("name", COMPILERS)
def test_maps_compile_without_a_warning(tmp_path: Path, name: str) -> None:
    for c in (_valve(tmp_path, "first input"), _outlet(tmp_path)):
        stem = generate(c.program, tmp_path)
        text = (tmp_path / f"{stem}.c").read_text()
        assert "along(" in text
        source = tmp_path / f"{stem}.c"
        run(*compiler(name), *WARNINGS, "-c", source, "-o", tmp_path / "o")


@_laws
def test_the_text_for_programs_is_the_map(tmp_path: Path, law: str) -> None:
    arr = cast("list[dict[str, Any]]", result(_valve(tmp_path, law), ())["arrs"])[0]
    y, w = sympy.symbols("y w")
    # D stands for its argument here: SymPy takes the derivative of nan for zero
    names = {"i": 1, "y": y, "w": w, "b": 2, "D": lambda x, _: x}
    expr = sympy.parse_expr(arr["expr"], local_dict=names)
    for at in _POINTS[::3]:
        found = expr.subs({y: sympy.Rational(str(at[0])), w: sympy.Rational(str(at[1]))})
        value = float("nan") if found is sympy.nan else float(found)
        assert value == pytest.approx(1 - at[0] - 2 * _pressure(*at), abs=1e-9, nan_ok=True), at


_SCENARIO = """
duration = 20
sampling.rate = 1000
initial."b.q" = 8
inputs.i = "4 + 2*sin(2*t)"
inputs.w = "2.5 + 2*sin(t)"
"""


@_laws
def test_a_simulated_machine_is_silent_until_it_breaks(tmp_path: Path, law: str) -> None:
    # the flow stays within the map: e from 2.2 to 6.9, over the knots 4 of e and 2 of w
    c = _valve(tmp_path, law)
    engine = c.engine(native=True)

    def residual(fault: str) -> Any:
        engine.reset()
        log = c.simulate(read(c, _SCENARIO + fault)).log
        batch = engine.run(np.column_stack([log.columns[k.path] for k in engine.signals]))
        assert batch.valid[2000:].all()
        return np.abs(batch.value[2000:, 0]).max()

    quiet = residual("")
    assert quiet < 0.02  # of a flow of 4; the laws bend within a sample
    fault = '[[fault]]\nof = "b"\nchange = "*= 1.2"\nat = 5'
    assert residual(fault) > 10 * quiet
