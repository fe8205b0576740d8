"""Numbers for parameters and coefficients: nominal values, and how much one depends on another."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from fractions import Fraction
from operator import mul
from typing import Any, TypeAlias, cast

from bondgraph.field.evaluation import Evaluated
from bondgraph.ir.expr import Expr, Op, topological
from bondgraph.ir.graph import BondGraph

Number: TypeAlias = float | Fraction | int

#: The functions of `bondgraph.ir.functions` on doubles; some of them keep a fraction a fraction.
DOUBLES: dict[str, Callable[..., Any]] = {
    **{
        name: getattr(math, name)
        for name in "sqrt cbrt exp log sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh"
        " pow atan2".split()
    },
    "abs": abs,
    "min": min,
    "max": max,
    "sign": lambda x: 1 if x > 0 else -1 if x < 0 else x,
    "ssqrt": lambda x: math.copysign(math.sqrt(abs(x)), x),
    "ssq": lambda x: x * abs(x),
}


def _compare(node: Expr, args: list[Any]) -> bool:
    left, right = args
    if node.name == "==":
        return bool(left == right)
    return bool(left < right if node.name == "<" else left <= right)


def _logic(node: Expr, args: list[Any]) -> bool:
    if node.name == "not":
        return not args[0]
    return all(args) if node.name == "and" else any(args)


def _function(node: Expr, args: list[Any]) -> Any:
    function = DOUBLES.get(node.name)
    return None if function is None else function(*args)


#: Rational numbers, as long as functions leave them rational; then doubles.
EXACT: dict[Op, Callable[[Expr, list[Any]], Any]] = {
    Op.NUM: lambda node, _: node.number,
    Op.ADD: lambda node, args: sum(map(mul, node.coefficients, args)),
    Op.MUL: lambda node, args: math.prod(map(pow, map(_rational, args), node.exponents)),
    Op.FN: _function,
    Op.IF: lambda _, args: args[1] if args[0] else args[2],
    Op.CMP: _compare,
    Op.LOGIC: _logic,
}


def _rational(x: Any) -> Any:
    return Fraction(x) if isinstance(x, int) else x


def evaluate(root: Expr, values: Mapping[str, Number]) -> Number | None:
    """The value of a constant expression; None where a symbol has none or it is not defined.

    Rational arithmetic stays exact as long as the values are rational.
    """
    return Valued(values).value(root)


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


def declared_zero(graph: BondGraph, numbers: Mapping[str, Number | None]) -> tuple[str, ...]:
    """The faults that are declared to be zero, whatever number stands in their place."""
    return tuple(v.name for v in graph.values if v.fault and (v.zero or numbers.get(v.name) == 0))


class Valued(Evaluated[Number]):
    """Constant expressions where symbols have numbers, by name; what was found once is kept.

    `zeros` are declared to be zero, whatever their numbers are.
    """

    def __init__(self, values: Mapping[str, Number], zeros: Collection[str] = ()) -> None:
        super().__init__(EXACT, lambda node: values.get(node.symbol.name))
        self._zeros = frozenset(zeros)

    def sensitivities(self, weights: Mapping[Expr, float]) -> dict[str, float] | None:
        """theta * d sum / d theta of a weighted sum of expressions, by parameter.

        At the nominal values; d sum / d theta where theta is declared 0. One pass back over all
        expressions, as there may be hundreds of parameters (Linnainmaa, 1970). Not a number where a
        slope is not defined, None where the expressions have no value.
        """
        if any(self.value(root) is None for root in weights):
            return None
        adjoint = dict(weights)
        slopes: dict[str, float] = {}
        for node in reversed(topological(weights)):
            above = adjoint.get(node)
            if not above:
                continue
            value = float(cast(Number, self.known[node]))
            if node.op is Op.SYM:
                name = node.symbol.name
                slopes[name] = above * (1.0 if name in self._zeros else value or 1.0)
                continue
            own = [cast(Number, self.known[a]) for a in node.args]
            plain = node.op is Op.MUL and value and math.isfinite(value)
            for i, arg in enumerate(node.args):
                # of a product by a factor: all others at once
                slope = node.exponents[i] * value / float(own[i]) if plain else _slope(node, own, i)
                adjoint[arg] = adjoint.get(arg, 0.0) + above * slope
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
        high, low = (
            EXACT[node.op](node, [*args[:i], x, *args[i + 1 :]]) for x in (at + width, at - width)
        )
        return float(high - low) / (2 * width)
    except (ValueError, OverflowError, ZeroDivisionError):
        return math.nan
