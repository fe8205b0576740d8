"""Adjoints of exponentials: polynomials of which only leading coefficients are carried."""

from __future__ import annotations

import pytest

from bondgraph.exact.exponentials import ExponentialSample, linear, tell
from bondgraph.exact.forms import ORDERS
from bondgraph.exact.plant_equations import Equation
from bondgraph.exact.signal_algebra import Exponentials, Mixed
from bondgraph.field.numbers import Undefined
from bondgraph.field.prime import PrimeField
from bondgraph.field.sparse import CONSTANT
from bondgraph.ir.expr import Kind, Pool


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


p = Pool()
y, z, w = (p.symbol(n, Kind.SENSOR) for n in "yzw")
u, v = (p.symbol(n, Kind.INPUT) for n in "uv")
f = p.symbol("f", Kind.FLOW)
a = p.symbol("a", Kind.PARAM)


def _sample() -> ExponentialSample:
    """f is -7 e^(s t) as its variable has the other sign, u 2, v 3 and a 5."""
    numbers = PrimeField(1)
    algebra = Exponentials(numbers, numbers.number(3), numbers.number(5))
    place = {f: (0, -1), u: (1, 1), v: (2, 1)}
    found = {0: numbers.number(7), 1: numbers.number(2), 2: numbers.number(3)}
    return ExponentialSample(algebra, place, {a: [numbers.number(5)]}, found, {})


def test_sensors_and_inputs_are_told_with_their_errors_and_all_else_as_it_is() -> None:
    """y reads a f' with an error of 100, u errs by 10; what errs by nothing is what it is."""
    sample = _sample()
    number = sample.algebra.numbers.number
    reads = {y: p.mul(a, p.der(f)), z: f}
    tell(sample, reads, {y: number(100), u: number(10), a: number(9)})
    assert sample.value(y) == (100 - 5 * 7 * 3 + number(0), 1)
    assert sample.value(z) == (number(-7), 1)
    assert sample.value(u) == (number(2 - 10), 1) and sample.value(v) == (number(3), 1)
    assert sample.value(a) == (number(5), 0)
    assert sample.earlier(1) is sample


def test_what_is_no_exponential_is_refused() -> None:
    start = p.symbol("x0", Kind.INITIAL)
    sample = _sample()
    for refused in (
        lambda: sample.value(start),
        lambda: sample.start(start.symbol),
        lambda: tell(sample, {y: p.mul(f, u)}, {}),  # of degree 2
        lambda: tell(sample, {y: a}, {}),  # a constant
    ):
        with pytest.raises(Mixed):
            refused()


def test_a_plant_is_linear_if_all_of_its_equations_are_with_constant_coefficients() -> None:
    line = Equation(-1, {0: [1], ORDERS + 1: [2]}, None)
    assert linear([]) and linear([line, line])
    for other in (
        Equation(-1, {0: [1]}, p.fn("sin", f)),
        Equation(-1, {0: [1], CONSTANT: [4]}, None),
        Equation(-1, {0: [1, 2]}, None),
    ):
        assert not linear([other]) and not linear([line, other])
