"""The numbers of the laws as they stand below an element: a resistance, a modulus, a ratio."""

from __future__ import annotations

from collections.abc import Iterator

from bondgraph.algebra.nominal import Nominal
from bondgraph.ir.expr import Expr, symbols
from bondgraph.ir.graph import BondGraph, Node, Value
from bondgraph.text.numerals import readable

_SHOWN = 2  # parameters of one law


def coefficients(graph: BondGraph) -> dict[int, str]:
    """For each element whose law has parameters with numbers these, in SI units.

    >>> import bondgraph
    >>> graph = bondgraph.compile("models/dc_motor.bg").graph
    >>> found = coefficients(graph)
    >>> [(node.path, found[n]) for n, node in enumerate(graph.nodes) if n in found][:3]
    [('L', '0.0003 H'), ('R', '17.6 Ohm'), ('k', '0.00351 N.m/A')]
    """
    nominal, values = Nominal(graph), {v.symbol: v for v in graph.values}
    found = {}
    for n, node in enumerate(graph.nodes):
        parts = list(_parts(node, nominal, values))
        if parts:
            found[n] = ", ".join([*parts[:_SHOWN], *(["…"] if len(parts) > _SHOWN else [])])
    return found


def _parts(node: Node, nominal: Nominal, values: dict[Expr, Value]) -> Iterator[str]:
    own = node.path.rpartition(".")[2]
    law = symbols(*[law.zero for law in node.laws])
    used = [values[symbol] for symbol in law if symbol in values]
    for value in used:
        number = nominal.value(value.symbol)
        if number is None:
            continue
        name = value.name.rpartition(".")[2]
        unit = "" if value.unit in (None, "", "1") else f" {value.unit}"
        said = f"{readable(number, 4)}{unit}"
        yield said if name == own and len(used) == 1 else f"{name} = {said}"
