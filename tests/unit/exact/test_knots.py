"""Nonlinear laws that hold each other: satisfied at once, or said not to be."""

from __future__ import annotations

from collections.abc import Iterator
from random import Random

import pytest
from flint import arb, ctx

from bondgraph.exact.evaluate import evaluate
from bondgraph.exact.forms import ORDERS
from bondgraph.exact.knots import together
from bondgraph.exact.known import KnownSample, gradient
from bondgraph.exact.plant_equations import Equation, Setting
from bondgraph.exact.point import STRIDE, Point
from bondgraph.exact.signal_algebra import Mixed
from bondgraph.field.balls import Precision, Reals
from bondgraph.field.numbers import Number, Undefined
from bondgraph.field.prime import PrimeField
from bondgraph.field.sparse import CONSTANT
from bondgraph.ir.expr import Expr, Kind, Pool

p = Pool()
x, y, z = (p.symbol(n, Kind.FLOW) for n in "xyz")
a = p.symbol("a", Kind.PARAM)
_PLACE = {x: (0, 1), y: (1, -1), z: (2, 1)}
_x, _y, _z = (v * ORDERS for v in range(3))


@pytest.fixture(autouse=True)
def bits() -> Iterator[None]:
    """As many as the reals of a model begin with, whatever ran before."""
    with ctx.workprec(Precision().bits):
        yield


def _plus(*terms: Expr) -> Expr:
    return p.add(*[(1, term) for term in terms])


def _point(seed: int = 1) -> Point:
    reals = Reals({})
    return Point(_PLACE, Setting({a: [reals.number(2)]}, reals, 2), Random(seed))


def _solved(
    laws: list[Equation], seed: int = 1, evaluations: int = 200, point: Point | None = None
) -> dict[int, Number]:
    return together(point or _point(seed), laws, STRIDE, evaluations)


@pytest.mark.parametrize("seed", range(4))
def test_two_laws_determine_two_numbers_whatever_they_begin_with(seed: int) -> None:
    """exp(x) + y = 2 falls and sinh(y) + y - x = sinh(1) + 1 rises: they meet at x = 0, y = 1."""
    one = arb(1)
    laws = [
        Equation(-1, {CONSTANT: [arb(-2)]}, _plus(p.fn("exp", x), y)),
        # y is the negative of its variable
        Equation(-1, {_x: [-one], _y: [-one], CONSTANT: [-one - one.sinh()]}, p.fn("sinh", y)),
    ]
    found = _solved(laws, seed)
    assert set(found) == {0, STRIDE}
    assert found[0].contains(0) and found[STRIDE].contains(-1)
    assert all(value.rad() < arb(2) ** -256 for value in found.values())


@pytest.mark.parametrize("seed", range(4))
def test_of_more_numbers_than_laws_those_that_are_found_satisfy_them(seed: int) -> None:
    """x^2 + y^2 + z^2 = 9 and a x y z = z with a = 2: a curve, of which any point will do."""
    square = _plus(p.power(x, 2), p.power(y, 2), p.power(z, 2))
    laws = [
        Equation(-1, {CONSTANT: [arb(-9)]}, square),
        Equation(-1, {_z: [arb(-1)]}, p.mul(a, x, y, z)),
    ]
    found = _solved(laws, seed)
    assert set(found) == {0, STRIDE, 2 * STRIDE}
    X, Y, Z = found[0], -found[STRIDE], found[2 * STRIDE]
    assert (X**2 + Y**2 + Z**2 - 9).contains(0)
    assert (2 * X * Y * Z - Z).contains(0)


def test_what_linear_equations_have_tied_together_stays_so() -> None:
    """x = v1 + 1 already; x^3 = 8 leaves v1 = 1 and nothing else is asked for."""
    point = _point()
    point.add({0: arb(1), STRIDE: arb(-1), CONSTANT: arb(-1)})
    found = _solved([Equation(-1, {CONSTANT: [arb(-8)]}, p.power(x, 3))], point=point)
    assert len(found) == 1
    for column, value in found.items():
        point.fix({column: arb(1)}, value)
    assert (point.fix({0: arb(1)}) - 2).contains(0)
    assert (point.fix({STRIDE: arb(1)}) - 1).contains(0)


def test_a_rate_counts_with_the_coefficient_that_it_is() -> None:
    """The second derivative is twice coefficient two: where its cube is 64 that is 2."""
    law = Equation(-1, {CONSTANT: [arb(-64)]}, p.power(p.der(x, 2), 3))
    assert _solved([law])[2].contains(2)


def test_a_step_is_cut_where_a_law_has_no_value() -> None:
    """log(x) = -3 far from where random numbers are: a whole step leads below zero."""
    law = Equation(-1, {CONSTANT: [arb(3)]}, p.fn("log", p.fn("abs", x)))
    for seed in range(4):
        found = _solved([law], seed)[0]
        assert abs(abs(float(found)) - 0.049787068367863944) < 1e-15


def test_laws_without_a_solution_or_without_time_for_it_are_refused() -> None:
    nowhere = Equation(-1, {CONSTANT: [arb(1)]}, p.power(x, 2))
    twice = Equation(-1, {CONSTANT: [arb(-3)]}, p.power(x, 2))
    for laws, evaluations in (([nowhere], 200), ([twice, twice], 200), ([twice], 2)):
        with pytest.raises(Undefined):
            _solved(laws, evaluations=evaluations)


# ------------------------------------------------------------------------- laws at known points


def _known(*variables: list[int]) -> KnownSample:
    f = PrimeField(1)
    series = [[f.number(c) for c in told] for told in variables]
    return KnownSample(_PLACE, Setting({a: [f.number(2)]}, f, 3), series)


def test_variables_are_told_with_their_signs_and_constants_as_they_are() -> None:
    sample = _known([1, 2], [5, 7], [0])
    assert sample.value(x) == [1, 2] and sample.value(a) == [2]
    assert [c + 5 * (k == 0) + 7 * k for k, c in enumerate(sample.value(y))] == [0, 0]
    assert evaluate([p.mul(a, x, y)], sample, 2)[0] == [-10, -34]
    for alien in (p.symbol("x0", Kind.INITIAL), p.integral(x, p.symbol("x0", Kind.INITIAL))):
        with pytest.raises(Mixed):
            evaluate([alien], sample, 1)


def test_slopes_of_a_law_by_variables_and_their_derivatives() -> None:
    """Of a x'' y + y^2 - x at x = 4 + 3 t + 5 t^2 and v1 = 7: a x'' is 20, y is -7."""
    law = _plus(p.mul(a, p.der(x, 2), y), p.power(y, 2), p.neg(x))
    found = gradient(law, _known([4, 3, 5], [7], [0]), _PLACE)
    f = PrimeField(1)
    expected = {(0, 2): 2 * -7, (1, 0): -(20 + 2 * -7), (0, 0): -1}
    assert found == {key: f.number(value) for key, value in expected.items()}
    both = gradient(_plus(p.mul(x, z), p.neg(p.mul(x, z, a))), _known([4], [0], [9]), _PLACE)
    assert both == {(0, 0): f.number(-9), (2, 0): f.number(-4)}
    with pytest.raises(Undefined):
        gradient(p.power(z, -1), _known([4], [7], [0]), _PLACE)
