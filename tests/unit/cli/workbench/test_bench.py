"""The server of the workbench without a browser: floods, pages from elsewhere, saving, the end."""

from __future__ import annotations

import asyncio
import json
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import aiohttp
import pytest
from aiohttp import WSServerHandshakeError

import bondgraph
from bondgraph.cli.main import main
from bondgraph.cli.workbench.bench import OnDisk
from bondgraph.cli.workbench.starts import starts
from bondgraph.cli.workbench.trial import trial
from bondgraph.text.diagnostic import CompileError
from tests.unit.cli.workbench.pages import Workbench

MODEL = "bg 1\nmodel M { param R = 2 Ohm; Se:U -> 1:i; i -> R:R; i -> Df:y }\n"


def _read(address: str, talk: Any) -> Any:
    """What happens on a WebSocket of the page."""

    async def run() -> Any:
        async with (
            aiohttp.ClientSession() as session,
            session.ws_connect(f"{address}ws", max_msg_size=0) as page,
        ):
            return await talk(session, page)

    return asyncio.run(run())


async def _until(page: Any, kind: str, version: int | None = None) -> dict[str, Any]:
    while True:
        message: dict[str, Any] = json.loads((await asyncio.wait_for(page.receive(), 60)).data)
        if message["type"] == kind and version in (None, message.get("version")):
            return message


@pytest.fixture
def bench(tmp_path: Path) -> Any:
    """A server of a small model."""
    file = tmp_path / "m.bg"
    file.write_text(MODEL)
    served = Workbench(file)
    try:
        yield served
    finally:
        served.close()


def test_a_flood_of_texts_is_answered_by_the_newest(bench: Workbench) -> None:
    async def talk(session: Any, page: Any) -> tuple[int, dict[str, Any]]:
        await _until(page, "hello")
        for k in range(1, 301):
            text = MODEL.replace("2 Ohm", f"{k} Ohm")
            await page.send_json({"do": "look", "version": k, "text": text, "model": ""})
        await page.send_str("no wish at all")
        await page.send_json({"do": "look", "version": "x", "text": 7, "model": None})
        sketches = 0
        while True:
            message = json.loads((await asyncio.wait_for(page.receive(), 60)).data)
            sketches += message["type"] == "sketch"
            if message["type"] == "derived":
                return sketches, message

    sketches, last = _read(bench.address, talk)
    assert last["version"] == 300 and last["status"] == "ok"
    assert sketches < 300  # what was stale by the time that it could be begun was left out
    assert last["targets"][0] == {
        "name": "R", "kind": "param", "unit": "Ohm", "factor": 1.0, "value": 300.0,
    }  # fmt: skip


def test_derivations_are_answered_beside_a_run(bench: Workbench) -> None:
    async def talk(session: Any, page: Any) -> dict[str, Any]:
        await page.send_json({"do": "look", "version": 1, "text": MODEL, "model": ""})
        await _until(page, "derived", 1)
        await page.send_json({"do": "run", "id": 7, "scenario": "duration = 1\n", "faults": []})
        for name in ("r1", "r9", 5):
            await page.send_json({"do": "derive", "name": name})
        found: dict[str, Any] = {}
        while len(found) < 3:
            message = json.loads((await asyncio.wait_for(page.receive(), 60)).data)
            found[message.get("name", message["type"])] = message
        return found

    found = _read(bench.address, talk)
    assert sorted(found) == ["r1", "r9", "run"] and found["run"]["id"] == 7
    ((part,),) = [found["r1"]["parts"]]
    assert part["ending"].startswith("SymPy agrees") and part["steps"][0]["node"] == "U"
    assert found["r9"]["parts"] == [] and "r9" in found["r9"]["message"]


def test_pages_from_elsewhere_are_refused(bench: Workbench) -> None:
    async def look() -> None:
        async with aiohttp.ClientSession() as session:
            for path in ("ws", "lsp"):
                with pytest.raises(WSServerHandshakeError) as refused:
                    await session.ws_connect(bench.address + path, origin="http://evil.example")
                assert refused.value.status == 403
            other = {"Host": "evil.example"}
            async with session.get(bench.address, headers=other) as answer:
                assert answer.status == 403
            async with session.get(bench.address) as answer:
                policy = answer.headers["Content-Security-Policy"]
                assert "default-src 'none'; script-src 'self'; style-src 'self' 'nonce-" in policy
                assert "unsafe" not in policy

    asyncio.run(look())


