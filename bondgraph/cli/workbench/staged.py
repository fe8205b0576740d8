"""What is found out about one text, stage by stage, in a process of its own that may be killed."""

from __future__ import annotations

import os
import signal
import time
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Any

from bondgraph import Compilation
from bondgraph.cli.workbench.derived import derived, helping, replayed
from bondgraph.cli.workbench.sketch import Job, opened, sketch
from bondgraph.cli.workbench.trial import trial
from bondgraph.text.diagnostic import CompileError

_REST = 0.25  # s after a key without another one, before residuals are derived
_MEMORY = 4 << 30  # bytes that a process may have


class _Newer(Exception):
    """A newer run is asked for."""


def staged(pipe: Connection, job: Job) -> None:
    """Send the sketch of the text, then what is derived, then what is asked for.

    Asked for are derivations and runs; of runs only the newest counts. Ends with the pipe.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # ^C is for the server
    _bounded()
    with suppress(EOFError, BrokenPipeError, ConnectionResetError):
        begun = time.process_time()
        drawn = sketch(job)
        pipe.send(drawn | {"took": 1e3 * (time.process_time() - begun)})
        if not drawn["sound"]:
            return
        pipe.poll(_REST)
        with suppress(AttributeError, OSError):
            os.nice(5)  # after what is drawn while somebody types
        try:
            compilation = opened(job)
            pipe.send(derived(compilation, job.version))
        except CompileError as error:
            wrong = {"type": "derived", "version": job.version, "status": "wrong"}
            pipe.send(wrong | {"message": str(error), "help": helping(error)})
            return
        wishes = _Wishes(pipe)
        while True:
            _answer(wishes.take(), wishes, compilation, job.version)


class _Wishes:
    """What the page has asked for and has no answer to yet: of each kind the newest."""

    def __init__(self, pipe: Connection) -> None:
        self.pipe = pipe
        self._waiting: dict[str, dict[str, Any]] = {}

    def take(self) -> dict[str, Any]:
        """The next one; what is quick comes before a run. Raises EOFError when the page is gone."""
        while not self._waiting or self.pipe.poll():
            self._hear()
        first = min(self._waiting, key=lambda kind: kind == "run")
        return self._waiting.pop(first)

    def run_again(self) -> bool:
        """Whether another run is asked for."""
        while self.pipe.poll():
            self._hear()
        return "run" in self._waiting

    def _hear(self) -> None:
        wish = self.pipe.recv()
        kind = "run" if wish.get("do") == "run" else f"derive {wish.get('name')}"
        self._waiting[kind] = wish


def _answer(
    wish: dict[str, Any], wishes: _Wishes, compilation: Compilation, version: int
) -> None:
    """Replay a derivation, or run the machine unless another run is asked for meanwhile."""
    if wish.get("do") != "run":
        wishes.pipe.send(replayed(compilation, str(wish.get("name")), version))
        return

    def progress(share: float) -> None:
        if wishes.run_again():
            raise _Newer

    with suppress(_Newer):
        found: dict[str, Any] = trial(compilation, wish, progress)
        wishes.pipe.send(found | {"version": version})


def _bounded() -> None:
    """No more memory than a machine of this size can spare."""
    with suppress(ImportError, ValueError, OSError):
        import resource

        _, most = resource.getrlimit(resource.RLIMIT_AS)
        if most == resource.RLIM_INFINITY or most > _MEMORY:
            resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, most))
