"""Times of streams in words, beside what the calendar of the standard library says."""

from __future__ import annotations

import math
from datetime import UTC, datetime, timedelta

import pytest

from bondgraph.runtime.monitoring.clock import Gap
from bondgraph.text.moment import moment


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0.0, "0.000 s"),
        (-2.5, "-2.500 s"),
        (999999999.9, "999999999.900 s"),
        (1e9, "2001-09-09T01:46:40.000Z"),
        (1.7723e9 + 0.9996, "2026-02-28T17:33:21.000Z"),
        (math.inf, "inf s"),
        (math.nan, "nan s"),
        (1e15, "1000000000000000.000 s"),
    ],
)
def test_a_time_is_told_as_people_read_it(seconds: float, words: str) -> None:
    assert moment(seconds) == words


def test_a_date_is_the_one_that_was_read() -> None:
    begin = datetime(1970, 1, 1, tzinfo=UTC)
    for seconds in (1.2e9, 1.5e9 + 0.125, 4.1e9):
        told = datetime.fromisoformat(moment(seconds).replace("Z", "+00:00"))
        assert told - begin == timedelta(seconds=seconds)


def test_a_gap_of_a_clock_is_told_with_dates() -> None:
    assert Gap(1e9, 1e9 + 2.5, 24).text == (
        "24 samples lost from 2001-09-09T01:46:40.000Z to 2001-09-09T01:46:42.500Z"
    )
    assert Gap(4.0, 4.5, 4).text == "4 samples lost from 4 s to 4.5 s"
