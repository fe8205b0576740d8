"""Directions in which nothing is told, with as few parameters each as there can be."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.told_combinations import (
    Combination,
    _product,
    _sum,
    _whole,
    combinations,
    untold,
)
from bondgraph.runtime.log import Array


def _covariance(*directions: tuple[float, Array]) -> Array:
    """Of a thousandth, and of so much more in some directions at right angles."""
    found = 1e-3 * np.eye(len(directions[0][1]))
    for variance, along in directions:
        own = along / np.linalg.norm(along)
        found += variance * np.outer(own, own)
    return found


_ONE, _OTHER = np.array([1.0, -1.0, 0.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0, -2.0, 0.0])


@pytest.mark.parametrize("turned", [0.3, 0.7, 2.0])
def test_two_directions_that_are_mixed_are_told_apart(turned: float) -> None:
    """Whatever turn of both is the largest one: elimination leaves a pair of parameters each."""
    unit = [x / np.linalg.norm(x) for x in (_ONE, _OTHER)]
    first = np.cos(turned) * unit[0] + np.sin(turned) * unit[1]
    second = np.cos(turned) * unit[1] - np.sin(turned) * unit[0]
    found = untold(_covariance((60.0, first), (50.0, second)), 1.0)
    by_first = {int(np.flatnonzero(row)[0]): row for row in found}
    assert sorted(by_first) == [0, 2]
    assert by_first[0] / by_first[0][0] == pytest.approx(_ONE, abs=1e-9)
    assert by_first[2] / by_first[2][2] == pytest.approx(_OTHER, abs=1e-9)
    for row in found:  # the largest of each is one
        assert np.abs(row).max() == pytest.approx(1.0)


def test_three_directions_share_what_they_have_to() -> None:
    """Of all changes whose sum is zero each leaves two parameters in each row."""
    found = untold(np.eye(4) - 0.25, 0.5)
    assert found.shape == (3, 4)
    assert (found != 0).sum(axis=1).tolist() == [2, 2, 2]
    assert found.sum(axis=1) == pytest.approx(0.0, abs=1e-9)
    assert np.linalg.matrix_rank(found) == 3


def test_what_is_as_much_as_is_asked_for_counts() -> None:
    covariance = np.diag([4.0, 1.0, 9.0])
    assert untold(covariance, 4.0).shape == (2, 3)
    assert untold(covariance, 4.1).shape == (1, 3)
    assert untold(covariance, 9.1).shape == (0, 3)


# --------------------------------------------------------------------- what is told instead


def _told(
    names: str,
    values: Sequence[float],
    null: Sequence[Sequence[float]],
    same: Callable[..., float],
    zeros: Sequence[float] = (),
) -> tuple[Combination, ...]:
    """Of parameters that may change along `null`, in their units, with something the `same`."""
    nominal = same(*values)
    none = np.zeros(len(values)) if not zeros else np.array(zeros)
    return combinations(
        names.split(), values, np.ones(len(values)), none, np.array(null, dtype=float),
        lambda point: abs(same(*point) / nominal - 1.0),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("names", "values", "null", "same", "told"),
    [
        # what changes along (R, L) is no ratio, along (1, -1) no sum
        ("R L", (2.0, 5.0), [(2.0, 5.0)], lambda r, x: r / x, "R/L L/R"),
        ("R C", (2.0, 5.0), [(2.0, -5.0)], lambda r, c: r * c, "R*C"),
        ("a b", (2.0, 3.0), [(1.0, -1.0)], lambda a, b: a + b, "a+b"),
        ("a b", (2.0, 3.0), [(1.0, 2.0)], lambda a, b: 2 * a - b, "2*a-b -2*a+b"),
        ("k R", (2.0, 5.0), [(1.0, 5.0)], lambda k, r: k**2 / r, "k^2/R R/k^2"),
        ("k R J", (2.0, 5.0, 7.0), [(1.0, 5.0, 0.0), (0.0, 5.0, -7.0)],
         lambda k, r, j: k**2 / (r * j), "k^2/(R*J) R*J/k^2"),
        ("a b c", (2.0, 3.0, 5.0), [(1.0, -1.0, 0.0), (0.0, 1.0, -1.0)],
         lambda a, b, c: a + b + c, "a+b+c"),
        # along equal values a sum and a product change alike: what is left decides
        ("a b", (2.0, 2.0), [(1.0, -1.0)], lambda a, b: a + b, "a+b"),
        ("a b", (2.0, 2.0), [(1.0, -1.0)], lambda a, b: a * b, "a*b"),
        # neither whole exponents nor whole factors
        ("a b", (2.0, 3.0), [(1.0, 2.2)], lambda a, b: 2.2 * a - b, ""),
    ],
)  # fmt: skip
def test_what_logs_tell_of_parameters_that_they_do_not_tell_apart(
    names: str,
    values: tuple[float, ...],
    null: list[tuple[float, ...]],
    same: Callable[..., float],
    told: str,
) -> None:
    """Which of two that are one over the other, or less the other, is a matter of taste."""
    (found,) = _told(names, values, null, same)
    assert found.told.replace(" ", "") in (told.split() or [""])
    assert found.parameters == tuple(names.split())


def test_changes_are_relative_to_their_values_and_a_tenth_at_most() -> None:
    (found,) = _told("a b c", (2.0, 3.0, 4.0), [(1.0, -3.0, 0.0)], lambda a, b, c: 3 * a + b)
    (change,) = found.changes
    assert change == pytest.approx({"a": 0.05, "b": -0.1}) and found.zeros == ()
    assert found.parameters == ("a", "b")


def test_of_what_is_declared_zero_a_change_is_in_its_own_unit() -> None:
    """a changes by twice as much as z: by 5 % of 2 with 0.05, a tenth of the size of z."""
    (found,) = _told("a z", (2.0, 0.0), [(2.0, 1.0)], lambda a, z: a - 2 * z, zeros=(0.0, 0.5))
    (change,) = found.changes
    assert found.zeros == ("z",)
    assert change == pytest.approx({"a": 0.05, "z": 0.05})
    assert found.told.replace(" ", "") in ("a-2*z", "-a+2*z")  # no product: zero has no logarithm


def test_what_has_no_parameter_in_common_is_told_apart() -> None:
    names, values = "a b c d e".split(), [2.0, 3.0, 5.0, 7.0, 11.0]
    null = np.array([[1.0, -1.0, 0, 0, 0], [0, 0, 1.0, -1.0, 0], [0, 0, 0, 1.0, -1.0]])
    asked: list[list[int]] = []

    def more(own: Sequence[int]) -> float | None:
        asked.append(list(own))
        return float(len(own))

    found = combinations(
        names, values, np.ones(5), np.zeros(5), null, lambda point: 0.0, more
    )
    assert [one.parameters for one in found] == [("a", "b"), ("c", "d", "e")]
    assert [one.more for one in found] == [2.0, 3.0] and asked == [[0, 1], [2, 3, 4]]
    chained = combinations(
        names, values, np.ones(5), np.zeros(5),
        np.array([[1.0, -1.0, 0, 0, 0], [0, 0, 1.0, -1.0, 0], [0, 1.0, -1.0, 0, 0]]),
        lambda point: 0.0,
    )  # fmt: skip
    assert [one.parameters for one in chained] == [("a", "b", "c", "d")]
    assert chained[0].more is None


def test_one_that_is_not_told_at_all_and_two_with_nothing_in_common() -> None:
    (found,) = _told("a b", (2.0, 3.0), [(1.0, 0.0)], lambda a, b: b)
    assert found.text() == "a is not told" and found.changes == ({"a": 0.1},)
    (both,) = _told("a b", (2.0, 3.0), [(1.0, 1.0), (1.0, -1.0)], lambda a, b: 1.0)
    assert both.told == "" and len(both.changes) == 2


@pytest.mark.parametrize(
    ("numbers", "whole"),
    [
        ([0.2, -0.4], [1, -2]),
        ([-0.2, -0.4], [1, 2]),  # one of them counts up
        ([-0.2, 0.6, 0.2], [-1, 3, 1]),
        ([1.0, 2.08], [1, 2]),
        ([1.0, 2.2], None),
        ([1.0, 4.0], None),
        ([3.0, 3.0], [1, 1]),
    ],
)
def test_whole_multiples(numbers: list[float], whole: list[int] | None) -> None:
    assert _whole(np.array(numbers)) == whole


def test_products_and_sums_as_they_are_written() -> None:
    names = ["R", "J", "k"]
    assert _product(names, [1, 1, -2]) == "R*J/k^2"
    assert _product(names, [-1, -1, 2]) == "k^2/(R*J)"
    assert _product(names, [-1, -1, -3]) == "R*J*k^3"
    assert _product(names[:2], [1, -1]) == "R/J"
    assert _sum(names, [1, -2, 3]) == "R - 2*J + 3*k"
    assert _sum(names, [-1, 1, -1]) == "-R + J - k"
