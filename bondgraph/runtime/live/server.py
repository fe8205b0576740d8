"""The page and its WebSocket, served: who is let in, and how much of anything one may ask for."""

from __future__ import annotations

import asyncio
import hmac
import json
import logging
import os
import secrets
import signal
import socket
import time as clocks
from collections import Counter
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress
from threading import Thread
from typing import Any

from aiohttp import WSMsgType, web
from aiohttp.web_protocol import RequestHandler

from bondgraph.runtime.live.gate import Gate
from bondgraph.runtime.live.guests import Guest, Service, Talk
from bondgraph.text.diagnostic import Trouble

_LOCAL = ("127.0.0.1", "localhost", "[::1]", "::1")
_CLOSE = 0.3  # s that all pages together may take to say goodbye
_END = 0.4  # s that a watch has for its last words
_PATIENCE = 10.0  # s that a page may take to read what it is sent
_AT_ONCE = 10  # messages of a page that are read at once

#: Nothing from elsewhere, no script or style in the page itself.
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self';"
    " img-src 'self' data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
_HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
}

#: The pages that are open, by their connection.
PAGES: web.AppKey[dict[RequestHandler | None, web.WebSocketResponse[Any]]] = web.AppKey(
    "pages", dict
)

_Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


def _quiet() -> logging.Logger:
    """A logger that says nothing, unless somebody looks for a bug.

    What others send is wrong as they like: they are not to fill a log, nor to hold up the server
    where nobody reads it.
    """
    if not os.environ.get("BONDGRAPH_TRACEBACK"):
        for name in ("asyncio", "aiohttp"):
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)
    return logging.getLogger("aiohttp.server")


class PortTaken(Trouble):
    """Nobody can listen there; the message says why."""


def listening(host: str, port: int) -> socket.socket:
    """A socket that listens; raises `PortTaken`."""
    try:
        family, kind, proto, _, at = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except (OSError, UnicodeError) as error:
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


def token_for(made: socket.socket) -> str:
    """What an address has to begin with where other computers can ask; "" where only this one."""
    return "" if made.getsockname()[0] in _LOCAL else secrets.token_urlsafe(16)


def address_of(made: socket.socket, token: str) -> str:
    """Where a browser finds the page of what listens there."""
    host, port = made.getsockname()[:2]
    if host in ("0.0.0.0", "::"):
        host = socket.gethostname()
    name = f"[{host}]" if ":" in host else host
    return f"http://{name}:{port}/{token + '/' if token else ''}"


def application(
    files: Mapping[str, tuple[str, str]],
    talks: Mapping[str, Talk],
    token: str = "",
    policy: str = POLICY,
) -> web.Application:
    """The files by path, each (type, text), and WebSockets by theirs.

    Only requests that name this machine are answered, so that no page from elsewhere can reach it
    under a name of its own (DNS rebinding). With a token all paths begin with it.
    """
    prefix = f"/{token}/" if token else "/"
    headers = {"Content-Security-Policy": policy, **_HEADERS}
    taken: Counter[str] = Counter()  # pages of each WebSocket

    @web.middleware
    async def guarded(request: web.Request, handler: _Handler) -> web.StreamResponse:
        if not _welcome(request):
            raise web.HTTPForbidden(text="This address is not served here.")
        response = await handler(request)
        if not response.prepared:
            response.headers.update(headers)
        return response

    async def answer(request: web.Request) -> web.StreamResponse:
        begin = request.path[: len(prefix)].encode(errors="replace")
        if hmac.compare_digest(begin, prefix.encode()):
            path = "/" + request.path[len(prefix) :]
            if path in talks:
                if taken[path] >= talks[path].pages:
                    text = "Too many pages are open."
                    raise web.HTTPServiceUnavailable(text=text, headers=headers)
                taken[path] += 1
                try:
                    return await _talk(request, talks[path])
                finally:
                    taken[path] -= 1
            if path in files:
                kind, text = files[path]
                return web.Response(text=text, content_type=kind, charset="utf-8")
        raise web.HTTPNotFound(text="There is nothing here.", headers=headers)

    async def goodbye(app: web.Application) -> None:
        pages = app[PAGES].values()
        said = [asyncio.create_task(p.close(code=1001, message=b"the server ends")) for p in pages]
        if said:
            _, late = await asyncio.wait(said, timeout=_CLOSE)
            for task in late:
                task.cancel()
            await asyncio.gather(*said, return_exceptions=True)
        for connection in app[PAGES]:
            _cut(connection)

    app = web.Application(middlewares=[guarded])
    app[PAGES] = {}
    app.router.add_get("/{path:.*}", answer)
    app.on_shutdown.append(goodbye)
    return app