def test_it_ends_within_a_second_whatever_it_does(tmp_path: Path) -> None:
    file = tmp_path / "robot.bg"
    file.write_text(Path("models/khepera.bg").read_text())
    served = Workbench(file)

    async def talk(session: Any, page: Any) -> float:
        await _until(page, "hello")
        text = file.read_text()
        await page.send_json({"do": "look", "version": 1, "text": text, "model": ""})
        await _until(page, "sketch", 1)  # residuals of the robot are being derived now
        async with session.ws_connect(f"{served.address}lsp") as language:
            await language.send_json({"jsonrpc": "2.0", "id": 1, "method": "initialize",
                                      "params": {"capabilities": {}, "processId": None,
                                                 "rootUri": None}})  # fmt: skip
            await asyncio.wait_for(language.receive(), 60)
            start = time.monotonic()
            served.server.send_signal(signal.SIGTERM)
            await asyncio.to_thread(served.server.wait, 20)
            return time.monotonic() - start

    try:
        assert _read(served.address, talk) < 1.5  # a second, and what a busy machine adds
        assert served.server.returncode == 0
        assert served.server.stdout is not None and served.server.stdout.read() == "stopped\n"
    finally:
        served.close()


def test_a_file_is_saved_formatted_or_not_at_all(tmp_path: Path) -> None:
    file = tmp_path / "m.bg"
    disk = OnDisk(str(file))
    assert (disk.text, disk.digest) == ("", "")
    found = disk.save("bg 1\nmodel M{1:j{<-Se:U;->R:r=2}}", "")
    assert found == "bg 1\nmodel M { 1:j { <- Se:U; -> R:r = 2 } }\n"
    assert file.read_text() == found and main(["format", "--check", str(file)]) == 0
    seen = disk.digest
    with pytest.raises(CompileError):
        disk.save("bg 1\nmodel {", seen)
    file.write_text("bg 1\nmodel Theirs {}\n")
    assert disk.save("bg 1\nmodel Mine {}\n", seen) is None
    assert file.read_text() == "bg 1\nmodel Theirs {}\n" and disk.text == file.read_text()
    file.unlink()
    assert disk.changed() and disk.digest == ""
    assert disk.save("bg 1\nmodel Mine {}\n", "") == "bg 1\nmodel Mine {}\n"
    assert not disk.changed()


def test_what_is_no_model_to_edit_is_told_in_a_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "big.bg").write_text("#" * 1_000_001)
    (tmp_path / "raw.bg").write_bytes(b"bg 1\0")
    for name, words in (("big.bg", "1000000"), ("raw.bg", "zero bytes"), (".", "folder"),
                        ("no/such.bg", "no folder")):  # fmt: skip
        assert main(["edit", str(tmp_path / name), "--port", "0", "--no-browser"]) == 1
        said = capsys.readouterr().err
        assert words in said and "Traceback" not in said


def test_starts_are_models_that_stand_alone() -> None:
    found = starts()
    assert [s.name for s in found[:2]] == ["empty", "dc_motor"] and len(found) > 8
    for start in found[1:]:
        assert bondgraph.compile(text=start.text, open_ports=True).integral is not None


def test_a_run_says_what_is_wrong_with_its_settings() -> None:
    compilation = bondgraph.compile(text=MODEL)

    def told(**settings: Any) -> str:
        return str(trial(compilation, {"scenario": "duration = 1.0", **settings},
                         lambda _: None)["message"])  # fmt: skip

    assert "`V`" in told(scenario='[inputs]\nV = "1"')
    assert "no such parameter" in told(faults=[{"target": "nobody", "change": "*=", "value": 2}])
    assert "no number" in told(faults=[{"target": "R", "change": "*=", "value": 1e300}])
    assert "no number of seconds" in told(
        faults=[{"target": "R", "change": "*=", "value": 2, "at": "soon"}]
    )
    assert "at most 30" in told(faults=[{}] * 31)


def test_an_interrupt_ends_it_with_a_word(tmp_path: Path) -> None:
    (tmp_path / "m.bg").write_text(MODEL)
    command = [sys.executable, "-m", "bondgraph", "edit", "m.bg", "--port", "0", "--no-browser"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert "stop with ^C" in process.stdout.readline()
        process.send_signal(signal.SIGINT)
        assert process.stdout.read() == "stopped\n" and process.wait(20) == 0
