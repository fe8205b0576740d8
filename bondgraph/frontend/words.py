"""The words that have a meaning in the language, and how to call a word in a message."""

from __future__ import annotations

from typing import Final

#: Words that begin a statement when a name follows; they may be names anywhere else.
KEYWORDS: Final = frozenset("model import port param const input sensor let fault for if".split())
#: Words of expressions: no value, node or port can be called so.
RESERVED: Final = frozenset(["and", "or", "not", "true", "false"])
#: Words that follow a number without being its unit.
NOT_UNITS: Final = frozenset(
    "and or not unknown counts when else if for "
    "param const input sensor let fault port model import".split()
)


def is_arrow(word: str) -> bool:
    """Whether the word is `->`, `<-`, `-[7]->` or `<-[7]-`."""
    return word == "->" or word == "<-" or word.startswith(("-[", "<-["))


def say(word: str) -> str:
    """The word as it is called in a message."""
    if len(word) > 40:
        word = word[:37] + "..."
    return f"`{word}`"
