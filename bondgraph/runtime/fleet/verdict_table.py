"""The verdicts of a fleet as a table: a row for each, written as CSV or Parquet and read again."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable
from typing import Any

from bondgraph.runtime.fleet.watched_log import WatchedLog, from_json_record
from bondgraph.runtime.log import LogError
from bondgraph.text.printable import printable
from bondgraph.text.whole_file import naming, whole

#: What a row is called that says why a log is bad.
ERROR = "error"

_OF_LOG = {"log": str, "start": float, "end": float, "worst": str, "level": float, "notes": str}
_OF_VERDICT = {
    "number": int, "time": float, "event": str, "since": float, "class": str, "residuals": str,
    "candidates": str, "pairs": str, "message": str,
}  # fmt: skip
_KINDS: dict[str, type] = {**_OF_LOG, **_OF_VERDICT, "key": str}
_SUMMARY = "log state start end alarms class since worst level notes error".split()
_BETWEEN = "; "  # notes have none


def columns_of(logs: Iterable[WatchedLog]) -> dict[str, list[Any]]:
    """The table by column; what a row says of its log is the same in all rows of it.

    A row of a bad log comes last and has the event `error`. `residuals`, `candidates` and `pairs`
    are JSON, as in a line of `--json`.

    >>> table = columns_of([WatchedLog("a.csv", error="no samples came")])
    >>> table["log"], table["event"], table["message"]
    (['a.csv'], ['error'], ['no samples came'])
    """
    columns: dict[str, list[Any]] = {name: [] for name in _KINDS}
    for log in logs:
        own = [log.log, log.start, log.end, log.residual, log.level, _BETWEEN.join(log.notes)]
        rows = [_row(verdict) for verdict in log.to_record()["verdicts"]]
        if log.error:
            nothing = ["{}", "[]", "[]"]
            rows.append([len(rows) + 1, log.end, ERROR, None, "", *nothing, log.error])
        for row in rows:
            for name, value in zip(_KINDS, [*own, *row, log.key], strict=True):
                columns[name].append(value)
    return columns


def summary(logs: Iterable[WatchedLog]) -> dict[str, list[Any]]:
    """A row for each log, by column; `class` and `since` are of its last alarm."""
    columns: dict[str, list[Any]] = {name: [] for name in _SUMMARY}
    for log in logs:
        alarm = log.last_alarm
        named, since = ("", None) if alarm is None else (" or ".join(alarm.group), alarm.since)
        row = [log.log, log.state, log.start, log.end, log.alarms, named, since, log.residual,
               log.level, _BETWEEN.join(log.notes), log.error]  # fmt: skip
        for name, value in zip(_SUMMARY, row, strict=True):
            columns[name].append(value)
    return columns


def _row(said: dict[str, Any]) -> list[Any]:
    named = " or ".join(said["group"])
    parts = [json.dumps(said[name]) for name in ("residuals", "candidates", "pairs")]
    return [said["number"], said["time"], said["event"], said["since"], named, *parts,
            said["message"]]  # fmt: skip


def check_name(path: str) -> None:
    """Raise LogError for a file that cannot be written here, by its name."""
    if path.lower().endswith(".parquet"):
        _parquet(path)
    elif not path.lower().endswith(".csv"):
        raise LogError(path, None, "verdicts are written as .csv or .parquet", "name it so")


def write_verdicts(path: str, logs: Iterable[WatchedLog]) -> None:
    """Write the table, the whole file or nothing; raises LogError or OSError."""
    columns = columns_of(logs)
    with whole(path) as temporary, naming(path):
        if path.lower().endswith(".parquet"):
            arrow, parquet = _parquet(path)
            kinds = {str: arrow.string(), float: arrow.float64(), int: arrow.int64()}
            schema = arrow.schema([(name, kinds[kind]) for name, kind in _KINDS.items()])
            parquet.write_table(arrow.table(columns, schema=schema), temporary)
            return
        with open(temporary, "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(columns)
            for row in zip(*columns.values(), strict=True):
                writer.writerow([printable(v) if isinstance(v, str) else v for v in row])


def read_verdicts(path: str) -> list[WatchedLog]:
    """The logs of a table that was written so; raises LogError for any other file."""
    try:
        rows = _parquet_rows(path) if path.lower().endswith(".parquet") else _csv_rows(path)
        logs: dict[str, dict[str, Any]] = {}
        for row in rows:
            log = logs.setdefault(row["log"], _of_log(row))
            if row["event"] == ERROR:
                log["error"] = row["message"]
            else:
                log["verdicts"].append(_said(row))
        return [from_json_record(log) for log in logs.values()]
    except OSError as error:
        raise LogError(path, None, f"cannot be read: {error.strerror or error}") from error
    except (AttributeError, KeyError, TypeError, ValueError, csv.Error) as error:
        message = "it is there, and no table of verdicts that `--output` wrote"
        raise LogError(path, None, message, "name another file, or move it away") from error


def _of_log(row: dict[str, Any]) -> dict[str, Any]:
    return {
        "log": row["log"],
        "verdicts": [],
        "start": row["start"],
        "end": row["end"],
        "residual": row["worst"],
        "level": row["level"],
        "notes": row["notes"].split(_BETWEEN) if row["notes"] else [],
        "error": "",
        "told": [],
        "key": row["key"],
    }


def _said(row: dict[str, Any]) -> dict[str, Any]:
    parts = {name: json.loads(row[name]) for name in ("residuals", "candidates", "pairs")}
    group = row["class"].split(" or ") if row["class"] else []
    return {**{n: row[n] for n in ("number", "event", "time", "since", "message")}, **parts,
            "group": group}  # fmt: skip


def _csv_rows(path: str) -> Iterable[dict[str, Any]]:
    with open(path, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file, strict=True):
            yield {
                name: row[name] if kind is str else kind(row[name]) if row[name] else None
                for name, kind in _KINDS.items()
            }


def _parquet_rows(path: str) -> Iterable[dict[str, Any]]:
    arrow, parquet = _parquet(path)
    try:
        found: list[dict[str, Any]] = parquet.ParquetFile(path).read().to_pylist()
    except arrow.ArrowException as error:
        raise ValueError(str(error)) from error
    return found


def _parquet(path: str) -> tuple[Any, Any]:
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError as error:
        message, help = "Parquet needs the package pyarrow", "install it, or name the file .csv"
        raise LogError(path, None, message, help) from error
    return pyarrow, pyarrow.parquet
