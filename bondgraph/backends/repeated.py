"""What a long recipe repeats is written once: equal cells of an array become a loop."""

from __future__ import annotations

from collections.abc import Sequence

from bondgraph.ir.program import TapeOp
from bondgraph.text.tuples import NamedTuple

_LONGEST = 600  # lines that are looked for again behind themselves


class Run(NamedTuple):
    """`many` lines from `first` on, so many `times`; each time all lengths `grow` by a number."""

    first: int
    many: int
    times: int
    grow: int


def repeated(ops: Sequence[TapeOp]) -> tuple[list[TapeOp], list[Run]]:
    """The lines of a recipe that differ, and in which order they are run.

    >>> op = TapeOp(1, 0, 0, 0, 5, True)
    >>> lines, runs = repeated([op, *[op._replace(source=2, length=k) for k in range(0, 40, 2)]])
    >>> len(lines), [tuple(run) for run in runs]
    (2, [(0, 1, 1, 0), (1, 1, 20, 2)])
    """
    lines: list[TapeOp] = []
    runs: list[Run] = []
    at = single = 0

    def alone(end: int) -> None:
        if single < end:
            runs.append(Run(len(lines), end - single, 1, 0))
            lines.extend(ops[single:end])

    while at < len(ops):
        count, times, grow = _again(ops, at)
        if count * (times - 1) < 8:  # a run is a line too
            at += 1
            continue
        alone(at)
        runs.append(Run(len(lines), count, times, grow))
        lines.extend(ops[at : at + count])
        at = single = at + count * times
    alone(len(ops))
    return lines, runs


def _again(ops: Sequence[TapeOp], at: int) -> tuple[int, int, int]:
    """Of what stands at a place, the count of lines that are repeated most, how often and how."""
    best = (1, 1, 0)
    for count in range(1, min(_LONGEST, (len(ops) - at) // 2) + 1):
        first, second = ops[at], ops[at + count]
        grow = second.length - first.length
        if grow < 0 or not _follows(first, second, grow):
            continue
        end = at + count
        while end < len(ops) and _follows(ops[end - count], ops[end], grow):
            end += 1
        times = (end - at) // count
        if count * (times - 1) > best[0] * (best[1] - 1):
            best = count, times, grow
        if times > 1 and end == len(ops):
            break
    return best


def _follows(one: TapeOp, other: TapeOp, grow: int) -> bool:
    return one._replace(length=one.length + grow) == other
