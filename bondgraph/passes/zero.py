"""Decide whether an expression is identically zero, by its value at a random point of a field.

Schwartz (1980) and Zippel (1979): a rational expression that is not zero vanishes at a random
point modulo 2**61 - 1 with a probability below 1e-15 for the sizes met here. Functions and
derivatives count as independent unknowns of their arguments' values, which can only err towards
"not zero".
"""

from __future__ import annotations

from collections.abc import Sequence
from zlib import crc32

from bondgraph.ir.expr import Expr, Op, topological

_P = (1 << 61) - 1


def is_zero(expr: Expr) -> bool:
    """Whether `expr` vanishes identically; a division by zero at both points counts as not zero.

    >>> from bondgraph.ir.expr import Pool, Kind
    >>> p = Pool(); a = p.symbol("a", Kind.PARAM); b = p.symbol("b", Kind.PARAM)
    >>> square = p.power(p.add((1, a), (1, b)), 2)
    >>> cross = p.add((1, p.power(a, 2)), (2, p.mul(a, b)), (1, p.power(b, 2)))
    >>> is_zero(p.sub(square, cross))
    True
    """
    return all(_value(expr, seed) == 0 for seed in (1, 2))


def share_factor(a: list[Expr], b: list[Expr]) -> bool:
    """Whether two polynomials (coefficients from the constant up) have a common factor.

    Euclid's algorithm on their values at a random point; a division by zero there counts as yes.
    """
    left, right = ([_value(c, 3) for c in p] for p in (a, b))
    if None in left or None in right:
        return True
    one, other = _trimmed(left), _trimmed(right)
    while other:
        top = pow(other[-1], -1, _P)
        while len(one) >= len(other):
            factor = one[-1] * top % _P
            shift = len(one) - len(other)
            for k, c in enumerate(other):
                one[k + shift] = (one[k + shift] - factor * c) % _P
            one = _trimmed(one[:-1])
        one, other = other, one
    return len(one) > 1


def _trimmed(values: Sequence[int | None]) -> list[int]:
    known = [v for v in values if v is not None]
    while known and not known[-1]:
        known.pop()
    return known


def _value(expr: Expr, seed: int) -> int | None:
    values: dict[Expr, int] = {}
    for node in topological([expr]):
        args = [values[a] for a in node.args]
        if node.op is Op.NUM:
            number = node.number
            if number.denominator % _P == 0:
                return None
            value = number.numerator * pow(number.denominator, -1, _P)
        elif node.op is Op.ADD:
            value = 0
            for c, x in zip(node.coefficients, args, strict=True):
                value += x * c.numerator * pow(c.denominator, -1, _P)
        elif node.op is Op.MUL:
            value = 1
            for e, x in zip(node.exponents, args, strict=True):
                if x == 0 and e < 0:
                    return None
                value = value * pow(x, e, _P) % _P
        elif node.op is Op.SYM:
            value = _mix(seed, node.symbol.name)
        else:
            data = node.root.zero.id if node.op is Op.ROOT else node.data
            value = _mix(seed, f"{node.op.value}:{data}:{args}")
        values[node] = value % _P
    return values[expr]


def _mix(seed: int, text: str) -> int:
    data = f"{seed}:{text}".encode()
    return (crc32(data) << 29 ^ crc32(data[::-1]) * 0x9E3779B97F4A7C15) % _P
