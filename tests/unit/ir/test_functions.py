"""What the record says of each function, against numbers of mpmath; and that no table has a gap."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

import mpmath
import pytest
from sympy.core.function import AppliedUndef

from bondgraph.algebra.numeric import DOUBLES, evaluate
from bondgraph.algebra.symbolic import to_sympy
from bondgraph.backends.target import load, targets
from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.ir.functions import FUNCTIONS, Interval

ONE = [name for name, f in FUNCTIONS.items() if len(f.slopes) == 1]
TWO = [name for name, f in FUNCTIONS.items() if len(f.slopes) == 2]


def truth(name: str) -> Callable[..., mpmath.mpf]:
    """The function in multiple precision."""
    own: dict[str, Callable[..., mpmath.mpf]] = {
        "abs": abs,
        "sign": mpmath.sign,
        "cbrt": lambda x: mpmath.sign(x) * mpmath.cbrt(abs(x)),
        "ssqrt": lambda x: mpmath.sign(x) * mpmath.sqrt(abs(x)),
        "ssq": lambda x: x * abs(x),
        "min": min,
        "max": max,
        "pow": mpmath.power,
    }
    return own.get(name) or getattr(mpmath, name)


def points(name: str, count: int = 12) -> list[float]:
    """Numbers of some decades inside of the domain."""
    draw, domain = random.Random(name), FUNCTIONS[name].domain
    found: list[float] = []
    while len(found) < count:
        x = draw.choice((-1, 1)) * 10 ** draw.uniform(-1.5, 0.8)
        if domain.low < x < domain.high:
            found.append(x)
    return found


def number(expr: Expr, **values: float) -> float:
    found = evaluate(expr, values)
    assert found is not None
    return float(found)


@pytest.mark.parametrize("name", ONE)
def test_slope_integral_inverse_and_intervals_of_one_argument(name: str) -> None:
    pool, f = Pool(), FUNCTIONS[name]
    x = pool.symbol("x", Kind.PARAM)
    value = pool.fn(name, x)
    for at in points(name):
        exact = truth(name)
        assert DOUBLES[name](at) == pytest.approx(float(exact(mpmath.mpf(at))), rel=1e-14)
        slope = float(mpmath.diff(exact, at))
        found = number(f.slopes[0](pool, value, x), x=at)
        assert found == pytest.approx(slope, rel=1e-9, abs=1e-12)
        assert inside(float(exact(mpmath.mpf(at))), f.values)
        assert f.rates is None or inside(slope, f.rates)
        if f.inverse is not None:
            back = float(exact(mpmath.mpf(at)))
            undo = back**f.inverse if isinstance(f.inverse, int) else DOUBLES[f.inverse](back)
            assert undo == pytest.approx(at, rel=1e-9)
        if f.odd is not None:
            size = abs(at)
            part = size**f.odd if isinstance(f.odd, int) else DOUBLES[f.odd](size)
            assert math.copysign(part, at) == pytest.approx(float(exact(mpmath.mpf(at))), rel=1e-14)
        if f.integral is not None:
            factor, whole = f.integral
            rate = float(factor) * float(mpmath.diff(truth(whole), at))
            assert rate == pytest.approx(float(exact(mpmath.mpf(at))), rel=1e-9)


@pytest.mark.parametrize("name", TWO)
def test_slopes_of_two_arguments(name: str) -> None:
    pool, exact = Pool(), truth(name)
    x, y = pool.symbol("x", Kind.PARAM), pool.symbol("y", Kind.PARAM)
    draw = random.Random(name)
    for _ in range(12):
        a, b = draw.uniform(0.2, 3.0), draw.uniform(0.2, 3.0)
        for k, slope in enumerate(FUNCTIONS[name].slopes):
            wanted = float(mpmath.diff(exact, (a, b), (1 - k, k)))
            found = number(slope(pool, pool.fn(name, x, y), x, y), x=a, y=b)
            assert found == pytest.approx(wanted, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("name", ONE)
def test_value_at_zero(name: str) -> None:
    f = FUNCTIONS[name]
    if f.zero is not None:
        pool = Pool()
        assert float(truth(name)(mpmath.mpf(0))) == f.zero
        assert pool.fn(name, pool.zero) is pool.num(f.zero)
    elif f.domain.low < 0 < f.domain.high:
        value = float(truth(name)(mpmath.mpf(0)))
        assert not math.isfinite(value) or value != int(value)


def inside(x: float, interval: Interval) -> bool:
    return interval.low <= x <= interval.high


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_kind_of_number_and_every_language_knows_every_function(name: str) -> None:
    pool = Pool()
    x = [pool.symbol(n, Kind.PARAM) for n in "xy"[: len(FUNCTIONS[name].slopes)]]
    assert name in DOUBLES
    assert not to_sympy(pool.fn(name, *x)).atoms(AppliedUndef)  # as an unknown function would be
    for target in targets():
        assert name in load(target).dialect.functions, target


PAIRS = [(f.inverse, name) for name, f in FUNCTIONS.items() if isinstance(f.inverse, str)]


@pytest.mark.parametrize(("outer", "inner"), PAIRS)
def test_what_undoes_a_function_leaves_its_argument(outer: str, inner: str) -> None:
    pool = Pool()
    x = pool.symbol("x", Kind.SENSOR)
    argument = pool.mul(pool.symbol("k", Kind.PARAM), x)
    assert pool.fn(outer, pool.fn(inner, argument)) is argument
    for at in points(inner):
        assert truth(outer)(truth(inner)(mpmath.mpf(at))) == pytest.approx(at)


@pytest.mark.parametrize(
    ("outer", "inner", "at"), [("asin", "sin", 4), ("atan", "tan", 4), ("acosh", "cosh", -4)]
)
def test_what_undoes_one_branch_of_a_function_stays(outer: str, inner: str, at: int) -> None:
    pool = Pool()
    x = pool.symbol("x", Kind.SENSOR)
    assert pool.fn(outer, pool.fn(inner, x)) is not x
    assert truth(outer)(truth(inner)(mpmath.mpf(at))) != pytest.approx(at)
