"""What a past value of a signal is called: `delay(U, 2.5 s)`, which no name of a model can be."""

from __future__ import annotations

from fractions import Fraction

_HEAD, _UNIT = "delay(", " s)"


def past_name(of: str, seconds: Fraction) -> str:
    """The name of what a signal was so many seconds ago.

    >>> past_name("U", Fraction(5, 2)), past_of("delay(U, 2.5 s)"), past_of("U")
    ('delay(U, 2.5 s)', ('U', Fraction(5, 2)), None)
    """
    return f"{_HEAD}{of}, {float(seconds)!r}".removesuffix(".0") + _UNIT


def past_of(name: str) -> tuple[str, Fraction] | None:
    """The signal and the seconds of such a name; None for any other."""
    if not name.startswith(_HEAD):
        return None
    of, _, seconds = name[len(_HEAD) :].removesuffix(_UNIT).rpartition(", ")
    return of, Fraction(seconds)
