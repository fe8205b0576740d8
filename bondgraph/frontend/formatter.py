"""Lays a `.bg` text out in the one canonical way, without touching what it says."""

from __future__ import annotations

from bondgraph.frontend.parser import Parser
from bondgraph.frontend.spacing import WIDTH, Item, Setter, line, wrap
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source

_INDENT = "    "
#: A statement goes on further to the right than a body would.
_CONTINUED = 2 * _INDENT


def format_text(source: Source, report: Report) -> str | None:
    """The text of `source` in canonical layout; None, with errors in `report`, if it is wrong.

    Words and comments stay, in their order; only spaces, line ends and semicolons change. One
    statement stands in a line; braces written in one line stay so while they fit into 100
    columns; blank lines are kept, at most one; comments behind neighbouring lines are aligned.
    Formatting twice gives the same text as once.

    >>> format_text(Source("a.bg", "bg 1\\nmodel M{1:j{<-Se:U;->R:r=2*a}}"), Report())
    'bg 1\\nmodel M { 1:j { <- Se:U; -> R:r = 2*a } }\\n'
    """
    parser = Parser(source, report)
    if parser.file() is None or parser.errors:
        return None
    return _Formatter(parser).text()


class _Comment:
    """A comment in a line of its own."""

    __slots__ = ("blank", "text")

    def __init__(self, text: str, blank: bool) -> None:
        self.text = text
        self.blank = blank  # a blank line stands before it


class _Block:
    """Braces and the statements in them; `closing` are the comments before the end."""

    __slots__ = ("behind_open", "closing", "one_line", "opening", "statements")

    def __init__(self, opening: int) -> None:
        self.opening = opening
        self.behind_open = ""
        self.statements: list[_Statement] = []
        self.closing: list[_Comment] = []
        self.one_line = True


class _Statement:
    """Words and braces of a statement, with the comments before, inside and behind it."""

    __slots__ = ("before", "behind", "blank", "inside", "pieces")

    def __init__(self, before: list[_Comment], blank: bool) -> None:
        self.before = before
        self.blank = blank
        self.pieces: list[int | _Block] = []
        self.inside: dict[int, tuple[str, list[_Comment]]] = {}  # by the word that follows
        self.behind = ""


