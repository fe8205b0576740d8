"""A broker of MQTT: how it is named and reached, and how verdicts are published there."""

from __future__ import annotations

import os
import ssl
import time
from collections import deque
from collections.abc import Callable
from functools import partial
from threading import Lock
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from bondgraph.runtime.log import LogError
from bondgraph.text.tuples import NamedTuple

if TYPE_CHECKING:
    from paho.mqtt.client import Client

#: Where the password of the user in an address is looked up; an argument can be seen by others.
PASSWORD = "BONDGRAPH_MQTT_PASSWORD"

#: For how long a broker keeps what comes while the monitor is away, in s.
SESSION = 7 * 24 * 3600

#: Below the topic of the verdicts: whether the monitor watches, has ended, or is gone.
PRESENCE = "/monitor"

#: What a broker says that will say the same next time, as codes of MQTT 5.
_FOR_GOOD = frozenset({0x84, 0x85, 0x86, 0x87, 0x8A, 0x8C})  # version, name, password, rights, ban

_CUT_OFF = ssl.SSLEOFError, ssl.SSLZeroReturnError, ConnectionResetError
_CUT = 3  # times that a broker breaks TLS off until that is no broker that ends just now
_ALIVE = 15  # s without a word after which a connection counts as lost
_FIRST, _LONGEST = 1, 30  # s between attempts to connect


