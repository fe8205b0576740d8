"""A large residual as a tape: the polynomial in p of every signal, one pass from the residual down.

Reverse accumulation: the polynomial of a node is the sum over its users of theirs times the
factor on the way. One row a node and one operation an edge, whatever the number of signals.
"""

from __future__ import annotations

from collections.abc import Container

from bondgraph.ir.expr import Expr, Op, Pool, topological
from bondgraph.ir.nodes import constant, holding, linear_terms
from bondgraph.ir.normal import Edge, Leaf, Tape


def record(pool: Pool, expr: Expr) -> Tape:
    """The tape of a residual; integrals and nonlinear expressions are its leaves."""
    memo: dict[Expr, bool] = {}
    constant(expr, memo)
    varying = {n for n, known in memo.items() if not known}
    scales: dict[object, Expr] = {}
    moving = holding([expr], lambda n: n.op is Op.DER)
    degree: dict[Expr, int] = {expr: 0}
    rows: dict[Expr, int] = {}
    edges: list[Edge] = []
    leaves: list[Leaf] = []
    incoming: dict[Expr, list[tuple[Expr, int, Expr]]] = {}
    for node in reversed(topological([expr], stop=lambda n: n not in varying)):
        if node not in degree:
            continue  # only reached through an atom
        below = _factors(pool, node, varying, scales)
        rows[node] = len(rows)
        edges += [Edge(rows[node], rows[s], k, c) for s, k, c in incoming.pop(node, ())]
        if below is None:
            leaves.append(Leaf(node, rows[node], degree[node], node not in moving))
            continue
        for child, shift, scale in below:
            incoming.setdefault(child, []).append((node, shift, scale))
            degree[child] = max(degree.get(child, 0), degree[node] + shift)
    constants = [n for n in incoming if n not in varying]
    if constants:
        rows[pool.one] = len(rows)
        for node in sorted(constants, key=lambda n: n.id):
            for source, shift, scale in incoming[node]:
                if shift == 0:
                    value = pool.mul(scale, node)
                    edges.append(Edge(rows[pool.one], rows[source], 0, value))
        leaves.append(Leaf(pool.one, rows[pool.one], 0, True))
    return Tape(tuple(edges), tuple(leaves), len(rows))


def _factors(
    pool: Pool, node: Expr, varying: Container[Expr], scales: dict[object, Expr]
) -> list[tuple[Expr, int, Expr]] | None:
    """What a node is linear in: (argument, power of p, factor); None for an atom."""
    if node.op is Op.DER:
        return [(node.args[0], 1, pool.one)]
    terms = linear_terms(node, varying)
    if terms is None:
        return None
    out = []
    for term in terms:
        key = term.coefficient, term.others  # most are met again and again
        scale = scales.get(key) or scales.setdefault(key, term.factor(pool))
        out.append((term.arg, 0, scale))
    return out
