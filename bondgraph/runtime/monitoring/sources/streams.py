"""Samples that a thread hears: from a pipe, a serial port, a topic of an MQTT broker."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from threading import Event, Thread
from typing import TYPE_CHECKING, Any

from bondgraph.runtime.log import LogError
from bondgraph.runtime.log_numbers import Form
from bondgraph.runtime.monitoring.mqtt_client import SESSION, Address, Link
from bondgraph.runtime.monitoring.sources.lines import Decoder
from bondgraph.runtime.monitoring.sources.sample_source import (
    IDLE,
    Block,
    Chunk,
    Cutter,
    Intake,
    Source,
    decoded,
)

if TYPE_CHECKING:
    from paho.mqtt.client import Client, MQTTMessage
    from serial import Serial

_SMALL, _REST = 4096, 0.05  # bytes: after fewer a pipe is left alone for so many s
_LONGEST = 5.0  # s between two attempts to open a serial port
_AT_ONCE = 200  # messages that a broker may send before the first of them is acknowledged


class Stream(Source):
    """Lines as they come, between the thread that hears them and the one that computes."""

    decoder: Decoder
    live = True

    def __init__(self, name: str, form: Form, intake: Intake) -> None:
        self.name = name
        self.decoder = Decoder(form)
        self._intake = intake

    @property
    def dropped(self) -> int:
        """See `Source`."""
        return self._intake.dropped


class Pipe(Stream):
    """Lines from a descriptor; who writes too fast is held up by the pipe, nothing is dropped.

    At most so many bytes wait here.
    """

    def __init__(
        self,
        form: Form,
        descriptor: int = 0,
        name: str = "standard input",
        most: int = 1 << 22,
    ) -> None:
        super().__init__(name, form, Intake(most, waits=True))
        self._descriptor = descriptor
        self._reader: Thread | None = None

    def chunks(self, stop: Event) -> Iterator[Chunk]:
        """All lines, until the writer closes the pipe."""
        # Reading blocks, and nothing wakes it up: the thread is left behind at the end.
        self._reader = Thread(target=self._read, daemon=True)
        self._reader.start()
        yield from decoded(self._intake, self.decoder, stop)

    def go(self, position: dict[str, Any]) -> str:
        """A pipe cannot go back."""
        return "what came through a pipe is gone"

    def close(self) -> None:
        """Let the thread end."""
        self._intake.end()

    def join(self, patience: float) -> None:
        """Wait until the thread has read the end, at most so many seconds."""
        if self._reader is not None:
            self._reader.join(patience)

    def _read(self) -> None:
        cutter = Cutter()
        try:
            while piece := os.read(self._descriptor, 1 << 16):
                block = cutter.cut(piece)
                if block is not None:
                    self._intake.put(block)
                if len(piece) < _SMALL:
                    time.sleep(_REST)  # to wake up for each line would cost most
        except OSError as error:
            self._intake.say("gap", f"{self.name}: {error.strerror}")
        last = cutter.cut(b"\n") if cutter.rest else None
        if last is not None:
            self._intake.put(last)
        self._intake.end()


class SerialPort(Stream):
    """Lines from a serial port; while the device is away it is looked for again and again."""

    def __init__(self, port: str, baud: int, form: Form) -> None:
        super().__init__(f"{port} at {baud} baud", form, Intake())
        self._port, self._baud = port, baud
        self._over = Event()
        self._serial: Serial | None = self._open()

    def chunks(self, stop: Event) -> Iterator[Chunk]:
        """All lines, until `stop` is set."""
        thread = Thread(target=self._read, daemon=True)
        thread.start()
        try:
            yield from decoded(self._intake, self.decoder, stop)
        finally:
            self._over.set()
            thread.join(1.0)

    def go(self, position: dict[str, Any]) -> str:
        """A serial port cannot go back."""
        return "what came through a serial port is gone"

    def close(self) -> None:
        """Close the port."""
        self._over.set()
        if self._serial is not None:
            self._serial.close()

    def _open(self) -> Serial:
        try:
            import serial
        except ImportError as error:
            remedy = "install it (pip install 'bondgraph-arr[robot]')"
            raise LogError(self._port, None, "a serial port needs pyserial", remedy) from error
        try:
            return serial.serial_for_url(self._port, self._baud, timeout=IDLE)
        except (serial.SerialException, ValueError) as error:
            text = str(error.strerror or error) if isinstance(error, OSError) else str(error)
            raise LogError(self._port, None, f"cannot be opened: {text}") from error

    def _read(self) -> None:
        cutter = Cutter(whole=False)
        while not self._over.is_set():
            try:
                if self._serial is None:
                    self._again()
                    cutter = Cutter(whole=False)
                    continue
                piece = self._serial.read(max(1, self._serial.in_waiting))
            except Exception as error:  # drivers raise what they like: the device is gone
                if not self._over.is_set():
                    self._lost(error)
                continue
            block = cutter.cut(piece) if piece else None
            if block is not None:
                self._intake.put(block)

    def _lost(self, error: Exception) -> None:
        self._intake.say("gap", f"{self._port} is gone ({error}); it is looked for again")
        if self._serial is not None:
            self._serial.close()
        self._serial = None

    def _again(self) -> None:
        """Look for the device until it is back, more and more seldom."""
        wait = 0.1
        while not self._over.wait(wait):
            try:
                self._serial = self._open()
            except LogError:
                wait = min(2 * wait, _LONGEST)
            else:
                self._intake.say("gap", f"{self._port} is back")
                return


class Topic(Stream):
    """Messages of a topic, quality of service 1: a JSON object, an array of them, or lines of CSV.

    A message is acknowledged when its samples have been computed. With a lasting `identity` the
    broker keeps what comes while the monitor is away; without (None) each start is a new one.
    """

    def __init__(self, at: Address, form: Form, identity: str | None) -> None:
        # The broker stops long before so much waits.
        super().__init__(f"{at.topic} at {at.name}", form, Intake(most=1 << 40))
        self._topic = at.topic
        self._last = float("-inf")
        keep = SESSION if identity else 0
        self._link = Link(
            at, identity or "", self._say, self._joined, keep, _AT_ONCE, refuse=self._intake.fail
        )
        self._link.client.on_message = self._received
        self._link.client.on_subscribe = self._subscribed

    def chunks(self, stop: Event) -> Iterator[Chunk]:
        """All messages, until `stop` is set."""
        self._link.start()
        yield from decoded(self._intake, self.decoder, stop, self._last)

    def go(self, position: dict[str, Any]) -> str:
        """The broker goes on with what was not acknowledged; what was, is known by its time."""
        self._last = float(position.get("time", self._last))
        return "the broker has only what came since"

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
                why = f"the broker does not let the monitor read {self._topic}: {code}"
                remedy = "give the user that is named in its address the right to"
                self._intake.fail(LogError(self.name, None, why, remedy))

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
