"""A fleet from Python: files, folders, data frames in; verdicts and tables out."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

from bondgraph.runtime.diagnosis.tuning import Tuning
from bondgraph.runtime.fleet.column_log import log_of
from bondgraph.runtime.fleet.log_paths import log_files, with_states
from bondgraph.runtime.fleet.verdict_table import columns_of, summary
from bondgraph.runtime.fleet.watched_log import BAD, WatchedLog
from bondgraph.runtime.fleet.watcher import Item, LogTable
from bondgraph.runtime.fleet.workers import default_client, watched
from bondgraph.runtime.log import Log, LogError
from bondgraph.runtime.log_numbers import Form
from bondgraph.runtime.monitoring.columns import Mapped, read_map, read_time
from bondgraph.runtime.monitoring.engine import setting
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.runtime.monitoring.watch_settings import Compiled, WatchSettings
from bondgraph.text.diagnostic import Trouble


class Fleet(Sequence[WatchedLog]):
    """What came of each log, in the order in which they were given."""

    def __init__(self, logs: Iterable[WatchedLog]) -> None:
        self._logs = tuple(logs)

    def __getitem__(self, at: Any) -> Any:
        return self._logs[at]

    def __len__(self) -> int:
        return len(self._logs)

    def __iter__(self) -> Iterator[WatchedLog]:
        return iter(self._logs)

    @cached_property
    def verdicts(self) -> list[list[Verdict]]:
        """All that was said, a list for each log."""
        return [list(log.verdicts) for log in self._logs]

    def table(self) -> dict[str, list[Any]]:
        """A row for each log, by column; pandas and polars take it as it is (docs/fleets.md)."""
        return summary(self._logs)

    def rows(self) -> dict[str, list[Any]]:
        """A row for each verdict, by column, as `monitor --output` writes it."""
        return columns_of(self._logs)

    def __repr__(self) -> str:
        states = [log.state for log in self._logs]
        parts = [f"{states.count(s)} {s}" for s in dict.fromkeys(states)]
        return f"Fleet({', '.join(parts)})"


def monitor(
    compilation: Compiled,
    logs: Any,
    *,
    tuning: Tuning | None = None,
    columns: Mapping[str, Mapped] | str | os.PathLike[str] | None = None,
    time: str | None = None,
    unit: str | None = None,
    rate: float | None = None,
    operating: str | None = None,
    accept: float | None = None,
    jobs: int = 1,
    states: str | os.PathLike[str] | None = None,
    progress: Callable[[float], None] = lambda _: None,
    tell: Callable[[str], object] = lambda _: None,
) -> Fleet:
    """Watch logs of a machine, each by itself, as `bondgraph monitor` does (docs/fleets.md).

    `logs` is a pandas or polars data frame, a dict of columns, a `Log`, a path of a file, folder or
    pattern, a list of any of these, or a dict of them by name. `columns` is a map file or what it
    says; `time`, `unit`, `rate`, `operating` and `accept` are as in `bondgraph monitor`: `--time`,
    `--time-unit`, `--rate`, `--while`, `--accept`. With `jobs` above 1 so many processes watch, or
    the workers of Dask if `distributed` has a default client. `states` is a folder that gets a
    table of each log, with a row for each sample. `progress` is told the share that is done, 0 to
    1, `tell` what a watch notes besides. A log that cannot be watched has an `error`; raises
    Trouble if that is so for all, CompileError if the model is wrong, ValueError without any log or
    if `states` is where logs are, OSError if it cannot be made.

    >>> import bondgraph, numpy
    >>> c = bondgraph.compile("models/dc_motor.bg")
    >>> t = numpy.arange(3000) / 1000
    >>> rest = dict.fromkeys(["U", "load", "current", "speed"], 0 * t)
    >>> found = bondgraph.monitor(c, {"rest": {"t": t, **rest}, "empty": {"t": t}})
    >>> found.table()["log"], found.table()["state"], found[1].error[:20]
    (['rest', 'empty'], ['not watched', 'bad'], 'no column for load (')
    """
    form = Form("", time, unit, (), rate)
    mapping: Mapping[str, Mapped] | None = None
    if isinstance(columns, str | os.PathLike):
        told = read_time(columns)
        if told is not None and time is None:
            form = form._replace(time=told.column, unit=unit or told.unit)
        mapping = read_map(columns, setting(*compilation.runnable_programs).signals)
    elif columns is not None:
        mapping = dict(columns)
    if mapping is not None and operating is None:
        form = form._replace(wanted=frozenset(own.column for own in mapping.values()))
    settings = WatchSettings(compilation, tuning, form, mapping, operating, accept)
    assert compilation.program  # a wrong model is told before any log is looked at
    folder = os.fspath(states) if states is not None else ""
    items, bad = _items(logs, form, tell, folder)
    if not items and not bad:
        raise ValueError("no log to watch")
    if folder:
        os.makedirs(folder, exist_ok=True)
    found: dict[int, WatchedLog] = dict(bad)
    places = [k for k in range(len(items) + len(bad)) if k not in bad]
    for k, one in watched(settings, items, jobs, default_client()):
        found[places[k]] = one
        for text in one.told:
            tell(f"{one.log}: {text}")
        progress(len(found) / (len(items) + len(bad)))
    fleet = Fleet([found[k] for k in sorted(found)])
    if all(log.state == BAD for log in fleet):
        raise Trouble(f"no log can be watched; {fleet[0].log}: {fleet[0].error}")
    return fleet


def _items(
    logs: Any, form: Form, tell: Callable[[str], object], states: str
) -> tuple[list[Item], dict[int, WatchedLog]]:
    """What is to be watched, and by its place what cannot be: tables that are no logs."""
    items: list[Item] = []
    bad: dict[int, WatchedLog] = {}
    for name, one in _named(logs):
        if isinstance(one, str | os.PathLike):
            files = log_files([os.fspath(one)], tell, states)
            own = [f._replace(name=name) if name and len(files) == 1 else f for f in files]
            items += [with_states(f, states) for f in own]
            continue
        called = name or f"log {len(items) + len(bad) + 1}"
        try:
            log = one if isinstance(one, Log) else log_of(one, form._replace(name=called))
            items.append(with_states(LogTable(called, log), states))
        except LogError as error:
            text = error.message + (f"; {error.help}" if error.help else "")
            bad[len(items) + len(bad)] = WatchedLog(called, error=text)
    return items, bad


def _named(logs: Any) -> list[tuple[str, Any]]:
    """The logs, each with its name, "" if it has none."""
    if _single(logs):
        return [("", logs)]
    if isinstance(logs, Mapping):
        return [(str(name), one) for name, one in logs.items()]
    return [("", one) for one in logs]


def _single(logs: Any) -> bool:
    """Whether this is one log, and not several of them."""
    if isinstance(logs, Mapping):  # of columns, unless it holds logs
        return not any(_single(one) for one in logs.values())
    return isinstance(logs, str | os.PathLike | Log) or hasattr(logs, "columns")
