"""What the generated code does: C and Python alike, warm-up, bad samples, encoders, refusals."""

from __future__ import annotations

import math
import random
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import bondgraph
from bondgraph.backends.identifiers import snake
from bondgraph.backends.members import Member, derivatives, samples
from bondgraph.backends.parts import step_part
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import load
from tests.unit.backends import programs
from tests.unit.backends.compilers import (
    InC,
    compiler,
    exact_module,
    generate,
    python_module,
    python_self_test,
    run,
)

_SAMPLE = pytest.mark.parametrize("make", programs.ALL, ids=lambda m: m.__name__)
_OPTIONS = {"motor": (0.001, 20.0, 1.0), "ladder": (0.001, 20.0, 0.5)}


def _given(members: list[Member], values: random.Random) -> list[Any]:
    found: list[Any] = []
    for member in members:
        if member.type == "bool":
            found.append(values.random() < 0.5)
        elif member.type == "count":
            found.append(values.randrange(-(2**31), 2**31))
        else:
            numbers = tuple(values.uniform(0.1, 1.0) for _ in range(member.size or 1))
            found.append(numbers if member.size else numbers[0])
    return found


def _named(members: list[Member], values: list[Any]) -> dict[str, Any]:
    return {m.name: v for m, v in zip(members, values, strict=True)}


@_SAMPLE
def test_c_and_python_give_the_same_digits(make: programs.Maker, tmp_path: Path) -> None:
    program = make()
    stem = generate(program, tmp_path)
    module, in_c = python_module(tmp_path, stem), InC(program, tmp_path, stem)
    ours, theirs = Spelling(program, load("python")), Spelling(program, load("c"))
    unset = [f.name for f in program.params if f.default is None]
    parameters = module.Parameters(**{ours.params[name]: 0.75 for name in unset})
    monitor = module.Monitor(parameters)
    options = (1.0 / program.rate, program.bandwidth, program.time_unit)
    assert in_c.configure(*options, **{theirs.params[name]: 0.75 for name in unset}) == 0
    values = random.Random(7)
    names = [ours.residuals[r.name] for r in program.residuals]
    apart = exact_module(tmp_path, stem, module)
    exactly = apart.Exact(parameters)
    for _ in range(40):
        given = _given(samples(program, ours), values)
        found = monitor.step(module.Samples(**_named(samples(program, ours), given)))
        numbers, valid = in_c.step(**_named(samples(program, theirs), given))
        assert [getattr(found, n) for n in names] == pytest.approx(numbers, rel=1e-13, abs=1e-13)
        assert [n in found.valid for n in names] == valid
        given = _given(list(derivatives(program, ours)), values)
        given_exact = _named(list(derivatives(program, ours)), given)
        exact = exactly.residuals(apart.Derivatives(**given_exact))
        numbers = in_c.exact(**_named(list(derivatives(program, theirs)), given))
        same = pytest.approx(numbers, rel=1e-12, abs=1e-13, nan_ok=True)
        assert [getattr(exact, n) for n in names] == same


@_SAMPLE
def test_python_selftest_and_checks(make: programs.Maker, tmp_path: Path, root: Path) -> None:
    stem = generate(make(), tmp_path)
    told = python_self_test(tmp_path)
    assert told.endswith("PASS\n") and "FAIL" not in told
    run(sys.executable, "example/example.py", cwd=tmp_path)
    files = [f"{stem}.py", f"exact/{stem}_exact.py", "example/example.py", "tests/selftest.py"]
    config = ("--config", root / "pyproject.toml", "--no-cache")
    run(sys.executable, "-m", "ruff", "check", *config, *files, cwd=tmp_path)
    run(sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path, *files, cwd=tmp_path)


def test_python_module_needs_only_the_standard_library(tmp_path: Path) -> None:
    stem = generate(programs.functions(), tmp_path)
    code = f"import sys; sys.path[:0] = ['.']; import {stem}"
    subprocess.run([sys.executable, "-I", "-S", "-c", code], cwd=tmp_path, check=True)


def _both(tmp_path: Path) -> tuple[Any, InC]:
    program = programs.motor()
    stem = generate(program, tmp_path)
    in_c = InC(program, tmp_path, stem)
    assert in_c.configure(0.001, 20.0, 1.0) == 0
    module = python_module(tmp_path, stem)
    monitor = module.Monitor()
    return lambda **s: monitor.step(module.Samples(**s)), in_c


_GOOD = {"U": 1.0, "i": 0.05, "y": 1.0, "y2": 0.5}


