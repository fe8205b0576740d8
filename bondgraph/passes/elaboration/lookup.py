"""Find what a dotted reference means: a node, a port or a value, here or in a submodel."""

from __future__ import annotations

import re
from typing import NoReturn

from bondgraph.ir.syntax import Part, Ref
from bondgraph.library.units import suggest_unit
from bondgraph.passes.elaboration.build_time import index
from bondgraph.passes.elaboration.problems import Skip, fail, listed, meant, written
from bondgraph.passes.elaboration.scope import (
    Array,
    Env,
    Named,
    NodeEntry,
    PortEntry,
    Scope,
    ValueEntry,
)
from bondgraph.text.diagnostic import Label, Remedy, Report, replacing
from bondgraph.text.source import Span

#: A number and what looks like the first part of its unit, before a name.
_UNIT_BEFORE = r"(?<![\w.])([0-9][\w.+-]*) ([^\W\d][\w.^/*\s-]*?[*/])\s*\Z"
_UNIT_AFTER = r"\w+(?:\^-?[0-9]+)?(?:[*/.][^\W\d]\w*(?:\^-?[0-9]+)?)*"
#: What is meant by the time, which no model has.
_TIME = (
    "A model has no time of its own. What is given as a function of time is an `input`; a scenario "
    "of `simulate` says what it is at each t."
)
#: What variables of a law are called in books of a domain, where no other one is called so.
_USUAL = {
    "q": ("x", "z", "theta", "phi", "Q", "Vol", "vol"),
    "p": ("lam", "Lambda", "psi", "flux", "P", "L"),
    "f": ("v", "i", "w", "omega", "I", "vel", "velocity", "current"),
    "e": ("u", "F", "T", "tau", "M", "torque", "force", "voltage", "pressure"),
}


def unit_meant(origin: Span) -> Remedy | None:
    """How a unit that was taken for a product, as in `3 kg*m^2`, has to be spelt."""
    source = origin.source
    column = source.position(origin.start)[1] - 1
    line = source.line(origin.line)
    before = re.search(_UNIT_BEFORE, line[:column])
    after = re.match(_UNIT_AFTER, line[column:])
    if before is None or after is None:
        return None
    unit = suggest_unit("".join((before[2] + after[0]).split()))
    if unit is None:
        return None
    start = origin.start - len(line[:column]) + before.start()
    place = Span(source, start, origin.start + after.end())
    text = f"{before[1]} {unit}"
    return replacing(place, text, f"A unit contains no `*` and no spaces: `{text}`.")


def _indexless(part: Part) -> Remedy:
    return replacing(part.origin, part.name, f"Write `{part.name}` without an index.")


