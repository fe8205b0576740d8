"""Series and exponentials as algebras: values, adjoints, and what each of them refuses."""

from __future__ import annotations

from fractions import Fraction

import pytest

from bondgraph.exact.signal_algebra import Exponentials, Mixed, Taylor, compare
from bondgraph.field.balls import Reals
from bondgraph.field.numbers import Number, Numbers, Undefined
from bondgraph.field.prime import PrimeField
from bondgraph.field.series import Series

F = PrimeField(1)
R = Reals({})
S, SIGMA = 3, 5


def _exponentials(terms: int = 3) -> Exponentials:
    return Exponentials(F, F.number(S), F.number(SIGMA), terms)


def _is(found: tuple[Number, int], value: Fraction | int, degree: int) -> bool:
    return found == (F.fraction(value), degree)


@pytest.mark.parametrize("f", [F, R], ids=["field", "reals"])
def test_sums_and_products_of_series_that_are_not_of_one_length(f: Numbers) -> None:
    t = Taylor(f)
    one, two = [f.number(c) for c in (2, 3)], [f.number(c) for c in (1, 0, 4)]
    assert t.combine([(2, one), (-1, two)], 3) == [3, 6, -4]
    assert t.combine([(2, one), (-1, two)], 2) == [3, 6]
    assert t.combine([(2, one), (-1, two)], 1) == [3]
    assert t.product([(one, 2), (two, 1)], 3) == [4, 12, 25]  # (4 + 12 t + 9 t^2)(1 + 4 t^2)
    assert t.product([(one, 0)], 3) == [1] and t.product([], 2) == [1]
    assert t.product([(two, 1), (one, 0)], 2) == [1, 0]
    assert t.leads(one, two) == [2, 1]
    assert not t.moves([f.number(0)] * 2) and t.moves([f.number(0), f.number(1)])


def test_adjoints_of_series_by_the_orders_they_belong_to() -> None:
    """A number k of an adjoint is the derivative of the result by coefficient k."""
    t = Taylor(F)
    adjoint: Series = [F.number(c) for c in (7, 0, 2)]
    # coefficients 0 .. 2 of slope * change, where the slope is 1 + 3 t + 5 t^2
    assert t.back(adjoint, [1, 3, 5], 3) == [7 + 0 + 10, 0 + 6, 2]
    assert t.back(adjoint, [4], 3) == t.times(adjoint, 4) == [28, 0, 8]
    assert t.back_der(adjoint, []) == [0, 7, 0, 6]
    assert [x * 2 for x in t.back_integral(adjoint)] == [0, 2]
    assert t.join(adjoint, [1]) == [8, 0, 2]
    assert t.order(adjoint) == 2 and t.order([F.number(4), F.number(0)]) == 0
    assert t.start_of(adjoint) == 7
    assert t.lasting(adjoint) and not t.lasting([F.number(0), F.number(1)])
    assert t.vanishes([F.number(0)] * 2) and not t.vanishes(adjoint)
    assert t.seed(F.number(6)) == [6]


def test_exponentials_add_where_they_grow_alike_and_multiply_in_any_case() -> None:
    e = _exponentials()
    signal, constant, none = (F.number(2), 1), (F.number(7), 0), (F.number(0), 1)
    assert _is(e.combine([(3, signal), (-1, (F.number(1), 1))], 1), 5, 1)
    assert _is(e.combine([(3, constant), (2, none)], 1), 21, 0)  # a zero grows as one likes
    assert e.combine([(1, none)], 1)[0] == 0
    for terms in ([(1, signal), (1, constant)], [(1, constant), (1, none), (2, signal)]):
        with pytest.raises(Mixed):
            e.combine(terms, 1)
    assert _is(e.product([(signal, 2), (constant, -1)], 1), Fraction(4, 7), 2)
    assert _is(e.der(e.product([(signal, 2)], 1)), 4 * 2 * S, 2)
    assert e.der(constant)[0] == 0
    assert _is(e.number(F.number(9)), 9, 0)


