"""A place in the words of a file: looking, taking, complaining, going on after an error."""

from __future__ import annotations

import re

from bondgraph.frontend.lexer import split
from bondgraph.frontend.words import KEYWORDS, RESERVED, is_arrow, say
from bondgraph.text.diagnostic import Edit, Label, Remedy, Report
from bondgraph.text.limits import NAME_LETTERS, SYNTAX_ERRORS
from bondgraph.text.source import Source, Span

TYPE_CHECKING = False
if TYPE_CHECKING:
    from bondgraph.frontend.odd import Odd

_ODD_NAME = re.compile(rf"__|(?<!\w)_|(?<!\w)\w{{{NAME_LETTERS + 1}}}")


class SyntaxProblem(Exception):
    """A statement that cannot be understood; `at` is the word where that became clear."""

    def __init__(
        self, code: str, message: str, labels: tuple[Label, ...], help: str | Remedy, at: int
    ) -> None:
        super().__init__(message)
        self.code = code
        self.labels = labels
        self.help = help
        self.at = at


class TooManyProblems(Exception):
    """Raised to give up on a file."""


class Notes:
    """What the words turned out to be, as word numbers; only the formatter wants to know it."""

    __slots__ = ("begins", "groups", "laws", "less_minus", "signs", "units", "wide_colons")

    def __init__(self) -> None:
        self.begins: list[int] = []  # first words of statements, equations, imports, models
        self.groups: list[int] = []  # brackets that are not those of a call or of arguments
        self.laws: list[int] = []  # braces around the law of an element
        self.less_minus: list[int] = []  # `<-` that is less-than, minus
        self.signs: list[int] = []  # minus signs with one operand
        self.units: list[tuple[int, int]] = []  # from a word to before another one
        self.wide_colons: list[int] = []  # colons of declarations


