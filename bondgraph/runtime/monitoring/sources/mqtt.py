"""Samples from a topic of an MQTT broker, none lost while either side is away for a while."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from threading import Event
from typing import TYPE_CHECKING, Any

from bondgraph.runtime.log_numbers import Form
from bondgraph.runtime.monitoring.mqtt_client import SESSION, Address, Link
from bondgraph.runtime.monitoring.sources.lines import Decoder
from bondgraph.runtime.monitoring.sources.sample_source import Block, Chunk, Intake, decoded

if TYPE_CHECKING:
    from paho.mqtt.client import Client, MQTTMessage

_AT_ONCE = 200  # messages that the broker may send before the first of them is acknowledged


class Topic:
    """Messages of a topic, quality of service 1: a JSON object, an array of them, or lines of CSV.

    A message is acknowledged when its samples have been computed. With a lasting `identity` the
    broker keeps what comes while the monitor is away; without (None) each start is a new one.
    """

    replays = False

    def __init__(self, at: Address, form: Form, identity: str | None) -> None:
        self.name = f"{at.topic} at {at.name}"
        self.decoder: Decoder | None = Decoder(form)
        self._lines = self.decoder
        self._topic = at.topic
        self._last = float("-inf")
        self._intake = Intake(most=1 << 40)  # the broker stops before
        keep = SESSION if identity else 0
        self._link = Link(at, identity or "", self._say, self._joined, keep, _AT_ONCE)
        self._link.client.on_message = self._received
        self._link.client.on_subscribe = self._subscribed

    def chunks(self, stop: Event) -> Iterator[Chunk]:
        """All messages, until `stop` is set."""
        self._link.start()
        yield from decoded(self._intake, self._lines, stop, self._last)

    def go(self, position: dict[str, Any]) -> str:
        """The broker goes on with what was not acknowledged; what was, is known by its time."""
        self._last = float(position.get("time", self._last))
        return "the broker has only what came since"

    def rate(self) -> float | None:
        """Not known before samples come."""
        return None

    def close(self) -> None:
        """Leave the broker; the session stays there."""
        self._link.stop()

    def _say(self, what: str) -> None:
        self._intake.say("gap", what)

    def _joined(self, client: Client) -> None:
        from paho.mqtt.subscribeoptions import SubscribeOptions

        # A retained sample is of any age: it is not asked for.
        client.subscribe(self._topic, options=SubscribeOptions(qos=1, retainHandling=2))

    def _subscribed(
        self, client: Client, data: object, mid: int, codes: list[Any], properties: object
    ) -> None:
        for code in codes:
            if code.is_failure:
                self._say(f"the broker does not let the monitor read {self._topic} ({code})")

    def _received(self, client: Client, data: object, message: MQTTMessage) -> None:
        payload = bytes(message.payload).strip()
        if payload[:1] in (b"{", b"["):
            payload = b" ".join(payload.splitlines())  # one line, however it was written
        self._intake.put(Block(payload + b"\n", again=message.dup, done=self._acknowledge(message)))

    def _acknowledge(self, message: MQTTMessage) -> Callable[[], None]:
        connection = self._link.connections

        def done() -> None:
            # After a new connection the same number may mean another message.
            if message.qos and connection == self._link.connections:
                self._link.client.ack(message.mid, message.qos)

        return done
