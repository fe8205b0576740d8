"""Connections to a live server that say anything at all, before and after a sound handshake."""

from __future__ import annotations

import random
import socket
from contextlib import suppress

HANDSHAKE = (
    "GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n"
)
_WORDS = (
    b"GET / HTTP/1.1\r\n", b"GET /ws HTTP/1.1\r\n", b"\r\n", b"Content-Length: 99999999999\r\n",
    b"Transfer-Encoding: chunked\r\n", b"POST ", b"\xff\x00", b"GET /\xff%2e%2e/ HTTP/1.1\r\n",
    b"Host: \xff\r\n", b"Host: 127.0.0.1\r\n", b"Origin: http://\xe9\r\n", b"HTTP/9.9",
    b"Host: [::1\r\n", b"Upgrade: websocket\r\n", b"GET //evil/ws HTTP/1.1\r\n",
    b"GET http://[ HTTP/1.1\r\n", b"Sec-WebSocket-Key: x\r\n", b"Expect: 100-continue\r\n",
)  # fmt: skip
_OPERATIONS = (0x81, 0x82, 0x01, 0x00, 0x80, 0x88, 0x89, 0x8A, 0xF1, 0x83, 0xC1)


def garbage(port: int, count: int, seed: int) -> None:
    """Open so many connections one after the other; each says something and goes."""
    rng = random.Random(seed)
    for k in range(count):
        with socket.socket() as made, suppress(OSError):
            made.settimeout(0.05)
            made.connect(("127.0.0.1", port))
            if k % 2:
                made.sendall(HANDSHAKE.format(port=port).encode())
                if k % 4 == 1:
                    made.recv(100)
                made.sendall(b"".join(_frame(rng) for _ in range(rng.randrange(4))))
            else:
                made.sendall(b"".join(rng.choice(_WORDS) for _ in range(rng.randrange(1, 8))))
                made.sendall(b"\r\n\r\n" if rng.random() < 0.5 else b"")
            if rng.random() < 0.3:
                made.recv(100)


def _frame(rng: random.Random) -> bytes:
    """Bytes as a frame of a WebSocket of any operation, or without a head."""
    data = rng.randbytes(rng.randrange(200))
    size = len(data)
    length = bytes([0x80 | size]) if size < 126 else b"\xfe" + size.to_bytes(2, "big")
    head = bytes([rng.choice(_OPERATIONS)]) + length + b"\0\0\0\0"
    return head + data if rng.random() < 0.8 else data
