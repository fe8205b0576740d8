"""Strokes that follow from other strokes: propagation by worklist, each with its reason."""

from __future__ import annotations

from bondgraph.ir.causal import Reason
from bondgraph.passes.causality.rules import Network, Wish
from bondgraph.text.tuples import NamedTuple


class Clash(NamedTuple):
    """A rule that cannot be kept because of the strokes of `bonds` (-1: a bond with two wishes)."""

    rule: int
    bonds: tuple[int, ...]


class Strokes:
    """A partial assignment, closed under the rules: linear in the number of bonds as a whole.

    `value[b]` is the stroke (0 tail, 1 head, -1 open), `trail` the bonds in order of assignment.
    """

    __slots__ = ("_last", "_open", "net", "reason", "taken", "trail", "value")

    def __init__(self, net: Network) -> None:
        self.net = net
        self.value = [-1] * net.bonds
        self.reason: list[Reason | None] = [None] * net.bonds
        self.taken = [-1] * len(net.ends)  # the strong end of each rule
        self.trail: list[int] = []
        self._open = [len(ends) for ends in net.ends]
        self._last = [0] * len(net.ends)  # exclusive or of the open ends: names the last one
        for rule, ends in enumerate(net.ends):
            for end in ends:
                self._last[rule] ^= end

    def start(self) -> Clash | None:
        """Assign what follows without any choice: a junction of one bond has it strong."""
        for rule, ends in enumerate(self.net.ends):
            if not ends:
                return Clash(rule, ())
            if len(ends) == 1 and self.taken[rule] < 0:
                reason = Reason("propagated", self.net.name[rule])
                clash = self.put(ends[0] >> 1, self.net.strong[ends[0]], reason)
                if clash is not None:
                    return clash if clash.rule >= 0 else Clash(rule, clash.bonds)
        return None

    def wish(self, wish: Wish) -> Clash | None:
        """Grant a wish, with all that follows."""
        return self.put(wish.bond, wish.value, Reason(wish.cause, wish.node))

    def put(self, bond: int, value: int, reason: Reason) -> Clash | None:
        """Place a stroke and propagate; on a clash the strokes placed so far stay."""
        if self.value[bond] >= 0:
            return None if self.value[bond] == value else Clash(-1, (bond,))
        self._set(bond, value, reason)
        at = len(self.trail) - 1
        rules = self.net.rule
        while at < len(self.trail):
            now = self.trail[at]
            at += 1
            tail, head = 2 * now, 2 * now + 1
            forward = rules[tail] < rules[head]  # the way a bond is drawn must not matter
            for end in (tail, head) if forward else (head, tail):
                rule = rules[end]
                if rule >= 0:
                    clash = self._follow(rule, end)
                    if clash is not None:
                        return clash
        return None

    def _set(self, bond: int, value: int, reason: Reason) -> None:
        self.value[bond] = value
        self.reason[bond] = reason
        self.trail.append(bond)

    def _follow(self, rule: int, end: int) -> Clash | None:
        """What the stroke at `end` means for the other bonds of the rule."""
        net, bond = self.net, end >> 1
        self._open[rule] -= 1
        self._last[rule] ^= end
        if self.value[bond] == net.strong[end]:
            if self.taken[rule] >= 0:
                return Clash(rule, (self.taken[rule] >> 1, bond))
            self.taken[rule] = end
            reason = Reason("propagated", net.name[rule], (bond,))
            for other in net.ends[rule]:
                if self.value[other >> 1] < 0:
                    self._set(other >> 1, 1 - net.strong[other], reason)
        elif self.taken[rule] < 0 and self._open[rule] < 2:
            last = self._last[rule]
            others = [e >> 1 for e in net.ends[rule] if e != last or not self._open[rule]]
            if not self._open[rule]:
                return Clash(rule, tuple(others))
            if self.value[last >> 1] < 0:
                reason = Reason("propagated", net.name[rule], tuple(others))
                self._set(last >> 1, net.strong[last], reason)
        return None
