"""Numbers, and lists of names, as a person reads them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

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


def joined(names: Iterable[str], word: str = "and") -> str:
    """All of one name or more.

    >>> joined(["a"]), joined(["a", "b", "c"], "or")
    ('a', 'a, b or c')
    """
    *most, last = names
    return f"{', '.join(most)} {word} {last}" if most else last


def listed(names: Sequence[str], word: str = "and", most: int = 8) -> str:
    """`a, b or c`; of more than `most` names the first ones and how many more there are.

    >>> listed(["a", "b", "c"], "or"), listed(["a", "b", "c", "d"], "and", 3)
    ('a, b or c', 'a, b and 2 more')
    """
    if len(names) > most:
        return joined([*names[: most - 1], f"{len(names) - most + 1} more"])
    return joined(names, word) if names else ""
