"""What shows of a switch that is not in the position that it is told, in words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from bondgraph.ir.signature_matrix import ModeSignature, ModeSignatures, stuck
from bondgraph.text.numerals import joined, listed, plural

_APART = "told apart from all other faults"


def stuck_switches(mode: ModeSignature) -> Iterator[tuple[str, str]]:
    """In one mode, each switch that is in the other position, and what shows of that."""
    for switch, name in mode.stuck.items():
        yield name, shown(mode, switch)


def shown(mode: ModeSignature, fault: str) -> str:
    """What a fault does while the machine stays in a mode, and what else does that.

    >>> import bondgraph
    >>> off, on = bondgraph.compile("models/oven.bg").mode_signatures.modes
    >>> shown(on, "on"), shown(off, "P")
    ('moves r1, like Ch or P', 'not seen')
    """
    what = seen(mode, fault)
    if mode.matrix is None or not what.startswith("moves"):
        return what
    others = [mode.stuck.get(f, f) for f in mode.matrix.confused_with(fault)]
    alike = f"like {listed(others, 'or')}" if others else _APART
    return f"{what}, {alike}"


def seen(mode: ModeSignature, fault: str) -> str:
    """What a fault does while the machine stays in a mode."""
    if mode.matrix is None:
        return f"no behaviour, {mode.reason}"
    if fault in mode.impossible:
        return f"no behaviour in that position, {mode.impossible[fault]}"
    residuals = mode.matrix.seen_by(fault)
    return f"moves {joined(residuals)}" if residuals else "not seen"


def positions(found: ModeSignatures) -> Iterator[tuple[str, list[tuple[ModeSignature, str]]]]:
    """Each switch stuck off and on, with what shows of it in each mode that tells otherwise."""
    for switch in found.names:
        for position in (False, True):
            there = [m for m in found.modes if m.modes[switch] is not position]
            yield stuck(switch, position), [(m, shown(m, switch)) for m in there]


def by_modes(there: Sequence[tuple[ModeSignature, str]]) -> Iterator[str]:
    """What is said of modes, once for all that have some inputs in common, the usual last.

    Inputs that are the same in all of the modes are left out.

    >>> modes = [{"a": a, "b": b} for a in (False, True) for b in (False, True)]
    >>> there = [ModeSignature(m, None, "") for m in modes]
    >>> list(by_modes([*zip(there, ["not seen", "not seen", "moves r1", "moves r1"])]))
    ['a off: not seen', 'a on: moves r1']
    >>> list(by_modes([*zip(there, ["not seen", "moves r1", "moves r1", "moves r1"])]))
    ['a off, b off: not seen', 'otherwise: moves r1']
    """
    alike: dict[str, list[ModeSignature]] = {}
    for mode, what in there:
        alike.setdefault(what, []).append(mode)
    usual = _common([mode for mode, _ in there])
    for what, modes in sorted(alike.items(), key=lambda item: len(item[1])):
        common = _common(modes)
        same = sum(common.items() <= mode.modes.items() for mode, _ in there) == len(modes)
        inputs = {n: on for n, on in common.items() if n not in usual}
        if len(alike) == 1:
            yield what
        elif same:
            yield f"{ModeSignature(inputs, None, '').name}: {what}"
        elif 2 * len(modes) > len(there):
            yield f"otherwise: {what}"
        else:
            yield f"{modes[0].name} and {plural(len(modes) - 1, 'mode')} more: {what}"


def _common(modes: Sequence[ModeSignature]) -> dict[str, bool]:
    """The inputs that are the same in all of the modes."""
    first = modes[0].modes if modes else {}
    return {n: on for n, on in first.items() if all(mode.modes[n] is on for mode in modes)}


def overall(found: ModeSignatures) -> Iterator[str]:
    """A line for each position of each switch: in how many modes it shows, and how clearly."""
    for name, there in positions(found):
        words = {what for _, what in there}
        if len(words) == 1:
            yield f"{name}: {words.pop()}"
            continue
        moves = [what for _, what in there if what.startswith("moves")]
        apart = sum(what.endswith(_APART) for what in moves)
        yield f"{name}: seen in {len(moves)} of {len(there)} modes, {_APART} in {apart}"
