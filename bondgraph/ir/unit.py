"""Physical dimensions as exact exponents, and units as a dimension with a factor to SI."""

from __future__ import annotations

from fractions import Fraction
from typing import TypeAlias

from bondgraph.text.tuples import NamedTuple

#: Exponents of (m, kg, s, A, K, mol, cd); a radian and a turn have no dimension.
Dimension: TypeAlias = tuple[Fraction | int, ...]

NONE: Dimension = (0, 0, 0, 0, 0, 0, 0)


class Unit(NamedTuple):
    """A unit as written; a value in it times `factor` is the value in SI base units."""

    text: str
    dimension: Dimension
    factor: Fraction


def times(left: Dimension, right: Dimension) -> Dimension:
    """The dimension of a product.

    >>> times((1, 0, 0, 0, 0, 0, 0), (0, 0, -1, 0, 0, 0, 0))
    (1, 0, -1, 0, 0, 0, 0)
    """
    return tuple([a + b for a, b in zip(left, right, strict=True)])


def over(left: Dimension, right: Dimension) -> Dimension:
    """The dimension of a quotient."""
    return tuple([a - b for a, b in zip(left, right, strict=True)])


def raised(base: Dimension, exponent: Fraction | int) -> Dimension:
    """The dimension of a power; whole exponents come out as `int`.

    >>> raised((2, 0, -2, 0, 0, 0, 0), Fraction(1, 2))
    (1, 0, -1, 0, 0, 0, 0)
    """
    return tuple([whole(a * exponent) for a in base])


def whole(value: Fraction | int) -> Fraction | int:
    """The same number as an `int` where it is one: faster to add, and prints as people write."""
    return value.numerator if value.denominator == 1 else value
