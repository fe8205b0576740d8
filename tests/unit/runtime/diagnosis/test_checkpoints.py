"""Sensors that drift and are right again, and windings that warm up, solved here."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.runtime.diagnosis.checkpoints import Checkpoints, _left, steady
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.verdict import Verdict

_PUMP = """bg 1
model Pump {
    input n : rad/s
    param D = 4e-6 m^3 +- 3%
    param G = 5e-10 m^3/s/Pa +- 5%
    Sf:pump = D*n -> 1:line -> 0:node
    line -> Df:q
    node { -> R:G { f = G*e }; -> De:p }
}
"""
_MOTOR = """bg 1
model Motor {
    param L = 20 mH +- 5%
    param R = 1.2 Ohm +- 10%
    param K = 0.1 N.m/A +- 2%
    param J = 0.02 kg.m^2 +- 3%
    param b = 0.01 N.m.s +- 10%
    Se:U -> 1:coil
    coil { -> I:L; -> R:R; -> Df:i; -> GY:K -> shaft }
    1:shaft { -> I:J; -> R:b; -> Df:w }
}
"""


@cache
def _compiled(text: str, rate: float, bandwidth: float) -> Compilation:
    return bondgraph.compile(text=text, rate=rate, bandwidth=bandwidth)


def _said(c: Compilation, rate: float, signals: dict[str, Array]) -> list[Verdict]:
    engine = c.engine()
    samples = np.column_stack([signals[k.path] for k in engine.signals])
    watch, t = c.diagnosis(engine), np.arange(len(samples)) / rate
    parts = [slice(start, start + 250) for start in range(0, len(t), 250)]
    said = [one for part in parts
            for one in watch.update(t[part], engine.run(samples[part]), samples[part])]  # fmt: skip
    return [one for one in said if one.event in ("fault", "update", "cleared")]


def _pump(seed: int, drift: Callable[[Array], Array]) -> list[Verdict]:
    """A pump whose sensor of flow is off by a `drift` (times in s), with one per cent of noise."""
    draw, t = np.random.default_rng(seed), np.arange(15_000) / 50.0
    n = 100.0 + 20.0 * np.sin(2 * np.pi * t / 11.0) + 10.0 * np.sin(2 * np.pi * t / 3.7)
    q = 4.04e-6 * n
    p = q / 4.9e-10 + 3e3 * draw.standard_normal(len(t))
    q = q + drift(t) + 1.2e-6 * draw.standard_normal(len(t))
    return _said(_compiled(_PUMP, 50.0, 5.0), 50.0, {"n": n, "q": q, "p": p})


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("rate", [1.2e-7, 2e-7, 2.5e-7])
def test_a_sensor_that_drifts_is_no_fault_any_more_once_it_is_right_again(
    seed: int, rate: float
) -> None:
    """Of 4e-4 m^3/s, from 60 s on until 240 s: what it went was followed, as a pump may change."""
    said = _pump(seed, lambda t: rate * np.clip(t - 60.0, 0.0, None) * (t < 240.0))
    assert said[-1].event == "cleared" and 240.0 < said[-1].time < 250.0
    if said[-2].event == "update":  # it was told before
        assert said[0].time < 240.0
        candidate = said[-2].candidates[0]
        assert candidate.fault == "q" and candidate.size is not None and candidate.size > 0


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_one_that_drifts_on_is_told_with_all_that_it_has_gone(seed: int) -> None:
    said = _pump(seed, lambda t: 2e-7 * np.clip(t - 60.0, 0.0, None))
    assert [one.event for one in said].count("fault") == 1
    assert "cleared" not in {one.event for one in said}
    last = next(one for one in reversed(said) if one.event == "update")
    (told,) = last.candidates
    assert told.fault == "q" and told.unit == "m^3/s" and told.size is not None
    # sizes are told again where they are wrong by much
    assert told.size == pytest.approx(2e-7 * (last.time - 60.0), rel=0.3)


def _motor(seed: int, off: float) -> list[Verdict]:
    """A motor whose winding warms up from 300 s on; its sensor of current is `off` from 450 s on.

    It is right again at 540 s.
    """
    draw, rate, size = np.random.default_rng(seed), 100.0, 60_000
    t = np.arange(size) / rate
    level = np.repeat(draw.uniform(4.0, 12.0, size // 500 + 1), 500)[:size]
    warm = 1.17 * (1.0 + 0.12 * (1.0 - np.exp(-np.maximum(t - 300.0, 0.0) / 150.0)))
    u, state = np.zeros(size), np.zeros((size, 2))
    i = w = 0.0
    for k in range(1, size):
        u[k] = u[k - 1] + 0.02 * (level[k] - u[k - 1])
        middle, r = 0.5 * (u[k - 1] + u[k]), float(warm[k])
        for _ in range(4):  # midpoint rule
            di, dw = (middle - r * i - 0.1 * w) / 0.02, (0.1 * i - 0.01 * w) / 0.02
            im, wm = i + di / 800.0, w + dw / 800.0
            i += (middle - r * im - 0.1 * wm) / 8.0
            w += (0.1 * im - 0.01 * wm) / 8.0
        state[k] = i, w
    current = state[:, 0] + off * ((t >= 450.0) & (t < 540.0))
    current += 0.005 * draw.standard_normal(size)
    speed = state[:, 1] + 0.05 * draw.standard_normal(size)
    return _said(_compiled(_MOTOR, rate, 2.0), rate, {"U": u, "i": current, "w": speed})


@pytest.mark.parametrize("off", [0.3, -0.3])
def test_what_was_followed_is_kept_where_an_alarm_is_of_something_else(off: float) -> None:
    """The winding warms up faster than a healthy one drifts, and is followed; a sensor fails."""
    said = _motor(1, off)
    last = next(one for one in reversed(said) if one.event == "update")
    assert 450.0 < said[0].time < 455.0
    (told,) = last.candidates
    assert told.fault == "i" and told.size == pytest.approx(off, rel=0.1)
    assert said[-1].event == "cleared" and 540.0 < said[-1].time < 550.0


# ------------------------------------------------------------------ where a drift began


def _known(row: int, level: float, limit: float = 2.0) -> Any:
    """What was known after so many rows: a residual stands at a level, and may move with time.

    Healthy, its variance grows by 0.25 a row; only when `drifting` says so.
    """
    return SimpleNamespace(
        row=row,
        limits=np.array([[limit], [1.0]]),
        expected=lambda rows, own: np.full((len(rows), int(own.sum())), level),
        moves=lambda age, rows, own, drifting: np.full((len(rows), 1), 0.25 * age * len(drifting)),
    )


def _began(level: Callable[[int], float], limit: float = 2.0) -> int | None:
    """Which row an alarm at row 100 goes back to, of a residual that stood at such levels."""
    now, known = 100, Checkpoints()
    known._known = [_known(row, level(row), limit) for row in range(0, now, 10)]
    known._known.append(_known(now + 10, 1e3))  # what is not known yet
    rows: list[Any] = [SimpleNamespace(valid=np.array([True, True])) for _ in range(3)]
    out = np.array([True, False])
    found = known._before(_known(now, level(now)), rows, out, [0])
    return None if found is None else found.row


def _from(start: float, end: float, pace: float) -> Callable[[int], float]:
    return lambda row: pace * (min(max(row, start), end) - start)


@pytest.mark.parametrize(
    ("pace", "row"),
    [
        # from row 80 on: age a, 20 of it in the drift: (20 p)^2/(a/4), largest at 20 and half of
        # that at 40; as far as is needed, 9, up to 178 p^2
        (1.0, 60),
        (0.6, 60),
        (0.4, 80),
        (0.3, None),
        (-1.0, 60),
    ],
)
def test_a_drift_began_no_later_than_it_stands_out_most(pace: float, row: int | None) -> None:
    assert _began(_from(80.0, 1e9, pace)) == row


@pytest.mark.parametrize(
    ("end", "row"),
    [
        # from row 0 on until `end`; beside row 0 it has moved by `end`, of that in the last half
        # of the time end - 50: a quarter of it at 66.7
        (64.0, None),
        (70.0, 0),
        (100.0, 0),
    ],
)
def test_a_drift_that_did_not_go_on_in_the_last_half_of_the_time_is_none(
    end: float, row: int | None
) -> None:
    """So fast that only the first row stands out: (p end)^2 / 25 is a little more than 9."""
    assert _began(_from(0.0, end, 15.2 / end)) == row


def test_what_was_not_known_then_or_does_not_move_is_nothing_to_go_back_to() -> None:
    assert _began(_from(80.0, 1e9, 1.0), limit=np.inf) is None
    assert _began(lambda _: 0.0) is None
    known = Checkpoints()
    rows: list[Any] = [SimpleNamespace(valid=np.array([True, True]))]
    assert known._before(_known(5, 1.0), rows, np.array([True, False]), [0]) is None
    known._known = [_known(0, 0.0)]
    assert known._before(_known(5, 50.0), [], np.array([True, False]), [0]) is None
    assert known._before(_known(5, 50.0), rows, np.array([False, False]), [0]) is None
    assert known._before(_known(5, 50.0), rows, np.array([True, False]), [0]) is known._known[0]
    assert known._before(_known(0, 50.0), rows, np.array([True, False]), [0]) is None


def test_what_was_known_is_kept_the_more_seldom_the_longer_that_is_ago() -> None:
    """Eight from one power of two to the next: those that are sixteen rows old every second one."""
    known = Checkpoints()
    for row in range(101):
        known.add(_known(row, 0.0))
    kept = [one.row for one in known._known]
    assert kept[-16:] == list(range(85, 101))
    assert [row for row in kept if 68 < row <= 84] == [70, 72, 74, 76, 78, 80, 82, 84]
    assert [row for row in kept if 36 < row <= 68] == [40, 44, 48, 52, 56, 60, 64, 68]
    assert [row for row in kept if row <= 36] == [0, 8, 16, 24, 32]


@pytest.mark.parametrize("seed", range(3))
def test_what_is_left_is_that_of_weighted_least_squares(seed: int) -> None:
    draw = np.random.default_rng(seed)
    (shape, values), weights = draw.standard_normal((2, 12)), draw.uniform(1.0, 3.0, 12)
    root = np.sqrt(weights)
    left = np.linalg.lstsq(np.column_stack([root, root * shape]), root * values, rcond=None)[1]
    assert _left(shape, values, weights) == pytest.approx(float(left[0]))
    middle = float(weights @ (values - np.average(values, weights=weights)) ** 2)
    assert _left(np.full(12, 5.0), values, weights) == pytest.approx(middle)


def test_a_line_is_steady_and_a_step_in_the_last_half_is_not() -> None:
    row, ones = np.arange(20.0), np.ones(20)
    assert steady(row, ones) and steady(0.0 * row, ones)
    for start in (10, 13, 19):
        assert not steady(1.0 * (row >= start), ones)
    assert steady(1.0 * (row >= 2), ones)  # it was early, and most of the rows are alike
