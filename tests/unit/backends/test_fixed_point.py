"""Whole numbers: as near to double as is said, in C as in Python, and refused where unproven."""

from __future__ import annotations

import math
import re
import shutil
from functools import cache
from pathlib import Path

import pytest

import bondgraph
from bondgraph.algebra import cubic_tanh
from bondgraph.backends.identifiers import snake
from bondgraph.backends.parts import begun
from bondgraph.cli.main import main
from bondgraph.compilation import Compilation
from bondgraph.compile_options import WrongOption
from bondgraph.ir.fixed_program import FixedProgram
from bondgraph.text.diagnostic import CompileError
from tests.sampled import Sampled
from tests.unit.backends.compilers import WARNINGS, compiler, run
from tests.unit.backends.fixed_models import RANGES, Ranges
from tests.unit.backends.whole_numbers import InC, Whole, largest_error, rows

_MODELS = Path(__file__).parents[3] / "models"
_ROWS = 700
_MISSING = sorted({p.stem for p in _MODELS.glob("*.bg")} - RANGES.keys())


@cache
def compiled(model: str) -> Compilation:
    path = _MODELS / f"{model}.bg"
    return bondgraph.compile(path, real="fixed", ranges=RANGES[model], targets=["c"])


@cache
def written(model: str) -> FixedProgram:
    return compiled(model).fixed_program


def inline(body: str, ranges: Ranges, **options: float) -> FixedProgram:
    text = f"bg 1\nmodel M {{\n{body}\n}}"
    c = bondgraph.compile(text=text, real="fixed", ranges=ranges, targets=["c"])
    return c.with_options(**options).fixed_program  # type: ignore[arg-type]


def refused(body: str, ranges: Ranges) -> list[tuple[str, str, str]]:
    """What is said against whole numbers: message, the line of its place, and what to do."""
    with pytest.raises(CompileError) as caught:
        inline(body, ranges)
    found = [d for d in caught.value.diagnostics if d.code == "no-fixed-point"]
    assert found
    return [
        (d.message, d.labels[0].span.source.text.splitlines()[d.labels[0].span.line - 1], d.help)
        for d in found
    ]


# --------------------------------------------------------------------------- the error


@pytest.mark.parametrize("model", RANGES)
def test_a_residual_is_as_near_to_double_as_is_said(model: str) -> None:
    """Over samples at their limits, in jumps and at random; the bound is no empty one."""
    fixed = written(model)
    found = largest_error(fixed, list(rows(fixed, _ROWS, 1)))
    hours = _ROWS / fixed.program.rate / 3600.0
    for name, own in fixed.residuals.items():
        bound = own.fixed + hours * own.hourly
        assert 0.05 * bound < found[name] <= bound, name
        assert own.fixed < 2e-6 * own.largest


def test_the_drift_of_an_integral_is_as_slow_as_is_said() -> None:
    """All samples such that each rounding of what is integrated goes the same way."""
    fixed = written("drive")
    rate = next(r for r in fixed.bits if r.name == "r2_rate")
    whole, bits = Whole(fixed), fixed.bits[rate]
    coefs = {"m__me__we": 0.001 / 0.04 / 24.0, "m__wh__ws": -25.0 * 0.001 / 0.04 / 24.0}
    row = dict.fromkeys(fixed.samples, 0)
    row |= {"m__me__we": (1 << 29) - 7, "m__wh__ws": -(1 << 29) + 5}
    exact = sum(c * math.ldexp(row[n], -fixed.samples[n].bits) for n, c in coefs.items())
    for _ in range(2000):
        whole.step(row)
    q = next(g.state for b in fixed.blocks for g in b.guards)
    off = abs(math.ldexp(whole.values[q], -bits) - (24.0 * 2000 - 12.0) * exact)
    r2 = fixed.residuals["r2"]
    assert r2.hourly > 0.0
    # tanh is as steep as its argument at most, and its factor in r2 is 0.8, twice at a jump
    assert 0.8 * off <= 2000 / 1000.0 / 3600.0 * r2.hourly


def test_an_integral_that_runs_away_starts_its_residual_anew() -> None:
    body = (
        "input u : 1\nparam g = 3 N/m\nlet x = int(w)\nSe:F -> 1:v\n"
        "v { -> I:m = 2 kg; -> R:s { e = g*u*x }; -> Df:w }"
    )
    ranges = {"F": (-8.0, 8.0), "u": (-1.0, 1.0), "w": (-1.0, 1.0)}
    [(message, _, help)] = refused(body, ranges)
    assert "integral" in message
    [name] = re.findall(r"--range (\w+)=", help)
    fixed = inline(body, ranges | {name: (-0.5, 0.5)})
    whole = Whole(fixed)
    row = {"F": 0, "u": 0, "w": fixed.samples["w"].most}  # 1 m/s: half a metre after 500 samples
    ends = [k for k in range(1500) if not whole.step(row)["r1"][1] and whole.age == [0]]
    assert len(ends) == 2 and 490 < ends[0] < 510 and ends[1] - ends[0] in (ends[0], ends[0] + 1)


