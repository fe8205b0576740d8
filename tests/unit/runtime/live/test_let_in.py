"""What a live server lets in: how much anybody may ask for, and that nobody holds up a watch."""

from __future__ import annotations

import asyncio
import json
import signal
import socket
import time
from contextlib import suppress
from pathlib import Path
from threading import Event
from typing import Any

import pytest
from aiohttp import WSServerHandshakeError, web
from aiohttp.test_utils import TestClient

from bondgraph.runtime.live import gate as gates
from bondgraph.runtime.live import server
from bondgraph.runtime.live.audience import talk
from bondgraph.runtime.live.follower import Follower
from bondgraph.runtime.live.gate import Gate
from bondgraph.runtime.live.hub import Hub
from bondgraph.runtime.live.portions import Portion, Portions
from bondgraph.runtime.log_numbers import Form
from bondgraph.runtime.monitoring.sources.streams import Pipe
from bondgraph.text import limits
from tests.fuzz.connections import garbage
from tests.live_flood import flood, served
from tests.unit.runtime.live.test_server import Watched, _frame, _served, _verdict


def test_a_flood_of_wishes_and_pages_that_do_not_read(tmp_path: Path) -> None:
    found = flood(tmp_path, viewers=60, silent=10, wishes=20_000, seconds=4.0)
    assert found.status == 0 and found.said == "stopped\n"
    assert found.refused == found.foreign == 5
    assert min(found.frames) > 0.5 * 20 * found.seconds and found.gap < 1.0
    assert found.most < found.before + 100  # MB
    assert found.end < 1.0


def test_connections_that_say_anything_leave_no_trace(tmp_path: Path) -> None:
    with served(tmp_path) as (process, address):  # nobody reads what it prints meanwhile
        garbage(int(address.rsplit(":", 1)[1].strip("/")), 400, 1)
        start = time.monotonic()
        process.send_signal(signal.SIGTERM)
        said, _ = process.communicate(timeout=20)
        assert time.monotonic() - start < 1.5
    assert said == "stopped\n" and process.returncode == 0


def test_a_page_that_never_reads_is_told_everything_anew() -> None:
    async def run() -> None:
        hub = Hub({"type": "hello"})
        viewer = hub.join()
        await viewer.next()
        for k in range(5000):
            hub.publish(_verdict(k))
            hub.publish({"type": "state", "state": f"{k}"})
            hub.publish(_frame(k))
        queued = len(viewer._rest) + len(viewer._frames) + len(viewer._newest)
        assert queued <= 100 + 40 + 3
        told = json.loads(await viewer.next())
        assert told["type"] == "hello" and told["verdicts"][-1] == _verdict(4999)
        assert len(told["verdicts"]) == 500
        hub.publish(_verdict(5000))
        assert json.loads(await viewer.next())["number"] == 5000

    asyncio.run(run())


def test_pages_that_begin_together_share_what_was_before() -> None:
    async def run() -> None:
        hub = Hub({"type": "hello"})
        hub.publish(_frame(1.0))
        one, two = [await hub.join().next() for _ in range(2)]
        assert one is two
        hub.publish(_frame(2.0))
        assert len(json.loads(await hub.join().next())["frames"]) == 2

    asyncio.run(run())


def test_names_from_outside_cannot_be_raw_in_a_message() -> None:
    async def run() -> None:
        links = {"a\u202eb": ["\x07"]}
        hub = Hub({"type": "hello", "monitored": "/dev/tty\x1b[2J", "links": links})
        hub.publish({"type": "verdict", "message": "line 1: `\x1b]0;x\x07\udcff`\n\u2066"})
        told = json.loads(await hub.join().next())
        assert told["monitored"] == "/dev/tty\ufffd[2J"
        assert told["links"] == {"a\ufffdb": ["\ufffd"]}
        assert told["verdicts"][0]["message"] == "line 1: `\ufffd]0;x\ufffd\ufffd`\n\ufffd"

    asyncio.run(run())


def test_beyond_this_computer_the_address_has_a_token() -> None:
    async def look(client: TestClient[Any, Any], hub: Hub, wishes: list[Any]) -> None:
        assert (await client.get("/sesame/")).status == 200
        assert (await client.get("/sesame/a.js")).status == 200
        await (await client.ws_connect("/sesame/ws")).close()
        for path in ("/", "/a.js", "/sesame", "/sesamo/", "/sesame/ws/", "/ses%61mee/", "/é/"):
            assert (await client.get(path)).status == 404
        with pytest.raises(WSServerHandshakeError) as refused:
            await client.ws_connect("/ws")
        assert refused.value.status == 404

    _served(look, "sesame")
    with server.listening("127.0.0.1", 0) as here, server.listening("0.0.0.0", 0) as anywhere:
        assert server.token_for(here) == ""
        one, two = server.token_for(anywhere), server.token_for(anywhere)
        assert len(one) > 20 and one != two


def test_there_is_room_for_so_many_pages(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "PAGES", 2)

    async def look(client: TestClient[Any, Any], hub: Hub, wishes: list[Any]) -> None:
        one, _ = [await client.ws_connect("/ws") for _ in range(2)]
        with pytest.raises(WSServerHandshakeError) as refused:
            await client.ws_connect("/ws")
        assert refused.value.status == 503
        await one.close()
        await asyncio.sleep(0.05)
        await client.ws_connect("/ws")

    _served(look)