def test_warm_up_lasts_as_long_as_said(tmp_path: Path) -> None:
    """5 time constants of 1/20 s at 1 kHz: valid 250 samples after the first one."""
    step, in_c = _both(tmp_path)
    for tick in range(260):
        assert ("r1" in step(**_GOOD).valid) is (tick >= 250)
        assert in_c.step(**_GOOD)[1] == [tick >= 250] * 2


def test_a_slower_filter_is_waited_for(tmp_path: Path) -> None:
    """A second at 20 rad/s, then 10 rad/s, which takes 250 samples longer to settle."""
    _, in_c = _both(tmp_path)
    for _ in range(1000):
        in_c.step(**_GOOD)
    memory = in_c.memory.raw
    assert in_c.configure(0.001, 10.0, 1.0) == 0
    in_c.memory.raw = memory
    assert [in_c.step(**_GOOD)[1] for _ in range(251)] == [[False] * 2] * 249 + [[True] * 2] * 2


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_bad_sample_stops_only_what_sees_it(bad: float, tmp_path: Path) -> None:
    step, in_c = _both(tmp_path)
    for _ in range(300):
        step(**_GOOD)
        in_c.step(**_GOOD)
    found, (values, valid) = step(**_GOOD | {"i": bad}), in_c.step(**_GOOD | {"i": bad})
    assert found.valid == {"r2"} and valid == [False, True]
    assert found.r1 == values[0] == 0.0
    found, (values, valid) = step(**_GOOD), in_c.step(**_GOOD)
    assert found.valid == {"r2"} and valid == [False, True]
    assert found.r1 == values[0] == pytest.approx(1.0 - 17.6 * 0.05)  # at rest on this sample
    for _ in range(250):
        found, (values, valid) = step(**_GOOD), in_c.step(**_GOOD)
    assert found.valid == {"r1", "r2"} and valid == [True, True]


def test_filter_is_the_one_that_was_meant(tmp_path: Path) -> None:
    """A step through 1/(p/20 + 1): 1 - exp(-20 t), to the last digits."""
    step, in_c = _both(tmp_path)
    quiet = {"U": 0.0, "i": 0.0, "y": 0.0, "y2": 0.0}
    step(**quiet)
    in_c.step(**quiet)
    for tick in range(1, 200):
        wanted = 1.0 - math.exp(-0.02 * tick)
        loud = quiet | {"U": 1.0}
        assert step(**loud).r1 == pytest.approx(wanted, rel=1e-13)
        assert in_c.step(**loud)[0][0] == pytest.approx(wanted, rel=1e-13)


@pytest.mark.parametrize(
    ("options", "params", "status", "message"),
    [
        ((0.001, 20.0, 1.0), {"R": math.nan}, 1, "parameter"),
        ((0.001, 20.0, 1.0), {"L": math.inf}, 1, "parameter"),
        ((0.0, 20.0, 1.0), {}, 2, "sample_time"),
        ((math.nan, 20.0, 1.0), {}, 2, "sample_time"),
        ((math.inf, 20.0, 1.0), {}, 2, "sample_time"),
        ((0.001, 0.0, 1.0), {}, 3, "bandwidth"),
        ((0.001, 1e5, 1.0), {}, 3, "bandwidth"),
        ((0.001, math.nan, 1.0), {}, 3, "bandwidth"),
        ((0.001, 20.0, -1.0), {}, 4, "time_unit"),
    ],
)
def test_configure_refuses(
    options: tuple[float, float, float],
    params: dict[str, float],
    status: int,
    message: str,
    tmp_path: Path,
) -> None:
    program = programs.motor()
    stem = generate(program, tmp_path)
    in_c = InC(program, tmp_path, stem)
    assert in_c.configure(*options, **params) == status
    for _ in range(300 if status != 4 else 0):
        assert in_c.step(**_GOOD)[1] == [False, False]  # nothing is valid after a refusal
    module = python_module(tmp_path, stem)
    sample_time, bandwidth, time_unit = options
    exact, parameters = exact_module(tmp_path, stem, module), module.Parameters(**params)
    with pytest.raises(ValueError, match=message):
        module.Monitor(parameters, sample_time=sample_time, bandwidth=bandwidth)
        exact.Exact(parameters, time_unit=time_unit)


