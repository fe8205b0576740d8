"""Declarations that were not meant as such: `1:i` where `i` is meant, `0:h[2]` for a second h."""

from __future__ import annotations

import re

from bondgraph.ir.syntax import Node, Part
from bondgraph.library.elements import PASSIVE
from bondgraph.passes.elaboration.problems import Skip, listed
from bondgraph.passes.elaboration.scope import Array, Named, NodeEntry, Scope
from bondgraph.text.diagnostic import Edit, Label, Remedy, Report
from bondgraph.text.source import Span

_SHOWN = 3  # places of one finding
_ONE_PORTS = (*PASSIVE, "Se", "Sf", "De", "Df")


class DeclaredAgain:
    """What one instance declares again; reading goes on as if its author had written it right."""

    def __init__(self, report: Report) -> None:
        self.report = report
        #: nodes that stand in a statement of their own, without a bond
        self.alone: set[NodeEntry | Scope] = set()
        self._names: dict[str, tuple[NodeEntry | Scope, list[Span]]] = {}
        self._first: dict[tuple[bool, str], Part] = {}
        self._sizes: dict[str, list[Part]] = {}

    # ---------------------------------------------------------------- bare names

    def node(self, node: Node, scope: Scope, alone: bool) -> NodeEntry | Scope | None:
        """The node that this declaration repeats, where the bare name of it would do."""
        before = scope.nodes.get(node.name.name)
        if node.name.first is not None or not isinstance(before, NodeEntry | Scope):
            return None
        new = _plain(node)
        if isinstance(before, Scope):
            same = before.model.name == node.type and new
        else:
            one_port = before.element is not None and before.element.kind in _ONE_PORTS
            same = before.type == node.type and (new or _plain(before.declaration))
            # with a bond here and there it would have two: another one was meant
            same = same and (not one_port or alone or before in self.alone)
        if not same or node.origin == before.origin:
            return None
        self._repeated(node.name.name, before, node.origin if new else before.origin)
        if not new and isinstance(before, NodeEntry):
            before.declaration, before.origin = node, node.origin
        return before

    def junction(self, before: Named | None, entry: NodeEntry) -> NodeEntry | None:
        """The junction that braces with a type open again."""
        if not isinstance(before, NodeEntry) or before.type != entry.type or (
            before.when is not None and entry.when is not None
        ) or before.origin == entry.origin:  # fmt: skip
            return None
        self._repeated(entry.name, before, _with_type(before if entry.when else entry))
        if entry.when is not None:
            before.when, before.origin = entry.when, entry.origin
        return before

    def _repeated(self, name: str, before: NodeEntry | Scope, place: Span) -> None:
        self._names.setdefault(name, (before, []))[1].append(place)

    # ------------------------------------------------------------------- indices

    def another_size(self, part: Part, nodes: bool, before: Named | None, size: int) -> bool:
        """Whether an index declares an array that there is already, with another size."""
        first = self._first.setdefault((nodes, part.name), part)
        if not isinstance(before, Array) or first is part or size == max(before.entries, default=0):
            return False
        self._sizes.setdefault(part.name, [first]).append(part)
        if size in before.entries:
            raise Skip
        return True

    # -------------------------------------------------------------------- telling

    def tell(self, scope: Scope) -> None:
        """Report what was noted: each name once, all arrays together."""
        for name, (entry, places) in self._names.items():
            kind = entry.type if isinstance(entry, NodeEntry) else entry.model.name
            times = "twice" if len(places) == 1 else f"{len(places) + 1} times"
            edit = Edit(f"write `{name}`", tuple((place, name) for place in places))
            self.report.error(
                "duplicate-name", f"`{kind}:{name}` is declared {times}.",
                *[Label(place, f"`{name}` is meant") for place in places[:_SHOWN]],
                Label(entry.origin, "declared here"),
                help=Remedy("A type declares a node, once; everywhere else its name alone means "
                            f"it, `{name}`.", (edit,)),
            )  # fmt: skip
        if self._sizes:
            self._tell_sizes(scope)

    def _tell_sizes(self, scope: Scope) -> None:
        name, parts = next(iter(self._sizes.items()))
        first, second = parts[0], parts[1]
        more = f" So are those of {listed([*self._sizes][1:])}." if len(self._sizes) > 1 else ""
        self.report.error(
            "array-size", f"The index in a declaration is the size of an array: "
            f"`{second.origin.text}` declares all `{name}` up to there, not one more.{more}",
            *[Label(part.origin, "") for part in (second, first, *parts[2:])[:_SHOWN]],
            help=Remedy(f"Declare all at once, `{max((p.origin.text for p in parts), key=_number)}"
                        f"`, and mean each by its index; or give each a name, `{name}1` and "
                        f"`{name}2`. In a `for` loop, `{name}[j]` declares one.",
                        self._named(scope)),
        )  # fmt: skip

    def _named(self, scope: Scope) -> tuple[Edit, ...]:
        """`h[1]` as `h1`, wherever it stands; none where an index is no number or h1 is taken."""
        place = scope.model.origin
        names = "|".join(self._sizes)
        text = place.text
        found = list(re.finditer(rf"(?<![\w.])({names})\s*\[\s*(\d+)\s*\]", text))
        if len(found) < len(re.findall(rf"(?<![\w.])(?:{names})\s*\[", text)):
            return ()
        taken = scope.nodes.keys() | scope.values.keys()
        if scope.parent is not None or any(f[1] + f[2] in taken for f in found):
            return ()
        changes = tuple(
            (Span(place.source, place.start + f.start(), place.start + f.end()), f[1] + f[2])
            for f in found
        )
        return (Edit("give each a name", changes),)


def _plain(node: Node | None) -> bool:
    return node is not None and not node.arguments and node.value is None and node.law is None


def _with_type(entry: NodeEntry) -> Span:
    """Where `1:j` stands: of braces, the origin is the name alone."""
    origin, before = entry.origin, f"{entry.type}:"
    start = origin.start - len(before)
    if origin.text.startswith(before) or origin.source.text[start : origin.start] != before:
        return origin
    return Span(origin.source, start, origin.end)


def _number(text: str) -> int:
    digits = re.search(r"\d+", text.partition("[")[2])
    return int(digits[0]) if digits else 0
