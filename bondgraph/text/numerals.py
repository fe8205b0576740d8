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


def plural(number: int, noun: str) -> str:
    """A number of things.

    >>> plural(1, "bond"), plural(2, "bond"), plural(0, "density")
    ('1 bond', '2 bonds', '0 densities')
    """
    if number == 1:
        return f"1 {noun}"
    return f"{number} {noun[:-1]}ies" if noun.endswith("y") else f"{number} {noun}s"
