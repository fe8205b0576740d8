"""The language server behind the page: one process of `bondgraph lsp` for each, over a WebSocket.

A message of the page is a message of the protocol. A page that does not read holds up its own
server and nobody else; one that sends more than is read loses it.
"""

from __future__ import annotations

import asyncio
import json
import sys
from contextlib import suppress
from typing import Any

from bondgraph.runtime.live.guests import Talk
from bondgraph.text import limits

_WAITING = 64  # messages that a page may be behind
_HELD = 8 * limits.EDIT_BYTES  # bytes that the server may be behind


def language_talk() -> Talk:
    """The WebSocket of the language server."""
    size = 6 * limits.EDIT_BYTES
    return Talk(LanguageGuest, limits.EDITORS, size, 4 * limits.KEYS_A_SECOND)


class LanguageGuest:
    """One page's language server."""

    def __init__(self) -> None:
        self._said: asyncio.Queue[str | None] = asyncio.Queue(_WAITING)
        self._unsent: list[bytes] = []  # before the process is there
        self._process: asyncio.subprocess.Process | None = None
        self._task = asyncio.create_task(self._serve())

    async def next(self) -> str:
        """See `Guest`; raises ConnectionError when the server has gone."""
        text = await self._said.get()
        if text is None:
            raise ConnectionError
        return text

    def hear(self, message: dict[str, Any]) -> None:
        """See `Guest`."""
        data = json.dumps(message).encode()
        framed = b"Content-Length: %d\r\n\r\n%s" % (len(data), data)
        if self._process is None:
            self._unsent.append(framed)
        elif self._process.stdin is not None and not self._process.stdin.is_closing():
            self._process.stdin.write(framed)
        if self._held() > _HELD:
            self._task.cancel()

    def leave(self) -> None:
        """See `Guest`."""
        self._task.cancel()

    def _held(self) -> int:
        if self._process is None or self._process.stdin is None:
            return sum(map(len, self._unsent))
        return self._process.stdin.transport.get_write_buffer_size()

    async def _serve(self) -> None:
        """Start the process, and hand on what it says until it ends, or the page has gone."""
        pipe = asyncio.subprocess.PIPE
        process = None
        try:
            process = await asyncio.create_subprocess_exec(
                sys.executable, "-m", "bondgraph", "lsp", "--stdio",
                stdin=pipe, stdout=pipe, stderr=asyncio.subprocess.DEVNULL, limit=_HELD,
            )  # fmt: skip
            assert process.stdin is not None and process.stdout is not None
            process.stdin.writelines(self._unsent)
            self._process, self._unsent = process, []
            while True:
                head = await process.stdout.readuntil(b"\r\n\r\n")
                size = int(head.lower().partition(b"content-length:")[2].split()[0])
                await self._said.put((await process.stdout.readexactly(size)).decode())
        except (asyncio.IncompleteReadError, OSError):
            pass
        finally:
            if process is not None and process.returncode is None:
                with suppress(ProcessLookupError):
                    process.kill()
            self._end()

    def _end(self) -> None:
        """The page is told that its server has gone."""
        while not self._said.empty():
            self._said.get_nowait()
        self._said.put_nowait(None)
