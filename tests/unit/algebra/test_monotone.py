"""Laws that grow, fall or do neither, against slopes sampled with numbers."""

from __future__ import annotations

import math
import random
from fractions import Fraction
from itertools import pairwise

import pytest

from bondgraph.algebra.derivative import partial
from bondgraph.algebra.implicit import invert
from bondgraph.algebra.interpreter import newton
from bondgraph.algebra.monotone import direction, slope_range
from bondgraph.algebra.numeric import evaluate
from bondgraph.ir.expr import Expr, Kind, Pool, Root

p = Pool()
x = p.symbol("x", Kind.FLOW)
a = p.symbol("a", Kind.PARAM)
y = p.symbol("y", Kind.SENSOR)


def times(*factors: Expr) -> Expr:
    return p.mul(*factors)


def plus(*terms: Expr) -> Expr:
    return p.add(*[(1, term) for term in terms])


def shifted(by: int) -> Expr:
    return p.add((1, x), (by, p.one))


one_sided = p.choose(p.compare("<", x, p.zero), x, times(a, x))
dead_zone = plus(p.fn("max", shifted(-1), p.zero), p.fn("min", shifted(1), p.zero))
jump = p.choose(p.compare("<", x, p.zero), x, shifted(-1))

#: law, what it does for a > 0, what it does for a < 0
LAWS = {
    "friction": (plus(p.fn("tanh", times(a, x)), x), 1, 0),
    "cubic": (plus(times(a, x), p.power(x, 3)), 1, None),
    "wave": (plus(times(a, x), p.fn("sin", x)), None, -1),
    "two": (p.add((2, x), (1, p.fn("sin", x))), 1, 1),
    "coulomb": (plus(times(a, p.fn("sign", x)), x), 1, None),
    "diode": (p.fn("exp", times(a, x)), 1, -1),
    "falling": (p.add((-1, p.fn("sinh", x)), (-3, times(a, x))), -1, None),
    "saturated": (p.fn("min", p.fn("max", x, p.neg(p.one)), p.one), None, None),
    "beyond": (plus(p.fn("min", p.fn("max", x, p.neg(p.one)), p.one), times(a, x)), 1, -1),
    "dead zone": (dead_zone, None, None),
    "one-sided": (one_sided, 1, None),
    "jump": (jump, None, None),
    "quadratic": (plus(p.power(x, 2), times(a, x)), None, None),
    "drag": (plus(times(a, p.fn("ssq", x)), x), 1, None),
    "orifice": (plus(p.fn("ssqrt", x), times(p.power(a, 2), x)), 1, 1),
    # power y^2 shared by effort x and flow y^2/x: x - a y^2/x = u has a root on each side of zero
    "pole": (p.sub(x, times(a, p.power(y, 2), p.power(x, -1))), None, None),
    "periods": (plus(p.fn("tan", x), times(a, x)), None, None),
}


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("value", [0.5, -3.0])
def test_a_direction_is_that_of_sampled_numbers(name: str, value: float) -> None:
    law, up, down = LAWS[name]
    found = direction(p, law, x, lambda s: value if s is a else None)
    expected = up if value > 0 else down
    if expected != 0:  # 0: true, but not known without bounds that interval arithmetic lacks
        assert found == expected
    if found is None:
        return
    draw = random.Random(name)
    points = sorted(draw.uniform(-4, 4) for _ in range(60))
    values = [evaluate(law, {"x": z, "a": value}) for z in points]
    numbers = [float(v) for v in values if v is not None]
    steps = [found * (after - before) for before, after in pairwise(numbers)]
    assert len(numbers) == 60 and min(steps) > 0


@pytest.mark.parametrize("name", [n for n, (_, up, _) in LAWS.items() if up])
def test_a_root_solves_its_equation(name: str) -> None:
    law = LAWS[name][0]
    node = invert(p, p.sub(y, law), x, lambda s: 0.5 if s is a else None)
    assert node is not None
    root = node.root
    places = {
        place.symbol.name: {y: 0.7, a: 0.5}[arg]
        for place, arg in zip(root.places, node.args, strict=True)
    }

    def look(z: float) -> tuple[float, float]:
        at = {"?x": z, **places}
        value = evaluate(root.zero, at)
        slope = evaluate(partial(p, root.zero, root.unknown), at)
        assert value is not None
        return float(value), math.inf if slope is None else float(slope)  # a root's, at zero

    if name == "diode":  # y > 0 has a solution; y - exp(a x) falls
        assert not root.rising
    found = newton(look, root.rising, float(root.guess), 200)
    if name == "coulomb":  # between -a and a nothing but standstill fits
        assert found == pytest.approx(0.2)
    forwards = evaluate(law, {"x": found, "a": 0.5})
    assert forwards == pytest.approx(0.7, rel=1e-12)


