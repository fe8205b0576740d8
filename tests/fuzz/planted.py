"""Kinds that break on purpose, each in a way that the fuzzer has to see."""

from __future__ import annotations

import time
from collections import deque
from itertools import count

import atheris

from tests.fuzz.attempt import Kind

WORDS = ("word",)
# Too long to be made again by chance.
ENDLESS, STUCK, HUNGRY = b"endless, " * 20, b"stuck, " * 20, b"hungry, " * 20
_kept: list[bytes] = []


@atheris.instrument_func  # type: ignore[misc]
def deep(text: bytes) -> str:
    """Breaks behind four letters, each with a branch of its own: chance needs 10^9 texts."""
    if text[:1] == b"\xb0":
        if text[1:2] == b"\x9d":
            if text[2:3] == b"\x04":
                if text[3:4] == b"\xe7":
                    raise LookupError("planted")
                return "three"
            return "two"
        return "one"
    return "none"


def endless(text: bytes) -> str:
    """Gives no answer to one text."""
    while text == ENDLESS:
        pass
    return f"sound {len(text) % 5}"


def stuck(text: bytes) -> str:
    """Goes into C for one text and does not come back: no signal reaches Python there."""
    if text == STUCK:
        deque(count(), maxlen=0)
    return f"sound {len(text) % 5}"


def hungry(text: bytes) -> str:
    """Takes memory for one text, and all of it if nobody ends that."""
    while text == HUNGRY:
        _kept.append(b"\1" * (1 << 20))
        time.sleep(0.005)
    return f"sound {len(text) % 5}"


KINDS = {
    "deep": Kind(deep, lambda: [b"abcdefgh"]),
    "endless": Kind(endless, lambda: [b"first", ENDLESS]),
    "stuck": Kind(stuck, lambda: [b"first", STUCK]),
    "hungry": Kind(hungry, lambda: [b"first", HUNGRY]),
}
