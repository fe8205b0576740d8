"""Polynomials over the field, coefficients from the constant up, and a root of one."""

from __future__ import annotations

from random import Random
from typing import TypeAlias

from bondgraph.exact.field import P, Undefined, inverse

Polynomial: TypeAlias = list[int]


def trim(a: Polynomial) -> Polynomial:
    """Without leading zeros."""
    while a and not a[-1]:
        a = a[:-1]
    return a


def add(a: Polynomial, b: Polynomial) -> Polynomial:
    """The sum."""
    if len(a) < len(b):
        a, b = b, a
    return trim([(x + (b[k] if k < len(b) else 0)) % P for k, x in enumerate(a)])


def mul(a: Polynomial, b: Polynomial) -> Polynomial:
    """The product."""
    if not a or not b:
        return []
    out = [0] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            out[i + j] += x * y
    return trim([x % P for x in out])


def remainder(a: Polynomial, b: Polynomial) -> Polynomial:
    """What division leaves."""
    a = a.copy()
    top = inverse(b[-1])
    while len(a) >= len(b):
        factor = a[-1] * top % P
        if factor:
            shift = len(a) - len(b)
            for k, c in enumerate(b):
                a[k + shift] = (a[k + shift] - factor * c) % P
        a.pop()
    return trim(a)


def common(a: Polynomial, b: Polynomial) -> Polynomial:
    """The greatest common divisor, with leading coefficient one."""
    while b:
        a, b = b, remainder(a, b)
    top = inverse(a[-1])
    return [x * top % P for x in a]


def _power(base: Polynomial, exponent: int, modulus: Polynomial) -> Polynomial:
    out: Polynomial = [1]
    for bit in bin(exponent)[2:]:
        out = remainder(mul(out, out), modulus)
        if bit == "1":
            out = remainder(mul(out, base), modulus)
    return out


def roots_of(a: Polynomial, random: Random) -> list[int]:
    """All roots in the field, ascending, by the method of Cantor and Zassenhaus (1981).

    Raises `Undefined` for the polynomial zero.

    >>> from random import Random
    >>> roots_of([6, P - 5, 1], Random(1))
    [2, 3]
    """
    a = trim(a)
    if not a:
        raise Undefined("every number is a root")
    if len(a) == 1:
        return []
    linear = common(a, add(_power([0, 1], P, a), [0, P - 1])) if len(a) > 2 else a
    pending, found = [linear], []
    while pending:
        part = pending.pop()
        if len(part) == 2:
            found.append(-part[0] * inverse(part[1]) % P)
        elif len(part) > 2:
            shift = [random.randrange(P), 1]
            half = common(part, add(_power(shift, (P - 1) // 2, part), [P - 1]))
            if 1 < len(half) < len(part):
                pending += [half, _quotient(part, half)]
            else:
                pending.append(part)
    return sorted(found)


def _quotient(a: Polynomial, b: Polynomial) -> Polynomial:
    a, out = a.copy(), [0] * (len(a) - len(b) + 1)
    top = inverse(b[-1])
    for shift in range(len(a) - len(b), -1, -1):
        factor = a[shift + len(b) - 1] * top % P
        out[shift] = factor
        for k, c in enumerate(b):
            a[k + shift] = (a[k + shift] - factor * c) % P
    return out
