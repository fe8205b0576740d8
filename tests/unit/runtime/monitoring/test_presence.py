"""That the monitor is there, has ended or is gone; and a broker that does not let it in."""

from __future__ import annotations

import signal
import socket
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.unit.runtime.monitoring import motor
from tests.unit.runtime.monitoring.broker import PASSWORD, Broker, Machine
from tests.unit.runtime.monitoring.watch import Watch, csv, until

Start = Callable[..., Watch]
_SECRET = "BONDGRAPH_MQTT_PASSWORD"


def _states(machine: Machine) -> list[str]:
    return [p["state"] for p in machine.presence]


def _log(tmp_path: Path) -> str:
    path = tmp_path / "log.csv"
    path.write_bytes(csv(motor.log(), 0, 500, header=True))
    return str(path)


@pytest.mark.parametrize("secure", [False, True])
def test_a_monitor_that_is_killed_is_gone_and_one_that_ends_has_ended(
    secure: bool, broker: Callable[..., Broker], watch: Start
) -> None:
    at = broker(secure=secure)
    trust = {"SSL_CERT_FILE": str(at.authority), _SECRET: PASSWORD} if secure else {}
    words = ["-", "--publish", f"{at.at}/motor/verdicts", "--heartbeat", "0.2"]
    machine = Machine(at, "machine")
    try:
        first = watch(*words, environment=trust)
        first.feed(csv(motor.log(), 0, 2800, header=True))
        until(lambda: _states(machine).count("watching") > 2, "heartbeats")
        beat = machine.presence[-1]
        assert beat["account"]["samples"]["read"] == 2800 and "2800 samples" in beat["message"]
        first.kill()
        until(lambda: "gone" in _states(machine), "the last will")
        assert _states(machine)[-1] == "gone"
        assert "Motor" in machine.presence[-1]["message"]
        second = watch(*words, environment=trust)
        until(lambda: _states(machine)[-1] == "watching", "the next one")
        assert second.ended(signal.SIGTERM) == 0
        until(lambda: _states(machine)[-1] == "ended", "the end")
        assert "stopped by SIGTERM" in machine.presence[-1]["message"]
        assert [v["event"] for v in machine.verdicts][-1] == "stop"
    finally:
        machine.close()


def test_a_watch_that_fails_has_ended_with_the_reason(
    broker: Callable[..., Broker], watch: Start
) -> None:
    at = broker()
    machine = Machine(at, "machine")
    try:
        one = watch("-", "--publish", f"{at.at}/motor/verdicts")
        until(lambda: _states(machine) == ["watching"])
        one.feed(b"t,U,load\n0,1,2\n0.001,1,2\n")
        assert one.ended() == 1
        until(lambda: _states(machine)[-1] == "ended")
        assert "no column for current" in machine.presence[-1]["message"]
    finally:
        machine.close()


@pytest.mark.parametrize("publish", [False, True])
@pytest.mark.parametrize(
    ("wrong", "word"),
    [("password", "Bad user name or password"), ("authority", "certificate verify failed"),
     ("none", "Bad user name or password")],
)  # fmt: skip
def test_a_broker_that_refuses_ends_the_watch_with_the_reason(
    wrong: str, word: str, publish: bool, broker: Callable[..., Broker], watch: Start
) -> None:
    at = broker(secure=True)
    trust = {"SSL_CERT_FILE": str(at.authority), _SECRET: PASSWORD}
    if wrong == "authority":
        del trust["SSL_CERT_FILE"]
    else:
        trust[_SECRET] = "wrong"
    address = at.at if wrong != "none" else at.at.replace("ann@", "")
    words = ["-", "--publish"] if publish else ["--mqtt"]
    one = watch(*words, f"{address}/motor/verdicts", environment=trust)
    until(lambda: one.errors)
    assert one.ended() == 1
    known = ("certificate", "self", "CERTIFICATE") if wrong == "authority" else (word, "authorized")
    assert any(k in one.errors for k in known), one.errors
    assert "127.0.0.1" in one.errors and "Traceback" not in one.errors
    assert "gap" not in one.events()


def test_tls_with_what_speaks_none_is_told(broker: Callable[..., Broker], watch: Start) -> None:
    at = broker()
    one = watch("--mqtt", f"mqtts://{at.at}/motor/samples")
    until(lambda: one.errors)
    assert one.ended() == 1
    assert "no TLS with the broker" in one.errors and "Traceback" not in one.errors


def test_a_broker_that_is_not_there_is_a_gap_with_its_reason(watch: Start) -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    one = watch("--mqtt", f"127.0.0.1:{port}/motor/samples")
    assert "Connection refused" in one.heard("gap", "cannot be reached")["message"]
    assert one.ended(signal.SIGTERM) == 0


def test_a_log_that_ends_before_the_broker_has_answered_ends_with_its_reason(
    broker: Callable[..., Broker], watch: Start, tmp_path: Path
) -> None:
    at = broker(secure=True)
    trust = {"SSL_CERT_FILE": str(at.authority), _SECRET: "wrong"}
    one = watch(_log(tmp_path), "--publish", f"{at.at}/motor/verdicts", environment=trust)
    assert one.ended() == 1
    assert "refuses the monitor" in one.errors
