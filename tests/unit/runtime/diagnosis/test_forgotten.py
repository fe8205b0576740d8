"""How long filters show what came before, against step responses of the filters themselves."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy import signal

from bondgraph.runtime.diagnosis.hypotheses import _forgotten, _rest


def _engine(stages: tuple[int, ...], lags: tuple[float, ...], **more: float) -> Any:
    own = {"bandwidth": 10.0, "sample_time": 0.01} | more
    return SimpleNamespace(stages=stages, lags=lags, **own)


def test_what_came_before_is_gone_after_the_most_stages_and_the_longest_lag() -> None:
    """A stage more is a time constant more, 10 samples; a lag of 0.3 s is 30."""
    rest = _rest(_engine((2,), (0.0,)))
    assert rest > 20
    assert _rest(_engine((2, 5, 1), (0.0,))) == rest + 30
    assert _rest(_engine((2,), (0.1, 0.3, 0.2))) == rest + 30
    assert _rest(_engine((), ())) == rest - 20
    assert _rest(_engine((2,), (0.0,), sample_time=0.005)) in (2 * rest, 2 * rest - 1)
    assert _rest(_engine((2,), (0.0,), bandwidth=5.0)) in (2 * rest, 2 * rest - 1)
    # what is left of the slowest response is next to nothing by then, and less after a lag
    assert _forgotten(_engine((5,), (0.0,)), np.array([_rest(_engine((5,), (0.0,)))])) < 0.05


@pytest.mark.parametrize("stages", [1, 2, 5])
def test_what_is_left_is_what_the_step_response_is_short_of(stages: int) -> None:
    engine = _engine((stages, 3), (0.0,))
    samples = np.array([0, 1, 10, 25, 60])
    found = _forgotten(engine, samples)
    assert found.shape == (5, 2)
    for column, count in enumerate((stages, 3)):
        filter_ = signal.lti([1.0], np.poly1d([0.1, 1.0]) ** count)
        time = np.linspace(0.0, 0.6, 6001)
        _, response = filter_.step(T=time)
        expected = 1.0 - np.interp(0.01 * samples, time, response)
        assert found[:, column] == pytest.approx(expected, abs=1e-6)
