"""Many pages, some that do not read, a flood of wishes: python -m tests.live_flood.

One server of `bondgraph live` is asked for all that at once. Told are the frames that pages get
meanwhile, the longest time without one, the memory of the server, and how fast it ends.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import re
import resource
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple

import aiohttp

from tests.fuzz.connections import HANDSHAKE
from tests.measured import ROOT, write
from tests.unit.runtime.live.rover import written

_WISHES = (
    {"do": "inject", "target": "f[1]", "change": "*=", "value": 3},
    {"do": "clear"},
    {"do": "inject", "target": "v[1]", "change": "+=", "value": 1e200},
    {"do": "no such thing"},
)


class Found(NamedTuple):
    """Of one run: what pages that read saw, the most memory in MB, the time of the end in s."""

    pages: int
    refused: int  # of the pages and hosts from elsewhere
    foreign: int  # how many of those there were
    frames: list[int]  # of each page that reads
    gap: float  # s, the longest without a frame, of any page that reads
    seconds: float
    wishes: int  # that the flood got rid of
    before: float  # MB
    most: float  # MB
    end: float  # s from SIGTERM to the end
    status: int
    said: str


class _Reader:
    """A page that reads."""

    def __init__(self) -> None:
        self.frames, self.last, self.gap = 0, 0.0, 0.0

    async def run(self, session: aiohttp.ClientSession, address: str) -> None:
        async with session.ws_connect(f"{address}ws", max_msg_size=0, autoping=True) as page:
            async for message in page:
                if str(message.data).startswith('{"type": "frame"'):
                    now = time.monotonic()
                    if self.frames:
                        self.gap = max(self.gap, now - self.last)
                    self.frames, self.last = self.frames + 1, now


class _Flood:
    """Wishes as fast as they go through, from one page that does not read."""

    def __init__(self) -> None:
        self.sent = 0

    async def run(self, session: aiohttp.ClientSession, address: str, count: int) -> None:
        with suppress(aiohttp.ClientError, ConnectionError):
            async with session.ws_connect(f"{address}ws", max_msg_size=0) as page:
                texts = [json.dumps(w) for w in _WISHES]
                for k in range(count):
                    await page.send_str(texts[k % len(texts)])
                    self.sent += 1


def _silent(port: int, words: str) -> socket.socket:
    """A connection that says something and never reads."""
    made = socket.socket()
    made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    made.connect(("127.0.0.1", port))
    made.sendall(words.encode())
    return made


async def _elsewhere(session: aiohttp.ClientSession, address: str) -> list[int]:
    """The answers to pages of other origins and requests under other names."""
    found = []
    for origin in ("http://evil.example", "null", "http://127.0.0.1:1"):
        try:
            async with session.ws_connect(f"{address}ws", headers={"Origin": origin}):
                found.append(101)
        except aiohttp.WSServerHandshakeError as error:
            found.append(error.status)
    for host in ("evil.example", "evil.example:8420"):
        async with session.get(address, headers={"Host": host}) as answer:
            found.append(answer.status)
    return found


def _memory(process: subprocess.Popen[str]) -> float:
    text = Path(f"/proc/{process.pid}/status").read_text()
    return int(re.search(r"VmRSS:\s+(\d+)", text)[1]) / 1024  # type: ignore[index]


async def _load(
    process: subprocess.Popen[str], address: str, viewers: int, silent: int, wishes: int, s: float
) -> Found:
    port = int(address.rsplit(":", 1)[1].strip("/"))
    connector = aiohttp.TCPConnector(limit=0)
    async with aiohttp.ClientSession(connector=connector) as session:
        alone = _Reader()
        tasks = [asyncio.create_task(alone.run(session, address))]
        while alone.frames < 60:  # until all that it needs is loaded
            await asyncio.sleep(0.05)
        before = _memory(process)
        readers = [_Reader() for _ in range(viewers - silent)]
        tasks += [asyncio.create_task(r.run(session, address)) for r in readers]
        mute = [_silent(port, HANDSHAKE.format(port=port)) for _ in range(silent)]
        mute += [_silent(port, "GET / HT") for _ in range(20)]  # a request that never ends
        start = time.monotonic()
        while min(r.frames for r in readers) < 1 and time.monotonic() - start < 30:
            await asyncio.sleep(0.05)
        for reader in readers:
            reader.frames, reader.gap, reader.last = 0, 0.0, time.monotonic()
        flood = _Flood()
        tasks.append(asyncio.create_task(flood.run(session, address, wishes)))
        start, most = time.monotonic(), before
        foreign = await _elsewhere(session, address)
        while time.monotonic() - start < s:
            await asyncio.sleep(0.2)
            most = max(most, _memory(process))
        now = time.monotonic()
        frames = [r.frames for r in readers]
        gap = max(max(r.gap, now - r.last) for r in readers)
        start = time.monotonic()
        process.send_signal(signal.SIGTERM)
        said, _ = await asyncio.to_thread(process.communicate, timeout=60)
        end = time.monotonic() - start
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        for one in mute:
            one.close()
    refused = sum(answer == 403 for answer in foreign)
    return Found(viewers, refused, len(foreign), frames, gap, now - start + end, flood.sent, before,
                 most, end, process.returncode, said)._replace(seconds=s)  # fmt: skip


@contextmanager
def served(folder: Path) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """A server of the rover in a process of its own, and its address."""
    model, scenario = written(folder)
    words = ["live", str(model), str(scenario), "--port", "0", "--no-browser"]
    process = subprocess.Popen(
        [sys.executable, "-m", "bondgraph", *words],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    try:
        assert process.stdout is not None
        found = re.search(r"http://127\.0\.0\.1:\d+/", process.stdout.readline())
        assert found is not None
        yield process, found[0]
    finally:
        process.kill()
        process.wait()
        assert process.stdout is not None
        process.stdout.close()


def flood(folder: Path, viewers: int, silent: int, wishes: int, seconds: float) -> Found:
    """Start a server, ask too much of it, end it."""
    with served(folder) as (process, address):
        return asyncio.run(_load(process, address, viewers, silent, wishes, seconds))


def table(found: Found) -> str:
    """What was found, for a page of the documentation."""
    frames = sorted(found.frames)
    rows = [
        ("pages at once", f"{found.pages}, of which {found.pages - len(frames)} do not read"),
        ("wishes of a flood, until its own buffers were full", f"{found.wishes}"),
        ("pages and names from elsewhere that were refused", f"{found.refused} of {found.foreign}"),
        ("frames a second, of 20: the median page, the worst one",
         f"{frames[len(frames) // 2] / found.seconds:.1f}, {frames[0] / found.seconds:.1f}"),
        ("longest time without a frame, any page that reads", f"{found.gap:.2f} s"),
        ("memory before, and at most", f"{found.before:.0f} MB, {found.most:.0f} MB"),
        ("from SIGTERM to the end", f"{found.end:.2f} s"),
    ]  # fmt: skip
    return "\n".join(["| | |", "|---|---|", *[f"| {a} | {b} |" for a, b in rows]])


def main() -> int:
    """Run once and tell; the exit status is 1 where the server did not end by itself."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--viewers", type=int, default=500)
    parser.add_argument("--silent", type=int, default=30)
    parser.add_argument("--wishes", type=int, default=200_000)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--write", action="store_true", help="put the table into docs/trust.md")
    args = parser.parse_args()
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(max(soft, 4096), hard), hard))
    with tempfile.TemporaryDirectory() as folder:
        found = flood(Path(folder), args.viewers, args.silent, args.wishes, args.seconds)
    print(table(found))
    print(found.said, end="")
    if args.write:
        write(ROOT / "docs" / "trust.md", "python -m tests.live_flood --write", table(found))
    return 0 if found.status == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
