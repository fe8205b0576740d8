"""Expressions at a random point of a prime field: exact questions, answered by numbers.

An expression that is not zero vanishes at a random point with a probability of about its degree
divided by 2**61 (Schwartz, 1980; Zippel, 1979). Symbols, functions and derivatives are numbers that
have nothing to do with each other, the same wherever they stand for the same; so what holds only by
an identity of functions is not seen, but for sin^2 + cos^2 = 1, and the answer can err towards "not
zero" alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from operator import mul
from zlib import crc32

from bondgraph.field.evaluation import Evaluated
from bondgraph.field.prime import P
from bondgraph.ir.expr import Expr, Op, Rational, topological


class RandomPoint(Evaluated[int]):
    """Values and slopes of expressions at one random point; the point is the same for one seed.

    `given` are the expressions of which some symbols have the values.

    >>> from bondgraph.ir.expr import Kind, Pool
    >>> p = Pool(); a, b = p.symbol("a", Kind.PARAM), p.symbol("b", Kind.PARAM)
    >>> RandomPoint(1).value(p.sub(p.scale(2, a), a)) == RandomPoint(1).value(a)
    True
    >>> sine, cosine = (p.power(p.fn(name, a), 2) for name in ("sin", "cos"))
    >>> RandomPoint(1).value(p.add((1, sine), (1, cosine)))
    1
    """

    def __init__(self, seed: int, given: Mapping[Expr, Expr] | None = None) -> None:
        self._seed = seed
        self._given = given or {}
        super().__init__({**dict.fromkeys(Op, self._apart), **_RESIDUES}, self._symbol)

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

    def _symbol(self, symbol: Expr) -> int | None:
        given = self._given.get(symbol)
        return self._drawn(symbol.symbol.name) if given is None else self.value(given)

    def _apart(self, node: Expr, args: list[int]) -> int:
        """What is no sum and no product: the same number for the same arguments."""
        if node.op is Op.FN and node.name in ("sin", "cos"):
            half = self._drawn(f"tan of half of {args}")  # -1 has no root: P is 3 modulo 4
            upper = 2 * half if node.name == "sin" else 1 - half * half
            return upper * pow(1 + half * half, -1, P) % P
        data = node.root.zero.id if node.op is Op.ROOT else node.data
        return self._drawn(f"{node.op.value}:{data}:{args}")

    def _slope(self, node: Expr, at: int, rate: int | None) -> int:
        """The derivative of a node by one of its arguments."""
        if node.op is Op.ADD:
            return residue(node.coefficients[at])
        if node.order:
            return pow(rate, node.order, P) if rate else 0
        if node.op is Op.MUL:
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


def residue(value: Rational) -> int:
    """A rational number modulo the prime; raises ValueError where that divides its denominator."""
    if value.denominator == 1:
        return value.numerator % P
    return value.numerator * pow(value.denominator, -1, P) % P


def _product(node: Expr, args: list[int]) -> int:
    value = 1
    for exponent, x in zip(node.exponents, args, strict=True):
        value = value * (x if exponent == 1 else pow(x, exponent, P)) % P
    return value


#: Arithmetic modulo the prime; a division by zero has no value.
_RESIDUES: dict[Op, Callable[[Expr, list[int]], int]] = {
    Op.NUM: lambda node, _: residue(node.number),
    Op.ADD: lambda node, args: sum(map(mul, map(residue, node.coefficients), args)) % P,
    Op.MUL: _product,
}
