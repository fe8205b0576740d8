"""What `diagnose` decides by: classes of faults, what sees them from which size on, and limits."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import accumulate
from math import ceil, floor, inf, log2

from bondgraph.backends import listing
from bondgraph.backends.identifiers import snake
from bondgraph.backends.target import Target
from bondgraph.ir.program import Program
from bondgraph.ir.residual_limit import (
    NEVER,
    OVERSHOOT,
    ROW,
    SHARE,
    ResidualLimit,
    ShownSize,
)
from bondgraph.notation.dialect import digits
from bondgraph.text.tuples import NamedTuple

#: Rows that all residuals have to be quiet for, and that a class waits for after the last alarm.
HOLD, SETTLED = 10, 2
#: Sizes on board are whole eighths of an octave; so much is added to what is least, and what a
#: residual has to be out for to be seen is counted from the sixteenth part on.
EIGHTH, LEAST, FIRST = 2.0**0.125, 128, 0.0625
#: Codes of sizes: the residual shows any size; it never is sure to.
ANY, NO_SIZE = 0, 255


class Tuned(NamedTuple):
    """What a tuning that `source` tells of knows by residual; nothing without one.

    `limits`, and from which size on each fault `shows` in a `window` of seconds.
    """

    limits: Mapping[str, ResidualLimit]
    source: str
    shows: Mapping[str, Mapping[str, ShownSize]]
    window: float


UNTUNED = Tuned({}, "", {}, 0.0)


class FaultClass(NamedTuple):
    """Faults that the same residuals see, with the numbers of these and codes of sizes for each.

    A residual that is out, so many eighths of an octave above a sixteenth of what makes it sure to
    be, makes a fault so much larger than what is `least`. One that is quiet speaks against a fault
    of the size that it is `sure` to show, and above.
    """

    faults: tuple[str, ...]
    seen_by: tuple[int, ...]
    least: tuple[int, ...]
    sure: tuple[int, ...]


def fault_classes(program: Program, tuned: Tuned = UNTUNED) -> tuple[FaultClass, ...]:
    """The classes of a program, in the order in which its residuals name them.

    Without a tuning a residual that sees a fault is taken to show any size of it. Not so where a
    machine has switches, as it depends on them what a residual sees; nor does a residual that
    `step` never has, or cannot see the fault in at this sample rate.
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
    found = []
    for row, faults in rows.items():
        seen_by = tuple([at for at, _ in row])
        if tuned.source:
            codes = [_of_class(faults, tuned.shows.get(residuals[at].name, {})) for at in seen_by]
        else:
            codes = [(1, ANY if sure else NO_SIZE) for _, sure in row]
        found.append(FaultClass(tuple(faults), seen_by, *zip(*codes, strict=True)))
    return tuple(found)


def _of_class(faults: Sequence[str], shown: Mapping[str, ShownSize]) -> tuple[int, int]:
    """The codes of one residual for any of some faults; both are on the safe side."""
    known = [shown[f] for f in faults if f in shown]
    if len(known) < len(faults):  # one that never moved it in the log: no level says its size
        return 1, NO_SIZE
    least, sure = min(size.least for size in known), max(size.sure for size in known)
    low = floor(8.0 * log2(least)) + LEAST if least > 0.0 else 1
    high = ceil(8.0 * log2(sure) - 8.0 * log2(FIRST)) + LEAST + 1 if 0.0 < sure < inf else NO_SIZE
    return min(max(low, 1), NO_SIZE - 1), min(max(high, 1), NO_SIZE)


def samples_a_row(program: Program) -> int:
    """Samples between two rows, at the rate and the bandwidth that the code is made for."""
    return max(1, ceil(ROW / program.bandwidth * program.rate))


def c_holes(program: Program, tuned: Tuned, target: Target) -> dict[str, object]:
    """The holes of diagnosis.h.j2 and diagnosis.c.j2."""
    prefix = snake(program.name).upper()
    own = fault_classes(program, tuned)
    names = [f'"{f}",' for c in own for f in c.faults]
    place = [f"{k}u," for k, c in enumerate(own) for _ in c.faults]

    def real(x: float) -> str:
        return f"{prefix}_CONSTANT({digits(x)})"

    def table(numbers: Iterable[int]) -> list[str]:
        return listing.table_lines([f"{x}u," for x in numbers] or ["0u,"], target, 4)

    stem = snake(program.name)
    return {
        **_both(program, tuned, real, target),
        "sum_type": f"{stem}_real",
        "peak_type": f"{stem}_real",
        "level_type": f"{stem}_real",
        "wide": "real",
        "wrap": " ",
        "level": "limit->level",
        "not_quiet": "!(out < RELEASE * limit->level)",
        "peak_code": "eighths(d->peak[k])",
        "no_peak": "REAL(0.0)",
        "fault_count": len(place),
        "fault_size": max((len(f) for c in own for f in c.faults), default=0) + 1,
        "residual_size": max((len(r.name) for r in program.residuals), default=0) + 1,
        "class_count": len(own),
        "none_fault": "" if place else " + 1",
        "none_class": "" if own else " + 1",
        "fault_names": listing.table_lines(names or ['"",'], target, 4),
        "fault_class": listing.table_lines(place or ["0u,"], target, 4),
        "none_seen": "" if own else " + 1",
        "entry_count": sum(len(c.seen_by) for c in own),
        "first_entries": table(accumulate([len(c.seen_by) for c in own], initial=0)),
        "seen_by": table(at for c in own for at in c.seen_by),
        "least_sizes": table(x for c in own for x in c.least),
        "sure_sizes": table(x for c in own for x in c.sure),
    }


def python_holes(program: Program, tuned: Tuned, target: Target) -> dict[str, object]:
    """The holes of diagnosis.py.j2."""
    own = fault_classes(program, tuned)

    def table(rows: Iterable[Iterable[object]]) -> list[str]:
        return [line for row in rows for line in _row([*map(str, row)], "()", target)]

    return {
        **_both(program, tuned, digits, target),
        "class_names": table([f'"{f}"' for f in c.faults] for c in own),
        "seen_by": table(c.seen_by for c in own),
        "least_sizes": table(c.least for c in own),
        "sure_sizes": table(c.sure for c in own),
    }


def _both(
    program: Program, tuned: Tuned, real: Callable[[float], str], target: Target
) -> dict[str, object]:
    row = samples_a_row(program)
    known = [tuned.limits.get(r.name, NEVER) for r in program.residuals] if tuned.source else []
    rows = [[real(x) for x in limit] for limit in known]
    names = [f'"{r.name}",' for r in program.residuals]
    return {
        "residual_names": listing.table_lines(names, target, 4),
        "decides": not program.bounds,
        "row": row,
        "least": max(3, row // 10),
        "hold": HOLD,
        "settled": SETTLED,
        "window": max(SETTLED * row, ceil(tuned.window * program.rate)),
        "eighth": digits(EIGHTH),
        "first_size": digits(FIRST),
        "no_size": NO_SIZE,
        "overshoot": digits(OVERSHOOT),
        "share": digits(SHARE),
        "tuned": listing.harmless(tuned.source, target),
        "limits": limit_lines(rows, target),
    }


def limit_lines(rows: Iterable[Sequence[str]], target: Target) -> list[str]:
    """The lines of a table that has a row for each residual."""
    braces = "{}" if target.folder == "c" else "()"
    return [line for own in rows for line in _row(own, braces, target)]


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
