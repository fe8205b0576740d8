"""Numbers as arguments of a command."""

from __future__ import annotations

import math


def positive(text: str) -> float:
    """A number above zero; raises ValueError for anything else."""
    value = float(text)
    if not 0 < value < math.inf:
        raise ValueError
    return value


positive.__name__ = "positive number"


def pace(text: str) -> float:
    """A number above zero, or inf; raises ValueError for anything else."""
    value = float(text)
    if not value > 0:
        raise ValueError
    return value


pace.__name__ = "positive number"


def bits(text: str) -> int:
    """How many bits a sample has."""
    value = int(text)
    if not 1 <= value <= 52:
        raise ValueError
    return value


bits.__name__ = "number of bits from 1 to 52"


def assigned(text: str) -> tuple[str, float]:
    """`NAME=VALUE`; raises ValueError for anything else."""
    name, _, number = text.rpartition("=")
    value = float(number)
    if not name or not math.isfinite(value):
        raise ValueError
    return name, value


assigned.__name__ = "NAME=VALUE"


def noise(text: str) -> tuple[str, float]:
    """`NAME=DEVIATION`, or the deviation of all sensors with an empty name."""
    name, value = assigned(text) if "=" in text else ("", float(text))
    if not 0 <= value < math.inf:
        raise ValueError
    return name, value


noise.__name__ = "[NAME=]DEVIATION"
