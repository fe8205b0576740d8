"""Decide whether an expression is identically zero, by its value at a random point of a field.

Schwartz (1980) and Zippel (1979): a rational expression that is not zero vanishes at a random
point modulo 2**61 - 1 with a probability below 1e-15 for the sizes met here. Functions and
derivatives count as independent unknowns of their arguments' values, which can only err towards
"not zero".
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from operator import mul
from zlib import crc32

from bondgraph.algebra.interpreter import Evaluated
from bondgraph.ir.expr import Expr, Op, Rational

PRIME = (1 << 61) - 1


def is_zero(expr: Expr) -> bool:
    """Whether `expr` vanishes identically; a division by zero at both points counts as not zero.

    >>> from bondgraph.ir.expr import Pool, Kind
    >>> p = Pool(); a = p.symbol("a", Kind.PARAM); b = p.symbol("b", Kind.PARAM)
    >>> square = p.power(p.add((1, a), (1, b)), 2)
    >>> cross = p.add((1, p.power(a, 2)), (2, p.mul(a, b)), (1, p.power(b, 2)))
    >>> is_zero(p.sub(square, cross))
    True
    """
    return all(_values([expr], seed)[expr] == 0 for seed in (1, 2))


def agree(pairs: Sequence[tuple[Expr, Expr]]) -> list[bool]:
    """Whether two expressions are identically equal, for each of the pairs, in one pass over all.

    Errs towards "not equal", as `is_zero` does; one that divides by zero at a point equals itself.

    >>> from bondgraph.ir.expr import Pool, Kind
    >>> p = Pool(); a = p.symbol("a", Kind.PARAM); b = p.symbol("b", Kind.PARAM)
    >>> agree([(p.add((2, p.add((1, a), (1, b))), (-2, b)), p.scale(2, a)), (a, b)])
    [True, False]
    """
    told = [(one, other) for one, other in pairs if one is not other]
    same = dict.fromkeys(told, True)
    for seed in (1, 2):
        at = _values([e for pair in told for e in pair], seed)
        for one, other in told:
            value = at[one]
            same[one, other] &= value is not None and value == at[other]
    return [one is other or same[one, other] for one, other in pairs]


def share_factor(a: list[Expr], b: list[Expr]) -> bool:
    """Whether two polynomials (coefficients from the constant up) have a common factor.

    Euclid's algorithm on their values at a random point; a division by zero there counts as yes.
    """
    at = _values([*a, *b], 3)
    left, right = ([at[c] for c in p] for p in (a, b))
    if None in left or None in right:
        return True
    one, other = _trimmed(left), _trimmed(right)
    while other:
        top = pow(other[-1], -1, PRIME)
        while len(one) >= len(other):
            factor = one[-1] * top % PRIME
            shift = len(one) - len(other)
            for k, c in enumerate(other):
                one[k + shift] = (one[k + shift] - factor * c) % PRIME
            one = _trimmed(one[:-1])
        one, other = other, one
    return len(one) > 1


def _trimmed(values: Sequence[int | None]) -> list[int]:
    known = [v for v in values if v is not None]
    while known and not known[-1]:
        known.pop()
    return known


def _values(exprs: Sequence[Expr], seed: int) -> dict[Expr, int | None]:
    """The nodes of some expressions at a random point; None where one divides by zero there."""
    point = random_point(seed)
    point.run(exprs)
    return point.known


def random_point(seed: object, zero: str | None = None) -> Evaluated[int]:
    """A point of the prime field; functions, derivatives and conditions are drawn there as well.

    `zero` is the name of a symbol that is zero.
    """

    def drawn(node: Expr, args: list[int]) -> int:
        data = node.root.zero.id if node.op is Op.ROOT else node.data
        return draw(f"{seed}:{node.op.value}:{data}:{args}")

    def symbol(node: Expr) -> int:
        return 0 if node.symbol.name == zero else draw(f"{seed}:{node.symbol.name}")

    return Evaluated({**dict.fromkeys(Op, drawn), **RESIDUES}, symbol)


def residue(value: Rational) -> int:
    """A rational number modulo the prime; raises ValueError where that divides its denominator."""
    if value.denominator == 1:
        return value.numerator % PRIME
    return value.numerator * pow(value.denominator, -1, PRIME) % PRIME


def _sum(node: Expr, args: list[int]) -> int:
    total: int = sum(map(mul, map(residue, node.coefficients), args))
    return total % PRIME


def _product(node: Expr, args: list[int]) -> int:
    value = 1
    for e, x in zip(node.exponents, args, strict=True):
        value = value * pow(x, e, PRIME) % PRIME
    return value


#: Arithmetic modulo the prime; a division by zero has no value.
RESIDUES: dict[Op, Callable[[Expr, list[int]], int]] = {
    Op.NUM: lambda node, _: residue(node.number),
    Op.ADD: _sum,
    Op.MUL: _product,
}


def draw(key: str) -> int:
    """A number modulo the prime that looks random, and is the same for a key in every run."""
    data = key.encode()
    return (crc32(data) << 29 ^ crc32(data[::-1]) * 0x9E3779B97F4A7C15) % PRIME
