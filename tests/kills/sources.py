"""What feeds a monitor that is killed: it goes on by itself, whoever listens."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from threading import Event, Thread

from bondgraph.runtime.log import Log
from tests.unit.runtime.monitoring.broker import PASSWORD, Broker, Machine
from tests.unit.runtime.monitoring.test_serial import Device
from tests.unit.runtime.monitoring.watch import Watch, csv, until

_TOGETHER = 60  # samples
_LAST = 3000  # samples that wait until the last monitor listens
_PER_SECOND = 1000.0  # samples: there are some as long as monitors are killed

KINDS = ("file", "growing file", "pipe", "serial", "broker", "broker with TLS")


class Feeder:
    """Sends a log to whoever listens, so many samples a second, the end of it once it is asked to.

    `words` are those of the monitor, `last` those of the last one where they are others. What a
    source `keeps` while nobody listens is not lost.
    """

    keeps = False
    seconds = 9.0
    environment: dict[str, str] = {}  # noqa: RUF012 (never changed)

    def __init__(self, folder: Path, log: Log) -> None:
        self._log, self._folder = log, folder
        self.words: list[str] = []
        self._over, self._ending = Event(), Event()
        self._thread = Thread(target=self._feed, daemon=True)

    @property
    def last(self) -> list[str]:
        return self.words

    def begin(self, watch: Watch) -> None:
        """The first monitor has started."""
        self.attach(watch)
        self._thread.start()

    def attach(self, watch: Watch) -> None:
        """Another monitor listens."""

    def finish(self, watch: Watch) -> int | None:
        """Send the rest to the last monitor, and let it end; its exit status."""
        self._ending.set()
        self._thread.join()
        return self.end(watch)

    def end(self, watch: Watch) -> int | None:
        return watch.ended()

    def send(self, data: bytes) -> None:
        raise NotImplementedError

    def close(self) -> None:
        self._over.set()
        self._ending.set()
        if self._thread.is_alive():
            self._thread.join()

    def _feed(self) -> None:
        start = time.monotonic()
        for k in range(0, self._log.rows, _TOGETHER):
            if k >= self._log.rows - _LAST:
                self._ending.wait()
            elif self._over.wait(max(0.0, start + k / _PER_SECOND - time.monotonic())):
                return
            if self._over.is_set():
                return
            self.send(csv(self._log, k, k + _TOGETHER))


def _head(log: Log) -> str:
    return ",".join(["t", *log.columns])


class File(Feeder):
    """A log that is there; of several blocks, so that there are positions between."""

    keeps = True
    seconds = 25.0

    def __init__(self, folder: Path, log: Log) -> None:
        super().__init__(folder, log)
        path = folder / "log.csv"
        path.write_bytes(csv(log, header=True))
        self.words = [str(path)]

    def send(self, data: bytes) -> None: ...


class GrowingFile(Feeder):
    """A log that is written."""

    keeps = True

    def __init__(self, folder: Path, log: Log) -> None:
        super().__init__(folder, log)
        self._path = folder / "log.csv"
        self._path.write_text(_head(log) + "\n")
        self.words = [str(self._path), "--follow"]

    def send(self, data: bytes) -> None:
        with self._path.open("ab") as file:
            file.write(data)

    def end(self, watch: Watch) -> int | None:
        size = self._log.rows
        until(lambda: watch.said and _read(watch) >= size, "the rest")
        return watch.ended(15)


class PipeFeeder(Feeder):
    """Standard input: what is written while nobody reads is gone."""

    def __init__(self, folder: Path, log: Log) -> None:
        super().__init__(folder, log)
        self.words = ["-", "--columns", _head(log)]
        self._watch: Watch | None = None

    def attach(self, watch: Watch) -> None:
        self._watch = watch

    def send(self, data: bytes) -> None:
        with suppress(OSError, ValueError):  # it was killed
            assert self._watch is not None
            self._watch.feed(data)


class Serial(Feeder):
    """A serial line: what nobody reads fills its buffer, and then is gone."""

    def __init__(self, folder: Path, log: Log) -> None:
        super().__init__(folder, log)
        self._device = Device(folder / "port")
        os.set_blocking(self._device.far, False)
        self.words = ["--serial", str(self._device.name), "--columns", _head(log)]

    def send(self, data: bytes) -> None:
        # The last monitor is given all of it, however busy this computer is.
        end = time.monotonic() + (10.0 if self._ending.is_set() else 0.02)
        while data and time.monotonic() < end:
            try:
                data = data[os.write(self._device.far, data[:512]) :]
            except BlockingIOError:
                time.sleep(0.001)

    def end(self, watch: Watch) -> int | None:
        return _after_marks(watch, self.send)

    def close(self) -> None:
        super().close()
        self._device.unplug()


class Mqtt(Feeder):
    """A broker, which keeps what comes while the monitor is away."""

    keeps = True
    secure = False

    def __init__(self, folder: Path, log: Log) -> None:
        super().__init__(folder, log)
        self.broker = Broker(folder, secure=self.secure)
        self.machine = Machine(self.broker, "machine")
        at = f"{self.broker.at}/motor/samples"
        self.words = ["--mqtt", at, "--columns", _head(log), "--publish", "motor/verdicts"]
        if self.secure:
            self.environment = {
                "SSL_CERT_FILE": str(self.broker.authority),
                "BONDGRAPH_MQTT_PASSWORD": PASSWORD,
            }

    def begin(self, watch: Watch) -> None:
        def heard() -> bool:
            self.send(b"noise\n")
            return "invalid" in watch.events()

        until(heard, "the subscription")  # before, a broker keeps nothing for it
        super().begin(watch)

    def send(self, data: bytes) -> None:
        self.machine.send(data)

    def end(self, watch: Watch) -> int | None:
        return _after_marks(watch, self.send)

    def close(self) -> None:
        super().close()
        self.machine.close()
        self.broker.kill()


class SecureMqtt(Mqtt):
    """The same with users and TLS."""

    secure = True


def _read(watch: Watch) -> int:
    beats = [v for v in watch.said if v["event"] == "heartbeat"]
    return int(beats[-1]["account"]["samples"]["read"]) if beats else 0


def _after_marks(watch: Watch, send: Callable[[bytes], None]) -> int | None:
    """End a watch once it has read all that was sent before."""

    def told() -> bool:
        send(b"end\n" * 20)
        return any("`end`" in v["message"] for v in watch.said)

    until(told, "the end")
    return watch.ended(15)


FEEDERS: dict[str, type[Feeder]] = dict(
    zip(KINDS, (File, GrowingFile, PipeFeeder, Serial, Mqtt, SecureMqtt), strict=True)
)
