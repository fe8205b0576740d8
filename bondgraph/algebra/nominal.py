"""The numbers that a model gives its parameters, as far as it gives them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from bondgraph.ir.expr import Expr, Op, topological
from bondgraph.ir.graph import BondGraph

if TYPE_CHECKING:
    from flint import arb

#: What an expression may call, on doubles.
FUNCTIONS: dict[str, Callable[..., Any]] = {
    **{
        name: getattr(math, name)
        for name in "sqrt cbrt exp log sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh"
        " pow atan2".split()
    },
    "abs": abs,
    "min": min,
    "max": max,
    "sign": lambda x: math.copysign(1.0, x) if x else 0.0,
    "ssqrt": lambda x: math.copysign(math.sqrt(abs(x)), x),
    "ssq": lambda x: x * abs(x),
}

#: How far off one operation may be, next to its largest term: some roundings of double precision,
#: as parameters are often rounded decimals of one another.
_ROUNDING = 1e-15
_BITS = 512  # of the numbers that decide where doubles cannot


class Nominal:
    """Nominal values of expressions of parameters, in SI units.

    `replaced` are parameters of a machine, by name, that have another value than the model says.
    """

    def __init__(self, graph: BondGraph, replaced: Mapping[str, float] | None = None) -> None:
        other = replaced or {}
        self._known: dict[Expr, float | None] = {
            v.symbol: float(other[v.name]) for v in graph.values if v.name in other
        }
        self._replaced = frozenset(self._known)
        self._doubts: dict[Expr, float] = {}
        self._sharp: dict[Expr, arb | None] = {}
        self._nothing: dict[Expr, bool] = {}
        self._given = {v.symbol: v.value for v in graph.values}
        self._given |= {
            p.initial: p.initial_value
            for n in graph.nodes
            for p in n.ports
            if p.initial is not None
        }
        self._given |= {i.initial: i.initial_value for i in graph.integrals}

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
        gives a relation that has no value on the healthy machine. So does a signal times a leak.
        """
        if expr.op is Op.NUM:
            return not expr.number
        for node in topological([expr], stop=self._nothing.__contains__):
            if node not in self._nothing:
                self._nothing[node] = self._vanishes(node)
        return self._nothing[expr]

    def _vanishes(self, node: Expr) -> bool:
        """`vanishes` of a node whose arguments are known."""
        value = self.value(node)
        if value is not None:
            return abs(value) <= self._doubt(node) and self._sharply_zero(node)
        if node.op is Op.MUL:
            factors = zip(node.args, node.exponents, strict=True)
            return any(exponent > 0 and self._nothing[a] for a, exponent in factors)
        return node.op in (Op.ADD, Op.DER) and all(self._nothing[a] for a in node.args)

    def _sharply_zero(self, expr: Expr) -> bool:
        """Whether a value that doubles cannot tell from zero is zero, as far as 150 digits tell.

        After hundreds of eliminations the error that doubles may have is larger than any value.
        What is left of terms that are rounded decimals of one another is nothing.
        """
        from flint import ctx  # few models get here, and `check` starts without it

        with ctx.workprec(_BITS):
            for node in topological([expr], stop=self._sharp.__contains__):
                if node not in self._sharp:
                    self._sharp[node] = self._sharp_value(node)
        found = self._sharp[expr]
        return found is None or bool(found.contains(0))

    def _sharp_value(self, node: Expr) -> arb | None:
        """The value of a node as a ball; None where doubles alone know how to find it."""
        from flint import arb, fmpq

        if node.op is Op.SYM:
            given = self._given.get(node) if node not in self._replaced else None
            if given is None or given.op is not Op.NUM:
                value = self.value(node)
                return None if value is None else arb(value)
            node = given
        if node.op is Op.NUM:
            return arb(fmpq(node.number.numerator, node.number.denominator))
        args = [x for a in node.args if (x := self._sharp[a]) is not None]
        if len(args) < len(node.args):
            return None
        if node.op is Op.MUL:
            factors = list(zip(args, node.exponents, strict=True))
            if any(e < 0 and x.contains(0) for x, e in factors):
                return None
            return math.prod([x**e for x, e in factors], start=arb(1))
        if node.op is Op.ADD:
            terms = [
                x * fmpq(c.numerator, c.denominator)
                for c, x in zip(node.coefficients, args, strict=True)
            ]
            total = sum(terms, start=arb(0))
            largest = max(abs(t).mid() for t in terms)
            return arb(0) if abs(total) <= largest * _ROUNDING else total
        value = self.value(node)
        return None if value is None else arb(value)

    def size(self, coefficient: Expr) -> float:
        """The nominal value of a coefficient: zero if it vanishes, one if the model gives none."""
        if self.vanishes(coefficient):
            return 0.0
        value = self.value(coefficient)
        return 1.0 if value is None else value

    def _doubt(self, expr: Expr) -> float:
        """A bound on the rounding error of `value` (running error analysis, Wilkinson 1963)."""
        for node in topological([expr], stop=self._doubts.__contains__):
            if node not in self._doubts:
                self._doubts[node] = self._rounding(node)
        return self._doubts[expr]

    def _rounding(self, node: Expr) -> float:
        own = abs(self._known.get(node) or 0.0)
        if node.op is Op.ADD:
            size, inherited = own, 0.0
            for c, arg in zip(node.coefficients, node.args, strict=True):
                weight = abs(float(c))
                size = max(size, weight * abs(self._known.get(arg) or 0.0))
                inherited += weight * self._doubts[arg]
            return inherited + _ROUNDING * size
        if node.op is Op.MUL:
            inherited = 0.0
            for exponent, arg in zip(node.exponents, node.args, strict=True):
                factor = abs(self._known.get(arg) or 0.0)
                if factor:
                    inherited += abs(exponent) * self._doubts[arg] / factor
            return own * (inherited + _ROUNDING)
        return _ROUNDING * own


def defined(expr: Expr, variable: Expr, at: float) -> bool:
    """Whether an expression has a value when the variable has one, and all else is one."""
    values: dict[Expr, float] = {}
    for node in topological([expr]):
        if node.op is Op.SYM:
            values[node] = at if node is variable else 1.0
            continue
        if node.op in (Op.FN, Op.NUM, Op.ADD, Op.MUL):
            value = _apply(node, [values[a] for a in node.args])
            if value is None and not (node.op is Op.FN and node.name not in FUNCTIONS):
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
            case Op.FN if node.name in FUNCTIONS:
                return float(FUNCTIONS[node.name](*args))
            case Op.DER:
                return 0.0
            case Op.IF:
                return args[1] if args[0] else args[2]
            case Op.CMP:
                left, right = args
                holds = {"<": left < right, "<=": left <= right, "==": left == right}
                return float(holds[node.name])
            case Op.LOGIC if node.name == "not":
                return float(not args[0])
            case Op.LOGIC:
                return float((all if node.name == "and" else any)(args))
            case _:
                return None
    except (ArithmeticError, ValueError):
        return None
