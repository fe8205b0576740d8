"""The smallest visible changes against numbers worked out by hand and against measured noise."""

from __future__ import annotations

import importlib.util
import math
import sys
from pathlib import Path
from types import ModuleType
from typing import Literal

import numpy as np
import pytest

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.ir.graph import BondGraph
from bondgraph.runtime.shown import shown
from bondgraph.runtime.smallest import Detection, Situation, noise, smallest
from tests.sampled import Sampled

_ROOT = Path(__file__).resolve().parents[3]

_ENCODER = """bg 1
model Spindle {
    param J = 0.01 kg.m^2
    param b = 0.2 N.m.s/rad
    Se:torque -> 1:rotor -> I:J
    rotor -> R:b
    sensor angle : rad = int(rotor.f) counts 1000/turn
}
"""


def _tolerances(graph: BondGraph) -> dict[str, float]:
    return {v.name: float(v.tolerance) for v in graph.values if v.tolerance}


def _found(compilation: Compilation, situation: Situation) -> Detection:
    return smallest(
        compilation.program, compilation.thresholds, _tolerances(compilation.graph), situation
    )


def _change(found: Detection, fault: str, residual: str) -> float:
    rows = [s for s in found.smallest if (s.fault, s.residual) == (fault, residual)]
    assert len(rows) == 1 and rows[0].change is not None
    return rows[0].change


@pytest.fixture(scope="module")
def motor() -> Compilation:
    return bondgraph.compile(_ROOT / "models" / "dc_motor.bg")


