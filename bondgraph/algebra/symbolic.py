"""Expressions to SymPy and back: the algebra behind closed forms and inversions of laws."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

import sympy as sp
from sympy.logic.boolalg import Boolean

from bondgraph.ir.expr import KNOWN_SIGNALS, Expr, Op, Pool, Symbol, topological

#: Time, on which every known signal depends in the SymPy form of a relation.
t = sp.Symbol("t", real=True)

_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "abs": sp.Abs,
    "sign": sp.sign,
    "sqrt": sp.sqrt,
    "cbrt": sp.cbrt,
    "ssqrt": lambda x: sp.sign(x) * sp.sqrt(sp.Abs(x)),
    "ssq": lambda x: x * sp.Abs(x),
    "pow": sp.Pow,
    "min": sp.Min,
    "max": sp.Max,
    "atan2": sp.atan2,
    "exp": sp.exp,
    "log": sp.log,
    "sin": sp.sin,
    "cos": sp.cos,
    "tan": sp.tan,
    "asin": sp.asin,
    "acos": sp.acos,
    "atan": sp.atan,
    "sinh": sp.sinh,
    "cosh": sp.cosh,
    "tanh": sp.tanh,
    "asinh": sp.asinh,
    "acosh": sp.acosh,
    "atanh": sp.atanh,
}
_NAMES = {f: name for name, f in _FUNCTIONS.items() if isinstance(f, type)}
_COMPARE: dict[str, Callable[..., Any]] = {"<": sp.Lt, "<=": sp.Le, "==": sp.Eq}
_LOGIC: dict[str, Callable[..., Any]] = {"and": sp.And, "or": sp.Or, "not": sp.Not}


def to_sympy(
    expr: Expr,
    leaves: Mapping[Expr, Any] | None = None,
    starts: Mapping[Symbol, Expr] | None = None,
) -> Any:
    """The expression as a SymPy one, nested as it is.

    Parameters become real symbols, known signals functions of `t`, D a `Derivative`, and an
    integral from the start `Integral(x, (t, 0, t)) + x0`. `leaves` overrides single nodes,
    `starts` gives the values from which integrals begin.
    """
    done: dict[Expr, Any] = dict(leaves or {})
    begins = starts or {}
    for node in topological([expr, *begins.values()], stop=done.__contains__):
        if node not in done:
            done[node] = _convert(node, [done[a] for a in node.args])
            if node.op is Op.INT:
                start = begins.get(node.symbol)
                own = sp.Symbol(node.symbol.name, real=True) if start is None else done[start]
                done[node] += own
    return done[expr]


def _convert(node: Expr, args: list[Any]) -> Any:
    match node.op:
        case Op.NUM:
            return sp.Rational(node.number.numerator, node.number.denominator)
        case Op.SYM:
            if node.symbol.kind in KNOWN_SIGNALS:
                return sp.Function(node.symbol.name, real=True)(t)
            return sp.Symbol(node.symbol.name, real=True)
        case Op.ADD:
            terms = zip(node.coefficients, args, strict=True)
            return sp.Add(*[sp.Rational(c.numerator, c.denominator) * a for c, a in terms])
        case Op.MUL:
            return sp.Mul(*[sp.Pow(a, e) for e, a in zip(node.exponents, args, strict=True)])
        case Op.FN:
            named = _FUNCTIONS.get(node.name)
            return named(*args) if named else sp.Function(node.name.replace(":", "_"))(*args)
        case Op.ROOT:
            return sp.Function(f"root_{node.root.name}")(*args)
        case Op.DER:
            inner, order = args[0], 1
            return sp.Derivative(inner, (t, order)) if inner.has(t) else sp.Integer(0)
        case Op.INT:
            return sp.Integral(args[0], (t, 0, t))
        case Op.IF:
            return sp.Piecewise((args[1], _truth(args[0])), (args[2], True))
        case Op.CMP:
            return _COMPARE[node.name](*args)
        case Op.LOGIC:
            return _LOGIC[node.name](*[_truth(a) for a in args])


def _truth(value: Any) -> Any:
    """A mode signal stands for a condition: on is 1."""
    return value if isinstance(value, Boolean) else sp.Eq(value, 1)


def from_sympy(pool: Pool, value: Any, names: Mapping[Any, Expr]) -> Expr | None:
    """A SymPy expression in the given symbols as one of ours; None if it cannot be written so."""
    if value in names:
        return names[value]
    if value.is_Rational:
        return pool.num(Fraction(int(value.p), int(value.q)))
    args = [from_sympy(pool, a, names) for a in value.args]
    known = [a for a in args if a is not None]
    if len(known) != len(args):
        return None
    if value.is_Add:
        return pool.add(*[(1, a) for a in known])
    if value.is_Mul:
        return pool.mul(*known)
    if value.is_Pow and value.exp.is_Integer:
        return pool.power(known[0], int(value.exp))
    if value.is_Pow and value.exp.is_Rational:
        return pool.fn("pow", known[0], known[1])
    if value.is_Pow and value.base == sp.E:
        return pool.fn("exp", known[1])
    name = _NAMES.get(value.func)
    return pool.fn(name, *known) if name and len(known) == 1 else None
