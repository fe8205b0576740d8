"""When a start is looked for after a break, when it is used, and who waits; fits are given here."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from bondgraph.runtime.diagnosis import origins
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
from bondgraph.runtime.diagnosis.origin_fit import Fit, _valleys
from bondgraph.runtime.diagnosis.origins import Origins, Readings
from bondgraph.runtime.diagnosis.remembered import Memory
from bondgraph.runtime.diagnosis.rows import Row, weight
from bondgraph.runtime.log import Array

_STEP, _EVERY = 0.1, 5  # s between samples, of which so many are a row
_MEMORY = Memory(("r1",), ("a",), ("a", "b"), unknown=("x",))
_LIMITS = np.array([[0.5, 1.0, 4.0], [0.5, 1.0, 4.0]])


class _Watch:
    """Residuals r1 and r2 of signals a, b and c; rows as they come, with what is fitted to them."""

    def __init__(
        self, monkeypatch: pytest.MonkeyPatch, *memories: Memory, level: float = 0.5,
        doubt: float = 9.0,
    ) -> None:  # fmt: skip
        signals = [SimpleNamespace(path=path, counts=None) for path in "abc"]
        engine: Any = SimpleNamespace(
            residuals=("r1", "r2"), signals=signals, sample_time=_STEP, warm_up=2.0, parameters={}
        )
        self.origins = Origins(engine, memories or (_MEMORY,), _EVERY)
        self.past: list[Row] = []
        self.looks: list[tuple[int, int]] = []  # after so many rows, at so many of them
        self.cases: list[Any] = []
        self.history: Any = SimpleNamespace(
            taught=[], narrowed=[], add=lambda *given: self.history.taught.append(given),
            narrow=lambda most: self.history.narrowed.append(most.tolist()),
        )  # fmt: skip

        def fitted(case: Any) -> Fit:
            self.looks.append((len(self.past), len(case.rows)))
            self.cases.append(case)
            rows = [row._replace(value=row.value.copy()) for row in case.rows]
            start = np.array([7.0, 8.0, 9.0])
            nothing: Any = None
            return Fit(start, (), (), np.zeros((0, 0)), self.history, nothing, rows, level, doubt)

        monkeypatch.setattr(origins, "fitted", fitted)

    def row(self, samples: Array | None = None, valid: bool = True) -> Any:
        """What settles with one row more."""
        own = np.ones((_EVERY, 3)) if samples is None else samples
        time = _STEP * (len(self.past) * _EVERY + np.arange(_EVERY))
        self.origins.take(time, own, self.past, again=False)
        ones, engine = np.ones(2), self.origins._engine
        self.past.append(
            Row(float(time[-1]), own, engine, ones.copy(), np.full(2, valid), ones.copy(), ones,
                np.zeros((0, 2)))
        )  # fmt: skip
        return self.settled()

    def settled(self) -> Any:
        return self.origins.settled(self.past, (), {}, self.history, _LIMITS)

    def until(self, most: int = 60) -> int | None:
        """After how many rows a start is used."""
        for number in range(1, most + 1):
            if self.row() is not None:
                return number
        return None


def test_a_start_is_looked_for_after_the_warm_up_and_ever_more_seldom(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Twenty samples of warm-up and three rows; then a quarter of the rows so far later."""
    one = _Watch(monkeypatch)
    assert one.until(30) is None
    assert [after for after, _ in one.looks] == [7, 8, 10, 12, 15, 18, 22, 27]
    assert [of for _, of in one.looks] == [7, 8, 10, 12, 15, 18, 22, 24]  # four and twenty at most
    assert one.settled() is None and len(one.looks) == 8  # the same row again
    assert one.origins.looking and one.origins.waiting.tolist() == [True, False]


def test_a_pulse_takes_two_warm_ups_to_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is what the start of a sum is told as, unless a parameter says where it begins."""
    one = _Watch(monkeypatch, _MEMORY._replace(integral=True))
    assert one.until(13) is None
    assert [after for after, _ in one.looks] == [11, 13]
    assert one.cases[0].warm == 40 and one.cases[0].places == [0]


@pytest.mark.parametrize(
    ("level", "doubt", "rows"),
    [
        (0.5, 0.5, 7),  # known well enough
        (1.0, 0.5, 7),
        (0.5, 0.51, None),
        # nothing explains what is seen: so many rows of those looked at are enough
        (1.01, 9.0, 27),
        (3.0, 9.0, 27),
        (3.01, 9.0, 18),
    ],
)
def test_a_start_is_used_once_it_is_known_or_nothing_explains_what_is_seen(
    level: float, doubt: float, rows: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    one = _Watch(monkeypatch, level=level, doubt=doubt)
    assert one.until(30) == rows
    own = one.origins
    assert own.waiting.tolist() == [rows is None, False]
    assert own.looking == (rows is None or level > 1.0)  # one that explains nothing is looked for
    told = own._told.tolist()
    assert told[0] == 7.0 if rows else np.isnan(told[0])
    assert np.isnan(told[1:]).all()
    # what is explained teaches the history, of the residuals that remember
    taught = one.history.taught
    assert len(taught) == (7 if rows == 7 else 0)
    for (value, own_weight, _, forget), row in zip(taught, one.past, strict=False):
        assert value.tolist() == [1.0, 1.0] and forget == 1.0
        assert own_weight.tolist() == [weight(row, _LIMITS[:, 0])[0], 0.0] and own_weight[0] > 0.0
    assert one.history.narrowed == ([[]] if rows == 7 else [])


def test_what_is_judged_by_a_doubtful_start_is_looked_at_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    one = _Watch(monkeypatch, level=3.5)
    assert one.until() == 18 and not one.origins.waiting.any()
    looks = len(one.looks)
    for _ in range(10):
        assert one.row() is None  # a doubtful one is not used twice
    assert [after for after, _ in one.looks[looks:]] == [22, 27]


def test_a_sample_without_a_value_begins_the_wait_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a signal that the residual reads; others do not matter."""
    for signal, looks in ((0, [12, 13]), (1, [12, 13]), (2, [7, 8, 10, 12])):
        one = _Watch(monkeypatch)
        for number in range(13):
            samples = np.ones((_EVERY, 3))
            if number == 5:
                samples[2, signal] = np.nan
            one.row(samples)
        # the row of the break begins before it: seven rows after that
        shown = [after for after, _ in one.looks]
        assert shown == ([13] if signal < 2 else looks)


