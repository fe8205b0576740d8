"""Proof by two cases: a bond of which neither stroke can stand."""

from __future__ import annotations

from bondgraph.ir.causal import Reason
from bondgraph.passes.causality.cores import oblige
from bondgraph.passes.causality.rules import Network, Wish
from bondgraph.passes.causality.strokes import Clash, Strokes
from bondgraph.text.tuples import NamedTuple

_LARGE = 300  # bonds tried one after the other


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
