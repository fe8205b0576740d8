"""Logs as CSV: our own with units and texts in comments, and those of other people."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Iterator

import numpy as np

from bondgraph.runtime.log import (
    EDITION,
    LEFT_OUT,
    MARK,
    TIME_UNIT,
    Array,
    Log,
    LogError,
    joined,
    name_of_time,
    no_time,
    seconds,
    time_column,
    unit_of_time,
    whole,
)
from bondgraph.runtime.log_numbers import NO_SAMPLE, by_c

_SEPARATORS = ("\t", ";", ",")
_WORDS = {
    **dict.fromkeys(NO_SAMPLE, float("nan")),
    "true": 1.0,
    "false": 0.0,
}
_COMMENT = re.compile(r"# (unit )?((?:[^\\:]|\\.)+): (.*)")
_ESCAPES = {"\\": "\\\\", "\n": "\\n", "\r": "\\r", ":": "\\:"}
_BLOCK = 1 << 22  # characters read at a time
_ROWS = 10_000  # rows written at a time


class CsvReader:
    """Makes logs of lines as they come: the comments and the header first, then blocks of rows.

    `path` is for messages; `time` and `rate` as for `read_log`. Raises LogError for lines that
    are wrong.
    """

    def __init__(self, path: str, time: str | None = None, rate: float | None = None) -> None:
        self.path = path
        self.names: list[str] = []  # the header; empty as long as it has not come
        self._wanted, self._rate = time, rate
        self._line = 0  # the last one that was taken
        self._rows = 0
        self._own = False
        self._comment = ""  # the last one of them, which may be the header
        self._separator = ","
        self._trailing = False  # each line ends with a separator
        self._time: str | None = None
        self._text: dict[str, str] = {}  # columns of text, with what the first row says
        self._units: dict[str, str] = {}
        self._meta: dict[str, str] = {}

    def feed(self, lines: list[str]) -> Log | None:
        """The samples in further lines; None as long as there is no header."""
        at = 0
        while not self.names and at < len(lines):
            self._line += 1
            if self._head(lines[at].rstrip("\r\n")):
                at += 1
            else:
                self._line -= 1  # a row, and the header was a comment
        if not self.names:
            return None
        first: list[list[float]] = []
        while not self._rows and at < len(lines):
            self._line += 1
            first += self._row(lines[at], self._line)
            at += 1
        return self._log(np.vstack([self._array(first), self._block(lines[at:])]))

    # ---------------------------------------------------------------- comments and header

    def _head(self, line: str) -> bool:
        """Take a line before the rows; False if it is one of the rows itself."""
        if line.startswith("#"):
            self._comments(line)
            return True
        if not line.strip():
            return True
        if not self._own:
            self._separator = next((s for s in _SEPARATORS if s in line), ",")
        elif found := re.match(r"t_*([;\t])", line):
            self._separator = found[1]  # ours, and another program has saved it again
        cells = self._cells(line, self._line)
        numbers = all(_number(c) is not None for c in cells)
        if numbers and any(c.strip() for c in cells):
            told = self._cells(self._comment.lstrip("# "), self._line)
            if len(told) != len(cells):
                message = "no header: the first line has numbers only"
                raise LogError(self.path, self._line, message, "name the columns in a line before")
            cells = told
        self._header(cells)
        return not numbers

    def _comments(self, line: str) -> None:
        self._comment = line
        if self._line == 1 and line.startswith(f"# {MARK} "):
            edition = line.removeprefix(f"# {MARK} ").strip()
            if edition != EDITION:
                message = f"a log of edition {edition}, this program reads {EDITION}"
                raise LogError(self.path, 1, message, "read it with a newer bondgraph")
            self._own = True
        found = _COMMENT.fullmatch(line) if self._own else None
        if found:
            into = self._units if found[1] else self._meta
            into[_plain(found[2])] = _plain(found[3])

    def _cells(self, line: str, number: int) -> list[str]:
        try:
            reader = csv.reader(
                [line], delimiter=self._separator, skipinitialspace=not self._own, strict=True
            )
            return next(reader, [])
        except csv.Error as error:
            raise LogError(self.path, number, str(error)) from error

    def _header(self, cells: list[str]) -> None:
        names = cells if self._own else [c.strip() for c in cells]
        self._trailing = len(names) > 1 and not names[-1]
        names = names[:-1] if self._trailing else names
        for k, name in enumerate(names):
            if not name:
                message = f"column {k + 1} has no name"
                raise LogError(self.path, self._line, message, "name every column in the header")
            if name in names[:k]:
                message = f"two columns are called `{name}`"
                raise LogError(self.path, self._line, message, "rename one of them")
        self._time = time_column(names, self._wanted, self.path, self._line)
        if self._own and self._wanted is None:
            self._time = names[0]
        if self._time is None and self._rate is None:
            raise no_time(self.path, self._line, names)
        self.names = names

    # ------------------------------------------------------------------------------ rows

    def _block(self, lines: list[str]) -> Array:
        """The numbers of some lines, a row for each; by C where they are numbers only."""
        first = self._line
        self._line += len(lines)
        if not (self._text or self._trailing):
            values = by_c(lines, self._separator, len(self.names))
            if values is not None:
                self._rows += len(values)
                return values
        rows = [row for k, s in enumerate(lines) for row in self._row(s, first + k + 1)]
        return self._array(rows)

    def _array(self, rows: list[list[float]]) -> Array:
        return np.array(rows, dtype=np.float64).reshape(len(rows), len(self.names))

    def _row(self, line: str, number: int) -> list[list[float]]:
        """The numbers of a line, nothing for a blank one or a comment."""
        if not line.strip() or line.startswith("#"):
            return []
        cells = self._cells(line.rstrip("\r\n"), number)
        if self._trailing and cells and not cells[-1].strip():
            cells.pop()
        if len(cells) != len(self.names):
            message = f"{len(cells)} cells where the header names {len(self.names)}"
            raise LogError(self.path, number, message, "mend or delete the line")
        if self._rows == 0:
            named = zip(self.names, cells, strict=True)
            self._text = {n: c for n, c in named if _number(c) is None and n != self._time}
        self._rows += 1
        return [[self._value(n, c, number) for n, c in zip(self.names, cells, strict=True)]]

    def _value(self, name: str, cell: str, number: int) -> float:
        if name in self._text:
            return 0.0
        value = _number(cell)
        if value is None:
            comma = re.fullmatch(r"\s*[+-]?\d+,\d+\s*", cell)
            remedy = "write decimal points" if comma else "leave a cell without a sample empty"
            message = f"`{cell.strip()}` in the column {name} is not a number"
            raise LogError(self.path, number, message, remedy)
        return value

    def _log(self, rows: Array) -> Log:
        columns = {
            name: np.ascontiguousarray(rows[:, k])
            for k, name in enumerate(self.names)
            if name not in self._text and name != self._time
        }
        meta = dict(self._meta)
        if self._text:
            meta[LEFT_OUT] = ", ".join(f"{n} (`{c.strip()}`)" for n, c in self._text.items())
        if self._time is None:
            assert self._rate is not None
            time = (np.arange(len(rows)) + (self._rows - len(rows))) / self._rate
        else:
            unit = "" if self._own else unit_of_time(self._time, self._units)
            values = np.ascontiguousarray(rows[:, self.names.index(self._time)])
            time = seconds(values, unit, self.path)
            meta |= {TIME_UNIT: unit} if unit else {}
        return Log(time, columns, {n: u for n, u in self._units.items() if n in columns}, meta)


def _number(cell: str) -> float | None:
    """The number in a cell, NaN where it has none, None where it is something else."""
    try:
        return float(cell) if "_" not in cell else None
    except ValueError:
        return _WORDS.get(cell.strip().lower())


def read_csv(path: str, time: str | None, rate: float | None) -> Log:
    """The log in a CSV file; see `read_log`."""
    reader = CsvReader(path, time, rate)
    parts: list[Log] = []
    try:
        with open(path, encoding="utf-8-sig") as file:
            while lines := file.readlines(_BLOCK):
                part = reader.feed(lines)
                if part is not None and (part.rows or not parts):
                    parts.append(part)
    except UnicodeDecodeError as error:
        raise LogError(path, _not_utf8(path), "not UTF-8", "save the file as UTF-8") from error
    if not parts:
        raise LogError(path, None, "no header: the file has nothing but comments or is empty")
    return joined(parts[1:] if len(parts) > 1 and not parts[0].rows else parts)


def _not_utf8(path: str) -> int | None:
    """The first line that is not UTF-8."""
    with open(path, "rb") as file:
        for number, line in enumerate(file, start=1):
            try:
                line.decode("utf-8-sig")
            except UnicodeDecodeError:
                return number
    return None


# ---------------------------------------------------------------------------------- writing


def write_csv(log: Log, path: str) -> None:
    """Write a log as CSV; see `write_log`."""
    with whole(path) as temporary, open(temporary, "w", encoding="utf-8", newline="\n") as file:
        file.writelines(f"{line}\n" for line in _comments(log))
        names = io.StringIO()
        header = [name_of_time(log.columns), *log.columns]
        csv.writer(names, lineterminator="\n").writerow(header)
        file.write(names.getvalue())
        file.writelines(_rows([log.time, *log.columns.values()]))


def _comments(log: Log) -> Iterator[str]:
    yield f"# {MARK} {EDITION}"
    for key, text in log.meta.items():
        yield f"# {_escaped(key)}: {_escaped(text)}"
    for name in log.columns:
        if log.units.get(name):
            yield f"# unit {_escaped(name)}: {_escaped(log.units[name])}"


def _rows(columns: list[Array]) -> Iterator[str]:
    """The rows as text: digits that give back the same double, nothing for NaN."""
    counts = [_whole(c) for c in columns]
    none = "" if len(columns) > 1 else "nan"  # a line without anything is no row
    for start in range(0, len(columns[0]), _ROWS):
        parts = [(c[start : start + _ROWS], k) for c, k in zip(columns, counts, strict=True)]
        texts = [_texts(part, count, none) for part, count in parts]
        yield "".join([f"{','.join(row)}\n" for row in zip(*texts, strict=True)])


def _whole(column: Array) -> bool:
    """Whether all numbers of a column can be written without a point."""
    with np.errstate(invalid="ignore"):
        small = (np.abs(column) < 2.0**53) & (column == np.rint(column))
    return bool(np.all(small & ~(np.signbit(column) & (column == 0.0))))


def _texts(column: Array, count: bool, none: str) -> Iterable[str]:
    if count:
        return map(str, column.astype(np.int64).tolist())
    return [none if x != x else repr(x) for x in column.tolist()]


def _escaped(text: str) -> str:
    return "".join([_ESCAPES.get(letter, letter) for letter in text])


def _plain(text: str) -> str:
    back = {code[1]: letter for letter, code in _ESCAPES.items()}
    return re.sub(r"\\(.)", lambda found: back.get(found[1], found[1]), text)
