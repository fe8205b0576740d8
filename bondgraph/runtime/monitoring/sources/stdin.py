"""Samples from standard input, or from any pipe."""

from __future__ import annotations

import os
from collections.abc import Iterator
from threading import Event, Thread
from typing import Any

from bondgraph.runtime.log_numbers import Form
from bondgraph.runtime.monitoring.sources.lines import Decoder
from bondgraph.runtime.monitoring.sources.sample_source import Chunk, Cutter, Intake, decoded


class Pipe:
    """Lines from a descriptor; who writes too fast is held up by the pipe, nothing is dropped.

    At most so many bytes wait here.
    """

    replays = False

    def __init__(
        self,
        form: Form,
        descriptor: int = 0,
        name: str = "standard input",
        most: int = 1 << 22,
    ) -> None:
        self.name = name
        self.decoder: Decoder | None = Decoder(form)
        self._lines = self.decoder
        self._descriptor = descriptor
        self._intake = Intake(most, waits=True)
        self._reader: Thread | None = None

    def chunks(self, stop: Event) -> Iterator[Chunk]:
        """All lines, until the writer closes the pipe."""
        # Reading blocks, and nothing wakes it up: the thread is left behind at the end.
        self._reader = Thread(target=self._read, daemon=True)
        self._reader.start()
        yield from decoded(self._intake, self._lines, stop)

    def go(self, position: dict[str, Any]) -> str:
        """A pipe cannot go back."""
        return "what came through a pipe is gone"

    def rate(self) -> float | None:
        """Not known before samples come."""
        return None

    def close(self) -> None:
        """Let the thread end."""
        self._intake.end()

    def join(self, patience: float) -> None:
        """Wait until the thread has read the end, at most so many seconds."""
        if self._reader is not None:
            self._reader.join(patience)

    def _read(self) -> None:
        cutter = Cutter()
        try:
            while piece := os.read(self._descriptor, 1 << 16):
                block = cutter.cut(piece)
                if block is not None:
                    self._intake.put(block)
        except OSError as error:
            self._intake.say("gap", f"{self.name}: {error.strerror}")
        last = cutter.cut(b"\n") if cutter.rest else None
        if last is not None:
            self._intake.put(last)
        self._intake.end()
