"""The arithmetic of ranges and the slopes that are made with it, by hand.

`[` and `]` are written for a bound that may be met on a stretch, `(` and `)` for one that is met at
single points at most.
"""

from __future__ import annotations

from fractions import Fraction

import pytest

from bondgraph.algebra.monotone import add, direction, join, power, scale, slope_range, times
from bondgraph.ir.expr import Expr, Kind, Pool, Root
from bondgraph.ir.functions import Interval

p = Pool()
x, u = p.symbol("x", Kind.FLOW), p.symbol("u", Kind.FLOW)
y, z = p.symbol("y", Kind.SENSOR), p.symbol("z", Kind.SENSOR)
a, b = p.symbol("a", Kind.PARAM), p.symbol("b", Kind.PARAM)


def read(text: str) -> Interval:
    """`(0, inf)` as a range."""
    low, high = text[1:-1].split(",")
    return Interval(float(low), float(high), text[0] == "(", text[-1] == ")")


def shown(found: Interval) -> str:
    low, high = (bound + 0.0 for bound in found[:2])  # zeros of either sign are alike
    return f"{'[('[found.open_low]}{low:.6g}, {high:.6g}{'])'[found.open_high]}"


@pytest.mark.parametrize(
    ("left", "right", "product"),
    [
        ("[2, 3]", "[4, 5]", "[8, 15]"),
        ("(2, 3]", "[4, 5]", "(8, 15]"),
        ("[2, 3)", "[4, 5]", "[8, 15)"),
        ("[2, 3]", "(4, 5)", "(8, 15)"),
        ("[-2, 3]", "[-5, 7]", "[-15, 21]"),
        ("[-2, 3]", "(-5, 7]", "(-15, 21]"),
        ("[-3, -2)", "[4, 5]", "[-15, -8)"),
        ("[-3, -2)", "[-5, -4]", "(8, 15]"),
        ("(0, inf)", "(0, inf)", "(0, inf)"),
        ("(0, inf)", "(-inf, 0)", "(-inf, 0)"),
        ("[0, 1]", "(0, inf)", "[0, inf)"),  # zero times anything, as long as it is zero
        ("[0, 1]", "(2, 3]", "[0, 3]"),
        ("(0, 1]", "[0, 3]", "[0, 3]"),
        ("(0, 1]", "(0, 3]", "(0, 3]"),
        ("[-3, 0]", "(0, 2]", "[-6, 0]"),
        ("[-3, 0)", "(0, 2]", "[-6, 0)"),
        ("[0, 0]", "(-inf, inf)", "[0, 0]"),
        ("(-1, 1)", "[2, 2]", "(-2, 2)"),
        ("(-1, 1]", "(-1, 1]", "(-1, 1]"),  # 1 on a stretch, as 1 times 1
        ("(-inf, inf)", "(0, 1]", "(-inf, inf)"),
    ],
)
def test_products(left: str, right: str, product: str) -> None:
    assert shown(times(read(left), read(right))) == product
    assert shown(times(read(right), read(left))) == product


@pytest.mark.parametrize(
    ("base", "exponent", "expected"),
    [
        ("(2, 3]", 1, "(2, 3]"),
        ("(2, 3]", 0, "[1, 1]"),
        ("(2, 3]", 2, "(4, 9]"),
        ("[0, 3)", 2, "[0, 9)"),
        ("[-3, -2)", 2, "(4, 9]"),
        ("(-3, 0]", 2, "[0, 9)"),
        ("[-2, 3)", 3, "[-8, 27)"),
        ("(-3, 2]", 2, "(0, 9)"),  # zero and nine are passed at single points
        ("[-3, 2)", 2, "(0, 9]"),
        ("(-2, 3]", 4, "(0, 81]"),
        ("(-1, 1]", 2, "(0, 1]"),  # one is reached from one side
        ("[-1, 1)", 2, "(0, 1]"),
        ("(2, 4]", -1, "[0.25, 0.5)"),
        ("(-4, -2]", -1, "[-0.5, -0.25)"),
        ("(1, 2]", -2, "[0.25, 1)"),
        ("(-2, -1]", -3, "[-1, -0.125)"),
        ("(0, 2]", -1, "[0.5, inf)"),
        ("(0, inf)", -1, "(0, inf)"),
        ("(-inf, 0)", -1, "(-inf, 0)"),
        ("(-inf, -2)", -1, "(-0.5, 0)"),
        ("(-1, 2)", -1, "(-inf, inf)"),
        ("(-2, 2)", -2, "(0.25, inf)"),
        ("(-1e200, 1e201)", 3, "(-inf, inf)"),
        ("[1e200, 1e201]", 2, "[inf, inf]"),
    ],
)
def test_powers(base: str, exponent: int, expected: str) -> None:
    assert shown(power(read(base), exponent)) == expected


