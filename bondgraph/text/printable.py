"""Text that cannot move a cursor, colour a screen, turn the reading direction or end a line.

Names, units, comments and messages come from files, devices and brokers. They become text of ours
at few borders (what is printed, a file that is written, a message to a page), and each of them
goes through here.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

#: Controls but for tab and line feed, marks of direction, invisible letters, line and paragraph
#: separators, halves of surrogates. Operators that are not seen, as in MathML, may stay.
_RAW = re.compile(
    "[\0-\x08\x0b-\x1f\x7f-\x9f\u00ad\u061c\u180e\u200b-\u200f\u2028-\u202e\u2065-\u206f\ufeff"
    "\ufff9-\ufffb\ud800-\udfff\U000e0000-\U000e0fff]"
)


def printable(text: str) -> str:
    r"""The text with U+FFFD in place of what is not to be printed; line ends and tabs stay.

    >>> printable("a\x1b[31m\u202eb")
    'a\ufffd[31m\ufffdb'
    """
    if text.isascii() and text.isprintable():
        return text
    return _RAW.sub("\N{REPLACEMENT CHARACTER}", text)


def one_line(text: str) -> str:
    """The same for text that is to stay in its line: line ends and tabs become spaces."""
    return printable(" ".join(text.split()) if not text.isprintable() else text)


def printable_values(value: Any) -> Any:
    """Plain data, with every text in it made printable, names of entries too."""
    if isinstance(value, str):
        return printable(value)
    if isinstance(value, Mapping):
        return {printable_values(k): printable_values(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [printable_values(v) for v in value]
    return value
