"""Lines of text from a machine, CSV or JSON, to samples; what is no sample is counted."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Iterator
from itertools import islice

import numpy as np

from bondgraph.runtime.log import MARK, Log, LogError
from bondgraph.runtime.log_numbers import (
    Form,
    Reader,
    Table,
    cells_of,
    finite,
    number,
    separator_of,
)
from bondgraph.runtime.time_column import chosen, stamp
from bondgraph.text.limits import COLUMNS, LINE_BYTES

_CAUSES = 2  # of lines that are no samples: more than one is noise
_JSON = re.compile(r"\s*(?:\{|\[\s*[{\]])")  # no row of units, `[s],[V]`
_UNIT = re.compile(r"# unit ((?:[^\\:]|\\.)+): (.*)")


class Decoder(Reader):
    """Makes logs of blocks of whole lines.

    A line is a row of CSV, a header, a comment, a JSON object of numbers by name or an array of
    such objects. A header may come again, as after a restart of the device. `garbage` counts the
    lines that are none of these; `example` is the last one of them, `why` says what is wrong with
    it and in which line, of `lines` so far.
    """

    def __init__(self, form: Form) -> None:
        super().__init__(form)
        self.garbage = self.lines = 0
        self.example = self.why = ""
        self._causes: dict[str, LogError] = {}
        self._key: str | None = None  # of time in objects, once it is known
        self._refused: LogError | None = None
        self._table: Table | None = None
        self.declare()

    def declare(self) -> None:
        """Forget the header, as if no line had come: that of the form is in force again."""
        self._table = None
        names = list(self.form.columns)
        if names:
            self._table = self._header_of(names, "", _is_name, strict=False)

    def feed(self, block: bytes, whole: bool = True) -> list[Log]:
        """The samples in the lines of a block, which ends with a line.

        Several logs where a header comes in between. With `whole` false the block may begin
        in the middle of a line; that line counts only if it cannot be a part of another one.
        Raises LogError for times in a unit that is none.
        """
        lines = block.decode("utf-8", errors="replace").replace("\ufeff", "").splitlines()
        found = []
        if not whole and lines and not self._complete(lines[0]):
            self._waste(0, lines[0], "the end of a line")
            self.lines += 1
            del lines[0]
        at, size = 0, len(lines)
        while at < size:
            count = self._head(lines, at)
            self.lines += count
            at += count
            end = next((k for k in range(at, size) if self._special(lines[k])), size)
            found += self._csv(lines[at:end])
            self.lines += end - at
            at = end
            end = next((k for k in range(at, size) if not _JSON.match(lines[k])), size)
            found += self._json(lines[at:end])
            self.lines += end - at
            at = end
        return found

    def check(self, most: int = 0) -> None:
        """Raise the LogError that says why no line could be used, if that is so.

        That is known once more than so many are no samples, all for the same cause.
        """
        if self.rows or self.garbage < most:
            return
        if self._refused is not None:
            raise self._refused
        if len(self._causes) == 1:
            raise next(iter(self._causes.values()))

    # ------------------------------------------------------------------ comments and headers

    def _special(self, line: str) -> bool:
        """Whether a line is something else than a row of CSV."""
        first = line.lstrip()[:1]
        if first in ("", "#") or _JSON.match(line):
            return True
        return first not in _NUMERIC and self._header(line) is not None

    def _head(self, lines: list[str], at: int) -> int:
        """Take comments, headers and empty lines; how many there are from one line on."""
        for k, line in enumerate(islice(lines, at, None)):
            first = line.lstrip()[:1]
            if first == "#":
                self._comment(line)
            elif first:
                row = first in _NUMERIC or _JSON.match(line)
                table = None if row else self._header(line)
                if table is None:
                    return k
                self._table = table
        return len(lines) - at

    def _comment(self, line: str) -> None:
        if line.startswith(f"# {MARK} "):
            self._own = True
        elif (found := _UNIT.fullmatch(line)) and len(self._units) < COLUMNS:
            self._units[re.sub(r"\\(.)", r"\1", found[1])] = found[2]

    def _header(self, line: str) -> Table | None:
        """A line as a header if it is one: names, none twice, one of them of time."""
        if len(line) > LINE_BYTES:
            return None
        separator = separator_of(line)
        try:
            names = [name.strip() for name in cells_of(line, separator)]
        except csv.Error:
            return None
        names = names[:-1] if len(names) > 1 and not names[-1] else names
        if len(set(names)) < max(len(names), 2) or any(not _is_name(n) for n in names):
            return None
        try:
            return self._header_of(names, separator, _is_name, strict=False)
        except LogError as error:
            self._refused = error
            return None

    def _complete(self, line: str) -> bool:
        """Whether a line cannot be the end of a longer one."""
        line = line.strip()
        if line[:1] == "{":
            return line[-1:] == "}"
        return line[:1] == "#" or self._header(line) is not None

    # ------------------------------------------------------------------------------ rows

    def _csv(self, lines: list[str]) -> list[Log]:
        table = self._table
        if not lines:
            return []
        if table is None:
            why = "no header names the columns yet"
            for k, line in enumerate(lines):
                self._waste(k, line, why)
            if "\ufffd" in lines[0] and self._refused is None:
                help = "save it as UTF-8"
                self._refused = LogError(self.form.name, self.lines + 1, "not UTF-8", help)
            return []
        table.separator = table.separator or separator_of(lines[0])
        try:
            rows = table.rows(lines, lambda k, why: self._waste(k, lines[k], str(why), why.help))
        except LogError as error:
            for k, line in enumerate(lines):
                self._waste(k, line, error.message, error.help)
            return []
        return [self._log_of_table(table, rows, {})] if len(rows) else []

    def _json(self, lines: list[str]) -> list[Log]:
        objects = list(self._objects(lines))
        try:
            time = self._time_of([row for _, row in objects])
        except LogError as error:
            self._refused = error
            for k, _ in objects:
                self._waste(k, lines[k], error.message, error.help)
            return []
        kept = []
        stamped = False
        for k, found in objects:
            row = {n: x for n, v in found.items() if (x := _json_number(v)) is not None}
            at = None if time is None else _json_time(found.get(time))
            row.pop(time or "", None)
            if time is not None and not finite(at):
                self._waste(k, lines[k], "no time")
            elif time is not None or row:
                kept.append((at, row))
                stamped |= isinstance(found.get(time or ""), str)
        if not kept:
            return []
        every = dict.fromkeys(name for _, row in kept for name in row)
        names = list(every)[:COLUMNS]
        columns = {
            name: np.array([row.get(name, np.nan) for _, row in kept], dtype=np.float64)
            for name in names
        }
        times = None if time is None else np.array([at for at, _ in kept], np.float64)
        return [self._log(len(kept), times, time or "", columns, {}, stamped)]

    def _objects(self, lines: list[str]) -> Iterator[tuple[int, dict[str, object]]]:
        """The objects in lines of JSON, each with the number of its line among these."""
        for k, line in enumerate(lines):
            try:
                value = json.loads(line)
            except (ValueError, RecursionError):
                self._waste(k, line, "not JSON")
                continue
            for found in value if isinstance(value, list) else [value]:
                if isinstance(found, dict) and found:
                    yield k, {str(n): x for n, x in found.items()}
                else:
                    self._waste(k, line, "no object of JSON")

    def _time_of(self, rows: list[dict[str, object]]) -> str | None:
        """The key of time in some objects; None where the rate has to make one."""
        names = list(dict.fromkeys(name for row in rows for name in row))
        if not rows or self._key in names:
            return self._key
        numbers = {
            name: np.array([_json_time(row.get(name)) for row in rows], dtype=np.float64)
            for name in self._times_of(names)
        }
        self._key = chosen(numbers, self.form.name, self.form.rate is not None)
        return self._key

    def _waste(self, at: int, line: str, why: str, help: str = "") -> None:
        """Count a line that is no sample, so many behind those that were taken."""
        number = self.lines + at + 1
        self.garbage += 1
        self.example, self.why = line.strip()[:60], f"line {number}: {why}"
        if len(self._causes) < _CAUSES:
            cause = re.sub(r"`[^`]*`|\d+", "", why)
            self._causes.setdefault(cause, LogError(self.form.name, number, why, help))


_NUMERIC = frozenset("0123456789+-.,;")


def _is_name(text: str) -> bool:
    """Whether a cell can be a name or a word: it begins with a letter, and all can be printed."""
    plain = text.isprintable() and "\ufffd" not in text
    return plain and (text[:1].isalpha() or text[:1] == "_") and number(text) is None


def _json_time(value: object) -> float | None:
    """The time that a JSON value is, a number or a text."""
    return stamp(value) if isinstance(value, str) else _json_number(value)


def _json_number(value: object) -> float | None:
    """The number that a JSON value is, NaN for null, None for anything else."""
    if value is None:
        return float("nan")
    if isinstance(value, bool | int | float):
        try:
            return float(value)
        except OverflowError:
            return float("nan")
    return None
