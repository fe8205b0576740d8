"""Samples from a file, in blocks; a CSV file can be followed while it grows."""

from __future__ import annotations

import hashlib
import os
import stat
from collections.abc import Iterator
from threading import Event
from typing import IO, Any

from bondgraph.runtime.log import TIME, Log, LogError
from bondgraph.runtime.log_file import read_form
from bondgraph.runtime.log_numbers import Form
from bondgraph.runtime.monitoring.sources.lines import Decoder
from bondgraph.runtime.monitoring.sources.sample_source import (
    IDLE,
    Chunk,
    Cutter,
    News,
    Source,
    rate_of,
)
from bondgraph.runtime.monitoring.sources.streams import Pipe
from bondgraph.text.regular_file import check_regular

_BLOCK = 1 << 20  # bytes read at a time
_ROWS = 20_000  # of a table, given at a time
_PATIENCE = 20  # lines that are no samples, all for the same cause, before the first one that is
_HEAD = 512  # bytes by which a file is known again


class LoadedLog(Source):
    """A log that is in memory as a whole; a place is the number of a row."""

    replays = True

    def __init__(self, name: str, log: Log) -> None:
        self.name = name
        self._log = log
        self._row = 0
        self._until = 0  # before this row all was computed once

    def chunks(self, stop: Event) -> Iterator[Chunk]:
        """All rows, some thousand at a time."""
        while self._row < self._log.rows and not stop.is_set():
            again = self._row < self._until
            end = self._until if again else self._log.rows
            part = self._log.part(self._row, min(self._row + _ROWS, end))
            self._row += part.rows
            yield Chunk(part, place={"row": self._row}, again=again)

    def go(self, position: dict[str, Any]) -> str:
        """Go on from a row."""
        until = (position.get("place") or {}).get("row", 0)
        if until > self._log.rows:
            return f"the file has only {self._log.rows} samples now"
        self._row = (position.get("back") or {}).get("row", 0)
        self._until = until
        return ""

    def rate(self) -> float | None:
        """Samples a second, of the first ones."""
        return rate_of(self._log.fastest())

    def samples(self) -> float | None:
        """See `Source`."""
        return float(self._log.rows)

    def whole(self) -> Iterator[Log]:
        """See `Source`."""
        yield self._log

    def time(self) -> str:
        """See `Source`."""
        return self._log.meta.get(TIME, "")


