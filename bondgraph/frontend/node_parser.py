"""Reads nodes of a chain: declarations with arguments, value and law, references, arrows."""

from __future__ import annotations

from bondgraph.frontend.cursor import Cursor, SyntaxProblem
from bondgraph.frontend.declarations import NAME_HELP, Declarations
from bondgraph.frontend.words import is_arrow, say
from bondgraph.ir import syntax
from bondgraph.text.diagnostic import Label, Remedy, replacing
from bondgraph.text.source import Span

_NODE_HELP = "Write a node: `R:name` declares one, `name` means one declared elsewhere."


class Nodes(Declarations):
    """The part of the parser that reads what stands between the arrows, and the arrows."""

    #: whether an unclosed brace was reported: the outer ones follow from it
    brace_reported = False

    # ------------------------------------------------------- ends of statements

    def _model_begins(self, at: int, opening: int) -> bool:
        """Whether the next model begins here: the brace before it was left open."""
        return (
            self.words[at] == "model"
            and self.fresh[at]
            and self.words[at + 1].isidentifier()
            and self.words[at + 2] in ("{", "(")
            and not self.fresh[at + 2]
            and (not self.indent(at) or self.indent(at) < self.indent(opening))
        )

    def unclosed(self, opening: int, end: int) -> None:
        """Complain, once for all braces still open, about the one that was not closed."""
        if self.brace_reported:
            return
        self.brace_reported = True
        likely = suspect(self, opening, end)
        labels = [Label(self.word_span(likely or opening), "opened here")]
        if likely is not None:
            labels.append(Label(self.word_span(opening), "this one then has no end"))
        self.complain(
            "syntax-unclosed",
            "This brace is not closed.",
            *labels,
            help="Add the missing `}`.",
        )

    def _statement_end(self) -> None:
        at = self.i
        word = self.words[at]
        if word == "else" and self.words[at + 1] in ("{", "if"):
            raise self.problem(
                "syntax-unexpected",
                "This `else` belongs to no `if`.",
                at,
                "no `if` before this",
                help="`else` follows the closing brace of `if n > 1 { ... }`.",
            )
        if self.fresh[at] or word == ";" or word == "}":
            return
        odd = self.odd_word(at)
        if odd is not None:
            raise odd
        from bondgraph.frontend.habits import (
            arrow,
            bracketed_unit,
            choice,
            decimal,
            factor,
            percent,
            several,
        )

        help: str | Remedy = "End the statement with a line end or `;`."
        meant = (
            several(self, at) or choice(self, at) or factor(self, at) or decimal(self, at)
            or arrow(self, at) or bracketed_unit(self, at) or percent(self, at)
        )  # fmt: skip
        if meant is not None:
            help = meant
        elif word == "," or word == "=":
            help = "Equations and statements are separated by a line end or `;`."
        elif word == "(":
            help = "End the statement with a line end or `;`; a product needs its sign `*`."
        elif word == ".":
            help = (
                "A node is declared by its name alone: write it in a statement of its own, "
                "`Model:part`, and then its port, `part.port`."
            )
        raise self.unexpected("the end of the statement", help)

    # --------------------------------------------------------- nodes and arrows

    def _arrow(self) -> syntax.Arrow:
        at = self.i
        word = self.words[at]
        self.i = at + 1
        label = word[word.index("[") + 1 : word.index("]")].strip() if "[" in word else None
        return syntax.Arrow(word[0] == "-", label, self.word_span(at))

    def _node(self) -> syntax.Node | syntax.Ref:
        at = self.i
        word = self.words[at]
        if self.words[at + 1] != ":" or self.fresh[at + 1]:
            if not word.isidentifier() or self.begins_statement(at):
                raise self.unexpected("a node", _NODE_HELP)
            return self.ref()
        plain = word in ("0", "1")
        if not plain:
            if not word.isidentifier():
                raise self.unexpected(
                    "the type of a node", "Junctions are `0:name` and `1:name`, elements `R:name`."
                )
            self.name("the type of a node", _NODE_HELP)
        self.i = at + 2
        self.same_line("the name of the node", NAME_HELP)
        name = self.part("the name of the node", NAME_HELP)
        arguments: tuple[syntax.Argument, ...] = ()
        value = tolerance = law = None
        if self.words[self.i] == "(" and not self.fresh[self.i]:
            self._plain_junction(plain)
            arguments = self._arguments()
        if self.words[self.i] == "=" and not self.fresh[self.i]:
            self._plain_junction(plain)
            self.i += 1
            value = self.node_value()
            tolerance = self.tolerance()
        if not plain and self.at_open():
            if is_arrow(self.words[self.i + 1]):
                raise self._bonds_at_element(at, name)
            law = self._law()
        return syntax.Node(word, name, arguments, value, tolerance, law, self.span(at))

    def _bonds_at_element(self, at: int, name: syntax.Part) -> SyntaxProblem:
        """`R:j { <- Se:U }` opens an element as if it were a junction."""
        type = self.word_span(at)
        edits = [replacing(type, kind).edits[0] for kind in ("1", "0")]
        shown = say(f"{self.words[at]}:{name.name}")
        return SyntaxProblem(
            "not-a-junction",
            f"{shown} is no junction: its braces hold its law, and no bonds.",
            (Label(self.word_span(self.i + 1), "a bond"), Label(type, "neither `0` nor `1`")),
            Remedy(
                f"Bonds stand in the braces of a junction: `1:{name.name} {{ ... }}` where they "
                f"share the flow, `0:{name.name} {{ ... }}` where they share the effort.",
                tuple(edits),
            ),
            self.i,
        )

    def _plain_junction(self, plain: bool) -> None:
        if plain:
            raise self.problem(
                "junction-value",
                "A junction has no value and no arguments: it only joins bonds.",
                self.i,
                "this does not belong to a junction",
                help="Put the value on an element bonded to it: `-> R:name = 3 Ohm`.",
            )

    def _arguments(self) -> tuple[syntax.Argument, ...]:
        opening = self.i
        self.i += 1
        self.brackets += 1
        form = "Arguments have names: `(n = 3, q0 = 0 rad)`."
        arguments: list[syntax.Argument] = []
        while True:
            at = self.i
            if not self.words[at].isidentifier():
                raise self.unexpected("the name of an argument", form)
            target = self.ref()
            if self.words[self.i] != "=":
                raise self.unexpected("`=`", form, Label(self.word_span(opening), "opened here"))
            self.i += 1
            value = self.expression()
            arguments.append(syntax.Argument(target, value, self.span(at)))
            if self.words[self.i] != ",":
                break
            self.i += 1
        self.close(")", opening, "`,` or `)`")
        return tuple(arguments)

    # --------------------------------------------------------------------- laws

    def _law(self) -> syntax.Law:
        """The braces of an element; like a body, it reports its own errors."""
        opening = self.i
        self.notes.laws.append(opening)
        self.i += 1
        ports: list[syntax.Part] = []
        equations: list[syntax.Equation] = []
        depth, errors = self.depth, self.errors
        words = self.words
        while True:
            while words[self.i] == ";":
                self.i += 1
            begin = self.i
            if words[begin] == "}":
                self.i = begin + 1
                break
            if self._ends_law(begin, opening):
                self.unclosed(opening, begin)
                break
            self.notes.begins.append(begin)
            try:
                if words[begin] == "port" and words[begin + 1].isidentifier():
                    self.i = begin + 1
                    ports.append(self.part("the name of a port of the field", NAME_HELP))
                else:
                    equations.append(self._equation())
                self._statement_end()
            except SyntaxProblem as problem:
                self.depth = depth
                self.tell(problem)
                self.i = max(self.i, problem.at)
                self.skip_statement(begin)
        if not equations and self.errors == errors:
            raise self.problem(
                "law-empty",
                "The braces of an element hold its law, and there is no equation in them.",
                opening,
                "these braces",
                help="Write an equation in e, f, q, p: `{ e = R*f }`; or leave out the braces.",
            )
        return syntax.Law(tuple(ports), tuple(equations), self.span(opening))

    def _ends_law(self, at: int, opening: int) -> bool:
        """Whether word `at` cannot belong to the law: its brace was left open."""
        if not self.words[at] or self._model_begins(at, opening):
            return True
        if not self.fresh[at] or self.indent(at) > self.indent(opening):
            return False
        port = self.words[at] == "port"
        return self.words[at + 1] == ":" or (not port and self.begins_statement(at))

    def _equation(self) -> syntax.Equation:
        at = self.i
        if is_arrow(self.words[at]):
            raise self.unexpected(
                "an equation",
                "The braces of an element hold its law; bonds stand in the braces "
                "of a junction, `0:name { ... }` or `1:name { ... }`.",
            )
        left = self.expression()
        help: str | Remedy = "A law is an equation: `e = R*f`, or `0 = e - R*f`."
        if isinstance(left, syntax.Binary) and left.op == "==" and self.words[self.i] != "=":
            sign = self.source.text.index("==", left.left.origin.end)
            place = Span(self.source, sign, sign + 2)
            raise SyntaxProblem(
                "syntax-unexpected", "I expected `=`, but I found `==`.",
                (Label(place, "`=` expected here"),),
                replacing(place, "=", "A law has one `=`; two compare, as in a condition."), self.i,
            )  # fmt: skip
        if self.words[self.i : self.i + 2] == [":", "="]:
            place = Span(self.source, self.starts[self.i], self.end_of(self.i + 1).start)
            help = replacing(place, "=", "A law is an equation, with `=`.")
        self.take("=", "`=`", help)
        return syntax.Equation(left, self.expression(), self.span(at))


def suspect(cursor: Cursor, opening: int, end: int) -> int | None:
    """The brace between `opening` and `end` whose `}` stands further left than its line begins.

    The author closed an outer brace there: the inner one was forgotten. None if no brace looks so.
    """
    pending: list[int] = []
    for at in range(opening + 1, end):
        word = cursor.words[at]
        if word == "{":
            pending.append(at)
        elif word == "}":
            if not pending:
                return None
            opened = pending.pop()
            if cursor.fresh[at] and cursor.indent(at) < cursor.indent(opened):
                return opened
    return None
