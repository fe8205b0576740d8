"""Numbers as a person reads them."""

from __future__ import annotations

_ABOVE = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def readable(value: float, digits: int = 3) -> str:
    """A number as it is printed in a book, without trailing zeros.

    >>> readable(0.0025), readable(1.4e-8), readable(-4)
    ('0.0025', '1.4·10⁻⁸', '−4')
    """
    mantissa, _, power = f"{value:.{digits}g}".partition("e")
    text = mantissa.replace("-", "−")
    return f"{text}·10{str(int(power)).translate(_ABOVE)}" if power else text
