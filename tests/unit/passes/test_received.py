"""Controllers act on readings: signatures by hand, and residuals on loops simulated by hand.

Every machine below is integrated here, with the wrong reading fed back to its controller; nothing
of the compiler is used but the residuals that it made. Constant errors, at the end of transients.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest

from bondgraph.compilation import Compilation
from tests.sampled import Sampled
from tests.unit.passes.relations import compiled

Numbers = Mapping[str, float]
Logged = dict[str, float]

_STEP = 1e-3  # s, also of the samples
_SECONDS = 6.0


class Loop(NamedTuple):
    """A model, the faults that each residual sees, and the machine by hand.

    `run(t, x, wrong)` gives the rates of the states and what is logged; `wrong` is what each fault
    adds to its parameter, command or reading. `shown` are the residuals at the end, by hand, with
    `size` of the fault; a fault that is not named leaves a residual at zero.
    """

    text: str
    sees: tuple[str, ...]
    start: tuple[float, ...]
    run: Callable[[float, np.ndarray, Numbers], tuple[list[float], Logged]]
    size: Numbers
    shown: Mapping[str, tuple[float, ...]]


_C, _G, _K, _KI = 2.0, 0.5, 1.5, 0.8  # of the tank: capacity, conductance, gains


def _r(t: float) -> float:
    return 3.0 + np.sin(1.3 * t)


def _tank(logged: bool, integral: bool) -> str:
    more = " + Ki*int(r - y)" if integral else ""
    gain = f"; param Ki = {_KI}" if integral else ""
    return f"""
    input r
    param K = {_K}; param c = {_C}; param g = {_G}{gain}
    let cmd = K*(r - y){more}
    Sf:pump = cmd
    0:t {{ <- pump; -> C:c; -> R:out {{ f = g*e }}; -> De:y }}
    {"sensor u = cmd" if logged else ""}
    """


def _tank_run(integral: bool) -> Callable[[float, np.ndarray, Numbers], tuple[list[float], Logged]]:
    def run(t: float, x: np.ndarray, wrong: Numbers) -> tuple[list[float], Logged]:
        r = _r(t)
        acts = r + wrong.get("r", 0.0)  # what acts on the machine; r is what is told
        y = x[0] + wrong.get("y", 0.0)
        k, ki = _K + wrong.get("K", 0.0), _KI + wrong.get("Ki", 0.0)
        cmd = k * (acts - y) + (ki * x[1] if integral else 0.0)
        flow = cmd + wrong.get("pump", 0.0)
        c, g = _C + wrong.get("c", 0.0), _G + wrong.get("g", 0.0)
        rates = [(flow - g * x[0]) / c, acts - y]
        return rates, {"r": r, "y": y, "u": cmd + wrong.get("u", 0.0)}

    return run


# With the truth t: K(r - y) + pump = g t + c t', and y = t + b. So the balance written in y is
# -g b for a wrong sensor, -p for a pump that delivers p too much, and u - K(r - y) is as it was.
P_LOGGED = Loop(
    _tank(True, False),
    ("K r c g pump y", "K r u"),
    (2.0, 0.0),
    _tank_run(False),
    {"y": 0.4, "pump": 0.3, "u": 0.2},
    {"y": (-_G * 0.4, 0.0), "pump": (-0.3, 0.0), "u": (0.0, 0.2)},
)
P_HIDDEN = Loop(
    _tank(False, False),
    ("K r c g pump y",),
    (2.0, 0.0),
    _tank_run(False),
    {"y": 0.4, "pump": 0.3},
    {"y": (-_G * 0.4,), "pump": (-0.3,)},
)
PI_LOGGED = Loop(
    _tank(True, True),
    ("K Ki r c g pump y", "K Ki r u"),
    (2.0, 0.0),
    _tank_run(True),
    {"y": 0.4, "pump": 0.3, "u": 0.2},
    {"y": (-_G * 0.4, 0.0), "pump": (-0.3, 0.0), "u": (0.0, 0.2)},
)

_L, _R, _J, _F, _KM, _KC, _KW = 0.2, 2.0, 0.3, 0.4, 0.5, 4.0, 1.2  # a motor in a cascade


def _cascade(t: float, x: np.ndarray, wrong: Numbers) -> tuple[list[float], Logged]:
    r, i, w = _r(t), x[0] + wrong.get("i", 0.0), x[1] + wrong.get("w", 0.0)
    volts = _KC * (_KW * (r - w) - i) + wrong.get("drive", 0.0)
    rates = [(volts - _R * x[0] - _KM * x[1]) / _L, (_KM * x[0] - _F * x[1]) / _J]
    return rates, {"r": r, "i": i, "w": w}


# Kc(Kw(r - w) - i) + drive - R i - k w - L i' and k i - f w - J w': the controllers act on i and w
# as they are read, so that an error is only in the other terms.
CASCADE = Loop(
    f"""
    input r
    param L = {_L}; param R = {_R}; param J = {_J}; param f = {_F}; param k = {_KM}
    param Kc = {_KC}; param Kw = {_KW}
    let wanted = Kw*(r - w)
    Se:drive = Kc*(wanted - i)
    1:coil {{ <- drive; -> I:L; -> R:R; -> GY:k -> shaft; -> Df:i }}
    1:shaft {{ -> I:J; -> R:f; -> Df:w }}
    """,
    ("Kc Kw r drive L R k i w", "k f J i w"),
    (1.0, 1.0),
    _cascade,
    {"i": 0.2, "w": 0.3, "drive": 0.5},
    {
        "i": (-_R * 0.2, _KM * 0.2),
        "w": (-_KM * 0.3, -_F * 0.3),
        "drive": (-0.5, 0.0),
    },
)

_C1, _C2, _G1 = 1.0, 2.0, 0.7  # two tanks, a pipe between them


def _difference(t: float, x: np.ndarray, wrong: Numbers) -> tuple[list[float], Logged]:
    r, y1, y2 = _r(t), x[0] + wrong.get("y1", 0.0), x[1] + wrong.get("y2", 0.0)
    d = y1 - y2 + wrong.get("d", 0.0)  # made of the readings, and wrong besides
    flow = _K * (r - d) + wrong.get("pump", 0.0)
    between = _G1 * (x[0] - x[1])
    return [(flow - between) / _C1, (between - _G * x[1]) / _C2], {
        "r": r, "y1": y1, "y2": y2, "d": d,
    }  # fmt: skip


# K(r - d) + pump - g1(y1 - y2) - c1 y1' and g1(y1 - y2) - g y2 - c2 y2' and d - (y1 - y2)
SENSOR_OF_SENSORS = Loop(
    f"""
    input r
    param K = {_K}; param c1 = {_C1}; param c2 = {_C2}; param g1 = {_G1}; param g = {_G}
    sensor d = y1 - y2
    Sf:pump = K*(r - d)
    0:a {{ <- pump; -> C:c1; -> De:y1 }}
    0:b {{ -> C:c2; -> R:out {{ f = g*e }}; -> De:y2 }}
    1:pipe {{ <- a; -> R:g1 {{ f = g1*e }}; -> b }}
    """,
    ("K r pump c1 g1 y1 y2", "c2 g1 g y1 y2", "d"),
    (2.0, 1.0),
    _difference,
    {"y1": 0.4, "y2": 0.3, "d": 0.2, "pump": 0.6},
    {
        "y1": (-_G1 * 0.4, _G1 * 0.4, 0.0),
        "y2": (_G1 * 0.3, -(_G1 + _G) * 0.3, 0.0),
        "d": (0.0, 0.0, 0.2),
        "pump": (-0.6, 0.0, 0.0),
    },
)


def _valve(t: float, x: np.ndarray, wrong: Numbers) -> tuple[list[float], Logged]:
    q, y = 2.0, x[0] + wrong.get("y", 0.0)
    return [(q + wrong.get("Q", 0.0) - _K * y * x[0]) / _C], {"Q": q, "y": y}


# Q - K y_read t - c t' = 0; a valve that a float opens: the machine runs on the wrong reading
_AT_REST = (-0.4 + np.sqrt(0.4**2 + 4.0 * 2.0 / _K)) / 2.0  # K (t + 0.4) t = 2
PASSIVE = Loop(
    f"""
    param K = {_K}; param c = {_C}
    Sf:Q -> 0:t
    t {{ -> C:c; -> R:valve {{ f = K*y*e }}; -> De:y }}
    """,
    ("K c Q y",),
    (1.0,),
    _valve,
    {"y": 0.4, "Q": 0.5},
    {"y": (-_K * (_AT_REST + 0.4) * 0.4,), "Q": (-0.5,)},
)


def _switched(auto: bool) -> Loop:
    def run(t: float, x: np.ndarray, wrong: Numbers) -> tuple[list[float], Logged]:
        manual, y = 1.0 + 0.5 * np.sin(2.0 * t), x[0] + wrong.get("y", 0.0)
        by_hand = manual + wrong.get("manual", 0.0)
        cmd = _K * (_r(t) - y) if auto else by_hand
        rates = [(cmd + wrong.get("pump", 0.0) - _G * x[0]) / _C]
        logged = {"r": _r(t), "manual": manual, "auto": float(auto), "y": y}
        return rates, logged | {"u": cmd + wrong.get("u", 0.0)}

    by_hand = (0.0, 0.0) if auto else (-0.3, 0.3)
    return Loop(
        f"""
        input r; input manual; input auto : bool
        param K = {_K}; param c = {_C}; param g = {_G}
        let cmd = if(auto, K*(r - y), manual)
        Sf:pump = cmd
        0:t {{ <- pump; -> C:c; -> R:out {{ f = g*e }}; -> De:y }}
        sensor u = cmd
        """,
        ("K r manual c g pump y", "K r manual u"),
        (2.0,),
        run,
        {"y": 0.4, "pump": 0.3, "manual": 0.3},
        {"y": (-_G * 0.4, 0.0), "pump": (-0.3, 0.0), "manual": by_hand},
    )


LOOPS = {
    "P, its command logged": P_LOGGED,
    "P, its command hidden": P_HIDDEN,
    "PI, its command logged": PI_LOGGED,
    "two controllers in a cascade": CASCADE,
    "a sensor of two sensors": SENSOR_OF_SENSORS,
    "a reading in a passive law": PASSIVE,
    "a switch, the controller on": _switched(True),
    "a switch, by hand": _switched(False),
}


@cache
def _compiled(name: str) -> Compilation:
    return compiled(f"model M {{\n{LOOPS[name].text}\n}}")


def _log(loop: Loop, wrong: Numbers, paths: list[str]) -> np.ndarray:
    """Samples of the loop, integrated by Runge and Kutta's method of fourth order."""
    x, rows = np.array(loop.start, dtype=float), []
    for n in range(round(_SECONDS / _STEP)):
        t, h = n * _STEP, _STEP
        log = loop.run(t, x, wrong)[1]
        rows.append([log[p] for p in paths])
        k1 = np.array(loop.run(t, x, wrong)[0])
        k2 = np.array(loop.run(t + h / 2, x + h / 2 * k1, wrong)[0])
        k3 = np.array(loop.run(t + h / 2, x + h / 2 * k2, wrong)[0])
        k4 = np.array(loop.run(t + h, x + h * k3, wrong)[0])
        x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return np.array(rows)


