"""How long a source may be silent, by the pauses that it has made; without a source."""

from __future__ import annotations

import pytest

from bondgraph.runtime.monitoring.silence import Silence


def _after(*pauses: float, most: float = 5.0, step: float = 0.01) -> tuple[Silence, float]:
    now = 100.0
    own = Silence(most, step, now)
    for pause in pauses:
        now += pause
        assert own.heard(now) == 0.0  # nothing was told
    return own, now


@pytest.mark.parametrize(
    ("pauses", "limit"),
    [
        ([], 5.0),
        ([30.0, 30.0, 30.0], 5.0),  # three are too few to tell
        ([1.0, 2.0, 30.0, 1.5], 6.0),  # a single long one is none: three times 2 s
        ([10.0, 1.0, 2.0, 3.0, 30.0], 30.0),
        ([1.0, 1.0, 1.0, 1.0], 5.0),  # no less than is asked for
        ([60.0, 60.0, *[2.0] * 14], 180.0),
        ([60.0, 60.0, *[2.0] * 15], 6.0),  # of sixteen there is one long one left
    ],
)
def test_three_times_the_second_longest_pause_is_no_silence(
    pauses: list[float], limit: float
) -> None:
    own, now = _after(*pauses)
    assert own.limit == pytest.approx(limit)
    assert own.due(now + 0.999 * limit) == 0.0 and not own.told
    assert own.due(now + 1.001 * limit) == pytest.approx(1.001 * limit) and own.told


def test_samples_that_are_far_apart_are_no_silence() -> None:
    assert _after(step=4.0)[0].limit == 12.0 and _after(step=1.0)[0].limit == 5.0


def test_silence_is_told_again_when_it_is_ten_times_as_long() -> None:
    own, now = _after()
    assert own.due(now + 5.0) == 0.0  # exactly as long is not longer
    assert own.due(now + 6.0) == 6.0
    assert own.due(now + 59.9) == 0.0 and own.due(now + 60.0) == 60.0
    assert own.due(now + 599.0) == 0.0 and own.due(now + 600.0) == 600.0
    assert own.heard(now + 700.0) == 700.0 and not own.told
    assert own.heard(now + 701.0) == 0.0


def test_what_was_computed_meanwhile_is_no_pause() -> None:
    own, now = _after()
    own.awake(now + 50.0)
    assert own.lasts(now + 51.0) == 1.0 and own.lasts(now + 40.0) == 0.0
    assert own.due(now + 51.0) == 0.0
