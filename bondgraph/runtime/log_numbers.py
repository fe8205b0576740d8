"""Lines of a table as numbers, by C where they hold nothing else, else cell by cell; as logs."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from bondgraph.runtime.log import LEFT_OUT, TIME, TIME_UNIT, Array, Log, LogError, labelled
from bondgraph.runtime.time_column import ISO, candidates, chosen, no_time, seconds, stamp, unit_of
from bondgraph.text.limits import COLUMNS
from bondgraph.text.tuples import NamedTuple

if TYPE_CHECKING:
    import pyarrow

#: How a cell says that there is no sample, in small letters.
NO_SAMPLE = ("", "nan", "na", "n/a", "null", "none")

_WORDS = {**dict.fromkeys(NO_SAMPLE, float("nan")), "true": 1.0, "false": 0.0}
_SEPARATORS = ("\t", ";", ",")
_EMPTY = re.compile(r"(?:^|(?<=[,;\t]))[ ]*(?=[,;\t]|\r?\n?$)")
_COMMA = re.compile(r"\s*[+-]?\d*,\d+(?:[eE][+-]?\d+)?\s*")
_FEW, _MANY = 4, 1000  # lines; fewer are not worth the start of numpy, of pyarrow
_HEAD = 1000  # lines by which the column of time is known


def separator_of(line: str) -> str:
    """What stands between the cells of a line."""
    return next((s for s in _SEPARATORS if s in line), ",")


def cells_of(line: str, separator: str, spaces: bool = False) -> list[str]:
    """The cells of a line; raises csv.Error. With `spaces` those in front of a cell are its own."""
    line = line.rstrip("\r\n")
    if '"' not in line:
        return line.split(separator)
    reader = csv.reader([line], delimiter=separator, skipinitialspace=not spaces, strict=True)
    return next(reader, [])


def number(cell: str) -> float | None:
    """The number in a cell, NaN where it has none, None where it is something else."""
    try:
        return float(cell) if "_" not in cell else None
    except ValueError:
        return _WORDS.get(cell.strip().lower())


class Refused(Exception):
    """A line that is no row: what is wrong, and a remedy."""

    def __init__(self, message: str, help: str = "") -> None:
        super().__init__(message)
        self.help = help


class Table:
    """A header that is in force; `time` is its column of time, None before it is known.

    `path` is for messages. `word` says whether a cell of the first row that is no number makes its
    column one of text. Unless it is `timeless`, one of the columns that it is told to look for has
    to be a time. Where it is not `strict`, a row is none that says no time.
    """

    def __init__(
        self,
        names: Sequence[str],
        separator: str,
        path: str,
        timeless: bool = False,
        word: Callable[[str], bool] = lambda _: True,
        strict: bool = True,
    ) -> None:
        self.names, self.separator = list(names), separator
        self.time: str | None = None
        self.text: dict[str, str] | None = None  # by column; None before the first row
        self.stamped: set[str] = set()  # columns of times in ISO 8601
        self.units: dict[str, str] = {}  # by column, from a row of them below the header
        self._path, self._timeless = path, timeless
        self._word, self._strict = word, strict
        self._times: list[str] = []
        self._open = False  # which of them it is
        self._point = ""  # before decimals, once one has come

    def take(self, time: str) -> Table:
        """This table, with a column of time that nobody asks for."""
        self.time = time
        return self

    def look_for(self, times: list[str]) -> Table:
        """This table, of which the first of these columns that grows in the first rows is time."""
        self._times, self._open = times, bool(times)
        return self

    @property
    def likely(self) -> str:
        """The likeliest column of time as long as nothing decides; "" where there is none."""
        return self._times[0] if self._open else ""

    def rows(self, lines: list[str], refuse: Callable[[int, Refused], None]) -> Array:
        """The numbers in some lines, a row for each; `refuse` is told where one is no row.

        Blank lines and comments count as none of them. Raises LogError while there are rows, and
        no column of time grows.
        """
        for part in (lines[:_HEAD], lines):
            if self._open:
                self._choose(part)
        return self._rows(lines, refuse)

    def _choose(self, lines: list[str]) -> None:
        """See which column is the time; that stays open as long as there are no rows."""
        try:
            rows = self._rows(lines, lambda *_: None)
            if len(rows):
                found = {n: rows[:, self.names.index(n)] for n in self._times}
                numbers = {n: v for n, v in found.items() if n not in (self.text or {})}
                self.time = chosen(numbers, self._path, self._timeless)
                self._open = False
        finally:
            self.text, self.stamped, self._point = None, set(), ""

    def _rows(self, lines: list[str], refuse: Callable[[int, Refused], None]) -> Array:
        found: list[list[float]] = []
        start = 0
        while start < len(lines) and self.text is None:
            self._take(start, lines[start], found, refuse)
            start += 1
        rest = lines[start:] if start else lines
        values = None if self.text else by_c(self._plain(rest), self.separator, len(self.names))
        if values is not None and self._timely(values):
            return values if not found else np.vstack([found, values])
        for k, line in enumerate(rest, start):
            self._take(k, line, found, refuse)
        return np.array(found, dtype=np.float64).reshape(len(found), len(self.names))

    def _plain(self, lines: list[str]) -> list[str]:
        """Lines without ISO 8601 and decimal commas; as they are where each has to be looked at."""
        comma = self.separator != "," and any("," in line for line in lines)
        if not (comma or self.stamped):
            return lines
        places = [self.names.index(name) for name in self.stamped]
        plain = []
        for line in lines:
            cells = line.rstrip("\r\n").split(self.separator)
            times = [stamp(cells[k]) if k < len(cells) else None for k in places]
            for k, time in zip(places, times, strict=True):
                if time is None:
                    return lines
                cells[k] = ""
            rest = self.separator.join(cells)
            if comma and ("." in rest or self._point != ","):
                return lines
            cells = rest.replace(",", ".").split(self.separator) if comma else cells
            for k, time in zip(places, times, strict=True):
                cells[k] = repr(time)
            plain.append(self.separator.join(cells) + "\n")
        return plain

    def _timely(self, values: Array) -> bool:
        if self._strict or self.time is None:
            return True
        return bool(np.isfinite(values[:, self.names.index(self.time)]).all())

    def _take(
        self, at: int, line: str, into: list[list[float]], refuse: Callable[[int, Refused], None]
    ) -> None:
        if not line.strip() or line.startswith("#"):
            return
        try:
            if self.text is not None or not self._row_of_units(line):
                into.append(self._row(line))
        except (Refused, csv.Error) as error:
            refuse(at, error if isinstance(error, Refused) else Refused(str(error)))

    def _row_of_units(self, line: str) -> bool:
        """Take a line that has nothing but units, one of them below the likeliest time."""
        cells = [c.strip().strip("[]()") for c in cells_of(line, self.separator)]
        units = {n: labelled(f"x [{c}]")[1] for n, c in zip(self.names, cells, strict=False)}
        found = bool(self._times) and units.get(self._times[0], "") != ""
        if not found or any(c and not u for c, u in zip(cells, units.values(), strict=False)):
            return False
        self.units = {name: unit for name, unit in units.items() if unit}
        return True

    def _row(self, line: str) -> list[float]:
        cells = cells_of(line, self.separator)
        if len(cells) == len(self.names) + 1 and not cells[-1].strip():
            cells.pop()
        if len(cells) != len(self.names):
            message = f"{len(cells)} cells where the header names {len(self.names)}"
            raise Refused(message, "mend or delete the line")
        row = dict(zip(self.names, cells, strict=True))
        first = self.text is None
        if first:
            self.stamped = {n for n in self._times if number(row[n]) is None and stamp(row[n])}
        values = {name: self._number(name, cell) for name, cell in row.items()}
        if not (self._strict or self.time is None or finite(values[self.time])):
            raise Refused("no time")
        if first:
            self.text = {
                name: row[name].strip()
                for name, value in values.items()
                if value is None and [name] != self._times and self._word(row[name].strip())
            }
        return [v if v is not None else self._instead(n, row[n]) for n, v in values.items()]

    def _number(self, name: str, cell: str) -> float | None:
        """The number in a cell, None where it is something else."""
        if name in self.stamped and number(cell) == number(cell):
            return stamp(cell)
        value = number(cell)
        comma = value is None and _COMMA.fullmatch(cell) is not None
        mark = "," if comma else "." if value is not None and "." in cell else ""
        if mark and self._point not in ("", mark):
            message = f"`{cell.strip()}` in the column {name}: decimal commas and points are mixed"
            raise Refused(message, "write one of both throughout, and nothing between thousands")
        self._point = mark or self._point
        return float(cell.replace(",", ".")) if comma else value

    def _instead(self, name: str, cell: str) -> float:
        """What stands for a cell that is no number: anything, in a column of text."""
        if self.text and name in self.text:
            return 0.0
        what = f"not a time of {ISO}" if name in self.stamped else "not a number"
        remedy = "leave a cell without a sample empty"
        if [name] == self._times:
            remedy = f"a time is a number, or {ISO} as in 2024-05-01T12:00:00.5+02:00"
        raise Refused(f"`{cell.strip()}` in the column {name} is {what}", remedy)


def numeric(cell: str) -> bool:
    """Whether a cell stands in a row rather than in a header: a number or time, or nothing."""
    return number(cell) is not None or stamp(cell) is not None or bool(_COMMA.fullmatch(cell))


def finite(value: float | None) -> bool:
    """Whether there is a number, neither NaN nor infinite."""
    return value is not None and value - value == 0.0


class Form(NamedTuple):
    """What is known of a table before its first line.

    `name` is for messages; `time` the name of the column of time (None: see `candidates`) and
    `unit` its unit (None: see `unit_of`); `columns` the header of CSV that has none; `rate`, in
    samples a second, makes times where no column has them. `wanted` are the columns that are
    signals, where that is known (none: perhaps all): what has to be decoded leaves out the others.
    """

    name: str
    time: str | None = None
    unit: str | None = None
    columns: tuple[str, ...] = ()
    rate: float | None = None
    wanted: frozenset[str] = frozenset()


class Reader:
    """What there is between lines and logs: the form, what comments said, how many rows came."""

    def __init__(self, form: Form) -> None:
        self.form = form
        self.rows = 0
        self._own = False  # a log of this program, with times in s
        self._units: dict[str, str] = {}
        self._clocks: dict[str, tuple[str, str]] = {}  # units of time, and how they are known

    def _header_of(
        self,
        names: list[str],
        separator: str,
        word: Callable[[str], bool] = lambda _: True,
        strict: bool = True,
    ) -> Table:
        """The table under a header; raises LogError where it has no column of time."""
        form = self.form
        if len(names) > COLUMNS:
            message = f"{len(names)} columns, {COLUMNS} are the most"
            raise LogError(form.name, None, message, "leave out what no model reads")
        count = Counter(names)
        twice = next((n for n in names if count[n] > 1), None)
        if twice is not None:
            message = f"two columns are called `{twice}`"
            raise LogError(form.name, None, message, "rename one of them")
        table = Table(names, separator, form.name, form.rate is not None, word, strict)
        if self._own and form.time is None and re.fullmatch("t_*", names[0]):
            return table.take(names[0])
        return table.look_for(self._times_of(names))

    def _times_of(self, names: list[str]) -> list[str]:
        """The columns that may be the time; raises LogError where one is needed."""
        form = self.form
        times = candidates(names, form.time)
        if form.time is not None and not times:
            there = ", ".join(names) or "no column"
            raise LogError(form.name, None, f"no column `{form.time}`", f"there is {there}")
        if not times and form.rate is None:
            raise no_time(form.name, names)
        return times

    def _log_of_table(self, table: Table, rows: Array, meta: dict[str, str]) -> Log:
        text = table.text or {}
        self._units |= table.units
        columns = {
            name: np.ascontiguousarray(rows[:, k])
            for k, name in enumerate(table.names)
            if name != (table.time or table.likely) and name not in text
        }
        if text:
            meta = meta | {LEFT_OUT: ", ".join(f"{n} (`{word}`)" for n, word in text.items())}
        if table.time is None:
            return self._log(len(rows), None, "", columns, meta)
        times = np.ascontiguousarray(rows[:, table.names.index(table.time)])
        stamped = table.time in table.stamped
        return self._log(len(rows), times, table.time, columns, meta, stamped)

    def _log(
        self,
        count: int,
        times: Array | None,
        name: str,
        columns: dict[str, Array],
        meta: dict[str, str],
        stamped: bool = False,
    ) -> Log:
        """Samples as a log; `times` are as the column `name` has them."""
        units = {n: u for n in columns if (u := self._units.get(n) or self._labelled(n))}
        if times is None:
            rate = self.form.rate or 1.0  # nothing is known of the time before there is a row
            told = {TIME: f"no column, {rate:g} samples a second as told"}
            times = (self.rows + np.arange(count)) / rate
        elif self._own and self.form.unit is None:
            told = {}
        else:
            times, told = self._timed(times, name, stamped)
        self.rows += count
        return Log(times, columns, units, meta | told)

    def _labelled(self, name: str) -> str:
        return "" if self._own else labelled(name)[1]

    def _timed(self, times: Array, name: str, stamped: bool) -> tuple[Array, dict[str, str]]:
        """Times in s, and what is said of them."""
        form = self.form
        if stamped:
            if form.unit not in (None, "s"):
                message = f"the times in the column `{name}` are {ISO}, not numbers in {form.unit}"
                raise LogError(form.name, None, message, "leave out --time-unit")
            return times, {TIME: f"the column `{name}`, as {ISO}"}
        if name not in self._clocks:
            written = self._units.get(name, "")
            self._clocks[name] = unit_of(name, times, form.unit, written)
        unit, why = self._clocks[name]
        told = {TIME: f"the column `{name}`, in {unit} {why}"}
        return seconds(times, unit, form.name), told | ({TIME_UNIT: unit} if unit != "s" else {})


def by_c(lines: list[str], separator: str, columns: int) -> Array | None:
    """The numbers in lines of equally many cells, the same doubles as `float` gives.

    None where a cell holds anything else than a number (pyarrow: or says that there is none), or a
    line has another number of cells: then each line has to be looked at.
    """
    if len(lines) < _FEW:
        return None
    text = ("" if lines[0].endswith("\n") else "\n").join(lines)
    if '"' in text or "#" in text:
        return None
    if len(lines) >= _MANY:
        try:
            return _by_arrow(text, separator, columns)
        except ImportError:
            pass
    return _by_numpy(lines, separator, columns)


def _by_arrow(text: str, separator: str, columns: int) -> Array | None:
    import pyarrow
    import pyarrow.csv

    # It would take SIGTERM and SIGINT for its own while it reads, and a wish to stop would be lost.
    pyarrow.enable_signal_handlers(False)
    data = text.encode("utf-8", "surrogatepass")
    names = [str(k) for k in range(columns)]
    try:
        table = pyarrow.csv.read_csv(
            pyarrow.BufferReader(data),
            pyarrow.csv.ReadOptions(column_names=names, block_size=len(data) + 1),
            pyarrow.csv.ParseOptions(delimiter=separator, quote_char=False),
            pyarrow.csv.ConvertOptions(
                column_types=dict.fromkeys(names, pyarrow.float64()),
                null_values=[word for n in NO_SAMPLE for word in dict.fromkeys((n, n.upper()))],
            ),
        )
    except pyarrow.ArrowInvalid:
        return None
    return np.stack([doubles(column) for column in table.columns], axis=1)


def doubles(column: pyarrow.ChunkedArray) -> Array:
    """The numbers of a column of doubles, NaN where it has none, as an array of its own.

    From its buffers: where pandas is installed, `to_numpy` of pyarrow loads it, which takes longer
    than to read most logs.

    >>> import pyarrow
    >>> doubles(pyarrow.chunked_array([[1.0, None], [], [2.0]], pyarrow.float64())).tolist()
    [1.0, nan, 2.0]
    """
    parts = [np.empty(0)]
    for chunk in filter(len, column.chunks):
        known, numbers = chunk.buffers()
        own = slice(chunk.offset, chunk.offset + len(chunk))
        if numbers is None:
            parts.append(np.full(len(chunk), np.nan))
        elif known is None:
            parts.append(np.frombuffer(numbers, np.float64)[own])
        else:
            bits = np.unpackbits(np.frombuffer(known, np.uint8), bitorder="little")
            parts.append(np.where(bits[own], np.frombuffer(numbers, np.float64)[own], np.nan))
    return np.concatenate(parts)


def _by_numpy(lines: list[str], separator: str, columns: int) -> Array | None:
    if all(not line.strip() for line in lines):
        return None
    for rows in (lines, (_EMPTY.sub("nan", line) for line in lines)):
        try:
            values = np.loadtxt(rows, delimiter=separator, comments=None, ndmin=2)
        except ValueError:
            continue  # perhaps cells without anything
        return values if values.shape[1] == columns else None
    return None
