"""Sensors that tell late and commands that arrive late, against signals shifted by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from bondgraph.algebra.symbolic import t
from bondgraph.compilation import Compilation, compile
from bondgraph.runtime.simulation.integrate import SimulationError
from bondgraph.runtime.simulation.run import Robot
from bondgraph.text.diagnostic import CompileError
from tests.simulation.machines import read
from tests.unit.backends.compilers import (
    COMPILERS,
    WARNINGS,
    InC,
    compiler,
    generate,
    python_module,
    run,
    self_test,
)

_RATE = 100
_TANK = """bg 1
model Tank {{
    input U
    param C = 2
    param R = 3
    Sf:pump = {command}
    0:tank {{ <- pump; -> C:C; -> R:R }}
    sensor level = {level}
    {more}
}}
"""


def _tank(command: str = "U", level: str = "tank.e", more: str = "", **options: Any) -> Compilation:
    text = _TANK.format(command=command, level=level, more=more)
    return compile(text=text, rate=options.pop("rate", _RATE), **options)


def _late(**options: Any) -> Compilation:
    return _tank("delay(U, 0.5 s)", "delay(tank.e, 2 s)", **options)


def _run(c: Compilation, native: bool = True, **columns: Any) -> Any:
    engine = c.engine(native=native)
    return engine.run(np.column_stack([columns[k.path] for k in engine.signals]))


def _signals(size: int) -> dict[str, Any]:
    draw = np.random.default_rng(7)
    return {name: np.cumsum(draw.normal(size=size)) for name in ("U", "level")}


# ------------------------------------------------------------------------------ relations


@pytest.mark.parametrize(
    ("command", "level", "relation"),
    [
        ("U", "tank.e", "U - level/R - C*D(level)"),
        ("delay(U, 0.5 s)", "tank.e", "delay(U, 0.5 s) - level/R - C*D(level)"),
        ("U", "delay(tank.e, 2 s)", "delay(U, 2 s) - level/R - C*D(level)"),
        ("delay(U, 500 ms)", "delay(tank.e, 2 s)", "delay(U, 2.5 s) - level/R - C*D(level)"),
        ("2*delay(delay(U, 1 s), 1/2*1 s)", "tank.e", "2*delay(U, 1.5 s) - level/R - C*D(level)"),
        ("delay(U, 0 s)", "delay(tank.e, 0 s)", "U - level/R - C*D(level)"),
    ],
)
def test_a_relation_is_looked_at_as_late_as_its_latest_sensor(
    command: str, level: str, relation: str
) -> None:
    c = _tank(command, level)
    assert c.residuals["r1"].text == relation
    assert c.verification.method.startswith("exact")
    assert c.signatures.signature("r1") == ("C", "R", "U", "level")


def test_each_relation_is_shifted_by_its_own_sensors() -> None:
    c = _tank("U", "delay(tank.e, 2 s)", "sensor other = delay(tank.e, 3 s); De:now <- tank")
    texts = [r.text for r in c.residuals]
    # one sensor gives the level, the others compare: 3 s, 2 s, and the first with the balance
    assert len(texts) == 3
    pairs = {frozenset(n for n in ("level", "other", "now") if n in text) for text in texts}
    for text in texts:
        if "other" in text:
            assert "delay(other" not in text  # the latest one is there as it is
        elif "level" in text:
            assert "delay(level" not in text
    assert all(pairs)


def test_a_controller_acts_on_an_old_reading() -> None:
    # u = K (r - y) is logged, and pumps 0.5 s later; y2 is told 1.5 s late
    c = compile(Path(__file__).parents[2] / "cases" / "signatures" / "delayed.bg")
    assert [r.text for r in c.residuals] == [
        "pump + delay(u, 2 s) - (delay(y1, 1.5 s) - y2)/R1 - c1*D(delay(y1, 1.5 s))",
        "(delay(y1, 1.5 s) - y2)/R1 - y2/R2 - c2*D(y2)",
        "u - K*(r - y1)",
    ]
    assert "u" not in c.signatures.signature("r1")  # who receives a reading receives this number


def test_relations_of_past_values_in_other_notations() -> None:
    relation = _late().residuals["r1"]
    assert r"\mathrm{delay}\left(U, \frac{5}{2}\,\mathrm{s}\right)" in relation.latex
    import sympy

    (late,) = [f for f in relation.expr.atoms(sympy.core.function.AppliedUndef) if f.args[0] != t]
    assert late.func.__name__ == "U" and late.args[0] == t - sympy.Rational(5, 2)
    assert relation.sensitivity("U") == 1
    # 2 (10 - 5/2): the error is one of U, as large as what U was then
    assert relation.effect("U", {"U": 2 * t, "level": 0.0}, at=10.0) == pytest.approx(20.0)


# ------------------------------------------------------------------------------ code


@pytest.mark.parametrize("native", [True, False], ids=["C", "Python"])
def test_past_values_are_those_of_a_log_shifted_by_hand(native: bool) -> None:
    columns = _signals(1500)
    late = _run(_late(), native, **columns)
    shift = 250  # samples: 2.5 s
    own = {"U": columns["U"][:-shift], "level": columns["level"][shift:]}
    plain = _run(_tank(), native, **own)
    assert not late.valid[:shift].any() and plain.valid.any()
    assert np.array_equal(late.valid[shift:], plain.valid)
    assert np.array_equal(late.value[shift:], plain.value)


@pytest.mark.parametrize("seconds", [0.004, 0.0137, 0.996, 1.23456])
def test_between_two_samples_is_a_straight_line(seconds: float) -> None:
    columns = _signals(800)
    c = _tank(f"delay(U, {seconds} s)")
    found = _run(c, **columns)
    back = seconds * _RATE
    whole = int(back)
    u = columns["U"]
    k = np.arange(whole + 1, len(u))
    past = u[k - whole] + (back - whole) * (u[k - whole - 1] - u[k - whole])
    plain = _run(_tank(), U=past, level=columns["level"][whole + 1 :])
    assert np.allclose(found.value[whole + 1 :], plain.value, rtol=0, atol=1e-11 * np.abs(u).max())
    assert not found.valid[: whole + 1].any()


def test_c_and_python_remember_the_same_digits() -> None:
    columns = _signals(2500)
    columns["U"][[1000, 1001]] = np.nan
    columns["level"][2000] = np.nan
    c = _tank("delay(U, 0.1234 s)", "delay(tank.e, 1.007 s)")
    one, other = (_run(c, native, **columns) for native in (True, False))
    assert np.array_equal(one.valid, other.valid) and np.array_equal(one.value, other.value)
    # a bad sample comes out as late as it has to: 1.1304 s, between samples 113 and 114 of the past
    settled = one.valid[:, 0].argmax()
    assert 0 < settled < 1000 and one.valid[settled : 1000 + 113, 0].all()
    assert not one.valid[1000 + 113, 0] and one.valid[1999, 0] and not one.valid[2000, 0]


def test_the_code_says_how_fast_it_may_be_sampled(tmp_path: Path) -> None:
    program = _late().program
    stem = generate(program, tmp_path)
    in_c, module = InC(program, tmp_path, stem), python_module(tmp_path, stem)
    good = 0
    for sample_time, fits in ((0.01, True), (0.02, True), (0.3, True), (0.0099, False)):
        status = in_c.configure(sample_time, 1.0, 1.0)
        assert (status == 0) == fits
        if not fits:
            with pytest.raises(ValueError, match="sample_time"):
                module.Monitor(sample_time=sample_time, bandwidth=1.0)
            continue
        monitor = module.Monitor(sample_time=sample_time, bandwidth=1.0)
        back = 2.5 / sample_time
        steps = 3 * round(back) + 60
        u, level = (x[:steps] for x in _signals(2000).values())
        for k in range(min(steps, len(u))):
            found = monitor.step(module.Samples(U=u[k], level=level[k]))
            values, valid = in_c.step(U=u[k], level=level[k])
            assert values[0] == found.r1 and valid[0] == ("r1" in found.valid)
            good += valid[0]
            assert not valid[0] or k >= back
    assert good


@pytest.mark.parametrize("name", COMPILERS)
def test_the_memory_compiles_without_a_warning(tmp_path: Path, name: str) -> None:
    stem = generate(_late().program, tmp_path)
    for option in ("", "-DTANK_FLOAT"):
        source = tmp_path / f"{stem}.c"
        flags = (*WARNINGS, *([option] if option else []))
        run(*compiler(name), *flags, "-c", source, "-o", tmp_path / "o")


def test_self_tests_run_beyond_a_short_memory(tmp_path: Path) -> None:
    c = _tank("delay(U, 0.05 s)", "delay(tank.e, 0.12 s)")
    stem = generate(c.program, tmp_path)
    assert "FAIL" not in self_test(tmp_path, stem, "-O2")
    from bondgraph.backends.golden import golden

    results = [v.results[0][0] for v in golden(c.program).step]
    assert not any(results[:17]) and all(results[17:])  # 0.17 s at 100 Hz


def test_a_follower_takes_over_what_is_remembered() -> None:
    columns = _signals(900)
    for native in (True, False):
        first = _late().engine(native=native)
        rows = np.column_stack([columns[k.path] for k in first.signals])
        first.run(rows[:600])
        second = first.configured({"R": 3.0})
        second.follow(first)
        assert np.array_equal(first.run(rows[600:]).value, second.run(rows[600:]).value)


def test_an_observer_says_why_it_is_none_and_step_filters_instead() -> None:
    c = _late(form="observer")
    assert c.observers["r1"] == "its signals are delayed"
    columns = _signals(1000)
    assert np.array_equal(_run(c, **columns).value, _run(_late(), **columns).value)


@pytest.mark.parametrize(
    "more",
    [
        "sensor th : rad = int(tank.e*1 rad) counts 24/turn",
        "input on : bool; 1:sw when on { -> R:x = 5 }; tank -> sw",
    ],
)
def test_a_switch_or_an_encoder_is_not_remembered(more: str) -> None:
    c = _tank("U", "delay(tank.e, 2 s)", more)
    late = [r for r, own in zip(c.program.residuals, c.residuals, strict=True)
            if "delay(on" in own.text or "delay(th" in own.text]  # fmt: skip
    assert late
    for info in late:
        assert info.unavailable == "a switch or an encoder in it would have to be remembered"
        assert not info.unwritten


def test_a_memory_without_end_is_refused() -> None:
    info = _tank("delay(U, 86400 s)").program.residuals[0]
    assert info.unavailable == "8.6e+06 samples would have to be remembered"
    assert not _tank("delay(U, 9999 s)").program.residuals[0].unavailable


_BRANCH = """bg 1
model Branch {{
    param R = 2
    param C = 3
    input on : bool
    0:n {{ <- Sf:Q; -> R:load = 5; -> 1:sw when on {{ -> R:x = 4 }} }}
    n -> 1:b {{ -> R:R; -> C:C }}
    sensor e = {}
    sensor f = {}
}}
"""


def test_a_residual_would_start_anew_too_early_at_a_switch() -> None:
    # D(e) - R D(f) - f/C has no mode, but e and f jump where the switch beside the branch turns
    for delay, opens in (("{}", True), ("delay({}, 1 s)", False)):
        c = compile(text=_BRANCH.format(delay.format("n.e"), delay.format("b.f")))
        own = [k for k, r in enumerate(c.residuals) if "D(" in r.text and "on" not in r.text]
        (info,) = [c.program.residuals[k] for k in own]
        assert any(o.residual == info.name and o.modes for o in c.program.openings) == opens
        assert bool(info.unavailable) != opens


def test_what_is_known_at_once_is_taken_first() -> None:
    c = _tank("U", "delay(tank.e, 2 s)", "tank -> De:quick")
    assert [r.text for r in c.residuals] == [
        "U - quick/R - C*D(quick)", "level - delay(quick, 2 s)",
    ]  # fmt: skip


# ------------------------------------------------------------------------------ simulation

_SCENARIO = """
duration = 40
sampling.rate = 100
initial."C.q" = 3
inputs.U = "{}"
"""
_WAVE = "2 + sin(0.7*t) + if(t > 13.3, 1, 0)"


def _log(c: Compilation, text: str) -> dict[str, Any]:
    return c.simulate(read(c, text)).log.columns


def test_a_run_is_that_of_the_machine_without_delays_shifted_by_hand() -> None:
    late = _log(_late(), _SCENARIO.format(_WAVE))
    shifted = _WAVE.replace("t)", "max(t - 0.5, 0))").replace("t >", "max(t - 0.5, 0) >")
    plain = _log(_tank(), _SCENARIO.format(shifted))
    told = _log(_tank(), _SCENARIO.format(_WAVE))
    assert np.allclose(late["U"], told["U"], rtol=0, atol=1e-9)
    assert np.allclose(late["level"][200:], plain["level"][:-200], rtol=0, atol=1e-6)
    assert np.allclose(late["level"][:200], 1.5)  # q/C at the start


def test_a_simulated_machine_is_silent_with_its_delays_and_not_without() -> None:
    log = _log(_late(), _SCENARIO.format(_WAVE))
    found, other = _run(_late(), **log), _run(_tank(), **log)
    assert found.valid.sum() > 3000
    assert np.abs(found.value[found.valid]).max() < 0.01
    assert np.abs(other.value[other.valid]).max() > 1
    fault = '[[fault]]\nof = "R"\nchange = "*= 1.2"\nat = 20'
    faulty = _log(_late(), _SCENARIO.format(_WAVE) + fault)
    assert np.abs(_run(_late(), **faulty).value).max() > 0.1


def test_a_controller_of_the_scenario_reads_and_acts_late() -> None:
    text = _SCENARIO.replace('inputs.U = "{}"\n', "") + """
