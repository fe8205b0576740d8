"""Adjoints against partial derivatives taken by hand, at a point of whole numbers."""

from __future__ import annotations

from fractions import Fraction

import pytest

from bondgraph.algebra.implicit import invert
from bondgraph.exact.adjoints import pull, static_adjoints
from bondgraph.exact.evaluate import Powers, values_of
from bondgraph.exact.outline import plan
from bondgraph.exact.signal_algebra import Exponentials, Taylor
from bondgraph.field.balls import Reals
from bondgraph.field.numbers import DividedByZero, Number
from bondgraph.field.prime import PrimeField
from bondgraph.field.series import Series
from bondgraph.ir.expr import Expr, Kind, Pool, Symbol

p = Pool()
x, y, z = (p.symbol(n, Kind.SENSOR) for n in "xyz")
on = p.symbol("on", Kind.MODE)
start = p.symbol("x0", Kind.INITIAL)
_REALS = Reals({})


class At:
    """A point at which x = 4 + t, y = 3 - 2 t + t^2 and z = 0."""

    def __init__(self) -> None:
        self.algebra = Taylor(_REALS)
        self.told: dict[Expr, list[int]] = {x: [4, 1], y: [3, -2, 1], z: [0], on: [1]}

    def value(self, symbol: Expr) -> Series:
        return [self.algebra.numbers.number(c) for c in self.told[symbol]]

    def start(self, initial: Symbol) -> Number:
        return 5


def _adjoints(
    root: Expr, seed: list[int] | None = None, jumps: bool = False
) -> dict[Expr, list[float]]:
    """The adjoints of the symbols, as far as there are any, of a coefficient of the root."""
    told = At()
    adjoints: dict[Expr, Series] = {root: seed or [1]}
    nodes, need = plan(root, len(adjoints[root]))
    values, failures = values_of(nodes, need, told)
    assert root not in failures
    pull(nodes, need, values, told.algebra, adjoints, jumps)
    return {v: [float(c) for c in own] for v, own in adjoints.items() if v in (x, y, z, on)}


def _plus(*terms: Expr) -> Expr:
    return p.add(*[(1, term) for term in terms])


_R = p.symbol("r", Kind.TEAR)
_RISES = _plus(_R, p.mul(p.power(x, 2), p.power(_R, 3)))
_CUBIC = invert(p, p.sub(y, _RISES), _R, lambda _: None)


@pytest.mark.parametrize(
    ("law", "by_x", "by_y"),
    [
        (p.add((3, x), (Fraction(-1, 2), y)), 3, Fraction(-1, 2)),
        (p.mul(x, y), 3, 4),
        (p.mul(p.power(x, 2), y), 24, 16),
        (p.mul(p.power(x, 3), p.power(y, -1)), 16, Fraction(-64, 9)),
        (p.power(y, -2), None, Fraction(-2, 27)),
        (p.mul(x, p.power(x, -3), p.power(y, 2)), Fraction(-9, 32), Fraction(3, 8)),
        (p.fn("pow", x, p.num(Fraction(5, 2))), 20, None),
        (p.fn("sqrt", p.mul(x, p.power(y, 2))), Fraction(3, 4), 2),
        (p.fn("min", x, p.mul(y, y)), 1, None),
        (p.fn("max", x, p.mul(y, y)), None, 6),
        (p.choose(p.compare("<", x, y), p.mul(x, y), p.power(y, 2)), None, 6),
        (p.choose(p.compare("<", y, x), p.mul(x, y), p.power(y, 2)), 3, 4),
        (p.fn("sign", x), None, None),
        # of two places that a symbol has both count: (x - y)^2 x is x^3 - 2 x^2 y + x y^2
        (p.mul(p.power(p.sub(x, y), 2), x), 9, -8),
        (p.mul(z, z, x), None, None),  # a slope of zero is none at all
    ],
)
def test_partial_derivatives(
    law: Expr, by_x: Fraction | int | None, by_y: Fraction | int | None
) -> None:
    found = _adjoints(law)
    for symbol, expected in ((x, by_x), (y, by_y)):
        if expected is None:
            assert symbol not in found
        else:
            assert found[symbol] == [pytest.approx(float(expected), rel=1e-14)]
    assert z not in found


def test_a_root_moves_as_its_equation_says() -> None:
    """r + x^2 r^3 = y: dr/dy (1 + 3 x^2 r^2) = 1, and dr/dx = -2 x r^3 dr/dy."""
    assert _CUBIC is not None
    nodes, need = plan(_CUBIC, 1)
    value = float(values_of(nodes, need, At())[0][_CUBIC][0])
    assert value + 16 * value**3 == pytest.approx(3)
    found = _adjoints(_CUBIC)
    steep = 1 + 48 * value**2
    assert found[y] == [pytest.approx(1 / steep)]
    assert found[x] == [pytest.approx(-8 * value**3 / steep)]


