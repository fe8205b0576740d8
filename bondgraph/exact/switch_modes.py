"""The modes of a switched plant: which boolean inputs matter, and which of their values to try."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from bondgraph.exact.outline import outline
from bondgraph.ir.expr import Expr, Kind
from bondgraph.ir.graph import BondGraph

#: Boolean inputs all of whose assignments are tried; beyond them the others go along.
MOST = 6


def modes_of(graph: BondGraph, exprs: Iterable[Expr] = ()) -> list[Expr]:
    """The boolean inputs that decide something in the plant or in the expressions.

    In the order of the model.
    """
    roots = list(exprs)
    roots += [law.zero for node in graph.nodes for law in node.laws]
    roots += [node.when for node in graph.nodes if node.when is not None]
    roots += [i.integrand for i in graph.integrals]
    roots += [s.reads for s in graph.sensors]
    used = {s for r in roots for s in outline(r).symbols if s.symbol.kind is Kind.MODE}
    return [i.symbol for i in graph.inputs if i.symbol in used]


def assignments(modes: Sequence[Expr]) -> list[dict[Expr, int]]:
    """The assignments to try: all of up to six modes; of more, each has both values.

    >>> from bondgraph.ir.expr import Pool
    >>> p = Pool(); a, b = p.symbol("a", Kind.MODE), p.symbol("b", Kind.MODE)
    >>> assignments([a, b])
    [{a: 0, b: 0}, {a: 0, b: 1}, {a: 1, b: 0}, {a: 1, b: 1}]
    """
    varied = min(len(modes), MOST)
    return [
        {m: number >> (varied - 1 - at % varied) & 1 for at, m in enumerate(modes)}
        for number in range(1 << varied)
    ]