[[controller]]
input = "U"
measures = "level"
setpoint = 2.0
kp = 0.3
ki = 0.05
period = 0.1
limits = [-5, 5]
"""
    log = _log(_late(), text)
    found = _run(_late(), **log)
    assert np.abs(found.value[found.valid]).max() < 0.01
    # for 2 s it reads the level of the start, and adds 0.05*0.5*0.1 to what it says every 0.1 s
    said = 0.3 * 0.5 + 0.0025 * np.arange(1, 20)
    assert log["U"][5:195:10] == pytest.approx(said, abs=1e-9)
    assert np.ptp(log["U"]) > 0.05


def test_a_law_acts_on_an_old_reading_in_a_run_as_well() -> None:
    c = compile(Path(__file__).parents[2] / "cases" / "signatures" / "delayed.bg", rate=100.0)
    text = "duration = 40\nsampling.rate = 100\ninputs.r = \"2 + sin(0.5*t)\"\n"
    text += 'initial."c1.q" = 1\ninitial."c2.q" = 0.5\n'
    healthy = _run(c, **_log(c, text))
    quiet = [np.abs(healthy.value[healthy.valid[:, k], k]).max() for k in range(3)]
    assert max(quiet) < 5e-3
    for fault in c.graph.faults:
        change = "+= 0.2" if fault == "pump" else "*= 1.3"
        found = _run(c, **_log(c, f'{text}[[fault]]\nof = "{fault}"\nchange = "{change}"\nat = 15'))
        moved = np.abs(np.where(found.valid, found.value, 0)).max(axis=0) > 0.03
        assert tuple(moved) == tuple(map(bool, c.signatures.row(fault))), fault


@pytest.mark.parametrize("fault", ["U", "level", "R", "C"])
def test_a_diagnosis_knows_that_a_command_shows_late(fault: str) -> None:
    # U shows 2.5 s after it has gone wrong: taken for one that began when it shows, it is no match
    c = _late()
    scenario = _SCENARIO.format(_WAVE).replace("= 40", "= 90")
    scenario += "[sensors.level]\nnoise = 0.005\n"
    scenario += f'[[fault]]\nof = "{fault}"\nchange = "*= 1.3"\nat = 70\n'
    log = c.simulate(read(c, scenario)).log
    engine = c.engine(native=True)
    samples = np.column_stack([log.columns[k.path] for k in engine.signals])
    found = c.diagnosis(engine).update(log.time, engine.run(samples), samples)
    (named,) = [v for v in found if v.event == "update"][-1:]
    assert named.candidates[0].fault == fault, named.message


def test_a_machine_without_an_end_is_refused() -> None:
    c = _late()
    with pytest.raises(SimulationError, match="`U` is delayed"):
        Robot(c.equations, c.integral, read(c, _SCENARIO.format("1")))


# ------------------------------------------------------------------------------ refusals


@pytest.mark.parametrize(
    ("command", "level", "more", "code"),
    [
        ("U", "tank.e + delay(tank.e, 1 s)", "", "delay-inside"),
        ("delay(tank.e*1, 1 s)", "tank.e", "", "delay-inside"),
        ("delay(int(U), 1 s)", "tank.e", "", "delay-inside"),
        ("U + delay(road, 1 s)", "tank.e", "input road unknown", "delay-inside"),
        ("if(on, U, delay(if(on, U, 0), 1 s))", "tank.e", "input on : bool", "delay-inside"),
        ("delay(U, C*1 s)", "tank.e", "", "delay-time"),
        ("delay(U, -1 s)", "tank.e", "", "delay-time"),
        ("delay(U, U*1 s)", "tank.e", "", "delay-time"),
        ("delay(U, 1 m)", "tank.e", "", "unit-mismatch"),
        ("U", "delay(tank.e, T)", "param T = 1 s", "delay-time"),
        ("U", "delay(tank.e, 1 s) counts 24/turn", "", "delay-counts"),
        ("U + delay(U, 1 s)", "tank.e", "", "delay-twice"),
        ("delay(U, 2 s) + delay(U, 1 s)", "tank.e", "", "delay-twice"),
        ("delay(U)", "tank.e", "", "wrong-arguments"),
        ("U", "delay(tank.e)", "", "wrong-arguments"),
    ],
)
def test_what_is_refused(command: str, level: str, more: str, code: str) -> None:
    with pytest.raises(CompileError) as failure:
        _ = _tank(command, level, more).graph
    codes = {d.code for d in failure.value.diagnostics if d.severity == "error"}
    assert codes == {code}
    assert all(d.labels and d.help for d in failure.value.diagnostics)


def test_constants_are_times() -> None:
    c = _tank("U", "delay(tank.e, 2*T)", "const T = 0.75 s")
    assert c.residuals["r1"].text == "delay(U, 1.5 s) - level/R - C*D(level)"