def _ends(name: str, wrong: Numbers) -> np.ndarray:
    """The residuals at the end of a log of the machine."""
    engine = _compiled(name).engine().configured(bounds=False)
    batch = engine.run(_log(LOOPS[name], wrong, [k.path for k in engine.signals]))
    assert batch.valid[-1].all()
    return np.asarray(batch.value[-1])


@pytest.mark.parametrize("name", LOOPS)
def test_signatures_are_those_by_hand(name: str) -> None:
    matrix = _compiled(name).signatures
    found = [set(matrix.signature(r)) for r in matrix.residuals]
    assert found == [set(row.split()) for row in LOOPS[name].sees]
    assert _compiled(name).verification.residuals == len(found)


@pytest.mark.parametrize("name", LOOPS)
def test_the_machine_that_runs_on_a_wrong_reading_moves_what_is_said(name: str) -> None:
    loop = LOOPS[name]
    healthy = _ends(name, {})
    assert healthy == pytest.approx(np.zeros(len(healthy)), abs=2e-6)
    for fault, size in loop.size.items():
        shown = _ends(name, {fault: size})
        assert np.abs(shown) == pytest.approx(np.abs(loop.shown[fault]), rel=1e-4, abs=2e-6), fault
        for row, value in zip(loop.sees, loop.shown[fault], strict=True):
            assert (value != 0.0) <= (fault in row.split())


