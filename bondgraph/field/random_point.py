"""Expressions at a random point of a prime field: exact questions, answered by numbers.

An expression that is not zero vanishes at a random point with a probability of about its degree
divided by 2**61 (Schwartz, 1980; Zippel, 1979). Symbols, functions and derivatives are numbers that
have nothing to do with each other, the same wherever they stand for the same; so what holds only by
an identity of functions is not seen, and the answer can err towards "not zero" alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from zlib import crc32

from bondgraph.field.prime import P
from bondgraph.ir.expr import Expr, Op, topological


class RandomPoint:
    """Values and slopes of expressions at one random point; the point is the same for one seed.

    `given` are the expressions of which some symbols have the values.

    >>> from bondgraph.ir.expr import Kind, Pool
    >>> p = Pool(); a, b = p.symbol("a", Kind.PARAM), p.symbol("b", Kind.PARAM)
    >>> RandomPoint(1).value(p.sub(p.scale(2, a), a)) == RandomPoint(1).value(a)
    True
    """

    def __init__(self, seed: int, given: Mapping[Expr, Expr] | None = None) -> None:
        self._seed = seed
        self._given = given or {}
        self._values: dict[Expr, int | None] = {}

    def value(self, expr: Expr) -> int | None:
        """The value at the point; None where a part of it divides by zero there."""
        for node in topological([expr], stop=self._values.__contains__):
            if node not in self._values:
                self._values[node] = self._value(node)
        return self._values[expr]

    def gradient(
        self, zero: Expr, wanted: Callable[[Expr], bool], rate: int | None = None
    ) -> dict[Expr, int]:
        """The derivative by each symbol that is wanted, where it is not zero.

        Functions have random slopes. d/dt is multiplication by `rate`; without one, a derivative or
        an integral does not answer what it is made of.
        """
        rows: dict[Expr, dict[Expr, int]] = {}
        for node in topological([zero]):
            total = {node: 1} if node.op is Op.SYM and wanted(node) else {}
            for k, arg in enumerate(node.args):
                slope = self._slope(node, k, rate) if rows[arg] else 0
                for variable, c in rows[arg].items() if slope else ():
                    total[variable] = (total.get(variable, 0) + slope * c) % P
            rows[node] = total
        return {v: c for v, c in rows[zero].items() if c}

    def _value(self, node: Expr) -> int | None:
        args = [x for a in node.args if (x := self._values[a]) is not None]
        if len(args) < len(node.args):
            return None
        match node.op:
            case Op.NUM:
                return _quotient(node.number.numerator, node.number.denominator)
            case Op.SYM if node in self._given:
                return self.value(self._given[node])
            case Op.SYM:
                return self._drawn(node.symbol.name)
            case Op.ADD:
                terms = zip(node.coefficients, args, strict=True)
                return sum(_quotient(c.numerator, c.denominator) * x for c, x in terms) % P
            case Op.MUL:
                product = 1
                for x, exponent in zip(args, node.exponents, strict=True):
                    if not x and exponent < 0:
                        return None
                    product = product * pow(x, exponent, P) % P
                return product
        data = node.root.zero.id if node.op is Op.ROOT else node.data
        return self._drawn(f"{node.op.value}:{data}:{args}")

    def _slope(self, node: Expr, at: int, rate: int | None) -> int:
        """The derivative of a node by one of its arguments."""
        match node.op:
            case Op.ADD:
                c = node.coefficients[at]
                return _quotient(c.numerator, c.denominator)
            case Op.DER:
                return rate or 0
            case Op.INT:
                return pow(rate, -1, P) if rate else 0
            case Op.MUL:
                product = node.exponents[at]
                for k, (arg, exponent) in enumerate(node.factors):
                    product = product * self._power(arg, exponent - (k == at)) % P
                return product
        return self._drawn(f"slope:{node.id}:{at}")

    def _power(self, node: Expr, exponent: int) -> int:
        x = self.value(node)
        if x is None or (not x and exponent < 0):  # that it has no value is for others to find
            return self._drawn(f"power:{node.id}:{exponent}")
        return pow(x, exponent, P)

    def _drawn(self, key: str) -> int:
        """A number that depends on the key alone, and not on the hash seed."""
        data = f"{self._seed}:{key}".encode()
        return (crc32(data) << 29 ^ crc32(data[::-1]) * 0x9E3779B97F4A7C15) % P


def _quotient(numerator: int, denominator: int) -> int:
    return numerator * (1 if denominator == 1 else pow(denominator, -1, P)) % P
