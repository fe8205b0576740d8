"""What every source of samples gives: chunks of a log, and news of the line they come by."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Iterator
from threading import Condition, Event
from typing import Any

import numpy as np

from bondgraph.runtime.log import Array, Log, LogError
from bondgraph.runtime.monitoring.sources.lines import Decoder
from bondgraph.text.limits import LINE_BYTES
from bondgraph.text.tuples import NamedTuple

#: How long a source that has nothing waits before it says so, in s.
IDLE = 0.2

_ROUND = (1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)  # times a power of ten
_CRYSTAL = 1e-4  # of a rate: no clock is nearer to the number on its label
_SURE, _DIGITS = 1e-6, 9  # of a rate: nothing is told more exactly, nor with more digits
_GAP = 3.5  # steps: what is longer is no few samples lost
_LATE = 0.7  # steps that a sample may be late by before one before it counts as lost
_TWICE = 0.1  # of all samples: if no more come twice, they are no samples of their own
_FIRST = 1000  # samples whose rate is taken
_FEW, _PAUSE = 20, 0.1  # blocks that wait so many s for more


class News(NamedTuple):
    """Something to tell about the line itself: `event` as in a verdict, and a sentence."""

    event: str
    message: str


class Chunk(NamedTuple):
    """Samples that came together; none where there is only news, or nothing at all.

    `place` says where they end, for sources that can go back (`Source.go`). `done` is called once
    the samples and what follows from them are safe. `again` says that they were computed before,
    and come only to warm up the filters.
    """

    log: Log | None = None
    news: tuple[News, ...] = ()
    place: dict[str, Any] | None = None
    done: Callable[[], None] | None = None
    again: bool = False


class Source(ABC):
    """Where samples come from.

    `name` is told to people and kept in the journal. `replays` says that it can go back, so that
    nothing is missed while nobody watches. One that is `live` gives samples as they are taken, so
    that one that gives none is silent; then it gives empty chunks.
    """

    name: str
    replays: bool = False
    live: bool = False
    decoder: Decoder | None = None

    @abstractmethod
    def chunks(self, stop: Event) -> Iterator[Chunk]:
        """All there is, until the end or until `stop` is set; an empty chunk if nothing comes.

        Raises LogError where no samples can be read at all.
        """

    @abstractmethod
    def go(self, position: dict[str, Any]) -> str:
        """Go on where a watch ended: at its `place`, with samples from `back` to warm up.

        `position` has also the `time` of the newest sample, in s. "", or why that cannot be; then
        the source begins as if it were new.
        """

    def rate(self) -> float | None:
        """Samples a second, where that can be known before the first one is taken."""
        return None

    def samples(self) -> float | None:
        """About how many samples there will be, where that can be known before the first one."""
        return None

    def whole(self) -> Iterator[Log]:
        """All samples, to look at them before they come; none where that cannot be."""
        return iter(())

    def time(self) -> str:
        """What is taken for the time, where that is known before the first sample; else ""."""
        return ""

    @property
    def dropped(self) -> int:
        """Lines that nobody read in time, and that were dropped."""
        return 0

    def close(self) -> None:  # noqa: B027 (there may be nothing to let go of)
        """Let go of the line."""


def rate_of(time: Array) -> float | None:
    """Samples a second, of the first ones, at times in s, as exactly as these tell it.

    A round number that is as near as the digits and the jitter of the times leave open, or a
    crystal, is the rate; else that of the fewest digits, of it or of the step, that is as near as
    the times tell.

    >>> rate_of(np.array([0.0, 0.0101, 0.0199, 0.0301, 0.5]))
    100.0
    >>> rate_of(np.round(np.arange(1000) / 610.35, 7))
    610.35
    >>> 1.0 / rate_of(60.0 * np.arange(20000))
    60.0
    >>> rate_of(np.sort(np.append(np.arange(1000.0), [12.02, 371.05, 802.03])))
    1.0
    """
    steps = np.diff(time[:_FIRST])
    steps = steps[steps > 0.0]
    if len(steps) < 2:
        return None
    step, open_ = _step(steps)
    rate = 1.0 / step
    power = 10.0 ** math.floor(math.log10(rate))
    near = min((m * power for m in _ROUND), key=lambda r: abs(r / rate - 1.0))
    if abs(near / rate - 1.0) <= max(open_, _CRYSTAL):
        return near
    told = (own for digits in range(1, _DIGITS)
            for own in (float(f"{rate:.{digits}g}"), 1 / float(f"{step:.{digits}g}")))  # fmt: skip
    return next((r for r in told if abs(r / rate - 1.0) <= max(open_, _SURE)), rate)


def _step(steps: Array) -> tuple[float, float]:
    """The time between two samples, and which share of it the steps leave open.

    Lost samples are counted, gaps left out, and samples that came twice are none: those soon after
    another, as long as they are few. Where many do, they come in pieces. The ends of all steps
    together are as uncertain as the times differ from a uniform grid between them: for steps that
    are uncertain each by itself three times the largest difference holds in 99 of 100 logs (a
    random walk and its bridge).
    """
    step = float(np.median(steps))
    for _ in range(3):  # a clock of few digits has steps of two sizes, and their mean is the step
        kept = steps[steps < _GAP * step]
        twice = kept < (1.0 - _LATE) * step
        counts = np.maximum(np.floor(kept / step + (1.0 - _LATE)), 1.0)
        counts = np.where(twice & (twice.mean() < _TWICE), 0.0, counts)
        step = float(kept.sum() / counts.sum())
    off = np.cumsum(kept - counts * step)
    return step, 3.0 * float(np.max(np.abs(off))) / (step * float(counts.sum()))


class Block(NamedTuple):
    """Whole lines as they came in. `whole` is false after a line was joined in the middle,
    `again` true for what may have come before; `done` as for a chunk."""

    lines: bytes
    whole: bool = True
    again: bool = False
    done: Callable[[], None] | None = None


class Intake:
    """Blocks between the thread that receives and the one that computes, at most so many bytes.

    What is too much waits (`waits`: the sender can be held up), or else the oldest is dropped, and
    `dropped` counts its lines.
    """

    def __init__(self, most: int = 1 << 22, waits: bool = False) -> None:
        self._most, self._waits = most, waits
        self._items: deque[Block | News] = deque()
        self._size = self.dropped = 0
        self._ended = False
        self._failed: LogError | None = None
        self._changed = Condition()

    def put(self, block: Block) -> None:
        """Add what has come."""
        with self._changed:
            while self._waits and self._size >= self._most and not self._ended:
                self._changed.wait()
            self._items.append(block)
            self._size += len(block.lines)
            while not self._waits and self._size > max(self._most, len(block.lines)):
                self._drop()
            self._changed.notify_all()

    def say(self, event: str, message: str) -> None:
        """Add news, in their place between the samples."""
        with self._changed:
            self._items.append(News(event, message))
            self._changed.notify_all()

    def fail(self, error: LogError) -> None:
        """Say that nothing can come, and why; whoever takes gets the error."""
        with self._changed:
            self._failed = error
            self._changed.notify_all()

    def end(self) -> None:
        """Say that nothing more comes, or that nobody takes it any more."""
        with self._changed:
            self._ended = True
            self._changed.notify_all()

    def take(self, patience: float = IDLE) -> list[Block | News] | None:
        """All that has come, perhaps nothing after `patience` s; None at the end."""
        with self._changed:
            if not self._items and not self._ended and self._failed is None:
                self._changed.wait(patience)
            if self._failed is not None:
                raise self._failed
            if not self._items:
                return None if self._ended else []
            items = list(self._items)
            self._items.clear()
            self._size = 0
            self._changed.notify_all()
            return items

    def _drop(self) -> None:
        """Forget the oldest block; news stay."""
        k = next(k for k, item in enumerate(self._items) if isinstance(item, Block))
        item = self._items[k]
        assert isinstance(item, Block)
        self.dropped += item.lines.count(b"\n")
        self._size -= len(item.lines)
        del self._items[k]


def decoded(
    intake: Intake, decoder: Decoder, stop: Event, last: float = float("-inf")
) -> Iterator[Chunk]:
    """The chunks of what a thread puts into an intake, until its end or until `stop` is set.

    `last` is the time in s of the newest sample that is known: of a block that may have come
    before, only what is newer counts.
    """
    while not stop.is_set() and (items := intake.take()) is not None:
        if not items:
            yield Chunk()
        elif len(items) < _FEW:  # more of them together cost less
            stop.wait(_PAUSE)
            items += intake.take(0.0) or []
        for item in _together(items):
            if isinstance(item, News):
                yield Chunk(news=(item,))
                continue
            logs = decoder.feed(item.lines, item.whole)
            if not logs:
                yield Chunk()  # lines that are no samples are to be told
            for log in logs:
                new = log.part(int(np.argmax(log.time > last))) if item.again else log
                if not item.again or log.time.max() > last:
                    last = float(log.time[-1])
                    yield Chunk(new)
            if item.done is not None:
                yield Chunk(done=item.done)


def _together(items: list[Block | News]) -> Iterator[Block | News]:
    """Blocks that can be read as one, joined: fewer steps where many small ones have come."""
    waiting: list[Block] = []
    for item in items:
        plain = isinstance(item, Block) and item.whole and not item.again
        if waiting and not plain:
            yield _joined(waiting)
            waiting = []
        if isinstance(item, Block) and plain:
            waiting.append(item)
        else:
            yield item
    if waiting:
        yield _joined(waiting)


def _joined(blocks: list[Block]) -> Block:
    if len(blocks) == 1:
        return blocks[0]

    def done() -> None:
        for block in blocks:
            if block.done is not None:
                block.done()

    return Block(b"".join([b.lines for b in blocks]), done=done)


class Cutter:
    """Cuts what comes in pieces of any size into whole lines."""

    def __init__(self, whole: bool = True) -> None:
        self._rest = b""
        self._whole = whole

    def cut(self, piece: bytes) -> Block | None:
        """The lines that are complete with this piece, if there are any."""
        text = self._rest + piece
        lines, feed, self._rest = text.rpartition(b"\n")
        whole = self._whole
        if len(self._rest) > LINE_BYTES:  # no line is that long: noise
            self._rest, self._whole = b"", False
        elif feed:
            self._whole = True
        return Block(lines + feed, whole) if feed else None

    @property
    def rest(self) -> bytes:
        """The beginning of a line that is not complete."""
        return self._rest
