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


def _values(exprs: Sequence[Expr], seed: int) -> dict[Expr, int | None]:
    """The nodes of some expressions at a random point; None where one divides by zero there."""
    values: dict[Expr, int | None] = {}
    for node in topological(exprs):
        args = []
        for a in node.args:
            x = values[a]
            if x is None:
                break
            args.append(x)
        values[node] = _one(node, args, seed) if len(args) == len(node.args) else None
    return values


def _one(node: Expr, args: list[int], seed: int) -> int | None:
    """One node from its arguments."""
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
    return value % _P


def _mix(seed: int, text: str) -> int:
    data = f"{seed}:{text}".encode()
    return (crc32(data) << 29 ^ crc32(data[::-1]) * 0x9E3779B97F4A7C15) % _P
