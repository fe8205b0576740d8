"""A monitor in a process of its own, to be fed, killed and started again."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
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
        time.sleep(0.005)


class Watch:
    """`bondgraph monitor dc_motor.bg ... --json`, and all that it says, as it says it."""

    def __init__(self, *words: str, **more: Any) -> None:
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONUNBUFFERED": "1"}
        self.process = subprocess.Popen(
            [sys.executable, "-m", "bondgraph", "monitor", MOTOR, "--json", *words],
            stdin=more.pop("stdin", subprocess.PIPE),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment,
            **more,
        )
        self.said: list[dict[str, Any]] = []
        self.errors = ""
        self._threads = [Thread(target=self._read), Thread(target=self._listen)]
        for thread in self._threads:
            thread.start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.said.append(json.loads(line))

    def _listen(self) -> None:
        assert self.process.stderr is not None
        self.errors = self.process.stderr.read().decode()

    def events(self) -> list[str]:
        """The kinds of verdicts so far."""
        return [verdict["event"] for verdict in self.said]

    def heard(self, event: str, word: str = "") -> dict[str, Any]:
        """The first verdict of a kind with a word in its message, once it has come."""

        def found() -> list[dict[str, Any]]:
            return [v for v in self.said if v["event"] == event and word in v["message"]]

        until(lambda: found() or self.process.poll() is not None, f"{event} {word}")
        until(lambda: found() or not self._threads[0].is_alive(), f"{event} {word}")
        assert found(), f"no {event} {word} in {self.said}\n{self.errors}"
        return found()[0]

    def feed(self, data: bytes) -> None:
        """Write to its standard input."""
        assert self.process.stdin is not None
        self.process.stdin.write(data)
        self.process.stdin.flush()

    def ended(self) -> int:
        """Its exit status, once all it said is here."""
        if self.process.stdin is not None and not self.process.stdin.closed:
            self.process.stdin.close()
        self.process.wait(PATIENCE)
        for thread in self._threads:
            thread.join(PATIENCE)
        for stream in (self.process.stdout, self.process.stderr):
            if stream is not None:
                stream.close()
        return self.process.returncode

    def kill(self) -> None:
        """End it without a chance to say anything."""
        self.process.kill()
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
