"""Hub, server and session: who is told what, and who is not let in."""

from __future__ import annotations

import asyncio
import json
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from threading import Event, Thread
from typing import Any

import pytest
from aiohttp import WSMsgType, WSServerHandshakeError
from aiohttp.test_utils import TestClient, TestServer

from bondgraph.cli import live as command
from bondgraph.cli import usage
from bondgraph.cli.main import main
from bondgraph.cli.options import model_of
from bondgraph.runtime.live.audience import talk
from bondgraph.runtime.live.hub import Hub
from bondgraph.runtime.live.samples import Simulated
from bondgraph.runtime.live.server import PortTaken, application, listening
from bondgraph.runtime.live.session import Session
from bondgraph.runtime.live.setup import Setup, Target, wish
from bondgraph.runtime.log_numbers import Form
from bondgraph.runtime.monitoring.sources.streams import Pipe
from bondgraph.runtime.simulation.scenario import Scenario
from tests.unit.runtime.live.rover import rover, written

FILES = {"/": ("text/html", "<title>x</title>"), "/a.js": ("text/javascript", "1")}


def _frame(t: float) -> dict[str, Any]:
    return {"type": "frame", "t": t, "real": {"p": [t, 0.0]}, "virtual": {"p": []},
            "desired": {"p": [None, 1.0]}}  # fmt: skip


def _verdict(k: int) -> dict[str, Any]:
    return {"type": "verdict", "number": k}


# ------------------------------------------------------------------------------ hub


def test_a_slow_page_loses_frames_but_no_verdict() -> None:
    async def run() -> None:
        hub = Hub({"type": "hello"})
        viewer = hub.join()
        assert json.loads(await viewer.next())["type"] == "hello"
        for k in range(500):
            hub.publish(_frame(k))
            if k % 100 == 0:
                hub.publish(_verdict(k))
        seen = [json.loads(await viewer.next()) for _ in range(5 + 40)]
        assert [m["type"] for m in seen] == 5 * ["verdict"] + 40 * ["frame"]
        assert [m["number"] for m in seen[:5]] == [0, 100, 200, 300, 400]
        assert [m["t"] for m in seen[5:]] == list(range(460, 500))
        assert viewer.dropped == 460

    asyncio.run(run())


def test_a_page_that_comes_later_knows_what_was_before() -> None:
    async def run() -> None:
        hub = Hub({"type": "hello"})
        for k in range(3000):
            hub.publish(_frame(float(k)))
        hub.publish(_verdict(1))
        hub.publish({"type": "state", "state": "running"})
        hub.publish({"type": "faults", "active": ["f"]})
        told = json.loads(await hub.join().next())
        assert told["verdicts"] == [_verdict(1)] and told["active"] == ["f"]
        assert told["state"]["state"] == "running"
        assert [f["t"] for f in told["frames"]] == list(range(2600, 3000))
        path = told["paths"]["real"]
        assert len(path) <= 1200 and path[0][0] < 10 and path[-1][0] > 2990
        assert told["paths"]["desired"] == []
        hub.publish({"type": "reset"})
        told = json.loads(await hub.join().next())
        assert told["frames"] == told["verdicts"] == told["paths"]["real"] == []

    asyncio.run(run())


# --------------------------------------------------------------------------- server


def _served(
    test: Callable[[TestClient[Any, Any], Hub, list[dict[str, Any]]], Any], token: str = ""
) -> None:
    async def run() -> None:
        hub, wishes = Hub({"type": "hello"}), []
        app = application(FILES, {"/ws": talk(hub, lambda wish, _: wishes.append(wish))}, token)
        async with TestClient(TestServer(app, host="127.0.0.1")) as client:
            await test(client, hub, wishes)

    asyncio.run(run())


def test_files_and_nothing_else() -> None:
    async def look(client: TestClient[Any, Any], hub: Hub, wishes: list[Any]) -> None:
        page = await client.get("/")
        assert page.status == 200 and await page.text() == "<title>x</title>"
        policy = page.headers["Content-Security-Policy"]
        assert "default-src 'none'" in policy and "unsafe" not in policy
        assert (await client.get("/a.js")).content_type == "text/javascript"
        for path in ("/../pyproject.toml", "/%2e%2e/pyproject.toml", "/b.js", "/a.js/"):
            assert (await client.get(path)).status == 404
        assert (await client.post("/")).status == 405

    _served(look)


