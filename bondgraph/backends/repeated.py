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
    tape = _Tape(ops)
    at = single = 0

    def alone(end: int) -> None:
        if single < end:
            runs.append(Run(len(lines), end - single, 1, 0))
            lines.extend(ops[single:end])

    while at < len(ops):
        count, times, grow = tape.again(at)
        if count * (times - 1) < 8:  # a run is a line too
            at += 1
            continue
        alone(at)
        runs.append(Run(len(lines), count, times, grow))
        lines.extend(ops[at : at + count])
        at = single = at + count * times
    alone(len(ops))
    return lines, runs


class _Tape:
    """The lines of a recipe: which are alike but for their lengths, and where the next such is."""

    def __init__(self, ops: Sequence[TapeOp]) -> None:
        forms: dict[tuple[int, int, int, int, bool], int] = {}
        self.lengths = [op.length for op in ops]
        self.forms = [
            forms.setdefault((op.target, op.source, op.shift, op.scale, op.fresh), len(forms))
            for op in ops
        ]
        self.next = [len(ops)] * len(ops)  # the place of the next line of the same form
        behind: dict[int, int] = {}
        for at in range(len(ops) - 1, -1, -1):
            self.next[at] = behind.get(self.forms[at], len(ops))
            behind[self.forms[at]] = at

    def again(self, at: int) -> tuple[int, int, int]:
        """Of what stands at a place, the count of lines that are repeated most, how often, how."""
        forms, lengths, size = self.forms, self.lengths, len(self.forms)
        best, second = (1, 1, 0), self.next[at]
        while second <= at + min(_LONGEST, (size - at) // 2) and second < size:
            count, grow = second - at, lengths[second] - lengths[at]
            if grow >= 0:
                end = second + 1
                while (
                    end < size
                    and forms[end] == forms[end - count]
                    and lengths[end] == lengths[end - count] + grow
                ):
                    end += 1
                times = (end - at) // count
                if count * (times - 1) > best[0] * (best[1] - 1):
                    best = count, times, grow
                if times > 1 and end == size:
                    break
            second = self.next[second]
        return best
