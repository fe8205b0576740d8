"""Causal paths without delay: algebraic loops, and the partners of a dependent storage.

The effort of bond b is the variable 2b, its flow 2b + 1. The end with the stroke receives the
effort and computes the flow.
"""

from __future__ import annotations

from bondgraph.ir.causal import Storage
from bondgraph.ir.graph import BondGraph
from bondgraph.library.elements import STORAGES
from bondgraph.passes.causality.strokes import Strokes

_FAR = 2000  # variables looked at in search of partners
_FEW = 4  # partners named


class Paths:
    """Which variable is computed from which, by a given assignment."""

    __slots__ = ("_at", "_graph", "_strokes", "_value")

    def __init__(self, graph: BondGraph, at: list[list[int]], strokes: Strokes) -> None:
        self._graph = graph
        self._at = at
        self._strokes = strokes
        self._value = strokes.value

    def maker(self, variable: int) -> int:
        """The node that computes the variable."""
        bond = self._graph.bonds[variable >> 1]
        at_head = (self._value[variable >> 1] == 1) == bool(variable & 1)
        return (bond.head if at_head else bond.tail).node

    def _input(self, end: int) -> int:
        """The variable that the node at this end receives."""
        return (end & ~1) | (self._value[end >> 1] != (end & 1))

    def sources(self, variable: int) -> list[int]:
        """The variables from which this one is computed at once; empty at a state or a source."""
        bond = variable >> 1
        end = 2 * bond + ((self._value[bond] == 1) == bool(variable & 1))
        rule = self._strokes.net.rule[end]
        if rule >= 0:
            ends = self._strokes.net.ends[rule]
            taken = self._strokes.taken[rule]
            if end == taken:
                return [self._input(e) for e in ends if e != end]
            return [self._input(taken)]
        node = self.maker(variable)
        if self._graph.nodes[node].kind == "R":
            return [self._input(e) for e in self._at[node]]
        return []

    def loops(self) -> list[tuple[int, ...]]:
        """The algebraic loops: the R's in each, or its junctions where it has no R."""
        found = []
        for component in self._components():
            makers = sorted({self.maker(v) for v in component})
            resistors = tuple(n for n in makers if self._graph.nodes[n].kind == "R")
            found.append(resistors or tuple(makers))
        return sorted(found)

    def _components(self) -> list[list[int]]:
        """Strongly connected components of more than one variable (Tarjan 1972, no recursion)."""
        size = 2 * len(self._value)
        order = [0] * size  # 0 not seen, else when
        low = [0] * size
        done = bytearray(size)
        found: list[list[int]] = []
        stack: list[int] = []
        clock = 0
        for root in range(size):
            if order[root]:
                continue
            work = [(root, iter(self.sources(root)))]
            clock += 1
            order[root] = low[root] = clock
            stack.append(root)
            while work:
                v, successors = work[-1]
                for w in successors:
                    if not order[w]:
                        clock += 1
                        order[w] = low[w] = clock
                        further = self.sources(w)
                        if not further:  # a state or a source closes no loop
                            done[w] = 1
                            continue
                        stack.append(w)
                        work.append((w, iter(further)))
                        break
                    if not done[w] and order[w] < low[v]:
                        low[v] = order[w]
                else:
                    work.pop()
                    if work and low[v] < low[work[-1][0]]:
                        low[work[-1][0]] = low[v]
                    if low[v] == order[v]:
                        if stack[-1] == v:
                            done[stack.pop()] = 1
                            continue
                        component: list[int] = []
                        while not component or component[-1] != v:
                            component.append(stack.pop())
                            done[component[-1]] = 1
                        if len(component) > 1:
                            found.append(component)
        return found

    def partners(self, storage: Storage) -> list[int]:
        """The storages (or else the sources) that fix what a dependent storage receives.

        Searched along causal paths, nearest first.
        """
        end = next(e for e in self._at[storage.node] if self._port(e) == storage.port)
        storages: list[int] = []
        others: list[int] = []
        queue = [self._input(end)]
        seen = set(queue)
        for variable in queue:
            node = self.maker(variable)
            kind = self._graph.nodes[node].kind
            if kind in STORAGES:
                if node != storage.node and node not in storages:  # which may have several ports
                    storages.append(node)
            elif kind in ("Se", "Sf", "De", "Df"):
                others.append(node)
            else:
                for source in self.sources(variable):
                    if source not in seen:
                        seen.add(source)
                        queue.append(source)
            if len(storages) >= _FEW or len(queue) > _FAR:
                break
        return storages or others

    def _port(self, end: int) -> int:
        bond = self._graph.bonds[end >> 1]
        return (bond.head if end & 1 else bond.tail).port
