"""A charge that is other in each log, and that nobody knows: the samples tell it."""

from __future__ import annotations

import json
from functools import cache

import numpy as np
import pytest

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.runtime.diagnosis.calibration import tune
from bondgraph.runtime.diagnosis.started import started
from bondgraph.runtime.log import Array, Log

_R, _RATE = 0.5, 100.0
_BEGAN = {"full": 12.0, "usual": 9.0, "empty": 6.0}  # C


@cache
def cell(start: str = "+- 50%", q0: str = "q0", r: str = "+- 5%") -> Compilation:
    """A cell of e = 0.2 q + 0.01 q^2 behind a resistance."""
    return bondgraph.compile(
        text=f"""bg 1
model Cell {{
    param R = 0.5 Ohm {r}
    param q0 = 10 C {start}
    0:t {{ <- Sf:I; -> De:V; -> 1:c }}
    c {{ -> C:s(q0 = {q0}) {{ e = 0.2*q + 0.01*q^2 }}; -> R:R }}
}}""",
        rate=_RATE,
    )


def log(begins: float, seed: int = 1, fault: float = 0.0, r: float = _R, rows: int = 4000) -> Log:
    """What is measured of a cell that begins so; the voltage reads too much from the middle on."""
    time = np.arange(rows) / _RATE
    current, q = np.sin(0.9 * time), begins + (1.0 - np.cos(0.9 * time)) / 0.9
    volt = r * current + 0.2 * q + 0.01 * q**2 + fault * (time > time[-1] / 2)
    volt += 0.01 * np.random.default_rng(seed).normal(size=rows)
    return Log(time, {"I": current, "V": volt}, {}, {})


def samples(c: Compilation, begins: float, seed: int = 1) -> Array:
    """The same as rows of an engine."""
    columns = log(begins, seed).columns
    return np.column_stack([columns[k.path] for k in c.engine().signals])


def said(c: Compilation, begins: float, fault: float = 0.0) -> tuple[str, tuple[str, ...]]:
    """All that is told of a log, and the faults that are named at last, the likeliest first."""
    own = log(begins, fault=fault)
    verdicts = bondgraph.monitor(c, {"t": own.time, **own.columns}).verdicts[0]
    named = [v.candidates for v in verdicts if v.candidates]
    return " ".join(v.message for v in verdicts), tuple(x.fault for x in named[-1]) if named else ()


@pytest.mark.parametrize("begins", _BEGAN.values())
@pytest.mark.parametrize("q0", ["s*Q", "10 C*(log(s) + 1.693)"])
def test_a_start_may_be_made_of_what_laws_read_and_not_be_defined_everywhere(
    q0: str, begins: float
) -> None:
    """The capacity is a constant of the law, too, and no start; a logarithm has no value below 0.

    A watch ended with a ValueError of either.
    """
    c = bondgraph.compile(
        text=f"""bg 1
model Cell {{
    const Q = 20 C
    param R = 0.5 Ohm +- 5%
    param s = 0.5 +- 50%
    0:t {{ <- Sf:I; -> De:V; -> 1:c }}
    c {{ -> C:s(q0 = {q0}) {{ e = 4*q/Q + 4*(q/Q)^2 }}; -> R:R }}
}}""",
        rate=_RATE,
    )
    assert [m.unknown for m in c.diagnosis_model.memories] == [("s",)]
    message, named = said(c, begins)
    assert "watched from now on" in message and "does not stand at zero" not in message, message
    assert named == ()


@pytest.mark.parametrize("begins", _BEGAN.values())
def test_a_watch_waits_until_the_samples_tell_it(begins: float) -> None:
    text, named = said(cell(), begins)
    assert "r1 waits until the machine has shown by its motion what q0 is" in text
    assert "r1 is watched from now on" in text
    assert "elsewhere" not in text and not named


@pytest.mark.parametrize("begins", _BEGAN.values())
def test_a_fault_that_begins_later_is_seen_and_named(begins: float) -> None:
    _, named = said(cell(), begins, fault=0.3)
    assert named[:1] == ("V",)


