"""Verdicts to a topic of an MQTT broker, each until the broker has taken it."""

from __future__ import annotations

import time
from collections import deque
from threading import Lock
from typing import TYPE_CHECKING

from bondgraph.runtime.monitoring.mqtt_client import Address, Link

if TYPE_CHECKING:
    from paho.mqtt.client import Client


class Publisher:
    """Publishes lines with quality of service 1; the last one is retained.

    Lines that the broker has not taken are sent again whenever it is back. `taken` is the number
    up to which it has all; `news` what there is to tell about the broker.
    """

    def __init__(self, at: Address, identity: str, taken: int = 0) -> None:
        self.name = f"{at.topic} at {at.name}"
        self.taken = taken
        self._topic = at.topic
        self._news: deque[str] = deque()
        self._waiting: dict[int, int] = {}  # number of the message -> number of the verdict
        self._open: set[int] = set()  # numbers of verdicts that are not taken
        self._early: set[int] = set()  # messages taken before their number was known here
        self._newest = taken
        self._lock = Lock()
        self._link = Link(at, identity, self._news.append, self._joined)
        self._link.client.on_publish = self._published
        self._link.start()

    def publish(self, number: int, line: str) -> None:
        """Send one line, now or when the broker is there."""
        with self._lock:
            self._open.add(number)
            self._newest = number
        sent = self._link.client.publish(self._topic, line, qos=1, retain=True)
        with self._lock:
            if sent.mid in self._early:
                self._early.remove(sent.mid)
                self._done(number)
            else:
                self._waiting[sent.mid] = number

    def news(self) -> list[str]:
        """What there is to tell since the last call."""
        found = []
        while self._news:
            found.append(self._news.popleft())
        return found

    def close(self, patience: float = 2.0) -> int:
        """Wait until all is taken, at most so many s; how many lines are not."""
        end = time.monotonic() + patience
        while self._open and time.monotonic() < end:
            time.sleep(0.01)
        self._link.stop()
        return len(self._open)

    def _joined(self, client: Client) -> None:
        """Nothing to do: what was not taken is sent again by itself."""

    def _published(
        self, client: Client, data: object, mid: int, code: object, properties: object
    ) -> None:
        with self._lock:
            number = self._waiting.pop(mid, None)
            if number is None:
                self._early.add(mid)
            else:
                self._done(number)
        if getattr(code, "is_failure", False):
            self._news.append(f"the broker does not take verdicts on {self._topic} ({code})")

    def _done(self, number: int) -> None:
        self._open.discard(number)
        self.taken = min(self._open) - 1 if self._open else self._newest
