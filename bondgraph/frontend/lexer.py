"""Cuts a `.bg` text into words; the gaps between them keep the line ends and the comments."""

from __future__ import annotations

import re

from bondgraph.text.tuples import NamedTuple

#: Everything between two words; the pieces of this pattern tile any text without a hole.
_PIECE = re.compile(
    r"""(?:[ \t\r\n\ufeff]+|\#[^\n]*)+            # a gap: blanks, line ends, comments
    |[^\W\d]\w*                                   # a name
    |[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?      # a number; `1..2` is a range
    |<-\[[ \t]*[0-9A-Za-z]+[ \t]*\]-              # a numbered arrow
    |-\[[ \t]*[0-9A-Za-z]+[ \t]*\]->
    |->|<-|<=|>=|==|!=|\+=|\*=|\+-|\.\.
    |"[^"\n]*"?                                   # a string, perhaps not closed on its line
    |.""",
    re.VERBOSE | re.DOTALL,
)

_BLANK = frozenset(" \t\r\n\ufeff#")


class Words(NamedTuple):
    """The words of a text, in parallel lists that end with three empty words.

    `starts[i]` is the offset of `words[i]`; `fresh[i]` says that a line end stands before it;
    `gaps[i]` is offset and text of the gap before word i, kept only where it holds a comment.
    """

    words: list[str]
    starts: list[int]
    fresh: list[bool]
    gaps: dict[int, tuple[int, str]]


def split(text: str) -> Words:
    """The words of `text`; never fails, an impossible character is a word of its own.

    >>> split("a -> R:b # x").words
    ['a', '->', 'R', ':', 'b', '', '', '']
    """
    words: list[str] = []
    starts: list[int] = []
    fresh: list[bool] = []
    gaps: dict[int, tuple[int, str]] = {}
    at = 0
    newline = True
    for piece in _PIECE.findall(text):
        if piece[0] in _BLANK:
            if "#" in piece:
                gaps[len(words)] = (at, piece)
            if "\n" in piece:
                newline = True
        else:
            words.append(piece)
            starts.append(at)
            fresh.append(newline)
            newline = False
        at += len(piece)
    # Enough ends of the text that looking two words ahead needs no care.
    words += ["", "", ""]
    starts += [at, at, at]
    fresh += [True, True, True]
    return Words(words, starts, fresh, gaps)
