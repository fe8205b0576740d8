"""Random graphs of rings and parallel links: junctions of one kind joined more than once."""

from __future__ import annotations

from random import Random

from tests.random.graphs import Drawing, Graph
from tests.random.rank import rank


class Rings(Drawing):
    """Two to four junctions, mostly alike, in a ring or with parallel links, most of them bonds."""

    def structure(self) -> None:
        random = self.random
        size, kind, mixed = random.randint(2, 4), random.choice("01"), random.random() < 0.4
        self.kinds = [random.choice("01") if mixed else kind for _ in range(size)]
        if size > 2 and random.random() < 0.5:
            self.links = [(k, (k + 1) % size, self.what()) for k in range(size)]
        else:
            again = [random.randrange(size - 1) for _ in range(random.randint(1, 2))]
            self.links = [(k, k + 1, self.what()) for k in [*range(size - 1), *again]]
        if random.random() < 0.6:
            self.kinds.append(random.choice("01"))
            self.links.append((random.randrange(size), size, "bond"))

    def what(self) -> str:
        return self.random.choice(["bond"] * 12 + ["TF", "GY"])


def rings(seed: int) -> tuple[Graph, int]:
    """A graph, and how many bonds close a ring of like junctions."""
    drawing = Rings(Random(f"ring {seed}"))
    graph = drawing.graph()
    like = [
        (a, b)
        for a, b, what in drawing.drawn
        if what == "bond" and drawing.kinds[a] == drawing.kinds[b]
    ]
    rows = [{f"n{a}": 1, f"n{b}": -1} for a, b in like]  # the incidence matrix of those bonds
    return graph, len(like) - rank(rows)


def surplus(graph: Graph) -> int:
    """How many equations too many there are without the sensors, contradictory or repeated."""
    inputs = {c for row in graph.rows for c in row if c.startswith("u")}
    free = [
        {c: x for c, x in row.items() if c not in inputs}
        for row in graph.rows
        if not any(c in graph.known and c not in inputs for c in row)
    ]
    return len(free) - rank(free)
