"""What shows of a switch that is not in the position that it is told, in words."""

from __future__ import annotations

from collections.abc import Iterator

from bondgraph.ir.signature_matrix import ModeSignature, ModeSignatures, stuck
from bondgraph.text.numerals import joined, listed


def stuck_switches(mode: ModeSignature) -> Iterator[tuple[str, str]]:
    """In one mode, each switch that is in the other position, and what shows of that."""
    for switch, name in mode.stuck.items():
        yield name, shown(mode, switch)


def shown(mode: ModeSignature, fault: str) -> str:
    """What a fault does while the machine stays in a mode.

    >>> import bondgraph
    >>> off, on = bondgraph.compile("models/oven.bg").mode_signatures.modes
    >>> shown(on, "on"), shown(off, "P")
    ('moves r1, like Ch or P', 'not seen')
    """
    if mode.matrix is None:
        return f"no behaviour, {mode.reason}"
    if fault in mode.impossible:
        return f"no behaviour in that position, {mode.impossible[fault]}"
    seen = mode.matrix.seen_by(fault)
    if not seen:
        return "not seen"
    others = [mode.stuck.get(f, f) for f in mode.matrix.confused_with(fault)]
    alike = f"like {listed(others, 'or')}" if others else "told apart from all other faults"
    return f"moves {joined(seen)}, {alike}"


def positions(found: ModeSignatures) -> Iterator[tuple[str, list[tuple[ModeSignature, str]]]]:
    """Each switch stuck off and on, with what shows of it in each mode that tells otherwise."""
    for switch in found.names:
        for position in (False, True):
            there = [m for m in found.modes if m.modes[switch] is not position]
            yield stuck(switch, position), [(m, shown(m, switch)) for m in there]


def overall(found: ModeSignatures) -> Iterator[str]:
    """A line for each position of each switch: in how many modes it shows, and how clearly."""
    for name, there in positions(found):
        words = {what for _, what in there}
        if len(words) == 1:
            yield f"{name}: {words.pop()}"
            continue
        moves = [what for _, what in there if what.startswith("moves")]
        apart = sum(what.endswith("told apart from all other faults") for what in moves)
        yield (
            f"{name}: seen in {len(moves)} of {len(there)} modes,"
            f" told apart from all other faults in {apart}"
        )
