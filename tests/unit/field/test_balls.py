"""Zeros of functions over the reals: which one is taken, and what is none."""

from __future__ import annotations

from collections.abc import Iterator
from random import Random

import pytest
from flint import arb, ctx

from bondgraph.field.balls import NOTHING, Precision, Reals, zero_between, zero_of
from bondgraph.field.numbers import Number, Undefined


@pytest.fixture(autouse=True)
def bits() -> Iterator[None]:
    """As many as the reals of a model begin with, whatever ran before."""
    with ctx.workprec(Precision().bits):
        yield


def test_a_jump_over_zero_is_no_solution() -> None:
    def step(z: Number) -> Number:
        return arb(1) if z > arb(1) / 3 else arb(-1)

    with pytest.raises(Undefined):
        zero_of(step, arb(0))


@pytest.mark.parametrize("zeros", [(-2.0, 0.5), (1.0, 1.1, 7.0), (-30.0, 4.0)])
def test_the_zero_nearest_to_a_known_one_is_taken(zeros: tuple[float, ...]) -> None:
    def product(z: Number) -> Number:
        out = arb(1)
        for zero in zeros:
            out = out * (z - zero)
        return out

    for zero in zeros:
        assert abs(float(zero_of(product, arb(zero + 0.01))) - zero) < 1e-12


def test_a_zero_is_enclosed_in_a_ball_that_no_quantity_of_a_machine_resolves() -> None:
    for power, low, high in ((3, 0, 5), (5, -1, 3), (3, 1, 40)):
        root = arb(2).root(power)
        for sign in (1, -1):
            found = zero_between(lambda z, p=power, s=sign: s * (z**p - 2), arb(low), arb(high))
            assert found.overlaps(root) and found.rad() < NOTHING


def test_a_zero_at_an_end_or_in_the_middle_is_found_there() -> None:
    for low, high in ((3, 9), (1, 5), (-7, 3), (0, 12)):
        found = zero_between(lambda z: z - 3, arb(low), arb(high))
        assert found.contains(3) and found.rad() < NOTHING


@pytest.mark.parametrize("power", [1, 3, 7])
@pytest.mark.parametrize("side", [1, -1])
def test_straight_lines_take_over_from_halves_and_converge(power: int, side: int) -> None:
    """512 bits by halves alone would take 512 values; 20 halves and lines of order 1.44 do not."""
    asked: list[Number] = []

    def curved(z: Number) -> Number:
        asked.append(z)
        return (side * z).exp() ** power - 5

    found = zero_between(curved, arb(-3), arb(4))
    assert found.overlaps(side * arb(5).log() / power)
    assert len(asked) < 60


def test_a_zero_between_large_numbers_is_enclosed_in_proportion() -> None:
    found = zero_between(lambda z: z**3 - arb(10) ** 60, arb(0), arb(10) ** 25)
    assert found.overlaps(arb(10) ** 20) and found.rad() < NOTHING * arb(10) ** 20


def test_a_pole_is_no_zero_however_steep() -> None:
    for sign in (1, -1):
        with pytest.raises(Undefined):
            zero_between(lambda z, s=sign: s / (z - arb(1) / 3), arb(0), arb(1))


def test_numbers_where_a_function_has_no_value_are_passed_over() -> None:
    """log z = 1 from -1 on: z is e, though half of the numbers have no logarithm."""

    def law(z: Number) -> Number:
        return Reals({}).log(z) - 1

    assert abs(float(zero_of(law, arb(-1))) - 2.718281828459045) < 1e-12


def test_where_a_function_has_no_zero_none_is_found() -> None:
    def nowhere(z: Number) -> Number:
        raise Undefined("no value")

    for law in (nowhere, lambda z: z * z + 1):
        with pytest.raises(Undefined):
            zero_of(law, arb(0))


@pytest.mark.parametrize("start", [0, 1, 2, 7])
def test_a_start_that_is_a_zero_is_kept_though_others_are_near(start: int) -> None:
    found = zero_of(lambda z: (z - start) * (z - start - 1) * (z - start + 1), arb(start))
    assert found.contains(start) and found.rad() < NOTHING * 8


def test_a_zero_far_from_a_start_is_found_as_one_very_near() -> None:
    for zero in (1e-9, 1e9, -1e7):
        found = zero_of(lambda z, at=zero: z**3 - arb(at) ** 3, arb(2))
        assert abs(float(found) / zero - 1) < 1e-12


def test_a_zero_without_a_change_of_sign_is_found_where_it_is_met() -> None:
    """Zero and one are looked at wherever a search begins."""
    assert zero_of(lambda z: z * z, arb(0)) == 0
    assert zero_of(abs, arb(0)) == 0
    assert zero_of(lambda z: (z - 1) ** 2, arb(0)) == 1
    assert zero_between(lambda z: z * (z - 3), arb(0), arb(1)) == 0


def test_with_random_numbers_any_zero_within_reach_is_taken() -> None:
    def cubic(z: Number) -> Number:
        return (z + 2) * (z - 1) * (z - 30)

    found = {round(float(zero_of(cubic, arb(0), Random(seed))), 9) for seed in range(40)}
    assert found == {-2.0, 1.0, 30.0}
