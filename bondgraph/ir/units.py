"""Physical dimensions as integer exponents, and units as a dimension with a factor to SI."""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple, TypeAlias

#: Exponents of (m, kg, s, A, K, mol, cd); a radian and a turn have no dimension.
Dimension: TypeAlias = tuple[Fraction | int, ...]

NONE: Dimension = (0, 0, 0, 0, 0, 0, 0)


class Unit(NamedTuple):
    """A unit as written; a value in it times `factor` is the value in SI base units."""

    text: str
    dimension: Dimension
    factor: Fraction
