"""In which unit each residual is, from the dimensions of what it is made of."""

from __future__ import annotations

from collections.abc import Iterable

from bondgraph.ir.expr import Expr, Op, topological
from bondgraph.ir.functions import FUNCTIONS
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.residuals import Residual
from bondgraph.ir.unit import NONE, Dimension, over, raised, times
from bondgraph.library.units import describe

_SECOND: Dimension = (0, 0, 1, 0, 0, 0, 0)


def residual_units(graph: BondGraph, residuals: Iterable[Residual]) -> dict[str, str]:
    """The SI unit of each residual as a person would write it, "" where that is not known.

    >>> import bondgraph
    >>> c = bondgraph.compile("models/dc_motor.bg")
    >>> residual_units(c.graph, [r.residual for r in c.residuals])
    {'r1': 'V', 'r2': 'N.m'}
    """
    known: dict[Expr, Dimension | None] = {v.symbol: v.dimension for v in graph.values}
    known |= {i.symbol: i.dimension for i in graph.inputs}
    known |= {s.symbol: s.dimension for s in graph.sensors if s.same_as is None}
    found = {}
    for residual in residuals:
        root = graph.pool.logged([residual.expr])[0]
        for node in topological([root], stop=known.__contains__):
            if node not in known:
                known[node] = _dimension(node, known)
        own = known[root]
        found[residual.name] = "" if own is None else describe(own)
    return found


def _dimension(node: Expr, known: dict[Expr, Dimension | None]) -> Dimension | None:
    args = [known.get(a) for a in node.args]
    match node.op:
        case Op.NUM | Op.CMP | Op.LOGIC:
            return NONE
        case Op.ADD:
            return next((a for a in args if a is not None), None)
        case Op.MUL:
            product = NONE
            for own, exponent in zip(args, node.exponents, strict=True):
                if own is None:
                    return None
                product = times(product, raised(own, exponent))
            return product
        case Op.DER:
            return None if args[0] is None else over(args[0], _SECOND)
        case Op.INT:
            return None if args[0] is None else times(args[0], _SECOND)
        case Op.IF:
            return args[1] or args[2]
        case Op.FN:
            record = FUNCTIONS.get(node.name)
            return args[0] if record is not None and record.unit == 1 else None
        case _:
            return None
