"""What the clock is for: a healthy motor stays below its threshold, whatever its samples suffer.

The motor of models/dc_motor.bg, its two differential equations written here and solved by scipy,
measured by converters of 16 bits (their rounding as noise). The threshold is five standard
deviations of each residual on a log without trouble, the samples are a millisecond apart, the
filter has a time constant of 50 ms. As a program it writes the table of docs/decisions/clock.md.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import bondgraph
from bondgraph.runtime.monitoring.clock import WRAP_32, Piece, clock_of
from bondgraph.runtime.monitoring.engine import Engine
from tests.measured import measured, write

_PAGE = Path(__file__).parents[4] / "docs" / "decisions" / "clock.md"
_MODEL = Path(__file__).parents[4] / "models" / "dc_motor.bg"
_L, _R, _K, _J, _F = 300e-6, 17.6, 3.51e-3, 1.4e-8, 1.19e-5
_RANGE = {"current": 0.2, "speed": 200.0}  # A, rad/s
_NOISE = 2.0**-16 / 12.0**0.5
_STEP, _COUNT = 1e-3, 8000

Stream = tuple[np.ndarray, np.ndarray]


def _voltage(t: np.ndarray) -> np.ndarray:
    return 4.0 + np.sin(2 * np.pi * t) + 0.5 * np.sin(2 * np.pi * 2.7 * t)


def _load(t: np.ndarray) -> np.ndarray:
    return 1e-4 * np.sin(2 * np.pi * 0.7 * t)


@cache
def _motion() -> Callable[[np.ndarray], np.ndarray]:
    def rates(t: float, x: np.ndarray) -> list[float]:
        return [
            (_voltage(t) - _R * x[0] - _K * x[1]) / _L,
            (_K * x[0] - _F * x[1] - _load(t)) / _J,
        ]

    jacobian = np.array([[-_R / _L, -_K / _L], [_K / _J, -_F / _J]])
    end = 1.0 + 1.3 * _STEP * _COUNT
    options = {"method": "Radau", "rtol": 1e-9, "atol": 1e-12, "dense_output": True}
    return solve_ivp(rates, (0.0, end), [0.0, 0.0], jac=jacobian, **options).sol


@cache
def _engine() -> Engine:
    return bondgraph.compile(_MODEL).engine()


def _measured(t: np.ndarray) -> np.ndarray:
    """What is measured at the times t, from a second after the start on."""
    current, speed = _motion()(1.0 + t)
    noise = np.random.default_rng(5).normal(0.0, _NOISE, (2, len(t)))
    signals = {
        "U": _voltage(1.0 + t),
        "load": _load(1.0 + t),
        "current": current + noise[0] * _RANGE["current"],
        "speed": speed + noise[1] * _RANGE["speed"],
    }
    return np.column_stack([signals[k.path] for k in _engine().signals])


def _run(pieces: list[Piece]) -> tuple[np.ndarray, float]:
    """The largest amount of each residual, and the share of time in which all are valid."""
    engine, found = _engine().configured(), []
    for piece in pieces:
        if piece.anew:
            engine.reset()
        found.append(engine.run(piece.samples))
    value = np.concatenate([b.value for b in found])
    valid = np.concatenate([b.valid for b in found])
    assert valid.any(axis=0).all()
    return np.abs(value).max(axis=0), float(valid.all(axis=1).mean())


@cache
def _threshold() -> np.ndarray:
    batch = _engine().configured().run(_measured(np.arange(_COUNT) * _STEP))
    return np.array([5.0 * v[ok].std() for v, ok in zip(batch.value.T, batch.valid.T, strict=True)])


def _uniform(samples: np.ndarray) -> list[Piece]:
    """The samples as they are, taken to be uniform."""
    return [Piece(np.arange(len(samples)) * _STEP, samples)]


def _kept(lost: range | list[int]) -> Stream:
    time = np.delete(np.arange(_COUNT), list(lost)) * _STEP
    return time, _measured(time)


def _gaps() -> Stream:
    return _kept([k for start in range(1500, _COUNT, 700) for k in range(start, start + 10)])


def _jitter() -> Stream:
    """Each period 5 % longer or shorter."""
    steps = _STEP * (1.0 + np.random.default_rng(2).uniform(-0.05, 0.05, _COUNT))
    return np.cumsum(steps), _measured(np.cumsum(steps))


def _restart() -> Stream:
    """The logger is off for 0.731 s and counts its time from 0 again."""
    time, samples = _kept(range(4000, 4731))
    return np.where(time < 4.0, time, time - 4.731), samples


def _off() -> Stream:
    """Each sample up to 5 % of a period before or after its place on a true grid."""
    places = np.arange(_COUNT) + np.random.default_rng(2).uniform(-0.05, 0.05, _COUNT)
    return _STEP * places, _measured(_STEP * places)


def _nan() -> Stream:
    time, samples = _kept([])
    samples[5000, [k.path for k in _engine().signals].index("speed")] = np.nan
    return time, samples


_TROUBLES: dict[str, Callable[[], Stream]] = {
    "nothing wrong": lambda: _kept([]),
    "one sample lost": lambda: _kept([5003]),
    "a gap of 10 ms every 0.7 s": _gaps,
    "each period 5 % longer or shorter, at random": _jitter,
    "samples 5 % off a true grid": _off,
    "the logger restarts, 0.731 s are lost": _restart,
    "one NaN": _nan,
}


def table() -> str:
    """The largest residual in standard deviations, and how long the residuals were valid."""
    rows = ["| | taken as uniform | valid | with the clock | valid |", "|---|---:|---:|---:|---:|"]
    for name, trouble in _TROUBLES.items():
        time, samples = trouble()
        clock = clock_of(_engine())
        cells = [name]
        for pieces in (_uniform(samples), clock.feed(time, samples) + clock.finish()):
            size, valid = _run(pieces)
            cells += [f"{float(np.max(5.0 * size / _threshold())):.3g}", f"{100 * valid:.1f} %"]
        rows.append(f"| {' | '.join(cells)} |")
    return "\n".join(rows)


def test_the_table_of_the_decision_is_what_is_measured_now() -> None:
    (page,) = measured(_PAGE)
    assert page.text == table()


@pytest.mark.parametrize(
    "trouble",
    [lambda: _kept([5003]), _gaps, _jitter, _restart],
    ids="lost gaps jitter restart".split(),
)
def test_below_the_threshold_with_the_clock_and_beyond_it_without(
    trouble: Callable[[], Stream],
) -> None:
    time, samples = trouble()
    clock = clock_of(_engine())
    size, _ = _run(clock.feed(time, samples) + clock.finish())
    assert np.all(size < _threshold())
    plain, _ = _run(_uniform(samples))
    assert np.any(plain > 2.0 * _threshold())


def test_one_value_that_is_none_does_not_end_the_watch() -> None:
    samples = _measured(np.arange(_COUNT) * _STEP)
    column = [k.path for k in _engine().signals].index("speed")
    _, clean = _run(_uniform(samples))
    samples[5000, column] = np.nan
    clock = clock_of(_engine())
    size, valid = _run(clock.feed(np.arange(_COUNT) * _STEP, samples))
    assert np.all(size < _threshold()) and valid == clean
    assert _run(_uniform(samples))[1] < clean - 0.03  # the filters start anew


def test_a_clock_that_wraps_is_not_noticed() -> None:
    time = np.arange(_COUNT) * _STEP
    stamps = (4_292_000_000 + np.arange(_COUNT) * 1000) % 2**32 / 1e6
    for wraps in (WRAP_32, None):
        clock = clock_of(_engine(), wraps=wraps)
        pieces = clock.feed(stamps, _measured(time))
        size, valid = _run(pieces)
        told = [p.anew for p in pieces if p.anew]
        assert np.all(size < _threshold())
        assert (told == []) == (wraps is not None)
        assert (valid == _run(_uniform(_measured(time)))[1]) == (wraps is not None)


if __name__ == "__main__":
    write(_PAGE, "python -m tests.unit.runtime.monitoring.test_clock_plant", table())
