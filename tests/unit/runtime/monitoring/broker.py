"""A real broker of MQTT on loopback, to be killed and started again; and clients of it."""

from __future__ import annotations

import getpass
import json
import os
import shutil
import signal
import socket
import subprocess
from pathlib import Path
from typing import Any

import pytest
from paho.mqtt.client import Client, MQTTMessage, MQTTv5
from paho.mqtt.enums import CallbackAPIVersion
from paho.mqtt.packettypes import PacketTypes
from paho.mqtt.properties import Properties

from tests.unit.runtime.monitoring.watch import until


def _program() -> str:
    found = shutil.which(
        "mosquitto", path=f"{os.environ.get('PATH', '')}:/usr/sbin:/usr/local/sbin"
    )
    if found is None:
        pytest.skip("mosquitto is not installed (apt install mosquitto)")
    return found


class Broker:
    """mosquitto on a free port; with `lasting` it keeps what it has over a restart."""

    def __init__(self, folder: Path, lasting: bool) -> None:
        with socket.socket() as one:
            one.bind(("127.0.0.1", 0))
            self.port: int = one.getsockname()[1]
        self.lasting = lasting
        self.at = f"127.0.0.1:{self.port}"
        self._config = folder / "mosquitto.conf"
        lines = [
            f"listener {self.port} 127.0.0.1",
            "allow_anonymous true",
            f"user {getpass.getuser()}",
            "max_queued_messages 0",
            f"persistence {'true' if lasting else 'false'}",
            f"persistence_location {folder}/",
            "autosave_on_changes true",
            "autosave_interval 1",
        ]
        self._config.write_text("\n".join(lines) + "\n")
        self._process: subprocess.Popen[bytes] | None = None
        self.start()

    def start(self) -> None:
        """Start it, and wait until it listens."""
        self._process = subprocess.Popen(
            [_program(), "-c", str(self._config)], stderr=subprocess.DEVNULL
        )
        until(self._listens, "the broker")

    def kill(self, number: int = signal.SIGKILL) -> None:
        """End it, by default without a chance to save anything."""
        if self._process is not None:
            self._process.send_signal(number)
            self._process.wait()
        self._process = None

    def _listens(self) -> bool:
        assert self._process is not None and self._process.poll() is None, "mosquitto has ended"
        try:
            socket.create_connection(("127.0.0.1", self.port), 1.0).close()
        except OSError:
            return False
        return True


class Machine:
    """A client that sends samples, and hears verdicts; neither is lost while the broker is away."""

    def __init__(self, broker: Broker, name: str) -> None:
        self.verdicts: list[dict[str, Any]] = []
        self.retained: list[dict[str, Any]] = []
        self._client = Client(CallbackAPIVersion.VERSION2, name, protocol=MQTTv5)
        self._client.on_message = self._heard
        self._client.on_connect = self._connected
        self.ready = False
        self._client.on_subscribe = self._subscribed
        self._client.on_disconnect = self._lost
        properties = Properties(PacketTypes.CONNECT)  # type: ignore[no-untyped-call]
        properties.SessionExpiryInterval = 3600
        self._client.connect_async(
            "127.0.0.1", broker.port, clean_start=False, properties=properties
        )
        self._client.loop_start()
        until(lambda: self.ready, "the machine")

    def _connected(self, client: Client, *_: object) -> None:
        client.subscribe("motor/verdicts", qos=1)

    def _subscribed(self, *_: object) -> None:
        self.ready = True

    def _lost(self, *_: object) -> None:
        self.ready = False

    def _heard(self, client: Client, data: object, message: MQTTMessage) -> None:
        (self.retained if message.retain else self.verdicts).append(json.loads(message.payload))

    def send(self, payload: object, retain: bool = False) -> None:
        """Publish samples, once the broker is there."""
        text = payload if isinstance(payload, bytes | str) else json.dumps(payload)
        self._client.publish("motor/samples", text, qos=1, retain=retain)

    def numbers(self) -> list[int]:
        """The numbers of the verdicts, each once, in the order in which they came first."""
        return list(dict.fromkeys(int(v["number"]) for v in self.verdicts))

    def close(self) -> None:
        """Leave."""
        self._client.disconnect()
        self._client.loop_stop()
