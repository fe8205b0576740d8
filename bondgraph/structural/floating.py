"""Networks that nothing grounds: only differences of their efforts matter, as in a diode bridge.

The efforts of the 0-junctions of such a network are determined up to a common constant, and the
balance of one of them follows from those of the others. A person who draws a circuit grounds one
node and leaves its junction out (Karnopp, Margolis and Rosenberg, 1990); here one is taken as zero.
"""

from __future__ import annotations

from collections.abc import Iterable

from bondgraph.field.prime import PrimeField
from bondgraph.field.sparse import eliminate
from bondgraph.ir.expr import Expr, symbols
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.groups import Groups


def references(graph: BondGraph) -> frozenset[int]:
    """A 0-junction of each floating network, by number: its effort may be taken as zero.

    A network floats where its efforts enter no law but by the balances of 1-junctions, and these
    hold whatever is added to all of them.
    """
    nodes = graph.nodes
    like = Groups[int]()  # junctions of one kind that are bonded together: one common variable
    for bond in graph.bonds:
        a, b = bond.tail.node, bond.head.node
        if nodes[a].kind == nodes[b].kind and nodes[a].kind in ("0", "1"):
            like.join(a, b)
    fixed = {like.find(n) for n, node in enumerate(nodes) if node.when is not None}
    rows: dict[int, dict[int, int]] = {}  # by 1-junction, how often the efforts are in its balance
    for bond in graph.bonds:
        for own, other, sign in ((bond.tail, bond.head, 1), (bond.head, bond.tail, -1)):
            if nodes[own.node].kind == "0":
                zero, one = like.find(own.node), like.find(other.node)
                if nodes[other.node].kind == "1":
                    row = rows.setdefault(one, {})
                    row[zero] = row.get(zero, 0) + sign
                elif nodes[other.node].kind != "0":
                    fixed.add(zero)
    found = _free(rows.values(), fixed)
    if found:
        used = _used(graph)
        fixed |= {like.find(n) for n, node in enumerate(nodes) if node.common in used}
        found = _free(rows.values(), fixed)
    return frozenset(found)


def _free(rows: Iterable[dict[int, int]], fixed: set[int]) -> list[int]:
    """What is left open where each row, a sum, is zero, and so are those that are fixed."""
    left = [{c: n for c, n in row.items() if n and c not in fixed} for row in rows]
    found = {c for row in left if len(row) == 1 for c in row}
    while found:  # alone in a row: zero, too
        left = [{c: n for c, n in row.items() if c not in found} for row in left]
        found = {c for row in left if len(row) == 1 for c in row}
    numbers = PrimeField(1)
    own = [{c: numbers.number(n) for c, n in row.items()} for row in left if row]
    determined = {pivot.column for pivot in eliminate(numbers, own)}
    return sorted({c for row in own for c in row} - determined)


def _used(graph: BondGraph) -> frozenset[Expr]:
    """Every symbol in a law, in what a sensor reads and in an integral."""
    exprs = [law.zero for node in graph.nodes for law in node.laws]
    exprs += [sensor.reads for sensor in graph.sensors]
    exprs += [item.integrand for item in graph.integrals]
    return frozenset(s for expr in exprs for s in symbols(expr))
