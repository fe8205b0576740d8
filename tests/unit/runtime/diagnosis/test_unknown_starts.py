"""A charge that is other in each log, and that nobody knows: the samples tell it."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import bondgraph
from bondgraph.pipeline import Compilation
from bondgraph.runtime.diagnosis.calibration import tune
from bondgraph.runtime.diagnosis.unknown_starts import started
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
def test_a_watch_waits_until_the_samples_tell_it(begins: float) -> None:
    text, named = said(cell(), begins)
    assert "r1 waits until the machine has shown by its motion what q0 is" in text
    assert "r1 is watched from now on" in text
    assert "elsewhere" not in text and not named


@pytest.mark.parametrize("begins", _BEGAN.values())
def test_a_fault_that_begins_later_is_seen_and_named(begins: float) -> None:
    _, named = said(cell(), begins, fault=0.3)
    assert named[:1] == ("V",)


def test_without_a_tolerance_the_start_is_what_is_declared() -> None:
    text, _ = said(cell(start=""), 6.0)
    assert "waits" not in text
    assert "began elsewhere than the model declares (where nobody knows it, give the param" in text


def test_a_parameter_that_a_law_reads_too_is_none_of_a_start() -> None:
    def unknown(c: Compilation) -> list[tuple[str, ...]]:
        return [memory.unknown for memory in c.diagnosis_model.memories]

    assert unknown(cell()) == [("q0",)]
    assert unknown(cell(q0="2*q0")) == [("q0",)]
    assert unknown(cell(start="")) == unknown(cell(q0="R*10 C/Ohm")) == [()]


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
    assert found.of_log("empty") == {"R": R.value, "q0": found.starts[2].value}
    assert R.tolerance is not None and R.tolerance < 0.05  # three logs tell it


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
