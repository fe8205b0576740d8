"""Points without a plant, and linear forms: which expressions are linear, and what they come to."""

from __future__ import annotations

import pytest

from bondgraph.exact.evaluate import evaluate
from bondgraph.exact.forms import ORDERS, Forms, NotLinear
from bondgraph.exact.free import FreeSample, linear
from bondgraph.exact.signal_algebra import Exponentials, Taylor
from bondgraph.field.prime import PrimeField
from bondgraph.field.sparse import CONSTANT
from bondgraph.ir.expr import Expr, Kind, Pool

p = Pool()
x, y = (p.symbol(n, Kind.SENSOR) for n in "xy")
u = p.symbol("u", Kind.INPUT)
a = p.symbol("a", Kind.PARAM)
on = p.symbol("on", Kind.MODE)
start = p.symbol("x0", Kind.INITIAL)


def plus(*terms: Expr) -> Expr:
    return p.add(*[(1, term) for term in terms])


@pytest.mark.parametrize(
    ("expr", "expected"),
    [
        (plus(p.mul(a, p.der(x, 2)), p.scale(3, u)), True),
        (p.mul(p.fn("sin", a), p.power(a, -2), p.der(plus(x, y))), True),
        (p.div(x, plus(a, p.one)), True),
        (a, True),
        (p.mul(x, p.der(y)), False),  # a product of signals
        (p.power(x, 2), False),
        (p.div(a, x), False),
        (plus(x, a), False),  # a signal and a constant
        (p.fn("sin", x), False),
        (p.integral(x, start), False),
        (p.mul(on, x), False),  # a switch
        (p.choose(p.compare("<", a, p.one), x, y), False),
    ],
)
def test_what_is_linear_in_signals(expr: Expr, expected: bool) -> None:
    assert linear(expr) == expected


def test_a_linear_expression_is_looked_at_with_exponentials_if_it_has_a_derivative() -> None:
    for expr, kind in ((p.der(x), Exponentials), (x, Taylor), (p.mul(x, p.der(x)), Taylor)):
        assert isinstance(FreeSample.of(expr, 1).algebra, kind)


def test_values_are_drawn_once_and_other_times_have_the_same_constants() -> None:
    sample = FreeSample.of(p.mul(x, p.der(x, 2)), 3)
    assert sample.value(x) == sample.value(x) != sample.value(y)
    assert (len(sample.value(x)), len(sample.value(a)), len(sample.value(on))) == (3, 1, 1)
    assert sample.value(on)[0] in (0, 1)
    later = sample.earlier(1)
    assert later.value(a) == sample.value(a) and later.value(x) != sample.value(x)
    assert later.earlier(1).value(x) not in (later.value(x), sample.value(x))
    assert len(later.value(x)) == 3


def test_a_relation_that_holds_for_all_signals_holds_at_a_free_point() -> None:
    """(x u)' = x' u + x u', with series; x'' + x' of an exponential is (s^2 + s) times it."""
    product = p.sub(p.der(p.mul(x, u)), plus(p.mul(p.der(x), u), p.mul(x, p.der(u))))
    assert not any(evaluate([product], FreeSample.of(product, 1), 1)[0])
    line = plus(p.der(x, 2), p.der(x))
    sample = FreeSample.of(line, 1)
    assert isinstance(sample.algebra, Exponentials)
    s = sample.algebra.s
    assert evaluate([line], sample, 1)[0] == ((s * s + s) * sample.value(x)[0], 1)


def _forms() -> tuple[Forms, int]:
    """The algebra, and the key of an unknown."""
    return Forms(PrimeField(1)), 3 * ORDERS


def test_forms_are_added_and_multiplied_by_what_is_known() -> None:
    """2 (v + 5) - 2 v = 10; (t + 2) (v + 5) = (t + 2) v + 5 t + 10 up to the second coefficient."""
    forms, v = _forms()
    number = forms.numbers.number
    form = {v: [number(1)], CONSTANT: [number(5)]}
    assert forms.combine([(number(2), form), (number(-2), {v: [number(1)]})], 2) == {
        CONSTANT: [number(10)]
    }
    time = {CONSTANT: [number(2), number(1)]}
    found = forms.product([(time, 1), (form, 1)], 2)
    assert found == {v: [number(2), number(1)], CONSTANT: [number(10), number(5)]}
    assert forms.product([(time, 2)], 3)[CONSTANT] == [number(4), number(4), number(1)]
    assert forms.product([(form, 0), (time, 1)], 2) == time


def test_the_derivative_of_a_form_has_that_of_its_coefficients_too() -> None:
    """((t + 2) v + 3 t)' = v + (t + 2) v' + 3, and ((t + 2) v + 7 v')' = v + (t + 2) v' + 7 v''."""
    forms, v = _forms()
    number = forms.numbers.number
    form = {v: [number(2), number(1)], CONSTANT: [number(0), number(3)]}
    assert forms.der(form) == {
        v: [number(1)], v + 1: [number(2), number(1)], CONSTANT: [number(3)],
    }  # fmt: skip
    both = {v: [number(2), number(1)], v + 1: [number(7)]}
    assert forms.der(both) == {
        v: [number(1)], v + 1: [number(2), number(1)], v + 2: [number(7)],
    }  # fmt: skip


def test_what_is_not_linear_says_which_argument_it_is() -> None:
    forms, v = _forms()
    number = forms.numbers.number
    unknown, known = {v: [number(1)]}, {CONSTANT: [number(4)]}
    for product in ([(unknown, 2)], [(unknown, -1)], [(unknown, 1), (unknown, 1)]):
        with pytest.raises(NotLinear) as caught:
            forms.product(product, 1)
        assert (caught.value.form, caught.value.of) == (unknown, "product")
    with pytest.raises(NotLinear) as caught:
        forms.function("atan2", [known, unknown], 1)
    assert (caught.value.of, caught.value.at) == ("atan2", 1)
    assert list(caught.value.beside) == [known, unknown]
    assert forms.try_known({}) == [0] and forms.try_known(unknown) is None
    assert forms.try_known({**known, **unknown}) is None
    assert forms.leads(known) == [number(4)]