def test_a_page_is_heard_no_oftener_than_a_person_wishes() -> None:
    async def look(client: TestClient[Any, Any], hub: Hub, wishes: list[Any]) -> None:
        page = await client.ws_connect("/ws")
        start = time.monotonic()
        for k in range(40):
            await page.send_str('{"do": "clear"}')
            if k % 2:
                await page.ping()
        while len(wishes) < 15 and time.monotonic() < start + 20:
            await asyncio.sleep(0.01)
        assert time.monotonic() - start > 0.9  # 22 messages: 10 at once, then 10 a second
        assert len(wishes) < 25
        assert page._writer is not None
        page._writer.transport.abort()  # type: ignore[union-attr]
        await asyncio.sleep(0.5)
        assert not client.app[server.PAGES]  # type: ignore[union-attr]

    _served(look)


async def _ended(reader: asyncio.StreamReader) -> bool:
    """Whether the other side ends a connection."""
    with suppress(ConnectionResetError):
        await asyncio.wait_for(reader.read(), 5)
    return reader.at_eof() or reader.exception() is not None


def test_connections_that_show_no_page_are_cut(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gates, "CONNECTIONS", 3)

    async def run() -> None:
        app = server.application(
            {"/": ("text/html", "x")}, {"/ws": talk(Hub({"type": "hello"}), lambda *_: None)}
        )
        runner = web.AppRunner(app, shutdown_timeout=0.1)
        await runner.setup()
        assert runner.server is not None
        pages = app[server.PAGES]
        gate = Gate(runner.server, pages)
        made = server.listening("127.0.0.1", 0)
        listener = await asyncio.get_running_loop().create_server(gate, sock=made)
        at = made.getsockname()
        silent = [await asyncio.open_connection(*at) for _ in range(3)]
        await asyncio.sleep(0.05)
        reader, writer = await asyncio.open_connection(*at)
        assert b" 503 " in await asyncio.wait_for(reader.read(), 5)
        now = time.monotonic()
        gate.look(now)
        gate.look(now + 29.0)
        assert len(runner.server.connections) == 3
        gate.look(now + 31.0)
        assert await asyncio.gather(*(_ended(r) for r, _ in silent)) == [True] * 3
        await asyncio.sleep(0.05)
        assert runner.server.connections == []
        for one in (writer, *(w for _, w in silent)):
            one.close()
            with suppress(ConnectionError):
                await one.wait_closed()
        listener.close()
        await runner.cleanup()

    asyncio.run(run())


HEADER = "t,F[1],F[2],turn[1],turn[2],v[1],v[2]\n"


def test_a_twin_that_takes_long_does_not_hold_up_the_watch(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    held = Event()

    def advance(self: Follower, *_: object) -> Any:
        held.wait(30)
        return [], {}, None

    monkeypatch.setattr(Follower, "_advance", advance)
    ours, theirs = socket.socketpair()
    watched = Watched(tmp_path, lambda: Pipe(Form("w"), theirs.fileno(), "w"), False, None)
    try:
        watched.wait(("type", "state"), ("state", "waiting"))
        start = time.monotonic()
        for k in range(700):
            ours.sendall((HEADER * (k == 0) + f"{k / 200},1,1,0,0,0,0\n").encode())
            time.sleep(0.005)
        ours.close()
        watched.wait(("type", "verdict"), ("whose", "real"), ("event", "stop"))
        watched.wait(("type", "state"), ("state", "ended"))
        frames = [m for m in watched.said if m["type"] == "frame"]
        assert frames and frames[-1]["t"] > 3.0 and all(f["virtual"]["p"] == [] for f in frames)
        assert time.monotonic() - start < 10
        times = [f["t"] for f in frames]
        assert times == sorted(times)
        watched.session.stop("the test")
        watched._thread.join(1.0)
        assert not watched._thread.is_alive()
        held.set()
    finally:
        held.set()
        ours.close()
        watched.stop()
        theirs.close()


def test_what_the_twin_is_too_slow_for_is_handed_back() -> None:
    portions, stop = Portions(waits=False), Event()
    none: Any = [0.0]
    late = [portions.put(Portion(1, {"t": k}, none, {}), stop) for k in range(65)]
    assert [p.frame["t"] for p in late[-1] if p.frame] == list(range(64))
    assert not any(late[:-1])
    found = portions.take(0.0)
    assert found is not None and found.skipped == 64 and found.frame == {"t": 64}
    assert portions.take(0.0) is None


def test_only_so_much_may_be_wished_and_injected(tmp_path: Path) -> None:
    ours, theirs = socket.socketpair()
    watched = Watched(tmp_path, lambda: Pipe(Form("w"), theirs.fileno(), "w"), False, None)
    refused: list[str] = []
    try:
        watched.wait(("type", "state"), ("state", "waiting"))
        wish = {"do": "inject", "target": "v[1]", "change": "+=", "value": 1}
        for _ in range(1000):
            watched.session.ask(wish, refused.append)
        assert refused and "too much is wished" in refused[0].lower()
        until = time.monotonic() + 20
        while len(refused) < 1000 - 30 and time.monotonic() < until:
            watched.session.ask(wish, refused.append)
            time.sleep(0.01)
        assert any("30 faults are already" in text for text in refused)
        active = [m["active"] for m in watched.said if m["type"] == "faults"][-1]
        assert len(active) == 30
    finally:
        ours.close()
        watched.stop()
        theirs.close()
