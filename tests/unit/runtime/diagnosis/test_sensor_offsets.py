"""Sensors that are off by a constant about as large as their noise are well."""

from __future__ import annotations

import math
from functools import cache
from itertools import accumulate

import numpy as np
import pytest

from bondgraph.compilation import Compilation
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
from bondgraph.runtime.diagnosis.rows import Part, Row
from bondgraph.runtime.diagnosis.sensor_offsets import SensorOffsets, roughness
from bondgraph.runtime.diagnosis.tuning import UNKNOWN
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.verdict import Verdict
from tests.unit.passes.relations import compiled

_STEP, _STOPS, _ENDS = 0.01, 80.0, 120.0
_R, _NOISE = 2.0, 0.08  # Ohm, V


@cache
def _line() -> Compilation:
    """A resistance with a tolerance between a supply and a load that nobody knows."""
    return compiled(
        "model M { input draw : A unknown; param R = 2 Ohm +- 20%; Se:U -> 1:line; line -> R:R"
        "; line -> Df:i; line -> 0:load; load -> De:y; load -> Sf:sink = draw }"
    ).with_options(rate=1.0 / _STEP)


def _log(seed: int, bias: float, later: float = 0.0) -> Array:
    """U, i and y, where y is off by a bias, and by something more from 100 s on.

    The current is 6 A until 80 s and nothing then: y = U - R i has no other part.
    """
    draw = np.random.default_rng(seed)
    t = np.arange(0.0, _ENDS, _STEP)
    current = np.where(t < _STOPS, 6.0 + 0.05 * np.sin(t), 0.0)
    supply = 24.0 + 0.5 * np.sin(0.3 * t)
    reading = supply - _R * current + bias + np.where(t >= 100.0, later, 0.0)
    told = {"U": supply, "i": current, "y": reading + _NOISE * draw.normal(size=len(t))}
    return np.column_stack([told[k.path] for k in _line().engine().signals])


def _watched(samples: Array) -> list[Verdict]:
    """What is told of a fault."""
    engine = _line().engine().configured(bandwidth=2.0)
    watch, said = _line().diagnosis(engine), []
    time = np.arange(len(samples)) * _STEP
    for k in range(0, len(samples), 500):
        part = samples[k : k + 500]
        said += watch.update(time[k : k + 500], engine.run(part), part)
    return [v for v in said if v.event in ("fault", "update")]


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("bias", [-_NOISE, 0.0, _NOISE])
def test_a_bias_as_large_as_the_noise_is_no_fault_of_a_machine_that_stops(
    seed: int, bias: float
) -> None:
    # while 6 A flow, R takes what the voltmeter is off by; at rest nothing but that is left
    assert _watched(_log(seed, bias)) == []


@pytest.mark.parametrize("seed", range(6))
def test_a_bias_of_many_times_the_noise_is_a_fault(seed: int) -> None:
    said = _watched(_log(seed, 0.0, 10 * _NOISE))
    assert said and 100.0 <= said[0].time < 102.0
    assert "y" in {c.fault for v in said for c in v.candidates}


def test_one_that_sets_in_while_the_machine_goes_on_is_seen_beside_what_was_learned() -> None:
    samples = _log(1, 0.0)
    at = [k.path for k in _line().engine().signals].index("y")
    samples[6000:, at] += 5 * _NOISE
    assert 60.0 <= _watched(samples[:7900])[0].time < 79.0


def test_roughness_is_the_deviation_of_what_is_white() -> None:
    draw, t = np.random.default_rng(4), np.arange(20000) * 0.01
    moving = 3.0 * np.sin(2.0 * t) + 5.0 * t
    noise = draw.normal(0.0, 0.2, len(t))
    empty = np.full(len(t), math.nan)
    found = roughness(np.column_stack([moving, moving + noise, empty]))
    assert found == pytest.approx([0.0, 0.2, 0.0], abs=0.004)


