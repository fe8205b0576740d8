"""Who talks with a page over its WebSocket, what a page may ask for, and who serves them all."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol

from bondgraph.text.tuples import NamedTuple


class Guest(Protocol):
    """What one page talks with, from its first message to its last; called in the server's loop."""

    async def next(self) -> str:
        """What the page is sent next, as soon as there is something."""

    def hear(self, message: dict[str, Any]) -> None:
        """The page says something."""

    def leave(self) -> None:
        """The page has gone."""


class Talk(NamedTuple):
    """A WebSocket: who talks there, for how many pages, in how large messages, how many a second.

    More messages than that wait at the page.
    """

    guest: Callable[[], Guest]
    pages: int
    size: int  # bytes of a message
    a_second: float


class Service(Protocol):
    """What is served beside files: talks over WebSockets, and what a thread of its own does."""

    @property
    def talks(self) -> Mapping[str, Talk]:
        """Who talks, by the path of the WebSocket."""

    def run(self) -> None:
        """What goes on until `stop`, in a thread of its own."""

    def stop(self, who: str) -> None:
        """End soon; `who` ends it."""
