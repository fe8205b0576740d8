"""Derivatives of any order, against difference quotients of the functions of time themselves.

x and y run as known polynomials; what is derived of an expression is evaluated with the values and
derivatives of these, and compared with what mpmath finds by differences of the whole, with 60
digits. No rule of differentiation is used on that side.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath as mp
import pytest
from scipy.optimize import brentq

from bondgraph.algebra.derivative import Jets, TooManyOperations, differentiate, operations, partial
from bondgraph.algebra.implicit import invert
from bondgraph.algebra.interpolation import interpolation
from bondgraph.algebra.numeric import EXACT, evaluate
from bondgraph.field.evaluation import Evaluated
from bondgraph.ir.expr import Expr, Kind, Op, Pool, Root, topological
from bondgraph.ir.tables import turned

p = Pool()
x, y = (p.symbol(n, Kind.SENSOR) for n in "xy")
a = p.symbol("a", Kind.PARAM)
on = p.symbol("on", Kind.MODE)
p.tables["bent.csv"] = tuple((Fraction(u), Fraction(v)) for u, v in ((0, 0), (1, 2), (3, 3)))

_X = [Fraction(6, 5), Fraction(-1, 2), Fraction(3, 4), Fraction(1, 3), Fraction(-2, 5)]
_Y = [Fraction(1, 2), Fraction(1, 3), Fraction(-2, 3), Fraction(1, 4), Fraction(1, 7)]
_A = Fraction(7, 4)


def _course(coefficients: list[Fraction]) -> Callable[[Any], Any]:
    """A polynomial of time."""
    numbers = [mp.mpf(c.numerator) / c.denominator for c in coefficients]
    return lambda t: mp.polyval(numbers[::-1], t)


def _at_zero(coefficients: list[Fraction], order: int) -> Fraction:
    """Its derivative at the time zero."""
    found = coefficients[order] if order < len(coefficients) else Fraction(0)
    for k in range(2, order + 1):
        found *= k
    return found


def plus(*terms: Expr) -> Expr:
    return p.add(*[(1, term) for term in terms])


both = p.mul(x, y)
#: an expression, and what it is of the numbers x and y
LAWS: dict[str, tuple[Expr, Callable[[Any, Any, Any], Any]]] = {
    "sum": (p.add((3, x), (-2, y), (1, a)), lambda x, y, a: 3 * x - 2 * y + a),
    "product": (p.mul(a, x, p.power(y, 2)), lambda x, y, a: a * x * y**2),
    "powers": (p.mul(p.power(x, 5), p.power(y, -3)), lambda x, y, a: x**5 / y**3),
    "reciprocal": (p.power(plus(x, y), -1), lambda x, y, a: 1 / (x + y)),
    "quotient": (p.div(plus(x, p.one), plus(y, a)), lambda x, y, a: (x + 1) / (y + a)),
    "square root": (p.fn("sqrt", x), lambda x, y, a: mp.sqrt(x)),
    "cube root": (p.fn("cbrt", x), lambda x, y, a: mp.cbrt(x)),
    "signed root": (p.fn("ssqrt", p.neg(x)), lambda x, y, a: -mp.sqrt(x)),
    "signed square": (p.fn("ssq", p.neg(x)), lambda x, y, a: -(x**2)),
    "absolute": (p.fn("abs", p.sub(y, x)), lambda x, y, a: x - y),
    "sign": (p.mul(x, p.fn("sign", p.sub(y, x))), lambda x, y, a: -x),
    "exp": (p.fn("exp", both), lambda x, y, a: mp.exp(x * y)),
    "log": (p.fn("log", both), lambda x, y, a: mp.log(x * y)),
    "sin": (p.fn("sin", both), lambda x, y, a: mp.sin(x * y)),
    "cos": (p.fn("cos", both), lambda x, y, a: mp.cos(x * y)),
    "tan": (p.fn("tan", both), lambda x, y, a: mp.tan(x * y)),
    "asin": (p.fn("asin", y), lambda x, y, a: mp.asin(y)),
    "acos": (p.fn("acos", y), lambda x, y, a: mp.acos(y)),
    "atan": (p.fn("atan", x), lambda x, y, a: mp.atan(x)),
    "sinh": (p.fn("sinh", x), lambda x, y, a: mp.sinh(x)),
    "cosh": (p.fn("cosh", x), lambda x, y, a: mp.cosh(x)),
    "tanh": (p.fn("tanh", x), lambda x, y, a: mp.tanh(x)),
    "asinh": (p.fn("asinh", x), lambda x, y, a: mp.asinh(x)),
    "acosh": (p.fn("acosh", x), lambda x, y, a: mp.acosh(x)),
    "atanh": (p.fn("atanh", y), lambda x, y, a: mp.atanh(y)),
    "angle": (p.fn("atan2", y, x), lambda x, y, a: mp.atan2(y, x)),
    "power": (p.fn("pow", x, y), lambda x, y, a: x**y),
    "fixed power": (p.fn("pow", x, p.num(Fraction(5, 2))), lambda x, y, a: x ** mp.mpf("2.5")),
    "fall": (p.fn("pow", x, p.num(Fraction(-3, 2))), lambda x, y, a: x ** mp.mpf("-1.5")),
    "named power": (p.fn("pow", x, a), lambda x, y, a: x**a),
    "smaller": (p.fn("min", p.power(x, 2), y), lambda x, y, a: y),
    "larger": (p.fn("max", p.power(x, 2), y), lambda x, y, a: x**2),
    "choice": (p.choose(p.compare("<", x, y), x, both), lambda x, y, a: x * y),
    "mode": (p.choose(on, both, x), lambda x, y, a: x * y),
    "table": (p.fn("table:bent.csv", p.mul(x, x)), lambda x, y, a: 2 + (x * x - 1) / 2),
}


@pytest.mark.parametrize("order", [1, 2, 3, 4])
@pytest.mark.parametrize("name", LAWS)
def test_a_derivative_is_that_of_the_course(name: str, order: int) -> None:
    expr, law = LAWS[name]
    found = differentiate(p, expr, order)
    rates = {
        p.der(s, k): p.num(_at_zero(course, k))
        for s, course in ((x, _X), (y, _Y))
        for k in range(1, order + 1)
    }
    (numbers,) = p.substitute([found], rates)
    value = evaluate(numbers, {"x": float(_X[0]), "y": float(_Y[0]), "a": float(_A), "on": 1.0})
    with mp.workdps(60):
        one, other, fixed = _course(_X), _course(_Y), mp.mpf(_A.numerator) / _A.denominator
        expected = float(mp.diff(lambda t: law(one(t), other(t), fixed), 0, order))
    assert value == pytest.approx(expected, rel=1e-9, abs=1e-12)


def test_the_first_derivative_of_a_power_is_written_as_it_is_taught() -> None:
    """(x^-3/2)' = -3/2 x^-5/2 x', without a division by x."""
    falling, e = p.fn("pow", x, p.num(Fraction(-3, 2))), Fraction(-3, 2)
    taught = p.mul(p.num(e), p.fn("pow", x, p.num(e - 1)), p.der(x))
    assert differentiate(p, falling) is taught


def test_what_does_not_move_has_no_derivative() -> None:
    fixed = p.mul(p.fn("sin", a), p.power(a, -2), p.choose(on, a, p.one))
    assert differentiate(p, fixed) is p.zero
    assert differentiate(p, p.compare("<", x, y)) is p.zero
    assert differentiate(p, plus(x, fixed), 2) is p.der(x, 2)


def test_an_integral_and_a_derivative_undo_each_other() -> None:
    start = p.symbol("s.q0", Kind.CONST)
    whole = p.integral(both, start)
    assert differentiate(p, whole) is both
    assert differentiate(p, whole, 2) is differentiate(p, both)
    assert differentiate(p, p.der(both), 0) is differentiate(p, both)


def test_too_large_a_derivative_is_given_up() -> None:
    """That of the sixth order makes more nodes than ten, that of a sum does not."""
    fresh = Pool()
    u, v = (fresh.symbol(n, Kind.SENSOR) for n in "uv")
    with pytest.raises(TooManyOperations):
        Jets(fresh).of(fresh.fn("tanh", fresh.mul(u, v)), 6, limit=10)
    assert Jets(fresh).of(fresh.add((1, u), (1, v)), 1, limit=10) is fresh.add(
        (1, fresh.der(u)), (1, fresh.der(v))
    )


def test_partial_derivatives_hold_the_rest_still() -> None:
    """d/dx of x^2 y + sin(x) if x < y else 3 x, on either side."""
    law = p.choose(
        p.compare("<", x, y), plus(p.mul(p.power(x, 2), y), p.fn("sin", x)), p.scale(3, x)
    )
    slope = partial(p, law, x)
    below = evaluate(slope, {"x": 0.5, "y": 2.0})
    assert below == pytest.approx(2 * 0.5 * 2.0 + float(mp.cos(0.5)))
    assert evaluate(slope, {"x": 2.5, "y": 2.0}) == 3.0
    assert partial(p, law, a) is p.zero


def test_operations_are_counted_once_where_they_are_shared() -> None:
    """x y is a product of two, its sine one more; two sums of two of them share both."""
    sine = p.fn("sin", both)
    assert operations([both]) == 2
    assert operations([sine]) == 3
    assert operations([plus(sine, x), plus(sine, y)]) == 7


def test_a_root_counts_as_ten_evaluations_of_its_equation() -> None:
    """Those are about the steps that Newton's method takes."""
    u, c = p.symbol("u", Kind.UNKNOWN), p.symbol("c", Kind.UNKNOWN)
    zero = p.sub(p.add((1, u), (1, p.power(u, 3))), c)
    node = p.root(Root("i", zero, u, (c,), u, True, Fraction(0)), x)
    assert operations([node]) == 10 * operations([zero]) > 0
    assert operations([plus(node, y)]) == 10 * operations([zero]) + 2
    assert operations([p.der(both)]) == 0


