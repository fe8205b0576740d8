"""The fault signature matrix of a model for its report, and what cannot be told apart."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bondgraph.backends.report.content import Group, MatrixRow, Mode, Signatures
from bondgraph.cli.reasons import reasons

if TYPE_CHECKING:
    from bondgraph.ir.program import Program
    from bondgraph.ir.signature_matrix import ModeSignature, SignatureMatrix
    from bondgraph.pipeline import Compilation


def matrix(compilation: Compilation, program: Program | None) -> Signatures:
    """The matrix with how long each fault shows, the groups, the best there could be, modes."""
    found, best = compilation.signatures, compilation.maximum_isolability
    cells = _cells(compilation, program)
    groups = []
    for number, faults in enumerate(found.groups, 1):
        hits = found.row(faults[0])
        seen = tuple(r for r, hit in zip(found.residuals, hits, strict=True) if hit)
        rows = tuple(MatrixRow(f, cells[f], True, len(faults) == 1) for f in faults)
        parts = tuple(part for part in best or (faults,) if part[0] in faults)
        groups.append(Group(number, seen, rows, parts))
    why = reasons(compilation) if found.undetectable else {}
    modes = compilation.mode_signatures if found.residuals else None
    return Signatures(
        found.residuals,
        tuple(groups),
        tuple((reason, tuple(faults)) for reason, faults in why.items()),
        best,
        () if modes is None else tuple(_mode(m, found) for m in modes.modes),
        0 if modes is None else modes.total - len(modes.modes),
    )


def _cells(compilation: Compilation, program: Program | None) -> dict[str, tuple[str, ...]]:
    """For each fault how each residual sees it."""
    found, lasting = compilation.signatures, compilation.detectability
    blind = {r.path: r.invisible for r in program.residuals} if program else {}
    words = {True: "strong", False: "weak", None: "unsaid"}
    cells: dict[str, tuple[str, ...]] = {}
    for fault, hits, strong in zip(found.faults, found.rows, lasting.strong, strict=True):
        row = []
        for residual, hit, lasts in zip(found.residuals, hits, strong, strict=True):
            unseen = " unseen" if fault in blind.get(residual, ()) else ""
            row.append(words[lasts] + unseen if hit else "")
        cells[fault] = tuple(row)
    return cells


def _mode(mode: ModeSignature, whole: SignatureMatrix) -> Mode:
    name = ", ".join(f"{n} {'on' if on else 'off'}" for n, on in mode.modes.items())
    if mode.matrix is None:
        return Mode(name, mode.reason, (), (), (), False)
    own = mode.matrix
    groups = []
    for faults in own.groups:
        hits = zip(own.residuals, own.row(faults[0]), strict=True)
        groups.append((tuple(r for r, hit in hits if hit), faults))
    lost = tuple(f for f in own.undetectable if f not in whole.undetectable)
    blind = tuple(r for r in own.residuals if not own.signature(r))
    return Mode(name, "", tuple(groups), lost, blind, own.rows == whole.rows)