class Cursor:
    """The words of one source and the place of the reader in them."""

    def __init__(self, source: Source, report: Report) -> None:
        self.source = source
        self.report = report
        self.words, self.starts, self.fresh, self.gaps = split(source.text)
        self.i = 0
        self.brackets = 0  # open round and square brackets: line ends inside them mean nothing
        self.depth = 0
        self.errors = 0
        text = source.text
        # Only a text with such characters pays for a closer look at every name.
        self.careful = _ODD_NAME.search(text) is not None or not text.isascii()
        self.complained: set[str] = set()
        self.has_docs = "##" in text
        self.notes = Notes()

    # ---------------------------------------------------------------- places

    def span(self, first: int) -> Span:
        """From word `first` to the last word taken."""
        last = self.i - 1
        return Span(self.source, self.starts[first], self.starts[last] + len(self.words[last]))

    def word_span(self, at: int) -> Span:
        """The place of one word; of the end of the file, the end of the last word."""
        if not self.words[at] and at:
            end = self.starts[at - 1] + len(self.words[at - 1])
            return Span(self.source, end, end)
        return Span(self.source, self.starts[at], self.starts[at] + len(self.words[at]))

    def end_of(self, at: int) -> Span:
        """The empty place behind word `at`."""
        end = self.starts[at] + len(self.words[at])
        return Span(self.source, end, end)

    # ------------------------------------------------------------- complaints

    def complain(self, code: str, message: str, *labels: Label, help: str | Remedy) -> None:
        """Report an error and go on as if all were well."""
        self.report.error(code, message, *labels, help=help)
        self.errors += 1
        if self.errors >= SYNTAX_ERRORS:
            raise TooManyProblems

    def problem(
        self, code: str, message: str, at: int, text: str = "", *more: Label, help: str | Remedy
    ) -> SyntaxProblem:
        """An error at word `at`, to be raised; the statement it is in is given up."""
        return SyntaxProblem(code, message, (Label(self.word_span(at), text), *more), help, at)

    def unexpected(self, wanted: str, help: str | Remedy, *more: Label) -> SyntaxProblem:
        """The word at the cursor is not what the language allows here."""
        at = self.i
        word = self.words[at]
        odd = self.odd_word(at)
        if odd is not None:
            return odd
        found = "the file ends" if not word else f"I found {say(word)}"
        begins = self.notes.begins
        first = not begins or begins[-1] == at
        if word and self.fresh[at] and not first and not self.brackets:
            found = "the line ends"
            end = self.starts[at - 1] + len(self.words[at - 1])
            label = Label(Span(self.source, end, end), f"{wanted} expected here")
        else:
            label = Label(self.word_span(at), f"{wanted} expected here")
        return SyntaxProblem(
            "syntax-unexpected", f"I expected {wanted}, but {found}.", (label, *more), help, at
        )

    def odd_word(self, at: int) -> SyntaxProblem | None:
        """A complaint about a word that is wrong wherever it stands, or None."""
        from bondgraph.frontend.odd import odd  # the slow path: only errors need it

        found = odd(self.source.text, self.words, self.starts, at)
        if found is None:
            return None
        return self.problem(
            found.code, found.message, found.at, found.label, help=self.remedy(found)
        )

    def remedy(self, found: Odd) -> str | Remedy:
        """What an odd word says is to be done, with the change where it is one."""
        if found.change is None:
            return found.help
        start, end, text = found.change
        edit = Edit(f"write `{text}`", ((Span(self.source, start, end), text),))
        return Remedy(found.help, (edit,))

    def tell(self, problem: SyntaxProblem) -> None:
        """Report a problem that was caught."""
        self.complain(problem.code, str(problem), *problem.labels, help=problem.help)

    # ----------------------------------------------------------------- taking

    def take(self, word: str, wanted: str, help: str | Remedy) -> int:
        """Take exactly this word on the same line; its number."""
        at = self.i
        if self.words[at] != word or (self.fresh[at] and not self.brackets):
            raise self.unexpected(wanted, help)
        self.i = at + 1
        return at

    def name(self, wanted: str, help: str) -> str:
        """Take a name that something is called by; it may stand in the next line."""
        at = self.i
        word = self.words[at]
        if not word.isidentifier():
            raise self.unexpected(wanted, help)
        if word in RESERVED:
            raise self.problem(
                "name-reserved",
                f"`{word}` has a fixed meaning in expressions and cannot be a name.",
                at,
                help=f"Choose another name, such as `{word}_`.",
            )
        if self.careful:
            self.check_name(at)
        self.i = at + 1
        return word

    def same_line(self, wanted: str, help: str) -> None:
        """Insist that the next word stands on this line."""
        if self.fresh[self.i] and not self.brackets:
            raise self.unexpected(wanted, help)

    def check_name(self, at: int) -> None:
        """Complain once about a name that the generated code could not spell."""
        word = self.words[at]
        sound = "__" not in word and word.isascii() and word[0] != "_"
        if word in self.complained or (sound and len(word) <= NAME_LETTERS):
            return
        self.complained.add(word)
        from bondgraph.frontend.odd import odd_name

        found = odd_name(word)
        # the name is changed wherever it stands
        places = [i for i, other in enumerate(self.words) if other == word]
        changes = tuple((self.word_span(i), found.change[2]) for i in places if found.change)
        edits = (Edit(f"write `{changes[0][1]}`", changes),) if changes else ()
        self.complain(
            found.code, found.message, Label(self.word_span(at), found.label),
            help=Remedy(found.help, edits),
        )  # fmt: skip

    def keyword(self, word: str) -> bool:
        """Take `word` if it is the next word of this line."""
        at = self.i
        if self.words[at] != word or (self.fresh[at] and not self.brackets):
            return False
        self.i = at + 1
        return True

    def at_open(self) -> bool:
        """Whether `{` comes next; one on the next line is complained about and accepted."""
        if self.words[self.i] != "{":
            return False
        if self.fresh[self.i] and self.i:
            end = self.starts[self.i - 1] + len(self.words[self.i - 1])
            self.complain(
                "brace-on-next-line",
                "The opening brace stands on a line of its own, and the line above is already "
                "a complete statement.",
                Label(self.word_span(self.i), "this brace"),
                Label(Span(self.source, end, end), "belongs here"),
                help=Remedy(
                    "Write `{` at the end of the line that it belongs to.",
                    (self.moved_up(end),),
                ),
            )
            self.fresh[self.i] = False  # said once
        return True

    def moved_up(self, end: int) -> Edit:
        """The brace at the cursor moved to the word above it, which ends at `end`."""
        brace = self.word_span(self.i)
        text = self.source.text
        line = text.rfind("\n", 0, brace.start)
        alone = text[line + 1 : brace.start].isspace() or line + 1 == brace.start
        behind = text[brace.end : brace.end + 1] in ("\n", "")
        start = line if alone and behind else brace.start
        if start == end:
            return Edit("move it up", ((Span(self.source, start, brace.end), " {"),))
        above = Span(self.source, end, end)
        return Edit("move it up", ((above, " {"), (Span(self.source, start, brace.end), "")))

    # --------------------------------------------------------------- recovery

    def begins_statement(self, at: int) -> bool:
        """Whether word `at` plainly begins a statement of its own line."""
        word = self.words[at]
        if not self.fresh[at] or not word:
            return False
        after = self.words[at + 1]
        if word in KEYWORDS:
            # `let and b`, `let counts 24/turn`: there the keyword is the name of a value
            name = after.isidentifier() and after not in RESERVED and after != "counts"
            return name and not self.fresh[at + 1]
        return is_arrow(word) or word == "}"

    def skip_statement(self, begin: int) -> None:
        """Go to the end of the statement that began at word `begin` and failed at the cursor."""
        words, fresh = self.words, self.fresh
        self.brackets = 0
        open_brackets = braces = 0
        for word in words[begin : self.i]:
            if word in ("(", "["):
                open_brackets += 1
            elif word in (")", "]"):
                open_brackets -= 1
        at = self.i
        while word := words[at]:
            if braces == 0:
                if word in ("}", ";"):
                    break
                if fresh[at] and at > begin and word != "{":
                    goes_on = open_brackets > 0 and not self.looks_fresh(at)
                    if not goes_on and not continues(words[at - 1]):
                        break
                    if self.begins_statement(at):
                        break
            if word == "{":
                braces += 1
            elif word == "}":
                braces -= 1
            elif word in ("(", "["):
                open_brackets += 1
            elif word in (")", "]"):
                open_brackets -= 1
            at += 1
        self.i = max(at, self.i)

    def indent(self, at: int) -> int:
        """How far the line of word `at` is indented."""
        text = self.source.text
        begin = text.rfind("\n", 0, self.starts[at]) + 1
        line = text[begin : self.starts[at]]
        return len(line) - len(line.lstrip(" \t"))

    def looks_fresh(self, at: int) -> bool:
        """Whether the line that begins at word `at` looks like a new statement."""
        return (
            self.begins_statement(at)
            or self.words[at + 1] == ":"
            or (is_arrow(self.words[at + 1]) and self.words[at].isidentifier())
        )


_CONTINUES = frozenset(["+", "-", "*", "/", "^", ",", "=", "(", "[", "<", ">", "<=", ">=", "=="])


def continues(word: str) -> bool:
    """Whether a statement goes on in the next line after this word."""
    return word in _CONTINUES or word in ("!=", "and", "or", "not", "+-", "±") or is_arrow(word)
