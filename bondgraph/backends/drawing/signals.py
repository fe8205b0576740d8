"""Which signals act on the laws of a bond graph: what modulates an element or drives a source."""

from __future__ import annotations

from collections.abc import Iterator

from bondgraph.ir.expr import Expr, Kind, symbols
from bondgraph.ir.graph import BondGraph, Node
from bondgraph.text.tuples import NamedTuple

_OUTSIDE = (Kind.INPUT, Kind.UNKNOWN, Kind.MODE)
_SHOWN = 3  # names beside one element; the tooltip has all


class Signal(NamedTuple):
    """What acts on the law of `node`: the names of the signals, and the nodes that they are from.

    With a `block` it is computed from them: an integral of them, or the law of a controller.
    """

    node: int
    names: tuple[str, ...]
    origins: tuple[int, ...]
    block: bool

    @property
    def label(self) -> str:
        """What stands beside the arrow or in the block."""
        shown = [name.rpartition(".")[2] for name in self.names[:_SHOWN]]
        text = ", ".join([*shown, *(["…"] if len(self.names) > _SHOWN else [])])
        return f"f({text})" if self.block and len(self.names) > 1 else text


def signals(graph: BondGraph) -> tuple[Signal, ...]:
    """The signals of a graph, in the order of its nodes.

    A plain source of an input of its own has none: its label says it already.

    >>> import bondgraph
    >>> for signal in signals(bondgraph.compile("models/slider_crank.bg").graph):
    ...     print(signal.names, [signal.origins == (graph_node,) for graph_node in (1,)])
    ('th',) [True]
    """
    return tuple(_Finder(graph).all())


class _Finder:
    def __init__(self, graph: BondGraph) -> None:
        self.graph = graph
        self.owner: dict[Expr, int] = {}
        for n, node in enumerate(graph.nodes):
            for port in node.ports:
                for variable in (port.effort, port.flow, port.state):
                    if variable is not None:
                        self.owner[variable] = n
            if node.common is not None:
                self.owner[node.common] = n
        self.integrals = {i.symbol: i for i in graph.integrals}
        self.sensors = {s.name: s for s in graph.sensors}

    def all(self) -> Iterator[Signal]:
        """Every element with a signal in its law."""
        for n, node in enumerate(self.graph.nodes):
            found = self._signal(n, node)
            if found is not None:
                yield found

    def _signal(self, n: int, node: Node) -> Signal | None:
        outside: list[str] = []
        names: list[str] = []
        origins: list[int] = []
        block = False
        for symbol in symbols(*[law.zero for law in node.laws]):
            kind, name = symbol.symbol.kind, symbol.symbol.name
            if self.owner.get(symbol) == n:
                continue
            if kind in _OUTSIDE:
                outside.append(name)
            elif kind is Kind.INTEGRAL and symbol in self.integrals:
                names.append(name.partition(".int")[0])
                origins += self._from(self.integrals[symbol].integrand)
                block = True
            elif kind in (Kind.READING, Kind.SENSOR) or symbol in self.owner:
                names.append(name)
                origins += self._from(symbol)
        plain = node.keyword == node.kind and node.kind in ("Se", "Sf")
        if not names and (not outside or (plain and len(outside) == 1)):
            return None
        own = tuple(dict.fromkeys([*names, *outside]))
        controls = bool(names) and node.kind in ("Se", "Sf")
        places = tuple(o for o in dict.fromkeys(origins) if o != n)
        return Signal(n, own, places, block or controls or (bool(names) and len(own) > 1))

    def _from(self, expr: Expr) -> list[int]:
        """The nodes that the variables and readings of an expression belong to."""
        found: list[int] = []
        for symbol in symbols(expr):
            sensor = self.sensors.get(symbol.symbol.name)
            if symbol in self.owner:
                found.append(self.owner[symbol])
            elif symbol in self.integrals:
                found += self._from(self.integrals[symbol].integrand)
            elif sensor is not None and sensor.node is not None:
                found.append(sensor.node)
            elif sensor is not None and symbol not in symbols(sensor.reads):
                found += self._from(sensor.reads)
        return found