class _Formatter:
    """The layout of one file that was read without an error."""

    def __init__(self, parser: Parser) -> None:
        self._text = parser.source.text
        self._words = parser.words
        self._starts = parser.starts
        self._begins = frozenset(parser.notes.begins)
        self._laws = frozenset(parser.notes.laws)
        self._setter = Setter(parser.words, parser.notes)
        self._lines: list[tuple[str, str]] = []  # code or comment, comment behind code

    def text(self) -> str:
        """The whole file."""
        whole, _ = self._block(0, _Block(-1))
        self._print_block(whole, 0)
        return "\n".join(_with_comments(self._lines)) + "\n"

    # -------------------------------------------------------------- structure

    def _gap(self, at: int) -> tuple[str, list[_Comment], bool]:
        """Before word `at`: comment behind the word before, comment lines, a blank line last."""
        end = self._starts[at - 1] + len(self._words[at - 1]) if at else 0
        gap = self._text[end : self._starts[at]]
        if "\n" not in gap and "#" not in gap:
            return "", [], False
        lines = [part.strip(" \t\r\ufeff") for part in gap.split("\n")]
        behind = lines.pop(0) if at else ""
        comments: list[_Comment] = []
        blank = False
        # What follows the last line end is the indentation of the word, except at the end.
        for text in lines if not self._words[at] else lines[:-1]:
            if text:
                comments.append(_Comment(text, blank))
            blank = not text
        return behind, comments, blank

    def _block(self, at: int, block: _Block) -> tuple[_Block, int]:
        """The statements from word `at` to the closing brace or the end; and that word."""
        pending: list[_Comment] = []
        blank = False
        while True:
            behind, comments, blank_here = self._gap(at)
            if behind:
                if block.statements and not block.statements[-1].behind and not pending:
                    block.statements[-1].behind = behind
                elif not block.statements and not block.behind_open and not pending and at:
                    block.behind_open = behind
                else:
                    pending.append(_Comment(behind, False))
            if comments:
                comments[0].blank |= blank
                blank = blank_here
            else:
                blank |= blank_here
            pending += comments
            word = self._words[at]
            if word == "" or word == "}":
                block.closing = pending
                return block, at
            if word == ";":
                at += 1
                continue
            statement, at = self._statement(at, _Statement(pending, blank))
            block.statements.append(statement)
            pending, blank = [], False

    def _statement(self, at: int, statement: _Statement) -> tuple[_Statement, int]:
        first = at
        words = self._words
        while words[at] not in ("}", ";", "") and (at == first or at not in self._begins):
            if at != first:
                behind, comments, _ = self._gap(at)
                if behind or comments:
                    statement.inside[at] = (behind, comments)
            if words[at] == "{":
                block, close = self._block(at + 1, _Block(at))
                block.one_line = "\n" not in self._text[self._starts[at] : self._starts[close]]
                statement.pieces.append(block)
                at = close + 1
            else:
                statement.pieces.append(at)
                at += 1
        return statement, at

    # ------------------------------------------------------------------- flat

    def _flat(self, statement: _Statement) -> str | None:
        """The statement in one line, or None where a line end is wanted in it."""
        if statement.inside:
            return None
        pieces: list[int | str] = []
        for piece in statement.pieces:
            text = self._flat_block(piece) if isinstance(piece, _Block) else piece
            if text is None:
                return None
            pieces.append(text)
        return line(self._setter.items(pieces, None))

    def _flat_block(self, block: _Block) -> str | None:
        if block.behind_open or block.closing:
            return None
        if not block.statements:
            return "{}"
        if not block.one_line:
            return None
        texts = [self._flat(statement) for statement in block.statements]
        known = [text for text in texts if text is not None]
        return "{ " + "; ".join(known) + " }" if len(known) == len(texts) else None

    # --------------------------------------------------------------- printing

    def _print_block(self, block: _Block, level: int) -> None:
        begun = False
        for statement in block.statements:
            self._print_comments(statement.before, level, begun)
            begun = begun or bool(statement.before)
            if statement.blank and begun:
                self._lines.append(("", ""))
            self._print(statement, level)
            begun = True
        self._print_comments(block.closing, level, begun)

    def _print_comments(self, comments: list[_Comment], level: int, begun: bool) -> None:
        for comment in comments:
            if comment.blank and begun:
                self._lines.append(("", ""))
            self._lines.append((_INDENT * level + comment.text, ""))
            begun = True

    def _print(self, statement: _Statement, level: int) -> None:
        indent = _INDENT * level
        flat = self._flat(statement)
        if flat is not None and len(indent) + len(flat) <= WIDTH:
            self._lines.append((indent + flat, statement.behind))
            return
        waiting: list[int | str] = []
        first, following = indent, indent + _CONTINUED
        before: int | None = None
        for piece in statement.pieces:
            at = piece.opening if isinstance(piece, _Block) else piece
            if at in statement.inside:
                behind, comments = statement.inside[at]
                self._flush(waiting, before, first, following, behind)
                self._lines += [(following + comment.text, "") for comment in comments]
                first = following if waiting or first == following else first
                before = None
                waiting = []
            if isinstance(piece, int):
                waiting.append(piece)
                continue
            text = self._flat_block(piece)
            short = text is not None and len(following) + len(text) <= WIDTH
            if text is not None and short and (piece.opening in self._laws or text == "{}"):
                waiting.append(text)
                continue
            waiting.append("{")
            self._flush(waiting, before, first, following, piece.behind_open)
            self._print_block(piece, level + 1)
            waiting, first, before = ["}"], indent, None
        self._flush(waiting, before, first, following, statement.behind)

    def _flush(
        self, waiting: list[int | str], before: int | None, first: str, following: str, behind: str
    ) -> None:
        items: list[Item] = self._setter.items(waiting, before)
        if items:
            lines = wrap(items, first, following)
            self._lines += [(text, "") for text in lines[:-1]]
            self._lines.append((lines[-1], behind))


def _with_comments(lines: list[tuple[str, str]]) -> list[str]:
    """The lines with the comments behind them, aligned over neighbouring lines if they fit."""
    out: list[str] = []
    at = 0
    while at < len(lines):
        end = at
        while end < len(lines) and lines[end][1]:
            end += 1
        if end == at:
            out.append(lines[at][0])
            at += 1
            continue
        column = max(len(code) for code, _ in lines[at:end]) + 2
        fits = all(column + len(comment) <= WIDTH for _, comment in lines[at:end])
        for code, comment in lines[at:end]:
            out.append(code + " " * (column - len(code) if fits else 2) + comment)
        at = end
    return out
