"""`diagnose` in whole numbers: what it is to decide, in Python's integers, and its C."""

from __future__ import annotations

import ctypes
from bisect import bisect_right
from collections.abc import Sequence
from functools import cache
from math import isqrt
from pathlib import Path
from typing import Any

from bondgraph.backends.decision import FaultClass
from bondgraph.ir.fixed_program import WholeLimit
from tests.unit.backends.compilers import WARNINGS, compiler, run
from tests.unit.backends.whole_numbers import WORD

BLIND, HEALTHY, ALARM = range(3)
RULED_OUT, SMALL, LIKELY = range(3)
_WIDE = 2**63
_ONE = 2**18  # of a sum
#: 2**(28 + n/8), to the nearest whole number: the fourth root of the root of 2**(8*28 + n).
_EIGHTHS = [(isqrt(isqrt(isqrt(2 ** (8 * 29 + n)))) + 1) // 2 for n in range(8)]


@cache
def _steps(sure: int) -> list[int]:
    """Eighths of an octave from a sixteenth of `sure` on, times 2**32."""
    return [_wide(sure * _EIGHTHS[n % 8]) << (n // 8) for n in range(255)]


def _wide(value: int) -> int:
    assert -_WIDE <= value < _WIDE, "does not fit in 64 bits"
    return value


class Decision:
    """What `diagnose` says of residuals, as docs/firmware.md and `WholeLimit` say; asserts fits."""

    def __init__(
        self, limits: Sequence[WholeLimit], classes: Sequence[FaultClass], row: int, window: int,
        latch: bool = False,
    ) -> None:  # fmt: skip
        self.limits, self.classes, self.latch = limits, classes, latch
        self.row, self.window = row, window
        self.least, self.hold = max(3, row // 10), 10 * row
        self.state = [BLIND] * len(limits)
        self.tick = 0
        self.clear()

    def clear(self) -> None:
        """End an alarm."""
        self.state = [HEALTHY if s == ALARM else s for s in self.state]
        self.since, self.peak, self.streak = ([0] * len(self.limits) for _ in range(3))
        self.sums = [[0, 0, 0] for _ in self.limits]
        self.candidate = [RULED_OUT] * len(self.classes)
        self.one = -1
        self.quiet = self.settled = 0

    def update(self, values: Sequence[int | None]) -> bool:
        """Take one sample of each residual; None is one that is not valid."""
        self.tick, row = (0, True) if self.tick + 1 >= self.row else (self.tick + 1, False)
        self.quiet, self.settled = self.quiet + 1, self.settled + 1
        fresh = False
        for k, value in enumerate(values):
            if value is not None:
                fresh |= self._watch(k, value, row)
                continue
            self.sums[k], self.streak[k] = [0, 0, 0], 0
            if self.state[k] == ALARM:
                self.quiet = 0
            else:
                self.state[k] = BLIND
        alarm = ALARM in self.state
        if fresh:
            self.quiet = self.settled = 0
        if alarm and not self.latch and self.quiet >= self.hold:
            self.clear()
            return False
        if fresh or (alarm and row):
            self._judge()
        return alarm

    def _watch(self, k: int, value: int, row: bool) -> bool:
        limit = self.limits[k]
        off = value - limit.mean
        out = abs(off) - limit.bound
        high = row and self._add_row(k, off, out)
        if self.state[k] == ALARM:
            self.since[k] += 1
            self._remember(k, out)
            if 2 * out >= limit.level or any(self.sums[k]):
                self.quiet = 0
            return False
        self.streak[k] = self.streak[k] + 1 if out > limit.level else 0
        self.state[k] = ALARM if high or self.streak[k] >= self.least else HEALTHY
        if self.state[k] == ALARM:
            self.since[k] = self.peak[k] = 0
            self._remember(k, out)
        return self.state[k] == ALARM

    def _add_row(self, k: int, off: int, out: int) -> bool:
        own = self.limits[k]
        top = min(own.height + round(1.166 * _ONE), WORD - 1)
        root = min(_wide(max(out, 0) * own.loud) >> own.loud_shift, WORD - 1)
        loud = min((_wide(root * root) >> 30) - own.drift, top * round(2**32 / 3) >> 32)
        more = [(_wide(x * own.unit) >> own.unit_shift) - _ONE // 2
                for x in (off - own.bound, -off - own.bound)]  # fmt: skip
        heights = own.height, own.height, top
        self.sums[k] = [
            min(max(_wide(total + x), 0), 2 * height, WORD - 1)
            for total, x, height in zip(self.sums[k], [*more, loud], heights, strict=True)
        ]
        return any(total > height for total, height in zip(self.sums[k], heights, strict=True))

    def _remember(self, k: int, out: int) -> None:
        """The largest peak: how many eighths of an octave it is above a sixteenth of `sure`."""
        own = self.limits[k]
        sure = own.level + 2 * own.bound
        if sure > 0:
            steps = _steps(sure)
            self.peak[k] = max(self.peak[k], bisect_right(steps, (out - own.level) << 32))

    def _judge(self) -> None:
        alarms = [k for k, s in enumerate(self.state) if s == ALARM]
        self.candidate = [self._left(c, alarms) for c in self.classes]
        likely = [k for k, left in enumerate(self.candidate) if left == LIKELY]
        named = len(likely) == 1 and self.settled >= 2 * self.row
        self.one = likely[0] if named else -1

    def _left(self, c: FaultClass, alarms: Sequence[int]) -> int:
        if not set(alarms) <= set(c.seen_by):
            return RULED_OUT
        least, sure = (dict(zip(c.seen_by, own, strict=True)) for own in (c.least, c.sure))
        size = max((least[k] + self.peak[k] for k in alarms if self.peak[k]), default=0)
        quiet = [sure[k] for k in c.seen_by if self.state[k] == HEALTHY]
        heard = self.settled >= self.window and any(s != 255 and s <= size for s in quiet)
        return SMALL if heard else LIKELY

    def words(self, alarm: bool) -> list[int]:
        """All that can be read of it."""
        sums = [x for own in zip(*self.sums, strict=True) for x in own]
        return [alarm, self.one, *self.state, *self.since, *self.candidate, *sums, *self.peak]


class DiagnoseInC:
    """`diagnose` of the generated C, sanitized."""

    def __init__(self, folder: Path, stem: str, residuals: int, classes: int) -> None:
        library = folder / "diagnose.so"
        options = ("-O1", *WARNINGS, "-fsanitize=undefined", "-fno-sanitize-recover=all")
        files = ("-shared", "-fPIC", "-o", library, f"{stem}.c")
        run(*compiler("gcc"), *options, "-static-libubsan", *files, cwd=folder)
        self.library, self.stem = ctypes.CDLL(str(library)), stem
        many = residuals

        def struct(name: str, fields: list[tuple[str, Any]]) -> Any:
            return type(name, (ctypes.Structure,), {"_fields_": fields})

        u8, i32, u32 = ctypes.c_uint8, ctypes.c_int32, ctypes.c_uint32
        self.Limit = struct("Limit", [
            ("mean", i32), ("level", u32), ("bound", u32), ("unit", i32), ("loud", i32),
            ("drift", i32), ("height", i32), ("unit_shift", u8), ("loud_shift", u8)])  # fmt: skip
        self.Residuals = struct("Residuals", [
            ("value", i32 * many), ("valid", ctypes.c_bool * many)])  # fmt: skip
        self.Diagnosis = struct("Diagnosis", [
            *((n, u32) for n in ("row", "least", "hold", "window")), ("latch", ctypes.c_bool),
            ("state", u8 * many), ("since", u32 * many), ("candidate", u8 * max(classes, 1)),
            ("fault_class", ctypes.c_int16), ("calm", ctypes.c_bool),
            *((n, i32 * many) for n in ("above", "below", "louder")), ("peak", u8 * many),
            ("streak", u32 * many), *((n, u32) for n in ("quiet", "settled", "tick"))
        ])  # fmt: skip
        self.found = self.Diagnosis()
        self.reset()
        self.diagnose = getattr(self.library, f"{stem}_diagnose")
        self.diagnose.restype = ctypes.c_bool

    def reset(self) -> None:
        """Forget everything, whatever was there before."""
        ctypes.memset(ctypes.byref(self.found), 0xAA, ctypes.sizeof(self.found))
        getattr(self.library, f"{self.stem}_diagnosis_reset")(ctypes.byref(self.found))

    def limits(self, limits: Sequence[WholeLimit]) -> Any:
        """Limits of one's own."""
        return (self.Limit * len(limits))(*(self.Limit(*own) for own in limits))

    def tuned(self) -> Any:
        """The limits that are in the code."""
        return (self.Limit * len(self.found.state)).in_dll(self.library, f"{self.stem}_limits")

    def update(self, limits: Any, values: Sequence[int | None]) -> list[int]:
        """All that can be read after one sample."""
        given = self.Residuals()
        for k, value in enumerate(values):
            given.value[k], given.valid[k] = value or 0, value is not None
        d = self.found
        alarm = self.diagnose(ctypes.byref(d), limits, ctypes.byref(given))
        lists = d.state, d.since, d.candidate, d.above, d.below, d.louder, d.peak
        return [alarm, d.fault_class, *(x for own in lists for x in own)]
