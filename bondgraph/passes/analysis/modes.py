"""The fault signature matrix of each mode of a switched machine, on trajectories of that mode."""

from __future__ import annotations

from collections.abc import Mapping

from bondgraph.exact.from_start import from_start
from bondgraph.exact.outline import outline
from bondgraph.exact.plant import Plant
from bondgraph.exact.reactions import Reactions
from bondgraph.exact.switch_modes import assignments, modes_of
from bondgraph.exact.trajectory import ExactUnavailable
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
    Zhang, 2010). Each of these inputs is a fault there as well: the switch is in the other
    position while residuals are told this one. A residual sees it unless it is zero on the
    trajectories of that mode too. Of more than six such inputs the first six are varied, the
    others are off. Without boolean inputs the result is empty.
    """
    exprs = [r.expr for r in residuals.residuals]
    used = modes_of(residuals.system.graph, exprs)
    if not used:
        return ModeSignatures((), (), 0)
    at_start = from_start(plant)
    every = [Reactions(at_start, seed, setting) for setting in assignments(used)]
    found = [_in_mode(exprs, matrix, reactions) for reactions in every]
    nowhere = {tuple(m.modes.values()): m.reason for m in found if m.matrix is None}
    both = zip(found, every, strict=True)
    whole = tuple(_with_switches(exprs, mode, reactions, nowhere) for mode, reactions in both)
    return ModeSignatures(tuple(s.symbol.name for s in used), whole, 1 << len(used))


def _in_mode(exprs: list[Expr], matrix: SignatureMatrix, reactions: Reactions) -> ModeSignature:
    """The faults of the model in the mode of the reactions."""
    told = {s.symbol.name: bool(on) for s, on in (reactions.modes or {}).items()}
    try:
        seen = reactions.sensed(exprs)
    except ExactUnavailable as reason:
        return ModeSignature(told, None, str(reason))
    symbol = {name: s for s, name in reactions.faults.items()}
    rows = tuple(tuple(symbol[f] in own for own in seen) for f in matrix.faults)
    return ModeSignature(told, matrix._replace(rows=rows), "")


def _with_switches(
    exprs: list[Expr],
    mode: ModeSignature,
    reactions: Reactions,
    nowhere: Mapping[tuple[bool, ...], str],
) -> ModeSignature:
    """The same with a row for each switch; `nowhere` has the modes without behaviour."""
    if mode.matrix is None:
        return mode
    rows: dict[str, tuple[bool, ...]] = {}
    impossible: dict[str, str] = {}
    for symbol in reactions.modes or ():
        name = symbol.symbol.name
        true = tuple(on is not (n == name) for n, on in mode.modes.items())
        try:
            if true in nowhere:
                raise ExactUnavailable(nowhere[true])
            rows[name] = tuple(
                symbol in outline(expr).symbols and reactions.moves(expr, symbol) for expr in exprs
            )
        except ExactUnavailable as reason:
            impossible[name] = str(reason)
    own = mode.matrix
    own = own._replace(faults=(*own.faults, *rows), rows=(*own.rows, *rows.values()))
    return mode._replace(matrix=own, impossible=impossible)
