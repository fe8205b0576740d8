"""Watching one log after the other with the same settings, each from its first sample."""

from __future__ import annotations

import hashlib
import json
import os
import pickle
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from functools import lru_cache
from threading import Lock
from typing import Protocol

from bondgraph.runtime.fleet.watched_log import Extent, WatchedLog
from bondgraph.runtime.log import Log, LogError
from bondgraph.runtime.log_numbers import Form
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.runtime.monitoring.sample_pipeline import Monitor
from bondgraph.runtime.monitoring.sources.file import LoadedLog, file_source
from bondgraph.runtime.monitoring.sources.sample_source import Source
from bondgraph.runtime.monitoring.states import States, states_file
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.runtime.monitoring.watch_parts import Decision, Parts, Stop
from bondgraph.runtime.monitoring.watch_settings import (
    WatchSettings,
    sample_rate,
    usual_bandwidth,
    watching,
    what_is_watched,
)
from bondgraph.text.diagnostic import CompileError, Trouble
from bondgraph.text.numerals import plural
from bondgraph.text.regular_file import check_regular
from bondgraph.text.tuples import NamedTuple
from bondgraph.text.whole_file import naming

_RATES = 16  # and filters of which engines are kept

#: Passes, and the numbers that they work with, belong to one thread at a time.
_TURN = Lock()


class Item(Protocol):
    """A log that is to be watched."""

    @property
    def name(self) -> str:
        """What it is called in tables."""

    @property
    def path(self) -> str:
        """What it is called in verdicts."""

    @property
    def states(self) -> str:
        """The file of its states, "" for none."""

    def source(self, form: Form) -> Source:
        """Its samples; raises LogError."""

    def key(self, digest: str) -> str:
        """By what its verdicts are known again: the `digest` of the settings, and what it is."""


class LogFile(NamedTuple):
    """A log in a file; `name` is as it was called, `path` is found from everywhere.

    So are its `states`, a file that is written while it is watched.
    """

    name: str
    path: str
    states: str = ""

    def source(self, form: Form) -> Source:
        """See `Item`."""
        check_regular(self.path)  # nobody waits for a pipe among many logs
        return file_source(self.path, form._replace(name=self.name))

    def key(self, digest: str) -> str:
        """See `Item`; a file is another one with another path, size or time of change."""
        try:
            state = os.stat(self.path)
            what = f"{state.st_size} {state.st_mtime_ns}"
        except OSError:
            what = "missing"
        return _hash(digest, self.path, what)


class LogTable(NamedTuple):
    """A log in memory; `states` as of a `LogFile`."""

    name: str
    log: Log
    states: str = ""

    @property
    def path(self) -> str:
        """See `Item`."""
        return self.name

    def source(self, form: Form) -> Source:
        """See `Item`."""
        return LoadedLog(self.name, self.log)

    def key(self, digest: str) -> str:
        """See `Item`; nothing is kept of it."""
        return ""


class Watcher:
    """Watches logs of any rates and lengths; the model is compiled once for each filter."""

    def __init__(self, settings: WatchSettings) -> None:
        self._settings = settings
        self._made: dict[tuple[float, float | None], _Made] = {}

    def watch(self, item: Item) -> WatchedLog:
        """What there is to say of one log, as a watch of nothing else says it.

        Raises nothing: what is wrong with a log is its `error`.
        """
        heard = _Heard()
        error = ""
        try:
            self._watch(item, heard)
        except (Trouble, CompileError) as trouble:
            error = _without_place(trouble, item)
        except OSError as trouble:
            written = item.states and trouble.filename == item.states
            what = f"its states cannot be written to {item.states}" if written else "cannot be read"
            error = f"{what}: {trouble.strerror or trouble}"
        except Exception as trouble:
            what = f"the watch failed: {type(trouble).__name__}: {trouble}"
            help = "`bondgraph monitor` on this log alone says more with BONDGRAPH_TRACEBACK=1"
            error = f"{what}; {help}"
        return heard.result(item.name, "".join(c if c.isprintable() else " " for c in error))

    def _watch(self, item: Item, heard: _Heard) -> None:
        settings = self._settings
        with closing(item.source(settings.form)) as source:
            usual = settings.compilation.options.rate
            rate = sample_rate(settings.form.rate, source, settings.tuning, usual)
            bandwidth = settings.compilation.options.bandwidth
            if bandwidth is None and settings.tuning is None:
                asked = settings.operating, settings.mapping
                bandwidth = usual_bandwidth(rate, source, False, *asked, settings.fitted)
            made = self._at(rate, bandwidth)
            engine = made.engine.configured()
            parts = made.settings.parts(source, engine, made.decided(engine))
            compilation = made.settings.compilation
            heard.extent = Extent(engine.residuals, compilation.diagnosis_model.sees)
            heard.told += made.told
            with _states(item.states, engine.residuals) as states:
                heard.parts = parts._replace(
                    sinks=[lambda _, verdict: heard.said.append(verdict)],
                    note=lambda text: heard.told.append(text.removeprefix(f"{source.name}: ")),
                    listeners=(heard.extent, *states),
                )
                heard.monitor = Monitor(heard.parts, what_is_watched(compilation, engine))
                heard.monitor.run(Stop())

    def _at(self, rate: float, bandwidth: float | None) -> _Made:
        """What watches at a rate with a filter; raises Trouble or CompileError."""
        found = self._made.get((rate, bandwidth))
        if found is None:
            told: list[str] = []
            compilation = self._settings.compilation.with_options(
                rate=rate, bandwidth=bandwidth
            )
            engine, decided = watching(
                compilation, self._settings.tuning, told.append, self._settings.accept
            )
            settings = self._settings._replace(compilation=compilation)
            found = _Made(settings, engine, decided, told)
            while len(self._made) >= _RATES:
                del self._made[next(iter(self._made))]
            self._made[rate, bandwidth] = found
        return found