def _generated(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location("generated_motor", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def test_noise_is_what_the_generated_code_shows(motor: Compilation) -> None:
    """60 000 samples of noise; the filter leaves some 500 independent ones of each residual."""
    module = _generated(_ROOT / "generated" / "dc_motor" / "motor.py")
    deviations = {"current": 2e-3, "speed": 5.0, "U": 0.05}
    expected = noise(motor.program, Situation(noise=deviations))
    monitor = module.Monitor()
    random = np.random.default_rng(7)
    rows = []
    for U, current, speed in random.normal(size=(60_000, 3)) * [0.05, 2e-3, 5.0]:
        r = monitor.step(module.Samples(U=U, current=current, speed=speed, load=0.0))
        rows.append((r.r1, r.r2))
    measured = np.array(rows)[2000:].std(axis=0)
    for value, sigma in zip(measured, expected.values(), strict=True):
        assert sigma is not None
        assert 0.85 < value / sigma < 1.15


def test_noise_of_an_encoder_is_that_of_its_counts(tmp_path: Path) -> None:
    """Against an encoder with a thousand times the counts on a spindle that speeds up steadily.

    The speed runs through many counts a sample, so that every rhythm of the rounding occurs.
    """
    expected, rows = 0.0, []
    time = np.arange(40_000) / 1000
    angle = 30.0 * time + 1.5 * time**2
    for counts in (1000, 1_000_000):
        path = tmp_path / f"spindle{counts}.bg"
        path.write_text(_ENCODER.replace("1000/turn", f"{counts}/turn"), encoding="utf-8")
        program = bondgraph.compile(path).program
        if not rows:
            found = noise(program, Situation())["r1"]
            assert found is not None
            expected = found
        run = Sampled(program)
        read = np.floor(angle * counts / (2 * math.pi)).astype(int)
        rows.append([run.step({"torque": 0.0, "angle": n}).residuals["r1"] for n in read])
    off = np.array(rows[0][1000:]) - np.array(rows[1][1000:])
    assert 0.85 < np.std(off) / expected < 1.15


def test_noise_where_the_residuals_are_zero(motor: Compilation) -> None:
    """A linear machine has the noise of zero signals where it truly runs: U = R i + k w, k i = f w.

    What the filter of r2 holds there is a rounding error.
    """
    deviations = {"current": 2e-4, "speed": 0.5}
    w = 12.0 / (17.6 * 1.19e-5 / 3.51e-3 + 3.51e-3)
    at = {"U": 12.0, "speed": w, "current": 1.19e-5 * w / 3.51e-3}
    running = noise(motor.program, Situation(at=at, noise=deviations))
    assert running == pytest.approx(noise(motor.program, Situation(noise=deviations)))


def test_constant_signals(motor: Compilation) -> None:
    """r1 = U - R i - k w and r2 = k i - f w - load at rest, tolerances 5, 2 and 10 %."""
    i, w = 0.03, 1000.0
    R, k, f = 17.6, 3.51e-3, 1.19e-5
    found = _found(motor, Situation(at={"U": 6.0, "current": i, "speed": w}))
    own_R, own_k = 0.05 * R * i, 0.02 * k * w
    assert _change(found, "R", "r1") == pytest.approx((own_R + 2 * own_k) / i)
    assert _change(found, "k", "r1") == pytest.approx((own_k + 2 * own_R) / w)
    assert _change(found, "U", "r1") == pytest.approx(2 * (own_R + own_k))
    assert _change(found, "current", "r1") == pytest.approx(2 * (own_R + own_k) / R)
    assert _change(found, "f", "r2") == pytest.approx((0.1 * f * w + 2 * 0.02 * k * i) / w)
    inertia = next(s for s in found.smallest if s.fault == "J")
    assert inertia.change is None and inertia.reason == "not moved by these signals"


def test_a_swing_shows_an_inertia(motor: Compilation) -> None:
    """|J w'| of a sine through n stages 1/(1 + p/wc) against kappa sigma."""
    hz, amplitude = 2.0, 300.0
    situation = Situation(swing={"speed": amplitude}, frequency=hz, noise={"load": 5e-3}, kappa=4.0)
    found = _found(motor, situation)
    info = motor.program.residuals[1]
    sigma = found.sigma["r2"]
    assert sigma is not None and sigma > 0
    omega = 2 * math.pi * hz
    gain = abs(1 / (1 + 1j * omega / motor.program.bandwidth)) ** info.stages
    slope = omega * amplitude * gain
    row = next(s for s in found.smallest if s.fault == "J")
    assert row.sensitivity <= slope * 1.001
    # the threshold of f is a quarter of a period late: the best moment is at the peak or near it
    own = 0.1 * 1.19e-5 * amplitude * gain
    times = np.linspace(0.0, 2 * math.pi, 20_001)
    best = np.min(
        (4.0 * sigma + 2 * own * np.abs(np.sin(times)))
        / np.maximum(slope * np.abs(np.cos(times)), 1e-9)
    )
    assert row.change == pytest.approx(best, rel=2e-3)


@pytest.mark.parametrize("swing", [{}, {"speed": 300.0, "angle": 0.4}])
@pytest.mark.parametrize("kind", ["motor", "spindle"])
def test_recorded_signals_show_what_the_same_signals_show(
    kind: str, swing: dict[str, float], motor: Compilation, tmp_path: Path
) -> None:
    """By the generated code over samples, one engine for each change, against arrays of runs."""
    compilation, at = motor, {"U": 6.0, "current": 0.03, "speed": 1000.0}
    if kind == "spindle":
        path = tmp_path / "spindle.bg"
        path.write_text(_ENCODER.replace("m.s/rad", "m.s/rad +- 5%"), encoding="utf-8")
        compilation, at = bondgraph.compile(path), {"torque": 2.0, "angle": 10.0}
    own = {name: size for name, size in swing.items() if name in at}
    situation = Situation(at, own, {"current": 1e-4, "speed": 0.1}, 2.0, 4.0)
    engine, program = compilation.engine(), compilation.program
    t = np.arange(math.ceil(engine.warm_up * program.rate) + 502) / program.rate
    columns = []
    for known in engine.signals:
        base, turn = at.get(known.path, 0.0), known.counts
        course = base + 0 * t if turn is None else base * t
        course = course + own.get(known.path, 0.0) * np.sin(2 * np.pi * 2.0 * t)
        columns.append(course if turn is None else np.round(course * turn / (2 * np.pi)))
    logs = [np.column_stack(columns)]
    tolerances = _tolerances(compilation.graph)
    found = shown(program, engine, tolerances, situation, logs)
    wanted = _found(compilation, situation)
    assert found.sigma == wanted.sigma
    # counts are whole: what they jump by moves an inertia
    close = 1e-3 if kind == "motor" else 0.15
    for one, other in zip(found.smallest, wanted.smallest, strict=True):
        assert (one.fault, one.residual, one.reason) == (other.fault, other.residual, other.reason)
        assert (one.change or 0.0) == pytest.approx(other.change or 0.0, rel=close)
    assert any(one.change for one in found.smallest)


def test_without_numbers_nothing_has_a_size(tmp_path: Path) -> None:
    path = tmp_path / "spindle.bg"
    path.write_text(_ENCODER.replace("param b = 0.2 N.m.s/rad", "param b : N.m.s/rad"), "utf-8")
    with pytest.raises(ValueError, match="b has no value"):
        _found(bondgraph.compile(path), Situation())


def test_the_inductance_and_capacitance_of_the_cable_are_marked() -> None:
    """At 1 kHz two metres of cable are a wire; the effect of L C p^2 is worked out here.

    A lumped cell has Us = Uin/(1 + ... + L C p^2): against 1, that is below 12 bits up to the
    highest visible frequency, pi rate/5, unless the rate is of the order of 10 MHz.
    """
    L, C, resolution = 250e-9, 110e-12, 2.0**-12

    def marked(rate: float) -> set[str]:
        compilation = bondgraph.compile(_ROOT / "models" / "khepera.bg", rate=rate)
        found = _found(compilation, Situation(at={"Uin": 5.0, "Us": 5.0}))
        rows = [s for s in found.smallest if s.residual == "r5"]
        return {s.fault for s in rows if s.reason.startswith("not visible")}

    for rate, hidden in ((1e3, True), (1e8, False)):
        effect = (math.pi * rate / 5) ** 2 * L * C
        assert (effect < resolution) is hidden
        assert ({"line.L", "line.C"} <= marked(rate)) is hidden


def test_a_lasting_error_of_a_signal_that_is_differentiated_does_not_show(tmp_path: Path) -> None:
    """r = torque' - ...: what is left of a constant torque is rounding, not a sensitivity."""
    path = tmp_path / "spindle.bg"
    spring = "    rotor -> C:s = 1/K\n    param K = 3 N.m/rad +- 5%\n    sensor angle"
    path.write_text(_ENCODER.replace("    sensor angle", spring), encoding="utf-8")
    compilation = bondgraph.compile(path)
    assert "D(torque" in str(compilation.residuals[0])
    for situation in (Situation(), Situation(at={"angle": 1.0, "torque": 2.0})):
        rows = [s for s in _found(compilation, situation).smallest if s.fault == "torque"]
        assert [s.reason for s in rows] == ["not moved by these signals"]


def test_where_a_relation_has_no_value_it_is_said_and_the_others_stay(tmp_path: Path) -> None:
    """r1 = P - k log(T) has no value at T = 0; at T = 2 an error of T counts half."""
    path = tmp_path / "m.bg"
    path.write_text(
        "bg 1\nmodel M {\nparam k = 1; param R = 1\n"
        "Sf:P -> 0:n\nn -> R:loss { f = k*log(e) }\nn -> De:T\n"
        "Se:U -> 1:a\na -> R:R\na -> Df:i\n}\n"
    )
    model = bondgraph.compile(path)
    noise = {"T": 0.01, "i": 0.01}
    cold = _found(model, Situation(noise=noise))
    (gone,) = cold.undefined
    (other,) = set(cold.sigma) - {gone}
    assert cold.sigma[gone] is None and cold.sigma[other]
    reasons = {s.reason for s in cold.smallest if s.residual == gone}
    assert reasons == {"no value at these signals"}
    warm = _found(model, Situation(at={"T": 2.0}, noise=noise))
    assert warm.undefined == ()
    assert _change(warm, "T", gone) == pytest.approx(2 * _change(warm, "P", gone), rel=1e-6)


def test_a_relation_with_an_iteration_inside(tmp_path: Path) -> None:
    """From y = e + exp(e) - 1 follows de/dy = 1/2 at rest, dr/dy = -(1/2)/R - 1/2 - 1 = -2."""
    path = tmp_path / "m.bg"
    path.write_text(
        "bg 1\nmodel M {\nparam R = 1\nSe:U -> 1:a -> 0:n\na -> R:R\n"
        "n -> R:d { f = exp(e) - 1 }\nn -> 1:b\nb -> R:x { f = e + exp(e) - 1 }\nb -> Df:y\n}\n"
    )
    found = _found(bondgraph.compile(path), Situation(noise={"y": 0.01}))
    assert _change(found, "U", "r1") == pytest.approx(2 * _change(found, "y", "r1"), rel=1e-4)


_FOLLOWED = """bg 1
model Charge {
    param R = 1 Ohm
    param C = 1 F
    Se:U -> 1:j -> R:R
    j -> 0:n -> C:C
    n -> De:u
}
"""


@pytest.mark.parametrize("form", ["derivative", "observer"])
def test_how_long_a_change_takes_to_be_sure(form: Literal["derivative", "observer"]) -> None:
    """w = U - u - R C u' jumps with U, and half of it is there after ln(2)/v or later.

    It is shown through (1 + p/v)^-n. The derivative form has n = 2 stages at the bandwidth:
    1 - (1 + x) exp(-x) = 1/2 at x = 1.678. The observer has one pole, v^2 = wc^2 + 1/(R C)^2.
    """
    wc = 2.0
    c = bondgraph.compile(text=_FOLLOWED, rate=200.0, bandwidth=wc, form=form)
    found = _found(c, Situation(noise={"u": 1e-3}))
    row = next(s for s in found.smallest if s.fault == "U")
    expected = 1.67835 / wc if form == "derivative" else math.log(2) / math.hypot(wc, 1.0)
    assert row.delay == pytest.approx(expected, abs=2 / 200)


def test_a_parameter_takes_as_long_as_the_filter_of_its_law() -> None:
    """At rest r2 = k i - f w - load - J w': a friction that doubles is a step of f w."""
    c = bondgraph.compile(text="""bg 1
        model Brake {
            param f = 1e-3 N.m.s
            param J = 1e-3 kg.m^2
            Se:load -> 1:rotor -> I:J
            rotor -> R:f
            rotor -> Df:speed
        }""", bandwidth=10.0)  # fmt: skip
    situation = Situation(at={"speed": 50.0, "load": 0.05}, noise={"load": 1e-4})
    row = next(s for s in _found(c, situation).smallest if s.fault == "f")
    assert row.delay == pytest.approx(1.67835 / 10.0, abs=2e-3)


def test_the_forms_of_one_compilation_are_those_of_their_own() -> None:
    c = bondgraph.compile(text=_FOLLOWED, rate=200.0)
    situation = Situation(at={"U": 1.0, "u": 1.0}, noise={"u": 1e-3})
    assert _found(c, situation) != _found(c.in_form("observer"), situation)
    for form in ("observer", ("r1",)):
        alone = bondgraph.compile(text=_FOLLOWED, rate=200.0, form=form)
        assert _found(c.in_form(form), situation) == _found(alone, situation)
    assert c.in_form(("r2",)).program == c.program
