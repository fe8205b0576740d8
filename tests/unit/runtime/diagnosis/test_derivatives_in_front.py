"""What a parameter does at an onset that stands behind one derivative, and in front of others.

Beside machines that are simulated until it becomes another one and on: a storage keeps its charge.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

import bondgraph
from bondgraph import Course, Scenario
from bondgraph.compilation import Compilation
from bondgraph.runtime.diagnosis.calibration import tune
from bondgraph.runtime.diagnosis.hypotheses import ALL, Bank, hypotheses
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.engine import copied
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.runtime.simulation.scenario import Fault, Sampling

_TUBE = """bg 1
model Tube {
    input P : W
    input Ta : K
    param Ch = 25 J/K +- 3%
    param Gh = 4 W/K +- 3%
    param mc = 3 W/K +- 3%
    param Ct = 6 J/K +- 3%
    Sf:power = P -> 0:grid
    grid { -> C:Ch(q0 = 10 kJ) }
    grid -> 1:film -> 0:air
    film -> R:rf = 1/Gh
    air { -> C:Ct(q0 = 2.4 kJ) }
    air -> 1:loss -> Se:amb = Ta
    loss -> R:rl = 1/mc
    sensor T : K = air.e
}
"""
_AXIS = """bg 1
model Axis {
    input F : N
    param M = 95 kg
    param Fv = 200 N.s/m
    Se:drive = F -> 1:car
    car { -> I:M; -> R:Fv }
    sensor q : m = int(car.f)
}
"""
_MODELS = {"tube": (_TUBE, 10.0, 0.5, 100.0, 160.0), "axis": (_AXIS, 1000.0, 100.0, 1.0, 1.2)}


def _compiled(name: str) -> Compilation:
    text, rate, bandwidth, *_ = _MODELS[name]
    return bondgraph.compile(Path(f"{name}.bg"), text=text, rate=rate, bandwidth=bandwidth)


def _samples(c: Compilation, name: str, *faults: Fault) -> Array:
    """Of a machine that is simulated in tight steps, without noise."""
    _, rate, _, _, end = _MODELS[name]
    t = np.arange(round(end * rate) + 2) / rate
    moves = {
        "P": 400.0 + 150.0 * np.sin(0.31 * t) + 80.0 * np.sin(0.11 * t),
        "Ta": 294.0 + np.sin(0.02 * t),
        "F": 40.0 * np.sin(9.0 * t) + 20.0 * np.sin(23.0 * t + 1.0),
    }
    signals = [k.path for k in c.engine().signals]
    log = c.simulate(
        Scenario(
            "runs", duration=end, seed=1, start="initial", sampling=Sampling(rate),
            inputs={k: Course(None, tuple(zip(t.tolist(), moves[k].tolist(), strict=True)))
                    for k in signals if k in moves},
            faults=faults, tolerance=1e-10,
        )
    ).log  # fmt: skip
    return np.column_stack([log.columns[path] for path in signals])


def test_how_many_derivatives_may_stand_in_front_is_as_relations_have_it() -> None:
    # P - film - D(Ch*(T + film/Gh)) with film = D(Ct*T) + mc*(T - Ta)
    tube = _compiled("tube").diagnosis_model.dynamic
    assert tube == {"Ch": (0, 1), "Gh": (0, 1), "Ct": (0, 1, ALL), "mc": (0, ALL)}
    # F - Fv*D(q) - D(M*D(q)): what resists has none in front of it, wherever q is zero
    assert _compiled("axis").diagnosis_model.dynamic == {"M": (0, 1), "Fv": (0,)}


@pytest.mark.parametrize(
    ("name", "fault", "factor", "front"),
    [
        ("tube", "Gh", 0.6, 1),
        ("tube", "Gh", 1.5, 1),
        ("tube", "Ch", 1.3, 1),
        ("tube", "mc", 0.8, ALL),
        ("axis", "M", 1.3, 1),
        ("axis", "Fv", 1.3, 0),
    ],
)
def test_it_does_to_a_residual_what_a_machine_does_that_becomes_another_one(
    name: str, fault: str, factor: float, front: float
) -> None:
    c = _compiled(name)
    *_, bandwidth, onset, _ = _MODELS[name]
    rate = _MODELS[name][1]
    samples, begin = _samples(c, name, Fault(fault, "*=", factor, onset)), round(onset * rate) + 1
    engine, model = c.engine().configured(bounds=False), c.diagnosis_model
    seen = copied(engine).run(samples).value[begin:, 0]
    known = [h for h in hypotheses(engine, model.faults, model.units, {}) if h.fault == fault]
    change = model.nominal[fault] * (1.0 - factor)
    now = copied(engine)
    now.run(samples[:begin])
    always = Bank(copied(engine), known, model.nominal, samples[0], {0: change})
    left = always.run(samples[:begin], [begin - 1])[0]

    def off(way: float) -> float:
        """By how much of what is seen at most, within eight time constants of the filter."""
        jumps = Bank(copied(now), known, model.nominal, samples[begin - 1], {0: change})
        bank = jumps
        if way < ALL:
            bank = always.copied()
            bank.onset(left, jumps if way else None)
        moved = bank.run(samples[begin:])[:, 0, 0] * change
        first = round(8.0 / bandwidth * rate)
        return float(np.abs(moved - seen)[:first].max() / np.abs(seen).max())

    found = {way: off(way) for way in (0, 1, ALL)}
    assert found[front] < 0.07
    others = [way for way in found if way != front and found[way] > 0.5]
    assert len(others) >= 1, "what it is not does something else"


def test_what_shows_of_a_film_does_not_depend_on_where_temperatures_are_zero() -> None:
    c, noise = _compiled("tube"), np.random.default_rng(4)
    samples = _samples(c, "tube")
    samples[:, _at(c, "T")] += 0.02 * noise.standard_normal(len(samples))
    celsius = samples.copy()
    celsius[:, [_at(c, "T"), _at(c, "Ta")]] -= 293.15
    kelvins, other = (_shown(c, table) for table in (samples, celsius))
    for fault in ("Gh", "mc"):
        assert other[fault] == pytest.approx(kelvins[fault], rel=0.01)
    assert kelvins["Gh"] > 0.005 * 4.0, "it is no jump of all of the temperature"


def test_a_film_that_wears_is_named() -> None:
    c, noise = _compiled("tube"), np.random.default_rng(5)
    samples = _samples(c, "tube", Fault("Gh", "*=", 0.6, 100.0))
    samples[:, _at(c, "T")] += 0.02 * noise.standard_normal(len(samples))
    engine = c.engine()
    base, watch = engine.configured(), c.diagnosis(engine)
    said: list[Verdict] = []
    for start in range(0, len(samples), 100):
        part = samples[start : start + 100]
        said += watch.update(np.arange(start, start + len(part)) / 10.0, base.run(part), part)
    told = [v for v in said if v.candidates]
    assert told
    for v in told:
        best = max(v.candidates, key=lambda one: one.probability)
        assert best.fault == "Gh" and best.probability > 0.9
    assert best.size == pytest.approx(-1.6, rel=0.2)


def _at(c: Compilation, path: str) -> int:
    return [k.path for k in c.engine().signals].index(path)


def _shown(c: Compilation, samples: Array) -> Mapping[str, float]:
    """The smallest change that is sure to show, infinite for none."""
    found = tune(c.engine(), c.diagnosis_model, [samples], c.program.digest, 10.0)
    return {s.hypothesis.fault: s.size or math.inf for s in found.shown
            if s.hypothesis.kind == "value"}  # fmt: skip
