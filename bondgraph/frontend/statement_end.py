"""Where a statement ends, found from its words: for a change that adds another one behind it."""

from __future__ import annotations

from bondgraph.frontend.cursor import continues
from bondgraph.frontend.lexer import split

_OPENS = {"{": 1, "(": 1, "[": 1, "}": -1, ")": -1, "]": -1}
#: Letters that are looked through: a large model is not read again for a remedy.
_LETTERS = 20_000


def statement_end(text: str, start: int) -> int | None:
    """The place behind the last word of the statement in which `start` is; None for a long one.

    >>> text = "1:j {\\n    <- Se:U\\n    -> R:r { e = 2*f }; -> Df:y\\n}"
    >>> ends = [statement_end(text, at) for at in (7, text.index("R:"))]
    >>> [text[end - 4 : end] for end in ends]
    ['Se:U', '*f }']
    >>> statement_end(text, 0) == len(text)
    True
    """
    words, starts, fresh, _ = split(text[start : start + _LETTERS])
    whole = start + _LETTERS >= len(text)
    depth = end = 0
    for at, word in enumerate(words):
        if depth == 0 and at:
            if word in (";", "}") or (word and fresh[at] and not continues(words[at - 1])):
                return start + end
            if not word:
                return start + end if whole else None
        depth += _OPENS.get(word, 0)
        end = starts[at] + len(word)
    return None