@pytest.mark.parametrize("bits", [3, 15, 26, 27])
def test_tanh_is_as_near_as_is_said(bits: int) -> None:
    unit = 2.0**cubic_tanh.BITS
    size = min(9 << bits, (1 << 31) - 1)
    worst = max(
        abs(cubic_tanh.cubic_tanh(x, bits) / unit - math.tanh(x / 2.0**bits))
        for x in range(-size, size, max(1, size // 40_000))
    )
    assert worst <= cubic_tanh.BOUND
    assert bits == 3 or worst > 0.5 * cubic_tanh.BOUND


@pytest.mark.parametrize(("bandwidth", "rate"), [(1.0, 1000.0), (200.0, 1000.0), (3.0, 50.0)])
def test_other_filters_keep_their_bounds(bandwidth: float, rate: float) -> None:
    c = compiled("dc_motor").with_options(bandwidth=bandwidth, rate=rate)
    fixed = c.fixed_program
    found = largest_error(fixed, list(rows(fixed, _ROWS, 2)))
    for name, own in fixed.residuals.items():
        assert 0.02 * own.fixed < found[name] <= own.fixed


def test_observers_keep_their_bounds() -> None:
    fixed = compiled("dc_motor").with_options(form="observer").fixed_program
    assert all(r.follows for r in fixed.program.residuals)
    found = largest_error(fixed, list(rows(fixed, _ROWS, 2)))
    for name, own in fixed.residuals.items():
        assert 0.02 * own.fixed < found[name] <= own.fixed


def test_products_and_quotients_keep_their_bounds() -> None:
    body = (
        "input u : 1\ninput n : 1\nparam R = 2 Ohm\nSe:U -> 1:i\n"
        "i { -> R:r { e = R*f*u*u/n }; -> I:L = 0.1 H; -> Df:y }"
    )
    ranges = {"U": (-5.0, 5.0), "u": (-3.0, 3.0), "n": (0.5, 4.0), "y": (-2.0, 2.0)}
    fixed = inline(body, ranges)
    found = largest_error(fixed, list(rows(fixed, _ROWS, 3)))
    own = fixed.residuals["r1"]
    assert 0.02 * own.fixed < found["r1"] <= own.fixed


_GEAR = """input T; input n; param J1 = 0.8; param J2 = 1.3; param R = 0.4
1:a { <- Se:T; -> I:J1; -> Df:w; -> MTF:g { f2 = n*f1 } -> b }
1:b { -> I:J2; -> R:f = R }"""
_TURNS = {"T": (-5.0, 5.0), "n": (0.5, 2.0), "w": (-3.0, 3.0)}


def test_laws_of_derivatives_keep_their_bounds() -> None:
    """n D(n w): what its first samples make is remembered, so that it is waited for."""
    fixed = inline(_GEAR, _TURNS)
    (info,) = fixed.program.residuals
    assert info.approximate and info.laws
    found = largest_error(fixed, list(rows(fixed, _ROWS, 2)))
    assert 0.001 * fixed.residuals["r1"].fixed < found["r1"] <= fixed.residuals["r1"].fixed


def test_laws_that_begin_at_once_come_to_the_same() -> None:
    c = bondgraph.compile(text=f"bg 1\nmodel M {{\n{_GEAR}\n}}", rate=100.0, bandwidth=2.0)
    first, later = Sampled(c.program), Sampled(begun(c.program))
    wait = begun(c.program).residuals[0].wait(0.02) / 0.02
    for k in range(round(wait) + 200):
        t = k / 100.0
        row = {"T": math.sin(t), "n": 1.2 + 0.5 * math.sin(3.0 * t), "w": 2.0 + math.cos(2.0 * t)}
        one, other = (run.step(row).residuals["r1"] for run in (first, later))
        if k > wait:
            assert other == pytest.approx(one, rel=1e-6, abs=1e-7)


# --------------------------------------------------------------------------- the code


@pytest.mark.parametrize("model", RANGES)
def test_c_does_what_the_instructions_say(model: str, tmp_path: Path) -> None:
    """Bit for bit, with bad samples between good ones; the sanitizer sees no overflow."""
    fixed = written(model)
    compiled(model).write(tmp_path)
    c, whole = InC(fixed, tmp_path, snake(fixed.program.name)), Whole(fixed)
    first, ever = min(fixed.samples), False
    for k, row in enumerate(rows(fixed, _ROWS, 4)):
        given = row | {k.name: 0 for k in fixed.program.knowns if k.name not in row}
        if k in (3, 60, 61):
            given[first] = -(2**31) if k % 2 else 2**31 - 1
        found = c.step(given)
        assert found == whole.step(given)
        ever |= any(valid for _, valid in found.values())
    assert ever


@pytest.mark.parametrize("name", ["gcc", "clang", "g++", "clang++"])
@pytest.mark.parametrize("model", ["dc_motor", "khepera", "hydraulic_actuator"])
def test_no_warning(model: str, name: str, tmp_path: Path) -> None:
    compiled(model).write(tmp_path)
    stem = snake(compiled(model).program.name)
    run(*compiler(name), *WARNINGS, "-O1", "-c", f"{stem}.c", "-o", "out.o", cwd=tmp_path)


@pytest.mark.skipif(shutil.which("arm-none-eabi-gcc") is None, reason="needs gcc-arm-none-eabi")
@pytest.mark.parametrize("model", RANGES)
def test_no_floating_point_on_a_controller(model: str, tmp_path: Path) -> None:
    compiled(model).write(tmp_path)
    stem = snake(compiled(model).program.name)
    for core in ("cortex-m0plus", "cortex-m3"):
        gcc = ("arm-none-eabi-gcc", "-std=c99", f"-mcpu={core}", "-mthumb", "-O2")
        run(*gcc, *WARNINGS, "-c", f"{stem}.c", "-o", "out.o", cwd=tmp_path)
        names = run("arm-none-eabi-nm", "--undefined-only", "out.o", cwd=tmp_path)
        assert not re.search(r"__aeabi_(c?[df]|[ul]*i?2[df])", names)
    text = (tmp_path / f"{stem}.c").read_text() + (tmp_path / f"{stem}.h").read_text()
    code = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    assert not re.search(r"\b(float|double)\b|math\.h", code)


@pytest.mark.skipif(shutil.which("riscv64-unknown-elf-gcc") is None, reason="needs its gcc")
@pytest.mark.parametrize("model", ["dc_motor", "khepera", "hydraulic_actuator"])
def test_no_floating_point_on_a_risc_v(model: str, tmp_path: Path) -> None:
    compiled(model).write(tmp_path)
    stem = snake(compiled(model).program.name)
    cores = ("-march=rv32imac", "-mabi=ilp32", "--specs=picolibc.specs")
    gcc = ("riscv64-unknown-elf-gcc", "-std=c99", *cores, "-O2")
    run(*gcc, *WARNINGS, "-c", f"{stem}.c", "-o", "out.o", cwd=tmp_path)
    names = run("riscv64-unknown-elf-nm", "--undefined-only", "out.o", cwd=tmp_path)
    assert not re.search(r"[sd]f[23]\b|[sd]f[sdt]i|si[sd]f", names)


def test_a_bad_sample_costs_the_residuals_that_see_it_only() -> None:
    fixed = written("dc_motor")
    whole = Whole(fixed)
    row = dict.fromkeys(fixed.samples, 0)
    for _ in range(600):
        found = whole.step(row)
    assert [valid for _, valid in found.values()] == [True, True]
    found = whole.step(row | {"U": fixed.samples["U"].most + 1})  # r2 does not read it
    assert [found["r1"], found["r2"][1]] == [(0, False), True]
    assert whole.age[0] == 0 and whole.age[1] == 601
    waited = 0
    while not found["r1"][1]:
        found, waited = whole.step(row), waited + 1
    settle = fixed.settle[0]
    assert settle is not None and waited == settle + 1


def test_an_encoder_runs_over_and_may_not_turn_too_far() -> None:
    fixed = written("khepera_built")
    plain = Whole(fixed)
    over = Whole(fixed)
    name = "m__1__motor"
    for k in range(700):
        row = dict.fromkeys((x.name for x in fixed.program.knowns), 0)
        turned = k % 4
        far = (turned + 2**31 - 2 + 2**31) % 2**32 - 2**31
        assert plain.step(row | {name: turned}) == over.step(row | {name: far})
    assert all(valid for _, valid in plain.step(row | {name: turned}).values())
    found = plain.step(row | {name: turned + fixed.samples[name].most + 1})
    assert {n: valid for n, (_, valid) in found.items()} == {"r1": False, "r2": True, "r3": True}


def test_the_readme_and_the_header_say_the_same() -> None:
    files = {a.path: a.text for a in compiled("dc_motor").artifacts if isinstance(a.text, str)}
    own = written("dc_motor").residuals["r1"]
    assert set(files) == {"motor.h", "motor.c", "CMakeLists.txt", "README.md"}
    assert f"times 2^{own.bits}, within {own.fixed:.2g} of double" in files["motor.h"]
    assert f"| `r1` | 2^{own.bits} | {own.largest:.3g} | {own.fixed:.2g} | none |" in (
        files["README.md"]
    )
    assert "MOTOR_FLOAT" not in "".join(files.values())


# ------------------------------------------------------------------------ what is refused


def test_every_signal_without_a_range_is_told_at_once() -> None:
    motor = (_MODELS / "dc_motor.bg").read_text()
    c = bondgraph.compile(text=motor, real="fixed", ranges={"U": (-12.0, 12.0)})
    with pytest.raises(CompileError) as caught:
        _ = c.fixed_program
    told = [d for d in caught.value.diagnostics if d.code == "no-fixed-point"]
    assert [re.findall("`(.*?)`", d.message)[0] for d in told] == ["load", "current", "speed"]
    assert "--range speed=LOW..HIGH` in rad/s" in told[-1].help


@pytest.mark.parametrize("model", _MISSING)
def test_what_whole_numbers_cannot_do_is_said(model: str) -> None:
    c = bondgraph.compile(_MODELS / f"{model}.bg")
    ranges = {k.path: (-1.0, 1.0) for k in c.program.knowns}
    ranges |= {s.name: (-1e-3, 1e-3) for s in c.program.states}
    with pytest.raises(CompileError) as caught:
        _ = c.with_options(real="fixed", ranges=ranges).fixed_program
    told = [d for d in caught.value.diagnostics if d.severity == "error"]
    assert {d.code for d in told} == {"no-fixed-point"}
    assert all(d.labels and d.help for d in told)


def test_a_divisor_that_can_be_zero_is_refused() -> None:
    body = "input n : 1\nparam R = 2 Ohm\nSe:U -> 1:i\ni { -> R:r = R/n; -> Df:y }"
    ranges = {"U": (-5.0, 5.0), "y": (-2.0, 2.0)}
    [(message, _, help)] = refused(body, ranges | {"n": (-0.5, 4.0)})
    assert "divides by `n`" in message and "do not hold 0" in help
    assert inline(body, ranges | {"n": (0.5, 4.0)}).residuals["r1"].fixed < 1e-5


def test_options_that_have_no_whole_numbers_are_told() -> None:
    for options in ({"extras": ["tests"]}, {"libm": True}):
        with pytest.raises(WrongOption):
            bondgraph.compile(_MODELS / "dc_motor.bg", real="fixed", **options)
    with pytest.raises(ValueError):
        bondgraph.compile(_MODELS / "dc_motor.bg", real="fixed", ranges={"U": (3.0, 2.0)})


# ------------------------------------------------------------------------ the command


def _limits_of(text: str) -> dict[str, tuple[float, float]]:
    found = re.findall(r"int32_t (\w+); .*times 2\^-?\d+, from (\S+) to (\S+) ", text)
    return {name: (float(low), float(high)) for name, low, high in found}


def test_ranges_come_from_a_log_and_from_options(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Twice the largest amount in the log, to the next power of two; an option goes before it."""
    log, model = tmp_path / "log.csv", str(_MODELS / "dc_motor.bg")
    log.write_text("t,load (N.m),U,current (mA),speed\n0,0.001,1,300,-5\n0.001,0.001,-3,,7\n")
    common = ["compile", model, "--real", "fixed", "--quiet", "-o", str(tmp_path / "out")]
    assert main([*common, "--ranges", str(log), "--range", "speed=0..1200 rad/min"]) == 0
    limits = _limits_of((tmp_path / "out" / "motor.h").read_text())
    assert limits["U"] == (-8.0, 8.0) and limits["current"] == (-1.0, 1.0)
    assert limits["load"] == (-0.00390625, 0.00390625) and limits["speed"] == (0.0, 20.0)
    log.write_text("t,load,U,current,speed\n0,0,1,300,-5\n0.001,0,-3,,7\n")
    assert main([*common, "--ranges", str(log)]) == 1
    told = " ".join(capsys.readouterr().err.split())
    assert "`load` has no range" in told and "give a log in which it is not always 0" in told
    assert main([*common, "--range", "speed=-3..4 A"]) == 1
    assert "not in A" in capsys.readouterr().err
    assert main([*common, "--range", "sped=-3..4"]) == 2
    assert "did you mean `speed`" in capsys.readouterr().err
    assert main([*common[:2], "--range", "speed=-3..4"]) == 1
    assert "for --real fixed only" in capsys.readouterr().err


def test_nothing_is_written_where_it_is_refused(tmp_path: Path) -> None:
    model, out = str(_MODELS / "slider_crank.bg"), tmp_path / "out"
    bounds = [w for n in ("T", "load", "speed") for w in ("--range", f"{n}=-1..1")]
    assert main(["compile", model, "--real", "fixed", *bounds, "-o", str(out)]) == 1
    assert not out.exists()
    for option in ("--with=tests", "--libm"):
        assert main(["compile", model, "--real", "fixed", option, "-o", str(out)]) == 1
    assert not out.exists()
