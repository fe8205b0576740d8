"""Adjoints of exponentials: polynomials of which only leading coefficients are carried."""

from __future__ import annotations

import pytest

from bondgraph.exact.signal_algebra import Exponentials
from bondgraph.field.numbers import Undefined
from bondgraph.field.prime import PrimeField


def test_a_derivative_keeps_no_coefficient_that_rests_on_one_cut_off() -> None:
    # 7 x^5 + 11 x^4 + (unknown) x^3 ... times (x + 2 s) with s = 3:
    # 7 x^6 + (11 + 42) x^5 + (unknown + 66) x^4 ...
    numbers = PrimeField(1)
    exponentials = Exponentials(numbers, numbers.number(3), numbers.number(5))
    one, zero = numbers.number(1), numbers.number(0)
    found = exponentials.back_der((one, zero, 5, 4, [7, 11]), (one, 2))
    assert found[2:] == (6, 5, [7, 11 + 42])
    # of 7 x + 11 nothing is cut off: 7 x^2 + 53 x + 66
    whole = exponentials.back_der((one, zero, 1, 0, [7, 11]), (one, 2))
    assert whole[2:] == (2, 0, [7, 53, 66])


def test_a_product_of_powers_adds_degrees_and_nothing_is_divided_by_zero() -> None:
    numbers = PrimeField(1)
    exponentials = Exponentials(numbers, numbers.number(3), numbers.number(5))
    two, five, none = (numbers.number(n) for n in (2, 5, 0))
    # (2 e)^3 (5 e^2)^-1 (5 e)^0, of degree 3 - 2 + 0
    found, degree = exponentials.product([((two, 1), 3), ((five, 2), -1), ((five, 1), 0)], 1)
    assert (found * five, degree) == (numbers.number(8), 1)
    assert exponentials.product([((none, 0), 2), ((five, 1), 1)], 1)[0] == none
    with pytest.raises(Undefined):
        exponentials.product([((none, 0), -1), ((five, 1), 1)], 1)
