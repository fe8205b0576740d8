"""Time derivatives by recurrences: what SymPy finds, at the price of a polynomial."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction

import pytest
import sympy

from bondgraph.algebra.derivative import Jets, TooManyOperations, differentiate, operations
from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological

T = sympy.Symbol("t")
X = sympy.Rational(3, 5) + sympy.sin(T) / 5
Y = sympy.Rational(1, 3) + T**2 / 7 + sympy.cos(2 * T) / 9
AT = sympy.Rational(1, 2)


def value(pool: Pool, expr: Expr) -> float:
    """The expression for x = X(t), y = Y(t), a = 7/10 at t = AT."""
    given = {
        pool.symbol("x", Kind.SENSOR): X,
        pool.symbol("y", Kind.SENSOR): Y,
        pool.symbol("a", Kind.PARAM): sympy.Rational(7, 10),
    }
    signals = dict(given)
    numbers: dict[Expr, float] = {}
    for node in topological([expr]):
        if node.op is Op.DER:
            signals[node] = signals[node.args[0]].diff(T)
        if node in signals:
            numbers[node] = float(sympy.sympify(signals[node]).subs(T, AT))
            continue
        args = [numbers[a] for a in node.args]
        match node.op:
            case Op.NUM:
                found = float(node.number)
            case Op.ADD:
                found = sum(float(c) * x for c, x in zip(node.coefficients, args, strict=True))
            case Op.MUL:
                found = math.prod(x**e for x, e in zip(args, node.exponents, strict=True))
            case Op.CMP:
                found = args[0] < args[1] if node.name == "<" else args[0] <= args[1]
            case Op.IF:
                found = args[1] if args[0] else args[2]
            case _:
                own = _OWN.get(node.name)
                found = own(*args) if own else getattr(math, node.name)(*args)
        numbers[node] = found
    return numbers[expr]


_OWN: dict[str, Callable[..., float]] = {
    "abs": abs,
    "min": min,
    "max": max,
    "sign": lambda x: (x > 0) - (x < 0),
    "ssqrt": lambda x: math.copysign(math.sqrt(abs(x)), x),
    "ssq": lambda x: x * abs(x),
    "cbrt": lambda x: math.copysign(abs(x) ** (1 / 3), x),
}

_ORDINARY = "sqrt cbrt exp log sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh".split()


@pytest.mark.parametrize("name", _ORDINARY)
def test_every_function(name: str) -> None:
    pool = Pool()
    x = pool.symbol("x", Kind.SENSOR)
    shift = 2 if name == "acosh" else 0
    ours = pool.fn(name, pool.add((1, x), (shift, pool.one)))
    theirs = getattr(sympy, name)(X + shift)
    for order in range(6):
        wanted = float(theirs.diff(T, order).subs(T, AT))
        assert value(pool, differentiate(pool, ours, order)) == pytest.approx(wanted, rel=1e-9)


def test_every_operation() -> None:
    pool = Pool()
    x, y = pool.symbol("x", Kind.SENSOR), pool.symbol("y", Kind.SENSOR)
    a, aa = pool.symbol("a", Kind.PARAM), sympy.Rational(7, 10)
    num = pool.num
    pairs = {
        pool.mul(a, x, y, pool.fn("exp", x)): aa * X * Y * sympy.exp(X),
        pool.mul(pool.power(x, 5), pool.power(y, -3)): X**5 / Y**3,
        pool.power(pool.sub(x, y), 4): (X - Y) ** 4,
        pool.fn("ssqrt", pool.sub(y, x)): -sympy.sqrt(X - Y),
        pool.fn("ssq", pool.sub(y, x)): -((X - Y) ** 2),
        pool.fn("abs", pool.sub(y, x)): X - Y,
        pool.fn("pow", x, a): X**aa,
        pool.fn("pow", x, num(Fraction(-4, 3))): X ** sympy.Rational(-4, 3),
        pool.fn("pow", x, num(Fraction(7, 3))): X ** sympy.Rational(7, 3),
        pool.fn("pow", x, pool.add((2, y), (-1, pool.one))): X ** (2 * Y - 1),
        pool.fn("atan2", x, y): sympy.atan2(X, Y),
        pool.fn("min", x, y): Y,
        pool.fn("max", pool.power(x, 2), pool.power(y, 2)): X**2,
        pool.choose(pool.compare("<", x, y), x, pool.mul(x, y)): X * Y,
        pool.mul(pool.der(x), pool.der(pool.mul(x, y))): X.diff(T) * (X * Y).diff(T),
    }
    jets = Jets(pool)
    for ours, theirs in pairs.items():
        for order in range(5):
            wanted = float(theirs.diff(T, order).subs(T, AT))
            assert value(pool, jets.of(ours, order)) == pytest.approx(wanted, rel=1e-9), ours


def test_powers_have_derivatives_at_zero() -> None:
    pool = Pool()
    x = pool.symbol("x", Kind.SENSOR)
    speed = pool.der(x)
    numbers = pool.substitute(
        [differentiate(pool, pool.power(x, 3), 3)],
        {pool.der(pool.der(speed)): pool.zero, pool.der(speed): pool.zero, speed: pool.num(2)},
    )
    assert pool.substitute(numbers, {x: pool.zero})[0].number == 6 * 2**3


def test_tables_are_differentiated_piece_by_piece() -> None:
    pool = Pool()
    pool.tables["t"] = ((Fraction(0), Fraction(0)), (Fraction(1), Fraction(3)))
    x = pool.symbol("x", Kind.SENSOR)
    found = differentiate(pool, pool.fn("table:t", x), 3)
    assert value(pool, found) == pytest.approx(3 * float(X.diff(T, 3).subs(T, AT)))


def test_integrals_and_constants() -> None:
    pool = Pool()
    x, a = pool.symbol("x", Kind.SENSOR), pool.symbol("a", Kind.PARAM)
    mode, start = pool.symbol("m", Kind.MODE), pool.symbol("x0", Kind.INITIAL)
    assert differentiate(pool, pool.integral(pool.mul(a, x), start), 1) is pool.mul(a, x)
    assert differentiate(pool, pool.mul(a, pool.fn("exp", a)), 3) is pool.zero
    assert differentiate(pool, pool.choose(mode, x, a), 1) is pool.choose(
        mode, pool.der(x), pool.zero
    )


def chain(pool: Pool, laws: int) -> Expr:
    """A signal behind so many laws f = ssqrt(e) in series with storages between them."""
    effort = pool.symbol("y", Kind.SENSOR)
    flow = effort
    for _ in range(laws):
        effort = pool.add((1, effort), (1, pool.fn("ssq", flow)))
        flow = pool.add((1, flow), (2, pool.der(effort)))
    return flow


def test_a_chain_of_laws_costs_a_polynomial() -> None:
    costs = []
    for laws in (4, 8, 16):
        pool = Pool()
        costs.append(operations([differentiate(pool, chain(pool, laws), 0)]))
    assert costs[1] < 9 * costs[0] and costs[2] < 9 * costs[1]  # at most the third power
    assert costs[2] < 5000


def test_the_limit_stops_at_once_and_spoils_nothing() -> None:
    pool = Pool()
    jets, whole = Jets(pool), chain(pool, 60)
    size = len(pool)
    with pytest.raises(TooManyOperations):
        jets.of(whole, 0, limit=500)
    assert len(pool) < size + 700
    x = pool.symbol("x", Kind.SENSOR)
    assert jets.of(pool.power(x, 2), 1) is pool.scale(2, pool.mul(x, pool.der(x)))


def test_deep_expressions_are_no_problem() -> None:
    pool = Pool()
    expr = x = pool.symbol("x", Kind.SENSOR)
    for _ in range(5000):
        expr = pool.add((1, x), (1, pool.fn("sin", expr)))
    assert operations([differentiate(pool, expr)]) > 5000
