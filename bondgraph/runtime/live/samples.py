"""The samples of a monitored machine at the pace of time, and those of one that is simulated."""

from __future__ import annotations

import subprocess
import tempfile
import time as clocks
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from threading import Event
from typing import IO, Any

import numpy as np

from bondgraph.runtime.log_numbers import Form
from bondgraph.runtime.monitoring.sources.sample_source import Chunk, News, Source
from bondgraph.runtime.monitoring.sources.streams import Pipe

_LATE = 0.25  # s on the wall; who is later than that does not catch up, time stretches
_LOOK = 0.05  # s between two looks at the wishes of people
_OVER = 2.0  # s on the wall over which the pace is measured
_AHEAD = 1 << 16  # bytes of samples that it may be ahead of who reads them
_END = 5.0  # s to end in


class Paced(Source):
    """A source whose samples come `portion` s at a time, at the latest when `between` was called.

    With a `speed` (s of samples a second on the wall) samples wait until it is their time, and
    while `paused`; without one they come as they come.
    """

    def __init__(
        self, inner: Source, portion: float, speed: float | None, between: Callable[[], None]
    ) -> None:
        self._inner = inner
        self.name, self.replays = inner.name, inner.replays
        self.decoder, self.live = inner.decoder, inner.live
        self._portion, self._speed, self._between = portion, speed, between
        self.paused = False
        self._anchor: tuple[float, float] | None = None  # on the wall, of the samples
        self._marks: deque[tuple[float, float]] = deque(maxlen=400)

    def chunks(self, stop: Event) -> Iterator[Chunk]:
        """See `Source`."""
        for chunk in self._inner.chunks(stop):
            self._between()
            if chunk.log is None or not chunk.log.rows:
                yield chunk
                continue
            time = chunk.log.time
            cuts = self._cuts(time)
            for a, b in pairwise(cuts):
                self._wait(float(time[b - 1]), stop)
                if stop.is_set():
                    return
                last = b == len(time)
                yield Chunk(
                    chunk.log.part(a, b),
                    chunk.news if a == 0 else (),
                    chunk.place if last else None,
                    chunk.done if last else None,
                    chunk.again,
                )

    def _cuts(self, time: Any) -> list[int]:
        cells = np.floor(time / self._portion)
        return [0, *(np.flatnonzero(np.diff(cells)) + 1).tolist(), len(time)]

    def _wait(self, t: float, stop: Event) -> None:
        """Until it is time for what has the time stamp t."""
        while True:
            self._between()
            now = clocks.monotonic()
            if self._speed is None or stop.is_set():
                break
            if self.paused:
                self._anchor = None
                self._marks.clear()
                stop.wait(_LOOK)
                continue
            if self._anchor is None or t < self._anchor[1]:
                self._anchor = now, t
            due = self._anchor[0] + (t - self._anchor[1]) / self._speed
            if due <= now:
                if now - due > _LATE:
                    self._anchor = now, t
                break
            stop.wait(min(_LOOK, due - now))
        if self._marks and t < self._marks[-1][1]:
            self._marks.clear()
        self._marks.append((now, t))

    @property
    def pace(self) -> float | None:
        """Seconds of samples a second on the wall, lately; None while nobody knows."""
        end = self._marks[-1] if self._marks else (0.0, 0.0)
        while len(self._marks) > 1 and end[0] - self._marks[0][0] > _OVER:
            self._marks.popleft()
        start = self._marks[0] if self._marks else end
        wall = end[0] - start[0]
        return (end[1] - start[1]) / wall if wall > _OVER / 4 else None

    @property
    def dropped(self) -> int:
        """See `Source`."""
        return self._inner.dropped

    def go(self, position: dict[str, Any]) -> str:
        """See `Source`."""
        return self._inner.go(position)

    def rate(self) -> float | None:
        """See `Source`."""
        return self._inner.rate()

    def time(self) -> str:
        """See `Source`."""
        return self._inner.time()

    def close(self) -> None:
        """See `Source`."""
        self._inner.close()


class Simulated(Pipe):
    """The samples that a command prints; the command ends with the source.

    Raises OSError where it cannot be started.
    """

    def __init__(self, words: Sequence[str], name: str) -> None:
        self._said: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 (closed with the source)
        self._process = subprocess.Popen(
            list(words),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=self._said,
            start_new_session=True,  # ^C is for us, who then end it
        )
        assert self._process.stdout is not None
        self._out = self._process.stdout
        super().__init__(Form(name), self._out.fileno(), name, _AHEAD)
        self._closed = False

    @property
    def number(self) -> int:
        """The number of its process."""
        return self._process.pid

    def chunks(self, stop: Event) -> Iterator[Chunk]:
        """See `Source`; at the end, why it ended."""
        yield from super().chunks(stop)
        if not stop.is_set():
            yield Chunk(news=(News("gap", f"the {self.name} has ended: {self._why()}"),))

    def _why(self) -> str:
        try:
            code = self._process.wait(_END)
        except subprocess.TimeoutExpired:
            return "its pipe is closed"
        self._said.seek(0)
        lines = self._said.read().decode(errors="replace").strip().splitlines()
        how = f"status {code}" if code >= 0 else f"signal {-code}"
        return f"{lines[-1]} ({how})" if lines else how

    def close(self) -> None:
        """End the process."""
        if self._closed:
            return
        self._closed = True
        self._process.terminate()
        try:
            self._process.wait(_END)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        super().close()
        self.join(_END)
        self._out.close()
        self._said.close()
