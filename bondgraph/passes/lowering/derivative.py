"""The exact time derivative of an expression of known signals, by the rules of calculus.

Parameters are constant in time. `if`, `abs`, `min`, `max` and tables are differentiated piece by
piece; a jump of a mode or of a sign has no derivative and contributes nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from itertools import pairwise

from bondgraph.ir.expr import CONSTANTS, Expr, Kind, Op, Pool, topological

_Rule = Callable[[Pool, Expr, Expr], Expr]


def _root(pool: Pool, x: Expr) -> Expr:
    return pool.power(pool.fn("sqrt", x), -1)


#: d f(x) / dx, given the node f(x) and x
_SLOPES: dict[str, _Rule] = {
    "abs": lambda p, f, x: p.fn("sign", x),
    "sign": lambda p, f, x: p.zero,
    "sqrt": lambda p, f, x: p.scale(Fraction(1, 2), p.power(f, -1)),
    "cbrt": lambda p, f, x: p.scale(Fraction(1, 3), p.power(f, -2)),
    "ssqrt": lambda p, f, x: p.scale(Fraction(1, 2), p.power(p.fn("abs", f), -1)),
    "ssq": lambda p, f, x: p.scale(2, p.fn("abs", x)),
    "exp": lambda p, f, x: f,
    "log": lambda p, f, x: p.power(x, -1),
    "sin": lambda p, f, x: p.fn("cos", x),
    "cos": lambda p, f, x: p.neg(p.fn("sin", x)),
    "tan": lambda p, f, x: p.add((1, p.one), (1, p.power(f, 2))),
    "asin": lambda p, f, x: _root(p, p.sub(p.one, p.power(x, 2))),
    "acos": lambda p, f, x: p.neg(_root(p, p.sub(p.one, p.power(x, 2)))),
    "atan": lambda p, f, x: p.power(p.add((1, p.one), (1, p.power(x, 2))), -1),
    "sinh": lambda p, f, x: p.fn("cosh", x),
    "cosh": lambda p, f, x: p.fn("sinh", x),
    "tanh": lambda p, f, x: p.sub(p.one, p.power(f, 2)),
    "asinh": lambda p, f, x: _root(p, p.add((1, p.one), (1, p.power(x, 2)))),
    "acosh": lambda p, f, x: _root(p, p.sub(p.power(x, 2), p.one)),
    "atanh": lambda p, f, x: p.power(p.sub(p.one, p.power(x, 2)), -1),
}


def differentiate(pool: Pool, expr: Expr, times: int = 1) -> Expr:
    """D(expr, times), with D on known signals (and on what stands under no other rule) only."""
    expr = push(pool, expr)
    for _ in range(times):
        expr = push(pool, _once(pool, expr))
    return expr


def push(pool: Pool, expr: Expr) -> Expr:
    """The same expression with every derivative moved inwards to the known signals."""
    new: dict[Expr, Expr] = {}
    for node in topological([expr]):
        args = tuple(new[a] for a in node.args)
        new[node] = _once(pool, args[0]) if node.op is Op.DER else pool.rebuild(node, args)
    return new[expr]


def _once(pool: Pool, expr: Expr) -> Expr:
    slopes: dict[Expr, Expr] = {}
    for node in topological([expr], stop=lambda n: n.op in (Op.DER, Op.INT)):
        slopes[node] = _slope(pool, node, slopes)
    return slopes[expr]


def _slope(pool: Pool, node: Expr, slopes: dict[Expr, Expr]) -> Expr:
    match node.op:
        case Op.NUM | Op.CMP | Op.LOGIC:
            return pool.zero
        case Op.SYM:
            still = node.symbol.kind in CONSTANTS or node.symbol.kind is Kind.MODE
            return pool.zero if still else pool.der(node)
        case Op.DER | Op.INT:
            return pool.der(node)
        case Op.ADD:
            pairs = zip(node.coefficients, node.args, strict=True)
            return pool.add(*[(c, slopes[a]) for c, a in pairs])
        case Op.MUL:
            terms = []
            for a, e in zip(node.args, node.exponents, strict=True):
                if slopes[a] is not pool.zero:
                    terms.append((e, pool.mul(node, pool.power(a, -1), slopes[a])))
            return pool.add(*terms)
        case Op.IF:
            condition, yes, no = node.args
            return pool.choose(condition, slopes[yes], slopes[no])
        case Op.FN:
            return _chain(pool, node, slopes)


def _chain(pool: Pool, node: Expr, slopes: dict[Expr, Expr]) -> Expr:
    if all(slopes[a] is pool.zero for a in node.args):
        return pool.zero
    x = node.args[0]
    if node.name.startswith("table:"):
        return pool.mul(_table_slope(pool, node.name, x), slopes[x])
    if len(node.args) == 1:
        return pool.mul(_SLOPES[node.name](pool, node, x), slopes[x])
    y = node.args[1]
    if node.name in ("min", "max"):
        first = pool.compare("<=" if node.name == "min" else ">=", x, y)
        return pool.choose(first, slopes[x], slopes[y])
    if node.name == "atan2":
        square = pool.add((1, pool.power(x, 2)), (1, pool.power(y, 2)))
        turned = pool.sub(pool.mul(y, slopes[x]), pool.mul(x, slopes[y]))
        return pool.div(turned, square)
    assert node.name == "pow"
    lowered = pool.fn("pow", x, pool.sub(y, pool.one))
    base = pool.mul(y, lowered, slopes[x])
    if slopes[y] is pool.zero:
        return base
    return pool.add((1, base), (1, pool.mul(node, pool.fn("log", x), slopes[y])))


def _table_slope(pool: Pool, name: str, x: Expr) -> Expr:
    """The slope of a piecewise linear table as a choice by bisection; 0 outside its range."""
    points = pool.tables[name.removeprefix("table:")]
    edges = [p[0] for p in points]
    inner = [(b[1] - a[1]) / (b[0] - a[0]) for a, b in pairwise(points)]
    slopes = [Fraction(0), *inner, Fraction(0)]

    def pick(low: int, high: int) -> Expr:
        if low == high:
            return pool.num(slopes[low])
        middle = (low + high) // 2
        below = pool.compare("<", x, pool.num(edges[middle]))
        return pool.choose(below, pick(low, middle), pick(middle + 1, high))

    return pick(0, len(slopes) - 1)