def test_the_adjoint_of_a_coefficient_is_that_of_the_convolution() -> None:
    """The second coefficient of x y^2 moves by (y^2)_(2 - j) for that of x with number j:
    y^2 = 9 - 12 t + 10 t^2; and of y by (2 x y)_(2 - j): 24 - 10 t + 4 t^2."""
    found = _adjoints(p.mul(x, p.power(y, 2)), [0, 0, 1])
    assert found[x] == [10, -12, 9]
    assert found[y] == [4, -10, 24]


def test_a_derivative_shifts_and_an_integral_shifts_back() -> None:
    """Coefficient 1 of D(x y) is twice coefficient 2 of x y; that of the integral is x y itself."""
    found = _adjoints(p.der(p.mul(x, y)), [0, 1])
    assert found[x] == [2, -4, 6] and found[y] == [0, 2, 8]
    found = _adjoints(p.integral(p.mul(x, y), start), [0, 0, 1])
    assert found[x] == [-1, 1.5] and found[y] == [0.5, 2]
    assert x not in _adjoints(p.integral(x, start), [1])  # the past alone


def test_what_a_decision_rests_on_counts_only_where_jumps_do() -> None:
    """Of if(x < z, x, y) the condition changes y - x; equal branches leave nothing to change."""
    for law, seen, jump in (
        (p.choose(p.compare("<", x, z), x, y), {y}, {x, y, z}),
        (p.choose(on, p.mul(x, x), y), {x}, {x, on}),
        (p.choose(on, p.mul(x, p.num(3)), p.mul(y, x)), {x}, {x}),  # 12 both ways
        (p.mul(y, p.fn("sign", x)), {y}, {x, y}),
        (p.choose(p.logic("and", on, p.compare("<", y, x)), x, p.zero), {x}, {x, y, on}),
        (p.choose(p.logic("not", on), p.power(z, -1), x), {x}, {x, on}),  # 1/0 is no value
    ):
        assert set(_adjoints(law)) == seen
        assert set(_adjoints(law, jumps=True)) == jump
    compared = p.choose(p.compare("<", y, x), p.num(7), p.zero)
    found = _adjoints(compared, jumps=True)
    assert found[x] == [-found[y][0]] and found[x] != [0]


def test_sums_and_products_have_the_same_adjoints_at_once() -> None:
    """Of 2/3 x^2 / y + 5 x z - y, where z is zero: by x 16/9, by y -59/27, by z 20."""
    law = p.add((Fraction(2, 3), p.mul(p.power(x, 2), p.power(y, -1))), (5, p.mul(x, z)), (-1, y))
    f = PrimeField(1)
    values: dict[Expr, Number] = {x: f.number(4), y: f.number(3), z: f.number(0)}
    for node in plan(law, 1)[0]:
        if node.args and node is not law:
            values[node] = f.number(0) if z in node.args else f.fraction(Fraction(16, 3))
    found = static_adjoints(law, values, f)
    assert found[x] == f.fraction(Fraction(16, 9))
    assert found[y] == f.fraction(Fraction(-59, 27))
    assert found[z] == 20 and found[law] == 1
    squares = p.add((1, p.power(z, 2)), (1, x))
    assert set(static_adjoints(squares, {**values, p.power(z, 2): 0}, f)) == {
        squares, x, p.power(z, 2),
    }  # fmt: skip


def test_powers_of_a_value_are_those_of_its_inverse_for_negative_exponents() -> None:
    f = PrimeField(1)
    powers = Powers(f, {x: f.number(4), z: f.number(0)})
    assert [powers.of(x, e) for e in (1, 3)] == [4, 64]
    assert [powers.of(x, e) * 64 for e in (-1, -3, -2)] == [16, 1, 4]
    assert powers.of(z, 2) == 0
    with pytest.raises(DividedByZero):
        powers.of(z, -2)


def test_of_exponentials_a_condition_counts_where_the_branches_differ() -> None:
    f = PrimeField(1)
    algebra = Exponentials(f, f.number(3), f.number(5))

    class Grows(At):
        def __init__(self) -> None:
            super().__init__()
            self.algebra = algebra  # type: ignore[assignment]

        def value(self, symbol: Expr) -> Series:
            told = {x: (4, 1), y: (4, 1), z: (4, 0), on: (1, 0)}
            return (f.number(told[symbol][0]), told[symbol][1])  # type: ignore[return-value]

    for law, expected in (
        (p.choose(on, x, y), {x}),
        (p.choose(on, p.scale(2, x), y), {x, on}),
        (p.choose(on, x, z), {x, on}),  # of a signal and a constant
    ):
        nodes, need = plan(law, 1)
        values, _ = values_of(nodes, need, Grows())
        adjoints = {law: algebra.seed(1)}
        pull(nodes, need, values, algebra, adjoints, jumps=True)
        assert {v for v in adjoints if v in (x, y, on)} == expected
