"""What `diagnose` decides by: classes of faults with what sees them, and limits of a tuning."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import ceil

from bondgraph.backends import listing
from bondgraph.backends.identifiers import snake
from bondgraph.backends.target import Target
from bondgraph.ir.program import Program
from bondgraph.ir.residual_limit import NEVER, OVERSHOOT, ROW, SHARE, ResidualLimit
from bondgraph.notation.dialect import digits
from bondgraph.text.tuples import NamedTuple

#: Rows that all residuals have to be quiet for, and that a class waits for after the last alarm.
HOLD, SETTLED = 10, 2


class Tuned(NamedTuple):
    """Limits by residual, of a tuning that `source` tells of; none without one."""

    limits: Mapping[str, ResidualLimit]
    source: str


UNTUNED = Tuned({}, "")


class FaultClass(NamedTuple):
    """Faults that the same residuals see, and the same ones show.

    What `shows` a fault is moved by it for sure, if the fault is large enough: such a residual
    that stays quiet speaks against it. What only `sees` it may be moved.
    """

    faults: tuple[str, ...]
    sees: tuple[bool, ...]
    shows: tuple[bool, ...]


def fault_classes(program: Program) -> tuple[FaultClass, ...]:
    """The classes of a program, in the order in which its residuals name them.

    Where a machine has switches it depends on them what a residual sees: nothing shows for sure.
    Nor does a residual that `step` never has, or cannot see the fault in at this sample rate.
    """
    residuals = program.residuals
    switched = any(k.kind == "mode" for k in program.knowns)

    entries: dict[str, list[tuple[int, bool]]] = {}  # by fault the residuals, and which show it
    for at, info in enumerate(residuals):
        for fault in () if info.unavailable else info.faults:
            sure = not (switched or fault in info.invisible)
            entries.setdefault(fault, []).append((at, sure))
    rows: dict[tuple[tuple[int, bool], ...], list[str]] = {}
    for fault in dict.fromkeys(f for r in residuals for f in r.faults):
        if fault in entries:
            rows.setdefault(tuple(entries[fault]), []).append(fault)
    size = range(len(residuals))
    return tuple(
        FaultClass(
            tuple(faults),
            tuple(map({at for at, _ in row}.__contains__, size)),
            tuple(map({at for at, sure in row if sure}.__contains__, size)),
        )
        for row, faults in rows.items()
    )


def samples_a_row(program: Program) -> int:
    """Samples between two rows, at the rate and the bandwidth that the code is made for."""
    return max(1, ceil(ROW / program.bandwidth * program.rate))


def c_holes(program: Program, tuned: Tuned, target: Target) -> dict[str, object]:
    """The holes of diagnosis.h.j2 and diagnosis.c.j2."""
    prefix = snake(program.name).upper()
    own = fault_classes(program)
    names = [f'"{f}",' for c in own for f in c.faults]
    place = [f"{k}u," for k, c in enumerate(own) for _ in c.faults]

    def real(x: float) -> str:
        return f"{prefix}_CONSTANT({digits(x)})"

    rows = [[f"{x}u" for x in _entries(c)] for c in own] or [["0u"] * len(program.residuals)]
    return {
        **_both(program, tuned, real, target),
        "fault_count": len(place),
        "fault_size": max((len(f) for c in own for f in c.faults), default=0) + 1,
        "residual_size": max((len(r.name) for r in program.residuals), default=0) + 1,
        "class_count": len(own),
        "none_fault": "" if place else " + 1",
        "none_class": "" if own else " + 1",
        "fault_names": listing.table_lines(names or ['"",'], target, 4),
        "fault_class": listing.table_lines(place or ["0u,"], target, 4),
        "signatures": [line for row in rows for line in _row(row, "{}", target)],
    }


def python_holes(program: Program, tuned: Tuned, target: Target) -> dict[str, object]:
    """The holes of diagnosis.py.j2."""
    own = fault_classes(program)
    return {
        **_both(program, tuned, digits, target),
        "class_names": [
            line for c in own for line in _row([f'"{f}"' for f in c.faults], "()", target)
        ],
        "signatures": [
            line for c in own for line in _row([str(x) for x in _entries(c)], "()", target)
        ],
    }


def _both(
    program: Program, tuned: Tuned, real: Callable[[float], str], target: Target
) -> dict[str, object]:
    row = samples_a_row(program)
    known = [tuned.limits.get(r.name, NEVER) for r in program.residuals] if tuned.source else []
    rows = [[real(x) for x in limit] for limit in known]
    braces = "{}" if target.folder == "c" else "()"
    names = [f'"{r.name}",' for r in program.residuals]
    return {
        "residual_names": listing.table_lines(names, target, 4),
        "decides": not program.bounds,
        "row": row,
        "least": max(3, row // 10),
        "hold": HOLD,
        "settled": SETTLED,
        "overshoot": digits(OVERSHOOT),
        "share": digits(SHARE),
        "tuned": listing.harmless(tuned.source, target),
        "limits": [line for own in rows for line in _row(own, braces, target)],
    }


def _entries(own: FaultClass) -> list[int]:
    """1 where a residual may be moved, 3 where it is for sure."""
    return [sees + 2 * shows for sees, shows in zip(own.sees, own.shows, strict=True)]


def _row(items: Sequence[str], braces: str, target: Target) -> list[str]:
    """One row of a table, in braces, over as many lines as it needs."""
    if not items:
        return []
    words = [f"{item}," for item in items]
    words[0] = braces[0] + words[0]
    words[-1] = words[-1].rstrip(",") + ("," if braces == "()" and len(words) == 1 else "")
    words[-1] += f"{braces[1]},"
    first, *more = listing.table_lines(words, target, 4)
    return [first, *(f" {line}" for line in more)]
