"""Reading a log from a file and writing one, in the form that its suffix says."""

from __future__ import annotations

import csv
import io
import os
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np

from bondgraph.runtime.log import (
    EDITION,
    LEFT_OUT,
    MARK,
    Array,
    Log,
    LogError,
    joined,
    name_of_time,
)
from bondgraph.runtime.log_numbers import (
    Form,
    Reader,
    Refused,
    Table,
    cells_of,
    doubles,
    numeric,
    separator_of,
)
from bondgraph.runtime.time_column import chosen, stamp
from bondgraph.text.limits import COLUMNS
from bondgraph.text.printable import respelt
from bondgraph.text.regular_file import check_regular
from bondgraph.text.whole_file import naming, whole

if TYPE_CHECKING:
    import pyarrow

_KEY = re.compile(r"[A-Za-z_][\w.-]*", re.ASCII)
_COMMENT = re.compile(r"# (unit )?((?:[^\\:]|\\.)+): (.*)")
_ESCAPES = {"\\": "\\\\", "\n": "\\n", "\r": "\\r", ":": "\\:"}
_BLOCK = 1 << 22  # characters read at a time
_ROWS = 10_000  # rows written at a time
_OBJECTS = (".jsonl", ".ndjson")
_TIMESTAMPS = {"s": 1, "ms": 10**3, "us": 10**6, "ns": 10**9}


def read_log(
    path: str | os.PathLike[str],
    *,
    time: str | None = None,
    unit: str | None = None,
    rate: float | None = None,
    columns: tuple[str, ...] = (),
) -> Log:
    """The log in a file, by its suffix: `.parquet`, `.mcap`, `.jsonl` (an object a line), else CSV.

    In files of other origin `time` names the column of time; without it, one is taken that is
    called t, time or timestamp, in capitals or not, with a unit behind it or not (`time_ms`,
    `Time (s)`), and grows. Times are numbers in a `unit` (None: as the name says, else s), or ISO
    8601. With `rate` (samples a second) there need not be any. CSV may be separated by commas,
    semicolons or tabs, and have decimal commas; `columns` name those of a file without a header.
    A cell that is empty or says nan, na, null or none is NaN; a column that has text in its first
    row is left out and told in `meta["left-out"]`, and what was taken for the time in
    `meta["time"]`. Raises LogError for a file that cannot be read.
    """
    name = os.fspath(path)
    return read_form(name, Form(name, time, unit, columns, rate))


def read_form(path: str, form: Form) -> Log:
    """The same, with what is known of the table before."""
    try:
        if path.lower().endswith(".parquet"):
            return read_parquet(path, form)
        if path.lower().endswith(".mcap"):
            from bondgraph.runtime.mcap_file import read_mcap

            return read_mcap(path, form)
        if path.lower().endswith(_OBJECTS):
            return read_objects(path, form)
        return read_csv(path, form)
    except OSError as error:
        raise LogError(path, None, f"cannot be read: {error.strerror or error}") from error


def write_log(log: Log, path: str | os.PathLike[str]) -> None:
    """Write a log, by the suffix `.csv` or `.parquet`: the whole file, or nothing.

    What is read back has the same doubles (CSV: but for the sign of NaN), units and texts. The
    same log gives the same bytes. Raises ValueError for a log with lengths that differ or names
    that cannot be written, LogError where the file cannot be.
    """
    name = os.fspath(path)
    _check(log)
    try:
        if name.lower().endswith(".parquet"):
            write_parquet(log, name)
        elif name.lower().endswith(".csv"):
            write_csv(log, name)
        else:
            raise LogError(name, None, "a log is written as .csv or .parquet", "name it so")
    except OSError as error:
        raise LogError(name, None, f"cannot be written: {error.strerror or error}") from error


def _check(log: Log) -> None:
    for name, column in log.columns.items():
        if column.shape != log.time.shape:
            raise ValueError(f"{name} has {len(column)} samples, time has {log.rows}")
        if not name or re.search(r"[\r\n]", name):
            raise ValueError(f"{name!r} cannot be the name of a column")
    for key in log.meta:
        if not _KEY.fullmatch(key):
            raise ValueError(f"{key!r} cannot be a key: letters, digits, _, - and . are allowed")