def test_pages_from_elsewhere_are_not_let_in() -> None:
    async def look(client: TestClient[Any, Any], hub: Hub, wishes: list[Any]) -> None:
        assert (await client.get("/", headers={"Host": "evil.example"})).status == 403
        assert (await client.get("/", headers={"Host": "evil.example:80"})).status == 403
        for origin in ("http://evil.example", "null", "http://127.0.0.1:1"):
            with pytest.raises(WSServerHandshakeError) as refused:
                await client.ws_connect("/ws", headers={"Origin": origin})
            assert refused.value.status == 403
        own = f"http://127.0.0.1:{client.port}"
        await (await client.ws_connect("/ws", headers={"Origin": own})).close()

    _served(look)


def test_several_pages_and_what_they_wish() -> None:
    async def look(client: TestClient[Any, Any], hub: Hub, wishes: list[Any]) -> None:
        one, two = await client.ws_connect("/ws"), await client.ws_connect("/ws")
        for page in (one, two):
            assert (await page.receive_json())["type"] == "hello"
        hub.publish(_verdict(7))
        for page in (one, two):
            assert (await page.receive_json())["number"] == 7
        for text in ("no json", "[1]", '"x"', "{" * 3000, '{"do": "clear"}'):
            await two.send_str(text)
        while not wishes:
            await asyncio.sleep(0.005)
        assert wishes == [{"do": "clear"}]
        await two.send_str("x" * 10_000)  # too long for a wish: this page is sent away
        message = await two.receive()
        assert message.type in (WSMsgType.CLOSE, WSMsgType.CLOSED, WSMsgType.ERROR)
        hub.publish(_verdict(8))
        assert (await one.receive_json())["number"] == 8

    _served(look)


def test_a_port_that_is_taken() -> None:
    with listening("127.0.0.1", 0) as made:
        port = made.getsockname()[1]
        with pytest.raises(PortTaken, match=rf"port {port}: address already in use; .*--port"):
            listening("127.0.0.1", port)
    with pytest.raises(PortTaken, match="no address"):
        listening("no.such.host.invalid", 0)


# -------------------------------------------------------------------------- session


def rover_setup() -> Setup:
    """The rover watched without a scenario."""
    args = usage.parser_for("live").parse_args(["live", "rover.bg", "--log", "-"])
    return command.setup_of(args, rover(), Scenario("none"))


class Watched:
    """A session over samples that the test writes, or a command prints, and what it says."""

    def __init__(self, folder: Path, source: Callable[[], Any], renews: bool, speed: float | None):
        model, scenario = written(folder)
        args = usage.parser_for("live").parse_args(["live", str(model), str(scenario)])
        compilation = rover()
        made: Setup = command.setup_of(args, compilation, compilation.scenario(scenario))
        made = made._replace(source=source, renews=renews, speed=speed)
        targets = {t.name: t for t in command.targets(compilation.graph)}
        self.said: list[dict[str, Any]] = []
        self.session = Session(made, targets, self.said.append)
        self._thread = Thread(target=self.session.run)
        self._thread.start()

    def wait(self, *want: tuple[str, Any]) -> dict[str, Any]:
        """The first message with these entries."""
        until = time.monotonic() + 30
        while time.monotonic() < until:
            for message in list(self.said):
                if all(message.get(k) == v for k, v in want):
                    return message
            time.sleep(0.01)
        raise AssertionError((want, self.said[-3:]))

    def stop(self) -> None:
        """End it."""
        self.session.stop("the test")
        self._thread.join(20)
        assert not self._thread.is_alive()


def _command(code: str) -> Callable[[], Simulated]:
    return lambda: Simulated([sys.executable, "-c", code], "simulated machine")


ROWS = """
import sys
print("t,F[1],F[2],turn[1],turn[2],v[1],v[2]")
for k in range(N):
    print(f"{k/200},0,0,0,0,0,0")
sys.stdout.flush()
"""


def test_a_machine_whose_process_dies(tmp_path: Path) -> None:
    code = ROWS.replace("N", "400") + "sys.exit('the battery is empty')"
    watched = Watched(tmp_path, _command(code), True, 100.0)
    try:
        told = watched.wait(("type", "verdict"), ("event", "gap"))
        assert "simulated machine has ended: the battery is empty (status 1)" in told["message"]
        watched.wait(("type", "state"), ("state", "ended"))
        last = [m for m in watched.said if m["type"] == "frame"][-1]
        assert last["t"] == pytest.approx(399 / 200)
        watched.said.clear()
        watched.session.ask({"do": "reset"})
        watched.wait(("type", "frame"))  # it has been started again
    finally:
        watched.stop()


