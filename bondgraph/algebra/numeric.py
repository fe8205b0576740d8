"""Numbers for parameters and coefficients: nominal values, and how much one depends on another."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any, TypeAlias

from bondgraph.ir.expr import Expr, Op, topological
from bondgraph.ir.graph import BondGraph

Number: TypeAlias = float | Fraction | int

_PLAIN: dict[str, Callable[..., float]] = {
    name: getattr(math, name)
    for name in (
        "sqrt exp log sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh pow atan2"
    ).split()
}


def function(name: str, args: tuple[Any, ...]) -> Any:
    """A function of `FUNCTIONS` at numbers; raises ValueError outside its domain."""
    x = args[0]
    match name:
        case "abs":
            return abs(x)
        case "sign":
            return (x > 0) - (x < 0)
        case "ssq":
            return x * abs(x)
        case "cbrt":
            return math.copysign(abs(float(x)) ** (1 / 3), x)
        case "ssqrt":
            return math.copysign(math.sqrt(abs(x)), x)
        case "min":
            return min(args)
        case "max":
            return max(args)
        case _:
            return _PLAIN[name](*args)


def evaluate(root: Expr, values: Mapping[str, Number]) -> Number | None:
    """The value of a constant expression; None where a symbol has none or it is not defined.

    Rational arithmetic stays exact as long as the values are rational.
    """
    found = evaluate_all([root], values)
    return None if found is None else found[root]


def evaluate_all(roots: Sequence[Expr], values: Mapping[str, Number]) -> dict[Expr, Number] | None:
    """The values of constant expressions and of all that they are made of; None as `evaluate`."""
    found: dict[Expr, Number] = {}
    try:
        for node in topological(roots):
            value = _one(node, [found[a] for a in node.args], values)
            if value is None:
                return None
            found[node] = value
    except (ValueError, OverflowError, ZeroDivisionError):
        return None
    return found


def _one(node: Expr, args: list[Number], values: Mapping[str, Number]) -> Any:
    match node.op:
        case Op.NUM:
            return node.number
        case Op.SYM:
            return values.get(node.symbol.name)
        case Op.ADD:
            total: Number = 0
            for c, a in zip(node.coefficients, args, strict=True):
                total = total + (c * a if isinstance(a, Fraction | int) else float(c) * a)
            return total
        case Op.MUL:
            product: Number = 1
            for a, e in zip(args, node.exponents, strict=True):
                product = product * (Fraction(a) if isinstance(a, int) else a) ** e
            return product
        case Op.FN if not node.name.startswith("table:"):
            return function(node.name, tuple(args))
        case Op.IF:
            return args[1] if args[0] else args[2]
        case Op.CMP:
            left, right = args
            return {"<": left < right, "<=": left <= right, "==": left == right}[node.name]
        case Op.LOGIC:
            if node.name == "not":
                return not args[0]
            return all(args) if node.name == "and" else any(args)
        case _:
            return None


def nominal(graph: BondGraph) -> dict[str, Fraction | float]:
    """The nominal values of parameters, constants and initial values, by name; those that have one.

    A value may be written in terms of others; exact as long as it is rational.
    """
    pending = [(v.symbol, v.value) for v in graph.values]
    pending += [(i.initial, i.initial_value) for i in graph.integrals]
    for node in graph.nodes:
        pending += [(p.initial, p.initial_value) for p in node.ports if p.initial is not None]
    found: dict[str, Fraction | float] = {}
    before = -1
    while len(found) != before:
        before = len(found)
        for symbol, value in pending:
            if value is None or symbol is None or symbol.op is not Op.SYM:
                continue
            if symbol.symbol.name not in found:
                number = evaluate(value, found)
                if number is not None:
                    name = symbol.symbol.name
                    found[name] = number if isinstance(number, float) else Fraction(number)
    return found


def sensitivities(
    weights: Mapping[Expr, float], values: Mapping[str, float]
) -> dict[str, float] | None:
    """theta * d sum / d theta of a weighted sum of constant expressions, by parameter.

    At the nominal values; d sum / d theta where theta is 0. One pass back over all expressions, as
    there may be hundreds of parameters (Linnainmaa, 1970). Not a number where a slope is not
    defined, None where the expressions have no value.
    """
    found = evaluate_all(list(weights), values)
    if found is None:
        return None
    adjoint = dict.fromkeys(found, 0.0)
    for root, weight in weights.items():
        adjoint[root] += weight
    slopes: dict[str, float] = {}
    for node in reversed(found):
        above = adjoint[node]
        if not above:
            continue
        if node.op is Op.SYM:
            slopes[node.symbol.name] = above * (values[node.symbol.name] or 1.0)
            continue
        own = [found[a] for a in node.args]
        for i, arg in enumerate(node.args):
            adjoint[arg] += above * _slope(node, own, i)
    return slopes


def _slope(node: Expr, args: list[Number], i: int) -> float:
    """The partial derivative of a node by one of its arguments, at their values."""
    if node.op is Op.ADD:
        return float(node.coefficients[i])
    try:
        if node.op is Op.MUL:
            product = float(node.exponents[i]) * float(args[i]) ** (node.exponents[i] - 1)
            for k, (arg, exponent) in enumerate(zip(args, node.exponents, strict=True)):
                if k != i:
                    product *= float(arg) ** exponent
            return product
        if node.op is not Op.FN and i == 0:
            return 0.0  # a condition
        at = float(args[i])
        width = 2.0**-20 * (abs(at) or 1.0)
        high = _one(node, [*args[:i], at + width, *args[i + 1 :]], {})
        low = _one(node, [*args[:i], at - width, *args[i + 1 :]], {})
        return float(high - low) / (2 * width)
    except (ValueError, OverflowError, ZeroDivisionError):
        return math.nan