def test_sums_and_multiples() -> None:
    assert shown(add()) == "[0, 0]"
    assert shown(add(read("[1, 2]"), read("[10, 20]"), read("[100, 200]"))) == "[111, 222]"
    assert shown(add(read("(1, 2]"), read("[10, 20)"))) == "(11, 22)"
    assert shown(scale(2.0, read("[1, 3)"))) == "[2, 6)"
    assert shown(scale(-2.0, read("[1, 3)"))) == "(-6, -2]"
    assert shown(scale(0.0, read("(-inf, inf)"))) == "[0, 0]"


def test_what_is_in_one_of_several() -> None:
    assert shown(join(read("[1, 2]"), read("(0, 1)"))) == "(0, 2]"
    assert shown(join(read("(0, 3)"), read("[1, 2]"))) == "(0, 3)"
    assert shown(join(read("(0, 3)"), read("[0, 3]"), read("[1, 1]"))) == "[0, 3]"
    assert shown(join(read("(0, 3)"), read("(0, 3)"))) == "(0, 3)"


# ------------------------------------------------------------------------------ values


@pytest.mark.parametrize(
    ("law", "at", "expected"),
    [
        (p.add((-2, y), (3, p.one)), "(1, 2]", "[-1, 1)"),
        (p.mul(y, p.power(z, -1)), "(1, 2]", "(0.2, 0.5]"),
        (p.power(y, 3), "[-2, 1)", "[-8, 1)"),
        (p.fn("exp", y), "(0, 1]", "(1, 2.71828]"),
        (p.fn("exp", y), "[0, 1e4]", "[1, inf]"),
        (p.fn("sinh", y), "[-1e4, 1e4)", "[-inf, inf)"),
        (p.fn("cbrt", y), "[-8, 27)", "[-2, 3)"),
        (p.fn("tanh", y), "(-inf, 0]", "(-1, 0]"),
        # what does not grow everywhere has the values that it has anywhere
        (p.fn("sqrt", y), "[4, 9]", "(0, inf)"),
        (p.fn("sin", y), "[0, 0]", "(-1, 1)"),
        (p.fn("log", y), "[1, 1]", "(-inf, inf)"),
        (p.fn("pow", y, p.num(Fraction(3, 2))), "[0, 4]", "(0, inf)"),
        (p.fn("pow", y, p.num(Fraction(3, 2))), "[-1, 4]", "(-inf, inf)"),
        (p.choose(p.compare("<", z, p.one), y, p.num(Fraction(7))), "(1, 2]", "(1, 7]"),
        (p.fn("max", y, z), "[1, 2]", "(-inf, inf)"),
    ],
)
def test_the_values_of_what_multiplies_the_variable(law: Expr, at: str, expected: str) -> None:
    """They are the slope of its product with the variable; z is from 4 to 5."""
    given = {y: read(at), z: read("[4, 5]")}
    found = slope_range(p, p.mul(x, law), x, lambda _: None, given=given)
    assert found is not None and shown(found) == expected


@pytest.mark.parametrize(
    ("value", "exact", "expected"),
    [
        (None, False, "(-inf, inf)"),
        (None, True, "(-inf, inf)"),
        (2.5, False, "(0, inf)"),
        (-2.5, False, "(-inf, 0)"),
        (0.0, False, "[0, 0]"),
        (2.5, True, "[2.5, 2.5]"),
        (0.0, True, "[0, 0]"),
    ],
)
def test_a_parameter_keeps_its_sign_or_has_its_value(
    value: float | None, exact: bool, expected: str
) -> None:
    found = slope_range(p, p.mul(a, x), x, lambda symbol: value, exact)
    assert found is not None and shown(found) == expected
    unknown = slope_range(p, p.mul(y, x), x, lambda symbol: value, exact)  # no parameter
    assert unknown is not None and shown(unknown) == "(-inf, inf)"


