"""The file that is edited, with its pages: read, watched on the disk, and written formatted."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from threading import Event, Lock
from typing import Any

from bondgraph.cli.workbench.language_talk import language_talk
from bondgraph.frontend.formatter import format_text
from bondgraph.frontend.read import decode
from bondgraph.runtime.live.guests import Talk
from bondgraph.text import limits
from bondgraph.text.diagnostic import CompileError, Report
from bondgraph.text.regular_file import check_regular
from bondgraph.text.whole_file import write_bytes

_LOOK = 0.5  # s between two looks at the disk


class OnDisk:
    """The file on the disk: `digest` of what was seen of it last, "" where there is none."""

    def __init__(self, path: str) -> None:
        self.path = path
        self._lock = Lock()
        self._stamp: tuple[int, int, int] | None = None
        self.text, self.digest = self._read()

    def _read(self) -> tuple[str, str]:
        """Its text and digest; raises CompileError where it is no text, OSError if too large."""
        self._stamp = _stamp(self.path)
        if self._stamp is None:
            return "", ""
        check_regular(self.path, limits.EDIT_BYTES)
        with open(self.path, "rb") as file:
            data = file.read(limits.EDIT_BYTES + 1)
        report = Report()
        source = decode(self.path, data, report)
        if source is None:
            raise CompileError(tuple(report.diagnostics))
        return source.text, hashlib.sha256(data).hexdigest()

    def changed(self) -> bool:
        """Whether somebody else has written it since; then text and digest are the new ones."""
        with self._lock:
            return self._looked()

    def _looked(self) -> bool:
        if _stamp(self.path) == self._stamp:
            return False
        before = self.digest
        try:
            self.text, self.digest = self._read()
        except (CompileError, OSError):  # it will be told when it is asked for
            self.digest = f"unreadable {self._stamp}"
        return self.digest != before

    def save(self, text: str, seen: str) -> str | None:
        """Write the text as `format` writes it, and give it; None where the file is not as `seen`.

        Raises CompileError for a text with a syntax error, OSError where it cannot be written.
        """
        report = Report()
        source = decode(self.path, text.encode(errors="surrogatepass"), report)
        found = None if source is None else format_text(source, report)
        if found is None:
            raise CompileError(tuple(report.diagnostics))
        data = found.encode()
        with self._lock:
            self._looked()
            if self.digest != seen:
                return None
            write_bytes(self.path, data)
            self._stamp = _stamp(self.path)
            self.text, self.digest = found, hashlib.sha256(data).hexdigest()
        return found


def _stamp(path: str) -> tuple[int, int, int] | None:
    """What changes whenever a file is written; None where there is none."""
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino


class Bench:
    """One file with its pages; `desk` makes what a page talks with."""

    def __init__(self, disk: OnDisk, desk: Callable[[Bench], Any]) -> None:
        self.disk = disk
        self.desks: set[Any] = set()
        self._stop = Event()
        size = 6 * limits.EDIT_BYTES  # JSON takes up to six letters for one
        self.talks = {
            "/ws": Talk(lambda: desk(self), limits.EDITORS, size, limits.KEYS_A_SECOND),
            "/lsp": language_talk(),
        }

    def run(self) -> None:
        """See `Service`: tell pages when somebody else writes the file."""
        while not self._stop.wait(_LOOK):
            if self.disk.changed():
                self.told({"type": "disk", "text": self.disk.text, "digest": self.disk.digest})

    def told(self, message: dict[str, Any], besides: Any = None) -> None:
        """Tell all pages, but for one."""
        for desk in list(self.desks):
            if desk is not besides:
                desk.say(message)

    def stop(self, who: str) -> None:
        """See `Service`."""
        self._stop.set()
        for desk in list(self.desks):
            desk.end()
