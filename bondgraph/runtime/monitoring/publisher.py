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
    """Publishes lines in their order with quality of service 1; the last one is retained.

    Lines that the broker has not taken are sent again when it is back. `taken` is the number up
    to which it has all.
    """

    def __init__(self, at: Address, identity: str, taken: int = 0) -> None:
        self.taken = taken
        self._topic = at.topic
        self._news: deque[str] = deque()
        self._queue: deque[tuple[int, str]] = deque()
        self._sent: dict[int, int] = {}  # on the way: number of the message -> of the verdict
        self._early: set[int] = set()  # messages taken before their number was known here
        self._newest = taken
        self._lock = Lock()
        self._link = Link(at, identity, self._news.append)
        self._link.client.on_publish = self._published
        self._link.start()

    def publish(self, number: int, line: str) -> None:
        """Send one line, now or when the broker is there."""
        self._queue.append((number, line))
        self._send()

    def news(self) -> list[str]:
        """What there is to tell of the broker since the last call; to be called now and then."""
        self._send()
        found = []
        while self._news:
            found.append(self._news.popleft())
        return found

    def close(self, patience: float = 2.0) -> int:
        """Wait until all is taken, at most so many s; how many lines are not.

        A broker that is known to be away is not waited for.
        """
        end = time.monotonic() + (0.0 if self._link.away else patience)
        while (self._queue or self._sent) and time.monotonic() < end:
            self._send()
            time.sleep(0.005)
        self._link.stop()
        return len(self._queue) + len(self._sent)

    def _send(self) -> None:
        """Hand on what waits, once all before it is taken: so the order stays as it is, also
        where the client sends again what was on its way when the connection was lost."""
        if not self._link.connected or self._sent:
            return
        while self._queue:
            number, line = self._queue.popleft()
            found = self._link.client.publish(self._topic, line, qos=1, retain=True)
            with self._lock:
                self._sent[found.mid] = number
                if found.mid in self._early:
                    self._early.remove(found.mid)
                    self._take(found.mid)

    def _published(
        self, client: Client, data: object, mid: int, code: object, properties: object
    ) -> None:
        with self._lock:
            if mid in self._sent:
                self._take(mid)
            else:
                self._early.add(mid)
        if getattr(code, "is_failure", False):
            self._news.append(f"the broker does not take verdicts on {self._topic} ({code})")

    def _take(self, mid: int) -> None:
        self._newest = max(self._newest, self._sent.pop(mid))
        self.taken = min([self._newest, *(number - 1 for number in self._sent.values())])
