"""Sums along what a fault does: what swings is seen, what healthy parameters do is not."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

import bondgraph
from bondgraph import Course, Scenario
from bondgraph.runtime.diagnosis.cusum import Cusum
from bondgraph.runtime.diagnosis.detection import Detection
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.rows import Average, Row
from bondgraph.runtime.diagnosis.score_sums import ScoreSums
from bondgraph.runtime.diagnosis.tuning import Limit, bandwidth_for, height
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.runtime.simulation.scenario import Fault, Sampling

_BETWEEN = 300.0  # rows between false alarms
_TOP = height(1.0, 1.0 / _BETWEEN)
_SWING = np.where(np.arange(4000) // 2 % 2, 1.0, -1.0)  # what a fault does, two rows to each side
_NOTHING = History(np.zeros(0))


def _limits(residuals: int = 1, along: float = 0.0) -> Array:
    return np.array([Limit(1.0, 1.0, 4.0, _TOP, unit=1.0, along=along)] * residuals)


def _row(value: Array, moves: Array, slopes: Array | None = None, bound: float = 0.0) -> Row:
    """Of residuals that one fault moves, (residuals,), and tolerated parameters (n, residuals)."""
    none, valid = np.zeros(len(value)), np.ones(len(value), dtype=bool)
    slopes = np.zeros((0, len(value))) if slopes is None else slopes
    average = Average(value, valid, none + bound, none, slopes)
    return Row(0.0, none, None, value, valid, none + bound, none, slopes, 0.0, average, moves[None])  # type: ignore[arg-type]


def _sums(size: float = 100.0, learns: bool = True) -> ScoreSums:
    """Of a change of one beside such a size, of a parameter that is known within its tolerance."""
    return ScoreSums(np.array([size]), 1, learns, tolerated=[True])


def _first(sums: ScoreSums, values: Array, moves: Array, limits: Array | None = None) -> int | None:
    """The row in which a sum of one residual is too high, None if none ever is."""
    for k, (value, move) in enumerate(zip(values, moves, strict=False)):
        own = _limits() if limits is None else limits
        if sums.add(_row(np.array([value]), np.array([move])), own, _NOTHING).any():
            return k
    return None


def test_noise_comes_to_the_height_a_quarter_as_often_as_to_that_of_a_test_at_most() -> None:
    # no row adds more than a third of it, which is not much here; twenty residuals of independent
    # noise, each begun anew when its sum has come to the height
    draw = np.random.default_rng(1)
    alarms, rows = 0, 3000
    for _ in range(20):
        sums, noise = _sums(learns=False), draw.standard_normal(rows)
        for value, move in zip(noise, _SWING, strict=False):
            if sums.add(_row(np.array([value]), np.array([move])), _limits(), _NOTHING).any():
                alarms += 1
                sums.restart()
    wanted = 20 * rows / _BETWEEN
    assert 0.05 * wanted < alarms < 0.25 * wanted


def test_an_alarm_is_high_until_rows_make_it_twenty_times_as_probable_that_it_is_over() -> None:
    # rows at zero that tell most make it exp(1/2) times as probable each
    sums = _sums(learns=False)
    assert _first(sums, 5.0 * _SWING[:200], _SWING) is not None
    for move in _SWING[:200]:
        sums.add(_row(np.array([5.0 * move]), np.array([move])), _limits(), _NOTHING)
    rows = 0
    while sums.high(_limits()).any():
        sums.add(_row(np.zeros(1), _SWING[rows : rows + 1]), _limits(), _NOTHING)
        rows += 1
    assert rows == math.ceil(math.log(20.0) / (0.5 + 0.01)), "and what the whole of it takes off"


def test_what_swings_is_seen_where_sums_of_the_residual_see_nothing() -> None:
    top = 12.0
    limits = np.array([Limit(1.0, 1.0, 4.0, top, unit=1.0)])
    values = 0.8 * _SWING[:300] + np.random.default_rng(2).standard_normal(300)
    plain = Cusum(1, learns=False)
    assert not any(plain.add(_row(np.array([v]), np.array([1.0])), limits).any() for v in values)
    sums = _sums()
    found = _first(sums, values, _SWING, limits)
    assert found is not None and found < 2.5 * top / (0.8 - 0.5)
    assert sums.onset(limits) == pytest.approx(found, abs=10)
    assert sums.sums[0].any() and sums.high(limits).all()  # that is more of it, not less


@pytest.mark.parametrize("unit", [0.01, 20.0])
def test_the_unit_of_a_residual_makes_no_difference(unit: float) -> None:
    """Its value, its noise, its bound and what a fault does are all so many times as large."""
    draw = np.random.default_rng(6).standard_normal(300)
    values = 0.8 * _SWING[:300] + draw
    found = []
    for size in (1.0, unit):
        limits = np.array([Limit(size, 1.0, 4.0, _TOP, unit=size)])
        sums = _sums(100.0, learns=False)
        rows = [_row(size * values[k : k + 1], size * _SWING[k : k + 1], bound=0.1 * size)
                for k in range(300)]  # fmt: skip
        found.append([bool(sums.add(row, limits, _NOTHING).any()) for row in rows])
    assert any(found[0]) and found[0] == found[1]


def test_what_a_tolerated_parameter_may_do_is_none_of_it() -> None:
    # a deviation for ever, where a parameter that is not known may do two
    draw, constant = np.random.default_rng(3), np.ones((1, 1))
    history = History(np.array([1.0]))
    values = 1.0 + draw.standard_normal(1000)
    for moves in (_SWING, np.ones(1000)):  # to and fro, and always to one side
        sums = _sums()
        for value, move in zip(values, moves, strict=False):
            row = _row(np.array([value]), np.array([move]), constant, bound=2.2)
            assert not sums.add(row, _limits(), history).any()
    sums, seen = _sums(), False
    for value, move in zip(values + 2.0 * _SWING[:1000], _SWING, strict=False):
        row = _row(np.array([value]), np.array([move]), constant, bound=2.2)
        seen |= bool(sums.add(row, _limits(), history).any())
    assert seen  # beside it, less than a bound has room for


def test_a_few_motions_alone_tell_nothing() -> None:
    # a residual that stood on one side, and then stands on the other, as the fault moves it
    slow = np.repeat([1.0, -1.0] * 20, 6)
    history, sums = History(np.array([5.0])), _sums()
    found = None
    for k, move in enumerate(slow):
        row = _row(np.array([5.0 * move]), np.array([move]), np.ones((1, 1)), bound=10.9)
        if found is None and sums.add(row, _limits(), history).any():
            found = k
    assert found is not None and 12 < found < 48


def test_noise_that_is_in_the_slope_as_in_the_residual_is_no_fault() -> None:
    # a tank that is at rest: its area times the noise of a rate is all that there is
    draw, area = np.random.default_rng(4), 3.0
    noise = draw.standard_normal(4000) / area
    found = _first(_sums(area), area * noise, noise)
    assert found is None or found > 3.0 * _BETWEEN  # seldom even for noise that is another one
    other = _first(_sums(), area * noise, noise)
    assert other is not None and other < 0.2 * _BETWEEN  # as much, unexplained


def test_where_a_residual_stands_along_a_direction_is_learned_where_nothing_is_declared() -> None:
    # a parameter without a tolerance that is off, or a gain: from the rows that come first
    draw = np.random.default_rng(6)
    values = 0.8 * _SWING[:1000] + draw.standard_normal(1000)
    assert _first(_sums(), values, _SWING) is not None
    sums = ScoreSums(np.array([100.0]), 1)
    assert _first(sums, values, _SWING) is None
    again = 1.8 * _SWING[:200] + draw.standard_normal(200)  # by as much more
    found = _first(sums, again, _SWING)
    assert found is not None and found < 100


def test_what_no_parameter_explains_is_taken_off_each_row() -> None:
    values = 2.0 * _SWING + np.random.default_rng(5).standard_normal(len(_SWING))
    for doubt in (0.0, 1.9):
        sums = _sums()
        seen = any(
            sums.add(_row(np.array([v]), np.array([m]), bound=doubt), _limits(), _NOTHING).any()
            for v, m in zip(values[:100], _SWING, strict=False)
        )
        assert seen == (doubt == 0.0)


def test_a_tuned_height_is_the_one_that_counts() -> None:
    values = 0.9 * _SWING + np.random.default_rng(2).standard_normal(len(_SWING))
    low = _first(_sums(learns=False), values, _SWING, _limits(along=5.0))
    high = _first(_sums(learns=False), values, _SWING, _limits(along=40.0))
    assert low is not None and high is not None and low < high


def test_a_state_goes_through_json_and_sums_go_on() -> None:
    values = 0.9 * _SWING + np.random.default_rng(2).standard_normal(len(_SWING))
    slopes, history = np.ones((1, 1)), History(np.array([0.1]))
    one = _sums()

    def add(sums: ScoreSums, k: int) -> list[float]:
        sums.add(_row(values[k : k + 1], _SWING[k : k + 1], slopes), _limits(), history)
        return [*sums.sums.ravel(), *sums.beyond.ravel(), *sums.held, sums.onset(_limits())]

    for k in range(14):
        add(one, k)
    other = _sums().resumed(json.loads(json.dumps(one.state())))
    assert one.sums.any()
    for k in range(14, 40):
        # the averages of rows are not kept: here they are added to none
        assert add(other, k) == pytest.approx(add(one, k))
    with pytest.raises((KeyError, TypeError, ValueError)):
        one.resumed({**one.state(), "learned": [[1.0]]})


def test_a_detection_fires_by_them_before_and_behind_its_state() -> None:
    values = 0.8 * _SWING[:300] + np.random.default_rng(2).standard_normal(300)
    limits, fired = np.array([Limit(1.0, 1.0, 9.0, 12.0, unit=1.0)]), []
    for again in (0, 20):  # from where it goes on with a state
        detection = Detection(["r1"], 3, learns=False, scores=_sums(learns=False))
        for k in range(300):
            if again and k == again:
                detection = detection.resumed(json.loads(json.dumps(detection.state())))
            row = _row(values[k : k + 1], _SWING[k : k + 1])
            if detection.row(row, limits, _NOTHING).any():
                fired.append(k)
                break
    assert len(fired) == 2 and fired[0] == fired[1] > 20


def test_where_nothing_is_known_nothing_is_added() -> None:
    sums = _sums()
    row = _row(np.array([9.0]), np.array([1.0]))
    assert not sums.add(row._replace(average=None), _limits(), _NOTHING).any()
    assert not sums.add(row, np.array([Limit(1.0, 1.0, 4.0, _TOP)]), _NOTHING).any()
    assert not sums.sums.any() and not sums.held.any() and not sums.onset(_limits())
    none = ScoreSums(np.zeros(0), 1)  # a model without such faults
    empty = row._replace(directions=np.zeros((0, 1)))
    assert not none.add(empty, _limits(), _NOTHING).any() and not none.held.any()


_AXIS = """bg 1
model Axis {
    input F : N
    param m = 20 kg +- 5%
    param b = 8 N.s/m +- 10%
    Se:F -> 1:slide
    slide -> I:m
    slide -> R:b
    slide -> Df:v
}
"""


def _sway(seed: int, fault: Fault | None) -> Array:
    """240 s of a slide that a force moves to and fro, at 100 Hz; the speed is noisy."""
    draw, time = np.random.default_rng(seed), np.arange(24_002) / 100.0
    force = sum(30.0 * np.sin(2 * np.pi * time * draw.uniform(0.2, 1.0) + draw.uniform(0, 6))
                for _ in range(3))  # fmt: skip
    c = bondgraph.compile(text=_AXIS, rate=100.0)
    course = Course(None, tuple(zip(time.tolist(), force.tolist(), strict=True)))
    scenario = Scenario(
        "sway", duration=240.0, seed=seed, start="initial", inputs={"F": course},
        sampling=Sampling(100.0), faults=() if fault is None else (fault,),
    )  # fmt: skip
    columns = c.simulate(scenario).log.columns
    speed = columns["v"] + 0.4 * draw.standard_normal(len(columns["v"]))
    return np.column_stack([columns["F"], speed])


@pytest.mark.parametrize("seed", [11, 12])
def test_a_load_that_becomes_heavier_is_seen_while_it_is_moved_to_and_fro(seed: int) -> None:
    heavier = Fault("m", "*=", 1.2, 120.0, math.inf, 0.0, 0.0, 1.0, "20 % more")
    assert not _said(_sway(seed, None))
    fault, *later = _said(_sway(seed, heavier))  # no sample is ever too far, and no other sum
    assert 120.0 < fault.time < 200.0
    (mass,) = [one for one in later[-1].candidates if one.fault == "m"]
    assert "m" in later[-1].group  # one residual tells none of its faults from the others
    assert mass.size == pytest.approx(4.0, rel=0.25)


def _said(samples: Array) -> list[Verdict]:
    c = bondgraph.compile(text=_AXIS, rate=100.0)
    engine = c.engine().configured(bandwidth=bandwidth_for(100.0, len(samples)))
    time, batch = np.arange(len(samples)) / 100.0, engine.configured().run(samples)
    return [v for v in c.diagnosis(engine).update(time, batch, samples) if v.event != "warm-up"]
