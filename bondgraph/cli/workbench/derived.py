"""What is told of a sound text when nobody types: residuals, their derivations, signatures."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from bondgraph import Compilation
from bondgraph.backends.report.formulas import Typesetter
from bondgraph.cli.live import links, targets
from bondgraph.cli.reasons import message, missing
from bondgraph.cli.reporting.collect import matrix
from bondgraph.cli.reporting.relations import derived_steps, relations
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.program import Program
from bondgraph.ir.residuals import Residual
from bondgraph.text.diagnostic import CompileError

#: What a source of this unit gives in a machine of ordinary size, to begin with.
_USUAL = {"V": "6", "N": "10", "N.m": "0.01", "rad/s": "10", "m/s": "0.1", "Pa": "1e5",
          "m^3/s": "1e-4", "K": "20", "W": "100", "W/K": "0.3"}  # fmt: skip


def derived(compilation: Compilation, version: int) -> dict[str, Any]:
    """The message for the page; `status` is ok, no_arr, or wrong with the reason as `message`."""
    found: dict[str, Any] = {"type": "derived", "version": version, "status": "wrong"}
    try:
        _ = compilation.signatures
        _ = compilation.verification
        program = compilation.program if compilation.residuals else None
    except CompileError as error:
        return found | {"message": str(error), "help": helping(error)}
    graph, typesetter = compilation.graph, _typesetter(compilation)
    return found | {
        "status": "ok" if compilation.residuals else "no_arr",
        "message": message(compilation),
        "relations": list(_relations(compilation, typesetter, program)),
        "missing": [list(pair) for pair in missing(compilation)],
        "signatures": _plain(matrix(compilation, program)),
        "links": links(graph),
        "inputs": list(_inputs(graph)),
        "targets": [t._asdict() for t in targets(graph)],
        "docs": {x.name: x.doc for items in (graph.values, graph.inputs, graph.sensors)
                 for x in items if x.doc},
    }


def replayed(compilation: Compilation, name: str, version: int) -> dict[str, Any]:
    """The message with the derivation of a residual; without one it says why in `message`."""
    found: dict[str, Any] = {"type": "derivation", "version": version, "name": name, "parts": []}
    try:
        steps = derived_steps(compilation, _typesetter(compilation), name)
    except (CompileError, KeyError) as error:
        return found | {"message": str(error)}
    parts = [dict(zip(("title", "steps", "ending"), _plain(part), strict=True)) for part in steps]
    return found | {"parts": parts}


def _typesetter(compilation: Compilation) -> Typesetter:
    graph = compilation.graph
    names = [x.name for items in (graph.values, graph.inputs, graph.sensors) for x in items]
    names += [v.symbol.name for e in compilation.equations.equations for v in e.variables]
    return Typesetter(names, graph.initial_values())


def helping(error: CompileError) -> str:
    """What to do about the first thing that is wrong."""
    return next((d.help for d in error.diagnostics if d.severity == "error"), "")


def _relations(
    compilation: Compilation, typesetter: Typesetter, program: Program | None
) -> Iterator[dict[str, Any]]:
    """The relations as in the report, each with the nodes that its causal path runs through."""
    parts = relations(compilation, typesetter, program)
    for part, relation in zip(parts, compilation.residuals, strict=True):
        residual = relation.residual
        nodes = compilation.graph.nodes
        last = residual.closing.node
        yield {
            **_plain(part),
            "nodes": _through(compilation.graph, residual),
            "closed_at": nodes[last].path if last >= 0 else None,
        }


def _through(graph: BondGraph, residual: Residual) -> list[str]:
    """The nodes whose equations a relation is made of, in the order in which it needs them."""
    numbers = [step.equation.node for step in residual.steps] + [residual.closing.node]
    return [graph.nodes[n].path for n in dict.fromkeys(numbers) if n >= 0]


def _inputs(graph: BondGraph) -> Iterator[dict[str, Any]]:
    """What is told to a machine, with a value to begin with: its sources push, loads are none."""
    own = {node.path for node in graph.nodes if node.kind in ("Se", "Sf")}
    items = [item for item in graph.inputs if not item.of]
    driving = {item.name for item in items if item.name in own} or {item.name for item in items}
    for item in items:
        unit = "" if item.unit in (None, "1") else item.unit or ""
        first = _USUAL.get(unit, "1") if item.name in driving else "0"
        yield {
            "name": item.name,
            "unit": unit,
            "mode": item.mode,
            "doc": item.doc,
            "first": "true" if item.mode else first,
        }


def _plain(value: Any) -> Any:
    """Records as dictionaries, all the way down."""
    if hasattr(value, "_asdict"):
        return {key: _plain(item) for key, item in value._asdict().items()}
    if isinstance(value, tuple | list):
        return [_plain(item) for item in value]
    return value