@pytest.mark.parametrize("begins", [0.75, 0.9])
def test_a_start_need_not_be_told_from_a_parameter_that_does_the_same(begins: float) -> None:
    """The voltage of a pack tells its charge and its open voltage together, and no more is needed.

    1 % of that is 0.44 V, and a twentieth of the charge is 0.4 V. (Of a law that is straight the
    relation has no start.)
    """
    c = bondgraph.compile(
        text="""bg 1
model Pack {
    param E0 = 44 V +- 1%
    param soc0 = 0.85 +- 20%
    param R = 0.02 Ohm +- 5%
    const Q = 259200 C
    0:t { <- Sf:I; -> De:U; -> 1:c }
    c { -> C:s(q0 = soc0*Q) { e = E0 + 7 V*q/Q + 0.6 V*(q/Q)^2 }; -> R:R }
}""",
        rate=1.0,
    )
    time, draw = np.arange(2400.0), np.random.default_rng(3)
    current = -20.0 + 30.0 * np.sin(time / 40.0)
    charge = begins * 259200.0 + np.cumsum(current) - current[0]
    part = charge / 259200.0
    volt = 44.2 + 7.0 * part + 0.6 * part**2 + 0.0202 * current + 0.02 * draw.normal(size=2400)
    volt += 2.0 * (time > 1200.0)
    verdicts = bondgraph.monitor(c, {"t": time, "I": current, "U": volt}).verdicts[0]
    known = [v.time for v in verdicts if "r1 is watched from now on" in v.message]
    (fault,) = [v.time for v in verdicts if v.event == "fault"]
    assert known[0] < 600.0 and 1200.0 < fault < 1230.0


def test_without_a_tolerance_the_start_is_what_is_declared() -> None:
    text, _ = said(cell(start=""), 6.0)
    assert "waits" not in text
    assert "began elsewhere than the model declares (where nobody knows it, give the param" in text


def test_a_parameter_that_a_law_reads_too_is_none_of_a_start() -> None:
    def starts(c: Compilation) -> tuple[tuple[str, ...], tuple[str, ...]]:
        (memory,) = c.diagnosis_model.memories
        return memory.begins, memory.unknown

    assert starts(cell()) == starts(cell(q0="2*q0")) == (("q0",), ("q0",))
    assert starts(cell(start="")) == (("q0",), ())
    assert starts(cell(q0="R*10 C/Ohm")) == ((), ())


def test_its_tolerance_widens_what_is_embedded_and_not_what_is_watched() -> None:
    """Code that is embedded looks for no start."""
    own = samples(cell(), 10.0)
    bounds = [cell(start).engine().run(own).bound[-1, 0] for start in ("+- 50%", "")]
    assert bounds[0] == bounds[1] > 0.0
    embedded = cell().thresholds
    assert embedded is not None and "q0" in {p.path for p in embedded.params}


def test_a_fit_finds_one_for_each_log() -> None:
    logs = {name: log(q, seed, r=0.52) for seed, (name, q) in enumerate(_BEGAN.items())}
    found = cell(r="+- 20%").fit(logs)
    assert [p.name for p in found.parameters] == ["R"]
    R = found.parameters[0]
    assert R.interval is not None and abs(R.value - 0.52) < 1.5 * R.interval < 0.01
    assert {s.log: s.value for s in found.starts} == pytest.approx(_BEGAN, abs=0.02)
    for one in found.starts:
        assert one.name == "q0" and one.unit == "C" and one.interval is not None
        assert abs(one.value - _BEGAN[one.log]) < 2.0 * one.interval < 0.02
    assert found.begun("empty", 0.0) == {"q0": found.starts[2].value}
    assert found.begun("empty", 1.0) == {}
    assert R.tolerance is not None and R.tolerance < 0.05  # three logs tell it


@pytest.mark.parametrize("start", ["+- 50%", ""])
def test_a_fit_uses_what_is_behind_a_gap(start: str) -> None:
    """There the charge is one that nobody knows, declared or not."""
    own = log(10.0)
    keep = (own.time < 15.0) | (own.time > 20.0)
    columns = {name: column[keep] for name, column in own.columns.items()}
    found = cell(start, r="+- 20%").fit({"run": Log(own.time[keep], columns, {}, {})})
    first, behind = found.starts[:-1], found.starts[-1]
    assert [(s.name, s.later) for s in first] == ([("q0", False)] if start else [])
    assert behind.later and behind.time == pytest.approx(20.0, abs=0.1)
    assert behind.value == pytest.approx(10.0 + (1.0 - np.cos(0.9 * behind.time)) / 0.9, abs=0.02)
    assert found.left[0].lost == 0.0 and found.left[0].rows > 3300 / 25  # half a time constant each