class Address(NamedTuple):
    """A topic at a broker; `secure` through TLS."""

    host: str
    port: int
    topic: str
    user: str | None
    secure: bool

    @property
    def name(self) -> str:
        """Where the broker is, for people."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"{host}:{self.port}"


def address(text: str) -> Address:
    """`[mqtts://][USER@]HOST[:PORT]/TOPIC`; raises ValueError for anything else.

    >>> address("localhost/robot/samples")
    Address(host='localhost', port=1883, topic='robot/samples', user=None, secure=False)
    >>> address("mqtts://ann@broker.lan:8884/robot").name
    'broker.lan:8884'
    """
    full = text if "://" in text else f"mqtt://{text}"
    parts = urlsplit(full, allow_fragments=False)
    topic = parts.path[1:] + (f"?{parts.query}" if parts.query else "")
    if parts.scheme not in ("mqtt", "mqtts") or not parts.hostname or not topic:
        raise ValueError(f"`{text}` is not HOST[:PORT]/TOPIC")
    secure = parts.scheme == "mqtts"
    port = parts.port or (8883 if secure else 1883)
    return Address(parts.hostname, port, topic, parts.username, secure)


class Link:
    """A client that connects again whenever the broker is back; `say` hears of it.

    Where the broker refuses the monitor before the first connection, for a password, for rights or
    in TLS, `refused` is why, and `refuse` gets it: that is no matter of time. `will` is a topic and
    what the broker keeps there once the client is gone without a goodbye.

    `keep` is for how many s the broker keeps the session while nobody is connected; without it
    every connection starts anew. `joined` is called after each connection.
    """

    def __init__(
        self,
        at: Address,
        identity: str,
        say: Callable[[str], None],
        joined: Callable[[Client], None] | None = None,
        keep: int = 0,
        at_once: int = 0,
        *,
        refuse: Callable[[LogError], None] = lambda error: None,
        will: tuple[str, str] | None = None,
    ) -> None:
        try:
            from paho.mqtt.client import Client, MQTTv5
            from paho.mqtt.enums import CallbackAPIVersion
            from paho.mqtt.packettypes import PacketTypes
            from paho.mqtt.properties import Properties
        except ImportError as error:
            remedy = "install it (pip install 'bondgraph-arr[robot]')"
            raise LogError(at.name, None, "MQTT needs paho-mqtt", remedy) from error
        self.connections = 0
        self.connected = False
        self.away = False  # and it was told
        self.refused: LogError | None = None
        self._at, self._say, self._joined, self._refuse = at, say, joined, refuse
        self._cut = 0  # attempts in which the broker has broken off TLS
        self._why = ""  # the last attempt to connect has failed
        self.client = Client(
            CallbackAPIVersion.VERSION2, identity, protocol=MQTTv5, manual_ack=True
        )
        if at.user is not None:
            self.client.username_pw_set(at.user, os.environ.get(PASSWORD))
        if at.secure:
            self.client.tls_set()
        if will is not None:
            self.client.will_set(will[0], will[1], qos=1, retain=True)
        # The reason is in the error only, which the client keeps to itself.
        setattr(self.client, "reconnect", partial(self._attempt, self.client.reconnect))  # noqa: B010
        self.client.on_log = self._logged
        self.client.reconnect_delay_set(_FIRST, _LONGEST)
        self.client.on_connect = self._connected
        self.client.on_connect_fail = self._failed
        self.client.on_disconnect = self._lost
        self._properties = Properties(PacketTypes.CONNECT)
        self._properties.SessionExpiryInterval = keep
        if at_once:
            self._properties.ReceiveMaximum = at_once
        self._clean = not keep

    def start(self) -> None:
        """Connect, now and whenever the connection is lost; in a thread."""
        self.client.connect_async(
            self._at.host,
            self._at.port,
            keepalive=_ALIVE,
            clean_start=self._clean,
            properties=self._properties,
        )
        self.client.loop_start()

    def stop(self) -> None:
        """Say goodbye to the broker and end the thread."""
        self.client.disconnect()
        self.client.loop_stop()

    def _connected(
        self, client: Client, data: object, flags: object, code: object, properties: object
    ) -> None:
        if getattr(code, "is_failure", False):
            why = f"the broker refuses the monitor: {code}"
            if not self.connections and getattr(code, "value", 0) in _FOR_GOOD:
                self._give_up(why, f"give USER@ before the host and the password in {PASSWORD}")
            else:
                self._tell(f"the broker {self._at.name}: {why}")
            return
        self.connections += 1
        if self.away:
            self._say(f"the broker {self._at.name} is back")
        self.away = False
        if self._joined is not None:
            self._joined(client)
        self.connected = True

    def _attempt(self, connect: Callable[[], object]) -> object:
        """Connect; keep why that fails."""
        try:
            return connect()
        except OSError as error:
            self._why = error.strerror or str(error)
            if isinstance(error, ssl.SSLError):
                reason = getattr(error, "reason", None)  # what no handshake made has none
                self._why = getattr(error, "verify_message", "") or f"{reason or error}"
            cut = isinstance(error, _CUT_OFF)
            self._cut += cut
            if self._at.secure and (self._cut >= _CUT if cut else isinstance(error, ssl.SSLError)):
                self._untrusted(self._why)
            raise

    def _logged(self, client: Client, data: object, level: object, text: str) -> None:
        """See what else TLS says: that the broker wants a certificate comes after the handshake."""
        if "ALERT" in text and "SSL" in text:
            self._untrusted(text.partition("SSL: ")[2].partition("]")[0] or text)

    def _untrusted(self, why: str) -> None:
        if not self.connections:
            remedy = "see that the port is that of TLS, and name the authority that has signed its"
            remedy += " certificate in SSL_CERT_FILE"
            self._give_up(f"no TLS with the broker: {why}", remedy)

    def _give_up(self, why: str, remedy: str) -> None:
        self.refused = LogError(self._at.name, None, why, remedy)
        self._refuse(self.refused)

    def _failed(self, client: Client, data: object) -> None:
        why = f" ({self._why})" if self._why else ""
        self._tell(f"the broker {self._at.name} cannot be reached{why}")

    def _lost(
        self, client: Client, data: object, flags: object, code: object, properties: object
    ) -> None:
        self.connected = False
        if getattr(code, "is_failure", False):
            self._tell(f"the broker {self._at.name} is gone ({code})")

    def _tell(self, what: str) -> None:
        """Say that the broker is away, once for each time."""
        if not self.away and self.refused is None:
            self._say(f"{what}; it is tried again")
        self.away = True


class Publisher:
    """Publishes lines in their order with quality of service 1; the last one is retained.

    Lines that the broker has not taken are sent again when it is back. `taken` is the number up
    to which it has all. Beside them is what is `present`; `gone` is what the broker says there
    when the monitor is gone without a goodbye.
    """

    def __init__(self, at: Address, identity: str, taken: int = 0, gone: str = "") -> None:
        self.taken = taken
        self._topic = at.topic
        self._news: deque[str] = deque()
        self._queue: deque[tuple[int, str]] = deque()
        self._sent: dict[int, int] = {}  # on the way: number of the message -> of the verdict
        self._early: set[int] = set()  # messages taken before their number was known here
        self._newest = taken
        self._lock = Lock()
        self._present = ""  # what is retained beside the verdicts
        self._presented: set[int] = set()  # messages of it on the way
        will = (at.topic + PRESENCE, gone) if gone else None
        self._link = Link(at, identity, self._news.append, self._joined, will=will)
        self._link.client.on_publish = self._published
        self._link.start()

    def publish(self, number: int, line: str) -> None:
        """Send one line, now or when the broker is there."""
        self._queue.append((number, line))
        self._send()

    def present(self, line: str) -> None:
        """Say how the monitor is, now and after each connection; only the last word is kept."""
        self._present = line
        if self._link.connected:
            self._show()

    def check(self) -> None:
        """Raise the LogError that says why the broker refuses the monitor, if it does."""
        if self._link.refused is not None:
            raise self._link.refused

    def news(self) -> list[str]:
        """What there is to tell of the broker since the last call; to be called now and then.

        Raises LogError where it refuses the monitor.
        """
        self.check()
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
        while (self._queue or self._sent or self._presented) and time.monotonic() < end:
            if self._link.refused is not None:
                break
            self._send()
            time.sleep(0.005)
        self._link.stop()
        return len(self._queue) + len(self._sent)

    def _joined(self, client: Client) -> None:
        if self._present:  # meanwhile the broker may have said that the monitor is gone
            self._show()

    def _show(self) -> None:
        found = self._link.client.publish(self._topic + PRESENCE, self._present, qos=1, retain=True)
        with self._lock:
            if found.mid in self._early:
                self._early.remove(found.mid)
            else:
                self._presented.add(found.mid)

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
            elif mid in self._presented:
                self._presented.remove(mid)
            else:
                self._early.add(mid)
        if getattr(code, "is_failure", False):
            self._news.append(f"the broker does not take verdicts on {self._topic} ({code})")

    def _take(self, mid: int) -> None:
        self._newest = max(self._newest, self._sent.pop(mid))
        self.taken = min([self._newest, *(number - 1 for number in self._sent.values())])
