"""What to say about a core: who meets where, which way the strokes were forced, and the physics.

Where no stroke is forced it is a proof by two cases, of a bond of which neither stroke can stand.
"""

from __future__ import annotations

from bondgraph.ir.causal import Reason
from bondgraph.ir.graph import BondGraph, Node
from bondgraph.passes.causality.cores import Core, Refutation, oblige, refute
from bondgraph.passes.causality.node_words import listing, name
from bondgraph.passes.causality.rules import Network, Wish
from bondgraph.passes.causality.strokes import Clash, Strokes
from bondgraph.text.diagnostic import Label
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

_LABELS = 10
_LARGE = 300  # bonds tried one after the other


class Explanation(NamedTuple):
    """A core told: `message` is the headline without its full stop, `meet` where it shows.

    `over` says whether there is too much (True) or too little (False) at that place; None where
    only the junctions together show it. `ring` says that what meets came from one place, along
    two ways. `strokes` are (bond of the graph, stroke) as forced, `roles` what happens at a node.
    """

    message: str
    physics: str
    labels: tuple[Label, ...]
    meet: int
    over: bool | None
    ring: bool
    strokes: tuple[tuple[int, int], ...]
    roles: tuple[tuple[int, str], ...]


class Side(NamedTuple):
    """One of the parties that meet at a junction: elements, and the junctions on their way.

    `forks` are the first nodes of the way where a party shares all that is behind with another.
    """

    elements: list[int]
    way: list[int]
    forks: list[int]


_TWICE = {
    "0": (
        "the effort of {0} is imposed twice, by {1}",
        "A 0-junction has one effort, so only one bond can bring it in.",
        "gets two efforts",
    ),
    "1": (
        "the flow of {0} is imposed twice, by {1}",
        "A 1-junction has one flow, so only one bond can bring it in.",
        "gets two flows",
    ),
    "TF": (
        "{0} receives effort from both sides, by {1}",
        "A transformer passes effort on: one side takes it, the other gives it.",
        "gets effort from both sides",
    ),
    "GY": (
        "{0} receives an effort on one side and a flow on the other, by {1}",
        "A gyrator turns effort into flow: both sides take effort or both take flow.",
        "gets an effort and a flow",
    ),
}
_NOBODY = {
    "0": (
        "nothing imposes the effort of {0}: {1}",
        "Every bond of this 0-junction brings a flow, none an effort; their sum cannot be zero.",
        "gets no effort",
    ),
    "1": (
        "nothing imposes the flow of {0}: {1}",
        "Every bond of this 1-junction brings an effort, none a flow; their sum cannot be zero.",
        "gets no flow",
    ),
    "TF": (
        "{0} receives a flow from both sides, by {1}",
        "A transformer passes flow on: one side takes it, the other gives it.",
        "gets flow from both sides",
    ),
    "GY": (
        "{0} receives a flow on one side and an effort on the other, by {1}",
        "A gyrator turns effort into flow: both sides take effort or both take flow.",
        "gets a flow and an effort",
    ),
}


def explanation(graph: BondGraph, net: Network, core: Core) -> Explanation:
    """Tell a core of the rules `net` of a graph."""
    small, place = net.part(core.rules, [must.bond for must in core.musts])
    musts = [must._replace(bond=place[must.bond]) for must in core.musts]
    refutation = refute(small, musts)
    assert refutation is not None
    return _Explainer(graph, small, musts, list(place), refutation).explanation()


