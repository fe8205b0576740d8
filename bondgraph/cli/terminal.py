"""The streams of a command: nothing that came from outside reaches a terminal or a log raw."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TextIO

from bondgraph.text.printable import printable


class Printable:
    """A stream that prints text printably; all else is done by the stream itself."""

    def __init__(self, stream: TextIO) -> None:
        self.raw = stream

    def write(self, text: str) -> int:
        """Write text as `printable` makes it, and with what the encoding has."""
        text = printable(text)
        try:
            return self.raw.write(text)
        except UnicodeEncodeError:
            encoding = self.raw.encoding or "ascii"
            return self.raw.write(text.encode(encoding, "replace").decode(encoding))

    def writelines(self, lines: list[str]) -> None:
        """Write each of them."""
        for line in lines:
            self.write(line)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.raw, name)


def styled(stream: TextIO, text: str) -> None:
    """Write text that has colours or moves the cursor, all of it ours."""
    getattr(stream, "raw", stream).write(text)


def exactly(stream: TextIO, text: str) -> None:
    """Write data as they are, but not to a terminal."""
    (stream if stream.isatty() else getattr(stream, "raw", stream)).write(text)


@contextmanager
def printable_streams() -> Iterator[None]:
    """Have output and errors printed so until the end of the block."""
    before = sys.stdout, sys.stderr
    sys.stdout, sys.stderr = Printable(before[0]), Printable(before[1])
    try:
        yield
    finally:
        sys.stdout, sys.stderr = before
