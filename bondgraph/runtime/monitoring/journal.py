"""What a monitor has said and how far it was, in a file that survives a kill at any moment."""

from __future__ import annotations

import contextlib
import json
import os
import stat
import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from bondgraph.runtime.monitoring.journal_records import Found, read_records
from bondgraph.runtime.monitoring.verdict import Verdict, to_json
from bondgraph.text.checked_line import checked_line, record_of
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.file_lock import locked
from bondgraph.text.numerals import listed, plural
from bondgraph.text.tuples import NamedTuple
from bondgraph.text.whole_file import aside, remove_leftovers, sync_folder, write_bytes

_EDITION = 2  # the first one had no checksums
_OLD = 1 << 20  # bytes of positions that are no longer needed, after which the file is cleaned
_SHORTEST = len(to_json(Verdict("", 0.0), 1))  # bytes of a verdict, at least
_LONGEST = 1 << 20  # bytes of a first line


class JournalError(Trouble):
    """A journal that cannot be used: what is wrong, and a remedy."""


class Past(NamedTuple):
    """What a journal knows.

    The last position with the state of the decision then, all verdicts with their numbers, up to
    which number they were published, and when that was written (s since the epoch). `number` is the
    highest that a verdict can have been said with. `damage` says in words what of the journal could
    not be read, "" where that is nothing.
    """

    source: str
    position: dict[str, Any]
    state: dict[str, Any] | None
    verdicts: tuple[tuple[int, Verdict], ...]
    sent: int
    at: float
    number: int
    damage: str


