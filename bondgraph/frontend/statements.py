"""Reads what stands in the braces of a model: junctions, nodes, bonds, laws, loops."""

from __future__ import annotations

from bondgraph.frontend.cursor import SyntaxProblem
from bondgraph.frontend.node_parser import Nodes
from bondgraph.frontend.words import KEYWORDS, is_arrow, say
from bondgraph.ir import syntax
from bondgraph.text.diagnostic import Label, replacing
from bondgraph.text.limits import BRACKETS

#: After one of these a keyword is an ordinary name: `port -> x`, `input { ... }`, `let:x`.
_NAME_FOLLOWERS = frozenset([":", ".", "[", "{", ";", "}", ""])


class Statements(Nodes):
    """The part of the parser that reads what stands in the braces of a model."""

    #: the variables of the `for` loops around the cursor
    loops: tuple[str, ...] = ()

    def body(self, opening: int, inside: bool) -> tuple[syntax.Statement, ...]:
        """Statements up to the closing brace; `inside`: bonds may begin with an arrow.

        The cursor stands after the brace opened at word `opening`. Errors are reported here, one
        statement each, and reading goes on with the next statement.
        """
        statements: list[syntax.Statement] = []
        words = self.words
        self.depth += 1
        depth = self.depth
        if depth > BRACKETS:
            self.i = opening
            raise self.too_deep(opening)
        while True:
            while words[self.i] == ";":
                self.i += 1
            begin = self.i
            word = words[begin]
            if word == "}":
                self.i = begin + 1
                break
            if not word or self._model_begins(begin, opening):
                self.unclosed(opening, begin)
                break
            self.notes.begins.append(begin)
            try:
                found = self.statement(inside)
                self._statement_end()
                statements += found
            except SyntaxProblem as problem:
                self.depth = depth
                self.tell(problem)
                self.i = max(self.i, problem.at)
                self.skip_statement(begin)
        self.depth -= 1
        return tuple(statements)

    def statement(self, inside: bool) -> tuple[syntax.Statement, ...]:
        """One statement; `inside` a junction body it may be a bond that begins with an arrow.

        A chain that ends with the braces of a junction is two.
        """
        at = self.i
        word = self.words[at]
        if word in KEYWORDS and not self._is_name(at):
            match word:
                case "param" | "const":
                    return (self._param(word),)
                case "let":
                    return (self._let(),)
                case "port":
                    return (self._port(),)
                case "input":
                    return (self._input(),)
                case "sensor":
                    return (self._sensor(),)
                case "fault":
                    return (self._fault(),)
                case "for":
                    return (self._for(inside),)
                case "if":
                    return (self._if(inside),)
                case "model":
                    raise self.problem(
                        "model-in-model",
                        "A model stands inside another one.",
                        at,
                        "this model",
                        help="Move it out of the braces, and use it here: `Name:part`.",
                    )
                case _:
                    raise self.unexpected(
                        "a statement",
                        f"`{word}` stands at the top of the file, outside all braces.",
                    )
        return self._chain_or_junction(inside)

    def _is_name(self, at: int) -> bool:
        """Whether the keyword at `at` is used as the name of a node."""
        after = self.words[at + 1]
        return self.fresh[at + 1] or after in _NAME_FOLLOWERS or is_arrow(after)

    # -------------------------------------------------------------- structure

    def open(self, help: str) -> int:
        """Take the `{` that must follow; its word number."""
        if not self.at_open():
            at = self.i
            problem = self.unexpected("`{`", help)
            if not (self.words[at] and self.fresh[at] and self.indent(at) > self.indent(at - 1)):
                raise problem
            # What follows is indented like a body: only the brace was forgotten.
            self.tell(problem)
            self.brace_reported = True
            return at - 1
        self.i += 1
        return self.i - 1

    def _for(self, inside: bool) -> syntax.For:
        at = self.i
        self.i = at + 1
        form = "Write `for j in 1..n { ... }`."
        variable = self.name("the name of the loop variable", form)
        self.take("in", "`in`", form)
        first = self.expression()
        self.take("..", "`..`", form)
        last = self.expression()
        opening = self.open(form)
        around, self.loops = self.loops, (*self.loops, variable)
        try:
            body = self.body(opening, inside)
        finally:
            self.loops = around
        return syntax.For(variable, first, last, body, self.span(at))

    def _if(self, inside: bool) -> syntax.If:
        at = self.i
        self.i = at + 1
        condition = self.expression()
        body = self.body(self.open("Write `if n > 1 { ... } else { ... }`."), inside)
        otherwise: tuple[syntax.Statement, ...] = ()
        if self.words[self.i] == "else" and (
            self.words[self.i + 1] in ("{", "if") or not self.fresh[self.i]
        ):
            self.i += 1
            if self.words[self.i] == "if":
                self.depth += 1
                if self.depth > BRACKETS:
                    raise self.too_deep(self.i)
                otherwise = (self._if(inside),)
                self.depth -= 1
            else:
                otherwise = self.body(self.open("Write `else { ... }`."), inside)
        return syntax.If(condition, body, otherwise, self.span(at))

    def _chain_or_junction(self, inside: bool) -> tuple[syntax.Statement, ...]:
        at = self.i
        doc = self.doc(at)
        nodes: list[syntax.Node | syntax.Ref | None] = []
        arrows: list[syntax.Arrow] = []
        last = at
        words = self.words
        if is_arrow(words[at]):
            if not inside:
                raise self._no_start(at)
            nodes.append(None)
            arrows.append(self._arrow())
            last = self.i
            nodes.append(self._node())
        else:
            node = self._node()
            nodes.append(node)
            word = words[self.i]
            if word == "{" or (word == "when" and not self.fresh[self.i]):
                junction = self._junction(at, node, doc)
                if junction is not None:
                    return (junction,)
        while is_arrow(words[self.i]) and not self.fresh[self.i]:
            arrows.append(self._arrow())
            last = self.i
            nodes.append(self._node())
        if not arrows and not isinstance(nodes[0], syntax.Node):
            if not inside and is_arrow(words[self.i]):
                raise self._no_start(self.i)
            if not self.fresh[self.i] and words[self.i] not in (";", "}"):
                from bondgraph.frontend.habits import arrow  # only for a message

                raise self.misspelt(at, sorted(KEYWORDS)) or self.unexpected(
                    "an arrow or `{`", arrow(self, self.i) or _alone(words[at])
                )
            raise self.problem(
                "name-alone",
                f"{say(words[at])} alone says nothing.",
                at,
                "only a name",
                help=_alone(words[at]),
            )
        if not inside and self.fresh[self.i] and is_arrow(words[self.i]):
            raise self._no_start(self.i)
        opened = words[self.i] == "{" or (words[self.i] == "when" and not self.fresh[self.i])
        if arrows and opened:
            chain = syntax.Chain(tuple(nodes), tuple(arrows), doc, self.span(at))
            return self._with_block(chain, last)
        return (syntax.Chain(tuple(nodes), tuple(arrows), doc, self.span(at)),)

    def _with_block(self, chain: syntax.Chain, at: int) -> tuple[syntax.Statement, ...]:
        """`a -> 1:j { ... }` is the chain `a -> 1:j` and then `j { ... }`.

        The last node stands at word `at`. A switched junction is declared before both.
        """
        opening = self.i
        node = chain.nodes[-1]
        assert node is not None
        if isinstance(node, syntax.Node):
            self._one_of_its_name(node, opening)
        junction = self._junction(at, node, "")
        if junction is None:
            raise self.unexpected("the end of the statement", "Only a junction is opened so.")
        if is_arrow(self.words[self.i]) and not self.fresh[self.i]:
            raise self.problem(
                "junction-in-chain",
                "A chain ends where a junction opens its braces.",
                self.i,
                "the chain goes on here",
                Label(self.word_span(opening), "these braces"),
                help="Go on in a statement of its own that begins with the name of the junction, "
                "or inside the braces: `-> x`.",
            )
        again = junction._replace(type="", when=None)
        if junction.when is None:
            return chain, again
        declared = junction._replace(body=())
        return declared, chain._replace(nodes=(*chain.nodes[:-1], junction.name)), again

    def _one_of_its_name(self, node: syntax.Node, opening: int) -> None:
        """Refuse braces after an array of junctions at the end of a chain: which one has them?"""
        index = node.name.first
        if index is None:
            return
        words = self.words
        end = next(i for i in range(opening, 0, -1) if words[i] == "[")
        if node.name.last is None and any(w in self.loops for w in words[end:opening]):
            return
        raise self.problem(
            "junction-in-chain",
            "Braces at the end of a chain belong to one junction, and these follow an array.",
            opening,
            "these braces",
            Label(node.origin, "the array"),
            help="Declare the array with its braces in a statement of its own, "
            f"`{node.type}:{node.name.name}[...] {{ ... }}`, and bond it by its name.",
        )

    def misspelt(self, at: int, keywords: list[str]) -> SyntaxProblem | None:
        """A complaint about a word that is nearly a keyword, `parm R = 2`, or one of elsewhere."""
        word = self.words[at]
        if not word.isidentifier():
            return None
        from bondgraph.frontend.habits import statement_meant  # only for a message

        help = statement_meant(self, at)
        if help is None and self.words[at + 1].isidentifier():
            from difflib import get_close_matches

            close = get_close_matches(word.lower(), keywords, 1, 0.6)
            help = replacing(self.word_span(at), close[0]) if close else None
        if help is None:
            return None
        what = f"There is no statement that begins with {say(word)}."
        return self.problem("unknown-statement", what, at, "not a keyword", help=help)

    def _no_start(self, at: int) -> SyntaxProblem:
        return self.problem(
            "bond-without-start",
            "A bond that begins with an arrow needs a junction around it.",
            at,
            "nothing stands before this arrow",
            help="Write the node before the arrow; a chain over several lines ends its lines "
            "with the arrow. Only in the braces of a junction a bond may begin with an arrow.",
        )

    def _junction(
        self, at: int, node: syntax.Node | syntax.Ref, doc: str
    ) -> syntax.Junction | None:
        """The rest of `1:name when c { ... }` or `name { ... }`; None if it is an element."""
        if isinstance(node, syntax.Ref):
            type, name = "", node
        elif node.type in ("0", "1"):
            type, name = node.type, syntax.Ref((node.name,), node.name.origin)
        else:
            return None
        when = None
        if self.words[self.i] == "when":
            if not type:
                raise self.unexpected(
                    "`{`", "Only where a junction is declared, `when` makes it a switched one."
                )
            self.i += 1
            when = self.expression()
        opening = self.open("A switched junction has braces: `1:sw when on { ... }`.")
        return syntax.Junction(type, name, when, self.body(opening, True), doc, self.span(at))


def _alone(word: str) -> str:
    return (
        f"Declare a node with its type, `R:{word}`, bond it, `{word} -> x`, or open its braces, "
        f"`{word} {{ ... }}`."
    )
