"""Words about expressions, on cases by hand and against the expression itself."""

from __future__ import annotations

from fractions import Fraction

import pytest

from bondgraph.algebra.affine import affine
from bondgraph.algebra.numeric import evaluate
from bondgraph.algebra.zero import is_zero
from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.ir.nodes import first_degree, linear_terms

POOL = Pool()
X, Y = (POOL.symbol(name, Kind.SENSOR) for name in "xy")
K = POOL.symbol("k", Kind.PARAM)
ON = POOL.symbol("on", Kind.MODE)
SUM = POOL.add((2, X), (-3, POOL.mul(K, Y)), (1, POOL.one))
PRODUCT = POOL.div(POOL.mul(K, X), Y)


@pytest.mark.parametrize("node", [X, POOL.num(3), SUM, PRODUCT, POOL.scale(-2, X), POOL.der(X)])
def test_every_node_is_a_sum_a_product_and_a_number_of_times_something(node: Expr) -> None:
    assert POOL.add(*node.terms) is node
    assert POOL.mul(*[POOL.power(a, e) for a, e in node.factors]) is node
    assert POOL.scale(*node.scaled) is node


def test_order_undoes_itself() -> None:
    rate = POOL.der(X)
    area = POOL.integral(X, POOL.symbol("x0", Kind.FREE))
    assert (rate.order, area.order, X.order) == (1, -1, 0)
    assert POOL.der(area) is X


@pytest.mark.parametrize("node", [SUM, PRODUCT])
def test_linear_terms_make_the_node_again(node: Expr) -> None:
    terms = linear_terms(node, {X})
    assert terms is not None
    assert POOL.add(*[term.of(POOL, term.arg) for term in terms]) is node
    assert is_zero(POOL.sub(POOL.add(*[(1, POOL.mul(t.factor(POOL), t.arg)) for t in terms]), node))


def test_a_product_is_linear_in_one_factor_at_most() -> None:
    assert linear_terms(PRODUCT, {X, Y}) is None
    assert linear_terms(PRODUCT, {Y}) is None  # which it divides by
    assert linear_terms(POOL.power(X, 2), {X}) is None
    assert linear_terms(POOL.fn("sin", X), {X}) is None


def test_first_degree() -> None:
    choice = POOL.choose(ON, X, POOL.mul(K, Y))
    for expr, without, with_choices in (
        (SUM, True, True),
        (POOL.mul(K, SUM), True, True),
        (POOL.mul(X, Y), False, False),
        (POOL.div(X, Y), False, False),
        (choice, False, True),
        (POOL.choose(POOL.compare("<", X, Y), X, Y), False, False),
        (POOL.der(X), False, False),
        (POOL.fn("sin", K), True, True),
    ):
        assert first_degree(expr, (X, Y), choices=False) is without
        assert first_degree(expr, (X, Y), choices=True) is with_choices


def test_affine_in_a_variable() -> None:
    zero = POOL.mul(K, POOL.add((2, POOL.mul(Y, POOL.sub(X, Y))), (1, POOL.choose(ON, X, Y))))
    parts = affine(POOL, zero, X)
    assert parts is not None
    slope, rest = parts
    again = POOL.add((1, POOL.mul(slope, X)), (1, rest))
    for on in (0, 1):
        at = {"x": Fraction(3, 7), "y": Fraction(-5, 3), "k": Fraction(2), "on": on}
        assert evaluate(zero, at) == evaluate(again, at) is not None
    assert affine(POOL, zero, Y) is None