class Journal:
    """An append-only file of JSON lines with checksums, each on the disk before the call returns.

    A line has what belongs together: verdicts, the position after them, the state of the decision
    there. So there is no moment at which one is known without the others. Old positions are
    cleaned away once they are many, where the folder lets that be done; verdicts stay for ever.

    A line that is damaged is left out, and `past` says so with its place; the file as it was found
    is kept beside. A last line without its end was being written when the monitor was killed.
    """

    def __init__(self, path: str, model: str, digest: str, source: str, rate: float) -> None:
        self.past: Past | None = None
        self._path = path
        self._head = {"journal": _EDITION, "model": model, "digest": digest, "source": source,
                      "rate": rate}  # fmt: skip
        self._said: list[dict[str, Any]] = []  # records of verdicts, kept for cleaning
        self._last: dict[str, Any] = {}  # the last position
        self._sent = 0
        self._count = 0  # of the last record
        self._size = 0  # bytes of all records
        self._old = 0  # bytes that could be cleaned away
        self._failed: JournalError | None = None
        remove_leftovers(Path(path).parent)
        self._file = self._opened()
        try:
            self._read()
        except BaseException:
            os.close(self._file)
            raise

    # --------------------------------------------------------------------------- writing

    def write(
        self,
        position: dict[str, Any],
        state: dict[str, Any],
        verdicts: Sequence[tuple[int, Verdict]] = (),
    ) -> None:
        """Put down verdicts, and how far the watch is; raises JournalError."""
        said: dict[str, Any] = {"at": round(time.time(), 3)}
        self._last = said | {"position": position, "state": state}
        if verdicts:
            said |= {"verdicts": [json.loads(to_json(v, n)) for n, v in verdicts]}
            self._said.append(said)
        self._append(said | self._last)

    def sent(self, number: int) -> None:
        """Put down that all verdicts up to this one were published; raises JournalError."""
        if number > self._sent:
            self._sent = number
            self._append({"sent": number})

    def close(self) -> None:
        """Close the file, for another monitor to open."""
        os.close(self._file)

    def _append(self, record: dict[str, Any]) -> None:
        """Put a record on the disk, all of it or nothing; after a failure nothing more."""
        if self._failed is not None:
            raise self._failed
        line = self._lines([record])
        try:
            _written(self._file, line)
            os.fsync(self._file)
        except OSError as error:
            with contextlib.suppress(OSError):
                os.ftruncate(self._file, self._size)
            self._failed = self._unwritable(error)
            raise self._failed from error
        self._size += len(line)
        self._old += len(line)
        if self._old > _OLD:
            self._old = 0
            with contextlib.suppress(OSError):  # no room for two, or no right to: it grows on
                self._clean()
            if not _is_at(self._file, self._path):
                message = "replaced while it was cleaned, so that what is written would be lost"
                self._failed = JournalError(f"{self._path}: {message}")
                raise self._failed

    def _lines(self, records: Iterable[dict[str, Any]]) -> bytes:
        lines = []
        for record in records:
            self._count += 1
            lines.append(checked_line({"n": self._count, **record}))
        return b"".join(lines)

    def _unwritable(self, error: OSError) -> JournalError:
        return JournalError(f"{self._path}: cannot be written: {error.strerror}")

    def _clean(self) -> None:
        """Write the file anew without old positions: the whole of it, or the old one stays."""
        before, self._count = self._count, 0
        last = [self._last] if self._last else []
        data = self._lines([self._head, *self._said, {"sent": self._sent}, *last])
        new = -1
        try:
            with aside(self._path) as (_, file):
                _written(file, data)
                new = os.dup(file)  # it keeps the lock
        except OSError:
            self._count = before
            if new >= 0:
                os.close(new)
            raise
        os.close(self._file)
        self._file, self._size, self._old = new, len(data), 0

    # --------------------------------------------------------------------------- reading

    def _opened(self) -> int:
        """The file with its lock."""
        flags = os.O_RDWR | os.O_CREAT | os.O_APPEND | _NO_WAIT
        while True:
            try:
                file = os.open(self._path, flags, 0o644)
            except OSError as error:
                raise self._unwritable(error) from error
            why = ""
            if not stat.S_ISREG(os.fstat(file).st_mode):
                why = "is no regular file; give another one"
            elif locked(file) is False:
                why = "another monitor writes it; give this one a journal of its own"
            elif _is_at(file, self._path):  # nobody has cleaned it in the meantime
                return file
            os.close(file)
            if why:
                raise JournalError(f"{self._path}: {why}")

    def _read(self) -> None:
        try:
            with open(self._file, "rb", closefd=False) as file:
                data = file.read()
            killed = b"\n" not in data and (data.startswith(_FIRST) or _FIRST.startswith(data))
            if not killed:
                self._take(data)
                return
            os.ftruncate(self._file, 0)  # there is nothing but the beginning of a first line
            sync_folder(os.path.dirname(os.path.abspath(self._path)))
        except OSError as error:
            raise JournalError(f"{self._path}: {error.strerror}") from error
        self._append(self._head)

    def _take(self, data: bytes) -> None:
        """Learn from what the file has, and mend it."""
        found = read_records(data)
        self._check(data, found)
        self._count, self._size = found.last, found.end
        for record in found.records:
            if "verdicts" in record:
                self._said.append({k: record[k] for k in ("at", "verdicts")})
            if "position" in record:
                self._last = {k: record[k] for k in ("at", "position", "state")}
            self._sent = record.get("sent", self._sent)
        words = self._damage(data, found)
        if found.damage:
            self._clean()
        elif found.end < len(data):
            os.ftruncate(self._file, found.end)
        self.past = self._known(found, words)
        if self.past is None or self.past.source != self._head["source"]:
            self._append({"source": self._head["source"]})

    def _check(self, data: bytes, found: Found) -> None:
        """Refuse what another program, version or model has written."""
        head = found.records[0] if found.records and found.records[0]["n"] == 1 else {}
        edition = head.get("journal", _edition(data))
        away = "move it away to begin anew"
        if not head and (found.records or edition == _EDITION):
            why = f"its first record is damaged: nobody knows of which model it is; {away}"
        elif edition is None:
            why = "is not a journal; give another file"
        elif edition != _EDITION or "digest" not in head:
            why = f"is a journal of another version of bondgraph (edition {edition}); {away}"
        elif head["digest"] != self._head["digest"]:
            why = (
                f"belongs to another model or other options ({head.get('model')},"
                f" {head['digest']}; this is {self._head['model']}, {self._head['digest']});"
                f" give another file, or {away}"
            )
        else:
            return
        raise JournalError(f"{self._path}: {why}")

    def _damage(self, data: bytes, found: Found) -> str:
        """In words: which lines are damaged, and what is lost with them. The file is kept then."""
        parts = [f"line {d.line}, at byte {d.byte}: {d.why}" for d in found.damage]
        if parts:
            numbers = {n for n, _ in found.verdicts}
            lost = [str(n) for n in range(1, max(numbers, default=0)) if n not in numbers]
            text = f"the journal is damaged ({listed(parts, 'and', 5)})"
            if lost:
                text += f", lost are the verdicts {listed(lost, 'and', 10)}"
            if found.doubtful:
                text += ", perhaps the last ones too" if lost else ", perhaps with verdicts"
            return f"{text}; as it was it is kept in {self._kept(data)}"
        if found.end < len(data):
            size = len(data) - found.end
            return f"the last {plural(size, 'byte')} of the journal are no whole record"
        return ""

    def _kept(self, data: bytes) -> str:
        """Keep a damaged file beside this one; where."""
        number = 1
        while True:
            place = Path(f"{self._path}.damaged" + (f"-{number}" if number > 1 else ""))
            if not os.path.lexists(place):
                write_bytes(place, data)
                return str(place)
            if place.is_file() and place.read_bytes() == data:  # of a start that was killed
                return str(place)
            number += 1

    def _known(self, found: Found, damage: str) -> Past | None:
        if not self._last and not found.verdicts and not damage:
            return None
        sources = [record["source"] for record in found.records if "source" in record]
        number = max((n for n, _ in found.verdicts), default=0)
        # As many as the damaged bytes can have held were said: no number is given twice.
        number += -(-found.doubtful // _SHORTEST)
        at = max((r["at"] for r in found.records if "at" in r), default=0.0)
        position, state = self._last.get("position", {}), self._last.get("state")
        return Past(sources[-1], position, state, found.verdicts, self._sent, at, number, damage)


#: What a journal begins with.
_FIRST = b'{"n": 1, "journal": '
#: Not to wait for the other end of a named pipe.
_NO_WAIT = getattr(os, "O_NONBLOCK", 0)


def known_rate(path: str) -> float | None:
    """The samples a second that a journal was begun with; None if there is no such journal."""
    try:
        if not os.path.isfile(path):
            return None  # a named pipe has nobody who writes
        with open(path, "rb") as file:
            rate = record_of(file.readline(_LONGEST).removesuffix(b"\n"))["rate"]
    except (OSError, ValueError, KeyError):
        return None
    return float(rate) if isinstance(rate, int | float) and rate > 0.0 else None


def _edition(data: bytes) -> int | None:
    """The edition that the first line of any journal tells; None if it is not one."""
    try:
        head = json.loads(data.split(b"\n", 1)[0])
    except (ValueError, RecursionError):
        return None
    edition = head.get("journal") if isinstance(head, dict) else None
    return edition if isinstance(edition, int) else None


def _is_at(file: int, path: str) -> bool:
    """Whether an open file is the one of this name."""
    try:
        return os.path.samestat(os.fstat(file), os.stat(path))
    except OSError:
        return False


def _written(file: int, data: bytes) -> None:
    """Write all of the data; raises OSError."""
    while data:
        data = data[os.write(file, data) :]
