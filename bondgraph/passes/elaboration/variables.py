"""The variables of every node: efforts, flows, states and their initial values."""

from __future__ import annotations

from typing import Literal

from bondgraph.ir.expr import Kind, Pool
from bondgraph.library.elements import ElementKind
from bondgraph.passes.elaboration.build_time import references
from bondgraph.passes.elaboration.problems import Skip
from bondgraph.passes.elaboration.scope import Given, NodeEntry, PortVariables
from bondgraph.passes.elaboration.values import Values


def create(pool: Pool, node: NodeEntry) -> None:
    """The symbols of a node: `x.f`, `x.e`, `gear.f1`, `mic.el.q`."""
    path = node.path
    if not node.ports:
        if node.type == "1":
            node.common = pool.symbol(f"{path}.f", Kind.FLOW)
        else:
            node.common = pool.symbol(f"{path}.e", Kind.EFFORT)
        return
    element = node.element
    two = element is not None and len(element.ports) == 2
    for port in node.ports:
        before, after = (path, port.name) if two or not port.name else (f"{path}.{port.name}", "")
        port.effort = pool.symbol(f"{before}.e{after}", Kind.EFFORT)
        port.flow = pool.symbol(f"{before}.f{after}", Kind.FLOW)
        if element is not None:
            port.stores = _stored(node, port, element)
        if port.stores:
            port.state = pool.symbol(f"{before}.{port.stores}", Kind.STATE)


def _stored(node: NodeEntry, port: PortVariables, element: ElementKind) -> Literal["q", "p", ""]:
    """What a port accumulates; where that may be q or p, the one that the laws use."""
    if len(element.states) < 2:
        return element.states[0] if element.states else ""
    law = node.declaration.law if node.declaration is not None else None
    sides = [side for q in law.equations for side in (q.left, q.right)] if law is not None else []
    used = {tuple([p.name for p in ref.parts]) for side in sides for ref in references(side)}
    found = [s for s in element.states if ((port.name, s) if port.name else (s,)) in used]
    return found[0] if len(found) == 1 else ""


def initial_values(node: NodeEntry, values: Values) -> None:
    """The declared initial states of a storage."""
    if not node.givens or node.element is None:
        return
    for port in node.ports:
        if not port.stores:
            continue
        wanted = f"{port.stores}0"
        target = (port.name, wanted) if port.name else (wanted,)
        found: Given | None = None
        for given in node.givens:
            if tuple([name for name, place in given.parts if place is None]) != target:
                continue
            given.root.used = True
            if found is not None:
                values.report.error(
                    "duplicate-argument", f"`{wanted}` is given twice.", given.argument.origin,
                    found.argument.origin, help="Keep one of them.",
                )  # fmt: skip
            found = given
        if found is not None:
            try:
                _initial(node, port, found, values)
            except Skip:
                continue


def _initial(node: NodeEntry, port: PortVariables, given: Given, values: Values) -> None:
    assert port.state is not None
    name = f"{port.state.symbol.name}0"
    expr, term = values.constant_value(given.bound, node.path, "An initial value")
    port.initial, port.initial_value = values.pool.symbol(name, Kind.INITIAL), expr
    if port.slot >= 0:
        effort, flow = values.quantities.pair(port.slot)
        stored = values.quantities.integrated(flow if port.stores == "q" else effort)
        values.quantities.same(stored, term, given.argument.origin,
                               f"the initial state of `{node.local}` has the unit of its state"
                               )  # fmt: skip
