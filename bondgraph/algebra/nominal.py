"""The numbers that a model gives its parameters, as far as it gives them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import cached_property
from operator import mul
from typing import TYPE_CHECKING

from bondgraph.algebra.numeric import DOUBLES, EXACT
from bondgraph.field.evaluation import Evaluated
from bondgraph.ir.expr import Expr, Op, topological
from bondgraph.ir.graph import BondGraph

if TYPE_CHECKING:
    from flint import arb

#: Doubles; a sum is rounded once, and what does not change has no derivative.
_DOUBLES: dict[Op, Callable[[Expr, list[float]], float | None]] = {
    **EXACT,
    Op.NUM: lambda node, _: float(node.number),
    Op.ADD: lambda node, args: math.fsum(map(mul, map(float, node.coefficients), args)),
    Op.MUL: lambda node, args: math.prod(map(pow, args, node.exponents)),
    Op.DER: lambda *_: 0.0,
}

#: How far off one operation may be, next to its largest term: some roundings of double precision,
#: as parameters are often rounded decimals of one another.
_ROUNDING = 1e-15
_CANCELS = 0.25  # of the sum of its terms, each as large as it is: less is left of few sums
_BITS = 512  # of the numbers that decide where doubles cannot


class Nominal:
    """Nominal values of expressions of parameters, in SI units.

    `replaced` are parameters of a machine, by name, that have another value than the model says.
    """

    def __init__(self, graph: BondGraph, replaced: Mapping[str, float] | None = None) -> None:
        other = replaced or {}
        own = {v.symbol: float(other[v.name]) for v in graph.values if v.name in other}
        self._replaced = frozenset(own)
        self._at = Evaluated(_DOUBLES, self._of_symbol, own)
        self._doubts: dict[Expr, float] = {}
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
        found = self._at.value(expr)
        return None if found is None else float(found)

    def _of_symbol(self, symbol: Expr) -> float | None:
        given = self._given.get(symbol)
        return None if given is None else self.value(given)

    def vanishes(self, expr: Expr) -> bool:
        """Whether a coefficient is zero at the nominal values, next to the size of its terms.

        A leak that is nominally zero, or a bridge that is nominally in balance: dividing by it
        gives a relation that has no value on the healthy machine. So does a signal times a leak.
        """
        if expr.op is Op.NUM:
            return not expr.number
        if expr not in self._nothing:
            self.value(expr)  # of all that it is made of, in one pass, and so is the next
            self._doubt(expr)
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
            factors = node.factors
            return any(exponent > 0 and self._nothing[a] for a, exponent in factors)
        return node.op in (Op.ADD, Op.DER) and all(self._nothing[a] for a in node.args)

    def _sharply_zero(self, expr: Expr) -> bool:
        """Whether a value that doubles cannot tell from zero is zero, as far as 150 digits tell.

        After hundreds of eliminations the error that doubles may have is larger than any value.
        What is left of terms that are rounded decimals of one another is nothing.
        """
        from flint import ctx  # few models get here, and `check` starts without it

        with ctx.workprec(_BITS):
            found = self._balls.value(expr)
        return found is None or bool(found.contains(0))

    @cached_property
    def _balls(self) -> Evaluated[arb]:
        """Values as balls; where doubles alone know how to find one, theirs."""
        from flint import arb, fmpq

        def of_symbol(node: Expr) -> arb | None:
            given = self._given.get(node) if node not in self._replaced else None
            return in_double(node) if given is None or given.op is not Op.NUM else number(given)

        def number(node: Expr, _: object = None) -> arb:
            return arb(fmpq(node.number.numerator, node.number.denominator))

        def in_double(node: Expr, _: object = None) -> arb | None:
            value = self.value(node)
            return None if value is None else arb(value)

        def product(node: Expr, args: list[arb]) -> arb | None:
            factors = list(zip(args, node.exponents, strict=True))
            if any(e < 0 and x.contains(0) for x, e in factors):
                return None
            return math.prod([x**e for x, e in factors], start=arb(1))

        def total(node: Expr, args: list[arb]) -> arb:
            terms = [
                x * fmpq(c.numerator, c.denominator)
                for c, x in zip(node.coefficients, args, strict=True)
            ]
            found = sum(terms, start=arb(0))
            largest = max(abs(t).mid() for t in terms)
            return arb(0) if abs(found) <= largest * _ROUNDING else found

        other = dict.fromkeys(Op, in_double)
        return Evaluated({**other, Op.NUM: number, Op.ADD: total, Op.MUL: product}, of_symbol)

    def cancels(self, expr: Expr) -> bool:
        """Whether the terms of a sum nearly cancel at the nominal values.

        What is divided by it is as much larger, and a term that is off by a tenth leaves nothing
        of the sum, or turns its sign.
        """
        value = self.value(expr) if expr.op is Op.ADD else None
        if value is None:
            return False
        sizes = [abs(float(c) * (self.value(arg) or 0.0)) for c, arg in expr.terms]
        return abs(value) < _CANCELS * sum(sizes)

    def size(self, coefficient: Expr) -> float:
        """The nominal value of a coefficient: zero if it vanishes, one if the model gives none."""
        if self.vanishes(coefficient):
            return 0.0
        value = self.value(coefficient)
        return 1.0 if value is None else value

    def _doubt(self, expr: Expr) -> float:
        """A bound on the rounding error of `value` (running error analysis, Wilkinson 1963)."""
        if expr not in self._doubts:
            for node in topological([expr], stop=self._doubts.__contains__):
                if node not in self._doubts:
                    self._doubts[node] = self._rounding(node)
        return self._doubts[expr]

    def _rounding(self, node: Expr) -> float:
        own = abs(self._at.known.get(node) or 0.0)
        if node.op is Op.ADD:
            size, inherited = own, 0.0
            for c, arg in node.terms:
                weight = abs(float(c))
                size = max(size, weight * abs(self._at.known.get(arg) or 0.0))
                inherited += weight * self._doubts[arg]
            return inherited + _ROUNDING * size
        if node.op is Op.MUL:
            inherited = 0.0
            for exponent, arg in zip(node.exponents, node.args, strict=True):
                factor = abs(self._at.known.get(arg) or 0.0)
                if factor:
                    inherited += abs(exponent) * self._doubts[arg] / factor
            return own * (inherited + _ROUNDING)
        return _ROUNDING * own


def defined(expr: Expr, variable: Expr, at: float) -> bool:
    """Whether an expression has a value when the variable has one, and all else is one."""
    point = Evaluated(_SOME, lambda node: at if node is variable else 1.0)
    return point.value(expr) is not None


#: What tells where an expression has no value: sums, products and functions.
_SOME: dict[Op, Callable[[Expr, list[float]], float | None]] = {
    **dict.fromkeys(Op, lambda *_: 1.0),
    **{op: _DOUBLES[op] for op in (Op.NUM, Op.ADD, Op.MUL)},
    Op.FN: lambda node, args: _DOUBLES[Op.FN](node, args) if node.name in DOUBLES else 1.0,
}
