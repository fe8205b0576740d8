"""Samples as they come are brought to the grid: against a definition that looks at all at once."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bondgraph.ir.program import Known
from bondgraph.runtime.monitoring.clock import WRAP_32, Clock, Gap, Piece, clock_of

_DT, _MOST = 0.01, 0.05


def _known(path: str, **more: object) -> Known:
    made = Known(path, path, "", "", "input", 0, False, None, None)
    return made._replace(**more)  # type: ignore[arg-type]


_SIGNALS = (
    _known("x"),
    _known("y", kind="sensor"),
    _known("angle", kind="sensor", counts=24.0),
    _known("on", kind="mode"),
)


def _clock(**options: float) -> Clock:
    return Clock(_SIGNALS, _DT, _MOST, **options)


def _rows(count: int) -> np.ndarray:
    k = np.arange(count, dtype=float)
    return np.column_stack([k, -2.0 * k, 3.0 * k, (k // 4) % 2])


def _joined(pieces: list[Piece]) -> list[tuple[np.ndarray, np.ndarray, Gap | None]]:
    """The stretches between gaps."""
    found: list[tuple[list[np.ndarray], list[np.ndarray], Gap | None]] = []
    for piece in pieces:
        assert bool(piece.anew) == (piece.gap is not None)
        assert len(piece.time) == len(piece.samples) > 0
        if piece.anew or not found:
            found.append(([], [], piece.gap))
        found[-1][0].append(piece.time)
        found[-1][1].append(piece.samples)
    return [(np.concatenate(t), np.concatenate(x), gap) for t, x, gap in found]


def _value(at: float, times: list[float], column: list[float], known: Known) -> float:
    """A signal at a time, from all samples of a stretch: what the clock promises, literally."""
    near = 1e-9
    good = [(t, x) for t, x in zip(times, column, strict=True) if math.isfinite(x)]
    before = [(t, x) for t, x in good if t <= at + near]
    behind = [(t, x) for t, x in good if t > at + near]
    if not before:
        return math.nan
    t0, x0 = before[-1]
    if known.kind == "mode":
        return x0 if at - t0 <= _MOST + near else math.nan
    if abs(t0 - at) <= near:
        return x0
    if not behind or behind[0][0] - t0 > _MOST + near:
        return math.nan
    t1, x1 = behind[0]
    steps = x1 - x0
    if known.counts is not None:
        steps = (steps + 2**31) % 2**32 - 2**31
    return x0 + steps * (at - t0) / (t1 - t0)


def _stretches(times: np.ndarray, rows: np.ndarray) -> list[tuple[list[float], list[list[float]]]]:
    found: list[tuple[list[float], list[list[float]]]] = []
    for t, row in zip(times.tolist(), rows.tolist(), strict=True):
        if not math.isfinite(t) or not any(map(math.isfinite, row)):
            continue
        if not found or abs(t - max(found[-1][0])) > _MOST + 1e-9:
            found.append(([], []))
        if not found[-1][0] or t > max(found[-1][0]) + 1e-9:
            found[-1][0].append(t)
            found[-1][1].append(row)
    return found


_STEPS = st.sampled_from([_DT] * 6 + [0.8 * _DT, 1.3 * _DT, 3 * _DT, _MOST, 0.0, -0.5 * _DT,
                          2.5 * _MOST, -3 * _MOST, math.nan])  # fmt: skip
_VALUES = st.floats(-5, 5) | st.sampled_from([math.nan, math.nan, math.inf])
_COUNTS = st.integers(-(2**31), 2**31 - 1).map(float) | st.just(math.nan)
_MODES = st.sampled_from([0.0, 1.0, math.nan])


@st.composite
def _streams(draw: st.DrawFn) -> tuple[np.ndarray, np.ndarray, list[int]]:
    steps = draw(st.lists(_STEPS, min_size=1, max_size=30))
    time, times = 0.0, []
    for step in steps:
        time += 0.0 if math.isnan(step) else step
        times.append(math.nan if math.isnan(step) else time)
    rows = [
        [draw(_VALUES), draw(_VALUES), draw(_COUNTS), draw(_MODES)] if draw(st.booleans())
        else [1.0 + k, 2.0 * k, 5.0 * k, 1.0]
        for k in range(len(times))
    ]  # fmt: skip
    cuts = draw(st.lists(st.integers(0, len(times)), max_size=8))
    return np.array(times), np.array(rows), sorted(cuts)


@given(_streams())
def test_any_blocks_give_the_grid_of_the_definition(
    stream: tuple[np.ndarray, np.ndarray, list[int]],
) -> None:
    times, rows, cuts = stream
    clock, pieces = _clock(), []
    for a, b in pairwise([0, *cuts, len(times)]):
        pieces += clock.feed(times[a:b], rows[a:b])
    found = _joined(pieces + clock.finish())
    expected = _stretches(times, rows)
    assert len(found) == len(expected)
    assert clock.dropped == len(times) - sum(len(t) for t, _ in expected)
    for (grid, samples, _), (own, own_rows) in zip(found, expected, strict=True):
        np.testing.assert_allclose(grid, own[0] + _DT * np.arange(len(grid)), atol=1e-12)
        assert len(grid) == math.floor((own[-1] - own[0]) / _DT + 1e-6) + 1
        for at, known in enumerate(_SIGNALS):
            column = [row[at] for row in own_rows]
            told = np.array([_value(t, own, column, known) for t in grid.tolist()])
            if known.counts is None:
                np.testing.assert_allclose(samples[:, at], told, atol=1e-7)
                continue
            off = (samples[:, at] - told + 2**31) % 2**32 - 2**31  # a counter has 32 bits
            np.testing.assert_array_equal(np.isnan(samples[:, at]), np.isnan(told))
            assert np.all((np.abs(off) <= 0.5 + 1e-6) | np.isnan(off))
            np.testing.assert_array_equal(samples[:, at], np.rint(samples[:, at]))


@given(_streams())
def test_any_blocks_give_the_same_bits(
    stream: tuple[np.ndarray, np.ndarray, list[int]],
) -> None:
    times, rows, cuts = stream
    results = []
    for bounds in ([0, *cuts, len(times)], range(len(times) + 1)):
        clock, pieces = _clock(), []
        for a, b in pairwise(bounds):
            pieces += clock.feed(times[a:b], rows[a:b])
        results.append(_joined(pieces + clock.finish()))
    assert len(results[0]) == len(results[1])
    for one, other in zip(*results, strict=True):
        np.testing.assert_array_equal(one[0], other[0])
        np.testing.assert_array_equal(one[1], other[1])
        assert one[2] == other[2]


def test_uniform_samples_pass_unchanged() -> None:
    rows = np.random.default_rng(1).normal(size=(30_000, 4))
    rows[:, 2] = np.rint(1e3 * rows[:, 2])
    time = 1.7e3 + np.arange(30_000) * _DT + 1e-10 * np.sin(np.arange(30_000))
    for stamps in (time, None):
        ((_, samples, gap),) = _joined(_clock().feed(stamps, rows))
        np.testing.assert_array_equal(samples, rows)
        assert gap is None


def test_a_short_gap_is_bridged_and_a_long_one_told() -> None:
    keep = np.array([k for k in range(60) if k not in (7, 21, 22, 23, *range(40, 50))])
    rows = _rows(60)
    rows[:, 3] = 0.0
    pieces = _clock().feed(keep * _DT, rows[keep])
    (time, samples, none), (later, rest, gap) = _joined(pieces)
    np.testing.assert_allclose(samples, rows[:40], atol=1e-9)
    np.testing.assert_array_equal(rest, rows[50:])
    np.testing.assert_allclose(np.concatenate([time, later]) / _DT, [*range(40), *range(50, 60)])
    assert none is None and gap == Gap(pytest.approx(0.39), pytest.approx(0.5), 10)
    assert gap is not None and gap.text == "10 samples lost from 0.39 s to 0.5 s"
    assert [p.anew for p in pieces if p.anew] == [gap.text]


def test_a_clock_that_goes_back_far_starts_anew_a_little_is_dropped() -> None:
    time = np.arange(40) * _DT
    time[20:] -= 0.15
    time[10] = time[9]
    time[30] -= 1.5 * _DT
    clock = _clock()
    (_, first, _), (grid, second, gap) = _joined(clock.feed(time, _rows(40)))
    assert clock.dropped == 2 and len(first) == len(second) == 20
    assert gap is not None and gap.lost == 0 and grid[0] == pytest.approx(0.05)
    assert "went back by 0.14 s" in gap.text
    np.testing.assert_allclose(second[:, 0], np.arange(20, 40), atol=1e-9)


@pytest.mark.parametrize("size", [1, 7, 1000])
def test_a_counter_of_microseconds_runs_over(size: int) -> None:
    """Twice, with a sample behind the first time that comes late."""
    raw = [(4_290_000_000 + k * 10_000_000) % 2**32 / 1e6 for k in range(900)]
    rows = [[float(k), 0.0, float(k), 0.0] for k in range(900)]
    raw.insert(2, 4294.0)
    rows.insert(2, [-1.0, 0.0, 0.0, 0.0])
    clock, pieces = Clock(_SIGNALS, 10.0, 50.0, WRAP_32), []
    for k in range(0, len(raw), size):
        pieces += clock.feed(np.array(raw[k : k + size]), np.array(rows[k : k + size]))
    ((time, samples, _),) = _joined(pieces)
    np.testing.assert_allclose(samples[:, 0], np.arange(900), atol=1e-6)
    np.testing.assert_allclose(time, 4290.0 + 10.0 * np.arange(900), rtol=1e-12)
    assert clock.dropped == 1


@pytest.mark.parametrize(
    ("step", "meant"), [(45.0, 45.0), (-45.0, -45.0), (55.0, -45.0), (-55.0, 45.0)]
)
def test_of_a_counter_that_runs_over_a_step_is_the_shorter_way(step: float, meant: float) -> None:
    """The time between the last sample before a gap and the first one behind it."""
    time = 50.0 + np.array([-_DT, 0.0, step, step + _DT])
    _, (grid, _, gap) = _joined(_clock(wraps=100.0).feed(time, _rows(4)))
    assert gap is not None and gap.end - gap.start == pytest.approx(meant)
    assert grid[0] == pytest.approx(50.0 + meant)


def test_a_counter_of_an_encoder_runs_over_in_a_gap() -> None:
    rows = _rows(20)
    counts = 2**31 - 50 + 9 * np.arange(20)
    rows[:, 2] = (counts + 2**31) % 2**32 - 2**31
    rows[[5, 6, 7], 2] = math.nan
    ((_, samples, _),) = _joined(_clock().feed(np.arange(20) * _DT, rows))
    np.testing.assert_array_equal(samples[:, 2], counts)


def test_a_signal_that_is_missing_longer_is_nan_and_the_rest_goes_on() -> None:
    rows = _rows(40)
    rows[10:12, 0] = math.nan
    rows[20:33, 1] = math.inf
    rows[20:33, 3] = math.nan
    clock = _clock()
    early = _joined(clock.feed(np.arange(12) * _DT, rows[:12]))
    assert len(early[0][0]) == 10  # waits for the next value of the signal
    ((_, samples, _),) = _joined(
        [Piece(*early[0][:2]), *clock.feed(np.arange(12, 40) * _DT, rows[12:])]
    )
    np.testing.assert_allclose(samples[:, 0], np.arange(40), atol=1e-9)
    assert np.flatnonzero(np.isnan(samples[:, 1])).tolist() == list(range(20, 33))
    assert np.flatnonzero(np.isnan(samples[:, 3])).tolist() == list(range(25, 33))  # held a while
    assert samples[24, 3] == rows[19, 3]


def test_samples_of_another_rate_are_interpolated() -> None:
    time = np.arange(0, 1, 0.004)
    rows = np.column_stack([np.sin(time), time, np.rint(1e4 * time), time > 0.5])
    ((grid, samples, _),) = _joined(_clock().feed(time, rows))
    np.testing.assert_allclose(samples[:, 0], np.sin(grid), atol=0.004**2 / 8)
    np.testing.assert_allclose(samples[:, 2], 1e4 * grid, atol=1.0)


def test_times_that_are_none_are_dropped() -> None:
    time = np.arange(12) * _DT
    time[[2, 3, 4, 5]] = [1e308, -1e300, math.inf, math.nan]
    clock = _clock(wraps=WRAP_32)
    ((_, samples, gap),) = _joined(clock.feed(time, _rows(12)))
    np.testing.assert_allclose(samples[:, 0], np.arange(12), atol=1e-9)
    assert clock.dropped == 4 and gap is None


def test_huge_numbers_do_no_harm() -> None:
    rows = np.full((6, 4), 1e308)
    rows[::2] *= -1
    ((_, samples, _),) = _joined(_clock().feed(np.arange(6) * 1.5 * _DT, rows))
    assert len(samples) == 8 and np.isnan(samples[:, 2]).all()


@pytest.mark.parametrize("bandwidth", [0.02, 0.5, 3.0])
@pytest.mark.parametrize("jitter", [0.0, 0.1])
def test_missed_samples_and_jitter_never_start_anew(bandwidth: float, jitter: float) -> None:
    """1 Hz, one step in twenty is 2 s: the straight line between is what the grid has there."""

    class Filter:
        signals, sample_time = _SIGNALS[:1], 1.0

    engine = Filter()
    engine.bandwidth = bandwidth  # type: ignore[attr-defined]
    rng = np.random.default_rng(3)
    times = np.cumsum(np.where(rng.random(3000) < 0.05, 2.0, 1.0))
    times += rng.normal(0.0, 1.0, 3000) * jitter
    clock = clock_of(engine)  # type: ignore[arg-type]
    pieces = clock.feed(times, 0.25 * times[:, None]) + clock.finish()
    assert [p.gap for p in pieces if p.gap] == []
    grid = np.concatenate([p.time for p in pieces])
    found = np.concatenate([p.samples for p in pieces])
    np.testing.assert_allclose(np.diff(grid), 1.0)
    assert abs(len(grid) - (times[-1] - times[0])) <= 2.0
    np.testing.assert_allclose(found[:, 0], 0.25 * grid, rtol=1e-12)


@pytest.mark.parametrize("cuts", [(), (7,), (3, 4, 5, 12, 13)])
def test_while_a_machine_is_off_there_is_no_grid(cuts: tuple[int, ...]) -> None:
    """However short it is off: nobody knows what it did, and a line across would be made up."""
    times, rows = np.arange(20) * _DT, _rows(20)
    on = np.ones(20, dtype=bool)
    on[:2] = on[6:8] = on[12] = on[18:] = False
    clock, pieces = _clock(), []
    for a, b in pairwise([0, *cuts, 20]):
        pieces += clock.feed(times[a:b], rows[a:b], on[a:b])
    found = _joined(pieces + clock.finish())
    assert [len(t) for t, _, _ in found] == [4, 4, 5]
    assert [x[0, 0] for _, x, _ in found] == [2.0, 8.0, 13.0]
    gaps = [gap for _, _, gap in found]
    assert gaps[0] is None and clock.left_out == 7
    assert [g and (g.lost, g.off) for g in gaps[1:]] == [(2, True), (1, True)]
    assert gaps[1] is not None and gaps[1].text == "the machine was off from 0.05 s to 0.08 s"
