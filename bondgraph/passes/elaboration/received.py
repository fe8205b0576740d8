"""What elements receive of sensors: a source that does is a controller, and may deliver wrongly.

The name of a sensor in a law is its reading, which is wrong when the sensor is. A source whose law
uses one may besides deliver something else than its law commands: a parameter that is declared 0
is added to what it gives. A passive element obeys quantities, so that a reading there gets a note.
"""

from __future__ import annotations

from collections.abc import Mapping

from bondgraph.ir.expr import Expr, Kind, Pool, symbols
from bondgraph.ir.graph import Law, Node
from bondgraph.library.dimensions import Term
from bondgraph.passes.elaboration.problems import listed
from bondgraph.passes.elaboration.quantities import Quantities
from bondgraph.passes.elaboration.scope import NodeEntry, ValueEntry
from bondgraph.text.diagnostic import Report
from bondgraph.text.tuples import NamedTuple

#: What is put after the path of a source whose name a value has already.
ERROR = "error"


class Delivery(NamedTuple):
    """What a source gives beyond its command: a parameter, with the node and its dimension."""

    node: NodeEntry
    symbol: Expr
    term: Term


def readings_in(roots: list[Expr], integrands: Mapping[Expr, Expr]) -> list[str]:
    """The sensors whose readings the expressions use, through their integrals too."""
    seen: dict[Expr, None] = {}
    while roots:
        fresh = [s for s in symbols(*roots) if s not in seen]
        seen.update(dict.fromkeys(fresh))
        roots = [integrands[s] for s in fresh if s in integrands]
    return [s.symbol.name for s in seen if s.symbol.kind is Kind.READING]


class Received:
    """Looks at the laws of all elements, and collects the deliveries of its controllers."""

    def __init__(
        self,
        pool: Pool,
        report: Report,
        quantities: Quantities,
        integrands: Mapping[Expr, Expr],
        values: list[ValueEntry],
    ) -> None:
        self._pool, self._report = pool, report
        self._quantities, self._integrands = quantities, integrands
        self._taken = {entry.path for entry in values}
        self.deliveries: dict[str, Delivery] = {}  # by the path of the source

    def node(self, entry: NodeEntry, node: Node) -> Node:
        """The node as it is in the graph: a controller with what it delivers wrongly."""
        used = readings_in([law.zero for law in node.laws], self._integrands)
        if not used:
            return node
        if node.kind not in ("Se", "Sf"):
            self._note(entry, node, used)
            return node
        # what is printed is older than the error, and so stands before it
        self._pool.logged([law.zero for law in node.laws])
        name = f"{node.path}.{ERROR}" if node.path in self._taken else node.path
        effort, flow = self._quantities.pair(entry.ports[0].slot)
        symbol = self._pool.symbol(name, Kind.PARAM)
        delivery = Delivery(entry, symbol, effort if node.kind == "Se" else flow)
        self.deliveries[node.path] = delivery
        return node._replace(laws=tuple([self._delivered(law, symbol) for law in node.laws]))

    def _delivered(self, law: Law, symbol: Expr) -> Law:
        """`f - command = 0` becomes `f - command - symbol = 0`."""
        return law._replace(zero=self._pool.add(*law.zero.terms, (-1, symbol)))

    def _note(self, entry: NodeEntry, node: Node, used: list[str]) -> None:
        self._report.info(
            "reading-in-law",
            f"`{entry.type}:{entry.local}` obeys what {listed(used)} "
            f"{'reads' if len(used) == 1 else 'read'}, not the quantity itself.",
            node.laws[0].origin,
            help="The name of a sensor is its reading, which is wrong when the sensor is. Physics "
            "obeys the quantity: write `x.e`, `x.f`, `x.q` or `x.p` of the node that is measured.",
        )
