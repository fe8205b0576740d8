"""Why a bond graph admits no causality: irreducible cores of rules and demands."""

from __future__ import annotations

from collections.abc import Sequence

from bondgraph.passes.causality.repair import Matching
from bondgraph.passes.causality.rules import Network, Wish
from bondgraph.passes.causality.strokes import Clash, Strokes
from bondgraph.text.tuples import NamedTuple

#: Beyond this size a core is the chain of forced strokes as it was found, not tested link by link.
_LARGE = 400


class Core(NamedTuple):
    """Rules and demands that contradict each other; without any one of them the rest agree."""

    rules: list[int]
    musts: list[Wish]

    def nodes(self, net: Network) -> list[int]:
        """Its members: junctions and two-ports, then sources and detectors."""
        return [*[net.name[rule] for rule in self.rules], *[must.node for must in self.musts]]


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


def cores(
    net: Network, musts: list[Wish], alike: Sequence[int] | None = None, most: int = 10
) -> list[Core]:
    """Contradictions that have no rule and no demand in common, each irreducible, `most` of them.

    `alike[node]` is the same number for nodes that come from the same place of the text (None: no
    two do): a contradiction is then told once, however many instances of a submodel repeat it.
    """
    own = range(max([*net.name, *[m.node for m in musts]], default=-1) + 1)
    kind: Sequence[int] = own if alike is None else alike
    rules = list(range(len(net.ends)))
    found: list[Core] = []
    while len(found) < most:
        core = _core(net, rules, musts)
        if core is None:
            break
        found.append(core)
        gone = {kind[node] for node in core.nodes(net)}
        rules = [rule for rule in rules if kind[net.name[rule]] not in gone]
        musts = [must for must in musts if kind[must.node] not in gone]
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
