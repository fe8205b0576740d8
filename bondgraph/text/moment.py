"""A time of a stream in words: seconds, or date and time where these are counted since 1970."""

from __future__ import annotations

from datetime import UTC, datetime

_DATES = 1e9  # s from which on they are of a clock, 2001 there: no machine has run for 31 years
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
