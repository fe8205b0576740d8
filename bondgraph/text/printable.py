"""Text that cannot move a cursor, colour a screen or turn the reading direction.

Names, units, comments and messages come from files, devices and brokers. They become text of ours
at a few borders (what is printed, a file that is written, a message to a page), and each of them
goes through here.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

#: Controls but for tab and line feed, marks of direction and of languages, line and paragraph
#: separators, halves of surrogates.
_RAW = re.compile(
    "[\0-\x08\x0b-\x1f\x7f-\x9f\u061c\u180e\u200e\u200f\u2028-\u202e\u2065-\u206f\ufff9-\ufffb"
    "\ud800-\udfff\U000e0000-\U000e0fff]"
)


def printable(text: str) -> str:
    r"""The text with U+FFFD in place of what is not to be printed; line ends and tabs stay.

    >>> printable("a\x1b[31m\u202eb")
    'a\ufffd[31m\ufffdb'
    """
    return respelt(text, lambda _: "\N{REPLACEMENT CHARACTER}")


def respelt(text: str, spell: Callable[[str], str]) -> str:
    """The text with each character that is not to be printed spelt in another way."""
    return text if text.isprintable() else _RAW.sub(lambda found: spell(found[0]), text)


def printable_values(value: Any) -> Any:
    """Plain data with every text in it made printable, names of entries too."""
    if isinstance(value, str):
        return printable(value)
    if isinstance(value, Mapping):
        return {printable_values(k): printable_values(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [printable_values(v) for v in value]
    return value


def json_text(value: object, indent: int | None = None, allow_nan: bool = False) -> str:
    r"""JSON in which such characters are escaped: the reader gets each of them.

    Raises ValueError for a number that is not finite, which JSON has not, unless it is allowed.

    >>> json_text({"log": "é\u202e"})
    '{"log": "é\\u202e"}'
    """
    import json  # not for those who print no JSON

    text = json.dumps(value, ensure_ascii=False, allow_nan=allow_nan, indent=indent)
    return respelt(text, _escaped)


def _escaped(character: str) -> str:
    units = character.encode("utf-16-be", "surrogatepass")
    return "".join([f"\\u{units[k : k + 2].hex()}" for k in range(0, len(units), 2)])
