"""Logs of columns in memory: of a pandas or polars data frame, or a dict."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any

import numpy as np

from bondgraph.runtime.log import LEFT_OUT, Array, Log, LogError
from bondgraph.runtime.log_numbers import Form, Reader
from bondgraph.runtime.time_column import chosen, stamp

_INDEX = "time"  # what the index of a data frame is called that has no name


def log_of(table: Any, form: Form) -> Log:
    """The log in a data frame, or in a dict of columns; the time as in a file, see `read_log`.

    Columns are those of `table.columns`, or the keys, each an array that numpy takes. A pandas
    index of dates, or one with the name of a time, is a column too. Raises LogError.

    >>> log = log_of({"t_ms": [0, 10, 20], "U": [1.0, None, 3.0]}, Form("run"))
    >>> log.time.tolist(), log.columns["U"].tolist()
    ([0.0, 0.01, 0.02], [1.0, nan, 3.0])
    """
    return _ColumnReader(form).read(_columns(table))


class _ColumnReader(Reader):
    """Makes a log of columns by name."""

    def read(self, columns: Mapping[str, Any]) -> Log:
        """All of it; raises LogError where there is no column of time, or lengths differ."""
        name, names = self.form.name, list(columns)
        lengths = {n: len(values) for n, values in columns.items()}
        if len(set(lengths.values())) > 1:
            told = ", ".join(f"{n} {count}" for n, count in lengths.items())
            raise LogError(name, None, f"the columns have different lengths: {told}")
        times = self._times_of(names)
        found = {n: own for n in names if (own := _numbers(columns[n])) is not None}
        stamps = {n: s for n in times if (s := _stamps(columns[n])) is not None}
        found |= stamps
        words = [n for n in names if n not in found]
        meta = {LEFT_OUT: ", ".join(words)} if words else {}
        numbers = {n: found[n] for n in times if n in found}
        if times and not numbers:
            raise LogError(name, None, f"the column {times[0]} of time has no numbers")
        time = chosen(numbers, name, self.form.rate is not None)
        rows = next(iter(lengths.values()), 0)
        if time is None:
            return self._log(rows, None, "", found, meta)
        return self._log(rows, found.pop(time), time, found, meta, time in stamps)


def _columns(table: Any) -> dict[str, Any]:
    names = getattr(table, "column_names", None) or getattr(table, "columns", table)
    columns = {str(name): np.asarray(table[name]) for name in names}
    index = getattr(table, "index", None)
    if index is not None and not callable(index):
        values, name = np.asarray(index), getattr(index, "name", None)
        dates = values.dtype.kind in "mM" or isinstance(next(iter(values), None), datetime)
        if dates or name is not None:
            columns = {str(name or _INDEX): values} | columns
    return columns


def _numbers(column: Any) -> Array | None:
    """The numbers of a column, NaN where there are none; None where it is not of numbers."""
    if column.dtype.kind in "mMSU":
        return None
    try:
        return np.array(column, dtype=np.float64)  # None is NaN then
    except (TypeError, ValueError):
        return None


def _stamps(column: Any) -> Array | None:
    """The times in s in a column of dates, of spans of time, or of texts; None in any other."""
    if column.dtype.kind in "mM":
        whole = column.astype(f"{column.dtype.kind}8[ns]").astype(np.int64)
        micro, nano = np.divmod(whole, 1000)  # a double has every microsecond of today
        return np.where(np.isnat(column), np.nan, micro / 1e6 + nano / 1e9)
    if column.dtype.kind not in "OSU":
        return None
    times = [_stamp(cell) for cell in column.tolist()]
    return None if not times or None in times else np.array(times, dtype=np.float64)


def _stamp(cell: object) -> float | None:
    """The time in s that a cell is, if it is a text or a date; without a zone it is UTC."""
    if isinstance(cell, datetime):
        return cell.replace(tzinfo=cell.tzinfo or UTC).timestamp()
    return stamp(cell) if isinstance(cell, str) else None
