"""A winding that warms up within its tolerance, solved here from sample to sample."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.runtime.monitoring.verdict import Verdict

_TEXT = """bg 1
model Winding {
    param L = 20 mH
    param R = 1.2 Ohm +- 10%
    Se:U -> 1:coil
    coil { -> I:L; -> R:R; -> Df:i }
}
"""
_SWITCH = """    input on : bool
    Se:V -> 1:lamp
    lamp { -> R:filament { e = if(on, 50 Ohm, 100 Ohm)*f }; -> Df:lit }
}
"""
_RATE = 100.0


@cache
def _winding(switch: bool = False) -> Compilation:
    text = _TEXT[:-2] + _SWITCH if switch else _TEXT
    return bondgraph.compile(text=text, rate=_RATE, bandwidth=2.0)  # a row every 1.5 s


def _told(seed: int, share: np.ndarray, switch: bool = False) -> list[Verdict]:
    """What is said where the resistance has a `share` of what is declared, at each sample.

    Beside a `switch` of a lamp that has nothing to do with the winding.
    """
    c, draw = _winding(switch), np.random.default_rng(seed)
    t = np.arange(len(share)) / _RATE
    level = np.repeat(draw.uniform(1.0, 4.0, len(t) // 300 + 1), 300)[: len(t)]
    volts, i = np.zeros(len(t)), np.zeros(len(t))
    for k in range(1, len(t)):
        volts[k] = volts[k - 1] + 0.02 * (level[k] - volts[k - 1])
        r, middle = 1.2 * share[k], 0.5 * (volts[k - 1] + volts[k])
        i[k] = middle / r + (i[k - 1] - middle / r) * np.exp(-r / 0.02 / _RATE)
    samples = np.column_stack([volts, i + 0.002 * draw.standard_normal(len(t))])
    engine = c.engine()
    columns = {"U": samples[:, 0], "i": samples[:, 1]}
    if switch:
        on = t // 20 % 2
        lit = 12.0 / np.where(on > 0, 50.0, 100.0) + 1e-3 * draw.standard_normal(len(t))
        columns |= {"on": on, "V": np.full(len(t), 12.0), "lit": lit}
    assert {k.path for k in engine.signals} == set(columns)
    samples = np.column_stack([columns[k.path] for k in engine.signals])
    watch = c.diagnosis(engine)
    parts = [slice(start, start + 500) for start in range(0, len(t), 500)]
    return [one for part in parts
            for one in watch.update(t[part], engine.run(samples[part]), samples[part])]  # fmt: skip


def _warm(seconds: float) -> np.ndarray:
    t = np.arange(round(seconds * _RATE)) / _RATE
    return 0.95 + 0.12 * (1.0 - np.exp(-t / 400.0))


@pytest.mark.parametrize("seed", range(6))
def test_a_winding_that_warms_up_gives_no_alarm(seed: int) -> None:
    assert [v for v in _told(seed, _warm(900.0)) if v.event == "fault"] == []


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("step", [0.02, 0.05])
def test_one_that_changes_at_once_within_its_tolerance_does(seed: int, step: float) -> None:
    """It is the machine that was learned that has changed."""
    share = np.full(45_000, 0.95)
    share[40_000:] += step
    first, named = (next(v for v in _told(seed, share) if v.event == event)
                    for event in ("fault", "update"))  # fmt: skip
    assert 400.0 < first.time < 403.0
    assert named.candidates[0].fault == "R"


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_switch_elsewhere_in_a_machine_does_not_keep_it_from_being_learned(seed: int) -> None:
    share = np.full(8_000, 0.95)
    share[6_000:] += 0.06
    first, named = (next(v for v in _told(seed, share, True) if v.event == event)
                    for event in ("fault", "update"))  # fmt: skip
    assert 60.0 < first.time < 64.0
    assert named.candidates[0].fault == "R"


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_one_that_drifts_by_a_tenth_of_its_tolerance_in_five_rows_does(seed: int) -> None:
    """Of 1.5 s each, from 300 s on."""
    share = np.full(35_000, 0.95)
    share[30_000:] += 0.01 * np.arange(5_000) / (5 * 150)
    first = next(v for v in _told(seed, share) if v.event == "fault")
    assert 300.0 < first.time < 320.0
