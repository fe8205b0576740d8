"""The pages of one session: all hear what it says, and each may wish something of it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from typing import Any, Protocol

from bondgraph.runtime.live.guests import Talk
from bondgraph.runtime.live.hub import Hub, message_text
from bondgraph.runtime.live.messages import Say
from bondgraph.runtime.live.session import Session
from bondgraph.text import limits


class Asked(Protocol):
    """What takes the wishes of pages; `refuse` is told why one cannot be done."""

    def __call__(self, message: dict[str, Any], refuse: Callable[[str], None]) -> None:
        """Somebody wishes something."""


class Onlooker:
    """One page of a session: what the hub tells it, and its wishes."""

    def __init__(self, hub: Hub, ask: Asked) -> None:
        self._hub, self._ask = hub, ask
        self._viewer = hub.join()
        self._loop = asyncio.get_running_loop()

    async def next(self) -> str:
        """See `Guest`."""
        return await self._viewer.next()

    def hear(self, message: dict[str, Any]) -> None:
        """See `Guest`."""
        self._ask(message, self._refuse)

    def leave(self) -> None:
        """See `Guest`."""
        self._hub.leave(self._viewer)

    def _refuse(self, why: str) -> None:
        text = message_text({"type": "refused", "message": why})
        with suppress(RuntimeError):  # the loop has ended
            self._loop.call_soon_threadsafe(self._viewer.put, "refused", text)


def talk(hub: Hub, ask: Asked) -> Talk:
    """The WebSocket of the live page."""
    return Talk(
        lambda: Onlooker(hub, ask), limits.PAGES, limits.WISH_BYTES, limits.WISHES_A_SECOND
    )


class Audience:
    """A session with its pages; `start` makes it for what it is to say to, in the server's loop."""

    def __init__(self, hello: dict[str, Any], start: Callable[[Say], Session]) -> None:
        loop, hub = asyncio.get_running_loop(), Hub(hello)

        def say(message: dict[str, Any]) -> None:
            with suppress(RuntimeError):  # the loop has ended
                loop.call_soon_threadsafe(hub.publish, message)

        self._session = start(say)
        self.talks = {"/ws": talk(hub, self._session.ask)}

    def run(self) -> None:
        """See `Service`."""
        self._session.run()

    def stop(self, who: str) -> None:
        """See `Service`."""
        self._session.stop(who)