def test_the_slope_of_a_choice_of_mode_is_not_decided() -> None:
    """A law that a switch changes has no root of its own."""
    on = p.symbol("on", Kind.MODE)
    law = p.choose(on, plus(x, p.power(x, 3)), p.fn("sinh", x))
    assert invert(p, p.sub(y, law), x, lambda _: None) is None


@pytest.mark.parametrize("scale", [1e-30, 1e-9, 1.0, 1e12])
def test_newton_finds_roots_of_any_size(scale: float) -> None:
    def look(z: float) -> tuple[float, float]:
        return z**3 - scale**3, 3 * z**2

    assert newton(look, True, 0.0, 200) == pytest.approx(scale, rel=1e-12)


def test_newton_says_when_there_is_no_root() -> None:
    found = newton(lambda z: (2.0 + z / (1 + abs(z)), 1.0), True, 0.0, 200)
    assert found != found


def test_newton_stops_at_a_jump() -> None:
    """Standing friction: the force lies inside the jump, and so the speed is zero."""
    found = newton(lambda z: (z + (1 if z > 0 else -1) - 0.3, 1.0), True, 5.0, 300)
    assert abs(found) < 1e-30


def test_a_relativistic_momentum_is_found() -> None:
    """p / sqrt(1 + p^2) grows, which the quotient rule alone does not show."""
    law = p.div(x, p.fn("sqrt", p.add((1, p.power(x, 2)), (1, p.one))))
    assert direction(p, law, x, lambda _: None) is None
    node = invert(p, p.sub(y, law), x, lambda _: None)
    assert node is not None and not node.root.rising and node.root.guess == Fraction(0)


def test_what_has_a_value_for_positive_numbers_alone_has_no_root_beyond_the_pole() -> None:
    # log x + x - 1/x rises from -inf at 0 to inf; without the logarithm it does so on both sides
    pole = p.neg(p.power(x, -1))
    assert direction(p, plus(x, pole), x, lambda _: None) is None
    assert direction(p, plus(x, pole, p.fn("log", x)), x, lambda _: None) == 1


@pytest.mark.parametrize(
    ("points", "low", "high"),
    [
        # slopes by hand: 2 and 1/2, and nothing beyond the ends
        (((0, 0), (1, 2), (3, 3)), 0.0, 2.0),
        (((0, 0), (2, 1), (3, 3)), 0.0, 2.0),
        (((0, 0), (1, -2), (3, -3)), -2.0, 0.0),
        (((0, 0), (1, 2), (3, -4)), -3.0, 2.0),
    ],
)
def test_the_slopes_of_a_table_are_those_between_its_points(
    points: tuple[tuple[int, int], ...], low: float, high: float
) -> None:
    p.tables["bent.csv"] = tuple((Fraction(u), Fraction(v)) for u, v in points)
    law = p.fn("table:bent.csv", x)
    found = slope_range(p, law, x, lambda _: None)
    assert found is not None and (found.low, found.high) == (low, high)
    # with as much added as it falls at most it may stand still, with more it grows
    assert direction(p, p.add((1, law), (int(-low), x)), x, lambda _: None) is None
    assert direction(p, p.add((1, law), (int(1 - low), x)), x, lambda _: None) == 1
    assert direction(p, p.add((1, law), (int(-1 - high), x)), x, lambda _: None) == -1


@pytest.mark.parametrize(("rising", "sign"), [(True, 1), (False, -1)])
def test_an_inner_unknown_grows_with_what_its_equation_says(rising: bool, sign: int) -> None:
    """u + u^3 = c or -u - u^3 = c: of c, and of what that grows or falls with; of nothing else."""
    u, c, d = (p.symbol(name, Kind.UNKNOWN) for name in "ucd")
    zero = p.sub(p.add((sign, u), (sign, p.power(u, 3))), c)
    root = Root(f"R{sign}", zero, u, (c,), u, rising, Fraction(0))

    def grows(law: Expr) -> int | None:
        return direction(p, law, x, lambda symbol: 1.0)

    assert grows(p.root(root, x)) == sign and grows(p.root(root, p.scale(-2, x))) == -sign
    assert grows(plus(p.root(root, y), x)) == 1  # what does not hold x does nothing
    assert grows(p.root(root, p.power(x, 2))) is None
    both = Root(f"S{sign}", p.sub(zero, d), u, (c, d), u, rising, Fraction(0))
    assert grows(p.root(both, x, p.power(x, 3))) == sign
    assert grows(p.root(both, x, p.neg(x))) is None