# ------------------------------------------------- maps and roots, whose slopes hold themselves


#: z = x + 10 y + x y, and 50 (x - 1) more from x = 1 on; measured to x = 3 and from y = -1/2 to 2.
_MAP = tuple(
    tuple(Fraction(v) for v in row)
    for row in ((0, -0.5, 0, 2), (0, -5, 0, 20), (1, -4.5, 1, 23), (3, 96.5, 103, 129))
)
p.tables["map.csv"] = p.tables["map.csv'"] = _MAP
p.tables["map.csv''"] = turned(_MAP)
p.tables["fall.csv"] = p.tables["fall.csv'"] = (
    _MAP[0], *[(row[0], *[-v for v in row[1:]]) for row in _MAP[1:]]
)  # fmt: skip
p.tables["curve.csv'"] = tuple((Fraction(v), Fraction(u)) for u, v in ((0, 0), (1, 2), (3, 3)))


def _value(expr: Expr, symbols: dict[Expr, float]) -> float | None:
    """A number, tables and roots looked up; NaN is none."""

    def function(node: Expr, args: list[Any]) -> Any:
        if node.name.startswith("table:"):
            name = node.name.removeprefix("table:")
            return interpolation(p.rows(name), name.endswith("'"))(*args)
        return EXACT[Op.FN](node, args)

    def root(node: Expr, args: list[Any]) -> float:
        inside = dict(zip(node.root.places, args, strict=True))
        zero = node.root.zero
        return float(
            brentq(lambda u: _value(zero, {**inside, node.root.unknown: u}), -99, 99, xtol=1e-15)
        )

    point: Evaluated[Any] = Evaluated({**EXACT, Op.FN: function, Op.ROOT: root}, symbols.get)
    found = point.value(expr)
    return None if found is None or found != found else float(found)


