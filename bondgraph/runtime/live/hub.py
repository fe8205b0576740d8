"""What pages are told: the past for a new one, fewer frames for a slow one, all of it bounded.

Whatever pages there are, and however slowly they read, a hub keeps one copy of the past, and for
each page no more than a short queue. A page that is too far behind is not sent what it has missed,
but the past anew, as if it had just come.
"""

from __future__ import annotations

import asyncio
import json
from collections import deque
from collections.abc import Callable
from typing import Any

from bondgraph.text.printable import printable_values

_PAST = 400  # frames that a new page gets
_VERDICTS = 500
_WAITING = 40  # frames that a slow page may be behind
_BEHIND = 100  # other messages that it may be behind, before it is told everything anew
_PATH = 1200  # points of each path
_NEWEST = ("state", "faults", "refused")  # of these only the last one matters


class Viewer:
    """One page: frames wait in a short queue whose oldest are dropped, nothing else is missed.

    `past` gives all that a page has to know when it begins.
    """

    def __init__(self, past: Callable[[], str]) -> None:
        self._past = past
        self._begins = True
        self._frames: deque[str] = deque(maxlen=_WAITING)
        self._rest: deque[str] = deque()
        self._newest: dict[str, str] = {}
        self._changed = asyncio.Event()
        self.dropped = 0

    def put(self, kind: str, text: str) -> None:
        """Something to be told, of a kind."""
        if self._begins and kind != "refused":  # the past will have it
            return
        if kind == "frame":
            self.dropped += len(self._frames) == _WAITING
            self._frames.append(text)
        elif kind in _NEWEST:
            self._newest[kind] = text
        else:
            if kind == "reset":
                self._frames.clear()
                self._rest.clear()
            self._rest.append(text)
            if len(self._rest) > _BEHIND:
                self._begins = True
                for queue in (self._frames, self._rest, self._newest):
                    queue.clear()
        self._changed.set()

    async def next(self) -> str:
        """What is to be sent next: what must not be lost first."""
        while True:
            if self._begins:
                self._begins = False
                return self._past()
            if self._rest:
                return self._rest.popleft()
            if self._newest:
                return self._newest.pop(next(iter(self._newest)))
            if self._frames:
                return self._frames.popleft()
            self._changed.clear()
            await self._changed.wait()


class Hub:
    """Lives in the loop of the server; `hello` is what every page is told first."""

    def __init__(self, hello: dict[str, Any]) -> None:
        self._hello = hello
        self._viewers: set[Viewer] = set()
        self._sent = self._published = 0
        self._said = (-1, "")  # the past as a text, and of when
        self._state: dict[str, Any] = {}
        self._faults: list[str] = []
        self._verdicts: deque[dict[str, Any]] = deque(maxlen=_VERDICTS)
        self._clear()

    def _clear(self) -> None:
        self._frames: deque[dict[str, Any]] = deque(maxlen=_PAST)
        self._paths: dict[str, list[list[float]]] = {"real": [], "virtual": [], "desired": []}
        self._step = dict.fromkeys(self._paths, 1)
        self._count = 0
        self._verdicts.clear()

    def join(self) -> Viewer:
        """A new page."""
        viewer = Viewer(self._past)
        self._viewers.add(viewer)
        return viewer

    def leave(self, viewer: Viewer) -> None:
        """A page has gone."""
        self._viewers.discard(viewer)

    def _past(self) -> str:
        """All that a page has to know that begins now; made once for all that begin together."""
        if self._said[0] != self._published:
            now = {
                **self._hello,
                "state": self._state,
                "active": self._faults,
                "verdicts": list(self._verdicts),
                "paths": self._paths,
                "frames": list(self._frames),
            }
            self._said = self._published, message_text(now)
        return self._said[1]

    def publish(self, message: dict[str, Any]) -> None:
        """Tell all pages, and remember what a new one has to know."""
        self._published += 1
        kind = message["type"]
        match kind:
            case "frame":
                self._sent += 1
                message = {**message, "n": self._sent}
                self._frames.append(message)
                self._walk(message)
            case "reset":
                self._clear()
            case "state":
                self._state = message
            case "faults":
                self._faults = message["active"]
            case "verdict":
                self._verdicts.append(message)
            case _:
                pass
        text = message_text(message)
        for viewer in self._viewers:
            viewer.put(kind, text)

    def _walk(self, frame: dict[str, Any]) -> None:
        """The paths, thinned to every second point when they get long."""
        self._count += 1
        for whose, path in self._paths.items():
            pose = frame[whose]["p"]
            if len(pose) < 2 or None in pose[:2] or self._count % self._step[whose]:
                continue
            path.append(pose[:2])
            if len(path) > _PATH:
                del path[1::2]
                self._step[whose] *= 2


def message_text(message: dict[str, Any]) -> str:
    """A message as a page reads it; a frame is numbers, all else may have names from outside."""
    plain = message if message["type"] == "frame" else printable_values(message)
    return json.dumps(plain, ensure_ascii=False, allow_nan=False)
