"""What a client of MQTT says of a broker that it does not reach, and when it gives up."""

from __future__ import annotations

import ssl
from collections.abc import Callable
from typing import Any, NamedTuple

import pytest

from bondgraph.runtime.log import LogError
from bondgraph.runtime.monitoring.mqtt_client import Address, Link, Publisher

pytest.importorskip("paho.mqtt.client")


class _Code(NamedTuple):
    """What a broker answers, as the client hands it on."""

    value: int
    is_failure: bool

    def __str__(self) -> str:
        return f"code {self.value}"


class _Heard(NamedTuple):
    """A link that was never started, and what it has said."""

    link: Link
    said: list[str]
    refused: list[LogError]


def heard(secure: bool = True, joined: Callable[[Any], None] | None = None) -> _Heard:
    said: list[str] = []
    refused: list[LogError] = []
    at = Address("broker.lan", 8883 if secure else 1883, "t", None, secure)
    return _Heard(Link(at, "me", said.append, joined, refuse=refused.append), said, refused)


def attempt(link: Link, error: OSError) -> None:
    """A connection that fails."""

    def fails() -> None:
        raise error

    with pytest.raises(type(error)):
        link._attempt(fails)
    link._failed(link.client, None)


def _certificate() -> ssl.SSLCertVerificationError:
    error = ssl.SSLCertVerificationError(1, "[SSL: CERTIFICATE_VERIFY_FAILED] in the long")
    error.reason, error.verify_message = "CERTIFICATE_VERIFY_FAILED", "self-signed certificate"
    return error


def _version() -> ssl.SSLError:
    error = ssl.SSLError(1, "[SSL: WRONG_VERSION_NUMBER] in the long")
    error.reason = "WRONG_VERSION_NUMBER"
    return error


@pytest.mark.parametrize(
    ("error", "why"),
    [
        (_certificate(), "self-signed certificate"),  # in words, where there are any
        (_version(), "WRONG_VERSION_NUMBER"),
        (ssl.SSLError(1, "something else"), "something else"),  # made by no handshake
    ],
)
def test_a_broker_that_is_not_trusted_is_given_up_at_once(error: ssl.SSLError, why: str) -> None:
    link, said, refused = heard()
    attempt(link, error)
    assert [str(e).split("; ")[0] for e in refused] == [
        f"broker.lan:8883: no TLS with the broker: {why}"
    ]
    assert link.refused is refused[0] and "SSL_CERT_FILE" in refused[0].help
    assert said == []  # what is refused is not tried again


def test_a_broker_that_is_not_there_is_told_once_and_tried_again() -> None:
    link, said, refused = heard()
    for _ in range(3):
        attempt(link, ConnectionRefusedError(111, "Connection refused"))
    assert said == [
        "the broker broker.lan:8883 cannot be reached (Connection refused); it is tried again"
    ]
    link._connected(link.client, None, None, _Code(0, False), None)
    assert said[1:] == ["the broker broker.lan:8883 is back"] and link.connections == 1
    link._lost(link.client, None, None, _Code(142, True), None)
    assert said[2:] == ["the broker broker.lan:8883 is gone (code 142); it is tried again"]
    assert not link.connected and not refused


def test_an_error_without_words_is_told_as_it_is() -> None:
    link, said, _ = heard()
    attempt(link, OSError("no words"))
    assert said == ["the broker broker.lan:8883 cannot be reached (no words); it is tried again"]


@pytest.mark.parametrize("error", [ssl.SSLEOFError, ssl.SSLZeroReturnError, ConnectionResetError])
def test_tls_that_is_broken_off_three_times_is_no_accident(error: type[OSError]) -> None:
    link, said, refused = heard()
    for times in (1, 2, 3):
        attempt(link, error(8, "cut"))
        assert len(refused) == (times == 3)
    assert len(said) == 1
    plain, _, none = heard(secure=False)
    for _ in range(4):
        attempt(plain, ConnectionResetError(104, "cut"))
    assert none == []


def test_who_was_connected_once_does_not_give_up() -> None:
    link, said, refused = heard()
    link._connected(link.client, None, None, _Code(0, False), None)
    attempt(link, _certificate())
    link._connected(link.client, None, None, _Code(0x86, True), None)
    assert refused == [] and link.refused is None
    assert said == [
        "the broker broker.lan:8883 cannot be reached (self-signed certificate); it is tried again"
    ]


@pytest.mark.parametrize(
    ("code", "for_good"),
    [(0x84, True), (0x85, True), (0x86, True), (0x87, True), (0x88, False), (0x8A, True),
     (0x8C, True), (0x97, False)],
)  # fmt: skip
def test_a_refusal_that_stays_is_told_from_one_that_may_pass(code: int, for_good: bool) -> None:
    """MQTT 5, 3.2.2.2: 0x88 is a server that is unavailable, 0x97 a quota."""
    link, said, refused = heard()
    link._connected(link.client, None, None, _Code(code, True), None)
    assert bool(refused) == for_good == (not said)
    assert not link.connected and link.connections == 0
    (why,) = [str(e) for e in refused] or said
    assert f"the broker refuses the monitor: code {code}" in why


def test_whoever_waits_for_the_connection_is_called_before_it_counts() -> None:
    states: list[bool] = []
    link, _, _ = heard(joined=lambda _: states.append(link.connected))
    link._connected(link.client, None, None, _Code(0, False), None)
    assert states == [False] and link.connected


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("[SSL: TLSV13_ALERT_CERTIFICATE_REQUIRED] tls", "TLSV13_ALERT_CERTIFICATE_REQUIRED"),
        ("SSL ALERT of some kind", "SSL ALERT of some kind"),
        ("Sending PINGREQ", None),
        ("SSL: all is well", None),
    ],
)
def test_a_broker_that_wants_a_certificate_says_so_afterwards(text: str, why: str | None) -> None:
    link, _, refused = heard()
    link._logged(link.client, None, None, text)
    told = [] if why is None else [f"no TLS with the broker: {why}"]
    assert [e.message for e in refused] == told


@pytest.mark.parametrize("gone", ["", '{"state": "gone"}'])
def test_a_publisher_leaves_word_for_the_case_that_it_is_gone(
    gone: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The broker keeps it beside the topic of the verdicts; without words it keeps nothing."""
    wills: list[tuple[object, ...]] = []
    monkeypatch.setattr(Link, "start", lambda self: None)
    monkeypatch.setattr(
        "paho.mqtt.client.Client.will_set",
        lambda self, topic, words, qos, retain: wills.append((topic, words, qos, retain)),
    )
    Publisher(Address("broker.lan", 1883, "motor/verdicts", None, False), "me", gone=gone)
    assert wills == ([("motor/verdicts/monitor", gone, 1, True)] if gone else [])
