"""A robot that is simulated in a process of its own, and heard through a pipe like a real one."""

from __future__ import annotations

import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from threading import Event
from typing import IO

from bondgraph.runtime.log_numbers import Form
from bondgraph.runtime.monitoring.sources.sample_source import Chunk, News
from bondgraph.runtime.monitoring.sources.streams import Pipe

_AHEAD = 1 << 16  # bytes of samples that it may be ahead of who reads them
_END = 5.0  # s to end in


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
