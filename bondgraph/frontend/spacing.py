"""How words are set in a line: spaces between them, and where a long line may be broken."""

from __future__ import annotations

from typing import Final

from bondgraph.frontend.cursor import Notes
from bondgraph.frontend.words import is_arrow
from bondgraph.text.tuples import NamedTuple

WIDTH: Final = 100

_NO_SPACE_AFTER: Final = frozenset(["(", "[", ".", "..", ""])
_NO_SPACE_BEFORE: Final = frozenset([")", "]", ",", ".", "..", "%", "["])
_TIGHT: Final = frozenset(["*", "/", "^"])
#: How bad a line end after this word is, brackets apart.
_BREAK: Final = {
    ",": 0, "or": 1, "and": 2, "<": 3, "<=": 3, ">": 3, ">=": 3, "==": 3, "!=": 3, "+": 4,
    "-": 4, "*": 5, "/": 5, "=": 6, "+=": 6, "*=": 6,
}  # fmt: skip
_PER_BRACKET: Final = 10


class Item(NamedTuple):
    """A word as it is printed; `rank`: how bad a line end before it is, None for impossible."""

    text: str
    space: bool
    rank: int | None


class Setter:
    """Turns the words of a statement into items; knows the roles that the parser noted."""

    def __init__(self, words: list[str], notes: Notes) -> None:
        self._words = words
        self._unit_end = {first: end for first, end in notes.units}
        self._in_unit = {at for first, end in notes.units for at in range(first + 1, end)}
        self._last_of_unit = {end - 1 for _, end in notes.units}
        self._wide_colons = frozenset(notes.wide_colons)
        self._groups = frozenset(notes.groups)
        self._signs = frozenset(notes.signs)
        self._less_minus = frozenset(notes.less_minus)

    def text(self, at: int) -> str:
        """Word `at` as it is printed; a unit is one piece, printed with its first word."""
        if at in self._unit_end:
            return "".join(self._words[at : self._unit_end[at]])
        if at in self._in_unit:
            return ""
        word = self._words[at]
        if is_arrow(word) and "[" in word:
            return "".join(word.split())
        return word

    def space(self, before: int, at: int) -> bool:
        """Whether a space stands between word `before` and word `at` of one line."""
        a, b = self._words[before], self._words[at]
        if at in self._unit_end:
            return True
        if before in self._last_of_unit and b in ("/", "^"):
            return True  # `5 m / x`: without the space, m/x would be the unit
        if a in ("/", "^") and before not in self._last_of_unit:
            return before > 0 and before - 1 in self._last_of_unit
        if a in _NO_SPACE_AFTER or a in _TIGHT or before in self._signs:
            return False
        if before in self._less_minus or b in _NO_SPACE_BEFORE or b in _TIGHT:
            return False
        if a == ":":
            return before in self._wide_colons
        if b == ":":
            return at in self._wide_colons
        return b != "(" or at in self._groups

    def items(self, pieces: list[int | str], before: int | None) -> list[Item]:
        """The items of words (numbers) and of finished texts (braces), `before` the word before."""
        found: list[Item] = []
        depth = 0
        last = before
        for piece in pieces:
            if isinstance(piece, str):
                found.append(Item(piece, True, None))
                last = None
                continue
            text = self.text(piece)
            if piece in self._less_minus:  # as if `<` and `-` had been written apart
                found.append(Item("<", True, None if last is None else self._rank(last, depth)))
                found.append(Item("-", True, depth * _PER_BRACKET + _BREAK["<"]))
            elif text:
                word = self._words[piece]
                if word in (")", "]"):
                    depth -= 1
                rank = None if last is None else self._rank(last, depth)
                space = last is None or self.space(last, piece)
                found.append(Item(text, space, rank))
                if word in ("(", "["):
                    depth += 1
            last = piece
        return found

    def _rank(self, before: int, depth: int) -> int | None:
        word = self._words[before]
        if before in self._signs or before in self._less_minus or before in self._in_unit:
            return None
        rank = 0 if is_arrow(word) else _BREAK.get(word)
        return None if rank is None else depth * _PER_BRACKET + rank


def line(items: list[Item]) -> str:
    """The items in one line."""
    return "".join(
        f" {item.text}" if item.space and number else item.text for number, item in enumerate(items)
    )


def wrap(items: list[Item], first: str, following: str) -> list[str]:
    """The items in lines of at most `WIDTH` characters where the language allows it.

    `first` and `following` are the indentations of the first line and of the others. Of the
    places that leave a line short enough the least bad one is taken, of equals the last.
    """
    lines: list[str] = []
    indent = first
    while True:
        text = indent + line(items)
        at = _best_break(items, len(indent)) if len(text) > WIDTH else None
        if at is None:
            lines.append(text)
            return lines
        lines.append(indent + line(items[:at]))
        items = items[at:]
        indent = following


def _best_break(items: list[Item], column: int) -> int | None:
    best: tuple[int, int] | None = None
    for at, item in enumerate(items):
        if at and item.rank is not None:
            if column > WIDTH and best is not None:
                break
            if column <= WIDTH or best is None:
                rank = item.rank
                if best is None or rank <= best[0]:
                    best = (rank, at)
        column += len(item.text) + (1 if item.space and at else 0)
    return None if best is None else best[1]
