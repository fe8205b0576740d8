"""Roots as functions of time: x of x + x^3 = y, whose equation and slope are written by hand."""

from __future__ import annotations

import pytest
from flint import arb

from bondgraph.algebra.implicit import invert
from bondgraph.exact.adjoints import pull
from bondgraph.exact.evaluate import evaluate, values_of
from bondgraph.exact.free import FreeSample
from bondgraph.exact.outline import plan
from bondgraph.exact.signal_algebra import Exponentials, Mixed, Taylor
from bondgraph.field.balls import Reals
from bondgraph.field.numbers import Undefined
from bondgraph.field.prime import PrimeField
from bondgraph.field.series import Series
from bondgraph.ir.expr import Expr, Kind, Op, Pool, Symbol

pool = Pool()
y = pool.symbol("y", Kind.SENSOR)
unknown = pool.symbol("x", Kind.TEAR)
rises = pool.add((1, unknown), (1, pool.power(unknown, 3)))
x = invert(pool, pool.sub(y, rises), unknown, lambda _: None)
assert x is not None and x.op is Op.ROOT


class Told:
    """A sensor that shows a series of real numbers."""

    algebra = Taylor(Reals({}))

    def __init__(self, *coefficients: int) -> None:
        self.coefficients: Series = [arb(c) for c in coefficients]

    def value(self, _: Expr) -> Series:
        return self.coefficients

    def start(self, _: Symbol) -> int:
        return 0


def test_the_value_and_every_coefficient_solve_the_equation() -> None:
    sample = Told(10, -3, 5, 1)
    found, back = evaluate([x, pool.add((1, x), (1, pool.power(x, 3)))], sample, 4)
    assert abs(float(found[0]) - 2) < 1e-12
    assert all((c - told).contains(0) for c, told in zip(back, sample.coefficients, strict=True))
    assert abs(float(found[1]) + 3 / 13) < 1e-12  # y' / (1 + 3 x^2)


def test_the_slope_is_that_of_the_implicit_function() -> None:
    nodes, need = plan(x, 1)
    sample = Told(10)
    adjoints = {x: [1]}
    pull(nodes, need, values_of(nodes, need, sample)[0], sample.algebra, adjoints)
    assert abs(float(adjoints[y][0]) - 1 / 13) < 1e-12


def test_without_a_plant_it_moves_as_its_equation_says_from_a_random_value() -> None:
    sample = FreeSample(Taylor(PrimeField(5)), 2, 7)
    (found,), (signal,) = evaluate([x], sample, 2), evaluate([y], sample, 2)
    assert found[1] * (1 + 3 * found[0] ** 2) == signal[1]
    assert evaluate([x], sample) == [found[:1]]


@pytest.mark.parametrize(("kind", "refused"), [(Kind.SENSOR, Mixed), (Kind.PARAM, Undefined)])
def test_exponentials_have_no_root(kind: Kind, refused: type[Exception]) -> None:
    of = pool.substitute([x], {y: pool.symbol(kind.value, kind)})[0]
    numbers = PrimeField(1)
    with pytest.raises(refused):
        evaluate([of], FreeSample(Exponentials(numbers, 3, 5), 0, 1))


class OfPlant(Told):
    """A point of a plant that says what the variable of the root truly is."""

    def __init__(self, true: int | None, healthy: bool, *coefficients: int) -> None:
        super().__init__(*coefficients)
        self.true, self.healthy = true, healthy

    def truly(self, _: Expr) -> object:
        return None if self.true is None else arb(self.true)


def test_on_a_healthy_plant_the_variable_has_to_solve_the_equation() -> None:
    """x + x^3 = 10 is solved by 2; a plant without the variable lets it be searched for."""
    assert evaluate([x], OfPlant(2, True, 10), 1)[0] == [2]
    for wrong in (3, None):
        with pytest.raises(Undefined):
            evaluate([x], OfPlant(wrong, True, 10), 1)
        found = evaluate([x], OfPlant(wrong, False, 10), 1)[0]
        assert abs(float(found[0]) - 2) < 1e-12
    assert evaluate([x], OfPlant(2, False, 10), 1)[0] == [2]


def test_in_a_field_a_faulty_plant_has_no_solution_to_search_for() -> None:
    class InField(OfPlant):
        algebra = Taylor(PrimeField(1))  # type: ignore[assignment]

        def truly(self, _: Expr) -> object:
            return self.algebra.numbers.number(2)

        def value(self, _: Expr) -> Series:
            return [self.algebra.numbers.number(int(float(c))) for c in self.coefficients]

    assert evaluate([x], InField(2, False, 10, 13), 2)[0] == [2, 1]
    with pytest.raises(Mixed):
        evaluate([x], InField(2, False, 11), 1)


def test_without_a_plant_one_equation_with_the_same_numbers_has_one_root() -> None:
    """And another with others; of exponentials only what is constant all through is undefined."""
    sample = FreeSample(Taylor(PrimeField(5)), 0, 7)
    twice = invert(pool, pool.sub(pool.scale(2, y), rises), unknown, lambda _: None)
    assert twice is not None
    assert evaluate([x], sample) == evaluate([x], sample) != evaluate([twice], sample)
    k = pool.symbol("k", Kind.PARAM)
    cubic = pool.add((1, unknown), (1, pool.mul(pool.power(k, 2), pool.power(unknown, 3))))
    both = invert(pool, pool.sub(y, cubic), unknown, lambda _: None)
    assert both is not None and len(both.args) > 1
    with pytest.raises(Mixed):
        evaluate([both], FreeSample(Exponentials(PrimeField(1), 3, 5), 0, 1))
