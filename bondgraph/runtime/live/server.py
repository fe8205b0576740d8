"""The page and its WebSocket, served on this machine."""

from __future__ import annotations

import asyncio
import json
import signal
import socket
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress
from threading import Thread
from typing import Any

from aiohttp import WSMsgType, web

from bondgraph.runtime.live.hub import Hub, Viewer
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
