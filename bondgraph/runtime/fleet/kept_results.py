"""The output of a fleet, which is written whole at the end, and what is known before that."""

from __future__ import annotations

import os
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from bondgraph.runtime.fleet.verdict_table import check_name, read_verdicts, write_verdicts
from bondgraph.runtime.fleet.watched_log import BAD, WatchedLog, from_json_record
from bondgraph.runtime.log import LogError
from bondgraph.text.checked_line import checked_line, record_of
from bondgraph.text.whole_file import remove_leftovers, write_bytes


class KeptResults:
    """Results by their keys: of the output file of an earlier run, and of one that was broken off.

    Until the output is written, `OUTPUT.part` has a file of JSON for each log that is done. Bad
    logs are not kept: perhaps they can be read the next time. Raises LogError for an output that is
    there and is no table of verdicts, or that cannot be written here.
    """

    def __init__(self, output: str) -> None:
        check_name(output)
        self._output, self.folder = output, Path(f"{output}.part")
        self.known: dict[str, WatchedLog] = {}
        if os.path.exists(output):
            self._learn(read_verdicts(output))
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            self._learn(filter(None, map(_kept, sorted(self.folder.glob("*.json")))))
        except OSError as error:
            message = f"cannot be written: {error.strerror or error}"
            raise LogError(str(self.folder), None, message) from error

    def _learn(self, logs: Iterable[WatchedLog]) -> None:
        self.known |= {log.key: log for log in logs if log.key and log.state != BAD}

    def keep(self, found: WatchedLog) -> None:
        """Put down what came of one log."""
        if found.state == BAD:
            return
        self.folder.mkdir(exist_ok=True)  # another run may have finished
        level = None if found.level is None else repr(found.level)  # it may be infinite
        line = checked_line({**found.to_record(), "level": level})
        write_bytes(self.folder / f"{found.key}.json", line)

    def finish(self, logs: Iterable[WatchedLog]) -> None:
        """Write the output; what was kept beside it is no longer needed."""
        write_verdicts(self._output, logs)
        self.discard()

    def discard(self) -> None:
        """Remove what was kept beside the output, and nothing that is not ours."""
        remove_leftovers(self.folder)
        for path in self.folder.glob("*.json"):
            path.unlink(missing_ok=True)
        with suppress(OSError):
            self.folder.rmdir()


def _kept(path: Path) -> WatchedLog | None:
    """What was put down for a log; None for a file that is not that: the log is watched again."""
    try:
        record = record_of(path.read_bytes().removesuffix(b"\n"))
        level = None if record["level"] is None else float(record["level"])
        return from_json_record({**record, "level": level})
    except (OSError, KeyError, TypeError, ValueError, AttributeError, OverflowError):
        return None
