"""The numbers that a model gives its parameters, as far as it gives them."""

from __future__ import annotations

import math

from bondgraph.ir.expr import Expr, Op, topological
from bondgraph.ir.graph import BondGraph

_FUNCTIONS = {
    "abs": abs,
    "sqrt": math.sqrt,
    "cbrt": math.cbrt,
    "exp": math.exp,
    "log": math.log,
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "asin": math.asin,
    "acos": math.acos,
    "atan": math.atan,
    "sinh": math.sinh,
    "cosh": math.cosh,
    "tanh": math.tanh,
    "asinh": math.asinh,
    "acosh": math.acosh,
    "atanh": math.atanh,
    "pow": math.pow,
    "atan2": math.atan2,
    "min": min,
    "max": max,
    "sign": lambda x: math.copysign(1.0, x) if x else 0.0,
    "ssqrt": lambda x: math.copysign(math.sqrt(abs(x)), x),
    "ssq": lambda x: x * abs(x),
}


class Nominal:
    """Nominal values of expressions of parameters, in SI units."""

    def __init__(self, graph: BondGraph) -> None:
        self._known: dict[Expr, float | None] = {}
        self._given = {v.symbol: v.value for v in graph.values}
        self._given |= {
            p.initial: p.initial_value
            for n in graph.nodes
            for p in n.ports
            if p.initial is not None
        }

    def value(self, expr: Expr) -> float | None:
        """The nominal value; None where a part has none (a symbolic parameter, a signal)."""
        for node in topological([expr], stop=self._known.__contains__):
            if node in self._known:
                continue
            self._known[node] = None  # also the answer for a definition that runs in a circle
            if node.op is Op.SYM:
                given = self._given.get(node)
                self._known[node] = None if given is None else self.value(given)
            else:
                args = [self._known[a] for a in node.args]
                numbers = [a for a in args if a is not None]
                if len(numbers) == len(args):
                    self._known[node] = _apply(node, numbers)
        return self._known[expr]

    def vanishes(self, expr: Expr) -> bool:
        """Whether a coefficient is zero at the nominal values, next to the size of its terms.

        A leak that is nominally zero, or a bridge that is nominally in balance: dividing by it
        gives a relation that has no value on the healthy machine.
        """
        if expr.op is Op.NUM:
            return not expr.number
        value = self.value(expr)
        if value is None:
            return False
        size = abs(value)
        for node in topological([expr]):
            if node.op is Op.ADD:
                for c, arg in zip(node.coefficients, node.args, strict=True):
                    size = max(size, abs(float(c) * (self._known.get(arg) or 0.0)))
        return abs(value) <= 1e-12 * size


def defined(expr: Expr, variable: Expr, at: float) -> bool:
    """Whether an expression has a value when the variable has one, and all else is one."""
    values: dict[Expr, float] = {}
    for node in topological([expr]):
        if node.op is Op.SYM:
            values[node] = at if node is variable else 1.0
            continue
        if node.op in (Op.FN, Op.NUM, Op.ADD, Op.MUL):
            value = _apply(node, [values[a] for a in node.args])
            if value is None and not (node.op is Op.FN and node.name not in _FUNCTIONS):
                return False
            values[node] = 1.0 if value is None else value
        else:
            values[node] = 1.0
    return True


def _apply(node: Expr, args: list[float]) -> float | None:
    try:
        match node.op:
            case Op.NUM:
                return float(node.number)
            case Op.ADD:
                terms = zip(node.coefficients, args, strict=True)
                return math.fsum(float(c) * a for c, a in terms)
            case Op.MUL:
                return math.prod(a**e for a, e in zip(args, node.exponents, strict=True))
            case Op.FN if node.name in _FUNCTIONS:
                return float(_FUNCTIONS[node.name](*args))  # type: ignore[operator]
            case _:
                return None
    except (ArithmeticError, ValueError):
        return None
