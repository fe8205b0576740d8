"""What the round brackets of a node bind: structure, params, inputs and initial states."""

from __future__ import annotations

from bondgraph.ir.syntax import Argument, Node
from bondgraph.passes.elaboration.build_time import decided, index
from bondgraph.passes.elaboration.problems import fail, listed, meant, rough
from bondgraph.passes.elaboration.scope import (
    Array,
    Bound,
    Env,
    Given,
    Named,
    NodeEntry,
    Scope,
    ValueEntry,
)
from bondgraph.text.diagnostic import Label, Report


class Arguments:
    """Keeps the arguments of a model and sees that each binds something, once."""

    def __init__(self, report: Report) -> None:
        self.report = report
        self.givens: list[tuple[Given, Scope | NodeEntry]] = []

    def structure(self, scope: Scope) -> None:
        """The structural arguments of an instance."""
        for generic in scope.model.generics:
            if generic.name in scope.generics:
                self.report.error(
                    "duplicate-name", f"There are two structural arguments `{generic.name}`.",
                    generic.origin, help="Rename one of them.",
                )  # fmt: skip
            bound: Bound | None = None
            for given in self.matching(scope.givens, generic.name, None):
                if len(given.parts) == 1:
                    given.root.used = True
                    self.once(bound, given)
                    bound = given.bound
            if bound is None:
                if generic.default is None:
                    where = scope.origin if scope.parent else generic.origin
                    fail(self.report, "missing-argument", f"`{scope.model.name}` needs a value of "
                         f"`{generic.name}`.", Label(where, "used here" if scope.parent else ""),
                         Label(generic.origin, "declared without a default"),
                         help=f"Give it where the model is used, `({generic.name} = ...)`, or "
                         f"declare a default: `{generic.name} : {generic.type} = ...`."
                         )  # fmt: skip
                bound = Bound(generic.default, scope, {}, generic.origin)
            value = decided(bound.value, bound.scope, bound.env, self.report)
            if isinstance(value, bool) != (generic.type == "bool"):
                fail(self.report, "wrong-type", f"`{generic.name}` is declared {generic.type}.",
                     Label(bound.origin, "this is not"), Label(generic.origin, "declared here"),
                     help="Give an int or a bool, as declared.")  # fmt: skip
            if not isinstance(value, bool):
                if value.denominator != 1:
                    fail(self.report, "not-an-integer", f"`{generic.name}` is declared int, but "
                         f"given {rough(value)}.", bound.origin,
                         help="Use a whole number.")  # fmt: skip
                scope.generics[generic.name] = value.numerator
            else:
                scope.generics[generic.name] = value

    def arguments(self, node: Node, scope: Scope, env: Env) -> list[Given]:
        """The arguments in round brackets, each with where its value is to be read."""
        return [self.argument(a, scope, env) for a in node.arguments]

    def argument(self, argument: Argument, scope: Scope, env: Env) -> Given:
        """One argument, its target split into names with their indices."""
        parts = tuple([(p.name, index(p, scope, env, self.report)) for p in argument.target.parts])
        return Given(parts, Bound(argument.value, scope, env, argument.origin), argument)

    @staticmethod
    def matching(givens: list[Given], name: str, place: int | None) -> list[Given]:
        """The arguments whose target begins with `name` (of that index, or of none)."""
        return [g for g in givens if g.parts[0][0] == name and g.parts[0][1] in (None, place)]

    def once(self, before: Bound | None, given: Given) -> None:
        """Refuse a second argument for one thing."""
        if before is not None:
            fail(self.report, "duplicate-argument",
                 f"`{given.argument.target.origin.text}` is given twice.",
                 Label(given.argument.origin, "given again"), Label(before.origin, "given here"),
                 help="Keep one of them.")  # fmt: skip

    def refuse_givens(self, entry: NodeEntry, givens: list[Given]) -> None:
        """Only a storage takes arguments (its initial state)."""
        for given in givens:
            given.root.used = True
            self.report.error(
                "unknown-argument",
                f"`{entry.type}:{entry.name}` takes no argument "
                f"`{given.argument.target.origin.text}`.", given.argument.origin,
                help="Round brackets give the initial state of a C (q0) or an I (p0), or bind the "
                "params of a submodel; a coefficient is written after `=`.",
            )  # fmt: skip

    def check_arguments(self) -> None:
        """Report arguments that bind nothing."""
        for given, entry in self.givens:
            if given.used:
                continue
            text = given.argument.target.origin.text
            if isinstance(entry, Scope):
                names = [n for n, v in entry.values.items() if _bindable(v)]
                names += entry.generics
                help = meant(given.parts[0][0], names, f"It takes {listed(names) or 'none'}.")
                message = f"`{entry.model.name}` takes no argument `{text}`."
            else:
                state = entry.element.state if entry.element is not None else None
                help = f"An element of this kind takes `{state}0`, its initial state."
                message = f"`{entry.type}:{entry.name}` takes no argument `{text}`."
            self.report.error("unknown-argument", message, given.argument.origin, help=help)


def _bindable(value: Named) -> bool:
    if isinstance(value, Array):
        return any(_bindable(v) for v in value.entries.values())
    return isinstance(value, ValueEntry) and value.kind in ("param", "const", "input")
