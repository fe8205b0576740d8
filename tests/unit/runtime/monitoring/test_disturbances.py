"""What happens to samples is told once, in words that say how much of it there was."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.clock import THROWN, Gap, Piece
from bondgraph.runtime.monitoring.disturbances import Disturbances, Hearing
from bondgraph.runtime.monitoring.residual_states import NO_VALUE, Change
from bondgraph.runtime.monitoring.silence import Silence
from bondgraph.runtime.monitoring.verdict import Verdict

_WARM_UP = 2.0


def _clock(since: float | None = None, stands: bool = False, **thrown: int) -> Any:
    none = dict.fromkeys(THROWN, 0)
    return SimpleNamespace(
        thrown=none | thrown, thrown_since=since, stands=stands, dropped=sum(thrown.values()),
        used=0, left_out=0,
    )  # fmt: skip


class _Told:
    """Disturbances of three residuals, with what they have said."""

    def __init__(self, warm_up: float = _WARM_UP) -> None:
        self.said: list[Verdict] = []
        self.states: Any = SimpleNamespace(residuals=("r1", "r2", "r3"), exhausted=())
        self.account: Any = SimpleNamespace(samples={"unmatched": 0})
        self.of = Disturbances(self.account, self.states, warm_up, self.said.append)

    def words(self) -> list[tuple[str, float, str]]:
        """What has been said since the last time."""
        found = [(one.event, one.time, one.message) for one in self.said]
        self.said.clear()
        return found

    def values(self, start: float, *changes: Change, valid: int = 0) -> None:
        """Ten samples, a second apart, residuals valid from one of them on."""
        time: Array = start + np.arange(10.0)
        there = np.repeat(np.arange(10)[:, None] >= valid, 3, axis=1)
        self.of.values(time, there, list(changes), lambda: ("r3",))


@pytest.mark.parametrize(
    ("lines", "words"),
    [(1, "1 line is no sample, the last"), (2, "2 lines are no samples, the last")],
)
def test_lines_that_are_no_samples_are_counted_with_the_last_one(lines: int, words: str) -> None:
    one = _Told()
    decoder: Any = SimpleNamespace(example="abc", why="line 3: no number")
    one.of.garbage(lines)
    one.of.told(5.0, None, _clock())
    assert one.words() == []
    one.of.told(5.0, decoder, _clock())
    ((event, time, text),) = one.words()
    assert (event, time) == ("invalid", 5.0) and text.startswith(words)
    assert text.endswith("is `abc` (line 3: no number)")
    one.of.told(6.0, decoder, _clock())
    assert one.words() == []


@pytest.mark.parametrize(("lines", "words"), [(1, "1 line was"), (7, "7 lines were")])
def test_lines_that_nobody_read_in_time_are_told(lines: int, words: str) -> None:
    one = _Told()
    one.of.overflow(lines)
    one.of.told(5.0, None, _clock())
    text = f"samples come faster than they are computed: {words} dropped"
    assert one.words() == [("late", 5.0, text)]


def test_samples_without_their_columns_are_told_with_the_reason() -> None:
    one = _Told()
    one.account.samples["unmatched"] = 12
    one.of.unmatched(12, "no column for U")
    one.of.told(5.0, None, _clock())
    text = "12 samples cannot be used: no column for U"
    assert one.words() == [("invalid", 5.0, text)]


def test_samples_that_are_thrown_away_are_told_by_cause_and_only_the_new_ones() -> None:
    one, before = _Told(), dict.fromkeys(THROWN, 0)
    one.of.thrown(before, _clock())
    one.of.told(1.0, None, _clock())
    assert one.words() == []
    clock = _clock(since=0.5, late=1)
    one.of.thrown(before, clock)
    one.of.told(1.0, None, clock)
    text = "1 sample is thrown away, from 0.5 s on: 1 behind a later one"
    assert one.words() == [("late", 1.0, text)]
    assert clock.thrown_since is None  # what comes next has a beginning of its own
    more = _clock(stands=True, late=2, twice=3, untimed=0)
    one.of.thrown(clock.thrown, more)
    one.of.told(2.5, None, more)
    text = "4 samples are thrown away: 1 behind a later one and 3 with the time of the one before"
    assert one.words() == [("late", 2.5, f"{text}; the clock stands still at 2.5 s")]


def _piece(start: float, gap: Gap | None) -> Piece:
    anew = "" if gap is None else gap.text
    return Piece(np.array([start, start + 1.0]), np.zeros((2, 1)), anew, gap)


def test_a_gap_is_told_with_what_may_be_missed() -> None:
    """From the last sample before it until the residuals are warm again."""
    one = _Told()
    one.of.gap(_piece(10.0, Gap(7.0, 10.0, 2)))
    ((event, time, text),) = one.words()
    assert (event, time) == ("gap", 10.0)
    assert text.startswith("2 samples lost from 7 s to 10 s; the residuals warm up, and what")
    assert text.endswith("what happens from 7 s to about 12 s may be missed")
    one = _Told()
    one.of.gap(_piece(5.0, Gap(7.0, 5.0, 0)))  # the clock went back
    assert one.words()[0][2].endswith("what happens from 5 s to about 7 s may be missed")


@pytest.mark.parametrize(
    ("lost", "off", "remedy"),
    [(2, False, ": tell the rate of the samples by --rate"), (0, False, ""), (2, True, "")],
)
def test_gaps_in_a_row_are_counted_and_lost_samples_have_a_remedy(
    lost: int, off: bool, remedy: str
) -> None:
    """Told the first time and whenever there are twice as many; two are no row."""
    one, told = _Told(), []
    for k in range(4):
        one.of.gap(_piece(10.0 + k, Gap(9.0 + k, 10.0 + k, lost, off)))
        told.append([text.partition(" may be missed")[2] for _, _, text in one.words()])
    assert told == [[""], [""], [], [f" (4 gaps in a row{remedy})"]]


def test_three_gaps_are_a_row_where_the_third_comes_late() -> None:
    """Residuals that need ten seconds: what comes again within a hundred is not new."""
    one, told = _Told(10.0), []
    for at in (0.0, 50.0, 115.0):  # more than a minute after it was told last
        one.of.progress = at
        one.of.gap(_piece(at + 10.0, Gap(at, at + 10.0, 2)))
        told.append([text.partition(" may be missed")[2] for _, _, text in one.words()])
    assert told == [[""], [""], [" (3 gaps in a row: tell the rate of the samples by --rate)"]]


def _change(at: int, time: float, first: bool = False, **signals: tuple[str, ...]) -> Change:
    names = tuple(signals)
    residuals = tuple(sorted({r for own in signals.values() for r in own}))
    return Change(at, time, names, residuals, first)


def test_a_signal_without_a_number_is_told_and_so_is_its_return() -> None:
    one = _Told()
    one.values(0.0)
    assert one.words() == []
    one.values(10.0, _change(3, 13.0, U=("r1", "r2")))
    ((event, time, text),) = one.words()
    assert (event, time) == ("invalid", 13.0)
    assert text.startswith("U has no number (") and text.endswith("13.000 s: r1 and r2 are blind")
    one.values(20.0)  # nothing new
    assert one.words() == []
    one.values(30.0, _change(4, 34.0), valid=10)
    assert one.words() == []  # it is there, and the residuals are not yet
    one.values(40.0)
    ((event, time, text),) = one.words()
    assert (event, time) == ("warm-up", 40.0)
    assert text == (
        "r1 and r2 have a value again: U is there;"
        " what happened from 13.000 s to 40.000 s may have been missed"
    )
    one.values(50.0)
    assert one.words() == []


def test_residuals_have_a_value_again_from_when_they_have_one_until_a_signal_is_gone() -> None:
    one = _Told()
    one.values(0.0, _change(1, 1.0, U=("r1",)), _change(5, 5.0), valid=7)
    (_, (_, time, text)) = one.words()
    assert time == 7.0 and text.endswith("from 1.000 s to 7.000 s may have been missed")
    one = _Told()
    one.values(0.0, _change(1, 1.0, U=("r1",)), _change(5, 5.0), valid=10)
    one.values(10.0, _change(1, 11.0, U=("r1",)), valid=2)
    assert [event for event, _, _ in one.words()] == ["invalid"]


def test_two_signals_and_one_residual_are_told_as_such() -> None:
    one = _Told()
    one.values(0.0, _change(1, 1.0, U=("r1",), V=("r1",)), _change(5, 5.0))
    (_, _, missing), (_, time, there) = one.words()
    assert missing.startswith("U and V have no number (") and missing.endswith(": r1 is blind")
    assert time == 5.0 and there.startswith("r1 has a value again: U and V are there;")


def test_a_signal_that_has_not_come_yet_is_waited_for_as_long_as_residuals_warm_up() -> None:
    one = _Told()
    one.values(0.0, _change(0, 0.0, True, U=("r1",)), _change(1, 1.0))
    assert one.words() == []
    one = _Told()
    one.values(50.0, _change(0, 50.0, True, U=("r1",)))
    one.of.told(51.9, None, _clock())
    assert one.words() == []
    one.of.told(52.0, None, _clock())
    ((event, time, text),) = one.words()
    assert (event, time) == ("invalid", 52.0) and "since 50.000 s" in text


def test_of_fewer_missing_signals_nothing_is_told_and_of_more_the_first_time() -> None:
    one = _Told()
    one.values(0.0, _change(1, 1.0, U=("r1",), V=("r2",)))
    assert len(one.words()) == 1
    one.values(10.0, _change(0, 10.0, U=("r1",)))
    assert one.words() == []
    one.of.progress = 100.0  # long enough for what goes on to be told again
    one.values(110.0, _change(0, 110.0, U=("r1",), W=("r2", "r3")))
    ((_, time, text),) = one.words()
    assert time == 110.0 and text.startswith("U and W have no number")
    assert "since 1.000 s" in text  # when the first of them was gone


def test_residuals_without_a_value_for_long_are_told_but_for_those_that_wait() -> None:
    one = _Told()
    one.states.exhausted = ("r3",)
    one.values(0.0)
    assert one.words() == []
    one.states.exhausted = ("r1", "r3")
    one.values(10.0)
    assert one.words() == [("invalid", 19.0, f"r1 is blind: {NO_VALUE}")]
    one.values(20.0)
    assert one.words() == []
    one.states.exhausted = ()
    one.values(30.0)
    assert one.words() == [("warm-up", 39.0, "r1 has a value again")]


def _hearing(clock: Any) -> tuple[Hearing, list[Verdict]]:
    said: list[Verdict] = []
    return Hearing(Silence(1.0, 0.1, 0.0), clock, said.append), said


@pytest.mark.parametrize(
    ("clock", "garbage", "instead"),
    [
        (_clock(), 0, ""),
        (_clock(), 4, ", but lines that are none"),
        (_clock(twice=2), 4, ", but some that are late, come twice or are empty"),
        (_clock(twice=2, stands=True), 4, ", but some of the same time: the clock of the device"
         " stands still"),
    ],
)  # fmt: skip
def test_silence_is_told_with_what_comes_instead(clock: Any, garbage: int, instead: str) -> None:
    hearing, said = _hearing(clock)
    hearing.look(7.0, garbage, 1.0)  # as long as is allowed
    assert said == [] and hearing.why(garbage, 1.0) == ""
    hearing.look(7.0, garbage, 1.5)
    text = f"no sample for 1.5 s on the clock of this computer{instead}; all residuals are blind"
    assert [(one.event, one.time, one.message) for one in said] == [("gap", 7.0, text)]
    assert hearing.why(garbage, 1.5) == f"no sample for 1.5 s{instead}"


def test_samples_that_come_again_end_a_silence_that_was_told() -> None:
    clock = _clock()
    hearing, said = _hearing(clock)
    clock.used = 5
    hearing.look(1.0, 0, 0.9)
    assert said == []
    hearing.look(2.0, 0, 3.0)
    clock.left_out = 1  # of a machine that is off: it is heard
    hearing.look(3.0, 0, 4.0)
    assert [one.message for one in said][1:] == [
        "samples come again, after 3.1 s on the clock of this computer"
    ]
    assert hearing.why(0, 4.5) == ""
    clock.used, clock.left_out = 10, 6  # five more of each
    hearing.look(4.0, 0, 4.9)
    clock.used, clock.left_out = 11, 7
    hearing.look(5.0, 0, 5.8)
    hearing.look(5.0, 0, 6.7)
    assert len(said) == 2


def test_what_came_before_the_last_sample_does_not_come_instead() -> None:
    clock = _clock(twice=2)
    hearing, said = _hearing(clock)
    clock.used = 5
    hearing.look(1.0, 4, 0.5)
    hearing.look(1.0, 4, 2.5)
    assert [one.message.partition(" on the clock of this computer")[2] for one in said] == [
        "; all residuals are blind"
    ]


def test_a_first_silence_is_heard_whatever_was_computed_before() -> None:
    hearing, said = _hearing(_clock())
    hearing.awake(5.0)
    hearing.look(0.0, 0, 5.5)
    assert [one.event for one in said] == ["gap"]


def test_what_is_computed_takes_its_time_and_is_no_silence() -> None:
    clock = _clock()
    hearing, said = _hearing(clock)
    clock.used = 5
    hearing.look(1.0, 0, 0.5)
    hearing.awake(10.0)
    hearing.look(2.0, 0, 10.9)
    assert said == []
    hearing.awake(11.5)  # nothing has come since
    hearing.look(2.0, 0, 11.6)
    assert [one.event for one in said] == ["gap"]
