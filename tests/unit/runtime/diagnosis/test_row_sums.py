"""What rows tell of faults by sums of averages: how these are made, when, and what they are for."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bondgraph.compilation import Compilation
from bondgraph.runtime.diagnosis.hypotheses import Bank, Hypothesis
from bondgraph.runtime.diagnosis.isolation import Rows
from bondgraph.runtime.diagnosis.row_averages import LAGS
from bondgraph.runtime.diagnosis.row_sums import told
from bondgraph.runtime.diagnosis.rows import Average, Row
from bondgraph.runtime.diagnosis.tuning import Limit
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.engine import copied
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.text.source import Source
from tests.unit.runtime.diagnosis.tank import tank

_VESSEL = """bg 1
model Vessel {
    const rho = 1000 kg/m^3
    const g = 9.81 m/s^2
    input q : m^3/s
    input vo
    param A = 0.2 m^2 +- 2%
    param ko = 9e-6 m^3/s.Pa^-0.5 +- 4%
    param leak = 0 m^3/s.Pa^-0.5
    Sf:q -> 0:liquid {
        -> C:water = A/(rho*g)
        -> De:p
        -> R:valve { f = ko*vo*ssqrt(e) }
        -> R:hole { f = leak*ssqrt(e) }
    }
}
"""


def _watched(seed: int, leak: float) -> list[Verdict]:
    """A vessel behind a noisy gauge leaks from 1 500 s on. Its inflow moves every five minutes."""
    vessel = Compilation(Source("vessel.bg", _VESSEL)).with_options(rate=1.0, bandwidth=0.2)
    t, draw = np.arange(2700.0), np.random.default_rng(seed)
    q = 4e-4 * (1.0 + 0.15 * np.repeat(draw.uniform(-1, 1, 9), 300))
    area, ko = 0.2 * draw.uniform(0.99, 1.01), 9e-6 * draw.uniform(0.98, 1.02)
    p, fine = [7e3], 20
    for k in range(len(t) - 1):
        now = p[-1]
        for _ in range(fine):
            out = (ko * 0.5 + leak * (t[k] >= 1500.0)) * math.sqrt(now)
            now += (q[k] - out) * 9810.0 / area / fine
        p.append(now)
    columns = {"q": q, "vo": 0.0 * t + 0.5, "p": np.array(p) + 60.0 * draw.standard_normal(len(t))}
    engine = vessel.engine()
    rows = np.column_stack([columns[k.path] for k in engine.signals])
    diagnosis, said = vessel.diagnosis(engine), []
    for k in range(0, len(t), 300):
        part = rows[k : k + 300]
        said += diagnosis.update(t[k : k + 300], engine.run(part), part)
    return said


@pytest.mark.parametrize("seed", range(4))
def test_a_leak_is_not_told_as_an_area_that_makes_less_of_the_noise(seed: int) -> None:
    """A fifth of the flow; an area of nothing would explain all noise of the level, and its fall.

    A leak and a valve that is wider do the same once the level stands.
    """
    leak = 9e-7
    said = _watched(seed, leak)
    assert not [v for v in said if v.event == "fault" and v.time < 1500.0]
    last = [v for v in said if v.event == "update"][-1]
    found = {c.fault: c for c in last.candidates}
    assert found["leak"].size == pytest.approx(leak, rel=0.3)
    assert sum(found[name].probability for name in ("leak", "ko", "vo")) > 0.7
    assert "A" not in found or found["A"].probability < 0.05


def test_averages_of_slopes_are_those_of_every_sample_by_the_length_of_the_row() -> None:
    engine = tank().engine()
    t = np.arange(160.0)
    columns = {"q": np.sin(0.3 * t) + 2.0, "p": np.cos(0.2 * t) + 3.0}
    samples = np.column_stack([columns[k.path] for k in engine.signals])
    known = [Hypothesis("C", "value", "", 6.0, True), Hypothesis("p", "gain", "", 0.3, False)]
    nominal = {"C": 20.0, "R": 2.0}
    engine.run(samples[:60])  # until its filter has settled
    samples = samples[60:]
    every = Bank(copied(engine), known, nominal).run(samples)
    # rows of 15 samples, of the first of which five came before
    ends, lengths = [9, 24, 39, 54, 69, 84, 99], [15] * 7
    bank = Bank(copied(engine), known, nominal)
    first = bank.rows(samples[:40], ends[:3], lengths[:3])
    then = bank.rows(samples[40:], [end - 40 for end in ends[3:]], lengths[3:])
    last, means = (np.concatenate(both) for both in zip(first, then, strict=True))
    assert last == pytest.approx(every[ends]) and (every[ends] != 0.0).all()
    begins = [0, *[end + 1 for end in ends[:-1]]]
    for row, (begin, end) in enumerate(zip(begins, ends, strict=True)):
        assert means[row] == pytest.approx(every[begin : end + 1].sum(axis=0) / 15.0)


_LIMIT = Limit(1.0, 1.0, 4.0, 9.0, 0.0, 1.0, 0.5, 0.2, 0.5, 0.0, 0.25)


def _row(draw: np.random.Generator, size: float = 1.0, valid: bool = True) -> Row:
    """One residual by one parameter; its average is another number than its last sample."""
    value, mean, slope, tilt, bound, doubt = size * draw.standard_normal(6)
    bounds = [np.abs(np.array([x])) for x in (bound, doubt)]
    sound = np.array([valid])
    average = Average(np.array([mean]), sound, *[2.0 * x for x in bounds], np.array([[tilt]]))
    whole = np.array([value]), np.array([True]), *bounds, np.array([[slope]])
    return Row(0.0, np.zeros((1, 1)), tank().engine(), *whole, average=average)


def test_a_sum_is_an_average_with_so_much_of_those_before_it() -> None:
    draw = np.random.default_rng(4)
    rows = [_row(draw) for _ in range(12)]
    found = told(rows[:LAGS], rows[LAGS:], [np.array([_LIMIT])] * (12 - LAGS))
    assert found.forms.sums.all()
    own = [row.average for row in rows]
    for k, one in enumerate(own[LAGS:], LAGS):
        assert one is not None
        parts = (one, 1.0), (own[k - 1], 0.5), (own[k - 3], 0.25)
        of = {name: sum(w * getattr(x, name) for x, w in parts)
              for name in ("value", "bound", "doubt", "slopes")}  # fmt: skip
        assert found.value[k - LAGS] == pytest.approx(of["value"] - 1.75 * 0.2)
        assert found.bound[k - LAGS] == pytest.approx(of["bound"])
        assert found.doubt[k - LAGS] == pytest.approx(of["doubt"])
        assert found.rest[k - LAGS] == pytest.approx(of["slopes"])
    # its variance is that of the sum, with what is not known of slopes and thresholds
    off = (0.02 * found.bound) ** 2 + (0.02 * found.value) ** 2 + (0.5 * found.doubt) ** 2
    assert 1.0 / found.weights(found.value) == pytest.approx(0.25 + off)


def test_a_last_sample_tells_where_no_sum_is_known_or_a_fault_does_more_than_noise() -> None:
    draw = np.random.default_rng(5)
    limits = [np.array([_LIMIT])] * 8
    for rows, sums in (
        ([_row(draw, valid=k != 6) for k in range(12)], [True, True, False, False, True, False]),
        ([_row(draw, 100.0) for k in range(12)], [False] * 6),
    ):
        found = told(rows[:LAGS], rows[LAGS:], limits)
        assert found.forms.sums[:6, 0].tolist() == sums  # of the sixth row before, and the third
        for k, by_sums in enumerate(found.forms.sums[:, 0].tolist()):
            if not by_sums:
                assert found.value[k] == rows[LAGS + k].value
                assert found.rest[k] == pytest.approx(rows[LAGS + k].slopes)
    # of a unit that is not known, and of averages that are not either, as where a log begins
    unknown = [np.array([_LIMIT._replace(unit=0.0)])] * 8
    assert not told(rows[:LAGS], rows[LAGS:], unknown).forms.sums.any()
    quiet = [_row(draw) for _ in range(3)]
    assert told([], quiet, limits[:3]).forms.sums[:, 0].tolist() == [False, False, False]


def test_a_sum_counts_as_often_as_values_that_share_their_noise_with_the_next() -> None:
    weight, nothing = np.ones((6, 2)), np.zeros((6, 0, 2))
    weight[0] = 0.0
    alone: Array = np.zeros((6, 2), dtype=bool)
    assert Rows(weight, weight, nothing, nothing, alone).values == 10
    alone[:, 1] = True
    assert Rows(weight, weight, nothing, nothing, alone).values == 5 + 2 * 5
