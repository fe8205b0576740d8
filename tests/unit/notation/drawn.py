"""Expressions drawn at random, and their values as numbers: not a word about any notation."""

from __future__ import annotations

import math

from hypothesis import strategies as st

from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological
from tests.unit.notation.mathml_reader import AREA, RATE

VALUES = {"x": 0.7, "y": -1.3, "R": 2.5, "k": 0.4}
ONE = {"tanh": math.tanh, "exp": math.exp, "abs": abs, "sin": math.sin,
        "ssq": lambda x: x * abs(x), "sqrt": lambda x: math.sqrt(x), "sign": lambda x: x and
        math.copysign(1, x), "ssqrt": lambda x: math.copysign(math.sqrt(abs(x)), x)}  # fmt: skip


def value(expr: Expr) -> float:
    """The expression as numbers, with D and Int as factors."""
    done: dict[Expr, float] = {}
    for n in topological([expr]):
        args = [done[a] for a in n.args]
        match n.op:
            case Op.NUM:
                done[n] = float(n.number)
            case Op.SYM:
                done[n] = VALUES[n.symbol.name]
            case Op.ADD:
                done[n] = sum(float(c) * a for c, a in zip(n.coefficients, args, strict=True))
            case Op.MUL:
                done[n] = math.prod(a**e for a, e in zip(args, n.exponents, strict=True))
            case Op.DER:
                done[n] = RATE * args[0]
            case Op.INT:
                done[n] = AREA * args[0]
            case Op.FN:
                done[n] = ONE[n.name](args[0])
    return done[expr]


@st.composite
def expressions(draw: st.DrawFn) -> Expr:
    """Sums, products, powers, functions, derivatives and integrals inside each other."""
    p = Pool()
    found = [p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR), p.symbol("R", Kind.PARAM),
             p.symbol("k", Kind.PARAM)]  # fmt: skip
    coefficients = st.fractions(-4, 4, max_denominator=5)
    for _ in range(draw(st.integers(2, 12))):
        a, b, c = (draw(st.sampled_from(found)) for _ in range(3))
        match draw(st.sampled_from("+++**/dif^")):
            case "+":
                made = p.add((draw(coefficients), a), (draw(coefficients), b), (1, c))
            case "*":
                made = p.mul(a, b, p.power(c, draw(st.integers(1, 3))))
            case "/":
                made = a if b is p.zero else p.div(a, b)
            case "d":
                made = p.der(a)
            case "i":
                made = p.integral(a, p.symbol("0", Kind.INITIAL))
            case "f":
                made = p.fn(draw(st.sampled_from(sorted(ONE))), a)
            case _:
                made = p.power(p.add((1, a), (2, b)), draw(st.sampled_from([2, 3])))
        found.append(made)
    return found[-1]
