"""Reads a whole `.bg` file into its syntax tree: edition, imports, models."""

from __future__ import annotations

import gc
import re

from bondgraph.frontend.cursor import SyntaxProblem, TooManyProblems
from bondgraph.frontend.statements import Statements
from bondgraph.frontend.words import is_arrow
from bondgraph.ir import syntax
from bondgraph.text.diagnostic import Label, Report, removing, replacing
from bondgraph.text.source import Source, Span

EDITION = 1
_BEGIN = re.compile(r"(?:[ \t\r\n\ufeff]|#[^\n]*+)*+bg[ \t]+[0-9]")

_TOP_HELP = "A file has `bg 1`, then `import` lines and `model Name { ... }`."


def parse(source: Source, report: Report) -> syntax.File | None:
    """The syntax tree of `source`; errors go to `report`, each cause once.

    A statement that cannot be understood is left out of the tree and reading goes on, so that
    several independent errors are found in one run. None if nothing could be understood: the
    file is empty, is no `.bg` file, or is of another edition.

    >>> from bondgraph.text.source import Source
    >>> parse(Source("a.bg", "bg 1; model M { Se:U -> R:r = 2 Ohm }"), Report()).models[0].name
    'M'
    """
    collecting = gc.isenabled()
    gc.disable()  # a tree has no cycles: looking for them would take longer than reading
    try:
        return Parser(source, report).file()
    finally:
        if collecting:
            gc.enable()


def has_edition(source: Source) -> bool:
    """Whether a text begins as a model does, with `bg` and a number.

    >>> has_edition(Source("a.bg", "# a motor\\nbg 1")), has_edition(Source("passwd", "root:x:0"))
    (True, False)
    """
    return _BEGIN.match(source.text) is not None