def test_in_each_mode_of_the_controller() -> None:
    c = _compiled("a switch, by hand")
    assert c.mode_signatures.names == ("auto",)
    found = []
    for mode in c.mode_signatures.modes:
        assert mode.matrix is not None
        found.append((mode.modes, [set(mode.matrix.signature(r)) for r in mode.matrix.residuals]))
    # told the other of manual and K*(r - y), both are off by the difference of these
    assert found == [
        ({"auto": False}, [{"manual", "c", "g", "pump", "y", "auto"}, {"manual", "u", "auto"}]),
        ({"auto": True}, [{"K", "r", "c", "g", "pump", "y", "auto"}, {"K", "r", "u", "auto"}]),
    ]


def test_what_could_be_told_apart_at_best() -> None:
    # K and r move both residuals by (r - y) dK and K dr, in one proportion; only u moves the
    # second one alone, and all others only the first
    best = _compiled("P, its command logged").maximum_isolability
    assert best is not None
    assert {frozenset(g) for g in best} == {
        frozenset({"K", "r"}), frozenset({"c", "g", "pump", "y"}), frozenset({"u"}),
    }  # fmt: skip


def test_a_wrong_sensor_shows_for_ever_though_its_controller_follows_it() -> None:
    # at rest the level is still, and the integral has made r - y zero
    found = _compiled("PI, its command logged").detectability
    assert found.weak("r1") == ("K", "c")
    assert found.weak("r2") == ("K",)