def test_exponentials_refuse_functions_and_decisions_of_signals_alone() -> None:
    e = _exponentials()
    signal, constant, none = (F.number(2), 1), (F.number(9), 0), (F.number(0), 1)
    for refused in (
        lambda: e.function("sin", [signal], 1),
        lambda: e.function("atan2", [constant, signal], 1),
        lambda: e.function("abs", [none], 1),  # a signal that is zero at one moment only
        lambda: e.rational(signal, Fraction(1, 2), 1),
        lambda: e.leads(constant, signal),
        lambda: e.integral(constant, F.number(1)),
        lambda: e.back_integral(e.seed(F.number(1))),
        lambda: e.slopes("sin", [signal], constant, 1),
    ):
        with pytest.raises(Mixed):
            refused()
    assert e.leads(none, constant) == [0, 9]
    assert _is(e.rational(constant, Fraction(2), 1), 81, 0)
    assert e.function("exp", [constant], 1) == (F.exp(F.number(9)), 0)
    two = e.function("pow", [(F.exp(F.number(4)), 0), (F.number(3), 0)], 1)
    assert two == (F.exp(F.number(12)), 0)
    with pytest.raises(Undefined):
        e.rational((-constant[0], 0), Fraction(1, 2), 1)


def test_functions_of_constants_among_exponentials_have_slopes() -> None:
    e = _exponentials()
    a, b = (F.exp(F.number(4)), 0), (F.number(3), 0)
    value = e.function("exp", [b], 1)
    assert list(e.slopes("exp", [b], value, 1)) == [value]
    power = e.function("pow", [a, b], 1)
    by_a, by_b = e.slopes("pow", [a, b], power, 1)
    assert by_a[0] * a[0] == 3 * power[0] and by_a[1] == 0
    assert by_b == (power[0] * 4, 0)


@pytest.mark.parametrize("terms", [0, 3])
def test_a_change_that_grows_and_one_that_stays_are_told_apart(terms: int) -> None:
    """Of D D y and D (x y): changes e^(sigma t) of y, and of a constant y that was there."""
    e = _exponentials(terms)
    signal, constant = (F.number(2), 1), (F.number(7), 0)
    top = e.seed(F.number(1))
    twice = e.back_der(e.back_der(top, constant), constant)
    assert twice[0] == SIGMA * SIGMA and e.order(twice) == 2
    assert not e.lasting(twice)  # a constant that is another one has no derivative either
    moved = e.times(e.back_der(top, signal), 4)
    assert moved[0] == 4 * (SIGMA + S) and e.lasting(moved) and e.order(moved) == 1
    assert e.start_of(moved) == moved[0] and not e.vanishes(moved)
    assert e.lasting(top) and e.order(top) == 0
    gone = e.join(moved, e.times(moved, -1))
    assert e.vanishes(gone) and not e.lasting(gone)
    both = e.join(top, twice)
    assert both[0] == 1 + SIGMA**2 and e.order(both) == 2 and e.lasting(both)
    assert e.join(twice, top)[:3] == both[:3]
    assert e.back(top, (F.number(6), 0), 1) == e.times(top, 6)


def test_the_order_is_that_of_the_highest_coefficient_that_does_not_cancel() -> None:
    """(sigma + s)(sigma + 0) - sigma^2 is s sigma; with few coefficients carried it is not said."""
    e = _exponentials()
    signal, constant = (F.number(2), 1), (F.number(7), 0)
    top = e.seed(F.number(1))
    one = e.back_der(e.back_der(top, signal), constant)
    two = e.times(e.back_der(e.back_der(top, constant), constant), -1)
    assert e.order(e.join(one, two)) == e.order(e.join(two, one)) == 1
    assert e.join(one, two)[0] == S * SIGMA
    few = _exponentials(1)
    one = few.back_der(few.back_der(few.seed(F.number(1)), signal), constant)
    two = few.times(few.back_der(few.back_der(few.seed(F.number(1)), constant), constant), -1)
    assert few.order(one) == 2
    with pytest.raises(Mixed, match="cancel"):
        few.order(few.join(one, two))


@pytest.mark.parametrize("f", [F, R], ids=["field", "reals"])
def test_comparisons_of_numbers(f: Numbers) -> None:
    three, also = f.number(3), f.fraction(Fraction(6, 2))
    nine = f.number(3) + f.power(f.number(9), Fraction(1, 2)) ** 2  # above by a square
    for op, equal, below, above in (("<", 0, 1, 0), ("<=", 1, 1, 0), ("==", 1, 0, 0)):
        assert compare(f, op, three, also) == bool(equal)
        assert compare(f, op, three, nine) == bool(below)
        assert compare(f, op, nine, three) == bool(above)