@pytest.mark.parametrize(
    ("first", "second", "expected"),
    [(3.0, 1.0, 1), (1.0, 3.0, -1), (2.0, 2.0, None), (3.0, -1.0, 1), (-3.0, 1.0, -1)],
)
def test_where_signs_do_not_decide_the_nominal_values_do(
    first: float, second: float, expected: int | None
) -> None:
    law = p.sub(p.mul(a, x), p.mul(b, x))
    assert direction(p, law, x, lambda n: first if n is a else second) == expected
    assert direction(p, law, x, lambda n: first if n is a else None) is None


# ------------------------------------------------------------------------------ slopes


def less(left: Expr, right: Expr, yes: Expr, no: Expr) -> Expr:
    return p.choose(p.compare("<", left, right), yes, no)


TWICE, FIVE = p.scale(2, x), p.scale(5, x)
ON = p.symbol("on", Kind.MODE)

p.tables["map"] = tuple(
    tuple(Fraction(v) for v in row) for row in ((0, 0, 2), (0, 0, 20), (1, 1, 23))
)  # z = x + 10 y + x y
p.tables["map'"] = p.tables["map"]
p.tables["curve'"] = tuple((Fraction(v), Fraction(w)) for v, w in ((0, 0), (2, 1), (8, 2)))


@pytest.mark.parametrize(
    ("law", "expected"),
    [
        (y, "[0, 0]"),
        (p.add((3, x), (-2, y), (-1, p.power(x, 2))), "[-1, 1]"),
        (p.power(x, 3), "[3, 12]"),
        (p.power(x, -2), "[-2, -0.25]"),
        (p.mul(p.power(x, 2), p.power(z, 3)), "[128, 500]"),  # 2 x z^3
        (p.mul(x, p.fn("exp", x)), "(2.71828, inf)"),  # exp(x) and x times what is positive
        (p.fn("max", x, TWICE), "[1, 2]"),
        (p.fn("min", x, y), "[0, 1]"),
        (p.fn("abs", p.sub(x, p.one)), "[1, 1]"),  # at 0 and beyond it
        (p.fn("abs", p.sub(x, p.num(Fraction(3, 2)))), "[-1, 1]"),
        (p.fn("abs", p.neg(x)), "[-1, 1]"),
        (p.fn("pow", x, p.num(Fraction(7, 5))), "(0, inf)"),
        (p.fn("pow", x, p.num(Fraction(-7, 5))), "(-inf, 0)"),
        (p.fn("pow", x, a), None),
        (p.fn("pow", p.sub(x, p.num(Fraction(3, 2))), p.num(Fraction(7, 5))), None),
        (p.fn("sin", p.scale(3, x)), "(-3, 3)"),
        (p.power(p.sub(x, p.num(Fraction(3, 2))), -1), None),  # a pole between 1 and 2
        (p.mul(x, p.power(y, -1)), "(-inf, inf)"),  # the pole is not one of x
        (less(y, p.zero, TWICE, FIVE), "[2, 5]"),
        (less(y, p.zero, TWICE, y), "[0, 2]"),
        (p.choose(ON, TWICE, FIVE), "[2, 5]"),
        # where the comparison holds the variable, both must be the same at its edge
        (less(TWICE, a, TWICE, a), "[0, 2]"),
        (less(TWICE, a, a, FIVE), None),
        (p.choose(p.compare("<=", x, p.zero), TWICE, FIVE), "[2, 5]"),
        (p.choose(p.compare("==", x, p.zero), TWICE, FIVE), None),
        (p.choose(p.logic("not", p.compare("<", x, p.zero)), TWICE, FIVE), None),
        (less(p.power(x, 2), p.one, TWICE, FIVE), None),
        (less(x, p.zero, p.power(x, -1), FIVE), None),
        (p.fn("table:map", x, y), "[0, 3]"),  # 1 and 3, and none beyond the ends
        (p.fn("table:map", y, x), "[0, 11]"),
        (p.fn("table:map", x, TWICE), "[0, 25]"),
        (p.fn("table:map'", x, y), "[0.333333, 1]"),  # what undoes it has no value there
        (p.fn("table:map'", y, x), "[-11, 0]"),
        (p.fn("table:curve'", x), "[0.166667, 0.5]"),
    ],
)
def test_slopes(law: Expr, expected: str | None) -> None:
    """x is from 1 to 2, z from 4 to 5, and y anything."""
    given = {x: read("[1, 2]"), z: read("[4, 5]")}
    found = slope_range(p, law, x, lambda _: None, given=given)
    assert (None if found is None else shown(found)) == expected