def test_sensitivities_are_those_of_the_measurement() -> None:
    relation = next(iter(_compiled("P, its command logged").residuals))
    assert str(relation.sensitivity_node("y")) == "-g"
    assert str(relation.sensitivity_node("pump")) == "1"


def test_the_code_has_one_signal_for_a_sensor() -> None:
    c = _compiled("P, its command hidden")
    assert [k.path for k in c.program.knowns] == ["r", "y"]
    assert [k.kind for k in c.program_with_readings.knowns] == ["input", "sensor", "reading"]
    assert not any("y_read" in a.text for a in c.artifacts)
    assert [k.path for k in c.engine().signals] == ["r", "y"]
    assert c.program.digest != c.program_with_readings.digest
    assert next(iter(c.residuals)).text == "K*(r - y) + pump - g*y - c*D(y)"


_SERVO = """model Servo {
    input want : rad
    param Kp = 3 N.m/rad; param Kd = 0.5 N.m.s/rad; param J = 0.1 kg.m^2; param b = 0.2 N.m.s/rad
    let motor = Kp*(want - th) - Kd*der(th)
    MSe:motor -> 1:rotor -> I:J
    rotor -> R:b
    sensor th : rad = int(rotor.f) counts 1000/turn
    fault weak : motor.error += -0.5 N.m
    fault bent : th += 0.1 rad
}"""


def test_both_programs_keep_the_same_terms_and_stages() -> None:
    for c in (*map(_compiled, LOOPS), compiled(_SERVO)):
        for one, other in zip(c.program.residuals, c.program_with_readings.residuals, strict=True):
            assert (one.stages, one.settle, one.invisible, one.approximate) == (
                other.stages, other.settle, other.invisible, other.approximate,
            )  # fmt: skip


@pytest.mark.parametrize("law", ["k*y*f", "if(open, k*y*f, 2*k*y*f)"])
def test_both_programs_have_the_same_filters_where_one_has_a_law_of_a_derivative(law: str) -> None:
    """y y' is half the derivative of y^2, what a law received of y times y' is no derivative."""
    switch = "input open : bool; " if "open" in law else ""
    c = compiled(f"""model M {{ {switch}Se:U -> 1:i; param k = 2
        i -> R:r {{ e = {law} }}; i -> I:L = 0.1; i -> C:C = 0.01; sensor y : C = C.q }}""")
    (one,), (other,) = c.program.residuals, c.program_with_readings.residuals
    assert other.approximate and not one.approximate
    assert (one.stages, one.laws) == (other.stages, other.laws) == (3, 2)
    assert (one.settle, one.held) == (other.settle, other.held)
    # U = 100 y + 2 y y' + 0.1 y'' of y = 1 + sin(t)/2
    engine, t = c.engine(), np.arange(8000) / 1000.0
    y, rate = 1.0 + 0.5 * np.sin(t), 0.5 * np.cos(t)
    columns = {"U": 100.0 * y + 2.0 * y * rate - 0.05 * np.sin(t), "y": y, "open": np.ones(8000)}
    batch = engine.run(np.column_stack([columns[k.path] for k in engine.signals]))
    assert batch.valid[-4000:].all() and np.abs(batch.value[-4000:]).max() < 1e-3


