"""How many terms a sum has with all derivatives taken, counted by hand."""

from __future__ import annotations

from math import comb

import pytest

from bondgraph.algebra.written_out import terms_written_out
from bondgraph.ir.expr import Expr, Kind, Pool

p = Pool()
x, y, z, w = (p.symbol(name, Kind.SENSOR) for name in "xyzw")
k, on, start = p.symbol("k", Kind.PARAM), p.symbol("on", Kind.MODE), p.symbol("x0", Kind.INITIAL)


def _derived(expr: Expr, order: int) -> Expr:
    return p.der(expr, order) if order else expr


@pytest.mark.parametrize("order", range(5))
def test_derivatives_of_products_have_the_terms_of_the_product_rule(order: int) -> None:
    """Orders are shared out among the factors; of one factor all of them are its own."""
    assert terms_written_out(_derived(x, order)) == 1
    assert terms_written_out(_derived(p.mul(x, y), order)) == order + 1
    assert terms_written_out(_derived(p.mul(x, y, z), order)) == comb(order + 2, 2)
    assert terms_written_out(_derived(p.power(x, 3), order)) == comb(order + 2, 2)
    assert terms_written_out(_derived(p.power(x, 4), order)) == comb(order + 3, 3)
    assert terms_written_out(_derived(p.mul(k, x, y), order)) == order + 1
    if order:  # what nothing differentiates stays a product
        both = p.mul(p.add((1, x), (1, y)), p.add((1, z), (2, w)))
        assert terms_written_out(_derived(both, order)) == 4 * (order + 1)
    assert terms_written_out(_derived(p.add((1, x), (1, p.mul(y, z))), order)) == order + 2


@pytest.mark.parametrize("order", range(1, 5))
def test_derivatives_of_functions_double_with_each(order: int) -> None:
    """The first is a slope times x'; of that product either factor is differentiated next.

    So are a power that is not multiplied out, and what stands below a bar.
    """
    for expr in (p.fn("sin", x), p.power(x, 5), p.power(x, -1)):
        assert terms_written_out(expr) == 1
        assert terms_written_out(_derived(expr, order)) == 2 ** (order - 1)
    # of two arguments twice as many begin with each: 2, then 2 + 2*2, ...
    assert terms_written_out(_derived(p.fn("atan2", x, y), order)) == 2 * 3 ** (order - 1)
    switched = p.choose(on, x, p.fn("sin", k))  # what stays adds nothing
    assert terms_written_out(_derived(switched, order)) == 2 ** (order - 1)


def test_what_stays_has_no_derivative_and_counts_once_in_a_sum() -> None:
    assert terms_written_out(p.add((1, x), (1, k), (3, p.one))) == 3
    assert terms_written_out(p.der(p.add((1, x), (1, p.mul(x, y)), (1, p.mul(k, x))))) == 4
    assert terms_written_out(p.mul(x, p.add((1, k), (1, p.one)))) == 1  # a factor that stays
    integral = p.integral(p.add((1, x), (1, y)), start)
    assert terms_written_out(integral) == 1
    assert terms_written_out(p.der(p.mul(integral, z))) == 1 + 2  # z' times it, (x + y) times z
    assert terms_written_out(p.der(p.mul(integral, z), 2)) == 1 + 2 * 1 + 2


def test_a_derivative_inside_of_a_derivative_is_one_of_a_higher_order() -> None:
    """(x y')' = x' y' + x y'', and (x (y z)')' has three terms more than (y z)' has."""
    assert terms_written_out(p.der(p.mul(x, p.der(y)))) == 2
    assert terms_written_out(p.der(p.mul(x, p.der(p.mul(y, z))))) == 2 + 3
    assert terms_written_out(p.der(p.mul(p.der(p.mul(x, y)), p.der(p.mul(z, w))))) == 2 * (3 * 2)
