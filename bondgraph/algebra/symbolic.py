"""Expressions to SymPy and back: the algebra behind closed forms and inversions of laws."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

import sympy as sp
from sympy.logic.boolalg import Boolean

from bondgraph.field.evaluation import Evaluated
from bondgraph.ir.expr import KNOWN_SIGNALS, Expr, Op, Pool, Symbol
from bondgraph.ir.past import past_of

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
#: Functions that SymPy writes by several of its own, which it cannot turn around.
WRITTEN_OUT = ("abs", "sign", "ssqrt", "ssq", "cbrt", "min", "max")
_NAMES = {f: name for name, f in _FUNCTIONS.items() if isinstance(f, type)}
_COMPARE: dict[str, Callable[..., Any]] = {"<": sp.Lt, "<=": sp.Le, "==": sp.Eq}
_LOGIC: dict[str, Callable[..., Any]] = {"and": sp.And, "or": sp.Or, "not": sp.Not}


def to_sympy(
    expr: Expr,
    leaves: Mapping[Expr, Any] | None = None,
    starts: Mapping[Symbol, Expr] | None = None,
) -> Any:
    """The expression as a SymPy one, nested as it is.

    Parameters become real symbols, one named `t` that of `constant t`, known signals functions of
    the time `t`, D a `Derivative`, and an integral from the start `Integral(x, (t, 0, t)) + x0`.
    `leaves` overrides single nodes, `starts` gives the values from which integrals begin.
    """
    begins = starts or {}

    def integral(node: Expr, args: list[Any]) -> Any:
        start = begins.get(node.symbol)
        own = _parameter(node.symbol.name) if start is None else point.value(start)
        return sp.Integral(args[0], (t, 0, t)) + own

    point: Evaluated[Any] = Evaluated({**_OPERATIONS, Op.INT: integral}, _symbol, leaves)
    return point.value(expr)


def _symbol(node: Expr) -> Any:
    past = past_of(node.symbol.name)
    if past is not None:
        of, seconds = past
        return sp.Function(of, real=True)(t - sp.Rational(seconds.numerator, seconds.denominator))
    if node.symbol.kind in KNOWN_SIGNALS:
        return sp.Function(node.symbol.name, real=True)(t)
    return _parameter(node.symbol.name)


def _parameter(name: str) -> Any:
    # SymPy would take a parameter that is called t for the time
    return sp.Symbol("constant t" if name == "t" else name, real=True)


def _sum(node: Expr, args: list[Any]) -> Any:
    terms = zip(node.coefficients, args, strict=True)
    return sp.Add(*[sp.Rational(c.numerator, c.denominator) * a for c, a in terms])


def _function(node: Expr, args: list[Any]) -> Any:
    named = _FUNCTIONS.get(node.name)
    return named(*args) if named else sp.Function(node.name.replace(":", "_"))(*args)


def _derivative(_: Expr, args: list[Any]) -> Any:
    return sp.Derivative(args[0], (t, 1)) if args[0].has(t) else sp.Integer(0)


_OPERATIONS: dict[Op, Callable[[Expr, list[Any]], Any]] = {
    Op.NUM: lambda node, _: sp.Rational(node.number.numerator, node.number.denominator),
    Op.ADD: _sum,
    Op.MUL: lambda node, args: sp.Mul(*map(sp.Pow, args, node.exponents)),
    Op.FN: _function,
    Op.ROOT: lambda node, args: sp.Function(f"root_{node.root.name}")(*args),
    Op.DER: _derivative,
    Op.IF: lambda _, args: sp.Piecewise((args[1], _truth(args[0])), (args[2], True)),
    Op.CMP: lambda node, args: _COMPARE[node.name](*args),
    Op.LOGIC: lambda node, args: _LOGIC[node.name](*map(_truth, args)),
}


def _truth(value: Any) -> Any:
    """A mode signal stands for a condition: on is 1."""
    return value if isinstance(value, Boolean) else sp.Eq(value, 1)


def applied(name: str, *args: Any) -> Any:
    """A function of the language of SymPy arguments."""
    return _FUNCTIONS[name](*args)


def called(value: Any) -> str | None:
    """The name in the language of the function that a SymPy value is of, if it has one."""
    if value.is_Pow and value.base == sp.E:
        return "exp"
    return _NAMES.get(value.func)


def from_sympy(
    pool: Pool,
    value: Any,
    names: Mapping[Any, Expr],
    other: Callable[[Any], Expr | None] = lambda _: None,
) -> Expr | None:
    """A SymPy expression in the given symbols as one of ours; None if it cannot be written so.

    `other` may say what is neither arithmetic nor a function of one argument.
    """
    if value in names:
        return names[value]
    if value.is_Rational:
        return pool.num(Fraction(int(value.p), int(value.q)))
    if (found := other(value)) is not None:
        return found
    args = [from_sympy(pool, a, names, other) for a in value.args]
    known = [a for a in args if a is not None]
    if len(known) != len(args):
        return None
    if value.is_Add:
        return pool.add(*[(1, a) for a in known])
    if value.is_Mul:
        return pool.mul(*known)
    if value.is_Pow and value.exp.is_Integer:
        return pool.power(known[0], int(value.exp))
    if value.is_Pow and value.exp.is_Rational and value.exp.q == 2:
        return pool.power(pool.fn("sqrt", known[0]), int(value.exp.p))
    if value.is_Pow and value.exp.is_Rational:
        return pool.fn("pow", known[0], known[1])
    if value.is_Pow and value.base == sp.E:
        return pool.fn("exp", known[1])
    name = _NAMES.get(value.func)
    return pool.fn(name, *known) if name and len(known) == 1 else None
