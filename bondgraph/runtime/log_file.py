"""Reading a log from a file and writing one, as CSV or Parquet by the suffix."""

from __future__ import annotations

import os
import re

from bondgraph.runtime.log import Log, LogError
from bondgraph.runtime.log_csv import read_csv, write_csv
from bondgraph.runtime.log_parquet import read_parquet, write_parquet

_KEY = re.compile(r"[A-Za-z_][\w.-]*", re.ASCII)


def read_log(
    path: str | os.PathLike[str], *, time: str | None = None, rate: float | None = None
) -> Log:
    """The log in a file, by its suffix: `.parquet`, else CSV.

    In files of other origin `time` names the column of time; without it, one is taken that is
    called t, time or timestamp, in capitals or not, with a unit behind it or not (`time_ms`). Times
    are in s unless that unit says otherwise. With `rate` (samples a second) there need not be
    one. CSV may be separated by commas, semicolons or tabs; a cell that is empty or says nan, na,
    null or none is NaN; a column that has text in its first row is left out and told in
    `meta["left-out"]`. Raises LogError for a file that cannot be read.
    """
    name = os.fspath(path)
    try:
        if name.lower().endswith(".parquet"):
            return read_parquet(name, time, rate)
        return read_csv(name, time, rate)
    except OSError as error:
        raise LogError(name, None, f"cannot be read: {error.strerror or error}") from error


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