def test_a_log_begins_where_least_is_left_of_it() -> None:
    c = cell()
    engine, lasts = started(c.engine(), c.diagnosis_model, samples(c, 6.0), later=False)
    assert engine.parameters["q0"] == pytest.approx(6.0, abs=0.02) and lasts.tolist() == [4000]
    still = samples(c, 6.0)[:20]  # shorter than the warm-up
    assert started(c.engine(), c.diagnosis_model, still, later=False)[1].tolist() == [0]


def test_limits_are_those_of_logs_whose_start_is_known() -> None:
    """Each log by itself at its own start, declared, has the largest residual of them all."""
    c = cell()
    logs = [samples(c, q, seed) for seed, q in enumerate(_BEGAN.values())]
    found = tune(c.engine(), c.diagnosis_model, logs, "digest", 1.0).tuning.limits["r1"]
    known = cell(start="")
    alone = [
        tune(known.engine().configured({"q0": q}), known.diagnosis_model, [own], "digest", 1.0)
        for q, own in zip(_BEGAN.values(), logs, strict=True)
    ]
    sigma = [own.tuning.limits["r1"].sigma for own in alone]
    assert 0.8 * min(sigma) < found.sigma < 1.2 * max(sigma)


_PAIR = """bg 1
model Pair {
    param R = 0.5 Ohm +- 5%
    param a0 = 10 C +- 50%
    param b0 = 10 C +- 50%
    1:s { <- Sf:I; -> 0:ta; -> 0:tb }
    ta { -> De:Va; -> 1:ca }
    ca { -> C:a(q0 = a0) { e = 0.2*q + 0.01*q^2 }; -> R:Ra = R }
    tb { -> De:Vb; -> 1:cb }
    cb { -> C:b(q0 = b0) { e = 0.2*q + 0.01*q^2 }; -> R:Rb = R }
}"""


@cache
def pair() -> Compilation:
    """Two of these cells in series: one current, two charges that nobody knows."""
    return bondgraph.compile(text=_PAIR, rate=_RATE)


def pair_log(a: float, b: float, fault: float = 0.0) -> dict[str, Array]:
    """Both begin elsewhere; the second voltage reads too much in the last quarter."""
    one, other = log(a, 3), log(b, 4)
    volt = other.columns["V"] + fault * (other.time > 30.0)
    return {"t": one.time, "I": one.columns["I"], "Va": one.columns["V"], "Vb": volt}


@pytest.mark.parametrize(("a", "b"), [(10.0, 10.0), (7.0, 12.0), (12.0, 6.0)])
@pytest.mark.parametrize("gap", [False, True])
def test_two_starts_behind_one_current_are_found(a: float, b: float, gap: bool) -> None:
    """A current that is told to have begun elsewhere moves both charges alike."""
    columns = pair_log(a, b)
    if gap:
        columns = {name: np.delete(own, slice(1500, 1700)) for name, own in columns.items()}
    verdicts = bondgraph.monitor(pair(), columns).verdicts[0]
    text = " ".join(v.message for v in verdicts)
    assert "r1 and r2 wait until the machine has shown by its motion what a0 and b0 are" in text
    assert "r1 and r2 are watched from now on" in text and "stand at zero" not in text
    assert gap == ("where they began is known" in text)
    assert not [v for v in verdicts if v.event == "fault"]


def test_a_fault_behind_two_starts_is_named() -> None:
    verdicts = bondgraph.monitor(pair(), pair_log(7.0, 12.0, fault=0.3)).verdicts[0]
    named = [v.candidates[0] for v in verdicts if v.candidates]
    assert named[-1].fault == "Vb" and named[-1].size == pytest.approx(0.3, abs=0.03)


def test_behind_a_kill_the_starts_are_found_anew() -> None:
    """By what a journal holds: the charges have gone on, as behind any gap."""
    columns = pair_log(7.0, 12.0, fault=0.3)
    engine = pair().engine().configured(bandwidth=10.0)
    rows = np.column_stack([columns[k.path] for k in engine.signals])
    first, second = pair().diagnosis(engine), pair().diagnosis(engine)
    part = slice(0, 1500)
    first.update(columns["t"][part], engine.run(rows[part]), rows[part])
    second.resume(json.loads(json.dumps(first.state())))
    again, part = engine.configured(), slice(1500, 4000)
    said = second.update(columns["t"][part], again.run(rows[part]), rows[part])
    faults = [v for v in said if v.event == "fault"]
    assert [round(v.since) for v in faults if v.since is not None] == [30]
    named = [v.candidates[0].fault for v in said if v.candidates]
    assert named[-1] == "Vb"