class Parser(Statements):
    """The parser of one file; `file` runs it, once."""

    def file(self) -> syntax.File | None:
        """The whole file."""
        edition = self._edition()
        if edition is None:
            return None
        imports: list[syntax.Import] = []
        models: list[syntax.Model] = []
        try:
            self._items(imports, models)
        except TooManyProblems:
            self.report.info(
                "syntax-many",
                "There are more errors; the rest of the file was not read.",
                help="Mend the first ones and run again.",
            )
        whole = Span(self.source, 0, len(self.source.text))
        return syntax.File(edition, tuple(imports), tuple(models), self.doc(0), whole)

    def _edition(self) -> int | None:
        words = self.words
        if words[0] == "bg" and words[1].isdigit():
            if words[1] == str(EDITION):
                self.i = 2
                return EDITION
            self.i = 1
            self.complain(
                "unknown-edition",
                f"The file is written in edition {words[1][:20]} of the language; this compiler "
                f"knows edition {EDITION}.",
                Label(self.word_span(1), "this edition"),
                help=replacing(
                    self.word_span(1), str(EDITION),
                    f"Write `bg {EDITION}`, or use a newer version of bondgraph.",
                ),
            )
            return None
        from bondgraph.frontend.foreign import not_bondgraph

        found = not_bondgraph(self.source)
        if found is not None:
            self.report.add(found)
            return None
        self.complain(
            "missing-edition",
            f"The file does not begin with its edition, `bg {EDITION}`.",
            Label(self.word_span(0), f"`bg {EDITION}` expected before this"),
            help=replacing(
                Span(self.source, 0, 0), f"bg {EDITION}\n",
                f"Write `bg {EDITION}` in the first line.",
            ),
        )
        if words[0] == "bg":
            self.skip_statement(0)
            return EDITION
        return EDITION if words[0] in ("model", "import") else None

    def _items(self, imports: list[syntax.Import], models: list[syntax.Model]) -> None:
        while True:
            at = self.i
            word = self.words[at]
            if not word:
                return
            self.notes.begins.append(at)
            try:
                if word == "model":
                    models.append(self._model())
                elif word == "import":
                    imports.append(self._import())
                elif word == ";":
                    self.i += 1
                elif word == "}":
                    raise self.problem(
                        "syntax-unopened",
                        "This brace closes nothing.",
                        at,
                        "no `{` belongs to it",
                        help=removing(
                            self.word_span(at), "Remove it, or look for a `}` too many above it."
                        ),
                    )
                elif self.fresh[at] and (models or self._like_statement(at)):
                    raise self.problem(
                        "statement-outside-model",
                        "A statement stands outside the braces of a model.",
                        at,
                        "outside all braces",
                        help="Move it into a model; perhaps a `}` above it is one too many.",
                    )
                else:
                    raise self.misspelt(at, ["model", "import"]) or self.unexpected(
                        "`model` or `import`", _TOP_HELP
                    )
            except SyntaxProblem as problem:
                self.tell(problem)
                self.brackets = self.depth = 0
                self.i = max(self.i, problem.at)
                self._next_item(at)

    def _like_statement(self, at: int) -> bool:
        after = self.words[at + 1]
        return self.begins_statement(at) or after == ":" or is_arrow(after)

    def _next_item(self, begin: int) -> None:
        """Go to the next line that begins with `model` or `import`: what is between follows."""
        at = max(self.i, begin + 1)
        words = self.words
        while words[at - 1] and words[at]:
            if words[at] in ("model", "import") and self.fresh[at] and words[at + 1].isidentifier():
                break
            at += 1
        self.i = min(at, len(words) - 1)

    def _import(self) -> syntax.Import:
        at = self.i
        self.i = at + 1
        form = 'Write `import A, B from "file.bg"`.'
        self.same_line("the name of a model", form)
        names = [self.name("the name of a model", form)]
        while self.keyword(","):
            names.append(self.name("the name of a model", form))
        self.take("from", "`from`", form)
        path = self.words[self.i]
        if path[:1] != '"' or len(path) == 1 or path[-1] != '"' or self.fresh[self.i]:
            raise self.unexpected("a file name in quotes", form)
        self.i += 1
        return syntax.Import(tuple(names), path[1:-1], self.span(at))

    def _model(self) -> syntax.Model:
        at, doc = self._begun()
        form = "Write `model Name { ... }`."
        self.same_line("the name of the model", form)
        name = self.name("the name of the model", form)
        name_origin = self.span(at + 1)
        generics: tuple[syntax.Generic, ...] = ()
        try:
            if self.words[self.i] == "(" and not self.fresh[self.i]:
                generics = self._generics()
            opening = self.open(form)
        except SyntaxProblem as problem:
            # What the braces hold can be read all the same.
            self.tell(problem)
            self.brackets = self.depth = 0
            self.i = max(self.i, problem.at)
            while self.words[self.i] not in ("{", "", "}") and not (
                self.fresh[self.i] and not self.fresh[self.i - 1] and self.words[self.i] == "model"
            ):
                self.i += 1
            if self.words[self.i] != "{":
                return syntax.Model(name, (), (), doc, self.span(at), name_origin)
            opening = self.i
            self.i += 1
        self.brace_reported = False
        body = self.body(opening, False)
        return syntax.Model(name, generics, body, doc, self.span(at), name_origin)

    def _generics(self) -> tuple[syntax.Generic, ...]:
        opening = self.i
        self.i += 1
        self.brackets += 1
        form = "Structural arguments are whole numbers or truths: `(n : int = 1, fast : bool)`."
        generics: list[syntax.Generic] = []
        while True:
            at = self.i
            name = self.name("the name of a structural argument", form)
            self._colon(form)
            type = self.words[self.i]
            if type not in ("int", "bool"):
                raise self.unexpected("`int` or `bool`", form)
            self.i += 1
            default = None
            if self.words[self.i] == "=":
                self.i += 1
                default = self.expression()
            generics.append(syntax.Generic(name, type, default, self.span(at)))
            if self.words[self.i] != ",":
                break
            self.i += 1
        self.close(")", opening, "`,` or `)`")
        return tuple(generics)
