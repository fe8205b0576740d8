"""Why a bond graph admits no causality: irreducible cores, told as a story."""

from __future__ import annotations

from bondgraph.ir.graph import BondGraph, Node
from bondgraph.passes.causal.matching import Matching
from bondgraph.passes.causal.network import Network, Wish
from bondgraph.passes.causal.strokes import Clash, Strokes
from bondgraph.text.diagnostic import Label, Report
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

#: Beyond this size a core is the chain of forced strokes as it was found, not tested link by link.
_LARGE = 400
_MOST = 10


class Core(NamedTuple):
    """Rules and demands that contradict each other; without any one of them the rest agree."""

    rules: list[int]
    musts: list[Wish]


class Refutation(NamedTuple):
    """Rules and demands (as numbers) that contradict each other, and how that came to light."""

    rules: list[int]
    musts: list[int]
    strokes: Strokes
    clash: Clash | None
    wish: Wish | None


def oblige(strokes: Strokes, musts: list[Wish]) -> tuple[Clash, Wish | None] | None:
    """Grant all demands, then what follows without any; the clash if that is impossible."""
    for wish in musts:
        clash = strokes.wish(wish)
        if clash is not None:
            return clash, wish
    clash = strokes.start()
    return None if clash is None else (clash, None)


def refute(net: Network, musts: list[Wish]) -> Refutation | None:
    """A contradiction among the rules and demands, or None where an assignment exists."""
    strokes = Strokes(net)
    failed = oblige(strokes, musts)
    if failed is not None:
        clash, wish = failed
        rules, used = _trace(strokes, musts, clash.bonds, [clash.rule] if clash.rule >= 0 else [])
        if wish is not None and clash.rule < 0:
            used = sorted({*used, musts.index(wish)})
        return Refutation(rules, used, strokes, clash, wish)
    matching = Matching(strokes, [-1] * net.bonds)
    if matching.complete():
        return None
    tree = sorted(v for v in matching.tree if v < matching.rules)
    touching = [e >> 1 for rule in tree for e in net.ends[rule] if strokes.value[e >> 1] >= 0]
    rules, used = _trace(strokes, musts, tuple(touching), tree)
    return Refutation(rules, used, strokes, None, None)


def _trace(
    strokes: Strokes, musts: list[Wish], bonds: tuple[int, ...], rules: list[int]
) -> tuple[list[int], list[int]]:
    """The rules and the demands from which these strokes follow."""
    rule_of = {name: rule for rule, name in enumerate(strokes.net.name)}
    by_bond: dict[tuple[int, int], int] = {}
    for i, must in enumerate(musts):
        by_bond.setdefault((must.bond, must.value), i)
    found, used = set(rules), set()
    stack, seen = list(bonds), set(bonds)
    while stack:
        bond = stack.pop()
        reason = strokes.reason[bond]
        if reason is None:
            continue
        if reason.cause != "propagated":
            used.add(by_bond[bond, strokes.value[bond]])
            continue
        found.add(rule_of[reason.node])
        for other in reason.because:
            if other not in seen:
                seen.add(other)
                stack.append(other)
    return sorted(found), sorted(used)


def restrict(net: Network, rules: list[int], musts: list[Wish]) -> tuple[Network, list[Wish]]:
    """The problem of these rules and demands alone."""
    small, place = net.part(rules, [must.bond for must in musts])
    return small, [must._replace(bond=place[must.bond]) for must in musts]


def cores(net: Network, musts: list[Wish]) -> list[Core]:
    """Contradictions that have no rule and no demand in common, each irreducible."""
    rules = list(range(len(net.ends)))
    found: list[Core] = []
    while len(found) < _MOST:
        core = _core(net, rules, musts)
        if core is None:
            break
        found.append(core)
        gone = set(core.rules)
        rules = [rule for rule in rules if rule not in gone]
        musts = [must for must in musts if must not in core.musts]
    return found


def _core(net: Network, rules: list[int], musts: list[Wish]) -> Core | None:
    found = _smaller(net, rules, musts)
    if found is None:
        return None
    rules, musts = found
    for kept in [*reversed(musts), *reversed(rules)]:
        if len(rules) + len(musts) > _LARGE:
            break
        if kept in musts or kept in rules:
            fewer = _smaller(net, [r for r in rules if r != kept], [m for m in musts if m != kept])
            if fewer is not None:
                rules, musts = fewer
    return Core(rules, musts)


