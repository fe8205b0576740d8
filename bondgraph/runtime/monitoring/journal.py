"""What a monitor has said and how far it was, in a file that survives a kill at any moment."""

from __future__ import annotations

import contextlib
import json
import os
import time
from collections.abc import Sequence
from typing import Any

from bondgraph.runtime.monitoring.verdict import Verdict, from_record, to_json
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.tuples import NamedTuple

_EDITION = 1
_OLD = 1 << 20  # bytes of positions that are no longer needed, after which the file is cleaned


class JournalError(Trouble):
    """A journal that cannot be used: what is wrong, and a remedy."""


class Past(NamedTuple):
    """What a journal knows: the last position with the state of the decision then, all verdicts
    with their numbers, up to which number they were published, and when that was written (s since
    the epoch)."""

    source: str
    position: dict[str, Any]
    state: dict[str, Any] | None
    verdicts: tuple[tuple[int, Verdict], ...]
    sent: int
    at: float


class Journal:
    """An append-only file of JSON lines, each on the disk before the call returns.

    A line has what belongs together: verdicts, the position after them, the state of the decision
    there. So there is no moment at which one is known without the others. Old positions are
    cleaned away once they are many; verdicts stay for ever.
    """

    def __init__(self, path: str, model: str, digest: str, source: str, rate: float) -> None:
        self.past: Past | None = None
        self._path = path
        self._head = {"journal": _EDITION, "model": model, "digest": digest, "source": source,
                      "rate": rate}  # fmt: skip
        self._lines: list[str] = []  # of verdicts, kept for cleaning
        self._sent = 0
        self._old = 0  # bytes that could be cleaned away
        self._file = self._opened()
        try:
            if not _lock(self._file):
                message = "another monitor writes it; give this one a journal of its own"
                raise JournalError(f"{path}: {message}")
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
        """Put down verdicts, and how far the watch is."""
        record: dict[str, Any] = {"at": round(time.time(), 3)}
        if verdicts:
            record["verdicts"] = [json.loads(to_json(v, n)) for n, v in verdicts]
        line = _line(record | {"position": position, "state": state})
        if verdicts:
            self._lines.append(_line(record))
        self._append(line)
        self._old += len(line)
        if self._old > _OLD:
            self._clean(line)

    def sent(self, number: int) -> None:
        """Put down that all verdicts up to this one were published."""
        if number > self._sent:
            self._sent = number
            line = _line({"sent": number})
            self._append(line)
            self._old += len(line)

    def close(self) -> None:
        """Close the file, for another monitor to open."""
        os.close(self._file)

    def _append(self, line: str) -> None:
        data = line.encode()
        try:
            while data:
                data = data[os.write(self._file, data) :]
            os.fsync(self._file)
        except OSError as error:
            raise self._unwritable(error) from error

    def _unwritable(self, error: OSError) -> JournalError:
        return JournalError(f"{self._path}: cannot be written: {error.strerror}")

    def _clean(self, last: str) -> None:
        """Write the file anew without old positions: the whole of it, or the old one stays."""
        temporary = f"{self._path}.new"
        file = os.open(temporary, os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND, 0o644)
        _lock(file)
        old, self._file = self._file, file
        without = {k: v for k, v in json.loads(last).items() if k != "verdicts"}
        kept = [_line(self._head), *self._lines, _line({"sent": self._sent}), _line(without)]
        self._append("".join(kept))
        os.replace(temporary, self._path)
        _sync_folder(self._path)
        os.close(old)
        self._old = 0

    # --------------------------------------------------------------------------- reading

    def _opened(self) -> int:
        try:
            return os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o644)
        except OSError as error:
            raise self._unwritable(error) from error

    def _read(self) -> None:
        with open(self._file, "rb", closefd=False) as file:
            data = file.read()
        records, good = self._records(data)
        if records:
            self._check(records[0])
            self.past = self._known(records)
        elif not _line(self._head).encode().startswith(data):
            raise JournalError(f"{self._path}: is not a journal; give another file")
        if good < len(data):  # a line that was not finished when the monitor was killed
            os.truncate(self._file, good)
        if not records:
            self._append(_line(self._head))
            _sync_folder(self._path)
        elif self.past is None or self.past.source != self._head["source"]:
            self._append(_line({"source": self._head["source"]}))

    def _check(self, head: dict[str, Any]) -> None:
        """Refuse what another program, version or model has written."""
        if head.get("journal") != _EDITION:
            message = "is not a journal of this version of bondgraph; give another file"
            raise JournalError(f"{self._path}: {message}")
        if head.get("digest") != self._head["digest"]:
            message = (
                f"belongs to another model or other options ({head.get('model')},"
                f" {head.get('digest')}; this is {self._head['model']}, {self._head['digest']});"
                " give another file, or move this one away to begin anew"
            )
            raise JournalError(f"{self._path}: {message}")

    def _records(self, data: bytes) -> tuple[list[dict[str, Any]], int]:
        """The records, and where in the file the last good one ends."""
        records = []
        good = at = 0
        for line in data.split(b"\n")[:-1]:
            at += len(line) + 1
            with contextlib.suppress(ValueError):
                record = json.loads(line)
                if isinstance(record, dict):
                    if good < at - len(line) - 1:
                        message = f"is damaged before byte {at}; move it away to begin anew"
                        raise JournalError(f"{self._path}: {message}")
                    records.append(record)
                    good = at
        return records, good

    def _known(self, records: list[dict[str, Any]]) -> Past | None:
        verdicts: list[tuple[int, Verdict]] = []
        position: dict[str, Any] = {}
        state, at, source = None, 0.0, str(self._head["source"])
        try:
            for record in records:
                self._sent = int(record.get("sent", self._sent))
                at = float(record.get("at", at))
                source = str(record.get("source", source))
                if "verdicts" in record:
                    verdicts += [from_record(v) for v in record["verdicts"]]
                    self._lines.append(_line({k: record[k] for k in ("at", "verdicts")}))
                if "position" in record:
                    position, state = record["position"], record["state"]
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            message = "has a line that is none of a journal; move it away to begin anew"
            raise JournalError(f"{self._path}: {message}") from error
        if not position and not verdicts:
            return None
        return Past(source, position, state, tuple(verdicts), self._sent, at)


def known_rate(path: str) -> float | None:
    """The samples a second that a journal was begun with; None if there is no such journal."""
    try:
        with open(path, encoding="utf-8") as file:
            return float(json.loads(file.readline())["rate"])
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _line(record: dict[str, Any]) -> str:
    return json.dumps(record, ensure_ascii=False, allow_nan=False) + "\n"


def _lock(file: int) -> bool:
    """Keep others from writing; False where another one does. The lock ends with the process."""
    try:
        import fcntl
    except ImportError:  # not on this system
        return True
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True


def _sync_folder(path: str) -> None:
    """Put the name of a new file on the disk."""
    with contextlib.suppress(OSError):
        folder = os.open(os.path.dirname(os.path.abspath(path)), os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)