class LinesFile(Source):
    """A file of lines; a place is a number of bytes, and what the file began with.

    With `follow` its end is waited at, as `tail -F` does: what is added is read, and a file that
    was cut or replaced is read from its start.
    """

    replays = True
    decoder: Decoder

    def __init__(self, path: str, form: Form, follow: bool = False) -> None:
        self.name = os.path.abspath(path)
        self.decoder = Decoder(form)
        self._path, self._follow = path, follow
        self.live = follow
        self._file = self._open()
        self._cutter = Cutter()
        self._offset = 0  # of the first byte behind the lines that were taken
        self._until = 0  # before this byte all was computed once

    def chunks(self, stop: Event) -> Iterator[Chunk]:
        """All lines, and those that are added until `stop` is set."""
        while not stop.is_set():
            left = self._until - self._file.tell()
            piece = self._file.read(min(_BLOCK, left) if left > 0 else _BLOCK)
            if piece:
                yield from self._taken(piece)
                if len(piece) == left and self._cutter.rest:  # the last line had no end then
                    yield from self._taken(b"\n", added=0)
            elif not self._follow:
                if self._cutter.rest:  # the last line has no line feed
                    yield from self._taken(b"\n", added=0)
                return
            else:
                yield from self._waited(stop)

    def go(self, position: dict[str, Any]) -> str:
        """Go on from a number of bytes, after reading the header again."""
        place, back = position.get("place") or {}, position.get("back") or {}
        until = int(place.get("offset", 0))
        size = os.fstat(self._file.fileno()).st_size
        if size < until or (until and self._head(until) != place.get("head")):
            return f"{self._path} is another file now"
        self._until, self._offset = until, int(back.get("offset", 0))
        if self._offset:
            self._header(self._offset)
            self.decoder.rows = int(back.get("rows", 0))
            self.decoder.lines = int(back.get("lines", 0))
        self._file.seek(self._offset)
        return ""

    def rate(self) -> float | None:
        """Samples a second, of the first ones."""
        first = self._first()
        return rate_of(first.fastest()) if first else None

    def samples(self) -> float | None:
        """As many as fit into the file, if all lines are as long as the first ones."""
        if self._follow:
            return None
        with self._open() as file:
            head = file.read(_BLOCK // 8)
            size = os.fstat(file.fileno()).st_size
        return head.count(b"\n") * size / len(head) if head else None

    def whole(self) -> Iterator[Log]:
        """See `Source`."""
        decoder = Decoder(self.decoder.form)
        with self._open() as file:
            while not self._follow and (lines := file.readlines(_BLOCK)):
                yield from decoder.feed(b"".join(lines))

    def time(self) -> str:
        """See `Source`."""
        first = self._first()
        return first.meta.get(TIME, "") if first else ""

    def _first(self) -> Log | None:
        with self._open() as file:
            lines = file.readlines(_BLOCK // 8)
        logs = Decoder(self.decoder.form).feed(b"".join(lines))
        return logs[0] if logs else None

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _header(self, end: int) -> None:
        """Read comments and the header at the start of the file, without samples."""
        self._file.seek(0)
        while self._file.tell() < end and not self.decoder.rows:
            self.decoder.feed(self._file.readline(_BLOCK))
        self.decoder.garbage = 0

    def _open(self) -> IO[bytes]:
        try:
            check_regular(self._path)
            return open(self._path, "rb")
        except OSError as error:
            raise LogError(self._path, None, f"cannot be read: {error.strerror}") from error

    def _taken(self, piece: bytes, added: int | None = None) -> Iterator[Chunk]:
        block = self._cutter.cut(piece)
        if block is None:
            return
        self._offset += len(block.lines) if added is None else len(block.lines) - 1
        again = self._offset <= self._until
        logs = self.decoder.feed(block.lines, block.whole)
        self.decoder.check(_PATIENCE)
        for log in logs[:-1]:
            yield Chunk(log, again=again)
        yield Chunk(logs[-1] if logs else None, place=self._place(), again=again)

    def _waited(self, stop: Event) -> Iterator[Chunk]:
        """Wait for more; begin again with a file that was cut or replaced."""
        yield Chunk()
        stop.wait(IDLE / 2)
        try:
            now = os.stat(self._path)
        except FileNotFoundError:
            return  # between two files
        old = os.fstat(self._file.fileno())
        if now.st_size < self._file.tell() and os.path.samestat(now, old):
            what = "was cut"
        elif not os.path.samestat(now, old):
            rest = self._file.read()
            if rest:  # came in the last moment
                yield from self._taken(rest)
            what = "was replaced"
        else:
            return
        self._file.close()
        self._file = self._open()
        self._offset = self._until = 0
        self._cutter = Cutter()
        yield Chunk(news=(News("gap", f"{self._path} {what}, read from its start"),))

    def _place(self) -> dict[str, Any]:
        place = {"offset": self._offset, "rows": self.decoder.rows, "lines": self.decoder.lines}
        return place | {"head": self._head(self._offset)}

    def _head(self, offset: int) -> str:
        """By what the file is known again: its first bytes, of those before `offset`."""
        at = self._file.tell()
        self._file.seek(0)
        head = self._file.read(min(_HEAD, offset))
        self._file.seek(at)
        return hashlib.sha256(head).hexdigest()[:16]


def _mode(path: str) -> int:
    """What kind of file it is; 0 for one that is not there."""
    try:
        return os.stat(path).st_mode
    except OSError:
        return 0


def file_source(path: str, form: Form, follow: bool = False) -> Source:
    """The samples in a file, by its suffix, or from a named pipe."""
    if stat.S_ISFIFO(_mode(path)):
        return Pipe(form, os.open(path, os.O_RDONLY), path)
    if path.lower().endswith((".parquet", ".mcap")):
        if follow:
            kind = "a Parquet file" if path.lower().endswith(".parquet") else "an MCAP file"
            raise LogError(path, None, f"{kind} cannot be followed", "follow a CSV file")
        return LoadedLog(os.path.abspath(path), read_form(path, form))
    return LinesFile(path, form, follow)
