"""The page and its WebSocket, served on this machine.

`Hub` has messages for all pages: the past for a new one, fewer frames for a slow one.
"""

from __future__ import annotations

import asyncio
import json
import signal
import socket
from collections import deque
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress
from threading import Thread
from typing import Any

from aiohttp import WSMsgType, web

from bondgraph.runtime.live.session import Session
from bondgraph.text.diagnostic import Trouble

_LARGEST = 4096  # bytes of a wish
_LOCAL = ("127.0.0.1", "localhost", "[::1]", "::1")
_CLOSE = 1.0  # s that a page may take to say goodbye

#: Nothing from elsewhere, no script or style in the page itself.
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self';"
    " img-src 'self' data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
_HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
}

_Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]
_PAST = 400  # frames that a new page gets
_VERDICTS = 500
_WAITING = 40  # frames that a slow page may be behind
_PATH = 1200  # points of each path


class PortTaken(Trouble):
    """Nobody can listen there; the message says why."""


def listening(host: str, port: int) -> socket.socket:
    """A socket that listens; raises `PortTaken`."""
    try:
        family, kind, proto, _, at = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except OSError as error:
        raise PortTaken(f"there is no address {host}") from error
    made = socket.socket(family, kind, proto)
    try:
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        made.bind(at)
        made.listen(64)
    except OSError as error:
        made.close()
        why = (error.strerror or str(error)).lower()
        raise PortTaken(
            f"cannot listen on {host}, port {port}: {why}; name another by --port, or 0 for any"
            " that is free"
        ) from error
    return made


def application(
    files: Mapping[str, tuple[str, str]], hub: Hub, ask: Callable[[dict[str, Any]], None]
) -> web.Application:
    """The files by path, each (type, text), and `/ws`. Wishes of pages go to `ask`.

    Only requests that name this machine are answered, so that no page from elsewhere can reach it
    under a name of its own (DNS rebinding).
    """
    sockets: set[web.WebSocketResponse] = set()

    @web.middleware
    async def guarded(request: web.Request, handler: _Handler) -> web.StreamResponse:
        if not _welcome(request):
            raise web.HTTPForbidden(text="This address is not served here.")
        response = await handler(request)
        if not response.prepared:
            response.headers.update(_HEADERS)
        return response

    async def file(request: web.Request) -> web.Response:
        found = files.get(request.path)
        if found is None:
            raise web.HTTPNotFound(text="There is nothing here.", headers=_HEADERS)
        return web.Response(text=found[1], content_type=found[0], charset="utf-8")

    async def talk(request: web.Request) -> web.WebSocketResponse:
        page = web.WebSocketResponse(heartbeat=20.0, max_msg_size=_LARGEST, compress=False)
        await page.prepare(request)
        viewer = hub.join()
        sockets.add(page)
        writer = asyncio.create_task(_write(page, viewer))
        try:
            async for message in page:
                if message.type is WSMsgType.TEXT:
                    wish = _wish(message.data)
                    if wish is not None:
                        ask(wish)
        finally:
            writer.cancel()
            with suppress(asyncio.CancelledError):
                await writer
            hub.leave(viewer)
            sockets.discard(page)
        return page

    async def goodbye(_: web.Application) -> None:
        for page in list(sockets):
            with suppress(Exception):
                await asyncio.wait_for(page.close(code=1001, message=b"the server ends"), _CLOSE)

    app = web.Application(middlewares=[guarded])
    app.router.add_get("/ws", talk)
    app.router.add_get("/{path:.*}", file)
    app.on_shutdown.append(goodbye)
    return app


async def _write(page: web.WebSocketResponse, viewer: Viewer) -> None:
    """Send what there is, as fast as the page takes it."""
    with suppress(ConnectionError):
        while not page.closed:
            await page.send_str(await viewer.next())


def _wish(text: str) -> dict[str, Any] | None:
    """What a page asks for; None for what is no wish."""
    try:
        found = json.loads(text)
    except (ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) else None


def _welcome(request: web.Request) -> bool:
    """Whether a request comes from a page of ours."""
    host = request.host.rpartition(":")[0] if request.host[-1:].isdigit() else request.host
    name = request.transport.get_extra_info("sockname") if request.transport else None
    own = {*_LOCAL, str(name[0])} if name else set(_LOCAL)
    alone = not name or name[0] in ("127.0.0.1", "::1")  # else other computers are served, too
    origin = request.headers.get("Origin")
    same = origin is None or origin.partition("://")[2] == request.host
    return same and (host in own or not alone)


async def serve(
    made: socket.socket,
    files: Mapping[str, tuple[str, str]],
    hello: dict[str, Any],
    start: Callable[[Callable[[dict[str, Any]], None]], Session],
    ready: Callable[[], None],
) -> None:
    """Serve until SIGINT or SIGTERM. `start` makes the session for what it is to say to."""
    loop = asyncio.get_running_loop()
    over = asyncio.Event()
    hub = Hub(hello)

    def say(message: dict[str, Any]) -> None:
        with suppress(RuntimeError):  # the loop has ended
            loop.call_soon_threadsafe(hub.publish, message)

    session = start(say)
    failed: list[BaseException] = []

    def run() -> None:
        try:
            session.run()
        except BaseException as error:
            failed.append(error)
            with suppress(RuntimeError):
                loop.call_soon_threadsafe(over.set)

    runner = web.AppRunner(application(files, hub, session.ask), access_log=None)
    await runner.setup()
    await web.SockSite(runner, made, shutdown_timeout=_CLOSE).start()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, over.set)
    thread = Thread(target=run, name="session")
    thread.start()
    try:
        ready()
        await over.wait()
    finally:
        session.stop("the server")
        await runner.cleanup()
        await asyncio.to_thread(thread.join)
    if failed:
        raise failed[0]


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
