"""Find which fault moves which relation, exactly.

A relation is differentiated with respect to every parameter and signal by reverse mode on
trajectories of the plant at its declared numbers, which decide the signature (`reactions`).
"""

from __future__ import annotations

from bondgraph.exact.plant import Plant
from bondgraph.exact.reactions import entries
from bondgraph.ir.expr import Expr, symbols
from bondgraph.ir.residuals import Residual, ResidualSet
from bondgraph.ir.signature_matrix import SignatureMatrix

_LONG = 2000  # nodes


def signatures(residuals: ResidualSet, plant: Plant, seed: int = 1) -> SignatureMatrix:
    """The fault signature matrix of the relations.

    Where no trajectory of the plant can be had at the declared numbers, the signatures are those at
    other numbers, or at free signals, and the matrix says that they are unconfirmed.
    """
    own = residuals.residuals
    names = tuple(r.name for r in own)
    seen = entries(plant, seed, [(r.expr, _behind(r)) for r in own])
    faults = residuals.system.graph.fault_symbols()
    hits = {symbol: [False] * len(own) for symbol in faults.values()}
    for at, sees in enumerate(seen):
        for symbol in sees.seen:
            if symbol in hits:
                hits[symbol][at] = True
    apart = {
        (name, fault): tuple(v.symbol.name for v in sees.apart[symbol])
        for name, sees in zip(names, seen, strict=True)
        if sees.apart
        for fault, symbol in faults.items()
        if symbol in sees.apart
    }
    unconfirmed = {n: sees.reason for n, sees in zip(names, seen, strict=True) if sees.reason}
    rows = tuple(map(tuple, hits.values()))
    orders = tuple(r.orders for r in own)
    return SignatureMatrix(names, tuple(faults), rows, orders, apart, unconfirmed)


def _behind(residual: Residual) -> list[Expr]:
    """The symbols that a relation was made of, those included that have dropped out of it.

    A parameter may drop out only because it is constant: that of a storage whose flow is zero.
    """
    if len(residual.steps) > _LONG:
        return symbols(residual.raw)
    zeros = [s.equation.zero for s in residual.steps]
    return symbols(residual.raw, residual.closing.zero, *zeros)
