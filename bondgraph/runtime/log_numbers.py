"""Lines of a table as numbers, by C where they hold nothing else, else cell by cell; as logs."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Sequence

import numpy as np

from bondgraph.runtime.log import LEFT_OUT, TIME_UNIT, Array, Log, seconds, unit_of_time
from bondgraph.text.tuples import NamedTuple

#: How a cell says that there is no sample, in small letters.
NO_SAMPLE = ("", "nan", "na", "n/a", "null", "none")

_WORDS = {**dict.fromkeys(NO_SAMPLE, float("nan")), "true": 1.0, "false": 0.0}
_SEPARATORS = ("\t", ";", ",")
_EMPTY = re.compile(r"(?:^|(?<=[,;\t]))[ ]*(?=[,;\t]|\r?\n?$)")
_FEW, _MANY = 4, 100  # lines; fewer are not worth the start of numpy, of pyarrow


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
    """A header that is in force; `time` is its column of time, if there is one.

    `word` says whether a cell of the first row that is no number makes its column one of text.
    Without `timeless` a row is none that says no time.
    """

    def __init__(
        self,
        names: Sequence[str],
        separator: str,
        time: str | None,
        word: Callable[[str], bool] = lambda _: True,
        timeless: bool = True,
    ) -> None:
        self.names, self.separator, self.time = list(names), separator, time
        self.text: dict[str, str] | None = None  # by column; None before the first row
        self._place = 0 if time is None else self.names.index(time)
        self._word, self._timeless = word, timeless

    def rows(self, lines: list[str], refuse: Callable[[int, Refused], None]) -> Array:
        """The numbers in some lines, a row for each; `refuse` is told where one is no row.

        Blank lines and comments count as none of them.
        """
        found: list[list[float]] = []
        start = 0
        while start < len(lines) and self.text is None:
            self._take(start, lines[start], found, refuse)
            start += 1
        rest = lines[start:] if start else lines
        values = None if self.text else by_c(rest, self.separator, len(self.names))
        if values is not None and self._timely(values):
            return values if not found else np.vstack([found, values])
        for k, line in enumerate(rest, start):
            self._take(k, line, found, refuse)
        return np.array(found, dtype=np.float64).reshape(len(found), len(self.names))

    def _timely(self, values: Array) -> bool:
        timeless = self._timeless or self.time is None
        return timeless or bool(np.isfinite(values[:, self._place]).all())

    def _take(
        self, at: int, line: str, into: list[list[float]], refuse: Callable[[int, Refused], None]
    ) -> None:
        if not line.strip() or line.startswith("#"):
            return
        try:
            into.append(self._row(line))
        except (Refused, csv.Error) as error:
            refuse(at, error if isinstance(error, Refused) else Refused(str(error)))

    def _row(self, line: str) -> list[float]:
        cells = cells_of(line, self.separator)
        if len(cells) == len(self.names) + 1 and not cells[-1].strip():
            cells.pop()
        if len(cells) != len(self.names):
            message = f"{len(cells)} cells where the header names {len(self.names)}"
            raise Refused(message, "mend or delete the line")
        values = list(map(number, cells))
        if not (self._timeless or self.time is None or finite(values[self._place])):
            raise Refused("no time")
        row = zip(self.names, cells, values, strict=True)
        if self.text is None:
            self.text = {
                name: cell.strip()
                for name, cell, value in row
                if value is None and name != self.time and self._word(cell.strip())
            }
            row = zip(self.names, cells, values, strict=True)
        return [v if v is not None else self._instead(name, cell) for name, cell, v in row]

    def _instead(self, name: str, cell: str) -> float:
        """What stands for a cell that is no number: anything, in a column of text."""
        if self.text and name in self.text:
            return 0.0
        comma = re.fullmatch(r"\s*[+-]?\d+,\d+\s*", cell)
        remedy = "write decimal points" if comma else "leave a cell without a sample empty"
        raise Refused(f"`{cell.strip()}` in the column {name} is not a number", remedy)


def finite(value: float | None) -> bool:
    """Whether there is a number, neither NaN nor infinite."""
    return value is not None and value - value == 0.0


class Form(NamedTuple):
    """What is known of a table before its first line.

    `name` is for messages; `time` the name of the column of time (None: t, time or timestamp) and
    `unit` its unit (None: as its name says, else s); `columns` the header of a stream of CSV that
    sends none; `rate`, in samples a second, makes times where no column has them.
    """

    name: str
    time: str | None = None
    unit: str | None = None
    columns: tuple[str, ...] = ()
    rate: float | None = None


class Reader:
    """What there is between lines and logs: the form, what comments said, how many rows came."""

    def __init__(self, form: Form) -> None:
        self.form = form
        self.rows = 0
        self._own = False  # a log of this program, with times in s
        self._units: dict[str, str] = {}

    def _log_of_table(self, table: Table, rows: Array, meta: dict[str, str]) -> Log:
        text = table.text or {}
        columns = {
            name: np.ascontiguousarray(rows[:, k])
            for k, name in enumerate(table.names)
            if name != table.time and name not in text
        }
        if text:
            meta = meta | {LEFT_OUT: ", ".join(f"{n} (`{word}`)" for n, word in text.items())}
        times = None if table.time is None else rows[:, table.names.index(table.time)]
        return self._log(len(rows), times, table.time or "", columns, meta)

    def _log(
        self,
        count: int,
        times: Array | None,
        name: str,
        columns: dict[str, Array],
        meta: dict[str, str],
    ) -> Log:
        """Samples as a log; `times` are as the column `name` has them."""
        if times is None:
            assert self.form.rate is not None
            times = (self.rows + np.arange(count)) / self.form.rate
        else:
            unit = "" if self._own else unit_of_time(name, self._units)
            if self.form.unit is not None:
                unit = "" if self.form.unit == "s" else self.form.unit
            times = seconds(np.ascontiguousarray(times), unit, self.form.name)
            meta = meta | ({TIME_UNIT: unit} if unit else {})
        self.rows += count
        return Log(times, columns, {n: u for n, u in self._units.items() if n in columns}, meta)


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
    values = np.empty((table.num_rows, columns))
    for k, column in enumerate(table.columns):
        values[:, k] = column.to_numpy()
    return values


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