_ROOT = invert(p, p.sub(x, p.add((1, y), (1, p.power(y, 3)))), y, lambda _: None)
_TWO = invert(p, plus(p.mul(a, x), p.fn("exp", y), p.power(y, 3)), y, lambda _: 1.0)
assert _ROOT is not None and _TWO is not None

ABOUT: dict[str, tuple[Expr, Callable[[Any, Any], Any]]] = {
    "map": (p.fn("table:map.csv", x, y), lambda x, y: x + 10 * y + x * y + 50 * (x - 1)),
    "map in its first cell": (
        p.fn("table:map.csv", p.mul(x, y), y), lambda x, y: x * y + 10 * y + x * y**2
    ),
    "map that falls": (
        p.fn("table:fall.csv", x, y), lambda x, y: -(x + 10 * y + x * y + 50 * (x - 1))
    ),
    "map of one that moves": (
        p.fn("table:map.csv", p.num(2), y), lambda x, y: 52 + 12 * y
    ),
    "beyond its first input": (p.fn("table:map.csv", p.scale(9, x), y),
                               lambda x, y: 103 + 13 * y),
    "first input of a map": (
        p.fn("table:map.csv'", p.add((10, x), (1, y)), y),
        lambda x, y: (10 * x - 9 * y + 50) / (51 + y),
    ),
    "first input of one that falls": (
        p.fn("table:fall.csv'", p.add((-10, x), (-1, y)), y),
        lambda x, y: (10 * x - 9 * y + 50) / (51 + y),
    ),
    "second input of a map": (
        p.fn("table:map.csv''", p.scale(15, x), x), lambda x, y: (14 * x - 50 * (x - 1)) / (10 + x)
    ),
    "curve backwards": (p.fn("table:curve.csv'", p.scale(2, x)), lambda x, y: 1 + 2 * (2 * x - 2)),
    "root": (_ROOT, lambda x, y: mp.findroot(lambda u: u + u**3 - x, mp.mpf("0.7"))),
    "root of two": (
        _TWO, lambda x, y: mp.findroot(lambda u: mp.mpf("1.75") * x + mp.exp(u) + u**3, mp.mpf(-1))
    ),
}  # fmt: skip


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("name", ABOUT)
def test_a_derivative_of_a_map_or_a_root_is_that_of_the_course(name: str, order: int) -> None:
    expr, law = ABOUT[name]
    numbers = {x: float(_X[0]), y: float(_Y[0]), a: float(_A)}
    with mp.workdps(60):
        one, other = _course(_X), _course(_Y)
        own = float(law(one(0), other(0)))
        expected = float(mp.diff(lambda t: law(one(t), other(t)), 0, order))
    assert _value(expr, numbers) == pytest.approx(own, rel=1e-9)
    rates = {
        p.der(s, k): p.num(_at_zero(course, k))
        for s, course in ((x, _X), (y, _Y))
        for k in range(1, order + 1)
    }
    (found,) = p.substitute([differentiate(p, expr, order)], rates)
    assert _value(found, numbers) == pytest.approx(expected, rel=1e-8, abs=1e-10)


@pytest.mark.parametrize("at", [-0.5, 3.5])
def test_beyond_its_ends_a_table_stands_still_and_backwards_it_has_no_slope(at: float) -> None:
    for name, slope in (("bent.csv", 0.0), ("curve.csv'", None)):
        (found,) = p.substitute([differentiate(p, p.fn(f"table:{name}", x))], {p.der(x): p.one})
        assert _value(found, {x: at}) == slope


def test_a_slope_of_a_map_at_numbers_holds_no_map() -> None:
    """Where both are knots the value is a number; where one moves it is looked up."""
    slope = partial(p, p.fn("table:map.csv", x, p.num(0)), x)
    assert [_value(slope, {x: at}) for at in (-1, 0.5, 2, 4)] == [0, 1, 51, 0]
    assert not any(n.op is Op.FN for n in topological([slope]))