class CsvReader(Reader):
    """Makes logs of lines as they come: the comments and the header first, then blocks of rows.

    Raises LogError for lines that are wrong.
    """

    def __init__(self, form: Form) -> None:
        super().__init__(form)
        self._line = 0  # the last one that was taken
        self._comment = ""  # the last one of them, which may be the header
        self._separator = ","
        self._table: Table | None = None
        self._meta: dict[str, str] = {}

    def feed(self, lines: list[str]) -> Log | None:
        """The samples in further lines; None as long as there is no header."""
        at = 0
        while self._table is None and at < len(lines):
            self._line += 1
            if self._head(lines[at].rstrip("\r\n")):
                at += 1
            else:
                self._line -= 1  # a row, and the header was a comment
        if self._table is None:
            return None
        with self._placed():
            rows = self._table.rows(lines[at:], self._refuse)
        self._line += len(lines) - at
        return self._log_of_table(self._table, rows, self._meta)

    def _refuse(self, at: int, why: Refused) -> None:
        raise self._wrong(str(why), why.help, self._line + at + 1) from why

    def _wrong(self, message: str, help: str = "", line: int | None = None) -> LogError:
        return LogError(self.form.name, line or self._line, message, help)

    @contextmanager
    def _placed(self) -> Iterator[None]:
        """What is said of the column of time gets its line."""
        try:
            yield
        except LogError as error:
            raise self._wrong(error.message, error.help, error.line) from error

    # ---------------------------------------------------------------- comments and header

    def _head(self, line: str) -> bool:
        """Take a line before the rows; False if it is one of the rows itself."""
        if line.startswith("#"):
            self._comments(line)
            return True
        if not line.strip():
            return True
        if not self._own:
            self._separator = separator_of(line)
        elif found := re.match(r"t_*([;\t])", line):
            self._separator = found[1]  # ours, and another program has saved it again
        cells = self._cells(line)
        numbers = all(map(numeric, cells))
        if self.form.columns and any(c.strip() and numeric(c) for c in cells):
            cells, numbers = list(self.form.columns), True
        elif numbers and any(c.strip() for c in cells):
            told = self._cells(self._comment.lstrip("# "))
            if len(told) != len(cells):
                message = "no header: the first line has numbers only"
                raise self._wrong(message, "name the columns in a line before")
            cells = told
        self._header(cells)
        return not numbers

    def _comments(self, line: str) -> None:
        self._comment = line
        if self._line == 1 and line.startswith(f"# {MARK} "):
            edition = line.removeprefix(f"# {MARK} ").strip()
            if edition != EDITION:
                message = f"a log of edition {edition}, this program reads {EDITION}"
                raise self._wrong(message, "read it with a newer bondgraph")
            self._own = True
        found = _COMMENT.fullmatch(line) if self._own else None
        if found:
            into = self._units if found[1] else self._meta
            into[_plain(found[2])] = _plain(found[3])

    def _cells(self, line: str) -> list[str]:
        try:
            return cells_of(line, self._separator, self._own)
        except csv.Error as error:
            raise self._wrong(str(error)) from error

    def _header(self, cells: list[str]) -> None:
        names = cells if self._own else [c.strip() for c in cells]
        names = names[:-1] if len(names) > 1 and not names[-1] else names
        for k, name in enumerate(names):
            if not name:
                raise self._wrong(f"column {k + 1} has no name", "name every column in the header")
        with self._placed():
            self._table = self._header_of(names, self._separator)


def read_csv(path: str, form: Form) -> Log:
    """The log in a CSV file; see `read_log`."""
    reader = CsvReader(form)
    parts: list[Log] = []
    check_regular(path)
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


def read_objects(path: str, form: Form) -> Log:
    """The log in a file of JSON lines; see `read_log`."""
    from bondgraph.runtime.monitoring.sources.lines import Decoder

    decoder = Decoder(form)
    check_regular(path)
    with open(path, "rb") as file:
        logs = decoder.feed(file.read() + b"\n")
    decoder.check()
    if decoder.garbage:
        raise LogError(path, None, f"no sample in {decoder.why}", "mend or delete the line")
    if len(logs) != 1:
        raise LogError(path, None, "not one JSON object a line", "name a CSV file .csv")
    return logs[0]


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
    text = "".join([_ESCAPES.get(letter, letter) for letter in text])
    return respelt(text, lambda letter: f"\\u{ord(letter):06x}")


def _plain(text: str) -> str:
    back = {code[1]: letter for letter, code in _ESCAPES.items()}

    def letter(found: re.Match[str]) -> str:
        return chr(int(found[1], 16)) if found[1] else back.get(found[2], found[2])

    return re.sub(r"\\(?:u(0[0-9a-f]{5}|10[0-9a-f]{4})|(.))", letter, text)


def _needed(path: str) -> LogError:
    return LogError(
        path,
        None,
        "Parquet needs the package pyarrow",
        "install it (pip install 'bondgraph-arr[robot]'), or use .csv",
    )


