"""Exact repair where propagation is not enough: alternating paths in a general graph.

The rules are vertices, the open bonds are edges, a strong bond is a matched edge, and every rule
must be covered. A bond that is strong at one end exactly when it is weak at the other gets a
vertex in its middle; an element is an optional vertex. With gyrators the graph may have odd
cycles, so the search shrinks blossoms (Edmonds 1965). The sets of optional vertices that perfect
matchings cover form a delta-matroid, on which the greedy algorithm is optimal (Bouchet 1987):
asking for one wish after the other, with an exact test each, grants as many as possible.
"""

from __future__ import annotations

from bondgraph.ir.groups import Groups
from bondgraph.passes.causality.strokes import Strokes


class Matching:
    """A complete assignment that agrees with the strokes placed so far, kept as a witness."""

    def __init__(self, strokes: Strokes, hint: list[int]) -> None:
        """Start from the strokes; `hint` is an assignment (-1 open) that may break rules."""
        net = strokes.net
        self.rules = len(net.ends)
        self.loose: set[int] = set()  # bonds between two elements obey no rule
        self._edge = [-1] * net.bonds  # the (first) edge of a bond
        self._ends: list[tuple[int, int]] = []
        self._bond: list[int] = []
        self._value: list[int] = []  # the stroke of the bond when the edge is matched
        self._near: list[list[int]] = [[] for _ in range(self.rules)]
        self._optional = [False] * self.rules
        for bond in range(net.bonds):
            if strokes.value[bond] < 0:
                self._add(strokes, bond)
        self._mate = [-1] * len(self._near)
        self._matched = [False] * len(self._ends)
        self._dead = [False] * len(self._ends)
        self._fixed = len(strokes.trail)
        for bond, edge in enumerate(self._edge):
            if edge >= 0 and hint[bond] >= 0:
                self._try(edge if hint[bond] == self._value[edge] else edge + 1, bond)
        for edge in range(len(self._ends)):
            if not any(self._optional[v] for v in self._ends[edge]):
                self._try(edge, self._bond[edge])
        self.tree: dict[int, bool] = {}

    def _add(self, strokes: Strokes, bond: int) -> None:
        net = strokes.net
        tail, head = net.rule[2 * bond], net.rule[2 * bond + 1]
        if tail < 0 and head < 0:
            self.loose.add(bond)
            return
        self._edge[bond] = len(self._ends)
        strong_tail, strong_head = net.strong[2 * bond], net.strong[2 * bond + 1]
        if tail >= 0 and head >= 0 and strong_tail == strong_head:
            self._join(tail, head, bond, strong_tail)
            return
        middle = len(self._near)
        self._near.append([])
        self._optional.append(tail < 0 or head < 0)
        # the lower rule first: the way a bond is drawn must not matter
        for rule, strong in sorted([(tail, strong_tail), (head, strong_head)]):
            if rule >= 0:
                self._join(rule, middle, bond, strong)

    def _join(self, u: int, v: int, bond: int, value: int) -> None:
        edge = len(self._ends)
        self._ends.append((u, v))
        self._bond.append(bond)
        self._value.append(value)
        self._near[u].append(edge)
        self._near[v].append(edge)

    def _try(self, edge: int, bond: int) -> None:
        """Match an edge of the bond if it exists and both its ends are free."""
        if edge < len(self._ends) and self._bond[edge] == bond:
            u, v = self._ends[edge]
            if u != v and self._mate[u] < 0 and self._mate[v] < 0:
                self._match(edge)

    def _match(self, edge: int) -> None:
        u, v = self._ends[edge]
        self._mate[u] = self._mate[v] = edge
        self._matched[edge] = True

    def _unmatch(self, edge: int) -> None:
        u, v = self._ends[edge]
        self._mate[u] = self._mate[v] = -1
        self._matched[edge] = False

    def _other(self, edge: int, vertex: int) -> int:
        u, v = self._ends[edge]
        return v if vertex == u else u

    # ------------------------------------------------------------ questions

    def complete(self) -> bool:
        """Cover every rule; on failure `tree` holds the vertices that cannot all be covered."""
        for vertex, near in enumerate(self._near):
            if near and self._mate[vertex] < 0 and not self._optional[vertex]:  # noqa: SIM102
                if not self._grow(vertex, -1):
                    return False
        return True

    def value(self, bond: int) -> int:
        """The stroke of an open bond in the witness, if it is not loose."""
        edge = self._edge[bond]
        value = self._value[edge]
        return value if self._matched[edge] else 1 - value

    def turn(self, bond: int, value: int) -> bool:
        """Change the witness so that this element's bond has the stroke `value`, if possible."""
        if bond in self.loose or self.value(bond) == value:
            return True
        edge = self._edge[bond]
        u, v = self._ends[edge]
        rule, leaf = (v, u) if self._optional[u] else (u, v)
        if self._matched[edge]:
            self._unmatch(edge)
            self._dead[edge] = True
            found = self._grow(rule, -1)
            self._dead[edge] = False
            if not found:
                self._match(edge)
            return found
        old = self._mate[rule]
        partner = self._other(old, rule)
        self._unmatch(old)
        self._match(edge)
        if self._optional[partner] or self._grow(partner, rule):
            return True
        self._unmatch(edge)
        self._match(old)
        assert self._mate[leaf] < 0
        return False

    def fix(self, strokes: Strokes) -> None:
        """Take the strokes that were placed since as settled."""
        for bond in strokes.trail[self._fixed :]:
            edge = self._edge[bond]
            while 0 <= edge < len(self._bond) and self._bond[edge] == bond:
                self._dead[edge] = True
                edge += 1
        self._fixed = len(strokes.trail)

    # --------------------------------------------------------------- search

    def _grow(self, root: int, banned: int) -> bool:
        """Cover the exposed `root` along an alternating path that avoids the vertex `banned`."""
        even: dict[int, bool] = {root: True}
        reach: dict[int, int] = {}  # the edge by which a vertex was reached against the matching
        base = Groups[int]()
        self.tree = even
        queue = [root]
        for x in queue:
            for edge in self._near[x]:
                y = self._other(edge, x)
                if self._dead[edge] or y in (banned, x):
                    continue
                state = even.get(y)
                if state is None:
                    reach[y] = edge
                    even[y] = False
                    mate = self._mate[y]
                    if mate < 0:
                        self._augment(y, reach)
                        return True
                    z = self._other(mate, y)
                    if self._optional[z]:
                        self._unmatch(mate)
                        self._augment(y, reach)
                        return True
                    even[z] = True
                    queue.append(z)
                elif state and base.find(x) != base.find(y):
                    top = self._meet(x, y, base, reach)
                    queue += self._shrink(x, edge, top, even, reach, base)
                    queue += self._shrink(y, edge, top, even, reach, base)
        return False

    def _augment(self, vertex: int, reach: dict[int, int]) -> None:
        x = vertex
        while True:
            edge = reach[x]
            p = self._other(edge, x)
            old = self._mate[p]
            if old >= 0:
                self._matched[old] = False
            self._match(edge)
            if old < 0:
                return
            x = self._other(old, p)

    def _meet(self, x: int, y: int, base: Groups[int], reach: dict[int, int]) -> int:
        """The lowest common ancestor of two even vertices, in terms of blossom bases."""
        seen: set[int] = set()
        ways = [x, y]
        while True:
            for i in (0, 1):
                if ways[i] < 0:
                    continue
                v = base.find(ways[i])
                if v in seen:
                    return v
                seen.add(v)
                mate = self._mate[v]
                if mate < 0:
                    ways[i] = -1
                else:
                    m = self._other(mate, v)
                    ways[i] = self._other(reach[m], m)

    def _shrink(
        self,
        x: int,
        edge: int,
        top: int,
        even: dict[int, bool],
        reach: dict[int, int],
        base: Groups[int],
    ) -> list[int]:
        """Shrink one side of a blossom into its base; the odd vertices that became even."""
        fresh = []
        while base.find(x) != top:
            reach[x] = edge
            y = self._other(self._mate[x], x)
            if not even[y]:
                even[y] = True
                fresh.append(y)
            for v in (x, y):
                if base.find(v) == v:
                    base.join(top, v)
            edge = reach[y]
            x = self._other(edge, y)
        return fresh


