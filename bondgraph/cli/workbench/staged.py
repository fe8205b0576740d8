"""What is found out about one text, stage by stage, in a process of its own that may be killed."""

from __future__ import annotations

import os
import signal
import time
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Any

from bondgraph import Compilation
from bondgraph.cli.workbench.derived import derived, helping
from bondgraph.cli.workbench.sketch import Job, opened, sketch
from bondgraph.cli.workbench.trial import trial
from bondgraph.text.diagnostic import CompileError

_REST = 0.25  # s after a key without another one, before residuals are derived
_MEMORY = 4 << 30  # bytes that a process may have


class _Newer(Exception):
    """Something newer is asked for."""


def staged(pipe: Connection, job: Job) -> None:
    """Send the sketch of the text, then what is derived, then the runs that are asked for.

    Asked for are settings of a run; only the newest of them counts. Ends with the pipe.
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
        while True:
            _run(pipe, compilation, job.version)


def _run(pipe: Connection, compilation: Compilation, version: int) -> None:
    """Wait for a run to be asked for, and run it unless there is another one by then."""
    settings = pipe.recv()
    while pipe.poll():
        settings = pipe.recv()

    def progress(share: float) -> None:
        if pipe.poll():
            raise _Newer

    with suppress(_Newer):
        found: dict[str, Any] = trial(compilation, settings, progress)
        pipe.send(found | {"version": version})


def _bounded() -> None:
    """No more memory than a machine of this size can spare."""
    with suppress(ImportError, ValueError, OSError):
        import resource

        _, most = resource.getrlimit(resource.RLIMIT_AS)
        if most == resource.RLIM_INFINITY or most > _MEMORY:
            resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, most))