def read_parquet(path: str, form: Form) -> Log:
    """The log in a Parquet file; see `read_log`."""
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError as error:
        raise _needed(path) from error
    check_regular(path)
    try:
        table = pyarrow.parquet.ParquetFile(path).read()
    except pyarrow.ArrowException as error:
        raise LogError(path, None, f"not a Parquet file: {str(error).splitlines()[0]}") from error
    return ParquetReader(form).read(table)


class ParquetReader(Reader):
    """Makes a log of a table of Arrow."""

    def read(self, table: pyarrow.Table) -> Log:
        """All of it; raises LogError where there is no column of time."""
        path, schema, meta = self.form.name, table.schema, {}
        texts = {_text(k): v for k, v in (schema.metadata or {}).items()}
        if MARK in texts:
            if _text(texts.pop(MARK)) != EDITION:
                message = f"a log of another edition, this program reads {EDITION}"
                raise LogError(path, None, message, "read it with a newer bondgraph")
            self._own, meta = True, {k: _text(v) for k, v in texts.items()}
        names = list(schema.names)
        if len(names) > COLUMNS:
            message = f"{len(names)} columns, {COLUMNS} are the most"
            raise LogError(path, None, message, "leave out what no model reads")
        twice = next((n for k, n in enumerate(names) if n in names[:k]), None)
        if twice is not None:
            raise LogError(path, None, f"two columns are called `{twice}`", "rename one of them")
        self._units = {f.name: _text((f.metadata or {}).get(b"unit", b"")) for f in schema}
        own = self._own and self.form.time is None
        times = names[:1] if own else self._times_of(names)
        stamps = {n: s for n in times if (s := _stamps(table.column(n))) is not None}
        columns = {n: stamps.get(n, _numbers(table.column(n))) for n in names}
        words = [n for n, values in columns.items() if values is None]
        if words:
            meta[LEFT_OUT] = ", ".join(f"{n} ({schema.field(n).type})" for n in words)
        found = {n: values for n, values in columns.items() if values is not None}
        numbers = {n: found[n] for n in times if n in found}
        if times and not numbers:
            raise LogError(path, None, f"the column {times[0]} of time has no numbers")
        timeless = self.form.rate is not None
        name = times[0] if own else chosen(numbers, path, timeless)
        if name is None:
            return self._log(table.num_rows, None, "", found, meta)
        return self._log(table.num_rows, found.pop(name), name, found, meta, name in stamps)


def _text(data: bytes) -> str:
    return data.decode("utf-8", "replace")


def _stamps(column: pyarrow.ChunkedArray) -> Array | None:
    """The times in s in a column of dates and times, or of their texts; None in any other."""
    import pyarrow

    kind = column.type
    if pyarrow.types.is_timestamp(kind):
        found = doubles(column.cast(pyarrow.int64()).cast(pyarrow.float64(), safe=False))
        return found if kind.unit == "s" else found / _TIMESTAMPS[kind.unit]
    if not (pyarrow.types.is_string(kind) or pyarrow.types.is_large_string(kind)):
        return None
    times = [np.nan if text is None else stamp(text) for text in column.to_pylist()]
    return None if None in times else np.array(times, dtype=np.float64)


def _numbers(column: pyarrow.ChunkedArray) -> Array | None:
    """The numbers of a column, NaN where there are none; None where it is not of numbers."""
    import pyarrow

    kind = column.type
    if not any(
        test(kind)
        for test in (
            pyarrow.types.is_floating,
            pyarrow.types.is_integer,
            pyarrow.types.is_boolean,
            pyarrow.types.is_decimal,
            pyarrow.types.is_null,
        )
    ):
        return None
    return doubles(column.cast(pyarrow.float64(), safe=False))


def write_parquet(log: Log, path: str) -> None:
    """Write a log as Parquet; see `write_log`."""
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError as error:
        raise _needed(path) from error
    arrays = {name_of_time(log.columns): log.time, **log.columns}
    units = {name_of_time(log.columns): "s", **log.units}
    fields = [
        pyarrow.field(n, pyarrow.float64(), metadata={"unit": units[n]} if units.get(n) else None)
        for n in arrays
    ]
    schema = pyarrow.schema(fields, metadata={MARK: EDITION, **log.meta})
    table = pyarrow.Table.from_arrays([pyarrow.array(a) for a in arrays.values()], schema=schema)
    with whole(path) as temporary, naming(path):
        pyarrow.parquet.write_table(table, temporary)
