"""A table of a watch: a row for each sample, with what each residual is and what is known."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from bondgraph.runtime.log import Array, LogError
from bondgraph.runtime.monitoring.engine import Batch
from bondgraph.runtime.monitoring.residual_states import STATES, Told
from bondgraph.text.whole_file import naming, whole


class _Table(Protocol):
    def add(self, columns: dict[str, Any]) -> None:
        """Further rows: columns of equal length."""

    def close(self) -> None:
        """There are no more."""


class States:
    """Writes the rows.

    Columns: `time` (s); for each residual its value, `_threshold` (NaN where none is known yet) and
    `_state`; `active` (1 while a fault is latched), `state` and `class`, the faults of the class
    that is named; see `ResidualStates`. The whole is in alarm where any is, and healthy where any
    is watched.
    """

    def __init__(self, table: _Table, residuals: Sequence[str]) -> None:
        self._table, self._residuals = table, tuple(residuals)

    def add(self, time: Array, decided: Batch, told: Told) -> None:
        """Further samples, by what they were decided on, and what they are."""
        names = np.array(STATES, dtype=object)
        watched = decided.valid & np.isfinite(decided.bound)
        columns: dict[str, Any] = {"time": time}
        for k, name in enumerate(self._residuals):
            columns[name] = np.where(decided.valid[:, k], decided.value[:, k], np.nan)
            columns[f"{name}_threshold"] = np.where(watched[:, k], decided.bound[:, k], np.nan)
            columns[f"{name}_state"] = names[told.codes[:, k]]
        columns["active"] = told.fired.astype(int)
        columns["state"] = names[told.whole]
        columns["class"] = told.named
        self._table.add(columns)


@contextmanager
def states_file(path: str, residuals: Sequence[str]) -> Iterator[States]:
    """A CSV or Parquet file of the rows, there when the watch ends.

    Raises LogError for another kind of file, or where Parquet cannot be written here.
    """
    kinds: dict[str, Callable[[Path], _Table]] = {".csv": _Csv, ".parquet": _Parquet}
    kind = kinds.get(Path(path).suffix.lower())
    if kind is None:
        raise LogError(path, None, "states are written as .csv or .parquet")
    with whole(path) as temporary:
        table = _Named(kind(temporary), path)
        try:
            yield States(table, residuals)
        finally:
            table.close()


class _Named:
    """A table whose failures name its file, not the one aside."""

    def __init__(self, table: _Table, path: str) -> None:
        self._table, self._path = table, path

    def add(self, columns: dict[str, Any]) -> None:
        with naming(self._path):
            self._table.add(columns)

    def close(self) -> None:
        with naming(self._path):
            self._table.close()


class _Csv:
    def __init__(self, path: Path) -> None:
        self._file = path.open("w", encoding="utf-8", newline="")
        self._writer = csv.writer(self._file, lineterminator="\n")
        self._begun = False

    def add(self, columns: dict[str, Any]) -> None:
        if not self._begun:
            self._writer.writerow(columns)
            self._begun = True
        cells = [x.tolist() for x in columns.values()]
        empty = [["" if c != c else c for c in column] for column in cells]  # NaN
        self._writer.writerows(zip(*empty, strict=True))

    def close(self) -> None:
        self._file.close()


class _Parquet:
    def __init__(self, path: Path) -> None:
        try:
            import pyarrow.parquet
        except ImportError as error:
            raise LogError(str(path), None, "Parquet needs pyarrow: pip install pyarrow") from error
        self._path, self._parquet = path, pyarrow.parquet
        self._writer: Any = None

    def add(self, columns: dict[str, Any]) -> None:
        import pyarrow

        table = pyarrow.table({n: pyarrow.array(x.tolist()) for n, x in columns.items()})
        if self._writer is None:
            self._writer = self._parquet.ParquetWriter(self._path, table.schema)
        self._writer.write_table(table)

    def close(self) -> None:
        if self._writer is not None:
            self._writer.close()
