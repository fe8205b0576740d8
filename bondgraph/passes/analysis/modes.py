"""The fault signature matrix of each mode of a switched machine, on trajectories of that mode."""

from __future__ import annotations

from bondgraph.exact.from_start import from_start
from bondgraph.exact.plant import ExactUnavailable, Plant
from bondgraph.exact.reactions import Reactions
from bondgraph.exact.switch_modes import assignments, modes_of
from bondgraph.ir.expr import Expr
from bondgraph.ir.residuals import ResidualSet
from bondgraph.ir.signature_matrix import ModeSignature, ModeSignatures, SignatureMatrix


def modes(
    residuals: ResidualSet,
    matrix: SignatureMatrix,
    plant: Plant,
    seed: int = 1,
) -> ModeSignatures:
    """Which residual sees which fault while the machine stays in one mode.

    The matrix of a model is the union over its modes; here every boolean input that a law, a
    junction or a residual uses is fixed, and the derivatives of the residuals are taken on
    healthy trajectories of that mode alone (hybrid fault signatures: Low, Wang, Arogeti, Luo and
    Zhang, 2010). Of more than six such inputs the first six are varied, the others are off.
    Without boolean inputs the result is empty.
    """
    exprs = [r.expr for r in residuals.residuals]
    used = modes_of(residuals.system.graph, exprs)
    if not used:
        return ModeSignatures((), (), 0)
    at_start = from_start(plant)
    found = []
    for setting in assignments(used):
        told = {symbol.symbol.name: bool(on) for symbol, on in setting.items()}
        found.append(_in_mode(exprs, matrix, Reactions(at_start, seed, setting), told))
    return ModeSignatures(tuple(s.symbol.name for s in used), tuple(found), 1 << len(used))


def _in_mode(
    exprs: list[Expr], matrix: SignatureMatrix, reactions: Reactions, told: dict[str, bool]
) -> ModeSignature:
    try:
        seen = reactions.sensed(exprs)
    except ExactUnavailable as reason:
        return ModeSignature(told, None, str(reason))
    symbol = {name: s for s, name in reactions.faults.items()}
    rows = tuple(tuple(symbol[f] in own for own in seen) for f in matrix.faults)
    return ModeSignature(told, matrix._replace(rows=rows), "")
