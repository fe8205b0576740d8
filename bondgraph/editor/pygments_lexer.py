"""Colours for Pygments, which documents, notebooks and terminals use: the language `bondgraph`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, ClassVar

from pygments.lexer import Lexer
from pygments.token import Comment, Error, Keyword, Name, Number, Operator, Punctuation, String
from pygments.token import Text as Blank

from bondgraph.editor.word_kinds import Kind, word_kinds

TOKENS: dict[Kind, Any] = {
    "comment": Comment.Single, "doc": String.Doc, "string": String.Double, "number": Number,
    "unit": Keyword.Type, "keyword": Keyword.Declaration, "operator word": Operator.Word,
    "constant": Keyword.Constant, "type": Name.Class, "declared": Name.Variable,
    "function": Name.Function, "signal": Name.Builtin.Pseudo, "name": Name, "arrow": Operator,
    "operator": Operator, "mark": Punctuation, "wrong": Error,
}  # fmt: skip


class BondGraphLexer(Lexer):
    """Models in the language of bondgraph, whole ones and fragments."""

    name = "bondgraph"
    aliases: ClassVar[list[str]] = ["bondgraph", "bg"]
    filenames: ClassVar[list[str]] = ["*.bg"]
    mimetypes: ClassVar[list[str]] = ["text/x-bondgraph"]
    url = ""

    def get_tokens_unprocessed(self, text: str) -> Iterator[tuple[int, Any, str]]:
        """The whole text in pieces: where each begins, what it is, its letters."""
        at = 0
        for start, word, kind in word_kinds(text):
            if start > at:
                yield at, Blank, text[at:start]
            yield start, TOKENS[kind], word
            at = start + len(word)
        if at < len(text):
            yield at, Blank, text[at:]
