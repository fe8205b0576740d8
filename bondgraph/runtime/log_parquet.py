"""Logs as Parquet, through pyarrow: units in the metadata of the fields, texts in the schema's."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bondgraph.runtime.log import (
    EDITION,
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
    whole,
)

if TYPE_CHECKING:
    import pyarrow

_TIMESTAMPS = {"s": 1, "ms": 10**3, "us": 10**6, "ns": 10**9}


def _needed(path: str) -> LogError:
    return LogError(
        path,
        None,
        "Parquet needs the package pyarrow",
        "install it (pip install 'bondgraph-arr[robot]'), or use .csv",
    )


def read_parquet(path: str, time: str | None, rate: float | None) -> Log:
    """The log in a Parquet file; see `read_log`."""
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError as error:
        raise _needed(path) from error
    try:
        table = pyarrow.parquet.ParquetFile(path).read()
    except pyarrow.ArrowException as error:
        raise LogError(path, None, f"not a Parquet file: {str(error).splitlines()[0]}") from error
    schema, own, meta = table.schema, False, {}
    texts = {_text(k): v for k, v in (schema.metadata or {}).items()}
    if MARK in texts:
        if _text(texts.pop(MARK)) != EDITION:
            message = f"a log of another edition, this program reads {EDITION}"
            raise LogError(path, None, message, "read it with a newer bondgraph")
        own, meta = True, {k: _text(v) for k, v in texts.items()}
    names = list(schema.names)
    twice = next((n for k, n in enumerate(names) if n in names[:k]), None)
    if twice is not None:
        raise LogError(path, None, f"two columns are called `{twice}`", "rename one of them")
    named = time_column(names, time, path, None)
    if own and time is None:
        named = names[0]
    if named is None and rate is None:
        raise no_time(path, None, names)
    units = {f.name: _text((f.metadata or {}).get(b"unit", b"")) for f in schema}
    columns = {n: _numbers(table.column(n), n == named) for n in names}
    words = [n for n, values in columns.items() if values is None]
    if words:
        meta[LEFT_OUT] = ", ".join(f"{n} ({schema.field(n).type})" for n in words)
    found = {n: values for n, values in columns.items() if values is not None}
    if named is None:
        assert rate is not None
        times = np.arange(table.num_rows) / rate
    else:
        if named not in found:
            raise LogError(path, None, f"the column {named} of time has no numbers")
        stamped = pyarrow.types.is_timestamp(schema.field(named).type)
        unit = "" if own or stamped else unit_of_time(named, units)
        meta |= {TIME_UNIT: unit} if unit else {}
        times = seconds(found.pop(named), unit, path)
    return Log(times, found, {n: u for n, u in units.items() if u and n in found}, meta)


def _text(data: bytes) -> str:
    return data.decode("utf-8", "replace")


def _numbers(column: pyarrow.ChunkedArray, time: bool) -> Array | None:
    """The numbers of a column, NaN where there are none; None where it is not of numbers."""
    import pyarrow

    kind, scale = column.type, 1
    if time and pyarrow.types.is_timestamp(kind):
        scale, column = _TIMESTAMPS[kind.unit], column.cast(pyarrow.int64())
    elif not any(
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
    values = column.cast(pyarrow.float64(), safe=False).to_numpy(zero_copy_only=False)
    found: Array = np.array(values, dtype=np.float64)  # one that may be written to
    return found if scale == 1 else found / scale


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
    with whole(path) as temporary:
        pyarrow.parquet.write_table(table, temporary)
