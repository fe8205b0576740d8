"""A real broker of MQTT on loopback, to be killed and started again; and clients of it.

One with users lets in `USER` with `PASSWORD` only; one with TLS has a certificate that an authority
of its own has signed, in the file `authority`.
"""

from __future__ import annotations

import base64
import getpass
import hashlib
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

USER, PASSWORD = "ann", "made by a test"


def _program(name: str = "mosquitto") -> str:
    found = shutil.which(name, path=f"{os.environ.get('PATH', '')}:/usr/sbin:/usr/local/sbin")
    if found is None:
        pytest.skip(f"{name} is not installed (apt install {name})")
    return found


def certificates(folder: Path) -> Path:
    """Make an authority, and a certificate of it for this computer; the file of the authority."""
    openssl = _program("openssl")
    name = folder / "authority.pem"
    new = [openssl, "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1",
           "-nodes", "-days", "2"]  # fmt: skip
    words = [
        [*new, "-subj", "/CN=authority of a test", "-keyout", folder / "authority.key",
         "-out", name],
        [*new, "-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1",
         "-addext", "basicConstraints=CA:FALSE", "-CA", name, "-CAkey", folder / "authority.key",
         "-keyout", folder / "broker.key", "-out", folder / "broker.pem"],
    ]  # fmt: skip
    for one in words:
        subprocess.run(one, check=True, capture_output=True)
    return name


def _password(text: str) -> str:
    """A password as mosquitto keeps it: PBKDF2 with SHA-512."""
    salt, rounds = os.urandom(12), 101
    key = hashlib.pbkdf2_hmac("sha512", text.encode(), salt, rounds)
    return "$".join(["", "7", str(rounds), *(base64.b64encode(b).decode() for b in (salt, key))])


class Broker:
    """mosquitto on a free port; with `lasting` it keeps what it has over a restart.

    With `secure` it speaks TLS, and has users.
    """

    def __init__(self, folder: Path, lasting: bool = False, secure: bool = False) -> None:
        with socket.socket() as one:
            one.bind(("127.0.0.1", 0))
            self.port: int = one.getsockname()[1]
        self.lasting = lasting
        self.at = f"127.0.0.1:{self.port}"
        self.authority = certificates(folder) if secure else None
        if secure:
            self.at = f"mqtts://{USER}@{self.at}"
            (folder / "users").write_text(f"{USER}:{_password(PASSWORD)}\n")
            (folder / "users").chmod(0o600)
        self._config = folder / "mosquitto.conf"
        lines = [
            f"listener {self.port} 127.0.0.1",
            f"allow_anonymous {'false' if secure else 'true'}",
            f"user {getpass.getuser()}",
            "max_queued_messages 0",
            f"persistence {'true' if lasting else 'false'}",
            f"persistence_location {folder}/",
            "autosave_on_changes true",
            "autosave_interval 1",
        ]
        if secure:
            lines += [f"password_file {folder}/users", f"certfile {folder}/broker.pem",
                      f"keyfile {folder}/broker.key"]  # fmt: skip
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
        self.presence: list[dict[str, Any]] = []
        self._client = Client(CallbackAPIVersion.VERSION2, name, protocol=MQTTv5)
        if broker.authority is not None:
            self._client.username_pw_set(USER, PASSWORD)
            self._client.tls_set(str(broker.authority))
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
        client.subscribe([("motor/verdicts", 1), ("motor/verdicts/monitor", 1)])

    def _subscribed(self, *_: object) -> None:
        self.ready = True

    def _lost(self, *_: object) -> None:
        self.ready = False

    def _heard(self, client: Client, data: object, message: MQTTMessage) -> None:
        if message.topic.endswith("/monitor"):
            self.presence.append(json.loads(message.payload))
            return
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