@pytest.mark.parametrize("seed", range(6))
def test_a_root_of_a_difference_that_comes_to_nothing_is_no_fault(seed: int) -> None:
    """A filter between pressures that are read to 250 Pa: its slope is infinite where they agree.

    Air goes at 4e-3 to 1.1e-2 m^3/s, so that 8 to 60 kPa stand across it, and now and then at 3e-4,
    where these are 44 Pa.
    """
    c, draw = _filter(), np.random.default_rng(seed)
    t = np.arange(0.0, 700.0, 0.2)
    wanted = np.repeat(draw.uniform(4e-3, 1.1e-2, 40), 100)[: len(t)]
    wanted[np.arange(len(t)) // 100 % 7 == 5] = 3e-4
    keep = math.exp(-0.2)
    flow = np.array(list(accumulate(wanted, lambda q, new: keep * q + (1.0 - keep) * new)))
    before = 7e5 + 2e4 * np.sin(0.01 * t)
    behind = before - (flow / _KF) ** 2 + 300.0
    told = {"q": flow + 1e-4 * draw.normal(size=len(t))}
    for name, pressure in (("p1", before), ("p2", behind)):
        told[name] = np.round((pressure + 400.0 * draw.normal(size=len(t))) / 250.0) * 250.0
    engine = c.engine().configured(bandwidth=0.25)
    samples = np.column_stack([told[k.path] for k in engine.signals])
    said = c.diagnosis(engine).update(t, engine.run(samples), samples)
    assert [v for v in said if v.event in ("fault", "update")] == []


_KF = 4.5e-5  # m^3/s.Pa^-0.5


@cache
def _filter() -> Compilation:
    return compiled(
        "model M { input use : m^3/s unknown; param kf = 4.5e-5 m^3/s.Pa^-0.5 +- 10%; Se:p1 -> 1:f"
        "; f -> R:kf { f = kf*ssqrt(e) }; f -> Df:q; f -> 0:line; line -> De:p2"
        "; line -> Sf:out = use }"
    ).with_options(rate=5.0)


def test_a_start_that_is_found_while_offsets_are_learned_changes_nothing_of_them() -> None:
    """Rows have its slope from then on, behind those of all else: of offsets ten rows tell."""
    engine = _line().engine()
    offset = Hypothesis("y", "offset", "V", 1.0, False)
    place = {k.path: at for at, k in enumerate(engine.signals)}
    offsets, history = SensorOffsets([offset], 1, place), History(np.array([0.2, 0.0]))
    samples, one = _log(1, 0.0), np.ones(1)
    for k in range(10):
        slopes = np.ones((2 if k < 4 else 3, 1))
        part = samples[500 * k : 500 * (k + 1)]
        sound = np.ones(1, dtype=bool)
        offsets.row(Row(0.0, part, engine, one, sound, one, one, slopes), history)
    assert offsets.known
    assert history.prior == pytest.approx([0.2, _NOISE], rel=0.05)


def test_room_is_what_offsets_may_do_where_something_is_out() -> None:
    """Two residuals and one sensor of a deviation of 2, whose slopes are 3 and 0, then 1 and 5."""
    own = object.__new__(SensorOffsets)
    own._numbers = [1]
    history = History(np.array([7.0, 2.0]))
    slopes = np.zeros((3, 2, 2))
    slopes[0, 1], slopes[1, 1], slopes[2, 1] = (3.0, 0.0), (1.0, 5.0), (9.0, 9.0)
    value = np.array([[50.0, 50.0], [-50.0, 0.0], [0.0, 0.0]])
    bound, none = np.array([[2.0, 2.0], [1.0, 1.0], [1.0, 1.0]]), np.zeros((3, 2))
    part = Part(np.arange(3.0), none, value, none == 0.0, bound, none, slopes)
    line = np.full((3, 2), 10.0)
    # nothing has been learned: two deviations of what they do, less the threshold that there is,
    # and no more than they do at most, as far as if they were spread evenly
    assert own.room(part, line, history) == pytest.approx(
        np.array([
            [min(UNKNOWN * 6.0 - 2.0, math.sqrt(3.0) * 6.0), 0.0],
            [min(UNKNOWN * 2.0 - 1.0, math.sqrt(3.0) * 2.0), 0.0],
            [0.0, 0.0],
        ])
    )
    assert not own.room(part, np.full((3, 2), 99.0), history).any()
    own._numbers = []
    assert not own.room(part, line, history).any()
