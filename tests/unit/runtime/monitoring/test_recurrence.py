"""When it is told what goes on and on: by a clock that is gone through by hand."""

from __future__ import annotations

from bondgraph.runtime.monitoring.recurrence import Recurrence


def told(times: list[float], one: Recurrence | None = None) -> list[tuple[float, int]]:
    """When something is told that happens at these times, and how many there are then."""
    one = one or Recurrence()
    found = []
    for now in times:
        one.add(1, now)
        if count := one.due(now):
            found.append((now, count))
    return found


def test_pauses_double_up_to_an_hour_while_it_goes_on() -> None:
    """Every twenty seconds: at 0, doubled at 20 and 60; then a minute, two, four, ... an hour.

    The count at a time t is t/20 + 1, and each time it is one less than twice the one before, so
    that only the clock tells.
    """
    at = [0, 20, 60, 120, 240, 480, 960, 1920, 3840, 7440, 11040, 14640]
    expected = [(float(t), t // 20 + 1) for t in at]
    assert told([20.0 * k for k in range(16000 // 20)]) == expected


def test_what_doubles_is_told_without_a_pause() -> None:
    """Ten a second for three seconds: at the first, second, fourth, eighth and sixteenth."""
    times = [k / 10 for k in range(30)]
    assert told(times) == [(0.0, 1), (0.1, 2), (0.3, 4), (0.7, 8), (1.5, 16)]


def test_half_a_minute_without_it_makes_it_new() -> None:
    """Thirty seconds are not more than half a minute; what was never told stays counted."""
    assert told([0.0, 30.0, 60.5]) == [(0.0, 1), (30.0, 2), (60.5, 1)]
    # the third was not told when it went quiet, and counts on
    assert told([0.0, 1.0, 2.0, 40.0]) == [(0.0, 1), (1.0, 2), (40.0, 4)]


def test_where_residuals_warm_up_for_long_ten_of_these_make_it_new() -> None:
    times = [0.0, 100.0, 499.0, 1000.0]
    assert told(times, Recurrence(50.0)) == [(0.0, 1), (100.0, 2), (499.0, 3), (1000.0, 1)]
    assert told(times[:3], Recurrence(3.0)) == [(time, 1) for time in times[:3]]


def test_a_new_one_begins_with_the_short_pause_again() -> None:
    one = Recurrence()
    assert told([0.0, 20.0, 40.0, 60.0, 80.0, 100.0, 120.0], one)[-1] == (120.0, 7)  # pause: 120
    again = [1000.0 + 20.0 * k for k in range(10)]
    assert [t - 1000.0 for t, _ in told(again, one)] == [0.0, 20.0, 60.0, 120.0]


def test_a_clock_that_goes_back_makes_it_new() -> None:
    assert told([1000.0, 1001.0, 5.0]) == [(1000.0, 1), (1001.0, 2), (5.0, 1)]
    # untold ones are told at once: by the new clock nobody knows how long ago the last word was
    assert told([1000.0, 1001.0, 1002.0, 5.0]) == [(1000.0, 1), (1001.0, 2), (5.0, 4)]


def test_several_at_once_count_as_many_and_nothing_is_told_twice() -> None:
    one = Recurrence()
    one.add(5, 0.0)
    assert (one.due(0.0), one.due(0.0), one.count) == (5, 0, 5)
    one.add(4, 1.0)
    assert one.due(1.0) == 0
    one.add(1, 2.0)
    assert one.due(2.0) == 10
    assert one.due(500.0) == 0  # nothing new
