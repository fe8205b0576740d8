"""Expressions to SymPy and back: nothing is lost on the way, and both differentiate alike."""

from __future__ import annotations

from fractions import Fraction

import pytest
import sympy as sp

from bondgraph.algebra.derivative import differentiate
from bondgraph.algebra.implicit import invert
from bondgraph.algebra.symbolic import t
from bondgraph.algebra.sympy_signals import Signals, name_of, own_function, taken, undone
from bondgraph.algebra.zero import is_zero
from bondgraph.ir.expr import Expr, Kind, Pool

p = Pool()
p.tables["bent.csv"] = tuple((Fraction(u), Fraction(v)) for u, v in ((0, 0), (1, 2), (3, 3)))
x, y = (p.symbol(n, Kind.SENSOR) for n in "xy")
told = p.symbol("z", Kind.READING)
a = p.symbol("a", Kind.PARAM)
on = p.symbol("on", Kind.MODE)
q0 = p.symbol("q0", Kind.INITIAL)


def plus(*terms: Expr) -> Expr:
    return p.add(*[(1, term) for term in terms])


_ROOTED = invert(p, p.sub(y, plus(x, p.power(x, 3))), x, lambda _: None)
assert _ROOTED is not None

LAWS: dict[str, Expr] = {
    "fraction": p.div(p.add((3, p.mul(a, x)), (-2, p.one)), plus(p.power(y, 2), a)),
    "derivatives": plus(p.der(x, 2), p.mul(a, p.der(y))),
    "a product of rates": p.mul(p.der(x), p.der(y), x),
    "functions": plus(p.fn("sin", x), p.fn("exp", p.mul(a, y)), p.fn("atan2", x, y)),
    "odd": plus(p.fn("ssq", x), p.mul(a, p.fn("abs", y)), p.fn("ssqrt", p.mul(x, y))),
    "smaller": p.mul(a, p.fn("min", x, y)),
    "power": p.fn("pow", x, a),
    "table": p.mul(a, p.fn("table:bent.csv", p.mul(x, y))),
    "choice": p.choose(p.compare("<", x, y), x, p.mul(a, y)),
    "of three": p.choose(
        p.compare("<", x, y), x, p.choose(p.compare("<=", a, x), p.mul(a, y), p.one)
    ),
    "mode": p.choose(on, x, y),
    "no mode": p.choose(p.logic("not", on), x, y),
    "both": p.choose(p.logic("and", on, p.compare("<", x, y)), x, y),
    "either": p.choose(p.logic("or", on, p.compare("<", x, y)), x, y),
    "root": p.mul(a, _ROOTED),
}


@pytest.mark.parametrize("name", LAWS)
def test_what_comes_back_is_what_went(name: str) -> None:
    signals = Signals(p, {}, [x])
    back = signals.expr(signals.sympy(LAWS[name]))
    (same,) = signals.copies([LAWS[name]])
    pool = signals.own
    assert back is same or is_zero(pool.sub(back, same))
    assert pool is not p


@pytest.mark.parametrize(
    "name", ["fraction", "derivatives", "a product of rates", "functions", "odd"]
)
def test_sympy_differentiates_to_the_same(name: str) -> None:
    """Its rules are not the compiler's: for the same law both say the same."""
    signals = Signals(p, {}, [])
    slope = signals.expr(sp.diff(signals.sympy(LAWS[name]), t).doit())
    (expected,) = signals.copies([differentiate(p, LAWS[name])])
    assert is_zero(signals.own.sub(slope, expected))


def test_signals_are_functions_of_time_and_parameters_are_not() -> None:
    signals = Signals(p, {}, [])
    found = signals.sympy(p.mul(a, x))
    assert found.diff(t) == signals.sympy(p.mul(a, p.der(x))) != 0
    assert signals.sympy(a).diff(t) == 0


def test_a_reading_is_what_its_sensor_says() -> None:
    signals = Signals(p, {}, [])
    found = signals.expr(signals.sympy(p.scale(2, told)))
    sensor = signals.own.symbol("z", Kind.SENSOR)
    assert found is signals.own.scale(2, sensor)


def test_an_integral_has_the_declared_start_beside_it() -> None:
    start = p.symbol("q.0", Kind.FREE)
    signals = Signals(p, {start.symbol: q0}, [])
    found = signals.sympy(p.integral(x, start))
    began = signals.sympy(q0)
    assert began in found.free_symbols
    assert sp.diff(found, t).doit(integrals=False) == signals.sympy(x)


@pytest.mark.parametrize(
    ("name", "back"),
    [("exp", "log"), ("sinh", "asinh"), ("ssq", "ssqrt"), ("ssqrt", "ssq"), ("tanh", "atanh")],
)
def test_a_function_is_undone_by_its_inverse(name: str, back: str) -> None:
    signals = Signals(p, {}, [])
    value, target = signals.sympy(p.fn(name, x)), signals.sympy(y)
    found = undone(value, 0, target)
    assert found == signals.sympy(p.fn(back, y))
    assert name_of(value) == name and name_of(found) == back


def test_what_undoes_tables_powers_and_nothing() -> None:
    signals = Signals(p, {}, [])
    target = signals.sympy(y)
    table = signals.sympy(p.fn("table:bent.csv", x))
    assert undone(table, 0, target) == own_function("table:bent.csv'")(target)
    assert undone(signals.sympy(p.fn("cbrt", x)), 0, target) == target**3
    assert undone(signals.sympy(p.fn("sign", x)), 0, target) is None
    assert undone(signals.sympy(x), 0, target) is None


def test_derivatives_are_taken_and_integrals_are_not() -> None:
    plain = sp.Function("x", real=True)(t)
    product = sp.Derivative(t**2 * plain, t)
    whole = sp.Integral(t, (t, 0, t))
    assert taken(product) == 2 * t * plain + t**2 * sp.Derivative(plain, t)
    assert taken(product + whole) == taken(product) + whole
    assert taken(whole) is whole
    assert taken(sp.Derivative(t * whole, t)).has(sp.Integral)


def test_the_slope_of_a_function_that_nobody_knows_is_one_of_its_own() -> None:
    """Of a table; that of one of the library is known by its arguments."""
    u, v = sp.Symbol("u", real=True), sp.Symbol("v", real=True)
    table = own_function("table:bent.csv")
    slope = sp.diff(table(u**2, v), u)
    by_first = own_function("table:bent.csv by 1")(u**2, v)
    assert sp.simplify(slope - 2 * u * by_first) == 0
    assert sp.diff(table(u, v), v) == own_function("table:bent.csv by 2")(u, v)
    square = own_function("ssq")(u)
    assert square.fdiff() == 2 * own_function("abs")(u)