def test_a_start_that_positions_tell_stands_in_no_integral() -> None:
    """A wheel on a shaft, K (u0 + x1 - x2) = 50 x2'', by encoders; each log begins elsewhere."""
    c = bondgraph.compile(
        text="""bg 1
model Spring {
    param K = 2e3 N.m/rad +- 10%
    param u0 = 1e-3 rad +- 500%
    Se:M -> 1:a -> 0:gap -> 1:b
    a -> I:J1 = 2 kg.m^2
    b -> I:J2 = 50 kg.m^2
    gap -> C:spring(q0 = u0) { e = K*q }
    sensor x1 : rad = int(a.f) counts 1e6/turn
    sensor x2 : rad = int(b.f) counts 1e6/turn
}""",
        rate=_RATE,
    )
    (memory,) = c.diagnosis_model.memories
    assert memory.begins == memory.unknown == ("u0",)
    draw, time = np.random.default_rng(3), np.arange(3000) / _RATE
    waves, logs, began = ((0.015, 1.7), (0.004, 4.1)), {}, []
    for name, phase in (("one", 0.5), ("two", 2.5)):
        turns = [(a, w, np.sin(w * time + phase)) for a, w in waves]
        torque = sum(-50.0 * a * w**2 * s for a, w, s in turns)
        began.append(torque[0] / 2.1e3)  # what the shaft is turned by
        faster = sum(-(w**2) * (a - 50.0 * a * w**2 / 2.1e3) * s for a, w, s in turns)
        x2 = sum(a * s for a, _, s in turns)
        columns = {"M": 2.0 * faster + torque}
        for position, value in (("x1", torque / 2.1e3 + x2), ("x2", x2)):
            counts = np.floor(value * 1e6 / (2.0 * np.pi) + draw.uniform())
            columns[position] = counts - counts[0]  # since the start
        logs[name] = Log(time, columns, {}, {})
    found = c.fit(logs, ["K"])
    assert found.values["K"] == pytest.approx(2.1e3, rel=5e-3)
    for one, truth in zip(found.starts, began, strict=True):
        assert abs(truth) > 4e-4
        assert one.name == "u0" and one.value == pytest.approx(truth, abs=2e-5)


@pytest.mark.parametrize("seed", (1, 2))
def test_a_start_need_not_be_told_from_the_first_count_of_an_encoder(seed: int) -> None:
    """A stiff shaft, u0 + x1 - x2 is less than a count of x1: the threshold has a count."""
    c = bondgraph.compile(
        text="""bg 1
model Spring {
    param K = 2e5 N.m/rad +- 10%
    param u0 = 1e-3 rad +- 500%
    Se:M -> 1:a -> 0:gap -> 1:b
    a -> I:J1 = 2 kg.m^2
    b -> I:J2 = 50 kg.m^2
    gap -> C:spring(q0 = u0) { e = K*q }
    sensor x1 : rad = int(a.f) counts 4096/turn
    sensor x2 : rad = int(b.f)
}""",
        rate=200.0,
    )
    draw, time = np.random.default_rng(seed), np.arange(20000) / 200.0
    turns = [(a, w, np.sin(w * time + 0.5)) for a, w in ((0.15, 1.7), (0.04, 4.1))]
    torque = sum(-50.0 * a * w**2 * s for a, w, s in turns)
    moment = torque + 2.0 * sum(-(w**2) * (a - 50.0 * a * w**2 / 2e5) * s for a, w, s in turns)
    x2 = sum(a * s for a, _, s in turns)
    counts = np.floor((torque / 2e5 + x2) * 4096 / (2.0 * np.pi) + draw.uniform())
    columns = {"M": moment, "x1": counts - counts[0], "x2": x2 + 2e-6 * draw.standard_normal(20000)}
    verdicts = bondgraph.monitor(c, {"t": time, **columns}).verdicts[0]
    text = " ".join(v.message for v in verdicts)
    assert "r2 is watched from now on" in text
    assert not any(v.event == "fault" for v in verdicts)
