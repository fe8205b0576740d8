"""A robot that is simulated in a process of its own, and heard through a pipe like a real one."""

from __future__ import annotations

import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from threading import Event
from typing import IO, Any

from bondgraph.runtime.log_numbers import Form
from bondgraph.runtime.monitoring.sources.lines import Decoder
from bondgraph.runtime.monitoring.sources.sample_source import Chunk, News
from bondgraph.runtime.monitoring.sources.stdin import Pipe

_AHEAD = 1 << 16  # bytes of samples that it may be ahead of who reads them
_END = 5.0  # s to end in


class Simulated:
    """The samples that a command prints; the command ends with the source.

    Raises OSError where it cannot be started.
    """

    replays = False

    def __init__(self, words: Sequence[str], name: str) -> None:
        self.name = name
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
        self._pipe = Pipe(Form(name), self._out.fileno(), name, _AHEAD)
        self.decoder: Decoder | None = self._pipe.decoder
        self._closed = False

    @property
    def number(self) -> int:
        """The number of its process."""
        return self._process.pid

    def chunks(self, stop: Event) -> Iterator[Chunk]:
        """See `Source`; at the end, why it ended."""
        yield from self._pipe.chunks(stop)
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

    def go(self, position: dict[str, Any]) -> str:
        """See `Source`."""
        return self._pipe.go(position)

    def rate(self) -> float | None:
        """See `Source`."""
        return None

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
        self._pipe.close()
        self._pipe.join(_END)
        self._out.close()
        self._said.close()
