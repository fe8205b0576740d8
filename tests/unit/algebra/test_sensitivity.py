"""Sensitivities against SymPy's derivatives and against differences of the relations' values."""

from __future__ import annotations

import random
from collections.abc import Mapping
from fractions import Fraction
from itertools import pairwise
from typing import Any

import pytest
import sympy as sp

import bondgraph
from bondgraph.algebra.sensitivity import sensitivity, variation
from bondgraph.algebra.symbolic import t, to_sympy
from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological
from tests.unit.passes.relations import compiled

MODELS = ("dc_motor", "quarter_car", "two_tanks", "microphone", "drive", "rc_loop", "oven")


@pytest.mark.parametrize("model", MODELS)
def test_parameters_as_sympy_differentiates(model: str) -> None:
    """SymPy differentiates the relation itself, with its own rules, at random signals."""
    c = bondgraph.compile(f"models/{model}.bg")
    graph, starts = c.graph, c.graph.initial_values()
    for relation in c.residuals:
        expr = relation.residual.expr
        wrt = [graph.fault_symbol(f) for f in relation.faults]
        wrt = [s for s in wrt if s.symbol.kind is Kind.PARAM]
        whole = to_sympy(expr, starts=starts)
        for symbol, slope in sensitivity(graph.pool, expr, wrt, starts).items():
            own = sp.Symbol(symbol.symbol.name, real=True)
            zero = {graph.pool.symbol("0", Kind.INITIAL).symbol: graph.pool.zero}
            ours = to_sympy(slope, starts={**starts, **zero})
            assert _same(sp.diff(whole, own), ours), (relation.name, symbol)


def _same(a: Any, b: Any) -> bool:
    """Whether two expressions agree at signals that are random polynomials of time."""
    draw = random.Random(5)
    for _ in range(2):
        values: dict[Any, Any] = {}
        for f in sorted(a.atoms(sp.Function) | b.atoms(sp.Function), key=str):
            if f.func.__class__ is sp.core.function.UndefinedFunction:
                powers = [sp.Rational(draw.randint(1, 9), 7) * t**k for k in range(3)]
                values[f] = sp.Add(*powers)
        for s in sorted((a.free_symbols | b.free_symbols) - {t}, key=str):
            values[s] = sp.Rational(draw.randint(1, 9), 5)
        left, right = (x.subs(values).doit().subs(t, sp.Rational(1, 3)).evalf(30) for x in (a, b))
        if abs(left - right) > 1e-20 * (1 + abs(left)):
            return False
    return True


SHAPES = {
    "kinks": lambda p, R, y: p.fn("abs", p.sub(p.mul(R, y), p.one)),
    "limit": lambda p, R, y: p.fn("min", p.mul(R, y), p.num(2)),
    "branch": lambda p, R, y: p.choose(p.compare("<", R, y), p.power(R, 3), p.mul(R, y)),
    "table": lambda p, R, y: p.fn("table:s", p.mul(R, y)),
    "root": lambda p, R, y: p.fn("ssqrt", p.sub(y, R)),
    "signed square": lambda p, R, y: p.fn("ssq", p.sub(y, R)),
    "power": lambda p, R, y: p.fn("pow", y, R),
    "angle": lambda p, R, y: p.fn("atan2", R, y),
    "cube root": lambda p, R, y: p.fn("cbrt", p.mul(R, R, y)),
    "inverse": lambda p, R, y: p.fn("asinh", p.div(y, R)),
    "product": lambda p, R, y: p.mul(p.power(p.add((1, R), (2, y)), -2), R, p.fn("exp", R)),
}


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("R_value", [0.4, 1.3, 2.9])
def test_functions_by_differences(shape: str, R_value: float) -> None:
    """A change by 1e-6 of the parameter, the expression evaluated in floating point."""
    p = Pool()
    p.tables["s"] = tuple((Fraction(x), Fraction(y)) for x, y in ((0, 0), (1, 2), (3, 3), (4, 9)))
    R, y = p.symbol("R", Kind.PARAM), p.symbol("y", Kind.SENSOR)
    expr = SHAPES[shape](p, R, y)
    y_value, h = 1.1, 1e-6
    up, down = (_value(p, expr, {R: R_value + s * h, y: y_value}) for s in (1, -1))
    slope = sensitivity(p, expr, [R])[R]
    assert _value(p, slope, {R: R_value, y: y_value}) == pytest.approx((up - down) / (2 * h), 1e-6)


def _value(pool: Pool, expr: Expr, point: Mapping[Expr, float]) -> float:
    """Floating-point value by SymPy's functions; the table by straight lines."""
    leaves: dict[Expr, Any] = {s: sp.Float(x) for s, x in point.items()}
    for node in topological([expr]):
        if node.op is Op.FN and node.name.startswith("table:"):
            x = _value(pool, node.args[0], point)
            points = pool.tables[node.name[6:]]
            (x0, y0), (x1, y1) = next(pair for pair in pairwise(points) if x <= pair[1][0])
            leaves[node] = sp.Float(float(y0) + (x - float(x0)) * float((y1 - y0) / (x1 - x0)))
    return float(to_sympy(expr, leaves))