def _smaller(
    net: Network, rules: list[int], musts: list[Wish]
) -> tuple[list[int], list[Wish]] | None:
    refutation = refute(*restrict(net, rules, musts))
    if refutation is None:
        return None
    return [rules[r] for r in refutation.rules], [musts[m] for m in refutation.musts]


# ------------------------------------------------------------------- telling


class Side(NamedTuple):
    """One of the parties that meet at a junction: elements, and the junctions on their way."""

    elements: list[int]
    way: list[int]


def report_conflicts(graph: BondGraph, net: Network, musts: list[Wish], report: Report) -> None:
    """One error for each independent contradiction."""
    for core in cores(net, musts):
        small, wishes = restrict(net, core.rules, core.musts)
        refutation = refute(small, wishes)
        assert refutation is not None
        _tell(graph, refutation, core, report)


def _tell(graph: BondGraph, refutation: Refutation, core: Core, report: Report) -> None:
    strokes, clash, wish = refutation.strokes, refutation.clash, refutation.wish
    if clash is None:
        _tell_loop(graph, strokes.net, core, report)
        return
    if clash.rule >= 0:
        where = strokes.net.name[clash.rule]
        over = strokes.taken[clash.rule] >= 0
        sides = [_side(strokes, bond, where) for bond in clash.bonds]
    else:
        assert wish is not None
        reason = strokes.reason[clash.bonds[0]]
        assert reason is not None
        if reason.cause != "propagated":
            _tell_bond(graph, reason.node, wish, report)
            return
        where = reason.node
        rule = strokes.net.name.index(where)
        over = bool(reason.because) and strokes.taken[rule] >> 1 == reason.because[0]
        sides = [_side(strokes, bond, where) for bond in reason.because]
        sides.append(Side([wish.node], []))
    _tell_junction(graph, where, over, sides, report)


def _side(strokes: Strokes, start: int, where: int) -> Side:
    """What fixes the stroke of bond `start`: the elements, and the way from them to `where`."""
    elements: list[int] = []
    way: list[int] = []
    queue, seen = [start], {start}
    for bond in queue:
        reason = strokes.reason[bond]
        if reason is None:
            continue
        group = way if reason.cause == "propagated" else elements
        if reason.node not in group and reason.node != where:
            group.append(reason.node)
        for other in reason.because:
            if other not in seen:
                seen.add(other)
                queue.append(other)
    return Side(elements, way[::-1])


def name(node: Node) -> str:
    """A node as it is spoken of: `R:fe`, `0:bus`."""
    return f"{node.keyword}:{node.path}"


def listing(names: list[str], most: int = 6) -> str:
    """Names joined as in a sentence; the many are counted."""
    if len(names) > most:
        names = [*names[: most - 1], f"{len(names) - most + 1} more"]
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def sentence(text: str) -> str:
    """The text with a capital letter, unless it begins with a name, and with a full stop."""
    first = text if ":" in text.split(" ", 1)[0] else text[:1].upper() + text[1:]
    return f"{first}."


_TWICE = {
    "0": (
        "the effort of {0} is imposed twice, by {1}",
        "A 0-junction has one effort, so only one bond can bring it in.",
        "Put the resistance or inertance that lies between the two into the model: a 1-junction "
        "with R or I between them. Or remove one of the two.",
    ),
    "1": (
        "the flow of {0} is imposed twice, by {1}",
        "A 1-junction has one flow, so only one bond can bring it in.",
        "Put the compliance or leakage that lies between the two into the model: a 0-junction "
        "with C or R between them. Or remove one of the two.",
    ),
    "TF": (
        "{0} receives effort from both sides, by {1}",
        "A transformer passes effort on: one side takes it, the other gives it.",
        "Put a 1-junction with the R or I that lies between the two next to the transformer, "
        "or remove one of the two.",
    ),
    "GY": (
        "{0} receives an effort on one side and a flow on the other, by {1}",
        "A gyrator turns effort into flow: both sides take effort or both take flow.",
        "Put a junction with the R, C or I that is missing next to the gyrator, or remove one "
        "of the two.",
    ),
}
_NOBODY = {
    "0": (
        "nothing imposes the effort of {0}: {1}",
        "Every bond of this 0-junction brings a flow, none an effort; their sum cannot be zero.",
        "Add the C or R at which this effort builds up, or let one source be an Se.",
    ),
    "1": (
        "nothing imposes the flow of {0}: {1}",
        "Every bond of this 1-junction brings an effort, none a flow; their sum cannot be zero.",
        "Add the I or R that limits this flow, or let one source be an Sf.",
    ),
    "TF": (
        "{0} receives a flow from both sides, by {1}",
        "A transformer passes flow on: one side takes it, the other gives it.",
        "Put a 0-junction with the C or R that lies between the two next to the transformer, "
        "or remove one of the two.",
    ),
    "GY": (
        "{0} receives a flow on one side and an effort on the other, by {1}",
        "A gyrator turns effort into flow: both sides take effort or both take flow.",
        "Put a junction with the R, C or I that is missing next to the gyrator, or remove one "
        "of the two.",
    ),
}


