"""Lines of text from a machine, CSV or JSON, to samples; what is no sample is counted."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Iterable, Sequence

import numpy as np

from bondgraph.runtime.log import (
    LEFT_OUT,
    MARK,
    TIME_UNIT,
    Array,
    Log,
    LogError,
    name_of_time,
    no_time,
    seconds,
    time_column,
    unit_of_time,
)
from bondgraph.text.tuples import NamedTuple

_SEPARATORS = ("\t", ";", ",")
_WORDS = {
    **dict.fromkeys(["", "nan", "na", "n/a", "null", "none"], float("nan")),
    "true": 1.0,
    "false": 0.0,
}
_EMPTY = re.compile(r"(?:^|(?<=[,;\t]))[ ]*(?=[,;\t]|\r?$)")
_UNIT = re.compile(r"# unit ((?:[^\\:]|\\.)+): (.*)")


class Form(NamedTuple):
    """What is known of a stream before its first line.

    `name` is for messages; `time` the name of the column of time (None: t, time or timestamp) and
    `unit` its unit (None: as its name says, else s); `columns` the header of a stream of CSV that
    sends none; `rate`, in samples a second, makes times where no column has them.
    """

    name: str
    time: str | None = None
    unit: str | None = None
    columns: tuple[str, ...] = ()
    rate: float | None = None


class _Table:
    """A header that is in force."""

    def __init__(self, names: Sequence[str], separator: str, time: str | None) -> None:
        self.names = list(names)
        self.separator = separator
        self.time = None if time is None else self.names.index(time)
        self.text: dict[int, str] | None = None  # columns of words; None before the first row


class Decoder:
    """Makes logs of blocks of whole lines.

    A line is a row of CSV, a header, a comment, a JSON object of numbers by name or an array of
    such objects. A header may come again, as after a restart of the device. `garbage` counts the
    lines that are none of these, `example` is the last one of them.
    """

    def __init__(self, form: Form) -> None:
        self.form = form
        self.garbage = 0
        self.example = ""
        self.rows = 0
        self._own = False
        self._units: dict[str, str] = {}
        self._refused: LogError | None = None
        self._table: _Table | None = None
        self.declare()

    def declare(self) -> None:
        """Forget the header, as if no line had come: that of the form is in force again."""
        self._table = None
        names = list(self.form.columns)
        if names:
            self._table = _Table(names, "", self._time_of(names))

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

    def _header(self, line: str) -> _Table | None:
        """A line as a header if it is one: names, none twice, one of them of time."""
        separator = next((s for s in _SEPARATORS if s in line), ",")
        names = [name.strip() for name in _cells(line, separator)]
        trailing = len(names) > 1 and not names[-1]
        names = names[:-1] if trailing else names
        if len(set(names)) < max(len(names), 2) or any(not _is_name(n) for n in names):
            return None
        try:
            time = self._time_of(names)
        except LogError as error:
            self._refused = error
            return None
        return _Table(names, separator, time)

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
        if not table.separator:
            table.separator = next((s for s in _SEPARATORS if s in lines[0]), ",")
        rows = self._fast(table, lines) if table.text == {} else None
        if rows is None:
            kept = [row for line in lines if (row := self._row(table, line)) is not None]
            rows = np.array(kept, dtype=np.float64).reshape(len(kept), len(table.names))
        words = table.text or {}
        columns = {
            name: np.ascontiguousarray(rows[:, k])
            for k, name in enumerate(table.names)
            if k != table.time and k not in words
        }
        told = {LEFT_OUT: ", ".join(f"{table.names[k]} (`{w}`)" for k, w in words.items())}
        times = None if table.time is None else rows[:, table.time]
        name = "" if table.time is None else table.names[table.time]
        return self._log(times, name, columns, told if words else {})

    def _fast(self, table: _Table, lines: list[str]) -> Array | None:
        """All rows at once where they are numbers only, as nearly always."""
        filled: Iterable[str] = lines
        if any(table.separator * 2 in s or s[-1:] == table.separator for s in lines):
            filled = (_EMPTY.sub("nan", line) for line in lines)
        try:
            rows = np.loadtxt(filled, delimiter=table.separator, comments=None, ndmin=2)
        except ValueError:
            return None
        fits = rows.shape == (len(lines), len(table.names))
        if not fits or (table.time is not None and not np.isfinite(rows[:, table.time]).all()):
            return None
        return rows

    def _row(self, table: _Table, line: str) -> list[float] | None:
        """The numbers in a line, None if it is no row of the table."""
        cells = [c.strip() for c in _cells(line, table.separator)]
        if len(cells) == len(table.names) + 1 and not cells[-1]:
            cells.pop()
        values = [_number(c) for c in cells]
        time = None if table.time is None or table.time >= len(cells) else values[table.time]
        if len(cells) != len(table.names) or (table.time is not None and not _finite(time)):
            self._waste(line)
            return None
        if table.text is None:
            words = [k for k, v in enumerate(values) if v is None and _is_name(cells[k])]
            table.text = {k: cells[k] for k in words}
        numbers = [0.0 if k in table.text else v for k, v in enumerate(values)]
        if any(v is None for v in numbers):
            self._waste(line)
            return None
        return [v for v in numbers if v is not None]

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
        return self._log(times, kept[0][1], columns, {})

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
        return (time, name, row) if _finite(time) else None

    def _log(
        self, times: Array | None, name: str, columns: dict[str, Array], meta: dict[str, str]
    ) -> list[Log]:
        count = len(next(iter(columns.values()))) if times is None else len(times)
        if times is None:
            assert self.form.rate is not None
            times = (self.rows + np.arange(count)) / self.form.rate
        elif self.form.unit is not None:
            unit = "" if self.form.unit == "s" else self.form.unit
            times = seconds(times, unit, self.form.name)
            meta |= {TIME_UNIT: unit} if unit else {}
        elif not self._own:
            unit = unit_of_time(name, self._units)
            times = seconds(times, unit, self.form.name)
            meta |= {TIME_UNIT: unit} if unit else {}
        self.rows += count
        units = {n: u for n, u in self._units.items() if n in columns}
        return [Log(np.ascontiguousarray(times), columns, units, meta)] if count else []

    def _waste(self, line: str) -> None:
        self.garbage += 1
        self.example = line.strip()[:60]


_NUMERIC = frozenset("0123456789+-.,;")


def _cells(line: str, separator: str) -> list[str]:
    if '"' not in line:
        return line.split(separator)
    try:
        return next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])
    except csv.Error:
        return []


def _is_name(text: str) -> bool:
    """Whether a cell can be a name or a word: it begins with a letter, and all can be printed."""
    plain = text.isprintable() and "\ufffd" not in text
    return plain and (text[:1].isalpha() or text[:1] == "_") and _number(text) is None


def _number(cell: str) -> float | None:
    """The number in a cell, NaN where it has none, None where it is something else."""
    try:
        return float(cell)
    except ValueError:
        return _WORDS.get(cell.lower())


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


def _finite(value: float | None) -> bool:
    return value is not None and value - value == 0.0
