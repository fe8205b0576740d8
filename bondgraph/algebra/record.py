"""A large residual as a tape: the polynomial in p of every signal, one pass from the residual down.

Reverse accumulation: the polynomial of a node is the sum over its users of theirs times the
factor on the way. One row a node and one operation an edge, whatever the number of signals.
"""

from __future__ import annotations

from bondgraph.ir.expr import CONSTANTS, Expr, Op, Pool, topological
from bondgraph.ir.normal import Edge, Leaf, Tape


def record(pool: Pool, expr: Expr) -> Tape:
    """The tape of a residual; integrals and nonlinear expressions are its leaves."""
    fixed: dict[Expr, bool] = {}
    moving: dict[Expr, bool] = {}
    for node in topological([expr]):
        fixed[node] = node.op is not Op.INT and all(fixed[a] for a in node.args)
        if node.op is Op.SYM:
            fixed[node] = node.symbol.kind in CONSTANTS
        moving[node] = node.op is Op.DER or any(moving[a] for a in node.args)
    degree: dict[Expr, int] = {expr: 0}
    rows: dict[Expr, int] = {}
    edges: list[Edge] = []
    leaves: list[Leaf] = []
    incoming: dict[Expr, list[tuple[Expr, int, Expr]]] = {}
    for node in reversed(topological([expr], stop=lambda n: fixed[n])):
        if node not in degree:
            continue  # only reached through an atom
        below = _factors(pool, node, fixed)
        rows[node] = len(rows)
        edges += [Edge(rows[node], rows[s], k, c) for s, k, c in incoming.pop(node, ())]
        if below is None:
            leaves.append(Leaf(node, rows[node], degree[node], not moving[node]))
            continue
        for child, shift, scale in below:
            incoming.setdefault(child, []).append((node, shift, scale))
            degree[child] = max(degree.get(child, 0), degree[node] + shift)
    constants = [n for n in incoming if fixed[n]]
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
    pool: Pool, node: Expr, fixed: dict[Expr, bool]
) -> list[tuple[Expr, int, Expr]] | None:
    """What a node is linear in: (argument, power of p, factor); None for an atom."""
    if node.op is Op.ADD:
        return [(a, 0, pool.num(c)) for c, a in node.terms]
    if node.op is Op.DER:
        return [(node.args[0], 1, pool.one)]
    if node.op is Op.MUL:
        pairs = list(node.factors)
        varying = [(a, e) for a, e in pairs if not fixed[a]]
        if len(varying) == 1 and varying[0][1] == 1:
            factor = pool.mul(*[pool.power(a, e) for a, e in pairs if fixed[a]])
            return [(varying[0][0], 0, factor)]
    return None