async def _talk(request: web.Request, talk: Talk) -> web.WebSocketResponse:
    """One page, from its first message to its last."""
    pages = request.app[PAGES]
    page = web.WebSocketResponse(
        timeout=_CLOSE,
        autoping=False,
        heartbeat=20.0,
        max_msg_size=talk.size,
        compress=False,
    )
    pages[request.protocol] = page
    guest = talk.guest()
    try:
        await page.prepare(request)
        writer = asyncio.create_task(_write(page, guest, request.protocol))
        try:
            await _read(page, guest, request.protocol, talk.a_second)
        finally:
            writer.cancel()
            with suppress(asyncio.CancelledError, ConnectionError):
                await writer
    finally:
        guest.leave()
        del pages[request.protocol]
    return page


async def _write(page: web.WebSocketResponse, guest: Guest, connection: RequestHandler) -> None:
    """Send what there is, as fast as the page takes it; one that takes nothing is cut off."""
    try:
        while not page.closed:
            text = await guest.next()
            async with asyncio.timeout(_PATIENCE):
                await page.send_str(text)
    except (ConnectionError, TimeoutError):
        _cut(connection)


async def _read(
    page: web.WebSocketResponse, guest: Guest, connection: RequestHandler, a_second: float
) -> None:
    """Hear what a page wishes, not more often than a person could; the rest waits at the page."""
    free = clocks.monotonic()  # when all that was read is paid for
    async for message in page:
        if message.type is WSMsgType.PING:
            await page.pong(message.data)
        elif message.type is WSMsgType.TEXT:
            wish = _wish(message.data)
            if wish is not None:
                guest.hear(wish)
        free = max(free, clocks.monotonic()) + 1 / a_second
        wait = free - clocks.monotonic() - _AT_ONCE / a_second
        if wait > 0:
            await asyncio.sleep(wait)
        if connection.transport is None:  # the page has gone: nobody wishes the rest
            return


def _cut(connection: RequestHandler | None) -> None:
    """End a connection without waiting for what was not read."""
    if connection is not None and connection.transport is not None:
        connection.transport.abort()


def _wish(text: str) -> dict[str, Any] | None:
    """What a page asks for; None for what is no wish."""
    try:
        found = json.loads(text)
    except (ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) else None


def _welcome(request: web.Request) -> bool:
    """Whether a request comes from a page of ours."""
    asked = request.headers.get("Host", "")
    host = asked.rpartition(":")[0] if asked[-1:].isdigit() and ":" in asked else asked
    name = request.transport.get_extra_info("sockname") if request.transport else None
    own = {*_LOCAL, str(name[0])} if name else set(_LOCAL)
    alone = not name or name[0] in ("127.0.0.1", "::1")  # else other computers are served, too
    origin = request.headers.get("Origin")
    same = origin is None or origin.partition("://")[2] == asked
    return same and (host in own or not alone)


async def serve(
    made: socket.socket,
    files: Mapping[str, tuple[str, str]],
    start: Callable[[], Service],
    ready: Callable[[], None],
    token: str = "",
    policy: str = POLICY,
) -> None:
    """Serve until SIGINT or SIGTERM; a second one ends the program at once.

    `start` makes, in the loop of the server, what there is beside the files. All paths begin with
    the token.
    """
    loop = asyncio.get_running_loop()
    over = asyncio.Event()
    service = start()
    failed: list[BaseException] = []

    def run() -> None:
        try:
            service.run()
        except BaseException as error:
            failed.append(error)
            with suppress(RuntimeError):
                loop.call_soon_threadsafe(over.set)

    def end() -> None:
        over.set()
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.remove_signal_handler(number)

    app = application(files, service.talks, token, policy)
    runner = web.AppRunner(
        app, access_log=None, logger=_quiet(), shutdown_timeout=_CLOSE, lingering_time=0.0
    )
    await runner.setup()
    assert runner.server is not None
    pages = app[PAGES]
    gate = Gate(runner.server, pages)
    listener = await loop.create_server(gate, sock=made)
    watch = asyncio.create_task(gate.watch())
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, end)
    # Who is in the middle of something long is left behind at the end: nothing of it is kept.
    thread = Thread(target=run, name="service", daemon=True)
    thread.start()
    try:
        ready()
        await over.wait()
    finally:
        service.stop("the server")
        watch.cancel()
        listener.close()
        await runner.cleanup()
        await asyncio.to_thread(thread.join, _END)
    if failed:
        raise failed[0]
