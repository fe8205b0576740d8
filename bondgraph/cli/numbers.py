"""Numbers as arguments of a command, and as a person reads them."""

from __future__ import annotations

import math


def positive(text: str) -> float:
    """A number above zero; raises ValueError for anything else."""
    value = float(text)
    if not 0 < value < math.inf:
        raise ValueError
    return value


positive.__name__ = "positive number"


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


_ABOVE = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def readable(value: float, digits: int = 3) -> str:
    """A number as it is printed in a book, without trailing zeros.

    >>> readable(0.0025), readable(1.4e-8), readable(-4)
    ('0.0025', '1.4·10⁻⁸', '−4')
    """
    mantissa, _, power = f"{value:.{digits}g}".partition("e")
    text = mantissa.replace("-", "−")
    return f"{text}·10{str(int(power)).translate(_ABOVE)}" if power else text
