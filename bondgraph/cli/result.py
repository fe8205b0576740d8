"""The machine-readable result of a compilation: one JSON object, described in docs/json.md."""

from __future__ import annotations

from collections.abc import Iterable

from bondgraph.algebra.present import tidy
from bondgraph.cli.reasons import message, reason
from bondgraph.compilation import Compilation
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.residuals import Residual
from bondgraph.ir.signature_matrix import Detectability, ModeSignatures
from bondgraph.notation.latex import latex, lettered
from bondgraph.notation.parsable import Names, parsable
from bondgraph.notation.typeset import Letters


def result(compilation: Compilation, files: Iterable[str]) -> dict[str, object]:
    """The result of a compilation that went well; `files` are the paths that were written.

    `status` is ok, or no_arr where the model has no redundancy. Raises `CompileError` as the
    stages do.
    """
    from bondgraph.text.render import as_json

    graph = compilation.graph
    matrix = compilation.signatures
    names, spelled = Names(graph.names), lettered(graph.names)
    lasting, best = compilation.detectability, compilation.maximum_isolability
    arrs = [
        _arr(graph, residual, lasting, names, spelled)
        for residual in compilation.residuals.residual_set.residuals
    ]
    used = {symbol for _, symbols in arrs for symbol in symbols}
    return {
        "status": "ok" if arrs else "no_arr",
        "message": message(compilation),
        "diagnostics": as_json(tuple(compilation.report.diagnostics)),
        "model": graph.name,
        "n_arr": len(arrs),
        "files": list(files),
        "arrs": [arr for arr, _ in arrs],
        "missing": [
            {
                "about": missing.about.name,
                "reason": missing.finding.message,
                "elements": list(missing.elements),
            }
            for missing in compilation.residuals.missing
        ],
        "symbols": [plain for plain in names.by_model.values() if plain in used],
        "names": {
            plain: names.known_as.get(plain, name)
            for name, plain in names.by_model.items()
            if plain in used
        },
        "undetectable": list(matrix.undetectable),
        "reasons": {fault: reason(compilation, fault) for fault in matrix.undetectable},
        "weak": list(lasting.only_weak),
        "groups": [list(group) for group in matrix.groups],
        "best": None if best is None else [list(group) for group in best],
        **_modes(compilation.mode_signatures),
    }


def _modes(found: ModeSignatures) -> dict[str, object]:
    """The signatures of each mode of a switched model; nothing for another model."""
    if not found.modes:
        return {}
    listed: list[dict[str, object]] = []
    for mode in found.modes:
        item: dict[str, object] = {"inputs": dict(mode.modes)}
        if mode.matrix is None:
            item["reason"] = mode.reason
        else:
            matrix = mode.matrix
            item["signatures"] = {r: list(seen) for r, seen in matrix.sees.items()}
            item["undetectable"] = list(matrix.undetectable)
            item["groups"] = [list(group) for group in matrix.groups]
            item["stuck"] = mode.stuck
            if mode.impossible:
                item["impossible"] = dict(mode.impossible)
        listed.append(item)
    return {"modes": listed, "modes_total": found.total}


def _arr(
    graph: BondGraph,
    residual: Residual,
    lasting: Detectability,
    names: Names,
    spelled: Letters,
) -> tuple[dict[str, object], tuple[str, ...]]:
    root = tidy(graph.pool, *graph.pool.logged([residual.expr]))[0]
    matrix, weak = lasting.matrix, lasting.weak(residual.name)
    written = parsable(graph.pool, root, names, graph.initial_values())
    arr: dict[str, object] = {
        "name": residual.name,
        "expr": written.expr,
        "symbols": list(written.symbols),
        "orders": dict(matrix.orders[matrix.residuals.index(residual.name)]),
        "signature": list(matrix.signature(residual.name)),
        "weak": None if weak is None else list(weak),
    }
    if elsewhere := matrix.only_off_nominal(residual.name):
        arr["only_off_nominal"] = {fault: list(values) for fault, values in elsewhere.items()}
    if residual.name in matrix.unconfirmed:
        arr["unconfirmed"] = list(matrix.faults)
        arr["unconfirmed_reason"] = matrix.unconfirmed[residual.name]
    if residual.free_of is not None:
        arr["free_of"] = residual.free_of
    if written.implicit:
        arr["implicit"] = {name: zero for name, zero, _ in written.implicit}
        arr["guess"] = {name: guess for name, _, guess in written.implicit}
    if written.defs:
        arr["defs"] = [list(definition) for definition in written.defs]
    else:
        arr["latex"] = latex(root, graph.initial_values(), spelled)
    return arr, written.symbols
