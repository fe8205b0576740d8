"""Which residuals are watched and which wait is told once, and when that changes."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.hypotheses import rows_apart
from bondgraph.runtime.diagnosis.learning import FIRST
from bondgraph.runtime.diagnosis.status import WatchStatus
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.verdict import Verdict

_ENGINE: Any = SimpleNamespace(
    residuals=("r1", "r2", "r3"), warm_up=2.0, sample_time=0.1, bandwidth=3.0
)


def _mask(*names: str) -> Mask:
    return np.array([name in names for name in _ENGINE.residuals])


def _origins(*waiting: str, lost: tuple[str, ...] = ()) -> Any:
    """Residuals that wait for their origins, some of them as these were lost."""
    return SimpleNamespace(
        waiting=_mask(*waiting), lost=_mask(*lost), unknown=lambda of: "where it began"
    )


class _Watch:
    """A status, and what it has said since the last time."""

    def __init__(self, *used: str) -> None:
        self.status = WatchStatus(_ENGINE, _mask(*(used or _ENGINE.residuals)))
        self.noise: Array = np.ones(3)

    def rows(
        self, start: float, *valid: Mask, origins: Any = None
    ) -> list[tuple[str, float, str]]:
        """Samples a tenth of a second apart, and the end of their row."""
        out: list[Verdict] = []
        time = start + 0.1 * np.arange(len(valid))
        own = origins or _origins()
        table = np.array(valid).reshape(len(valid), 3)
        self.status.warm_up(time, table, self.noise, own, out)
        if len(valid):
            self.status.row(float(time[-1]), self.noise, own, out)
        return [(one.event, round(one.time, 6), one.message) for one in out]


_ALL, _NONE = _mask("r1", "r2", "r3"), _mask()


def test_that_all_are_watched_is_told_once_at_the_sample_that_settles_the_last_one() -> None:
    watch = _Watch()
    assert watch.rows(0.0) == []
    assert watch.rows(0.0, _mask("r1"), _NONE) == []
    found = watch.rows(0.2, _mask("r2"), _mask("r3"), _ALL)  # each has had a value by then
    assert found == [("warm-up", 0.3, "r1, r2 and r3 are watched from now on")]
    assert watch.rows(0.5, _ALL, _NONE, _ALL) == []


def test_residuals_that_are_not_used_are_not_waited_for() -> None:
    watch = _Watch("r1")
    assert watch.rows(1.0, _NONE, _mask("r1")) == [
        ("warm-up", 1.1, "r1 is watched from now on")
    ]


def test_a_residual_without_a_value_is_told_after_five_warm_ups() -> None:
    """Of 2 s each, and a sample of 0.1 s."""
    watch = _Watch()
    assert watch.rows(3.0, _mask("r1", "r3"), _NONE) == []
    assert watch.rows(12.9, _mask("r1"), _NONE) == []
    first, second = watch.rows(13.0, _NONE, _mask("r1"))
    assert first[:2] == ("invalid", 13.1) and first[2].startswith("r2 had no value so far: ")
    assert second == ("warm-up", 13.1, "r1 and r3 are watched from now on")


def test_residuals_whose_noise_nobody_knows_learn_it_and_those_without_origin_wait() -> None:
    watch = _Watch()
    watch.noise = np.array([1.0, math.inf, math.inf])
    ((event, time, text),) = watch.rows(0.0, _ALL, origins=_origins("r3"))
    assert (event, time) == ("warm-up", 0.0)
    watched, learned, waits = text.split("; ")
    assert watched == "r1 is watched from now on"
    assert learned.startswith("the noise of r2 is learned until ")
    assert learned.endswith(" s at least, and no alarm given before")
    assert waits == "r3 waits until the machine has shown by its motion where it began"


@pytest.mark.parametrize("at", [0.0, 0.1 * (rows_apart(_ENGINE) - 1), 7.3])
def test_noise_is_learned_until_so_many_rows_have_been_seen(at: float) -> None:
    """The row that is begun counts as the first one of them."""
    every, out = rows_apart(_ENGINE), list[Verdict]()
    _Watch().status.relearning(at, _NONE, _mask("r1", "r2"), out)
    (said,) = out
    before = math.ceil((round(at / 0.1) + 1) / every)  # rows, with the one that `at` is in
    until = ((before + FIRST - 1) * every - 1) * 0.1
    assert said.message == (
        f"driven as never before: the noise of r1 and r2 is learned until {until:.3f} s at least,"
        " unless it is seen to be as it was, and no alarm given before"
    )
    _Watch().status.relearning(at, _NONE, _NONE, out)
    assert len(out) == 1


def test_what_is_switched_as_never_before_is_not_said_to_be_driven_as_well() -> None:
    out = list[Verdict]()
    _Watch().status.relearning(1.0, _mask("r1"), _mask("r1", "r2"), out)
    assert [v.message.partition(" is learned")[0] for v in out] == [
        "switched as never before: the noise of r1",
        "driven as never before: the noise of r2",
    ]


def test_what_waits_and_what_waits_no_longer_is_told_once() -> None:
    watch = _Watch()
    begun = watch.rows(0.0, _ALL, origins=_origins("r2", "r3"))
    assert begun[0][2].startswith("r1 is watched from now on; r2 and r3 wait until")
    watch.noise = np.array([1.0, 1.0, math.inf])
    assert watch.rows(1.0, _ALL, origins=_origins("r2", "r3", lost=("r2",))) == []
    ((event, time, text),) = watch.rows(2.0, _ALL, origins=_origins("r3"))
    assert (event, time) == ("warm-up", 2.0)
    assert text == "r2 is watched from now on: where they began is known"
    ((_, _, text),) = watch.rows(3.0, _ALL)
    assert text.startswith("the noise of r3 is learned until ")
    ((event, _, text),) = watch.rows(4.0, _ALL, origins=_origins("r1", lost=("r1",)))
    assert event == "invalid" and text.startswith("r1 waits until the machine has shown")
    assert watch.rows(5.0, _ALL, origins=_origins("r1", lost=("r1",))) == []
    # one that waits and was not lost says nothing, and nothing when it waits no longer
    assert watch.rows(6.0, _ALL, origins=_origins("r1", "r2", lost=("r1",))) == []
    ((_, _, text),) = watch.rows(7.0, _ALL)
    assert text.startswith("r1 is watched from now on")


def test_before_residuals_have_begun_no_row_says_anything() -> None:
    watch = _Watch()
    assert watch.rows(0.0, _NONE, origins=_origins("r1", lost=("r1",))) == []
    assert watch.rows(0.1, _NONE) == []


def test_beginnings_behind_breaks_are_told_the_more_seldom_the_more_there_are() -> None:
    """The first two at once, of those behind them the one that is the fourth break."""
    watch, told = _Watch(), []
    for k in range(6):
        if k:
            watch.status.restart()
        told.append(len(watch.rows(float(k), _ALL)))
        if not told[-1]:  # nor what has begun to wait meanwhile
            assert watch.rows(k + 0.5, _ALL, origins=_origins("r1", lost=("r1",))) == []
    assert told == [1, 1, 1, 0, 1, 0]


def test_breaks_before_residuals_have_begun_count_as_well() -> None:
    """Three together, then one after the other: the sixth is twice as many as were told."""
    watch, told = _Watch(), []
    for breaks in (0, 3, 1, 1, 1):
        for _ in range(breaks):
            watch.status.restart()
        told.append(len(watch.rows(float(len(told)), _ALL)))
    assert told == [1, 1, 0, 0, 1]


def test_why_residuals_are_not_watched_is_known_by_name() -> None:
    watch, out = _Watch(), list[Verdict]()
    assert watch.status.waits(_origins()) == {}
    learning: Any = SimpleNamespace(off=_NONE, declared=_NONE, hopeless=_mask("r2", "r3"))
    watch.status.learned(1.0, _NONE, learning, out)
    watch.status.learned(2.0, _NONE, learning, out)
    (said,) = out
    assert (said.event, said.time) == ("invalid", 1.0)
    assert said.message.startswith("r2 and r3 are not watched: an approximation that is far off")
    waits = watch.status.waits(_origins("r1", "r2"))
    until = "it waits until the machine has shown by its motion where it began"
    assert waits == {"r1": until, "r2": until, "r3": "it is an approximation that is far off"}


@pytest.mark.parametrize(
    ("off", "declared", "words", "start"),
    [((), ("r1",), "", False), (("r1",), (), "r1 does not stand at zero", False),
     (("r1", "r2"), ("r2",), "r1 and r2 do not stand at zero", True),
     (("r1",), ("r2",), "r1 does not stand at zero", False),
     (("r3",), ("r3",), "", False)],
)  # fmt: skip
def test_residuals_that_do_not_stand_at_zero_are_told_with_what_that_may_be(
    off: tuple[str, ...], declared: tuple[str, ...], words: str, start: bool
) -> None:
    out: list[Verdict] = []
    found: Any = SimpleNamespace(off=_mask(*off), declared=_mask(*declared), hopeless=_NONE)
    _Watch().status.learned(1.0, _mask("r1", "r2"), found, out)
    ((first, *rest),) = [one.message.split("; ") for one in out]
    assert first == "r1 and r2 are watched from now on"
    assert [text.partition(": ")[0] for text in rest] == ([words] if words else [])
    assert any("give the parameter of it a tolerance" in text for text in rest) == start
