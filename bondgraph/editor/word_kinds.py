"""What each word of a text is, by the words around it alone: for colours, also of fragments."""

from __future__ import annotations

import re
from collections.abc import Generator, Iterator
from typing import Literal

from bondgraph.frontend.expression_parser import UNIT
from bondgraph.frontend.lexer import Words, split
from bondgraph.frontend.words import KEYWORDS, NOT_UNITS, is_arrow
from bondgraph.library.elements import SIGNALS
from bondgraph.text.tuples import NamedTuple

Kind = Literal[
    "comment", "doc", "string", "number", "unit", "keyword", "operator word", "constant", "type",
    "declared", "function", "signal", "name", "arrow", "operator", "mark", "wrong",
]  # fmt: skip

_DECLARES = frozenset(["param", "const", "input", "sensor"])
_COMMENT = re.compile(r"#[^\n]*")
_OPENS = frozenset(["{", "}", ";"])
_OPERATORS = frozenset("+ - * / ^ = == != < <= > >= += *= +- ± % ..".split())
_MARKS = frozenset("( ) [ ] { } , ; : .".split())


class Word(NamedTuple):
    """A stretch of the text and what it is."""

    start: int
    text: str
    kind: Kind


def word_kinds(text: str) -> Iterator[Word]:
    """The words and comments of a text in order; blanks between them are left out.

    >>> [(w.text, w.kind) for w in word_kinds("-> R:Re = 3 kOhm  # wire")][1:6:2]
    [('R', 'type'), ('Re', 'declared'), ('3', 'number')]
    """
    reader = _Reader(text)
    at = 0
    while at < len(reader.words):
        yield from reader.comments(at)
        if not reader.words[at]:
            return
        at = yield from reader.word(at)


class _Reader:
    def __init__(self, text: str) -> None:
        self.text = text
        found: Words = split(text)
        self.words, self.starts, self.fresh, self.gaps = found

    def comments(self, at: int) -> Iterator[Word]:
        """The comments before word `at`."""
        gap = self.gaps.get(at)
        if gap is None:
            return
        start, text = gap
        for found in _COMMENT.finditer(text):
            own = found[0].startswith("##") and not found[0].startswith("###")
            yield Word(start + found.start(), found[0], "doc" if own else "comment")

    def word(self, at: int) -> Generator[Word, None, int]:
        """Word `at`, with the unit that follows it; the number of the next one."""
        kind = self.kind(at)
        yield Word(self.starts[at], self.words[at], kind)
        end = self.starts[at] + len(self.words[at])
        if kind == "number" and self.text[end : end + 1] == " ":
            return (yield from self.unit(at + 1, end + 1))
        if self.words[at] == ":" and self.declares(at):
            return (yield from self.unit(at + 1, self.starts[at + 1]))
        return at + 1

    def unit(self, at: int, start: int) -> Generator[Word, None, int]:
        """A unit if one begins at word `at`, which has to stand at `start`."""
        word = self.words[at]
        found = UNIT.match(self.text, start)
        begins = word.isidentifier() or not word.isascii() or (word == "1" and found is not None)
        if found is None or not begins or self.starts[at] != start or word in NOT_UNITS:
            return at
        if word == "bool":
            return at
        if word[0].isdigit() and self.words[at + 1] not in (".", "/") and not self.declares(at - 1):
            return at
        yield Word(start, found[0], "unit")
        while self.words[at] and self.starts[at] < found.end():
            at += 1
        return at

    def declares(self, colon: int) -> bool:
        """Whether the colon follows the name that `param`, `input` and so on declare."""
        at = colon - 1
        if at > 0 and self.words[at] == "]":
            while at > 0 and self.words[at] != "[":
                at -= 1
            at -= 1
        return at > 0 and self.words[at - 1] in _DECLARES and self.kind(at - 1) == "keyword"

    def kind(self, at: int) -> Kind:
        """What word `at` is."""
        word, after = self.words[at], self.words[at + 1]
        before = self.words[at - 1] if at else ""
        if word[0] == '"':
            return "string" if len(word) > 1 and word[-1] == '"' else "wrong"
        node = after == ":" and self.words[at + 2].isidentifier() and not self.declares(at + 1)
        if (word in ("0", "1") or word.isidentifier()) and node and not self.before_colon(before):
            return "type"
        if word[0].isdigit() and word[0].isascii():
            return "number"
        if is_arrow(word):
            return "arrow"
        if word.isidentifier():
            return self.identifier(at, word, before, after)
        if word in _OPERATORS:
            return "operator"
        return "mark" if word in _MARKS else "wrong"

    @staticmethod
    def before_colon(before: str) -> bool:
        """Whether the word before says that a colon here belongs to a declaration."""
        return before in ("port", "fault", "(", ",")

    def identifier(self, at: int, word: str, before: str, after: str) -> Kind:
        """What a word of letters is."""
        if before == ".":
            return "signal" if word in SIGNALS else "name"
        if word in ("true", "false"):
            return "constant"
        if word in ("and", "or", "not"):
            return "operator word"
        if self.keyword(at, word, before, after):
            return "keyword"
        if before == ":" and at > 1 and self.kind(at - 2) == "type":
            return "declared"
        begins = at < 2 or self.fresh[at - 1] or self.words[at - 2] in _OPENS
        if before in KEYWORDS - {"if", "import"} and begins:
            return "declared"
        return "function" if after == "(" and not self.fresh[at + 1] else "name"

    def keyword(self, at: int, word: str, before: str, after: str) -> bool:
        """Whether a word has its meaning in the language here."""
        begins = at == 0 or self.fresh[at] or before in _OPENS
        same_line = not self.fresh[at + 1]
        if word in KEYWORDS and begins:
            # what follows `if` is any expression; the others are followed by a name
            return same_line and (after.isidentifier() or (word == "if" and after in ("(", "not")))
        if word == "bg":
            return begins and after.isdigit()
        match word:
            case "in" | "out":
                port = before == ":" and at > 2 and self.words[at - 3] == "port"
                loop = word == "in" and at > 1 and self.words[at - 2] == "for"
                return port or loop
            case "from":
                return after.startswith('"')
            case "bool" | "int":
                return before == ":"
            case "counts":  # before an operand; else it is a unit
                return not begins and same_line and (after[:1].isalnum() or after == "(")
            case "when" | "unknown":
                return not begins and after != ":" and (before.isidentifier() or before == "]"
                                                        or word != "when")  # fmt: skip
            case "else":
                return before == "}" or after in ("{", "if")
        return False