def test_the_simulated_machine_has_the_numbers_of_the_watch(tmp_path: Path) -> None:
    """1 V over a resistor of 4 ohm, which is 2 ohm in the model, and then 1 ohm in a file."""
    model, scenario, file = (tmp_path / name for name in ("r.bg", "r.toml", "numbers.toml"))
    model.write_text("bg 1\nmodel M { param R = 2 Ohm; 1:i { <- Se:U; -> R:R; -> Df:y } }\n")
    scenario.write_text('duration = "50 ms"\n[inputs]\nU = 1\n')
    file.write_text("[parameters]\nR = 1\n")
    for words, current in ((["--set", "R=4000 mOhm"], 0.25), (["--parameters", str(file)], 1.0)):
        args = usage.parser_for("live").parse_args(["live", str(model), str(scenario), *words])
        made = command.setup_of(args, model_of(args), model_of(args).scenario(scenario))
        source = made.source()
        try:
            logs = (c.log for c in source.chunks(Event()) if c.log is not None and c.log.rows)
            first = next(logs)  # it goes on for as long as it is heard
        finally:
            source.close()
        assert first.columns["y"][-1] == pytest.approx(current)


def test_a_machine_that_never_says_anything(tmp_path: Path) -> None:
    watched = Watched(tmp_path, _command("raise SystemExit('no cable')"), True, 1.0)
    try:
        told = watched.wait(("type", "state"), ("state", "ended"))
        assert "no samples came" in told["text"]
        assert "no cable" in watched.wait(("event", "gap"))["message"]
    finally:
        watched.stop()


def test_samples_without_a_column_are_told(tmp_path: Path) -> None:
    code = 'print("t,F[1],turn[1],turn[2],v[1],v[2]"); print("0,0,0,0,0,0")'
    watched = Watched(tmp_path, _command(code), True, 1.0)
    try:
        told = watched.wait(("type", "state"), ("state", "ended"))
        assert "no column for F[2]" in told["text"]
    finally:
        watched.stop()


def _drive(ours: socket.socket, watched: Watched, start: int, stop: int) -> None:
    """Samples as the twin can follow them: of a burst of a real machine it leaves some out."""
    for k in range(start, stop, 100):
        rows = [f"{j / 200},1,1,0,0,0,0" for j in range(k, k + 100)]
        ours.sendall("\n".join([*rows, ""]).encode())
        watched.wait(("type", "frame"), ("t", (k + 99) / 200))


def test_faults_are_injected_refused_and_taken_back(tmp_path: Path) -> None:
    ours, theirs = socket.socketpair()
    name = "a wire"
    watched = Watched(tmp_path, lambda: Pipe(Form(name), theirs.fileno(), name), False, None)
    session = watched.session
    try:
        ours.sendall(b"t,F[1],F[2],turn[1],turn[2],v[1],v[2]\n")
        _drive(ours, watched, 0, 3000)
        session.ask({"do": "inject", "target": "f[1]", "change": "*=", "value": 9})
        assert watched.wait(("type", "faults"), ("active", ["f[1] × 9"]))
        _drive(ours, watched, 3000, 4800)
        watched.wait(("whose", "virtual"), ("event", "fault"))
        verdict = watched.wait(("whose", "virtual"), ("event", "update"))
        assert verdict["fired"] == ["r1"] and "f[1]" in verdict["group"]
        session.ask({"do": "inject", "target": "turn[2]", "change": "+=", "value": -0.5})
        watched.wait(("type", "faults"), ("active", ["f[1] × 9", "turn[2] − 0.5 rad"]))
        session.ask({"do": "inject", "fault": 0})
        watched.wait(("active", ["f[1] × 9", "turn[2] − 0.5 rad", "brake drags"]))
        for wish in (
            {"do": "inject", "fault": 1}, {"do": "inject", "fault": "0"}, {"do": "inject"},
            {"do": "inject", "target": "f[1]", "change": "stuck"},
            {"do": "inject", "target": "f[1]", "change": "*=", "value": "9"},
            {"do": "inject", "target": "f[1]", "change": "*=", "value": True},
            {"do": "inject", "target": ["f"], "change": "*=", "value": 2},
            {"do": "inject", "target": "F[1]", "change": "missing"},
            {"do": "inject", "target": "f[1]", "change": "^", "value": 2},
            {"do": "pause"}, {"do": ["x"]}, {},
        ):  # fmt: skip
            watched.said.clear()
            session.ask(wish)
            watched.wait(("type", "refused"))
        session.ask({"do": "clear"})
        watched.wait(("type", "faults"), ("active", []))
        session.ask({"do": "reset"})  # a real machine goes on
        watched.wait(("type", "reset"))
        watched.said.clear()
        ours.sendall(b"24.0,1,1,0,0,0,0\n24.005,1,1,0,0,0,0\n24.01,1,1,0,0,0,0\n")
        frame = watched.wait(("type", "frame"))
        assert frame["virtual"]["p"][0] == pytest.approx(0.0, abs=1e-3)
    finally:
        ours.close()
        watched.stop()
        theirs.close()


