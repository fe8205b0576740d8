"""Where in a TOML text each value stands: Python's reader of TOML tells values but no places."""

from __future__ import annotations

import re

Path = tuple[str | int, ...]
Place = tuple[int, int]

_BLANK = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_KEY = re.compile(r"""\s*(?:([\w-]+)|"((?:\\.|[^"\\])*)"|'([^']*)')[ \t]*""")
_TEXT = re.compile(
    r'''"""(?:\\.|[^\\])*?"""+|\'\'\'.*?\'\'\'+|"(?:\\.|[^"\\])*"|'[^']*\'''', re.DOTALL
)
_BARE = re.compile(r"[^,\]}\n#]*")


def places(text: str) -> dict[Path, Place]:
    """Start and end of each value and of each table's name, by the keys that lead to it.

    Texts are given without their quotes; entries of lists are counted from 0. The text has to be
    right as TOML.

    >>> where = places('[inputs]\\nU = "5 V"\\n')
    >>> where["inputs", "U"]
    (14, 17)
    """
    return _Scanner(text).scan()


class _Scanner:
    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.found: dict[Path, Place] = {}
        self.counts: dict[Path, int] = {}

    def scan(self) -> dict[Path, Place]:
        table: Path = ()
        self.blank()
        while self.at < len(self.text):
            before = self.at
            if self.text[self.at] == "[":
                table = self.heading()
            else:
                self.pair(table)
            self.blank()
            if self.at == before:  # nothing of TOML
                break
        return self.found

    def heading(self) -> Path:
        """The path of `[a.b]` or `[[a.b]]`."""
        brackets = 2 if self.text.startswith("[[", self.at) else 1
        self.at += brackets
        start = self.at
        names = self.keys()
        place = (start, self.at)
        self.at += brackets
        path: Path = ()
        for k, name in enumerate(names):
            path = (*path, name)
            if brackets == 2 and k == len(names) - 1:
                self.counts[path] = self.counts.get(path, -1) + 1
            if path in self.counts:
                path = (*path, self.counts[path])
        self.found.setdefault(path, place)
        return path

    def pair(self, table: Path) -> None:
        """`key = value`."""
        path = (*table, *self.keys())
        self.at += 1  # the equals sign
        self.value(path)

    def keys(self) -> list[str]:
        """The names of a dotted key."""
        names: list[str] = []
        while True:
            match = _KEY.match(self.text, self.at)
            if match is None:
                return names
            names.append(next(g for g in match.groups() if g is not None))
            self.at = match.end()
            if not self.text.startswith(".", self.at):
                return names
            self.at += 1

    def value(self, path: Path) -> None:
        """The place of a value, and those of all that is in it."""
        self.blank()
        start = self.at
        opening = self.text[start : start + 1]
        if opening in ("[", "{") and opening:
            self.at += 1
            count = 0
            self.blank()
            while self.at < len(self.text) and self.text[self.at] not in "]}":
                before = self.at
                if opening == "[":
                    self.value((*path, count))
                    count += 1
                else:
                    self.pair(path)
                self.blank()
                if self.text.startswith(",", self.at):
                    self.at += 1
                    self.blank()
                if self.at == before:
                    break
            self.at += 1
            self.found[path] = (start, self.at)
            return
        match = _TEXT.match(self.text, start)
        if match is not None:
            quotes = 3 if match[0][:3] in ('"""', "'''") and len(match[0]) > 5 else 1
            self.at = match.end()
            self.found[path] = (start + quotes, self.at - quotes)
            return
        match = _BARE.match(self.text, start)
        self.at = match.end() if match else start
        self.found[path] = (start, start + len(self.text[start : self.at].rstrip()))

    def blank(self) -> None:
        """Over blanks, ends of lines and comments."""
        match = _BLANK.match(self.text, self.at)
        self.at = match.end() if match else self.at
