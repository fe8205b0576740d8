"""Expressions written outside of a model file, in a scenario: its names are paths of the graph."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import TYPE_CHECKING

from bondgraph.frontend.cursor import SyntaxProblem
from bondgraph.frontend.expression_parser import Expressions as Words
from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological
from bondgraph.ir.graph import Value
from bondgraph.ir.syntax import Ref
from bondgraph.ir.unit import Dimension
from bondgraph.library.units import PI
from bondgraph.passes.elaboration.calls import Calls
from bondgraph.passes.elaboration.expressions import Place
from bondgraph.passes.elaboration.problems import Skip, fail, meant
from bondgraph.passes.elaboration.quantities import PURE, Quantities
from bondgraph.passes.elaboration.scope import Typed
from bondgraph.text.diagnostic import Diagnostic, Label, Report
from bondgraph.text.source import Source, Span

if TYPE_CHECKING:
    from bondgraph.passes.elaboration.scope import Scope

TIME = "t"


class Outside(Calls):
    """Reads quantities and expressions in the parameters of a model, and in time where allowed."""

    def __init__(self, pool: Pool, values: Iterable[Value], report: Report) -> None:
        super().__init__(pool, report, Quantities(report))
        self.values = {v.name: v for v in values}
        self.timely = False

    def read(
        self,
        place: Span,
        dimension: Dimension | None,
        what: str,
        timely: bool,
        truth: bool = False,
    ) -> Expr | None:
        """The expression at a place of a text; None, and an error in the report, if it is wrong.

        `dimension` is what it has to have (None: any); with `timely` it may hold the time `t`. A
        `truth` is a condition, or a number that is zero where it does not hold.
        """
        self.timely = timely
        said = Report()
        before, self.report = self.report, said
        self.quantities.report = said
        try:
            return self._read(place, dimension, what, truth)
        except Skip:
            return None
        finally:
            self.report = self.quantities.report = before
            for found in said.diagnostics:
                before.add(_at_home(found, place.source))

    def _read(self, place: Span, dimension: Dimension | None, what: str, truth: bool) -> Expr:
        text = place.source.text
        blank = re.sub(r"[^\n]", " ", text)
        alone = Source(place.source.path, blank[: place.start] + place.text + blank[place.end :])
        words = Words(alone, self.report)
        origin = Span(alone, place.start, place.end)
        if not place.text.strip():
            fail(self.report, "scenario-value", f"{what} is empty.", origin,
                 help='Write a number with its unit, as in "5 V", or an expression.')  # fmt: skip
        try:
            tree = words.expression()
            if words.i < len(words.words) and words.words[words.i] not in ("", "\n"):
                raise words.unexpected("the end of the expression", "Write one expression here.")
        except SyntaxProblem as problem:
            words.tell(problem)
            raise Skip from None
        scope: Scope = None  # type: ignore[assignment]  # names are paths: nothing is looked up
        node, term = (self.convert if truth else self.quantity)(tree, Place(scope, {}, ""))
        if any(n.op is Op.DER or _is_integral(n) for n in topological([node])):
            fail(self.report, "scenario-value", f"{what} has an integral or derivative in it.",
                 origin, help="Write it as a function of t itself: it has no memory.")  # fmt: skip
        if term is None:
            return node
        if dimension is not None:
            known = self.quantities.known(dimension, origin, what)
            self.alike(term, known, origin, f"{what} has the unit of the model")
        return node

    def is_value(self, name: str, place: Place) -> bool:
        """Whether a parameter of the model is called so."""
        return name in self.values

    def no_mode(self, ref: Ref, place: Place) -> None:
        """There are no inputs here."""

    def reference(self, ref: Ref, place: Place) -> Typed:
        """The time, pi, or a parameter by its path."""
        name = ref.origin.text.replace(" ", "")
        if name == "pi" and name not in self.values:
            return self.pool.num(PI), PURE
        if name == TIME and self.timely:
            # a plain number of seconds, so that `sin(2*pi*t)` needs no unit
            return self.pool.symbol(TIME, Kind.INPUT), (
                self.quantities.dimensions.fresh(ref.origin, "time")
            )
        value = self.values.get(name)
        if value is None:
            known = [*self.values, *([TIME] if self.timely else [])]
            extra = ", of time `t` in seconds" if self.timely else ""
            fail(self.report, "unknown-name", f"The model has no parameter `{name}`.", ref.origin,
                 help=meant(name, known, f"Expressions are made of parameters{extra} and numbers.",
                            ref.origin))  # fmt: skip
        if value.dimension is None:
            return value.symbol, self.quantities.dimensions.fresh(ref.origin, f"`{name}`")
        return value.symbol, self.quantities.known(value.dimension, ref.origin, f"`{name}`")


def _is_integral(node: Expr) -> bool:
    return node.kind is Kind.INTEGRAL


def _at_home(found: Diagnostic, source: Source) -> Diagnostic:
    """The finding with its places in the whole text instead of in the expression alone."""
    labels = tuple(
        Label(Span(source, s.start, s.end), text) if s.source.path == source.path else
        Label(s, text) for s, text in found.labels
    )  # fmt: skip
    return found._replace(labels=labels)
