"""A monitor on a real broker: whoever is killed, no sample and no verdict is lost."""

from __future__ import annotations

import re
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from bondgraph.runtime.monitoring.mqtt_client import address
from tests.unit.runtime.monitoring import motor
from tests.unit.runtime.monitoring.broker import Broker, Machine
from tests.unit.runtime.monitoring.watch import Watch, csv, objects, until

Start = Callable[..., Watch]


@contextmanager
def machine(broker: Broker, name: str = "machine") -> Iterator[Machine]:
    one = Machine(broker, name)
    try:
        yield one
    finally:
        one.close()


def samples(one: Machine, start: int, stop: int, step: int = 100) -> None:
    for k in range(start, stop, step):
        one.send(objects(motor.log(), k, k + step))


def listening(first: Watch, one: Machine) -> None:
    """Wait until the monitor hears the machine; before, a broker keeps nothing for it."""
    first.heard("start")

    def heard() -> bool:
        one.send("noise")
        return "invalid" in first.events()

    until(heard, "the subscription")


def words(broker: Broker, tmp_path: Path) -> list[str]:
    return [
        *("--mqtt", f"{broker.at}/motor/samples", "--publish", "motor/verdicts"),
        *("--journal", str(tmp_path / "j")),
    ]


def test_a_killed_monitor_misses_nothing_that_the_broker_kept(
    broker: Callable[..., Broker], tmp_path: Path, watch: Start
) -> None:
    at = broker(False)
    with machine(at) as one:
        first = watch(*words(at, tmp_path))
        listening(first, one)
        samples(one, 0, 4000)
        first.heard("update")
        first.kill()
        samples(one, 4000, 4800)  # nobody is there
        second = watch(*words(at, tmp_path))
        second.heard("warm-up")
        samples(one, 4800, 6000)
        one.send("end\n" * 4000)
        second.heard("invalid", "`end`")
        assert second.ended(signal.SIGTERM) == 0
        said = first.said + second.said
        until(lambda: len(one.numbers()) == len(said), "all verdicts")
        assert one.numbers() == [v["number"] for v in said] == list(range(1, len(said) + 1))
        assert [v["event"] for v in said if v["event"] != "invalid"] == [
            *("start", "warm-up", "warm-up", "fault", "update"),
            *("resumed", "warm-up", "stop"),
        ]
        resumed = second.heard("resumed")["message"]
        assert "still latched" in resumed
        assert next(v for v in one.verdicts if v["event"] == "fault") == first.heard("fault")
    with machine(at, "late") as late:
        until(lambda: late.retained)
        assert late.retained == [said[-1]]


@pytest.mark.parametrize("lasting", [True, False])
def test_a_killed_broker_loses_no_verdict(
    lasting: bool, broker: Callable[..., Broker], tmp_path: Path, watch: Start
) -> None:
    at = broker(lasting)
    with machine(at) as one:
        first = watch(*words(at, tmp_path))
        listening(first, one)
        samples(one, 0, 2800)
        one.send("middle\n" * 1000)
        first.heard("warm-up", "from now on")
        first.heard("invalid", "`middle`")
        until(lambda: one.numbers() == [v["number"] for v in first.said])
        at.kill()
        first.heard("gap", "gone")
        at.start()
        first.heard("gap", "back")
        until(lambda: one.ready)
        samples(one, 2800, 6000)
        one.send("end\n" * 4000)
        first.heard("fault")
        first.heard("invalid", "`end`")
        assert first.ended(signal.SIGTERM) == 0
        # A broker that was killed may send again what it had not put down as taken.
        count = re.search(r"after (\d+) samples", first.said[-1]["message"])
        assert count is not None and int(count[1]) >= 6000
        # What it took before the machine was back, and did not keep, it has told nobody.
        back = [v["number"] for v in first.said if v["event"] == "gap"]
        optional = set() if lasting else set(back)
        needed = {v["number"] for v in first.said} - optional
        until(lambda: set(one.numbers()) >= needed, "all verdicts")
        assert one.numbers() == sorted(one.numbers())


def test_verdicts_that_no_broker_took_are_sent_after_the_next_start(
    broker: Callable[..., Broker], tmp_path: Path, watch: Start
) -> None:
    at = broker(False)
    at.kill()
    (tmp_path / "log.csv").write_bytes(csv(motor.log(), header=True))
    more = ["--publish", f"{at.at}/motor/verdicts", "--journal", str(tmp_path / "j")]
    first = watch(str(tmp_path / "log.csv"), *more)
    assert first.ended() == 0
    assert "not taken" in first.errors and first.events()[-1] == "stop"
    at.start()
    with machine(at) as one:
        second = watch(str(tmp_path / "log.csv"), *more)
        assert second.ended() == 0 and second.errors == ""
        said = first.said + second.said
        until(lambda: len(one.numbers()) == len(said))
        assert one.verdicts == said


def test_all_forms_of_messages_are_read_and_old_ones_are_not(
    broker: Callable[..., Broker], watch: Start
) -> None:
    at = broker(False)
    log = motor.log()
    with machine(at) as one:
        one.send({"t": 77.0, "U": 1}, retain=True)
        names = ",".join(["t", *log.columns])
        first = watch("--mqtt", f"{at.at}/motor/samples", "--columns", names)
        listening(first, one)
        samples(one, 0, 1500)
        one.send(csv(log, 1500, 3000))
        for k in range(3000, 3200):
            one.send(objects(log, k, k + 1)[0])
        one.send(csv(log, 3200, 3600, header=True) + b"end\n" * 4000)
        first.heard("fault")
        first.heard("invalid", "`end`")
        assert first.ended(signal.SIGTERM) == 0
        assert "3600 samples" in first.said[-1]["message"]


@pytest.mark.parametrize("text", ["", "host", "host/", "/topic", "ftp://host/t", "host:x/t"])
def test_what_is_no_address_is_refused(text: str) -> None:
    with pytest.raises(ValueError):
        address(text)