def test_a_parameter_that_is_not_set_is_refused(tmp_path: Path) -> None:
    program = programs.encoder()
    stem = generate(program, tmp_path)
    assert InC(program, tmp_path, stem).configure(0.001, 20.0, 1.0) == 1
    with pytest.raises(TypeError):
        python_module(tmp_path, stem).Monitor(python_module(tmp_path, stem).Parameters())


def test_a_rate_above_the_one_of_the_code_is_refused(tmp_path: Path) -> None:
    """Terms were left out because they cannot be seen at 1 kHz; at 10 kHz they could."""
    from bondgraph.ir.program import Dropped

    program = programs.motor()._replace(dropped=(Dropped("r1", "i", 1, 1e-6),))
    stem = generate(program, tmp_path)
    in_c = InC(program, tmp_path, stem)
    assert in_c.configure(0.001, 20.0, 1.0) == 0
    assert in_c.configure(0.01, 20.0, 1.0) == 0
    assert in_c.configure(0.0001, 20.0, 1.0) == 2
    module = python_module(tmp_path, stem)
    module.Monitor(sample_time=0.001)
    with pytest.raises(ValueError, match="sample_time"):
        module.Monitor(sample_time=0.0001)


def test_counter_runs_over(tmp_path: Path) -> None:
    """Counts on both sides of 2^31 are neighbours."""
    program = programs.encoder()
    stem = generate(program, tmp_path)
    in_c = InC(program, tmp_path, stem)
    assert in_c.configure(0.001, 2000.0, 1.0, **{"lambda": 1.0}) == 0
    module = python_module(tmp_path, stem)
    monitor = module.Monitor(module.Parameters(lambda_=1.0), bandwidth=2000.0)
    counts = [2**31 - 2, 2**31 - 1, -(2**31), -(2**31) + 1, 2**31 - 1, -(2**31) + 5]
    smooth = 0.0
    for count, angle in zip(counts, [0, 1, 2, 3, 1, 7], strict=True):
        smooth += (1.0 - math.exp(-2.0)) * (angle - smooth)
        found = monitor.step(module.Samples(int_=count, class_=0.0, register=False)).r1
        values, _ = in_c.step(int_=count, class_=0.0, register_=False)
        assert found == pytest.approx(smooth, rel=1e-12)
        assert values[0] == pytest.approx(smooth, rel=1e-12)


def test_exponential_is_exact(tmp_path: Path) -> None:
    module = python_module(tmp_path, generate(programs.motor(), tmp_path))
    values = random.Random(3)
    for x in [0.0, -1e-9, -1.0, 0.35, -0.35, 700.0, -700.0] + [
        values.uniform(-40.0, 40.0) for _ in range(500)
    ]:
        assert module._exponential(x) == pytest.approx(math.exp(x), rel=4e-16)
    assert module._exponential(-2000.0) == 0.0
    assert module._exponential(2000.0) == math.inf
    assert math.isnan(module._exponential(math.nan))


@pytest.mark.parametrize("model", ["khepera", "dc_motor", "two_tanks", "oven"])
def test_the_constant_coefficients_are_those_of_configure(model: str, tmp_path: Path) -> None:
    """Bit for bit, and once more in float to a rounding."""
    c = bondgraph.compile(f"models/{model}.bg")
    c.write(tmp_path)
    stem = snake(c.program.name)
    upper = stem.upper()
    spelling = Spelling(c.program, load("c"))
    members = [spelling.coefs[f.name] for f in step_part(c.program).coefs]
    same = " && ".join(f"near(made.{m}, {stem}_nominal_coefficients.{m})" for m in members)
    (tmp_path / "same.c").write_text(f"""
#include <math.h>
#include <string.h>
#include "{stem}.h"
static int near({stem}_real x, {stem}_real y)
{{
    return sizeof x == 8 ? x == y : fabs((double)(x - y)) <= 1e-5 * fabs((double)y);
}}
int main(void)
{{
    {stem}_parameters p;
    {stem}_coefficients made;
    {stem}_nominal(&p);
    return !({stem}_configure(&made, &p, {upper}_SAMPLE_TIME, {upper}_BANDWIDTH) == {upper}_OK
        && {same}
        && memcmp(made.settle, {stem}_nominal_coefficients.settle, sizeof made.settle) == 0
        && made.longest == {stem}_nominal_coefficients.longest);
}}
""")
    for real in ((), (f"-D{upper}_FLOAT",)):
        options = ("-O2", "-ffp-contract=off", *real, "same.c", f"{stem}.c", "-lm", "-o", "same")
        run(*compiler("gcc"), *options, cwd=tmp_path)
        run(tmp_path / "same")