def test_a_position_loop_with_an_encoder() -> None:
    # Kp(want - th) - Kd th' + error - b th' - J th'': an offset of the encoder shows while it moves
    c = compiled(_SERVO)
    relation = next(iter(c.residuals))
    assert relation.text.startswith("Kp*(want - th) + motor.error")
    assert set(relation.faults) == {"Kp", "Kd", "J", "b", "motor.error", "want", "th"}
    assert set(c.detectability.weak("r1") or ()) >= {"th", "J"}
    assert [(e.name, e.target) for e in c.graph.events] == [
        ("weak", "motor.error"), ("bent", "th"),
    ]  # fmt: skip
    assert [(k.path, k.kind) for k in c.program_with_readings.knowns] == [
        ("want", "input"), ("th", "sensor"), ("th", "reading"),
    ]  # fmt: skip
    assert [(k.path, k.kind) for k in c.program.knowns] == [("want", "input"), ("th", "sensor")]
    unit = {v.name: v.unit for v in c.graph.values}["motor.error"]
    assert unit == "N.m"


def test_a_law_that_uses_no_reading_has_no_delivery_of_its_own() -> None:
    c = compiled("model M { Se:U = 2*t.f + k; param k = 3; Se:W -> 1:t; U -> t; t -> R:R1 = 5"
                 "; t -> Df:y }")  # fmt: skip
    assert c.graph.faults == ("k", "W", "y")


def test_a_passive_law_that_uses_a_reading_gets_a_note() -> None:
    notes = [d for d in _compiled("a reading in a passive law").report.diagnostics]
    assert [(d.code, d.severity) for d in notes] == [("reading-in-law", "info")]
    assert notes[0].labels[0].span.text == "f = K*y*e"
    assert _compiled("P, its command logged").report.diagnostics == []


def test_a_program_without_readings_is_one_program() -> None:
    c = compiled("model M { Se:U -> 1:i; i -> R:R1 = 2; i -> I:L1 = 3; i -> Df:y }")
    assert c.program_with_readings is c.program


def test_the_interpreter_and_the_engine_agree_on_the_emitted_program() -> None:
    c = _compiled("P, its command hidden")
    engine = c.engine()
    rows = _log(P_HIDDEN, {"y": 0.4}, [k.path for k in engine.signals])[:300]
    run = Sampled(c.program, {f.name: f.default for f in c.program.params})
    for row, value in zip(rows, engine.run(rows).value, strict=True):
        found, valid = run.step(dict(zip([k.name for k in c.program.knowns], row, strict=True)))
        if valid["r1"]:
            assert found["r1"] == pytest.approx(value[0], rel=1e-9, abs=1e-12)


def test_a_relation_that_says_only_what_is_read_is_none() -> None:
    # the source gives its junction what the sensor reads there: y = y
    c = compiled("model M { param R1 = 2; Se:s = y -> 0:t; t -> R:R1; t -> De:y }")
    assert [str(r) for r in c.residuals] == []


def test_a_controller_within_its_tolerance_stays_below_the_threshold() -> None:
    # a gain that is 4 % too high moves the balance by -0.04 K(r - y); it may be off by 5 %
    text = P_HIDDEN.text.replace(f"K = {_K}", f"K = {_K} +- 5%")
    engine = compiled(f"model M {{\n{text}\n}}").engine()
    rows = _log(P_HIDDEN, {"K": 0.04 * _K}, [k.path for k in engine.signals])
    batch = engine.run(rows)
    value, bound = np.abs(batch.value[batch.valid]), batch.bound[batch.valid]
    assert (value <= bound + 2e-6).all()
    assert value[-1] == pytest.approx(0.8 * bound[-1], rel=1e-3)
