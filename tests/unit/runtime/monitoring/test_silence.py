"""A live source that gives nothing: from a pipe, a growing file, a serial port and a broker."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from threading import Event, Thread
from typing import Any

import pytest

from bondgraph.runtime.monitoring.recurrence import Recurrence
from bondgraph.runtime.monitoring.silence import Silence
from tests.unit.runtime.monitoring import motor
from tests.unit.runtime.monitoring.broker import Broker, Machine
from tests.unit.runtime.monitoring.test_serial import Device
from tests.unit.runtime.monitoring.watch import Watch, csv, until

Start = Callable[..., Watch]
Send = Callable[[bytes], object]

_SOON = ("--silence", "0.5")


@contextmanager
def fed(kind: str, tmp_path: Path, watch: Start, broker: Callable[..., Broker],
        *words: str) -> Iterator[tuple[Watch, Send]]:  # fmt: skip
    """A watch of a source of some kind, and how it is sent lines."""
    head = ",".join(["t", *motor.log().columns])
    if kind == "pipe":
        one = watch("-", "--columns", head, *words)
        yield one, one.feed
    elif kind == "file":
        path = tmp_path / "log.csv"
        path.write_bytes(head.encode() + b"\n")
        one = watch(str(path), "--follow", *words)

        def add(data: bytes) -> None:
            with path.open("ab") as file:
                file.write(data)

        yield one, add
    elif kind == "serial":
        device = Device(tmp_path / "port")
        one = watch("--serial", str(device.name), "--columns", head, *words)
        one.heard("start")
        device.send(b"\n")  # the end of a line that was joined in the middle
        yield one, device.send
        one.kill()
        device.unplug()
    else:
        at = broker()
        machine = Machine(at, "machine")
        one = watch("--mqtt", f"{at.at}/motor/samples", "--columns", head, *words)

        def heard() -> bool:
            machine.send("noise\n")
            return "invalid" in one.events()

        one.heard("start")
        until(heard, "the subscription")
        yield one, machine.send
        one.kill()
        machine.close()


def _read(one: Watch) -> int:
    """How many samples had been read by the last heartbeat."""
    return int([v for v in one.said if v["event"] == "heartbeat"][-1]["account"]["samples"]["read"])


KINDS = pytest.mark.parametrize("kind", ["pipe", "file", "serial", "mqtt"])


@KINDS
def test_a_source_that_falls_silent_is_told_and_so_is_its_return(
    kind: str, tmp_path: Path, watch: Start, broker: Callable[..., Broker]
) -> None:
    log = motor.log(6.0, 1.0)
    with fed(kind, tmp_path, watch, broker, *_SOON, "--heartbeat", "0.3") as (one, send):
        send(csv(log, 0, 2800))
        one.heard("warm-up", "from now on")
        told = one.heard("gap", "no sample for")
        assert "on the clock of this computer; all residuals are blind" in told["message"]
        silent = one.heard("heartbeat", "blind: no sample for")
        assert {s["state"] for s in silent["account"]["states"].values()} == {"blind"}
        send(csv(log, 3600, 6000))
        one.heard("gap", "samples come again, after")
        assert "800 samples lost" in one.heard("gap", "lost")["message"]
        until(lambda: _read(one) == 5200, "the last sample")
        one.heard("heartbeat", "r1, r2 healthy")
        assert one.ended(signal.SIGTERM) == 0
    account = one.said[-1]["account"]
    assert account["samples"]["read"] == account["samples"]["used"] == 5200
    assert account["lines"]["gaps"] == 1 and account["lines"]["lost"] == 800
    gaps = [v["message"] for v in one.said if v["event"] == "gap"]
    assert len([g for g in gaps if g.startswith("no sample")]) <= 3


@KINDS
def test_lines_that_are_none_and_a_clock_that_stands_still_are_silence_too(
    kind: str, tmp_path: Path, watch: Start, broker: Callable[..., Broker]
) -> None:
    log = motor.log(6.0, 1.0)
    rows = csv(log, 2800, 6000).splitlines(keepends=True)
    with fed(kind, tmp_path, watch, broker, *_SOON) as (one, send):
        send(csv(log, 0, 2800))
        one.heard("warm-up", "from now on")
        with repeated(send, b"broken\n"):
            one.heard("gap", "but lines that are none")
        send(csv(log, 2800, 2801))
        one.heard("gap", "come again")
        still = [b"2.8," + row.split(b",", 1)[1] for row in rows]
        with repeated(send, *[b"".join(still[k : k + 40]) for k in range(1, 3200, 40)]):
            one.heard("gap", "the clock of the device stands still")
            one.heard("late", "with the time of the one before")
        assert one.ended(signal.SIGTERM) == 0
    assert {s["state"] for s in one.said[-1]["account"]["states"].values()} == {"blind"}


@contextmanager
def repeated(send: Send, *parts: bytes) -> Iterator[None]:
    """Something sent again and again while others wait."""
    over = Event()

    def run() -> None:
        k = 0
        while not over.wait(0.02):
            send(parts[k % len(parts)])
            k += 1

    thread = Thread(target=run)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


def test_a_source_that_never_gives_anything_is_told(watch: Start) -> None:
    one = watch("-", *_SOON)
    one.heard("gap", "no sample for")
    assert one.ended() == 1
    assert "no samples came" in one.errors


def test_usual_pauses_are_no_silence_and_long_silence_is_no_flood() -> None:
    one = Silence(2.0, 0.001, 0.0)
    now, told = 0.0, 0
    for _ in range(30):  # a message each ten seconds
        for _ in range(50):
            now += 0.2
            told += one.due(now) > 0.0
        one.heard(now)
    assert told == 4 and one.limit == pytest.approx(30.0)
    words = []
    for _ in range(500_000):
        now += 0.2
        if lasts := one.due(now):
            words.append(lasts)
    assert words == pytest.approx([30.2, 302.0, 3020.0, 30200.0], rel=0.01)
    assert one.heard(now) > 90_000.0


def test_how_long_a_silence_was_is_known_where_it_was_told() -> None:
    one = Silence(2.0, 0.5, 10.0)
    assert (one.due(12.0), one.heard(12.5), one.told) == (0.0, 0.0, False)
    assert (one.due(14.0), one.due(15.0), one.told) == (0.0, 2.5, True)
    assert (one.heard(15.5), one.told, one.heard(18.5)) == (3.0, False, 0.0)
    assert (one.lasts(19.5), one.lasts(18.0)) == (1.0, 0.0)
    slow = Silence(2.0, 1.0, 0.0)  # three steps of its samples
    assert (slow.limit, slow.due(3.0), slow.due(3.1)) == (3.0, 0.0, 3.1)


def test_a_single_stall_is_no_usual_pause() -> None:
    one = Silence(2.0, 0.001, 0.0)
    for k in range(1, 100):
        one.heard(0.1 * k + (300.0 if k > 50 else 0.0))
        assert one.limit == 2.0


def test_what_recurs_is_told_at_first_doubled_and_each_while() -> None:
    one, told = Recurrence(), []
    for second in range(7200):
        one.add(1000, float(second))
        if count := one.due(float(second)):
            told.append((second, count))
    assert [s for s, _ in told[:6]] == [0, 1, 3, 7, 15, 31]
    assert len(told) < 20
    assert max(b - a for (a, _), (b, _) in pairwise(told)) <= 3600
    assert one.due(9e9) > 0  # what was not told yet
    one.add(1, 9e9 + 100.0)
    assert one.due(9e9 + 100.0) == 1  # anew
    one.add(1, 5.0)
    assert one.due(5.0) == 1  # the clock has gone back


def test_a_slow_computation_is_no_silence(watch: Start) -> None:
    log = motor.log()
    one = watch("-", "--silence", "0.05")
    one.feed(csv(log, 0, 10, header=True))
    one.heard("gap", "no sample for")  # it does listen
    one.feed(csv(log, 10, 6000))
    one.heard("gap", "come again")
    assert one.ended() == 0
    at = [k for k, v in enumerate(one.said) if "no sample" in v["message"]]
    assert all(one.said[k]["time"] in (0.009, 0.0) for k in at[:1])


def test_heartbeats_are_said_and_count_as_no_verdict(tmp_path: Path, watch: Start) -> None:
    log, journal = motor.log(), tmp_path / "journal"
    one = watch("-", "--heartbeat", "0.2", "--journal", str(journal))
    for k in range(0, 6000, 500):
        one.feed(csv(log, k, k + 500, header=k == 0))
        time.sleep(0.2)
    assert one.ended() == 0
    beats = [v for v in one.said if v["event"] == "heartbeat"]
    rest: list[dict[str, Any]] = [v for v in one.said if v["event"] != "heartbeat"]
    assert len(beats) >= 3
    assert [v["number"] for v in rest] == list(range(1, len(rest) + 1))
    assert b"heartbeat" not in journal.read_bytes().replace(b'"heartbeat": {', b"")
    reads = [v["account"]["samples"]["read"] for v in beats]
    assert reads == sorted(reads) and reads[-1] > 1000
    assert one.said[-1]["account"]["verdicts"].get("heartbeat") is None
