"""Reads the declarations of a model: parameters, inputs, sensors, values, faults, ports."""

from __future__ import annotations

from bondgraph.frontend.cursor import SyntaxProblem
from bondgraph.frontend.expression_parser import Expressions
from bondgraph.ir import syntax
from bondgraph.text.diagnostic import Edit, Remedy, replacing
from bondgraph.text.source import Span

NAME_HELP = "A name begins with a letter and has letters, digits and `_`."


class Declarations(Expressions):
    """The part of the parser that reads statements without braces, each with its keyword."""

    def doc(self, at: int) -> str:
        """The `##` lines that stand directly before word `at`."""
        if not self.has_docs:
            return ""
        docs: list[str] = []
        while True:
            gap = self.gaps.get(at)
            if gap is not None and "##" in gap[1]:
                lines = gap[1].split("\n")
                # The first piece ends the line of the word before: it documents nothing.
                own = lines if at == 0 else lines[1:]
                docs[:0] = [_doc_text(line) for line in own if _is_doc(line)]
            if at == 0 or self.words[at - 1] != ";":
                return "\n".join(docs)
            at -= 1

    def _begun(self) -> tuple[int, str]:
        """Step over a keyword; where it stands, and the text of the `##` comments above it."""
        at = self.i
        self.i = at + 1
        return at, self.doc(at)

    def _colon(self, help: str | Remedy) -> None:
        self.notes.wide_colons.append(self.take(":", "`:`", help))

    def _param(self, keyword: str) -> syntax.Param:
        at, doc = self._begun()
        name = self.part(f"the name of the {keyword}", NAME_HELP)
        if self.words[self.i] == "=" and not self.fresh[self.i]:
            self.i += 1
            value = self.expression()
            tolerance = self.tolerance()
            return syntax.Param(keyword, name, None, value, tolerance, doc, self.span(at))
        from bondgraph.frontend.habits import several  # only for a message

        more = several(self, self.i) if self.words[self.i] == "," else None
        self._colon(
            more or f"Write `{keyword} {name.name} = 3 Ohm`, or `: Ohm` for a value given later."
        )
        unit = self.unit()
        if self.words[self.i] == "=" and not self.fresh[self.i]:
            help = (
                f"A value carries its own unit: `{keyword} {name.name} = 3 {unit}`. "
                f"`: {unit}` alone declares one that is given where the submodel is used."
            )
            raise self.problem(
                "param-unit-and-value",
                f"`{name.name}` has a unit after `:` and a value too.",
                self.i,
                "the value",
                help=Remedy(help, self._with_unit(name, unit)),
            )
        return syntax.Param(keyword, name, unit, None, None, doc, self.span(at))

    def _with_unit(self, name: syntax.Part, unit: str) -> tuple[Edit, ...]:
        """The value of `param R : Ohm = 3` with the unit behind it, where it is a plain number."""
        at = self.i + 1
        number = self.words[at]
        bare = number[:1].isdigit() and (self.fresh[at + 1] or self.words[at + 1] in ("+-", ";"))
        if not bare:
            return ()
        place = Span(self.source, name.origin.end, self.starts[at] + len(number))
        return replacing(place, f" = {number} {unit}").edits

    def _let(self) -> syntax.Let:
        at, doc = self._begun()
        name = self.part("the name of the value", NAME_HELP)
        self.take("=", "`=`", f"Write `let {name.name} = ` and an expression.")
        return syntax.Let(name, self.expression(), doc, self.span(at))

    def _port(self) -> syntax.Port:
        at, doc = self._begun()
        name = self.name("the name of the port", NAME_HELP)
        form = f"Write `port {name} : in electrical`, or `out` and another domain."
        self._colon(form)
        if self.words[self.i] not in ("in", "out") or self.fresh[self.i]:
            raise self.unexpected("`in` or `out`", form)
        direction = self.words[self.i]
        self.i += 1
        self.same_line("the domain of the port", form)
        domain = self.name("the domain of the port", form)
        return syntax.Port(name, direction, domain, doc, self.span(at))

    def _input(self) -> syntax.Input:
        at, doc = self._begun()
        name = self.part("the name of the input", NAME_HELP)
        unit = None
        boolean = False
        if self.words[self.i] == ":" and not self.fresh[self.i]:
            self._colon("")
            boolean = self.keyword("bool")
            word = self.words[self.i]
            if not boolean and word.lower() in ("boolean", "bool", "logical"):
                help = replacing(self.word_span(self.i), "bool", "A mode is an `input ... : bool`.")
                raise self.unexpected("`bool` or a unit", help)
            if not boolean:
                unit = self.unit()
        unknown = self.keyword("unknown")
        if self.words[self.i] == "=" and not self.fresh[self.i]:
            raise self._input_value(at, name, boolean)
        return syntax.Input(name, unit, boolean, unknown, doc, self.span(at))

    def _input_value(self, at: int, name: syntax.Part, boolean: bool) -> SyntaxProblem:
        """`input U = 12 V`: what a log says has no value in the model."""
        equals = self.i
        self.i += 1
        value = self.expression()
        place = self.span(at)
        self.i = equals
        edits: tuple[Edit, ...] = ()
        help = f"A log says what it is, or `simulate --input {name.name}=...`. What is fixed "
        if boolean:
            help += (
                "when the model is put together is an argument of it, "
                f"`model Name({name.name} : bool = true)`."
            )
        else:
            declared = f"param {name.origin.text} = {value.origin.text}"
            help += f"is a `{declared}`, which a source `Se:{name.name}` may give as well."
            edits = replacing(place, declared).edits
            if isinstance(value, syntax.Number) and value.unit is not None:
                only = f"input {name.origin.text} : {value.unit}"
                edits = (*replacing(place, only).edits, *edits)
        return self.problem(
            "input-value",
            f"`{name.origin.text}` is an input and has a value.",
            equals,
            "an input has none in the model",
            help=Remedy(help, edits),
        )

    def _sensor(self) -> syntax.Sensor:
        at, doc = self._begun()
        name = self.part("the name of the sensor", NAME_HELP)
        form = f"Write `sensor {name.name} : rad = ` and what it measures."
        unit = None
        if self.words[self.i] == ":" and not self.fresh[self.i]:
            self._colon(form)
            unit = self.unit()
        self.take("=", "`=`", form)
        value = self.expression()
        counts = None
        if self.keyword("counts"):
            counts = self._counts()
        return syntax.Sensor(name, unit, value, counts, doc, self.span(at))

    def _counts(self) -> syntax.Expression:
        """`24/turn`: an expression whose last division is by the word `turn`."""
        at = self.i
        whole = self.expression()
        if (
            isinstance(whole, syntax.Binary)
            and whole.op == "/"
            and isinstance(whole.right, syntax.Ref)
            and len(whole.right.parts) == 1
            and whole.right.parts[0].name == "turn"
        ):
            return whole.left
        help: str | Remedy = "Write `counts 24/turn`; a sum needs brackets, `counts (n + 1)/turn`."
        if isinstance(whole, syntax.Number) and (whole.unit or "").endswith("/turn"):
            right = f"{whole.text}/turn"
            help = replacing(whole.origin, right, f"Write `counts {right}`, without a unit.")
        raise self.problem(
            "counts-per-turn",
            "The resolution of an encoder is a number of counts per turn.",
            at,
            "this resolution",
            help=help,
        )

    def _fault(self) -> syntax.Fault:
        at, doc = self._begun()
        name = self.part("the name of the fault", NAME_HELP)
        form = f"Write `fault {name.name} : line.R += 100 Ohm`, or `=` or `*=`."
        self._colon(form)
        target = self.ref()
        op = self.words[self.i]
        if op not in ("=", "+=", "*=") or self.fresh[self.i]:
            raise self.unexpected("`=`, `+=` or `*=`", form)
        self.i += 1
        return syntax.Fault(name, target, op, self.expression(), doc, self.span(at))


def _is_doc(line: str) -> bool:
    text = line.lstrip(" \t\ufeff")
    return text.startswith("##") and not text.startswith("###")


def _doc_text(line: str) -> str:
    text = line.strip(" \t\r\ufeff")[2:]
    return text[1:] if text.startswith(" ") else text
