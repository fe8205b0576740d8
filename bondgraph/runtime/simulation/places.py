"""Where in a TOML text each value stands: Python's reader of TOML tells values but no places."""

from __future__ import annotations

import re

Path = tuple[str | int, ...]

_KEY = r"""(?:[\w-]+|"[^"\n]*"|'[^'\n]*')"""
_DOTTED = rf"{_KEY}(?:\s*\.\s*{_KEY})*"
_TABLE = re.compile(rf"^[ \t]*(\[\[?)[ \t]*({_DOTTED})[ \t]*\]", re.MULTILINE)
_PAIR = re.compile(
    rf"""^[ \t]*({_DOTTED})[ \t]*=[ \t]*("[^"\n]*"|'[^'\n]*'|[^\n#]*)""", re.MULTILINE
)
_INNER = re.compile(rf"""({_DOTTED})[ \t]*=[ \t]*("[^"\n]*"|'[^'\n]*'|[^,}}\]\n]*)""")


def places(text: str) -> dict[Path, tuple[int, int]]:
    """Start and end of each value and of each table's name, by the keys that lead to it.

    Texts are given without their quotes. What is written over several lines has the place of its
    first; a value that is not found has none.

    >>> where = places('[inputs]\\nU = "5 V"\\n')
    >>> where["inputs", "U"]
    (14, 17)
    """
    found: dict[Path, tuple[int, int]] = {}
    counts: dict[Path, int] = {}
    table: Path = ()
    marks = [(m.start(), m, True) for m in _TABLE.finditer(text)]
    marks += [(m.start(), m, False) for m in _PAIR.finditer(text)]
    for _, match, heading in sorted(marks, key=lambda mark: mark[0]):
        if heading:
            table = _parts(match[2])
            if match[1] == "[[":
                counts[table] = counts.get(table, -1) + 1
                table = (*table, counts[table])
            else:
                table = _inside(table, counts)
            found.setdefault(table, match.span(2))
            continue
        path = (*table, *_parts(match[1]))
        found[path] = _bare(text, *match.span(2))
        if match[2].lstrip().startswith("{"):
            for inner in _INNER.finditer(text, match.start(2) + 1, match.end(2)):
                found[(*path, *_parts(inner[1]))] = _bare(text, *inner.span(2))
    return found


def _parts(dotted: str) -> Path:
    return tuple(key.strip("\"'") for key in re.findall(_KEY, dotted))


def _inside(table: Path, counts: dict[Path, int]) -> Path:
    """The table with the number of the array entry that it belongs to."""
    out: Path = ()
    for key in table:
        out = (*out, key)
        if out in counts:
            out = (*out, counts[out])
    return out


def _bare(text: str, start: int, end: int) -> tuple[int, int]:
    """The place without blanks around and without quotes."""
    while end > start and text[end - 1] in " \t":
        end -= 1
    if end - start >= 2 and text[start] in "\"'" and text[end - 1] == text[start]:
        return start + 1, end - 1
    return start, end
