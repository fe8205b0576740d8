"""What an expression is made of, found in one pass and kept: relations are asked again and again.

>>> from bondgraph.ir.expr import Kind, Pool
>>> p = Pool(); y, u = p.symbol("y", Kind.SENSOR), p.symbol("u", Kind.INPUT)
>>> relation = p.sub(u, p.der(p.mul(u, y)))
>>> outline(relation).symbols, rational([relation]), highest_order([relation])
((y, u), True, 1)
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache

from bondgraph.ir.expr import Expr, Kind, Op, topological
from bondgraph.text.tuples import NamedTuple

_ARITHMETIC = frozenset({Op.SYM, Op.NUM, Op.ADD, Op.MUL})
_DECIDED = frozenset({Op.FN, Op.ROOT, Op.CMP, Op.IF})


class Outline(NamedTuple):
    """The nodes of an expression, arguments first, the symbols among them, and what else is."""

    nodes: tuple[Expr, ...]
    symbols: tuple[Expr, ...]
    ops: frozenset[Op]


@lru_cache(maxsize=1 << 14)
def outline(root: Expr) -> Outline:
    """What an expression is made of."""
    nodes = tuple(topological([root]))
    return Outline(
        nodes, tuple([n for n in nodes if n.op is Op.SYM]), frozenset([n.op for n in nodes])
    )


def demands(nodes: Sequence[Expr], roots: Sequence[Expr], n: int) -> dict[Expr, int]:
    """How many Taylor coefficients each node must deliver so that each root has `n`."""
    need = dict.fromkeys(nodes, 0)
    for node in roots:
        need[node] = max(need[node], n)
    for node in reversed(nodes):
        wanted = need[node]
        if node.op is Op.DER:
            wanted += 1
        elif node.op is Op.INT:
            wanted = max(wanted - 1, 1)
        for a in node.args:
            if need[a] < wanted:
                need[a] = wanted
    return need


@lru_cache(maxsize=512)
def plan(root: Expr, n: int) -> tuple[tuple[Expr, ...], dict[Expr, int]]:
    """The nodes below a root, arguments first, and what each must deliver."""
    nodes = outline(root).nodes
    return nodes, demands(nodes, [root], n)


@lru_cache(maxsize=8)
def static(roots: tuple[Expr, ...]) -> Sequence[Expr] | None:
    """The nodes below the roots if all are sums and products: one number each is enough."""
    if any(not outline(root).ops <= _ARITHMETIC for root in roots):
        return None
    return outline(roots[0]).nodes if len(roots) == 1 else topological(roots)


def rational(roots: Iterable[Expr]) -> bool:
    """Whether expressions are rational, decisions by known booleans apart."""
    for root in roots:
        nodes, _, ops = outline(root)
        if ops.isdisjoint(_DECIDED):
            continue
        decided: dict[Expr, bool] = {}
        for node in nodes:
            below = all(decided[a] for a in node.args)
            decided[node] = below and (node.op is not Op.SYM or node.symbol.kind is Kind.MODE)
            known = node.op is Op.IF and decided[node.args[0]]
            if node.op in _DECIDED and not known:
                return False
    return True


def highest_order(roots: Sequence[Expr], n: int = 1) -> int:
    """The highest derivative of any symbol that `n` coefficients of the roots ask for."""
    return max(highest_orders(tuple(roots), n), default=0)


@lru_cache(maxsize=1 << 14)
def highest_orders(roots: tuple[Expr, ...], n: int = 1) -> tuple[int, ...]:
    """The same of each root; what they share is looked at once.

    If a node has to give w coefficients, some symbol below it has to give max(w + above, least).
    """
    reach: dict[Expr, tuple[int, int]] = {}
    for node in topological(roots):
        inside = [reach[a] for a in node.args if a in reach]
        if node.op is Op.SYM:
            reach[node] = (0, 0)
        elif inside:
            above, least = max([a for a, _ in inside]), max([b for _, b in inside])
            if node.op is Op.DER:
                above += 1
            elif node.op is Op.INT:  # asks for one less, and for one at least
                above, least = above - 1, max(least, above + 1)
            reach[node] = (above, least)
    found = [reach.get(root, (-n, 1)) for root in roots]
    return tuple([max(n + above, least) - 1 for above, least in found])


def integral_depth(roots: Sequence[Expr]) -> int:
    """How deep integrals are nested below the roots."""
    depth: dict[Expr, int] = {}
    for node in topological(root for root in roots if Op.INT in outline(root).ops):
        below = max([depth[a] for a in node.args], default=0)
        depth[node] = below + (node.op is Op.INT)
    return max([depth.get(r, 0) for r in roots], default=0)
