"""A monitor in a process of its own, to be fed, killed and started again."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from threading import Thread
from typing import Any

from bondgraph.runtime.log import Log

ROOT = Path(__file__).resolve().parents[4]
MOTOR = str(ROOT / "models" / "dc_motor.bg")

#: How long a test waits for what must come, in s; nothing takes that long.
PATIENCE = 30.0


def until(met: Callable[[], object], what: str = "") -> None:
    """Wait until something is so."""
    end = time.monotonic() + PATIENCE
    while not met():
        assert time.monotonic() < end, f"waited in vain for {what or met}"
        time.sleep(0.01)


class Nursery:
    """What starts monitors; see `nursery`."""

    def __init__(self) -> None:
        self._asking, theirs = socket.socketpair()
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"}
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.unit.runtime.monitoring.nursery", str(theirs.fileno())],
            pass_fds=[theirs.fileno()],
            cwd=ROOT,
            env=environment,
        )
        theirs.close()

    def start(
        self, words: list[str], descriptors: list[int], environment: dict[str, str]
    ) -> int:
        """Start a monitor with these descriptors, and more in its environment; its process."""
        asked = {"words": words, "environment": environment}
        socket.send_fds(self._asking, [json.dumps(asked).encode()], descriptors)
        return int(self._asking.recv(64))

    def close(self) -> None:
        """End it."""
        self._asking.close()
        self._process.wait(PATIENCE)


class Watch:
    """`bondgraph monitor dc_motor.bg ... --json`, and all that it says, as it says it."""

    def __init__(
        self, nursery: Nursery, *words: str, environment: dict[str, str] | None = None
    ) -> None:
        pipes = [os.pipe() for _ in range(4)]
        theirs = [pipes[0][0], *(writing for _, writing in pipes[1:])]
        words = ("monitor", MOTOR, "--json", *words)
        self.process = nursery.start(list(words), theirs, environment or {})
        for descriptor in theirs:
            os.close(descriptor)
        self._input = os.fdopen(pipes[0][1], "wb", buffering=0)
        self._output, self._error, self._status = (os.fdopen(p[0], "rb") for p in pipes[1:])
        self.said: list[dict[str, Any]] = []
        self.errors = ""
        self.torn: list[str] = []  # lines that are not whole
        self._threads = [Thread(target=self._read), Thread(target=self._listen)]
        for thread in self._threads:
            thread.start()

    def _read(self) -> None:
        for line in self._output:
            try:
                if not line.endswith(b"\n"):
                    raise ValueError
                self.said.append(json.loads(line))
            except ValueError:
                self.torn.append(f"not a whole line: {line!r}")

    def _listen(self) -> None:
        self.errors = self._error.read().decode()

    def events(self) -> list[str]:
        """The kinds of verdicts so far."""
        return [verdict["event"] for verdict in self.said]

    def heard(self, event: str, word: str = "") -> dict[str, Any]:
        """The first verdict of a kind with a word in its message, once it has come."""

        def found() -> list[dict[str, Any]]:
            return [v for v in self.said if v["event"] == event and word in v["message"]]

        until(lambda: found() or not self._threads[0].is_alive(), f"{event} {word}")
        assert found(), f"no {event} {word} in {self.said}\n{self.errors}"
        return found()[0]

    def feed(self, data: bytes) -> None:
        """Write to its standard input."""
        while data:
            data = data[self._input.write(data) or 0 :]

    def tell(self, number: int) -> None:
        """Send it a signal."""
        os.kill(self.process, number)

    def ended(self, number: int = 0) -> int | None:
        """Its exit status after a signal, if any, or the end of its input; None: it was killed.

        All that it said is here then.
        """
        if number:
            self.tell(number)
        else:
            self._input.close()
        for thread in self._threads:
            thread.join(PATIENCE)
            assert not thread.is_alive(), "the monitor does not end"
        status = b"" if self._status.closed else self._status.read()
        for stream in (self._input, self._output, self._error, self._status):
            stream.close()
        return int(status) if status else None

    def kill(self) -> None:
        """End it without a chance to say anything, if it has not ended."""
        if not self._status.closed:
            with suppress(ProcessLookupError):
                self.tell(signal.SIGKILL)
            self.ended()


def csv(log: Log, start: int = 0, stop: int | None = None, header: bool = False) -> bytes:
    """Some rows of a log as lines, with or without the header."""
    names = list(log.columns)
    part = log.part(start, stop)
    columns = [part.time, *part.columns.values()]
    rows = [",".join(map(repr, row)) for row in zip(*[c.tolist() for c in columns], strict=True)]
    head = [",".join(["t", *names])] if header else []
    return "".join(f"{line}\n" for line in head + rows).encode()


def objects(log: Log, start: int, stop: int) -> list[dict[str, float]]:
    """Some rows of a log as JSON objects."""
    part = log.part(start, stop)
    return [
        {"t": float(part.time[k]), **{n: float(c[k]) for n, c in part.columns.items()}}
        for k in range(part.rows)
    ]