class _Explainer:
    """Tells one core; `bonds[b]` is the bond of the graph that bond b of the small net is."""

    def __init__(
        self,
        graph: BondGraph,
        net: Network,
        musts: list[Wish],
        bonds: list[int],
        refutation: Refutation,
    ) -> None:
        self.graph = graph
        self.net = net
        self.musts = musts
        self.bonds = bonds
        self.strokes = refutation.strokes
        self.clash = refutation.clash
        self.wish = refutation.wish
        self.labels: list[Label] = []
        self.seen: set[Span] = set()
        self.roles: dict[int, str] = {}

    def node(self, n: int) -> Node:
        return self.graph.nodes[n]

    def name(self, n: int) -> str:
        return name(self.graph.nodes[n])

    def names(self, nodes: list[int], most: int = 4) -> str:
        return listing([self.name(n) for n in nodes], most)

    def other(self, bond: int, n: int) -> int:
        """The node at the far end of a bond of the small net."""
        ends = self.graph.bonds[self.bonds[bond]]
        return ends.head.node if ends.tail.node == n else ends.tail.node

    def explanation(self) -> Explanation:
        clash, wish = self.clash, self.wish
        if clash is None:
            return self.branched()
        if clash.rule >= 0:
            where = self.net.name[clash.rule]
            return self.junction(where, self.strokes.taken[clash.rule] >= 0, list(clash.bonds), [])
        assert wish is not None
        bond = clash.bonds[0]
        reason = self.strokes.reason[bond]
        assert reason is not None
        if reason.cause != "propagated":
            return self.bond(reason.node, wish.node, ((self.bonds[bond], wish.value),))
        rule = self.net.name.index(reason.node)
        over = bool(reason.because) and self.strokes.taken[rule] >> 1 == reason.because[0]
        last = ((self.bonds[bond], wish.value),)
        return self.junction(reason.node, over, list(reason.because), [wish.node], last)

    def told(
        self,
        message: str,
        physics: str,
        meet: int,
        over: bool | None,
        ring: bool,
        strokes: tuple[tuple[int, int], ...],
    ) -> Explanation:
        labels, roles = tuple(self.labels[:_LABELS]), tuple(self.roles.items())
        return Explanation(message, physics, labels, meet, over, ring, strokes, roles)

    # ------------------------------------------------------------- at a junction

    def junction(
        self,
        where: int,
        over: bool,
        bonds: list[int],
        direct: list[int],
        last: tuple[tuple[int, int], ...] = (),
    ) -> Explanation:
        """Parties meet at a junction or two-port: by these bonds, or as elements on it."""
        node = self.node(where)
        message, physics, label = (_TWICE if over else _NOBODY)[node.kind]
        traces = [self.trace(bond) for bond in bonds]
        shared = {b for t in traces for b in t if sum(b in other for other in traces) > 1}
        sides = [self.side(t, shared, where) for t in traces] + [Side([n], [], []) for n in direct]
        parties = [self.party(side) for side in sides if any(side)]
        who = listing(parties) if parties else "it has no bond"
        if not over and node.kind in ("0", "1") and parties:
            common = "effort" if node.kind == "0" else "flow"
            heads = sum(len(s.elements + s.forks) or min(1, len(s.way)) for s in sides)
            takes = {1: "takes", 2: "both take"}.get(heads, "all take")
            who = f"{who} {takes} the {common} from it"
        text = message.format(name(node), who)
        forks = sorted({n for side in sides for n in side.forks})
        for fork in forks:
            text += f"; {self.ruled(fork, shared)}"
        self.label(where, label if parties else "nothing is connected here")
        for side in sides:
            for n in side.elements:
                self.label(n, role(self.node(n)))
        for trace in traces:
            for bond in trace:
                self.step(bond)
        used = sorted({b for trace in traces for b in trace})
        strokes = tuple((self.bonds[b], self.strokes.value[b]) for b in used)
        return self.told(text, physics, where, over, bool(forks), strokes + last)

    def trace(self, start: int) -> list[int]:
        """The bonds from which the stroke of `start` follows, nearest first."""
        queue, seen = [start], {start}
        for bond in queue:
            reason = self.strokes.reason[bond]
            for other in reason.because if reason else ():
                if other not in seen:
                    seen.add(other)
                    queue.append(other)
        return queue

    def side(self, trace: list[int], shared: set[int], where: int) -> Side:
        """A party by the bonds it came along, up to where it came along the same as another."""
        elements: list[int] = []
        way: list[int] = []
        forks: list[int] = []
        for bond in trace:
            reason = self.strokes.reason[bond]
            if reason is None or bond in shared:
                continue
            if any(b in shared for b in reason.because):
                group = forks
            else:
                group = way if reason.cause == "propagated" else elements
            if reason.node not in group and reason.node != where:
                group.append(reason.node)
        return Side(elements, [n for n in way[::-1] if n not in forks], forks)

    def party(self, side: Side) -> str:
        # without a source or sensor the first junction of the way has no choice of its own
        heads, way = side.elements + side.forks, side.way
        if not heads:
            heads, way = way[:1], way[1:]
        who = self.names(heads)
        return f"{who} (through {self.names(way)})" if way else who

    def ruled(self, fork: int, shared: set[int]) -> str:
        """Why the strokes at a fork are what they are."""
        rule = self.net.name.index(fork)
        first = next(e >> 1 for e in self.net.ends[rule] if e >> 1 in shared)
        party = self.party(self.side(self.trace(first), set(), fork))
        common = {"0": "effort", "1": "flow"}.get(self.node(fork).kind, "causality")
        return f"the {common} of {self.name(fork)} is fixed by {party}"

    def step(self, bond: int) -> None:
        """A label for the junction or two-port that forced the stroke of a bond."""
        reason = self.strokes.reason[bond]
        assert reason is not None
        n = reason.node
        if reason.cause != "propagated":
            self.label(n, role(self.node(n)))
            return
        kind = self.node(n).kind
        if not reason.because:
            self.label(n, "has no other bond")
            return
        before = reason.because[0]
        if kind in ("TF", "GY"):
            comes = "effort" if self.receives(before, n) else "flow"
            goes = "a flow" if comes == "effort" else "an effort"
            self.label(n, f"passes the {comes} on" if kind == "TF" else f"makes {goes} of it")
            return
        common = "effort" if kind == "0" else "flow"
        rule = self.net.name.index(n)
        if self.strokes.taken[rule] >> 1 == before:
            self.label(n, f"has the {common} of {self.name(self.other(before, n))}")
        else:
            last = self.name(self.other(bond, n))
            self.label(n, f"only {last} is left to impose its {common}")

    def receives(self, bond: int, n: int) -> bool:
        """Whether node n receives the effort of a bond of the small net."""
        ends = self.graph.bonds[self.bonds[bond]]
        return (ends.head if self.strokes.value[bond] else ends.tail).node == n

    def label(self, n: int, text: str) -> None:
        self.roles.setdefault(n, text)
        span = self.node(n).origin
        if span not in self.seen:
            self.seen.add(span)
            self.labels.append(Label(span, text))

    # -------------------------------------------------- at a bond, and in a loop

    def bond(self, first: int, second: int, last: tuple[tuple[int, int], ...]) -> Explanation:
        """Two on one bond that both impose."""
        a, b = self.node(first), self.node(second)
        what = "effort" if {a.kind, b.kind} <= {"Se", "Df", "0"} else "flow"
        self.label(second, role(b))
        self.label(first, role(a))
        at = last[0][0]
        return self.told(
            f"the {what} of one bond is imposed at both ends, by {name(a)} and {name(b)}",
            f"One end of a bond gives the {what}, the other answers.",
            first,
            True,
            False,
            ((at, 1 - last[0][1]), *last),
        )

    def branched(self) -> Explanation:
        """A contradiction that shows only when the junctions are taken together."""
        forced = [b for b, value in enumerate(self.strokes.value) if value >= 0]
        strokes = tuple((self.bonds[b], self.strokes.value[b]) for b in forced)
        fixed = [must.node for must in self.musts]
        junctions = [n for n in self.net.name if self.node(n).kind in ("0", "1")]
        kinds = {self.node(n).kind for n in junctions}
        common = "effort or flow" if len(kinds) > 1 else "effort" if "0" in kinds else "flow"
        by = f" beside {self.names(fixed)}" if fixed else ""
        text = f"{self.names(junctions or self.net.name)} cannot all get their {common}{by}"
        meet, physics = self.cases()
        for n in [*self.net.name, *fixed]:
            kind = self.node(n).kind
            told = {"TF": "passes effort or flow on", "GY": "makes flow of effort"}.get(kind)
            common = "effort" if kind == "0" else "flow"
            self.label(n, (told or f"needs one {common}") if n not in fixed else role(self.node(n)))
        return self.told(text, physics, meet, None, True, strokes)

    def cases(self) -> tuple[int, str]:
        """The proof, and the junction at which it starts."""
        net = self.net
        ends = [
            end
            for rule, n in enumerate(net.name)
            for end in net.ends[rule]
            if self.strokes.value[end >> 1] < 0 and self.node(n).kind in ("0", "1")
        ]
        found = split(net, self.musts, ends)
        if found is None:
            return net.name[0], (
                "Each 0-junction needs one bond that brings its effort, each 1-junction one that "
                "brings its flow, and these bonds are too few or too many."
            )
        end, yes, no = found
        where = net.name[net.rule[end]]
        common = "effort" if self.node(where).kind == "0" else "flow"
        giver = self.name(self.other(end >> 1, where))
        return where, (
            f"If {giver} imposes the {common} of {self.name(where)}, {self.end(yes)}; "
            f"if not, {self.end(no)}."
        )

    def end(self, branch: Branch) -> str:
        """Where a case ends, in a few words."""
        strokes, (rule, bonds) = branch.strokes, branch.clash
        over = strokes.taken[rule] >= 0
        for bond in bonds if self.node(self.net.name[rule]).kind in ("TF", "GY") else ():
            # a two-port only hands on what two junctions disagree about
            reason = strokes.reason[bond]
            if reason and reason.cause == "propagated" and reason.because:
                rule = self.net.name.index(reason.node)
                taken = strokes.taken[rule] >> 1
                over, bonds = taken != bond, (taken, bond)
                break
        where = self.net.name[rule]
        kind = self.node(where).kind
        if not over:
            return f"{self.name(where)} {_NOBODY[kind][2]}"
        by = listing([self.name(self.other(bond, where)) for bond in bonds])
        return f"{self.name(where)} {_TWICE[kind][2]}, by {by}"


