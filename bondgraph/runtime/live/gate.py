"""How many connections a server has, and how long one lasts that shows no page."""

from __future__ import annotations

import asyncio
import time as clocks
from collections.abc import Container

from aiohttp.web import Server
from aiohttp.web_protocol import RequestHandler

from bondgraph.text.limits import CONNECTIONS

_SILENT = 30.0  # s that a connection may last that shows no page
_LOOK = 5.0  # s between two looks at them
_NO_ROOM = b"HTTP/1.1 503 Service Unavailable\r\nContent-Length: 0\r\nConnection: close\r\n\r\n"


class Gate:
    """Makes the protocol of each connection that somebody opens, as long as there is room."""

    def __init__(self, server: Server, pages: Container[RequestHandler | None]) -> None:
        self._server, self._pages = server, pages
        self._since: dict[RequestHandler, float] = {}

    def __call__(self) -> asyncio.Protocol:
        """What a new connection speaks."""
        return self._server() if len(self._server.connections) < CONNECTIONS else _Full()

    async def watch(self) -> None:
        """Cut what has shown no page for too long, until cancelled."""
        while True:
            await asyncio.sleep(_LOOK)
            self.look(clocks.monotonic())

    def look(self, now: float) -> None:
        """Cut what has shown no page for too long; `now` in s."""
        others = [c for c in self._server.connections if c not in self._pages]
        self._since = {c: self._since.get(c, now) for c in others}
        for connection, since in self._since.items():
            if now - since >= _SILENT and connection.transport is not None:
                connection.transport.abort()


class _Full(asyncio.Protocol):
    """Says that there is no room."""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)
        transport.write(_NO_ROOM)
        transport.close()