def test_an_error_that_moves_goes_through_the_derivatives() -> None:
    p = Pool()
    y, b = p.symbol("y", Kind.SENSOR), p.symbol("b", Kind.SENSOR)
    L, K = p.symbol("L", Kind.PARAM), p.symbol("K", Kind.PARAM)
    expr = p.add((1, p.mul(L, p.der(p.der(y)))), (1, p.mul(K, p.fn("tanh", y))))
    assert sensitivity(p, expr, [y])[y] is p.mul(
        K, p.sub(p.one, p.power(p.fn("tanh", y), 2))
    )  # a constant error leaves D(y) alone
    moved = to_sympy(variation(p, expr, {y: b}))
    eps = sp.Symbol("eps")
    shifted = to_sympy(expr, {y: sp.Function("y", real=True)(t) + eps * to_sympy(b)})
    assert sp.simplify(sp.diff(shifted.doit(), eps).subs(eps, 0) - moved.doit()) == 0


def test_an_initial_value_made_of_parameters() -> None:
    """d/dC of Int(C y) that begins at 3 C is 3 + Int(y)."""
    p = Pool()
    y, q0 = p.symbol("y", Kind.SENSOR), p.symbol("q0", Kind.INITIAL)
    C, R = p.symbol("C", Kind.PARAM), p.symbol("R", Kind.PARAM)
    expr = p.mul(R, p.integral(p.mul(C, y), q0))
    found = sensitivity(p, expr, [C, R, q0], {q0.symbol: p.scale(3, C)})
    from_zero = p.integral(y, p.symbol("0", Kind.INITIAL))
    assert found == {
        C: p.mul(R, p.add((3, p.one), (1, from_zero))),
        R: p.integral(p.mul(C, y), q0),
        q0: R,
    }


def test_the_relation_of_a_model() -> None:
    """dc motor: r1 = U - R i - k w - L i'; with i = t^2 and L = 3: theta dr/dtheta = -6 t."""
    c = compiled(
        """model M { param L = 3; param R = 5; param k = 7; param J = 1
        Se:U -> 1:a; a { -> I:L; -> R:R; -> Df:i; -> GY:k -> b }
        1:b { -> I:J; -> Df:w } }"""
    )
    relation = next(r for r in c.residuals if "R" in r.faults)
    sign = 1 if relation.expr.coeff(sp.Function("U", real=True)(t)) == 1 else -1
    assert relation.sensitivity("R") == -sign * sp.Function("i", real=True)(t)
    signals = {"U": 0, "w": 4, "i": t**2}
    assert relation.effect("L", signals, at=2) == pytest.approx(-sign * 3 * 4)
    assert relation.effect("U", {**signals, "U": 12}, at=2) == pytest.approx(sign * 12)
    assert relation.effect("k", signals) == pytest.approx(-sign * 28)
    with pytest.raises(KeyError):
        relation.sensitivity("nonsense")


def test_a_long_chain_stays_linear() -> None:
    """x' = R x + L D(x) a thousand times over: the tangent has a few nodes a cell."""
    p = Pool()
    x = p.symbol("y", Kind.SENSOR)
    R, L = p.symbol("R", Kind.PARAM), p.symbol("L", Kind.PARAM)
    for _ in range(1000):
        x = p.add((1, x), (1, p.mul(R, x)), (1, p.mul(L, p.der(x))))
    found = sensitivity(p, x, [R, L])
    assert all(len(topological([s])) < 20_000 for s in found.values())


def test_a_parameter_called_t_is_not_the_time() -> None:
    """F - t v' - 3 v: its slope by t is -v', in which nothing else has become t."""
    text = "model M { param t = 2\n1:a { <- Se:F; -> I:m = t; -> R:d = 3; -> Df:v } }"
    (relation,) = compiled(text).residuals
    time, own = sp.Symbol("t", real=True), sp.Symbol("constant t", real=True)
    F, v = (sp.Function(name, real=True)(time) for name in ("F", "v"))
    wanted = F - own * sp.diff(v, time) - 3 * v
    assert sp.simplify(relation.expr / wanted) in (1, -1)
    slope = relation.sensitivity("t")
    assert sp.simplify(slope / sp.diff(v, time)) in (1, -1)


def test_what_moves_by_itself_moves_by_nothing_that_it_is_made_of() -> None:
    """2 x y + 3 x, of which the product is told to change by d and x by e."""
    p = Pool()
    x, y, d, e = (p.symbol(name, Kind.SENSOR) for name in ("x", "y", "d", "e"))
    product = p.mul(x, y)
    expr = p.add((2, product), (3, x))
    assert variation(p, expr, {product: d, x: e}, {}) is p.add((2, d), (3, e))
    assert variation(p, expr, {x: e}, {}) is p.add((2, p.mul(y, e)), (3, e))
    assert variation(p, expr, {d: e}, {}) is p.zero