@contextmanager
def _states(path: str, residuals: Sequence[str]) -> Iterator[list[States]]:
    """What writes a file of states, with the folders above it; none without a path."""
    if not path:
        yield []
        return
    with naming(path):
        os.makedirs(os.path.dirname(path), exist_ok=True)
    with states_file(path, residuals) as states:
        yield [states]


class _Made(NamedTuple):
    """What watches logs of one rate, and what was said when it was made."""

    settings: WatchSettings
    engine: Engine
    decided: Callable[[Engine], Decision]
    told: list[str]


class _Heard:
    """What a watch has said so far."""

    def __init__(self) -> None:
        self.said: list[Verdict] = []
        self.told: list[str] = []
        self.extent: Extent | None = None
        self.parts: Parts | None = None
        self.monitor: Monitor | None = None

    def result(self, name: str, error: str) -> WatchedLog:
        """All of it."""
        found = WatchedLog(name, tuple(self.said), error=error, told=tuple(self.told))
        if self.extent is None or self.parts is None or self.monitor is None:
            return found
        residual, level = self.extent.worst
        return found._replace(
            start=self.extent.start,
            end=self.extent.end,
            residual=residual,
            level=level,
            notes=_notes(self.parts, self.monitor, self.extent),
        )


def watch_in_worker(settings: bytes, item: Item) -> WatchedLog:
    """The same in a process that has nothing but this: `settings` are pickled."""
    with _TURN:
        return _watcher(settings).watch(item)


@lru_cache(maxsize=2)
def _watcher(settings: bytes) -> Watcher:
    return Watcher(pickle.loads(settings))


def digest(settings: WatchSettings, version: str) -> str:
    """By what settings are known again: model, options, tuning, columns, what is accepted.

    And the `version` of the program.
    """
    c, tuning = settings.compilation, settings.tuning
    return _hash(
        version,
        c.source.text,
        c.program.digest,
        "" if c.thresholds is None else c.thresholds.digest,
        repr(c.options),
        "" if tuning is None else tuning.to_json(),
        repr(settings.form),
        repr(sorted((settings.mapping or {}).items())),
        settings.operating or "",
        repr(settings.accept),
        repr(settings.fitted),
    )


def _hash(*parts: str) -> str:
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()[:32]


def _without_place(error: Exception, item: Item) -> str:
    """What is wrong, without the name of the log, which stands beside it."""
    if not isinstance(error, LogError) or error.path not in (item.name, item.path):
        return str(error)
    line = "" if error.line is None else f"line {error.line}: "
    return f"{line}{error.message}" + (f"; {error.help}" if error.help else "")


def _notes(parts: Parts, monitor: Monitor, extent: Extent) -> tuple[str, ...]:
    """What is missing, in a few words each."""
    samples, lines, clock = monitor.account.samples, monitor.account.lines, parts.clock
    notes = []
    if lines["gaps"]:
        notes.append(plural(lines["gaps"], "gap"))
    if lines["garbage"]:
        notes.append(f"{plural(lines['garbage'], 'line')} left out")
    if samples["unmatched"]:
        notes.append(f"{plural(samples['unmatched'], 'sample')} without all columns")
    if clock.dropped:
        notes.append(f"{plural(clock.dropped, 'sample')} late, twice or empty")
    if clock.left_out:
        notes.append(f"off for {plural(clock.left_out, 'sample')}")
    if extent.start is not None and extent.unwatched:
        notes.append(f"{extent.unwatched} not watched")
    return tuple(notes)