def role(node: Node) -> str:
    """What a source, a detector or a junction that is switched off imposes."""
    match node.kind:
        case "Se":
            return "imposes an effort"
        case "Sf":
            return "imposes a flow"
        case "De":
            return "an ideal De takes no flow: it imposes the flow zero"
        case "0" | "1":
            return f"off, it imposes the {'effort' if node.kind == '0' else 'flow'} zero"
        case _:
            return "an ideal Df takes no effort: it imposes the effort zero"


class Branch(NamedTuple):
    """One stroke of a bond, and the contradiction to which it leads."""

    strokes: Strokes
    clash: Clash


def split(net: Network, musts: list[Wish], ends: list[int]) -> tuple[int, Branch, Branch] | None:
    """Of these bond ends the one with the shortest proof that it cannot be strong nor weak.

    The first branch is the one in which it is strong. None where one bond is not enough.
    """
    best: tuple[int, Branch, Branch] | None = None
    shortest = 0
    for end in ends[:_LARGE]:
        pair = []
        for value in (net.strong[end], 1 - net.strong[end]):
            strokes = Strokes(net)
            oblige(strokes, musts)
            clash = strokes.put(end >> 1, value, Reason("chosen", net.name[net.rule[end]]))
            if clash is None:
                break
            pair.append(Branch(strokes, clash))
        size = sum(len(branch.strokes.trail) for branch in pair)
        if len(pair) == 2 and (best is None or size < shortest):
            shortest, best = size, (end, pair[0], pair[1])
    return best
