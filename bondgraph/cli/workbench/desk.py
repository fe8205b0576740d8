"""What one page of the workbench talks with: its wishes, and of each kind of answer the newest."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import Any

from bondgraph.cli.workbench.analyst import Analyst, Processes
from bondgraph.cli.workbench.bench import Bench
from bondgraph.cli.workbench.sketch import Job
from bondgraph.text.diagnostic import CompileError
from bondgraph.text.limits import EDIT_BYTES
from bondgraph.text.printable import json_text, printable_values


class Desk:
    """One page. An answer that it has not read yet is replaced by a newer one of its kind."""

    def __init__(self, bench: Bench, processes: Processes, hello: dict[str, Any]) -> None:
        self._bench = bench
        self._loop = asyncio.get_running_loop()
        self._waiting: dict[str, str] = {}
        self._more = asyncio.Event()
        self._analyst = Analyst(processes, self.say)
        self._saves: asyncio.Task[None] | None = None
        bench.desks.add(self)
        disk = bench.disk
        self._put({**hello, "type": "hello", "text": disk.text, "digest": disk.digest})

    def say(self, message: dict[str, Any]) -> None:
        """Tell the page, from any thread."""
        with suppress(RuntimeError):  # the loop has ended
            self._loop.call_soon_threadsafe(self._put, message)

    def _put(self, message: dict[str, Any]) -> None:
        kind = f"{message['type']} {message.get('name', '')}"
        self._waiting.pop(kind, None)  # a newer one waits behind what is older
        self._waiting[kind] = _sent(message)
        self._more.set()

    async def next(self) -> str:
        """See `Guest`."""
        while not self._waiting:
            self._more.clear()
            await self._more.wait()
        return self._waiting.pop(next(iter(self._waiting)))

    def leave(self) -> None:
        """See `Guest`."""
        self._bench.desks.discard(self)
        self.end()

    def end(self) -> None:
        """No more answers."""
        self._analyst.end()

    def hear(self, message: dict[str, Any]) -> None:
        """See `Guest`; what is no wish is not heard."""
        match message.get("do"):
            case "look":
                self._look(message)
            case "run":
                self._analyst.ask(message)
            case "derive" if isinstance(message.get("name"), str):
                self._analyst.ask(message)
            case "save" if self._saves is None or self._saves.done():
                self._saves = asyncio.create_task(self._save(message))
            case _:
                pass

    def _look(self, message: dict[str, Any]) -> None:
        version, text, model = (message.get(k) for k in ("version", "text", "model"))
        if not isinstance(version, int) or not isinstance(text, str) or not isinstance(model, str):
            return
        if len(text) > EDIT_BYTES:
            self._put({"type": "failed", "version": version,
                       "message": f"A page edits up to {EDIT_BYTES:,} characters."})  # fmt: skip
            return
        derivative = message.get("derivative") is True
        self._analyst.look(Job(version, self._bench.disk.path, text, model, derivative))

    async def _save(self, message: dict[str, Any]) -> None:
        """Write the file, and say what became of it."""
        text, seen = message.get("text"), message.get("seen")
        if not isinstance(text, str) or not isinstance(seen, str) or len(text) > EDIT_BYTES:
            return
        disk = self._bench.disk
        try:
            found = await asyncio.to_thread(disk.save, text, seen)
        except CompileError as error:
            self._put({"type": "unsaved", "why": str(error)})
        except OSError as error:
            why = f"{error.strerror or error}: {error.filename or disk.path}"
            self._put({"type": "unsaved", "why": why})
        else:
            if found is None:
                self._put({"type": "conflict", "text": disk.text, "digest": disk.digest})
                return
            answer = {"text": found, "digest": disk.digest}
            self._put({"type": "saved", "was": text, **answer})
            self._bench.told({"type": "disk", **answer}, besides=self)


def _sent(message: dict[str, Any]) -> str:
    """A message as it is sent: all of it printable, but for texts of the file, which stay exact."""
    exact = {key: message[key] for key in ("text", "was") if key in message}
    return json_text(printable_values(message) | exact)
