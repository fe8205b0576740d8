"""Times in words: a moment of a stream, in seconds or with its date, and how long it took."""

from __future__ import annotations

from datetime import UTC, datetime

_DATES = 1e9  # s from which on they are of a clock, 2001 there: no machine has run for 31 years
_LONG = 2.0  # of a unit, from which on it is used: 119 min, and 2 h
_LAST = 253402300799.0  # s: the end of the year 9999


def moment(seconds: float, form: str = ".3f") -> str:
    """A time in s, as people read it; `form` is that of the number where it is no date.

    >>> moment(4.7581), moment(4.5, ".6g"), moment(1772345015.95)
    ('4.758 s', '4.5 s', '2026-03-01T06:03:35.950Z')
    """
    if not _DATES <= seconds <= _LAST:
        return f"{seconds:{form}} s"
    found = datetime.fromtimestamp(round(seconds, 3), UTC)
    return found.isoformat(timespec="milliseconds").removesuffix("+00:00") + "Z"


def often(rate: float) -> str:
    """How often samples come, so many a second, as people read it.

    >>> often(1000.0), often(1.0 / 60.0)
    ('1000 samples a second', 'a sample every 60 s')
    """
    return f"{rate:g} samples a second" if rate >= 1.0 else f"a sample every {1.0 / rate:g} s"


def lasting(seconds: float, form: str = ".3f") -> str:
    """How long something took, as people read it: nobody counts a week in s.

    `form` is that of the number of seconds, as far as it is told in these.

    >>> lasting(0.5), lasting(360.0, ".3g"), lasting(13917.217), lasting(410000.0)
    ('0.500 s', '360 s', '3.87 h', '4.75 days')
    """
    if seconds >= _LONG * 86400.0:
        return f"{seconds / 86400.0:.3g} days"
    return f"{seconds / 3600.0:.3g} h" if seconds >= _LONG * 3600.0 else f"{seconds:{form}} s"