def test_who_has_no_sample_yet_does_not_look(monkeypatch: pytest.MonkeyPatch) -> None:
    one = _Watch(monkeypatch)
    for _ in range(9):
        assert one.row(np.full((_EVERY, 3), np.nan)) is None
    assert one.looks == [] and not one.origins.lost.any() and one.origins.waiting[0]
    one.row()
    assert one.origins.lost.tolist() == [True, False]


def test_who_knows_where_it_begins_waits_only_after_a_break(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    one = _Watch(monkeypatch, _MEMORY._replace(unknown=()))
    assert one.until(10) is None and one.looks == []
    assert not one.origins.looking and one.origins._told[0] == 1.0
    one.origins.restart([])
    assert one.origins.waiting.tolist() == [True, False]


def test_what_waits_is_told_by_parameters_or_by_signals() -> None:
    signals = [SimpleNamespace(path=path, counts=None) for path in "abc"]
    engine: Any = SimpleNamespace(
        residuals=("r1", "r2", "r3"), signals=signals, sample_time=1.0, warm_up=2.0, parameters={}
    )
    both = (
        Memory(("r1",), ("a",), ("a",), unknown=("x", "y")),
        Memory(("r2",), ("b",), ("b",)),
        Memory(("r3",), ("c",), ("c",), unknown=("x",)),
    )
    own = Origins(engine, both, 5)

    def words(*of: int) -> str:
        return own.unknown(np.array([k in of for k in range(3)]))

    assert words(0) == "what x and y are" and words(2) == "what x is"
    assert words(1) == "where b began" and words(0, 2) == "what x and y are"
    assert words(0, 1) == "what x and y are and where b began"


@pytest.mark.parametrize(("level", "rows"), [(2.0, 24), (3.5, 16)])
def test_as_many_rows_as_are_looked_at_are_enough(
    level: float, rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Four of the warm-up, and twenty or, where it is hopeless, twelve."""
    one = _Watch(monkeypatch, level=level)
    found = None
    while found is None:
        one.origins._groups[0].next = 0  # each row is looked at
        found = one.row()
    assert len(one.past) == rows == one.looks[-1][0]


def test_a_row_counts_once_however_often_it_is_asked_about(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    one = _Watch(monkeypatch)
    for _ in range(30):
        assert one.row() is None and one.settled() is None
    assert [after for after, _ in one.looks] == [7, 8, 10, 12, 15, 18, 22, 27]


def test_a_fit_that_fails_is_tried_again(monkeypatch: pytest.MonkeyPatch) -> None:
    one, tries = _Watch(monkeypatch), []

    def fails(case: Any) -> Fit:
        tries.append(len(case.rows))
        raise np.linalg.LinAlgError

    monkeypatch.setattr(origins, "fitted", fails)
    assert one.until(10) is None and tries == [7, 8, 10]


def test_a_start_that_is_known_by_its_deviation_leaves_room_for_three_of_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Two starts of deviations 2 and 3, and residuals that move by 1 and 10 with them."""
    one = _Watch(monkeypatch, doubt=0.1)
    starts = tuple(Hypothesis(name, "start", "V", 1.0, False) for name in ("x", "y"))
    slopes = np.array([[1.0, 4.0], [10.0, 5.0]])
    given = origins.fitted

    def fitted(case: Any) -> Fit:
        found = given(case)
        rows = [row._replace(slopes=slopes, bound=row.bound.copy()) for row in found.rows]
        spread = np.diag([4.0, 9.0])
        return found._replace(tolerated=starts, starts=starts, spread=spread, rows=rows)

    monkeypatch.setattr(origins, "fitted", fitted)
    settled = None
    while settled is None:
        settled = one.row()
    for row in settled.rows:  # r1 remembers, r2 does not
        assert row.bound.tolist() == pytest.approx([1.0 + 3.0 * np.hypot(2.0, 30.0), 1.0])
    assert one.history.narrowed == [[20.0, 30.0]]


@pytest.mark.parametrize(("valid", "rows"), [(True, 5), (False, 1)])
def test_a_start_that_has_gone_on_waits_for_its_slopes_alone(
    valid: bool, rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After a gap in which signals have gone on: until more than the warm-up has passed."""
    one, replays = _Watch(monkeypatch, _MEMORY._replace(unknown=())), []

    def replayed(case: Any, start: Array, tolerated: object) -> tuple[Any, list[Row]]:
        replays.append((len(case.rows), start.tolist()))
        return None, [row._replace(value=row.value.copy()) for row in case.rows]

    monkeypatch.setattr(origins, "replayed", replayed)
    for _ in range(3):
        assert one.row() is None
    one.origins.restart([])
    for number in range(1, rows + 1):
        found = one.row(5.0 * np.ones((_EVERY, 3)), valid or number > 1)
        assert (found is not None) == (number == rows) and not one.origins.lost.any()
    assert replays == [(rows, [1.0, 5.0, 5.0])]  # it began with 1, the others with what they are
    assert one.looks == [] and not one.origins.waiting.any() and not one.origins.looking


# ------------------------------------------------------------------------------- readings


def test_the_newest_readings_and_the_largest_speed() -> None:
    own = Readings(2, 0.1)
    time = np.arange(5.0)
    samples = np.array([[0, 1], [2, np.nan], [np.nan, np.nan], [9, np.nan], [12, np.nan]])
    own.note(time, samples, [0, 1], 3)
    assert (own.last(0), own.last(1)) == (12.0, 1.0)
    assert own.state()["fast"] == [3.0, 0.0]  # 12 in 4 s; of one sample nothing is told
    own.note(5.0 + time, 12.0 + 0.0 * samples, [0], 3)
    own.note(10.0 + time[:3], 100.0 * samples[:3], [0], 3)  # too few
    assert own.last(0) == 200.0 and own.state()["fast"] == [3.0, 0.0]
    other = Readings(2, 0.1)
    other.resume(own.state())
    assert other.state() == own.state() and np.isnan(Readings(1, 0.1).last(0))
    other.note(time, np.full((5, 2), np.nan), [0, 1], 3)
    assert other.last(0) == 200.0


@pytest.mark.parametrize(
    ("gap", "count", "goes"),
    [
        # 10 counts a second, 2 s ago: 30 and two more are room
        (2.0, 1032.0, True),
        (2.0, 1033.0, False),
        (2.0, 968.0, True),
        (2.0, 967.0, False),
        (0.0, 1000.0, False),
        (-0.5, 1000.0, False),
        # after a hundred seconds it could have come there from zero as well, up to 1502
        (100.0, 1502.0, False),
        (100.0, 1503.0, True),
    ],
)
def test_a_counter_goes_on_if_it_can_have_come_there(gap: float, count: float, goes: bool) -> None:
    own = Readings(1, 0.1)
    own.note(np.array([0.0, 1.0, 2.0]), np.array([[980.0], [990.0], [1000.0]]), [0], 2)
    assert own.go_on(np.array([2.0 + gap]), np.array([[count]]), 0, [0]) is goes


@pytest.mark.parametrize(("gap", "sure"), [(0.149, True), (0.151, False)])
def test_near_zero_only_the_next_sample_is_sure(gap: float, sure: bool) -> None:
    own = Readings(1, 0.1)
    own.note(np.array([0.0, 1.0]), np.array([[1.0], [1.0]]), [0], 1)
    assert own.go_on(np.array([1.0 + gap]), np.array([[2.0]]), 0, [0]) is sure
    assert own.go_on(np.array([1.0 + gap]), np.array([[2.0]]), 0, []) is True  # no counter
    # a sample of the same block counts as the newest
    samples = np.array([[500.0], [np.nan], [501.0]])
    assert own.go_on(np.array([5.0, 5.1, 5.2]), samples, 2, [0]) is True


@pytest.mark.parametrize(
    ("scores", "valleys"),
    [
        ([3.0, 1.0, 2.0], [1]),
        ([1.0, 2.0, 0.5], [2, 0]),
        ([3.0, 1.0, 1.0, 1.0, 2.0], [1, 3]),  # the ends of a plain
        ([1.0, 1.0, 1.0], [0, 2]),
        ([0.0, 0.0, 0.0, 1.0], [0, 2]),  # of zeros, too
        ([2.0, 1.0, 1.0 + 1e-7, 1.0, 2.0], [1, 3]),  # as good as a plain
        ([2.0, 1.0, 1.0 + 1e-5, 1.0, 2.0], [1, 3]),  # a ridge
        ([2.0, 1.0 + 1e-5, 1.0, 1.0 + 1e-5, 2.0], [2]),
        ([5.0], [0]),
    ],
)
def test_valleys_are_lower_than_what_is_beside_them(
    scores: list[float], valleys: list[int]
) -> None:
    assert _valleys(np.array(scores)) == valleys
