"""Lines of text from a machine, CSV or JSON, to samples; what is no sample is counted."""

from __future__ import annotations

import csv
import json
import re

import numpy as np

from bondgraph.runtime.log import MARK, Log, LogError, name_of_time, no_time, time_column
from bondgraph.runtime.log_numbers import (
    Form,
    Reader,
    Table,
    cells_of,
    finite,
    number,
    separator_of,
)

_UNIT = re.compile(r"# unit ((?:[^\\:]|\\.)+): (.*)")


class Decoder(Reader):
    """Makes logs of blocks of whole lines.

    A line is a row of CSV, a header, a comment, a JSON object of numbers by name or an array of
    such objects. A header may come again, as after a restart of the device. `garbage` counts the
    lines that are none of these, `example` is the last one of them.
    """

    def __init__(self, form: Form) -> None:
        super().__init__(form)
        self.garbage = 0
        self.example = ""
        self._refused: LogError | None = None
        self._table: Table | None = None
        self.declare()

    def declare(self) -> None:
        """Forget the header, as if no line had come: that of the form is in force again."""
        self._table = None
        names = list(self.form.columns)
        if names:
            self._table = _table(names, "", self._time_of(names))

    def feed(self, block: bytes, whole: bool = True) -> list[Log]:
        """The samples in the lines of a block, which ends with a line.

        Several logs where a header comes in between. With `whole` false the block may begin
        in the middle of a line; that line counts only if it cannot be a part of another one.
        Raises LogError where lines are sound, but have no column of time.
        """
        lines = block.decode("utf-8", errors="replace").replace("\ufeff", "").splitlines()
        found = []
        if not whole and lines and not self._complete(lines[0]):
            self._waste(lines.pop(0))
        while lines:
            taken = self._head(lines)
            lines = lines[taken:]
            count = next((k for k, s in enumerate(lines) if self._special(s)), len(lines))
            if count:
                found += self._csv(lines[:count])
                lines = lines[count:]
            count = next((k for k, s in enumerate(lines) if s[:1] not in ("{", "[")), len(lines))
            if count:
                found += self._json(lines[:count])
                lines = lines[count:]
        return found

    def check(self) -> None:
        """Raise the LogError that says why no line could be used, if that is so."""
        if self._refused is not None and not self.rows:
            raise self._refused

    # ------------------------------------------------------------------ comments and headers

    def _special(self, line: str) -> bool:
        """Whether a line is something else than a row of CSV."""
        first = line.lstrip()[:1]
        if first in ("", "#", "{", "["):
            return True
        return first not in _NUMERIC and self._header(line) is not None

    def _head(self, lines: list[str]) -> int:
        """Take comments, headers and empty lines; how many there are at the start."""
        for k, line in enumerate(lines):
            first = line.lstrip()[:1]
            if first == "#":
                self._comment(line)
            elif first:
                table = None if first in "{[" or first in _NUMERIC else self._header(line)
                if table is None:
                    return k
                self._table = table
        return len(lines)

    def _comment(self, line: str) -> None:
        if line.startswith(f"# {MARK} "):
            self._own = True
        elif found := _UNIT.fullmatch(line):
            self._units[re.sub(r"\\(.)", r"\1", found[1])] = found[2]

    def _header(self, line: str) -> Table | None:
        """A line as a header if it is one: names, none twice, one of them of time."""
        separator = separator_of(line)
        try:
            names = [name.strip() for name in cells_of(line, separator)]
        except csv.Error:
            return None
        names = names[:-1] if len(names) > 1 and not names[-1] else names
        if len(set(names)) < max(len(names), 2) or any(not _is_name(n) for n in names):
            return None
        try:
            time = self._time_of(names)
        except LogError as error:
            self._refused = error
            return None
        return _table(names, separator, time)

    def _time_of(self, names: list[str]) -> str | None:
        wanted = self.form.time
        if wanted is None and self._own and names[0] == name_of_time(names[1:]):
            return names[0]
        time = time_column(names, wanted, self.form.name, None)
        if time is None and self.form.rate is None:
            raise no_time(self.form.name, None, names)
        return time

    def _complete(self, line: str) -> bool:
        """Whether a line cannot be the end of a longer one."""
        line = line.strip()
        if line[:1] == "{":
            return line[-1:] == "}"
        return line[:1] == "#" or self._header(line) is not None

    # ------------------------------------------------------------------------------ rows

    def _csv(self, lines: list[str]) -> list[Log]:
        table = self._table
        if table is None:
            for line in lines:
                self._waste(line)
            return []
        table.separator = table.separator or separator_of(lines[0])
        rows = table.rows(lines, lambda k, _: self._waste(lines[k]))
        return [self._log_of_table(table, rows, {})] if len(rows) else []

    def _json(self, lines: list[str]) -> list[Log]:
        kept: list[tuple[float | None, str, dict[str, float]]] = []
        for line in lines:
            try:
                value = json.loads(line)
            except (ValueError, RecursionError):
                self._waste(line)
                continue
            for found in value if isinstance(value, list) else [value]:
                row = self._object(found)
                if row is None or (kept and (row[0] is None) != (kept[0][0] is None)):
                    self._waste(line)
                else:
                    kept.append(row)
        names = list(dict.fromkeys(name for _, _, row in kept for name in row))
        columns = {
            name: np.array([row.get(name, np.nan) for _, _, row in kept], dtype=np.float64)
            for name in names
        }
        if not kept:
            return []
        times = None if kept[0][0] is None else np.array([time for time, _, _ in kept], np.float64)
        return [self._log(len(kept), times, kept[0][1], columns, {})]

    def _object(self, value: object) -> tuple[float | None, str, dict[str, float]] | None:
        """The time, its name and the other numbers of a JSON object; None if it is no sample."""
        if not isinstance(value, dict) or not value:
            return None
        row = {str(k): x for k, v in value.items() if (x := _json_number(v)) is not None}
        try:
            name = time_column(list(row), self.form.time, self.form.name, None)
            if name is None and self.form.rate is None:
                raise no_time(self.form.name, None, [str(k) for k in value])
        except LogError as error:
            self._refused = error
            return None
        if name is None:
            return (None, "", row) if row else None
        time = row.pop(name)
        return (time, name, row) if finite(time) else None

    def _waste(self, line: str) -> None:
        self.garbage += 1
        self.example = line.strip()[:60]


_NUMERIC = frozenset("0123456789+-.,;")


def _table(names: list[str], separator: str, time: str | None) -> Table:
    return Table(names, separator, time, _is_name, timeless=False)


def _is_name(text: str) -> bool:
    """Whether a cell can be a name or a word: it begins with a letter, and all can be printed."""
    plain = text.isprintable() and "\ufffd" not in text
    return plain and (text[:1].isalpha() or text[:1] == "_") and number(text) is None


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