def test_sizes_are_in_the_units_of_the_model() -> None:
    volts = Target("U", "input", "mV", 1e-3, None)
    fault = wish({"target": "U", "change": "+=", "value": 250}, (), {"U": volts})
    assert not isinstance(fault, str)
    assert (fault.op, fault.value, fault.label) == ("+=", 0.25, "U + 250 mV")
    kinds = {t.name: (t.kind, t.unit, t.value) for t in command.targets(rover().graph)}
    assert kinds["f[1]"] == ("param", "N.s/m", 2.0)
    assert kinds["F[2]"] == ("input", "N", None)
    assert kinds["turn[1]"] == ("sensor", "rad", None)


def test_without_aiohttp_one_line_says_what_to_do(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "aiohttp", None)
    monkeypatch.delitem(sys.modules, "bondgraph.runtime.live.server")
    assert main(["live", "rover.bg", "--log", "-"]) == 1
    said = capsys.readouterr().err
    assert "needs aiohttp" in said and said.count("\n") == 1


@pytest.mark.parametrize(
    ("words", "wrong"),
    [
        (["rover.bg"], "nothing moves"),
        (["rover.bg", "--log", "-", "--serial", "x"], "not from --log and --serial"),
        (["rover.bg", "s.toml", "--follow"], "--follow needs --log"),
        (["rover.bg", "s.toml", "--port", "70000"], "70000 is no port"),
    ],
)
def test_wrong_words(words: list[str], wrong: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["live", *words]) == 2
    assert wrong in capsys.readouterr().err


def test_a_stream_ends_when_nobody_reads_it(tmp_path: Path) -> None:
    model, scenario = written(tmp_path)
    words = [sys.executable, "-m", "bondgraph", "simulate", str(model), str(scenario), "--stream"]
    with subprocess.Popen([*words, "--speed", "inf"], stdout=-1, stderr=-1, text=True) as process:
        assert process.stdout is not None and process.stderr is not None
        assert process.stdout.readline() == "t,F[1],F[2],turn[1],v[1],turn[2],v[2]\n"
        rows = [process.stdout.readline().strip().split(",") for _ in range(100)]
        assert [float(r[0]) for r in rows] == pytest.approx([k / 200 for k in range(100)])
        process.stdout.close()
        assert process.wait(20) == 0
        assert process.stderr.read() == ""


def test_small_portions_share_a_frame(tmp_path: Path) -> None:
    ours, theirs = socket.socketpair()
    watched = Watched(tmp_path, lambda: Pipe(Form("w"), theirs.fileno(), "w"), False, None)
    try:
        ours.sendall(b"t,F[1],F[2],turn[1],turn[2],v[1],v[2]\n")
        watched.wait(("type", "state"), ("state", "waiting"))
        start = time.monotonic()
        for k in range(200):
            ours.sendall(b"%f,1,1,0,0,0,%d\n" % (k / 200, k == 150))
            time.sleep(0.002)
        ours.close()
        watched.wait(("state", "ended"))
        frames = [m for m in watched.said if m["type"] == "frame"]
        assert len(frames) <= 2 + (time.monotonic() - start) * 25
        assert frames[-1]["t"] == pytest.approx(199 / 200)
        assert "after 200 samples" in watched.wait(("event", "stop"))["message"]
    finally:
        watched.stop()
        theirs.close()
