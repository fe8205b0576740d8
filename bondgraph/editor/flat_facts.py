"""What the compiler knows of the declarations of a text: units, strokes, residuals, by symbol."""

from __future__ import annotations

from collections.abc import Iterable
from os.path import realpath

from bondgraph.compilation import Compilation
from bondgraph.editor.occurrences import FileNames, Symbol
from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.graph import Bond, BondGraph, Input, Let, Node, Sensor, Value
from bondgraph.ir.unit import Dimension
from bondgraph.library.units import describe, parse_unit
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

Quantity = Value | Input | Sensor | Let


class FlatNode(NamedTuple):
    """A node of a flat graph, with the strokes of its model."""

    number: int
    node: Node
    causal: CausalGraph

    def bonds(self) -> list[Bond]:
        """The bonds that meet it."""
        return [b for b in self.causal.graph.bonds if self.number in (b.tail.node, b.head.node)]


class FlatFacts:
    """The parts of the flat models of a file, by the symbols that they come from."""

    def __init__(self, compilations: Iterable[Compilation], names: FileNames) -> None:
        self.compilations = tuple(compilations)
        self.names = names
        self.nodes: dict[Symbol, list[FlatNode]] = {}
        self.quantities: dict[Symbol, list[Quantity]] = {}
        self.arrows: dict[tuple[int, int], list[tuple[CausalGraph, Bond]]] = {}
        self._anchors: dict[tuple[str, int, bool], Symbol] = {}
        self._paths: dict[str, str] = {}
        paths = dict.fromkeys([names.path, *names.imports.values()])
        waiting = list(paths)
        while waiting:
            file = names.owner(waiting.pop())
            if file is None:
                continue
            for other in file.imports.values():
                if other not in paths:
                    paths[other] = None
                    waiting.append(other)
            self._anchor(file)
        for compilation in self.compilations:
            self._take(compilation, names)

    def _anchor(self, file: FileNames) -> None:
        for model in file.models.values():
            for declared in model.nodes.values():
                self._anchors[file.path, declared.anchor, True] = declared.symbol
            for declared in model.values.values():
                self._anchors[file.path, declared.anchor, False] = declared.symbol

    def _symbol(self, origin: Span, node: bool) -> Symbol | None:
        return self._anchors.get((self._real(origin.source.path), origin.start, node))

    def _real(self, path: str) -> str:
        if path not in self._paths:
            self._paths[path] = realpath(path)
        return self._paths[path]

    def _take(self, compilation: Compilation, names: FileNames) -> None:
        causal = compilation.integral
        graph = causal.graph
        for number, node in enumerate(graph.nodes):
            symbol = self._symbol(node.origin, True)
            if symbol is not None:
                self.nodes.setdefault(symbol, []).append(FlatNode(number, node, causal))
        for item in quantities(graph):
            symbol = self._symbol(item.origin, False)
            if symbol is not None:
                self.quantities.setdefault(symbol, []).append(item)
        for bond in graph.bonds:
            if self._real(bond.origin.source.path) == names.path:
                place = (bond.origin.start, bond.origin.end)
                self.arrows.setdefault(place, []).append((causal, bond))


def quantities(graph: BondGraph) -> list[Quantity]:
    """Everything of a model that has a value."""
    return [*graph.values, *graph.inputs, *graph.sensors, *graph.lets]


def unit_of(item: Quantity) -> str | None:
    """The unit of a quantity, as written or as inferred; None where nothing fixes it."""
    if item.unit is not None:
        return item.unit
    return None if item.dimension is None else describe(item.dimension)


def dimension_of(unit: str | None) -> Dimension | None:
    """What a unit measures; None where it is none."""
    found = None if unit is None else parse_unit(unit)
    return None if found is None else found.dimension
