"""What is to be known about the name under the cursor, as Markdown."""

from __future__ import annotations

from bondgraph.editor.flat_facts import FlatNode, Quantity, unit_of
from bondgraph.editor.occurrences import Declaration, ModelNames, Occurrence
from bondgraph.editor.residual_facts import ResidualFacts
from bondgraph.editor.workspace import Document
from bondgraph.ir.causal import CausalGraph, Reason
from bondgraph.ir.graph import Bond, Value
from bondgraph.library.elements import KINDS
from bondgraph.library.units import DOMAINS, Domain
from bondgraph.notation.dump_stages import bond_name, reason
from bondgraph.notation.line import show
from bondgraph.text.numerals import listed, plural
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

#: Parts of the machine that come from one declaration and are told one by one.
_TOLD = 2

WORDS = {
    "0": "0-junction: one effort, the flows balance",
    "1": "1-junction: one flow, the efforts balance",
    "R": "resistor", "MR": "modulated resistor", "C": "compliance", "I": "inertia",
    "IC": "field of inertias and compliances",
    "TF": "transformer", "MTF": "modulated transformer", "GY": "gyrator",
    "MGY": "modulated gyrator", "Se": "effort source", "MSe": "modulated effort source",
    "Sf": "flow source", "MSf": "modulated flow source", "De": "effort detector",
    "Df": "flow detector", "instance": "submodel", "port": "port", "param": "parameter",
    "const": "constant", "input": "input", "let": "named expression", "sensor": "sensor",
    "argument": "structural argument", "loop": "loop variable", "fault": "fault",
    "model": "model",
}  # fmt: skip


class Hover(NamedTuple):
    """Markdown about a stretch of the text."""

    span: Span
    text: str


def hover(document: Document, offset: int, residuals: ResidualFacts | None) -> Hover | None:
    """What is known of the name or arrow at a place; None where there is nothing to say."""
    found = document.names.at(offset)
    if found is not None and found.symbol is not None:
        text = _named(document, found, residuals)
        return None if text is None else Hover(found.span, text)
    return _arrow(document, offset)


def _named(
    document: Document, found: Occurrence, residuals: ResidualFacts | None
) -> str | None:
    assert found.symbol is not None
    declared = document.workspace.declaration(found.symbol)
    if declared is None:
        return f"`{found.symbol.name}`: {WORDS[found.kind]}"
    line = " ".join(_statement(declared).split())
    parts = [f"```bg\n{line}\n```"]
    if declared.doc:
        parts.append(declared.doc)
    if declared.kind == "model":
        names = document.workspace.names(declared.symbol.path)
        model = names and names.models.get(declared.symbol.name)
        parts.append(_model(model) if model else "")
        parts.append(residuals.summary(declared.symbol.name) if residuals else "")
    else:
        parts.append(_kind(declared))
    facts = document.facts
    for node in facts.nodes.get(found.symbol, ())[:_TOLD]:
        parts.append(_node(node))
    more = len(facts.nodes.get(found.symbol, ())) - _TOLD
    if more > 0:
        parts.append(f"and {plural(more, 'part')} more of the machine like it")
    for item in facts.quantities.get(found.symbol, ())[:_TOLD]:
        parts.append(_quantity(item))
        if residuals is not None:
            parts.append(residuals.about(item.name))
    return "\n\n".join(filter(None, parts))


def _statement(declared: Declaration) -> str:
    """The first line of what declares it."""
    origin = declared.statement.origin
    return origin.text.split("\n", 1)[0].rstrip(" {") if origin.text else declared.symbol.name


def _kind(declared: Declaration) -> str:
    word = WORDS[declared.kind]
    element = KINDS.get(declared.kind)
    if declared.kind == "instance":
        return f"{word} of the model `{declared.type}`"
    if element is None or not element.law:
        return word
    example = f", such as `{element.law}`" if element.law else ""
    return f"{word}; its law is linear unless it is written in braces{example}"


def _model(model: ModelNames) -> str:
    ports = [n for n, d in model.nodes.items() if d.kind == "port"]
    nodes = sum(d.kind != "port" for d in model.nodes.values())
    text = f"model with {plural(nodes, 'node')}"
    return f"{text} and the ports {', '.join(f'`{p}`' for p in ports)}" if ports else text


def _effort_and_flow(domain: Domain) -> str:
    effort = f"effort: {domain.effort_name} in {domain.effort_unit}"
    return f"{domain.name}; {effort}; flow: {domain.flow_name} in {domain.flow_unit}"


def _node(item: FlatNode) -> str:
    node = item.node
    lines = [f"**{node.path}**"]
    if node.domain and node.domain in DOMAINS and node.domain != "any":
        lines.append(_effort_and_flow(DOMAINS[node.domain]))
    lines += [f"law `0 = {show(law.zero)}`" for law in node.laws]
    lines += [f"- {stroke_told(item.causal, bond)}" for bond in item.bonds()]
    if any(s.node == item.number and not s.integral for s in item.causal.storages):
        lines.append("- it is in derivative causality: its state follows from others")
    if node.when is not None:
        lines.append(f"on while `{show(node.when)}`")
    return "\n".join(lines[:1] + [""] + lines[1:]) if lines[1:] else lines[0]


def stroke_told(causal: CausalGraph, bond: Bond) -> str:
    """Where the stroke of a bond stands, and why."""
    stroke = causal.strokes[bond.number]
    end = bond.tail if stroke.at == "tail" else bond.head
    at = causal.graph.nodes[end.node].path
    return f"`{bond_name(causal.graph, bond)}`: stroke at `{at}`, {_why(causal, stroke.reason)}"


def _why(causal: CausalGraph, found: Reason) -> str:
    """Why a stroke stands there; the bonds that force it by their names."""
    if found.cause != "propagated" or not found.because:
        return reason(causal, found)
    graph = causal.graph
    names = [f"`{bond_name(graph, graph.bonds[b])}`" for b in found.because[:_TOLD]]
    more = len(found.because) - _TOLD
    if more > 0:
        names.append(f"{more} more")
    return f"forced at `{graph.nodes[found.node].path}` by {listed(names, 'and')}"


def _quantity(item: Quantity) -> str:
    unit = unit_of(item)
    text = f"**{item.name}**"
    if isinstance(item, Value) and item.value is not None:
        text += f" = {show(item.value)}" + (" (in SI)" if unit else "")
    if isinstance(item, Value) and item.tolerance is not None:
        text += f" ± {float(100 * item.tolerance):g} %"
    return text + (f", unit `{unit}`" if unit else ", no unit is fixed")


def _arrow(document: Document, offset: int) -> Hover | None:
    """A bond: its strokes where the arrow is used."""
    for (start, end), bonds in document.facts.arrows.items():
        if start <= offset <= end and document.facts.names is document.names:
            span = Span(document.source, start, end)
            lines = [stroke_told(causal, bond) for causal, bond in bonds[:_TOLD]]
            return Hover(span, "\n\n".join(lines))
    return None