def test_what_is_zero_all_along_a_piece_leaves_nothing_to_grow() -> None:
    """The square of a dead zone, or of what is cut off: there x times it is 0 for every x."""
    above, below = p.sub(y, p.one), p.add((1, y), (1, p.one))
    zone = p.add((1, p.fn("max", above, p.zero)), (1, p.fn("min", below, p.zero)))
    cut = less(y, p.zero, p.fn("sin", y), p.zero)
    for factor in (zone, cut):
        assert direction(p, p.mul(x, p.power(factor, 2)), x, lambda _: None) is None
    # at single points of y it may be zero
    assert direction(p, p.mul(x, p.power(y, 2)), x, lambda _: None) == 1
    assert direction(p, p.mul(x, p.power(p.fn("sin", y), 2)), x, lambda _: None) == 1
    # and a root that is one from zero on leaves none of x*(1 - v^2) there
    v = less(y, p.zero, p.fn("sin", y), p.one)
    law = p.mul(x, p.sub(p.one, p.power(v, 2)))
    assert direction(p, law, x, lambda _: None) is None


def test_a_function_of_positive_numbers_limits_the_variable_everywhere() -> None:
    """But for one that only one side of a choice needs."""
    assert direction(p, p.power(x, 2), x, lambda _: None) is None
    square = p.add((1, p.power(x, 2)), (1, p.fn("log", x)))
    assert direction(p, square, x, lambda _: None) == 1
    other = p.add((1, p.power(x, 2)), (1, p.fn("pow", x, p.num(Fraction(3, 2)))))
    assert direction(p, other, x, lambda _: None) == 1
    inside = p.add((1, p.power(x, 2)), (1, p.fn("log", p.sub(x, p.one))))
    assert direction(p, inside, x, lambda _: None) is None  # of x - 1, which is followed no further
    chosen = p.add((1, p.power(x, 2)), (1, less(y, p.zero, x, p.fn("log", x))))
    assert direction(p, chosen, x, lambda _: None) is None


@pytest.mark.parametrize(
    ("name", "expected"), [("sinh", 1), ("ssq", 1), ("tanh", 1), ("sign", None), ("sin", None)]
)
def test_a_slope_of_zero_at_single_points_is_enough_to_grow(
    name: str, expected: int | None
) -> None:
    for factor in (1, -1):
        told = None if expected is None else factor * expected
        assert direction(p, p.scale(factor, p.fn(name, x)), x, lambda _: None) == told


def test_a_root_moves_against_what_its_equation_says() -> None:
    """2 u = 3 c: u goes by 3/2, of x^2 from 1 to 2 by 3 to 6; no pole is followed."""
    c = p.symbol("c", Kind.UNKNOWN)
    given = {x: read("[1, 2]")}

    def slope(zero: Expr, rising: bool) -> str | None:
        root = Root(f"R{zero.id}", zero, u, (c,), u, rising, Fraction(0))
        law = p.root(root, p.power(x, 2))
        found = slope_range(p, law, x, lambda _: None, given=given)
        return None if found is None else shown(found)

    assert slope(p.sub(p.scale(2, u), p.scale(3, c)), True) == "[3, 6]"
    assert slope(p.sub(p.scale(3, c), p.scale(2, u)), False) == "[3, 6]"
    # cosh(u) has any slope: all that is known is that the root was found to rise
    assert slope(p.sub(p.fn("cosh", u), p.scale(3, c)), True) == "(0, inf)"
    assert slope(p.sub(p.fn("cosh", u), p.scale(3, c)), False) == "(-inf, 0)"
    assert slope(p.sub(u, p.power(c, -1)), True) is None