def _tell_junction(
    graph: BondGraph, where: int, over: bool, sides: list[Side], report: Report
) -> None:
    node = graph.nodes[where]
    message, physics, remedy = (_TWICE if over else _NOBODY)[node.kind]
    parties = [_party(graph, side) for side in sides if side.elements or side.way]
    who = listing(parties) if parties else "it has no bond"
    if not over and node.kind in ("0", "1") and parties:
        common = "effort" if node.kind == "0" else "flow"
        heads = sum(len(side.elements or side.way[:1]) for side in sides)
        takes = {1: "takes", 2: "both take"}.get(heads, "all take")
        who = f"{who} {takes} the {common} from it"
    labels = [Label(node.origin, "here they meet" if parties else "nothing is connected here")]
    seen: set[Span] = {node.origin}
    for side in sides:
        for at in side.elements:
            _label(graph, at, _role(graph.nodes[at]), labels, seen)
        for at in side.way:
            _label(graph, at, "on the way", labels, seen)
    text = message.format(name(node), who)
    report.error("causality-conflict", sentence(text), *labels[:8], help=f"{physics} {remedy}")


def _label(graph: BondGraph, at: int, text: str, labels: list[Label], seen: set[Span]) -> None:
    span = graph.nodes[at].origin
    if span not in seen:
        seen.add(span)
        labels.append(Label(span, text))


def _party(graph: BondGraph, side: Side) -> str:
    # without a source or sensor the first junction of the way has no choice of its own
    heads, way = (side.elements, side.way) if side.elements else (side.way[:1], side.way[1:])
    who = listing([name(graph.nodes[n]) for n in heads], 4)
    return f"{who} (through {listing([name(graph.nodes[n]) for n in way], 4)})" if way else who


def _role(node: Node) -> str:
    match node.kind:
        case "Se":
            return "imposes an effort"
        case "Sf":
            return "imposes a flow"
        case "De":
            return "an ideal De takes no flow: it imposes the flow zero"
        case _:
            return "an ideal Df takes no effort: it imposes the effort zero"


def _tell_bond(graph: BondGraph, first: int, wish: Wish, report: Report) -> None:
    """Two sources or detectors on one bond."""
    a, b = graph.nodes[first], graph.nodes[wish.node]
    what = "effort" if {a.kind, b.kind} <= {"Se", "Df"} else "flow"
    report.error(
        "causality-conflict",
        f"The {what} of one bond is imposed at both ends, by {name(a)} and {name(b)}.",
        Label(b.origin, _role(b)),
        Label(a.origin, _role(a)),
        help=f"One end of a bond gives the {what}, the other answers. Put the R, I or C that "
        "lies between the two into the model, or remove one of them.",
    )


def _tell_loop(graph: BondGraph, net: Network, core: Core, report: Report) -> None:
    """A contradiction that shows only when the junctions are counted together."""
    nodes = [graph.nodes[n] for n in net.name]
    fixed = [graph.nodes[must.node] for must in core.musts]
    by = f" with {listing([name(n) for n in fixed])}" if fixed else ""
    places = [Label(n.origin, "one of the junctions") for n in nodes[:4]]
    places += [Label(n.origin, _role(n)) for n in fixed[:4]]
    report.error(
        "causality-conflict",
        f"{listing([name(n) for n in nodes])} cannot all get their effort or flow{by}.",
        *places,
        help="Each 0-junction needs one bond that brings its effort, each 1-junction one that "
        "brings its flow, and these bonds are too few or too many. Add the R, C or I that is "
        "missing at one of these junctions, or merge junctions that are one.",
    )
