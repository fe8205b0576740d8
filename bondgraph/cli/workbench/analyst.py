"""Looks at the texts of one page in processes beside the server: the newest one, the rest is stale.

A text has a process for as long as it is the newest. The process is ended when a newer text is
there, but not before it has sent its sketch: so that the drawing follows while somebody types on
and on, and what takes long begins when nobody types.
"""

from __future__ import annotations

import multiprocessing
import socket
import time as clocks
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from threading import Event, Lock, Thread
from typing import Any

from bondgraph.cli.workbench.sketch import Job, sketch
from bondgraph.cli.workbench.staged import staged

Say = Callable[[dict[str, Any]], None]

_BUG = "This takes more memory than there is, or found a bug in bondgraph."
_SKETCH = 20.0  # s that a drawing may take
_SOON = 0.1  # s between two looks whether processes can be had
_LONGEST = 300.0  # s that residuals may take, a derivation, or a run
_WISHES = 64  # at once


class Processes:
    """Starts processes quickly: a fork of one that has loaded everything, where there can be one.

    It takes some seconds to load that; `ready` says when.
    """

    def __init__(self) -> None:
        forks = "forkserver" in multiprocessing.get_all_start_methods()
        self._context: Any = multiprocessing.get_context("forkserver" if forks else "spawn")
        self.ready = Event()
        if not forks:
            self.ready.set()
            return
        self._context.set_forkserver_preload(["bondgraph.cli.workbench.warmed"])
        Thread(target=self._first, name="first process", daemon=True).start()

    def _first(self) -> None:
        """One with nothing to do is there as soon as all is loaded."""
        try:
            first = self._context.Process(target=int, daemon=True)
            first.start()
            first.join()
        except (EOFError, OSError):  # what forks has died: each process loads all itself
            self._context = multiprocessing.get_context("spawn")
        self.ready.set()

    def start(self, job: Job) -> tuple[BaseProcess, Connection]:
        """A process for a text, and what it says."""
        here, there = self._context.Pipe()
        process: BaseProcess = self._context.Process(target=staged, args=(there, job), daemon=True)
        process.start()
        there.close()
        return process, here


class Analyst:
    """One page's; `say` is told what is found, from a thread of its own."""

    def __init__(self, processes: Processes, say: Say) -> None:
        self._processes, self._say = processes, say
        self._lock = Lock()
        self._job: Job | None = None
        self._wishes: dict[str, dict[str, Any]] = {}
        self._awaited: set[str] = set()  # what answers will be of
        self._over = False
        self._woken, self._wake = socket.socketpair()
        self._wake.setblocking(False)
        self._process: BaseProcess | None = None
        self._pipe: Connection | None = None
        self._version = -1
        self._early: Job | None = None  # looked at before there were processes
        self._until = 0.0  # on the clock, when what is awaited has taken too long
        self._sketching = False
        self._thread = Thread(target=self._work, name="analyst", daemon=True)
        self._thread.start()

    def look(self, job: Job) -> None:
        """There is a newer text."""
        with self._lock:
            self._job = job
            self._wishes.clear()
        self._nudge()

    def ask(self, wish: dict[str, Any]) -> None:
        """A run of the newest text is asked for, or the derivation of one of its residuals."""
        kind = "run" if wish["do"] == "run" else f"derivation {wish.get('name')}"
        with self._lock:
            if len(self._wishes) < _WISHES:
                self._wishes[kind] = wish
        self._nudge()

    def end(self) -> None:
        """The page has gone."""
        self._over = True
        self._nudge()

    def _nudge(self) -> None:
        with suppress(OSError):  # it has ended, or is woken already
            self._wake.send(b"x")

    # -------------------------------------------------------------------- the thread

    def _work(self) -> None:
        try:
            while not self._over:
                self._turn()
        finally:
            self._kill()
            self._woken.close()
            self._wake.close()

    def _turn(self) -> None:
        """Wait for the page or the process, and do what follows."""
        watched: list[Any] = [self._woken, *([self._pipe] if self._pipe is not None else [])]
        left = self._until - clocks.monotonic() if self._until else None
        if self._early is not None:
            left = _SOON
        ready = wait(watched, None if left is None else max(left, 0.0))
        if self._woken in ready:
            self._woken.recv(4096)
        if self._pipe is not None and self._pipe in ready:
            self._receive(self._pipe)
        if not ready and self._until and clocks.monotonic() >= self._until:
            self._fail("This takes too long; it was given up.")
        if self._over:
            return
        job, wishes = self._due()
        if self._early is not None and self._processes.ready.is_set():
            job, self._early = job or self._early, None
        if job is not None:
            self._start(job)
        elif wishes and self._pipe is not None:
            with suppress(OSError):
                for wish in wishes.values():
                    self._pipe.send(wish)
            self._awaited |= wishes.keys()
            self._until = clocks.monotonic() + _LONGEST

    def _due(self) -> tuple[Job | None, dict[str, dict[str, Any]]]:
        """What is to be begun now: nothing before a sketch that is being made is there."""
        with self._lock:
            if self._sketching:
                return None, {}
            job, self._job = self._job, None
            wishes = dict(self._wishes)
            if self._pipe is not None:
                self._wishes.clear()
            return job, wishes

    def _start(self, job: Job) -> None:
        """Begin with a text; while processes cannot be had yet, its sketch is made here."""
        self._kill()
        if not self._processes.ready.is_set():
            self._early = job
            self._version = job.version
            try:
                self._say(sketch(job))
            except Exception:  # whatever it is, the process will find it as well
                self._fail(_BUG)
            return
        self._process, self._pipe = self._processes.start(job)
        self._version, self._sketching = job.version, True
        self._until = clocks.monotonic() + _SKETCH

    def _receive(self, pipe: Connection) -> None:
        try:
            message = pipe.recv()
        except (EOFError, OSError):
            self._gone()
            return
        self._sketching = False
        if message["type"] == "sketch" and message["sound"]:
            self._awaited.add("derived")
        self._awaited.discard(f"{message['type']} {message.get('name', '')}".strip())
        self._until = clocks.monotonic() + _LONGEST if self._awaited else 0.0
        self._say(message)

    def _gone(self) -> None:
        """The process has ended: because it had said all, or because something ended it."""
        process = self._process
        assert process is not None
        process.join()
        if process.exitcode:
            self._fail(_BUG)
        else:
            self._kill()

    def _fail(self, why: str) -> None:
        self._say({"type": "failed", "version": self._version, "message": why})
        self._kill()

    def _kill(self) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.join()
            self._process.close()
        if self._pipe is not None:
            self._pipe.close()
        self._process = self._pipe = None
        self._sketching, self._until = False, 0.0
        self._awaited.clear()
