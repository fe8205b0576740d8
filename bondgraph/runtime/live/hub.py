"""Messages for all pages: the past for a new one, fewer frames for a slow one."""

from __future__ import annotations

import asyncio
import json
from collections import deque
from typing import Any

_PAST = 400  # frames that a new page gets
_VERDICTS = 500
_WAITING = 40  # frames that a slow page may be behind
_PATH = 1200  # points of each path


class Viewer:
    """One page: frames wait in a short queue whose oldest are dropped, all else is kept."""

    def __init__(self) -> None:
        self._frames: deque[str] = deque(maxlen=_WAITING)
        self._rest: deque[str] = deque()
        self._changed = asyncio.Event()
        self.dropped = 0

    def put(self, text: str, frame: bool) -> None:
        """Something to be told."""
        if frame:
            self.dropped += len(self._frames) == _WAITING
            self._frames.append(text)
        else:
            if text.startswith('{"type": "reset"'):
                self._frames.clear()
            self._rest.append(text)
        self._changed.set()

    async def next(self) -> str:
        """What is to be sent next: what must not be lost first."""
        while not self._rest and not self._frames:
            self._changed.clear()
            await self._changed.wait()
        return self._rest.popleft() if self._rest else self._frames.popleft()


class Hub:
    """Lives in the loop of the server; `hello` is what every page is told first."""

    def __init__(self, hello: dict[str, Any]) -> None:
        self._hello = hello
        self._viewers: list[Viewer] = []
        self._sent = 0
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
        """A new page, with all that it has to know."""
        viewer = Viewer()
        now = {
            **self._hello,
            "state": self._state,
            "active": self._faults,
            "verdicts": list(self._verdicts),
            "paths": self._paths,
            "frames": list(self._frames),
        }
        viewer.put(_text(now), False)
        self._viewers.append(viewer)
        return viewer

    def leave(self, viewer: Viewer) -> None:
        """A page has gone."""
        self._viewers.remove(viewer)

    def publish(self, message: dict[str, Any]) -> None:
        """Tell all pages, and remember what a new one has to know."""
        frame = message["type"] == "frame"
        match message["type"]:
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
        text = _text(message)
        for viewer in self._viewers:
            viewer.put(text, frame)

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


def _text(message: dict[str, Any]) -> str:
    return json.dumps(message, ensure_ascii=False, allow_nan=False)
