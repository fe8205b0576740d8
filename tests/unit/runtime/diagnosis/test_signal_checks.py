"""Spikes, bursts of noise and values that stand still, of signals made by hand."""

from __future__ import annotations

import json
import math
from collections.abc import Collection, Sequence
from typing import Any

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.signal_checks import _SMOOTH, SignalChecks, Unusual
from bondgraph.runtime.log import Array

_STEP, _ROW = 0.01, 25


def _signals(seed: int, count: int = 4000) -> Array:
    """A resonance at nine samples a period, a flow that is set in steps, a slow temperature."""
    draw = np.random.default_rng(seed)
    k = np.arange(count)
    size = 1.0 + 0.5 * np.sin(k / 300.0)
    ringing = size * np.sin(2.0 * np.pi * k / 9.0) + 0.01 * draw.normal(size=count)
    steps = np.repeat(draw.uniform(0.0, 1.0, count // 40), 40) + 0.005 * draw.normal(size=count)
    slow = 300.0 + np.cumsum(0.02 * draw.normal(size=count)) + 0.05 * draw.normal(size=count)
    return np.column_stack([ringing, steps, slow])


def _looked(samples: Array) -> list[Unusual]:
    checks = SignalChecks(["y", "q", "T"], [0, 1, 2], _STEP)
    return [
        one
        for k in range(0, len(samples) - _ROW + 1, _ROW)
        for one in checks.row((k + _ROW - 1) * _STEP, samples[k : k + _ROW], not checks.active)
    ]


@pytest.mark.parametrize("seed", range(10))
def test_healthy_signals_are_not_unusual(seed: int) -> None:
    assert _looked(_signals(seed)) == []


@pytest.mark.parametrize(("column", "name", "size", "at"), [
    (0, "y", 1.0, 2510), (1, "q", 1.0, 2510), (2, "T", 2.0, 2510),
    (1, "q", 1.0, 2498), (2, "T", 2.0, 2498),  # the end of a row, told with the next one
    (1, "q", 0.1, 2510),  # steps are farther from what their neighbours let expect
])  # fmt: skip
def test_a_spike_is_told_with_its_time(column: int, name: str, size: float, at: int) -> None:
    samples = _signals(3)
    usual = np.ptp(samples[:2475, column])
    samples[at, column] += size
    (one,) = _looked(samples)
    assert (one.signal, one.kind) == (name, "spike")
    assert one.since == pytest.approx(at * _STEP, abs=1.5 * _STEP)
    assert one.now * usual == pytest.approx(size, rel=0.15)
    assert one.before < 0.5 * one.now


def _road(seed: int, spread: float) -> Array:
    """Eight seconds at 200 Hz of an acceleration over a road, louder and softer within a second."""
    draw, size = np.random.default_rng(seed), 0.0
    loud = np.empty(1600)
    for k in range(len(loud)):
        size += -size / 100.0 + math.sqrt(2.0 / 100.0) * draw.normal()
        loud[k] = math.exp(spread * size)
    rough = loud * draw.normal(size=len(loud))
    for _ in range(2):
        rough = np.convolve(rough, [0.25, 0.5, 0.25], "same")
    return rough[:, None]


def _spikes(samples: Array) -> list[float]:
    checks, found = SignalChecks(["a"], [0], 0.005), []
    for k in range(0, len(samples) - 24, 25):
        row = checks.row((k + 24) * 0.005, samples[k : k + 25], not checks.active)
        found += [one.since for one in row if one.kind == "spike"]
    return found


@pytest.mark.parametrize("spread", [0.7, 1.0, 1.3])
def test_of_few_samples_the_farthest_says_little_of_a_road(spread: float) -> None:
    assert sum(bool(_spikes(_road(seed, spread))) for seed in range(60)) <= 1
    for seed in range(10):
        samples = _road(seed, spread)
        samples[1210] += 5.0 * np.abs(samples[:1200]).max()
        assert any(abs(since - 1210 * 0.005) < 0.01 for since in _spikes(samples))


def test_a_step_is_no_spike() -> None:
    samples = _signals(4)
    samples[2000:] += [1.0, 1.0, 5.0]
    assert [one for one in _looked(samples) if one.kind == "spike"] == []


@pytest.mark.parametrize("seed", range(5))
def test_a_current_that_overshoots_at_each_step_of_a_command_has_no_spikes(seed: int) -> None:
    """A first-order current behind a voltage that steps, with the part of a sample that the step
    comes late in it: the first sample behind a step is a little above those that follow."""
    draw = np.random.default_rng(seed)
    count, turn = 20_000, 2243
    at = np.arange(count)
    side = np.where((at // turn) % 2 == 0, 1.0, -0.5)
    peak = np.where(at % turn == 0, 0.06 * draw.uniform(0.5, 1.0, count), 0.0) * np.sign(side)
    current = side + peak + 0.002 * draw.normal(size=count)
    slow = 300.0 + np.cumsum(0.02 * draw.normal(size=(count, 2)), axis=0)
    assert _looked(np.column_stack([slow[:, 0], current, slow[:, 1]])) == []


@pytest.mark.parametrize("seed", range(5))
def test_a_position_that_leaves_zero_has_no_burst(seed: int) -> None:
    """Noise around zero is foretold best by zero; a way that is gone then is no noise."""
    draw = np.random.default_rng(seed)
    at = np.arange(15_000) * 0.002
    ways = np.square(np.maximum(at - 1.0, 0.0))[:, None] * [1.0, 0.1, 0.001]
    assert _looked(ways + 0.002 * draw.normal(size=ways.shape)) == []


@pytest.mark.parametrize(("column", "name", "size"), [(0, "y", 0.5), (2, "T", 1.0)])
def test_a_burst_is_told_once_and_ends(column: int, name: str, size: float) -> None:
    samples = _signals(5)
    samples[2000:2400, column] += size * np.random.default_rng(1).normal(size=400)
    (one,) = _looked(samples)
    assert (one.signal, one.kind) == (name, "burst")
    assert one.since == pytest.approx(2000 * _STEP, abs=2 * _ROW * _STEP)


@pytest.mark.parametrize(
    ("suspects", "other", "told"),
    [((), False, []), (("q", "T"), False, ["q"]), (("T",), False, []), (("q", "T"), True, [])],
)
def test_noise_that_is_small_beside_the_range_is_told_where_residuals_see_it(
    suspects: tuple[str, ...], other: bool, told: list[str]
) -> None:
    """Four times as loud is 1 % of the range of q; it is the machine if T is louder too."""
    draw = np.random.default_rng(6)
    k, start = np.arange(6000), 5000
    samples = np.column_stack([
        np.sin(k / 300.0) + 0.005 * draw.normal(size=6000),
        2.0 * np.sin(k / 200.0) + 0.01 * draw.normal(size=6000),
        300.0 + 2.0 * np.sin(k / 250.0) + 0.01 * draw.normal(size=6000),
    ])  # fmt: skip
    samples[start:, 1] += 0.04 * draw.normal(size=1000)
    if other:
        samples[start:, 2] += 0.03 * draw.normal(size=1000)
    checks = SignalChecks(["y", "q", "T"], [0, 1, 2], _STEP)
    found = []
    for at in range(0, 6000 - _ROW + 1, _ROW):
        healthy, time = at < start, (at + _ROW - 1) * _STEP
        found += checks.row(time, samples[at : at + _ROW], healthy, () if healthy else suspects)
    assert {one.signal for one in found} == set(told)
    assert all(time <= 5500 * _STEP for time in [one.since for one in found[:1]])


@pytest.mark.parametrize(("column", "name"), [(0, "y"), (1, "q"), (2, "T")])
def test_a_signal_that_stands_still_is_told(column: int, name: str) -> None:
    samples = _signals(6)
    samples[2000:, column] = samples[2000, column]
    (one,) = _looked(samples)
    assert (one.signal, one.kind) == (name, "stuck")
    assert one.since == pytest.approx(2000 * _STEP, abs=3 * _STEP)


@pytest.mark.parametrize("seed", range(5))
def test_that_a_reading_in_steps_of_a_converter_stands_still_is_told_in_short_rows(
    seed: int,
) -> None:
    """Half its samples change, but in some row of 15 only two do."""
    draw = np.random.default_rng(seed)
    k = np.arange(4500)
    wave = 20.0 + 3.0 * np.sin(k / 250.0)
    samples = np.column_stack([np.round(wave + 0.08 * draw.normal(size=4500), 1), wave])
    samples[4000:, 0] = samples[4000, 0]
    checks = SignalChecks(["T", "w"], [0, 1], _STEP)
    rows = [samples[at : at + 15] for at in range(0, 4500, 15)]
    said = [one for n, row in enumerate(rows) for one in checks.row(n * 15 * _STEP, row, n < 266)]
    assert [(one.signal, one.kind) for one in said] == [("T", "stuck")]


def test_a_command_without_noise_may_be_held() -> None:
    samples = _signals(7)
    samples[:, 1] = np.repeat([0.0, 1.0, 0.3, 0.6], 1000)
    samples[1500:2500, 1] = 0.3  # held for longer than ever
    assert _looked(samples) == []


@pytest.mark.parametrize(("value", "told"), [(0.5, True), (1.2, False), (-0.2, False)])
def test_a_command_of_a_controller_may_stand_at_its_limits(value: float, told: bool) -> None:
    samples = _signals(6)
    samples[3000:3400, 1] = value
    checks = SignalChecks(["y", "q", "T"], [0, 1, 2], _STEP, inputs=("q",))
    rows = [samples[k : k + _ROW] for k in range(0, len(samples) - _ROW + 1, _ROW)]
    said = [one for k, row in enumerate(rows) for one in checks.row(k * _ROW * _STEP, row, True)]
    assert [(one.signal, one.kind) for one in said] == [("q", "stuck")] * told


@pytest.mark.parametrize("seed", range(3))
def test_two_spikes_that_are_close_are_not_what_the_signal_does(seed: int) -> None:
    """Of two as large and as close none is alone, and neither is told; later ones are as before."""
    samples = _signals(seed, 6000)
    samples[[2005, 2015, 4510], 2] += 3.0
    (one,) = (one for one in _looked(samples) if one.signal == "T")
    assert (one.kind, round(one.since / _STEP)) == ("spike", 4510)


def _fan(seed: int) -> Array:
    """A fan that stands, runs and stands, and its power: nothing but zeros while it stands."""
    draw = np.random.default_rng(seed)
    k = np.arange(4000)
    fan = np.where((k >= 1500) & (k < 3000), 0.4 + 0.2 * ((k // 300) % 3), 0.0)
    power = np.round(180.0 * fan**3 * (1.0 + 0.05 * draw.normal(size=4000)), 1)
    return np.column_stack([fan, power])


def _fan_looked(
    samples: Array, start: int = 0, suspects: Collection[str] = ()
) -> list[Unusual]:
    checks = SignalChecks(["fan", "P"], [0, 1], _STEP, inputs=("fan",))
    rows = [(k, samples[k : k + _ROW]) for k in range(start, len(samples) - _ROW + 1, _ROW)]
    return [
        one
        for k, row in rows
        for one in checks.row((k + _ROW - 1) * _STEP, row, not checks.active, suspects)
    ]


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("start", [0, 1500])
def test_a_machine_that_is_switched_on_or_off_is_neither_noisy_nor_stuck(
    seed: int, start: int
) -> None:
    assert _fan_looked(_fan(seed), start) == []


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("dies", [False, True])
def test_a_rotor_that_runs_out_is_not_stuck_and_one_that_is_told_to_stand_is(
    seed: int, dies: bool
) -> None:
    """Friction stops it 3 s behind its command, and no noise is left; what dies reads 0 before."""
    t, draw = np.arange(4000) * _STEP, np.random.default_rng(seed)
    on = np.where(t < 27.0, 1.0 + 0.3 * np.sin(0.5 * t), 0.0)
    speed = np.where(t < 27.0, 60.0 * on, np.maximum(22.0 * (30.0 - t), 0.0))
    speed = np.round(speed * (1.0 + 0.01 * draw.normal(size=4000) * (t < 27.0)), 1)
    if dies:
        speed[t >= 28.2] = 0.0
    told = [one for one in _fan_looked(np.column_stack([on, speed])) if one.kind == "stuck"]
    assert [one.signal for one in told] == (["P"] if dies else [])


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("suspect", [False, True])
def test_a_position_that_dies_on_its_way_is_told_where_residuals_see_it(
    seed: int, suspect: bool
) -> None:
    """It goes on at full speed, and its reading stays where it had come furthest."""
    t, draw = np.arange(4000) * _STEP, np.random.default_rng(seed)
    speed = np.where(t < 20.0, 0.4 * np.sin(t), 1.0)
    way = np.cumsum(speed) + 0.05 * draw.normal(size=4000)
    way[2800:] = way[2800]
    told = _fan_looked(np.column_stack([speed, way]), suspects=["P"] if suspect else [])
    assert [one.kind for one in told if one.signal == "P"] == (["stuck"] if suspect else [])


@pytest.mark.parametrize("seed", range(5))
def test_a_power_that_stands_still_while_the_fan_runs_is_told(seed: int) -> None:
    samples = _fan(seed)
    samples[2650:, 1] = samples[2650, 1]
    (one,) = _fan_looked(samples, 1500)
    assert (one.signal, one.kind) == ("P", "stuck")
    assert one.since == pytest.approx(2650 * _STEP, abs=3 * _STEP)


@pytest.mark.parametrize("seed", range(5))
def test_a_power_that_dies_while_the_fan_has_long_run_at_its_most_is_told(seed: int) -> None:
    samples = _fan(seed)
    samples[2100:, 0] = 0.8
    samples[2100:, 1] = np.round(92.0 + 4.0 * np.random.default_rng(seed).normal(size=1900), 1)
    samples[3300:, 1] = 0.0
    told = [one for one in _fan_looked(samples, 1500) if one.kind == "stuck"]
    assert [one.signal for one in told] == ["P"]
    assert told[0].since == pytest.approx(3300 * _STEP, abs=3 * _STEP)


def test_what_comes_back_soon_is_not_told_each_time() -> None:
    samples = _signals(8)
    samples[2000:4000:130, 2] += 3.0  # sixteen spikes, one in five rows
    told = _looked(samples)
    assert {one.kind for one in told} == {"spike"} and len(told) <= 3


@pytest.mark.parametrize("most", [2, 8])
def test_what_comes_back_is_held_for_no_more_rows_than_a_pause_has(most: int) -> None:
    """Spikes in one row of four, then none: with a pause of 8 rows they are one alarm."""
    samples = _signals(8)
    samples[2000:3200:104, 2] += 3.0
    checks, told = SignalChecks(["y", "q", "T"], [0, 1, 2], _STEP, pause=most), 0
    for row, k in enumerate(range(0, len(samples) - _ROW + 1, _ROW)):
        told += len(checks.row(row, samples[k : k + _ROW], not checks.active))
        assert not checks.active or row <= 3144 // _ROW + most + 1
    assert (told == 12) if most == 2 else (told <= 2)


def test_missing_samples_begin_anew() -> None:
    samples = _signals(9)
    samples[1000:1100, 0] = np.nan
    assert _looked(samples) == []


@pytest.mark.parametrize("dead", [0, 30, 1700])
def test_a_sensor_that_dies_hides_nothing_of_the_others(dead: int) -> None:
    samples = _signals(3)
    samples[dead:, 0] = np.nan
    samples[2510, 2] += 2.0
    (one,) = _looked(samples)
    assert (one.signal, one.kind) == ("T", "spike")


@pytest.mark.parametrize("at", range(2500, 2525, 2))
def test_noise_that_sets_in_within_a_row_is_told(at: int) -> None:
    """And not learned with that row, so that the next one is no louder than ever."""
    samples, draw = _signals(5), np.random.default_rng(at)
    more = 0.3 * np.minimum(np.arange(len(samples) - at) / 50.0, 1.0)  # in two rows
    samples[at:, 2] += more * draw.normal(size=len(more))
    said = _looked(samples)
    assert ("T", "burst") in {(one.signal, one.kind) for one in said}
    assert {one.signal for one in said} == {"T"}


def test_a_signal_that_stands_ever_longer_at_first_is_not_stuck() -> None:
    """Known for 200 samples in which it stood for one: what it does then is learned at once."""
    samples = _signals(7)
    for at, run in ((100, 2), (206, 8), (231, 15), (251, 24)):
        samples[at : at + run, 1] = samples[at, 1]
    assert _looked(samples) == []


def test_spikes_that_come_again_and_again_are_not_told_each_time() -> None:
    """Every eleven rows: twice, and then they are there."""
    samples = _signals(6)
    samples[2510::275, 1] += 1.0
    assert [(one.signal, one.kind) for one in _looked(samples)] == [("q", "spike")] * 2


def test_a_burst_of_a_sensor_that_dies_is_over() -> None:
    samples = _signals(5)
    samples[2000:2200, 2] += np.random.default_rng(1).normal(size=200)
    samples[2200:, 2] = np.nan
    checks = SignalChecks(["y", "q", "T"], [0, 1, 2], _STEP)
    active = []
    for k in range(0, len(samples) - _ROW + 1, _ROW):
        checks.row((k + _ROW - 1) * _STEP, samples[k : k + _ROW], not checks.active)
        active.append("T" in checks.active)
    assert any(active) and not active[-1]


def test_a_machine_with_encoders_only_has_nothing_to_look_at() -> None:
    checks = SignalChecks([], [], _STEP)
    assert checks.row(0.0, _signals(1)[:_ROW], True) == []
    other = SignalChecks([], [], _STEP)
    other.resume(json.loads(json.dumps(checks.state())))
    assert other.active == {}


def test_what_is_known_outlasts_a_restart() -> None:
    """The one that goes on says what the other would have said, and ends it as soon."""
    samples = _signals(5)
    samples[2000:2100, 2] += np.random.default_rng(1).normal(size=100)
    samples[3000, 0] += 1.0
    one, other = (SignalChecks(["y", "q", "T"], [0, 1, 2], _STEP) for _ in range(2))
    told: list[list[Unusual]] = [[], []]
    for k in range(0, len(samples) - _ROW + 1, _ROW):
        if k == 2050:  # the burst is active
            assert "T" in one.active
            other.resume(json.loads(json.dumps(one.state())))
            assert other.active == one.active
        row = (k + _ROW - 1) * _STEP, samples[k : k + _ROW], not one.active
        found = one.row(*row)
        if k >= 2050:
            told[0] += found
            told[1] += other.row(*row)
            assert ("T" in other.active) == ("T" in one.active)
    assert [u[:2] for u in told[0]] == [("y", "spike")] == [u[:2] for u in told[1]]


@pytest.mark.parametrize("count", [2, 3])
def test_a_state_with_a_second_measure_of_spikes_is_taken(count: int) -> None:
    columns, samples = list(range(count)), _signals(5)
    one, other = (SignalChecks(["y", "q", "T"][:count], columns, _STEP) for _ in range(2))
    for k in range(0, 2000, _ROW):
        one.row((k + _ROW - 1) * _STEP, samples[k : k + _ROW], True)
    state = json.loads(json.dumps(one.state()))
    at = next(k for k, table in enumerate(one._learned()) if table is one._far)
    before = {**state, "learned": [*state["learned"]]}
    before["learned"][at] = [state["learned"][at], [9.0] * count]
    other.resume(before)
    assert other.state() == state


@pytest.mark.parametrize(
    "state",
    [
        [["y", "burst", 1.0, 2.0]],
        {"learned": [], "active": [["y", "burst", None, 1.0, 0.1, 3]]},
        {"learned": [[1.0]], "active": []},
        {"learned": [[]] * 11, "active": []},
        {"active": []},
    ],
)
def test_a_state_of_another_kind_is_refused(state: Any) -> None:
    with pytest.raises((KeyError, TypeError, ValueError)):
        SignalChecks(["y"], [0], _STEP).resume(state)


def test_what_an_input_does_as_never_before_is_no_fault_of_a_sensor() -> None:
    """A machine that idles, and follows an input that begins to jump."""
    draw = np.random.default_rng(11)
    u = 1.0 + 0.01 * draw.normal(size=4000)
    u[2000:] += draw.choice([-1.0, 1.0], 2000)
    y = np.convolve(u, [0.5, 0.3, 0.2])[:4000] + 0.005 * draw.normal(size=4000)
    rows = [np.column_stack([u, y])[k : k + _ROW] for k in range(0, 4000, _ROW)]
    seen = {}
    for inputs in ((), ("u",)):
        checks = SignalChecks(["u", "y"], [0, 1], _STEP, inputs)
        said, lately = [], False
        for k, row in enumerate(rows):
            said += checks.row(k * 1.0, row, True)
            lately |= checks.lately("u")
        seen[inputs] = {one.signal for one in said}
        # and no alarm of residuals is put down to an input of which nothing was told
        assert lately == (inputs == ())
    assert seen == {(): {"u", "y"}, ("u",): set()}


@pytest.mark.parametrize("seed", range(4))
def test_noise_that_was_told_goes_on_whatever_a_controller_makes_of_it(seed: int) -> None:
    """A temperature whose noise grows, and a valve that follows what is read of it.

    At first the valve is as quiet as ever, then it moves as never before: it is told of nothing.
    """
    draw = np.random.default_rng(seed)
    at = np.arange(6000)
    loud = np.where((at >= 3000) & (at < 5000), np.where(at < 3200, 0.5, 2.0), 0.05)
    read = 20.0 + 5.0 * np.sin(at / 400.0) + loud * draw.normal(size=6000)
    valve = 0.5 + 0.05 * np.sin(at / 150.0) + 0.006 * (read - 20.0)
    samples, said = np.column_stack([valve, read]), []
    checks = SignalChecks(["v", "T"], [0, 1], _STEP, ("v",))
    active = []
    for k in range(0, 6000, _ROW):
        if k == 4000:
            checks.restart()  # the samples begin anew
        said += checks.row(k * _STEP, samples[k : k + _ROW], not checks.active)
        active += [k] * ("T" in checks.active)
    assert [(one.signal, one.kind) for one in said] == [("T", "burst")]
    assert active[0] <= 3100 and 5000 <= active[-1] <= 5300
    assert active == list(range(active[0], active[-1] + 1, _ROW))


@pytest.mark.parametrize("late", [1, 2, 0, -1])
@pytest.mark.parametrize("seed", range(3))
def test_a_spike_that_a_controller_answers_is_that_of_its_sensor(late: int, seed: int) -> None:
    """A valve that follows a temperature so many samples later; or one that leads it.

    What comes first is the cause: behind a valve that jumps as never before a temperature may.
    """
    draw = np.random.default_rng(seed)
    at = np.arange(4000)
    read = 20.0 + 5.0 * np.sin(at / 400.0) + 0.05 * draw.normal(size=4000)
    spikes = [2510, 2903, 3407]
    read[spikes] += 4.0
    valve = 0.5 + 0.02 * (np.roll(read, late) - 20.0)
    checks, said = SignalChecks(["v", "T"], [0, 1], _STEP, ("v",)), []
    for k in range(0, 4000, _ROW):
        part = np.column_stack([valve, read])[k : k + _ROW]
        said += checks.row((k + _ROW - 1) * _STEP, part, not checks.active)
    assert {(one.signal, one.kind) for one in said} == ({("T", "spike")} if late > 0 else set())
    assert [round(one.since / _STEP) for one in said] == (spikes if late > 0 else [])


@pytest.mark.parametrize("late", [1, 2, 0, -1])
@pytest.mark.parametrize("seed", range(3))
def test_noise_that_a_controller_passes_on_at_once_is_that_of_its_sensor(
    late: int, seed: int
) -> None:
    """As before, with a temperature that becomes noisy, or a valve that the temperature follows."""
    draw = np.random.default_rng(seed)
    at = np.arange(4000)
    loud = np.where((at >= 2500) & (at < 3200), 2.0, 0.05)
    read = 20.0 + 5.0 * np.sin(at / 400.0) + loud * draw.normal(size=4000)
    valve = 0.5 + 0.02 * (np.roll(read, late) - 20.0) + 1e-4 * draw.normal(size=4000)
    checks, said = SignalChecks(["v", "T"], [0, 1], _STEP, ("v",)), []
    for k in range(0, 4000, _ROW):
        part = np.column_stack([valve, read])[k : k + _ROW]
        said += checks.row((k + _ROW - 1) * _STEP, part, not checks.active)
    assert [(one.signal, one.kind) for one in said] == ([("T", "burst")] if late > 0 else [])


@pytest.mark.parametrize(("resistance", "noise", "told"), [(1.6, 0.0, False), (1.0, 0.8, True)])
def test_a_resistance_that_has_grown_is_no_noise_of_the_sensor_that_shows_it(
    resistance: float, noise: float, told: bool
) -> None:
    """A current 1.8 times as restless as ever makes a voltage that is 2.9 times so at 1.6 Ohm.

    Rows are restless in the same way, so that these ratios are exact.
    """
    draw = np.random.default_rng(12)
    at = np.arange(8000)
    restless = np.where((at >= 6000) & (noise == 0.0), 1.8, 1.0)
    current = 8.0 * np.sin(at / 300.0) + restless * np.tile(draw.normal(size=_ROW), 320)
    volt = np.where(at >= 6000, resistance, 1.0) * current + 0.01 * draw.normal(size=8000)
    volt[6000:] += 3.0 * noise * np.tile(draw.normal(size=_ROW), 80)
    checks = SignalChecks(["I", "V"], [0, 1], _STEP, ("I",))
    samples, said = np.column_stack([current, volt]), []
    for k in range(0, 8000, _ROW):
        said += checks.row(k * _STEP, samples[k : k + _ROW], k < 6000)
    assert [(one.signal, one.kind) for one in said] == ([("V", "burst")] if told else [])



@pytest.mark.parametrize("kind", ["command", "mode"])
def test_a_current_into_a_capacitor_that_is_switched_on_is_no_spike(kind: str) -> None:
    # i = U/R exp(-t/(R C)), gone within a sample: R C is half of one
    draw = np.random.default_rng(9)
    t, on = np.arange(4000) * _STEP, np.zeros(4000)
    current = 0.2 * np.sin(0.7 * t) + 0.01 * draw.normal(size=4000)
    for at in (1010, 2510, 3010):
        on[at : at + 300] = 1.0
        current[at:] += (0.0, 3.0, 9.0, 5.0)[at // 1000] * np.exp(-(t[at:] - t[at]) / (_STEP / 2))
    samples = np.column_stack([on, current])
    assert _switched(samples, kind) == []
    samples[3700, 1] += 3.0  # where nothing is switched
    (one,) = _switched(samples, kind)
    assert (one.signal, one.kind) == ("i", "spike")
    assert one.since == pytest.approx(37.0, abs=1.5 * _STEP)


def test_a_spike_beside_a_command_that_is_held_over_some_samples_is_one() -> None:
    draw = np.random.default_rng(3)
    held = np.repeat(draw.normal(size=800), 5)  # steps at each fifth sample: none of them is rare
    current = 0.01 * draw.normal(size=4000)
    current[3700] += 1.0
    assert [one.signal for one in _switched(np.column_stack([held, current]), "command")] == ["i"]


@pytest.mark.parametrize("late", [-1, 0, 1, 2])
@pytest.mark.parametrize("kind", ["command", "mode"])
def test_a_spike_at_a_step_of_a_slow_controller_is_one_once_its_answers_are_known(
    kind: str, late: int
) -> None:
    """A controller that is twenty times slower than the log: one step in each row, rare there."""
    command, current = _slow_controller(4000)
    current[3500 + late] += 1.0  # five times as large as any of the 170 answers before
    (one,) = _switched(np.column_stack([command, current]), kind)
    assert one[:2] == ("i", "spike")
    assert one.since == pytest.approx((3500 + late) * _STEP, abs=1.5 * _STEP)


@pytest.mark.parametrize(("step", "peak", "told"), [(1.0, 0.8, True), (4.0, 0.8, False),
                                                    (4.0, 2.4, True)])  # fmt: skip
def test_a_step_larger_than_ever_is_answered_by_as_much_more(
    step: float, peak: float, told: bool
) -> None:
    command, current = _slow_controller(4000)
    command[3500:] += step - 1.0 if command[3500] > command[3499] else 1.0 - step
    current[3500] = peak  # a step of one is answered by 0.2
    assert bool(_switched(np.column_stack([command, current]), "command")) == told


def _slow_controller(count: int) -> tuple[Array, Array]:
    """A command that steps to and fro by one at each 20th sample, and a current that answers each
    step with a peak of a fifth of it, gone with the next sample."""
    command = np.arange(count) // 20 % 2 * 1.0
    current = 0.01 * np.random.default_rng(4).normal(size=count)
    current[20::20] += 0.2
    return command, current


def _switched(samples: Array, kind: str) -> list[Unusual]:
    """What is unusual of a current, `samples` of a command or a mode and of it."""
    if kind == "mode":
        checks = SignalChecks(["i"], [1], _STEP, modes=[0])
    else:
        checks = SignalChecks(["on", "i"], [0, 1], _STEP, inputs=("on",))
    return [
        one
        for k in range(0, len(samples) - _ROW + 1, _ROW)
        for one in checks.row((k + _ROW - 1) * _STEP, samples[k : k + _ROW], not checks.active)
    ]


def test_an_input_that_goes_further_than_ever_hides_spikes_once() -> None:
    """It stands still for longer than its range is learned, and then steps every 8 s."""
    draw = np.random.default_rng(1)
    k = np.arange(10_000)
    valve = np.where(k < 6000, 0.2, 0.2 + 0.3 * ((k // 800) % 2))
    flow = np.sin(k / 40.0) + 0.01 * draw.normal(size=len(k))
    spikes = np.arange(7000, 10_000, 500) + 130
    flow[spikes] += 0.8
    told = _fan_looked(np.column_stack([valve, flow]))
    assert [(one.signal, one.kind) for one in told] == [("P", "spike")] * len(spikes)
    assert [round(one.since / _STEP) for one in told] == spikes.tolist()


def _cycle(seed: int) -> Array:
    """A current that goes to what is wanted with a time constant of two samples, and the voltage
    behind a resistance: it turns more sharply now and then than it did in thousands of samples."""
    draw = np.random.default_rng(seed)
    runs = [np.full(draw.integers(5, 40), draw.uniform(-230.0, 320.0)) for _ in range(2000)]
    wanted = np.concatenate(runs)[:10_000]
    current = np.zeros(len(wanted))
    for k in range(1, len(wanted)):
        current[k] = wanted[k] + (current[k - 1] - wanted[k]) * np.exp(-0.5)
    volt = 100.0 - 0.025 * current + 0.05 * draw.normal(size=len(wanted))
    return np.column_stack([current + 0.2 * draw.normal(size=len(wanted)), volt])


def _driven(samples: Array, row: int, names: Sequence[str] = ("I", "V")) -> list[Unusual]:
    """What is unusual of signals, the first of which is an input."""
    checks = SignalChecks(names, range(len(names)), _STEP, names[:1])
    return [
        one
        for k in range(0, len(samples) - row + 1, row)
        for one in checks.row((k + row - 1) * _STEP, samples[k : k + row], not checks.active)
    ]


@pytest.mark.parametrize("seed", [5, 6, 10, 17, 27, 29])
def test_a_voltage_that_turns_as_sharply_as_its_current_has_no_spike(seed: int) -> None:
    assert _driven(_cycle(seed), 15) == []


@pytest.mark.parametrize("seed", [5, 6, 10])
def test_a_spike_of_a_voltage_is_told_wherever_its_current_moves(seed: int) -> None:
    """Beside the sharpest turn of the second half, and where the current is about the same."""
    samples = _cycle(seed)
    bends = np.abs(np.diff(samples[:, 0], 2))
    for at in (6000 + int(bends[6000:].argmax()) + 1, 6000 + int(bends[6000:].argmin()) + 1):
        wrong = samples.copy()
        wrong[at, 1] += 6.0 * np.sign(samples[at, 1] - samples[at - 1 : at + 2, 1].mean())
        (one,) = _driven(wrong, 15)
        assert (one[:2], round(one.since / _STEP)) == (("V", "spike"), at)


@pytest.mark.parametrize("seed", [5, 6, 10])
def test_a_spike_of_a_current_tells_nothing_of_how_far_a_voltage_goes(seed: int) -> None:
    """What the voltage does not follow is not learned; nor is a wrong input told of."""
    samples = _cycle(seed)
    samples[2222, 0] += 4000.0
    assert _driven(samples, 15) == []


def test_a_state_without_moves_of_inputs_is_taken() -> None:
    """How far sensors go beside an input is learned with the next rows."""
    samples = _cycle(5)
    one, other = (SignalChecks(["I", "V"], [0, 1], _STEP, ["I"]) for _ in range(2))
    samples[9000, 1] += 6.0
    for k in range(0, 5010, 15):
        one.row((k + 14) * _STEP, samples[k : k + 15], True)
    state = json.loads(json.dumps(one.state()))
    del state["moves"]
    other.resume(state)
    rows = [(k, samples[k : k + 15]) for k in range(5010, 9990, 15)]
    said = [found for k, row in rows for found in other.row((k + 14) * _STEP, row, True)]
    assert [(found.signal, round(found.since / _STEP)) for found in said] == [("V", 9000)]


@pytest.mark.parametrize("share", [0.01, 0.02, 0.04])
@pytest.mark.parametrize("seed", range(3))
def test_several_spikes_in_a_row_are_told_until_they_end(seed: int, share: float) -> None:
    """Of a speed, in rows of 150, up to ten in one. Two that are close are none, as of a knock."""
    draw = np.random.default_rng(seed)
    speed = np.sin(np.arange(12_000) / 200.0) + 0.02 * draw.normal(size=12_000)
    spikes = np.flatnonzero(draw.random(3000) < share) + 6000
    speed[spikes] += draw.choice([-1.0, 1.0], len(spikes))
    checks, said, active = SignalChecks(["w"], [0], _STEP), [], []
    for k in range(0, 12_000, 150):
        row = speed[k : k + 150, None]
        said += checks.row((k + 149) * _STEP, row, not checks.active)
        active += [k] * bool(checks.active)
    assert {one[:2] for one in said} == {("w", "spike")}
    gaps = np.diff(spikes, prepend=0, append=12_000)
    alone = spikes[np.minimum(gaps[1:], gaps[:-1]) > 11]
    assert {int(k) for k in (alone + 4) // 150 * 150} <= {*active}  # the last four with the next
    assert len(said) <= 3 and active[-1] <= spikes[-1] + 12 * 150


@pytest.mark.parametrize("period", [3, 5, 9, 16])
@pytest.mark.parametrize("at", range(5000, 5150, 15))
def test_a_machine_that_rings_after_a_knock_has_no_spikes(at: int, period: int) -> None:
    draw = np.random.default_rng(at)
    speed = np.sin(np.arange(9000) / 200.0) + 0.01 * draw.normal(size=9000)
    k = np.arange(100)
    speed[at : at + 100] += np.exp(-k / (1.5 * period)) * np.cos(2.0 * np.pi * k / period)
    checks = SignalChecks(["w"], [0], _STEP)
    rows = [speed[k : k + 150, None] for k in range(0, 9000, 150)]
    said = [one for k, row in enumerate(rows) for one in checks.row(k * 1.0, row, True)]
    assert [one for one in said if one.kind == "spike"] == []


@pytest.mark.parametrize("row", [_ROW, 90])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize("seed", range(3))
def test_a_spike_that_a_controller_passes_on_in_the_same_sample_is_that_of_its_sensor(
    seed: int, sign: float, row: int
) -> None:
    """A pump that is set by a temperature as it was just read, and for other reasons: to these the
    temperature never answered at once. The flow does, and it is not the one."""
    draw = np.random.default_rng(seed)
    at = np.arange(11_000)
    read = 20.0 + np.sin(at / 400.0) + 0.05 * draw.normal(size=11_000)
    spikes = np.array([5012, 6537, 8111, 9640])
    read[spikes] += 5.0 * sign
    pump = np.clip(np.round(0.4 + 0.12 * (read - 20.0) + 0.1 * (at // 300 % 2), 2), 0.1, 1.0)
    flow = np.zeros(11_000)
    for k in range(1, 11_000):
        flow[k] = flow[k - 1] + 0.5 * (pump[k - 1] - flow[k - 1])
    samples = np.column_stack([pump, flow + 0.01 * draw.normal(size=11_000), read])
    told = _driven(samples, row, ("u", "q", "T"))
    assert {one[:2] for one in told} == {("T", "spike")}
    assert [round(one.since / _STEP) for one in told] == spikes.tolist()


def test_a_sample_is_compared_with_the_cubic_through_those_beside_it() -> None:
    """Two to either side: nothing is left of a parabola, nor of a cubic."""
    near, far = _SMOOTH
    for coefficients in ([7.0], [3.0, -2.0], [2.0, -3.0, 4.0], [5.0, 1.0, -2.0, 8.0]):
        at = np.polyval(coefficients, [-2.0, -1.0, 0.0, 1.0, 2.0])
        assert near * (at[1] + at[3]) + far * (at[0] + at[4]) == pytest.approx(at[2])