class Lookup:
    """Names to entries; every way to be wrong is reported and raises Skip."""

    def __init__(self, report: Report) -> None:
        self.report = report

    def node(self, ref: Ref, scope: Scope, env: Env) -> tuple[Named, tuple[Part, ...]]:
        """The node that a reference begins with and the parts that are left of it.

        Submodels are entered as far as the reference goes: `m[1].wh.hub.f` is the junction `hub`
        with `f` left; a name that is no node of the last submodel is left too.
        """
        parts = ref.parts
        entry = self.entry(parts[0], scope, scope, env)
        at = 1
        while isinstance(entry, Scope) and at < len(parts) and parts[at].name in entry.nodes:
            entry = self.entry(parts[at], entry, scope, env)
            at += 1
        return entry, parts[at:]

    def entry(self, part: Part, inside: Scope, scope: Scope, env: Env) -> Named:
        """One node of the instance `inside`; its index is read in `scope`."""
        named = inside.nodes.get(part.name)
        if named is None:
            self.no_node(part, inside)
        return self.indexed(part, named, scope, env)

    def no_node(self, part: Part, inside: Scope) -> NoReturn:
        """Report that there is no such node."""
        if part.name in inside.wrong or inside.incomplete:
            raise Skip
        value = inside.values.get(part.name)
        if value is not None:
            fail(self.report, "not-a-node", f"`{part.name}` is a value, not a node.",
                 Label(part.origin, "used as a node"), Label(value.origin, "declared here"),
                 help="Bonds go between junctions, elements, submodels and ports; declare a node "
                 f"with its type, as in `R:{part.name}`.")  # fmt: skip
        parts = [
            n for n, e in inside.nodes.items() if isinstance(e, Scope) and e.model.name == part.name
        ]
        if parts:
            fail(self.report, "not-a-node", f"`{part.name}` is a model, not a part of "
                 f"`{inside.model.name}`.", part.origin, help=written(part.origin, part.name,
                 parts[0]))  # fmt: skip
        fail(self.report, "unknown-name", f"`{inside.model.name}` has no node `{part.name}`.",
             part.origin, help=meant(part.name, inside.nodes, "Declare it with its type, as in "
             f"`1:{part.name}` or `R:{part.name}`.", part.origin))  # fmt: skip

    def indexed(self, part: Part, named: Named, scope: Scope, env: Env) -> Named:
        """The entry itself, or the one of an array that the index of the part names."""
        place = index(part, scope, env, self.report)
        if isinstance(named, Array):
            if place is None:
                fail(self.report, "index-missing", f"`{part.name}` is an array: which is meant?",
                     Label(part.origin), Label(named.origin, "declared here"),
                     help=f"Give an index, `{part.name}[1]`; in a chain of bonds a range, "
                     f"`{part.name}[1..{max(named.entries, default=1)}]`; where each of several has"
                     f" its own, `for j in 1..{max(named.entries, default=1)} {{ ... }}` with"
                     f" `{part.name}[j]`.")  # fmt: skip
            found = named.entries.get(place)
            if found is None:
                self.out_of_range(part, named, place)
            return found
        if place is not None:
            fail(self.report, "index-not-allowed", f"`{part.name}` is not an array.",
                 Label(part.origin), Label(named.origin, "declared here"),
                 help=_indexless(part))  # fmt: skip
        return named

    def out_of_range(self, part: Part, array: Array, place: int) -> NoReturn:
        """Report an index that the array has not."""
        low, high = min(array.entries, default=1), max(array.entries, default=0)
        has = f"from {low} to {high}" if high >= low else "at all (it is empty)"
        fail(self.report, "index-out-of-range", f"There is no `{part.name}[{place}]`.",
             Label(part.origin, f"index {place}"), Label(array.origin, f"has elements {has}"),
             help="Indices count from 1 up to the declared size.")  # fmt: skip

    def value(self, part: Part, inside: Scope, scope: Scope, env: Env) -> ValueEntry | None:
        """The value of that name in an instance, or None if it has none."""
        named = inside.values.get(part.name)
        if named is None:
            return None
        entry = self.indexed(part, named, scope, env)
        assert isinstance(entry, ValueEntry)
        return entry

    def no_value(
        self, ref: Ref, part: Part, inside: Scope, known: tuple[str, ...], own: tuple[str, ...]
    ) -> NoReturn:
        """Report that there is no such value; `own` are the variables of the law that it is in."""
        if part.name in inside.wrong or inside.incomplete:
            raise Skip
        node = inside.nodes.get(part.name)
        if node is not None:
            help = self.signals(node, ref.origin.text)
            if isinstance(node, NodeEntry) and node.common is not None and len(ref.parts) == 1:
                letter = "f" if node.type == "1" else "e"
                help += f" That of the element itself is `{letter}`." if letter in own else ""
            fail(self.report, "not-a-value", f"`{ref.origin.text}` is a node, not a value.",
                 Label(ref.origin, "used as a value"), Label(node.origin, "declared here"),
                 help=help)  # fmt: skip
        name = part.name
        what = f"`{inside.model.name}` has no value `{name}`."
        if len(ref.parts) == 1:
            unit = unit_meant(ref.origin)
            if unit is not None:
                fail(self.report, "unknown-name", what, part.origin, help=unit)
            usual = next((v for v in own if name in _USUAL.get(v, ())), None)
            if usual is not None:
                words = f"Did you mean `{usual}`? The law relates {listed(own)} of the element."
                fail(self.report, "unknown-name", what, part.origin,
                     help=replacing(part.origin, usual, words))  # fmt: skip
        otherwise = f"Declare it, as in `param {name} = 1` or `let {name} = ...`."
        source, end = part.origin.source, part.origin.end
        if name in ("t", "time"):
            otherwise = _TIME
        elif name == "d" and source.text[end:].lstrip().startswith("/"):
            otherwise = "A derivative in time is `der(x)`."
        elif own:
            otherwise += f" The law itself relates {listed(own)}."
        fail(self.report, "unknown-name", what, part.origin,
             help=meant(name, (*known, *inside.values), otherwise, part.origin))  # fmt: skip

    @staticmethod
    def signals(node: Named, text: str) -> str:
        """What can be written to get at the signals of a node."""
        if isinstance(node, Array):
            node = next(iter(node.entries.values()), node)
            text += "[1]"
        if isinstance(node, NodeEntry):
            if node.element is None:
                what = "f` is its common flow" if node.type == "1" else "e` is its common effort"
                return f"`{text}.{what}."
            if len(node.element.ports) == 2:
                return f"Its signals are `{text}.e1`, `{text}.f1`, `{text}.e2` and `{text}.f2`."
            return f"`{text}.e` is its effort, `{text}.f` its flow."
        if isinstance(node, PortEntry):
            return f"`{text}.e` is its effort, `{text}.f` its flow."
        return f"Name one of its values after a point: `{text}.name`."
