"""Verdicts on their way to a broker that takes its time, is away, or says no; without a broker."""

from __future__ import annotations

import time
from collections.abc import Callable
from threading import Timer
from types import SimpleNamespace
from typing import Any

import pytest

from bondgraph.runtime.log import LogError
from bondgraph.runtime.monitoring import mqtt_client
from bondgraph.runtime.monitoring.mqtt_client import Address, Link, Publisher, address


class _Client:
    """Numbers messages; says that one was taken when the test says so."""

    on_publish: Callable[..., None]

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.topics: list[str] = []
        self.early = False  # whether messages are taken before their number is known

    def publish(self, topic: str, line: str, qos: int, retain: bool) -> Any:
        assert (qos, retain) == (1, True)
        self.lines.append(line)
        self.topics.append(topic)
        if self.early:
            self.take(len(self.lines))
        return SimpleNamespace(mid=len(self.lines))

    def take(self, mid: int, failed: bool = False) -> None:
        self.on_publish(self, None, mid, SimpleNamespace(is_failure=failed), None)


class _Link:
    def __init__(
        self, at: Address, identity: str, say: Callable[[str], None], joined: object, will: object
    ) -> None:
        self.client = _Client()
        self.refused: LogError | None = None
        self.connected, self.away, self.stopped = True, False, False

    def start(self) -> None: ...

    def stop(self) -> None:
        self.stopped = True


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> tuple[Publisher, _Link]:
    links: list[_Link] = []

    def link(*given: Any, **named: Any) -> _Link:
        links.append(_Link(*given, **named))
        return links[0]

    monkeypatch.setattr(mqtt_client, "Link", link)
    return Publisher(address("here/robot/verdicts"), "me", taken=4), links[0]


def test_a_line_waits_until_all_before_it_are_taken(made: tuple[Publisher, _Link]) -> None:
    sender, link = made
    link.connected = False
    for number in (5, 6):
        sender.publish(number, f"line {number}")
    assert link.client.lines == [] and sender.taken == 4
    link.connected = True
    assert sender.news() == [] and link.client.lines == ["line 5", "line 6"]
    sender.publish(7, "line 7")
    assert link.client.lines == ["line 5", "line 6"]  # two are on their way
    link.client.take(2)
    assert sender.taken == 4  # the one before is not
    link.client.take(1)
    assert sender.taken == 6
    sender.news()
    assert link.client.lines[2:] == ["line 7"]


def test_the_end_waits_for_a_slow_broker(made: tuple[Publisher, _Link]) -> None:
    sender, link = made
    sender.publish(5, "line 5")
    Timer(0.2, link.client.take, [1]).start()
    assert sender.close(30.0) == 0
    assert sender.taken == 5 and link.stopped


def test_the_end_waits_no_longer_than_it_has_patience(made: tuple[Publisher, _Link]) -> None:
    sender, link = made
    sender.publish(5, "line 5")
    start = time.monotonic()
    assert sender.close(0.3) == 1
    assert time.monotonic() - start >= 0.3
    assert sender.taken == 4 and link.stopped


def test_a_broker_that_is_away_is_not_waited_for(made: tuple[Publisher, _Link]) -> None:
    sender, link = made
    link.connected, link.away = False, True
    sender.publish(5, "line 5")
    start = time.monotonic()
    assert sender.close(30.0) == 1
    assert time.monotonic() - start < 15.0


def test_how_the_monitor_is_stands_beside_its_verdicts(made: tuple[Publisher, _Link]) -> None:
    """Said at once where there is a connection, else with the next one, and then anew each time."""
    sender, link = made
    joined = sender._joined
    joined(link.client)  # there is nothing to say yet
    link.connected = False
    sender.present("watching")
    assert link.client.lines == []
    joined(link.client)
    link.connected = True
    sender.present("ended")
    joined(link.client)
    assert link.client.lines == ["watching", "ended", "ended"]
    assert set(link.client.topics) == {"robot/verdicts/monitor"}
    sender.publish(5, "line 5")
    assert link.client.topics[-1] == "robot/verdicts"


def test_the_end_waits_until_the_last_word_is_taken(made: tuple[Publisher, _Link]) -> None:
    sender, link = made
    sender.present("ended")
    start = time.monotonic()
    assert sender.close(0.3) == 0  # no line is left, but a word
    assert time.monotonic() - start >= 0.3
    link.client.take(1)
    start = time.monotonic()
    assert sender.close(30.0) == 0 and time.monotonic() - start < 15.0


def test_what_is_taken_before_its_number_is_known_is_not_waited_for(
    made: tuple[Publisher, _Link],
) -> None:
    sender, link = made
    link.client.early = True
    sender.present("watching")
    sender.publish(5, "line 5")
    sender.publish(6, "line 6")
    assert sender.taken == 6
    start = time.monotonic()
    assert sender.close(30.0) == 0 and time.monotonic() - start < 15.0


def test_who_is_refused_does_not_wait(made: tuple[Publisher, _Link]) -> None:
    sender, link = made
    sender.publish(5, "line 5")
    link.refused = LogError("broker", None, "no")
    start = time.monotonic()
    assert sender.close(30.0) == 1 and time.monotonic() - start < 15.0
    with pytest.raises(LogError):
        sender.check()
    with pytest.raises(LogError):
        sender.news()


def test_a_broker_that_takes_no_verdict_is_told_of(made: tuple[Publisher, _Link]) -> None:
    sender, link = made
    sender.publish(5, "line 5")
    link.client.take(1, failed=True)
    (text,) = sender.news()
    assert text.startswith("the broker does not take verdicts on robot/verdicts")


def test_a_broker_that_is_away_is_told_of_once_each_time() -> None:
    pytest.importorskip("paho.mqtt.client")
    said: list[str] = []
    link = Link(address("here/robot/verdicts"), "me", said.append)
    refused, accepted = SimpleNamespace(is_failure=True), SimpleNamespace(is_failure=False)
    client: Any = link.client
    assert not link.away
    client.on_connect_fail(client, None)
    client.on_connect_fail(client, None)
    assert link.away and len(said) == 1 and "here:1883" in said[0] and "tried again" in said[0]
    client.on_connect(client, None, None, accepted, None)
    assert link.connected and not link.away
    client.on_disconnect(client, None, None, refused, None)
    assert link.away and not link.connected and "is gone" in said[-1]
