"""For how many samples residuals count that keep something of where they began."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.remembered import (
    Memory,
    counted,
    from_the_start,
    unknown_starts,
    up_to_gaps,
)
from bondgraph.runtime.log import Array

#: r1 and r3 keep where `a` began and start anew with `b`, r2 keeps nothing.
_ENGINE: Any = SimpleNamespace(
    residuals=("r1", "r2", "r3", "r4"), signals=[SimpleNamespace(path=p) for p in "abcd"]
)
_OF_A = Memory(("r1", "r3"), ("a",), ("a", "b"))


def _samples(*lost: tuple[int, int]) -> Array:
    """Ten samples of four signals, without a number in some places (sample, column)."""
    found = np.ones((10, 4))
    for at in lost:
        found[at] = np.nan
    return found


@pytest.mark.parametrize(
    ("lost", "until"),
    [
        ([], 10),
        ([(4, 2), (5, 3)], 10),  # of signals that do not count
        ([(6, 0)], 6),
        ([(6, 1), (8, 0)], 6),  # the first one counts
        ([(0, 0)], 10),  # the log begins with the first whole sample
        ([(0, 0), (1, 1), (2, 0)], 10),
        ([(0, 0), (1, 1), (7, 0), (9, 0)], 7),
        ([(k, 0) for k in range(10)], 10),  # of nothing that counts it does not matter
    ],
)
def test_a_memory_lasts_from_the_first_whole_sample_to_one_that_is_not(
    lost: list[tuple[int, int]], until: int
) -> None:
    found = from_the_start(_ENGINE, [_OF_A], _samples(*lost), False)
    assert found.tolist() == [until, 10, until, 10]


def test_of_several_memories_each_has_its_own_and_the_shorter_one_counts() -> None:
    other = Memory(("r3", "r4"), ("d",), ("d",))
    found = from_the_start(_ENGINE, [_OF_A, other], _samples((7, 0), (3, 3)), False)
    assert found.tolist() == [7, 10, 3, 3]
    assert from_the_start(_ENGINE, [], _samples((3, 3)), False).tolist() == [10] * 4


def test_behind_a_gap_nothing_counts_but_for_what_a_parameter_tells() -> None:
    told = Memory(("r4",), ("d",), ("d",), begins=("d0",))
    found = from_the_start(_ENGINE, [_OF_A, told], _samples((3, 3)), True)
    assert found.tolist() == [0, 10, 0, 3]


def test_starts_that_samples_have_to_tell_are_unknown_ones_or_all_behind_a_gap() -> None:
    one = Memory(("r1",), ("a",), ("a",), False, ("a0", "a1"), ("a1",))
    other = Memory(("r4",), ("d",), ("d",), False, ("d0",), ("a1", "e0"))
    assert unknown_starts([one, other], False) == ("a1", "e0")
    assert unknown_starts([one, other], True) == ("a0", "a1", "d0")
    assert unknown_starts([], True) == ()


@pytest.mark.parametrize(
    ("later", "told", "expected"),
    [
        (False, {"a1"}, [6, 10, 6, 10]),
        (False, {"a0"}, [0, 10, 0, 10]),
        (False, {"a0", "a1"}, [6, 10, 6, 10]),
        (True, {"a1"}, [0, 10, 0, 10]),
        (True, {"a0", "a1"}, [6, 10, 6, 10]),
    ],
)
def test_residuals_count_whose_unknown_starts_are_all_told(
    later: bool, told: set[str], expected: list[int]
) -> None:
    memory = _OF_A._replace(begins=("a0", "a1"), unknown=("a1",))
    found = counted(_ENGINE, [memory], _samples((6, 0)), later, told)
    assert found.tolist() == expected


def test_residuals_that_lose_seconds_by_gaps_are_named() -> None:
    names = ("r1", "r2", "r3")
    assert up_to_gaps(names, np.zeros(3)) == ""
    assert up_to_gaps(names, np.array([0.0, 4.5, 0.0])).startswith("; r2 counts up to the first")
    assert up_to_gaps(names, np.array([0.1, 0.0, 2.0])).startswith("; r1 and r3 count up to")
