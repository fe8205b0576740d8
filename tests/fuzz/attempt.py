"""One text, given to what reads its kind under a limit of time, and fewer and fewer of it."""

from __future__ import annotations

import signal
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from tests.fuzz.mutate import ROOT

_PACKAGE = str(ROOT / "bondgraph")


class Kind(NamedTuple):
    """A kind of text: what reads it, sound ones to begin with, words that belong to it; whether
    they are models."""

    read: Callable[[bytes], str]
    seeds: Callable[[], list[bytes]]
    words: tuple[str, ...] = ()
    models: bool = False


class Finding(NamedTuple):
    """A text that broke what reads it: how and where, with a trace."""

    what: str
    trace: str
    text: bytes


class Slow(BaseException):
    """No answer in time; nothing that catches exceptions catches it."""


def finding(error: BaseException, text: bytes) -> Finding:
    """What became of a text that an exception ended; of one kind if `what` is the same."""
    frames = traceback.extract_tb(error.__traceback__)
    ours = [f for f in frames if f.filename.startswith(_PACKAGE)] or [frames[-1]]
    what = f"{type(error).__name__} in {Path(ours[-1].filename).name}:{ours[-1].name}"
    return Finding(what, "".join(traceback.format_exception(error, limit=-12)), text)


def attempt(
    read: Callable[[bytes], str], text: bytes, seconds: float = 20.0
) -> tuple[str, Finding | None]:
    """The answer to a text, and what broke, if it did or took longer."""
    usual = signal.signal(signal.SIGALRM, _too_slow)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        return read(text), None
    except (Exception, Slow) as error:
        signal.setitimer(signal.ITIMER_REAL, 0)
        found = finding(error, text)
        return found.what, found
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, usual)


def _too_slow(*_: object) -> None:
    raise Slow


def smallest(text: bytes, fails: Callable[[bytes], bool], tries: int = 3000) -> bytes:
    """Fewer and fewer lines, then bytes, as long as the text still fails."""
    for separator in (b"\n", b""):
        parts = text.split(separator) if separator else [bytes([b]) for b in text]
        size = len(parts) // 2
        while size:
            at = 0
            while at < len(parts) and tries:
                tries -= 1
                shorter = parts[:at] + parts[at + size :]
                if fails(separator.join(shorter)):
                    parts = shorter
                else:
                    at += size
            size //= 2
        text = separator.join(parts)
    return text
