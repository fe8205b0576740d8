"""`bondgraph monitor` on many logs: each is watched by itself, and a table says what came of it."""

from __future__ import annotations

import os
import sys
from contextlib import nullcontext
from typing import TYPE_CHECKING

from bondgraph import Options, __version__
from bondgraph.cli import console
from bondgraph.cli.log_options import form_of, note, operating_of
from bondgraph.cli.options import fitted_bandwidth, realising
from bondgraph.cli.terminal_layout import prose, width
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.moment import moment
from bondgraph.text.numerals import listed, plural

if TYPE_CHECKING:
    from argparse import Namespace
    from collections.abc import Iterable, Iterator, Sequence

    from bondgraph.runtime.diagnosis.tuning import Tuning
    from bondgraph.runtime.fleet.kept_results import KeptResults
    from bondgraph.runtime.fleet.watched_log import WatchedLog
    from bondgraph.runtime.fleet.watcher import LogFile
    from bondgraph.runtime.fleet.workers import Result
    from bondgraph.runtime.monitoring.watch_settings import WatchSettings

_ALONE = ("follow", "serial", "mqtt", "journal", "publish", "heartbeat", "metrics", "silence")
_SHORTEST = 9  # letters of a cell that is cut
_HEAD = ("log", "from", "to s", "lasts s", "verdict", "class", "since s", "worst")


def wrong(args: Namespace) -> str:
    """What is wrong with the words together, "" if nothing."""
    found = next((word for word in _ALONE if getattr(args, word)), None)
    if found is not None:
        return f"--{found} is for one machine, and the logs here are many: leave it out"
    if "-" in args.logs:
        return "standard input is one log, and the logs here are many: write it to a file"
    if not args.logs:
        return "no logs: name files, folders or patterns"
    if args.scheduler and args.jobs is not None:
        return "the workers of --scheduler are as many as they are: leave out --jobs"
    return _no_folder(args.states) if args.states else ""


def _no_folder(folder: str) -> str:
    """What is wrong with a folder for states, "" if nothing."""
    if folder.lower().endswith((".csv", ".parquet")):
        return f"--states of many logs is a folder, with a file for each: not {folder}"
    if os.path.exists(folder) and not os.path.isdir(folder):
        return f"--states of many logs is a folder, and {folder} is a file"
    return ""


def run(args: Namespace, tuning: Tuning | None, fault: int) -> int:
    """Watch all logs; the exit status, `fault` if it is asked for and there is one."""
    from bondgraph.runtime.fleet.kept_results import KeptResults
    from bondgraph.runtime.fleet.log_paths import log_files, with_states
    from bondgraph.runtime.fleet.watched_log import BAD
    from bondgraph.runtime.fleet.watcher import digest

    output = os.path.abspath(args.output) if args.output else None  # may be in a folder of logs
    folder = args.states or ""
    try:
        every = log_files(args.logs, note, folder)
    except ValueError as error:
        raise Trouble(str(error)) from error
    items = [with_states(item, folder) for item in every if item.path != output]
    if not items:
        raise Trouble(f"no log to watch in {listed(args.logs)}")
    settings = _settings(args, tuning)
    if folder:
        _make(folder)
    kept = KeptResults(args.output) if args.output else None
    try:
        found = _found(args, settings, items, digest(settings, __version__), kept)
    except KeyboardInterrupt:
        if kept is not None:
            print(f"what is done is kept in {kept.folder}: start again to go on", file=sys.stderr)
        raise
    if kept is not None:
        kept.finish(found)
    _say_notes(found)
    for log in found:
        if log.state == BAD:
            print(f"error: {log.log}: {log.error}", file=sys.stderr)
    if not args.lines:
        print("\n".join(lines(settings.compilation.graph.name, found, width())))
        if written := list(filter(None, (args.output, args.states))):
            print(f"\nWritten to {listed(written, 'and')}")
    if all(log.state == BAD for log in found):
        return 1
    return fault if args.fail_on_fault and any(log.alarms for log in found) else 0


def _make(folder: str) -> None:
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise Trouble(f"--states {folder} cannot be made: {error.strerror}") from error


def _settings(args: Namespace, tuning: Tuning | None) -> WatchSettings:
    """How each log is watched; what is wrong with that is told before any log is read."""
    from bondgraph.runtime.monitoring.columns import read_map
    from bondgraph.runtime.monitoring.engine import setting
    from bondgraph.runtime.monitoring.watch_settings import WatchSettings

    rate = args.rate or (tuning.rate if tuning else Options().rate)
    compilation = realising(args, rate=rate, bandwidth=args.bandwidth)
    signals = setting(*compilation.runnable_programs).signals
    mapping = read_map(args.map, signals) if args.map else None
    operating_of(args, mapping, "log")
    form, on = form_of(args, ""), args.operating
    fitted = fitted_bandwidth(args, compilation)
    return WatchSettings(compilation, tuning, form, mapping, on, args.accept, fitted)


def _found(
    args: Namespace,
    settings: WatchSettings,
    items: Sequence[LogFile],
    digest: str,
    kept: KeptResults | None,
) -> list[WatchedLog]:
    """What came of all logs, in their order; those that were done before are not watched again."""
    from bondgraph.runtime.fleet.watched_log import BAD
    from bondgraph.runtime.fleet.workers import client_of, watched

    keys = [item.key(digest) for item in items]
    known = kept.known if kept is not None else {}
    done = {
        k: known[key]
        for k, key in enumerate(keys)
        if key in known and (not items[k].states or os.path.exists(items[k].states))
    }
    if done:
        verb = "was" if len(done) == 1 else "were"
        note(f"{len(done)} of {plural(len(items), 'log')} {verb} watched before with the same model"
             " and options, and not again")  # fmt: skip
    left = [k for k in range(len(items)) if k not in done]
    found: list[WatchedLog] = []
    client = client_of(args.scheduler) if args.scheduler and left else nullcontext()
    with client as own, console.progress_bar(f"0 of {len(items)}") as progress:
        results = watched(settings, [items[k] for k in left], args.jobs or 1, own)
        every = _all(done, ((left[k], log) for k, log in results))
        named = ((k, log._replace(log=items[k].name, key=keys[k])) for k, log in every)
        for k, log in _in_order(_kept(named, kept, done)):
            found.append(log)
            progress((k + 1) / len(items), f"{k + 1} of {len(items)}")
            if args.lines:
                _print_lines(log, log.state == BAD)
    return found


def _all(done: dict[int, WatchedLog], results: Iterable[Result]) -> Iterator[Result]:
    yield from done.items()
    yield from results


def _kept(
    results: Iterable[Result], kept: KeptResults | None, done: dict[int, WatchedLog]
) -> Iterator[Result]:
    """The results, each once it is kept."""
    for k, log in results:
        if kept is not None and k not in done:
            kept.keep(log)
        yield k, log


def _in_order(results: Iterable[Result]) -> Iterator[Result]:
    """The results in the order of the logs, each as soon as those before it are there.

    >>> list(_in_order([(1, "b"), (0, "a"), (2, "c")]))
    [(0, 'a'), (1, 'b'), (2, 'c')]
    """
    waiting: dict[int, WatchedLog] = {}
    following = 0
    for k, log in results:
        waiting[k] = log
        while following in waiting:
            yield following, waiting.pop(following)
            following += 1


def _print_lines(log: WatchedLog, bad: bool) -> None:
    """The verdicts as lines of JSON, each with the name of the log."""
    from bondgraph.text.printable import json_text

    for record in log.to_record()["verdicts"]:
        print(json_text({"log": log.log, **record}))
    if bad:
        print(json_text({"log": log.log, "error": log.error}))
    sys.stdout.flush()


def _say_notes(logs: Iterable[WatchedLog]) -> None:
    """What watches note besides, each once with the logs for which it holds."""
    said: dict[str, list[str]] = {}
    for log in logs:
        for text in dict.fromkeys(log.told):
            said.setdefault(text, []).append(log.log)
    for text, names in said.items():
        note(f"{listed(names, 'and', 4)}: {text}")


# ---------------------------------------------------------------------------------- the table


def lines(model: str, logs: Sequence[WatchedLog], columns: int) -> list[str]:
    """The table of a fleet: a line for each log, its notes behind it or below where they fit."""
    from bondgraph.runtime.fleet.watched_log import BAD

    rows = [_row(log, name) for log, name in zip(logs, _short([x.log for x in logs]), strict=True)]
    table = console.columns(_fitting([_HEAD, *rows], columns))
    notes = ["", *["" if x.state == BAD else ", ".join(_notes(x)) for x in logs]]
    wide = max(len(line) for line in table) + 2
    beside = wide + max(len(text) for text in notes) <= columns
    out = [_message(model, logs), ""]
    for line, missing, log in zip(table, notes, [None, *logs], strict=True):
        if missing and beside:
            out.append(f"{line:<{wide}}{missing}")
            continue
        out.append(line)
        below = log.error if log is not None and log.error else missing
        out += prose(below, columns, "      ") if below else []
    return out


def _message(model: str, logs: Sequence[WatchedLog]) -> str:
    from bondgraph.runtime.fleet.watched_log import BAD, HEALTHY, UNWATCHED

    states = [log.state for log in logs]
    parts = [f"{sum(log.alarms > 0 for log in logs)} with an alarm"]
    parts += [f"{states.count(s)} {s}" for s in (HEALTHY, UNWATCHED, BAD) if s in states]
    return f"{model}: {plural(len(logs), 'log')}, {', '.join(parts)}"


def _row(log: WatchedLog, name: str) -> tuple[str, ...]:
    span = ("", "", "")
    if log.start is not None and log.end is not None:
        span = (_moment(log.start, 1), _moment(log.end, 1), f"{log.end - log.start:.1f}")
    alarm = log.last_alarm
    since = "" if alarm is None or alarm.since is None else _moment(alarm.since, 3)
    worst = "" if log.level is None else f"{log.residual} {log.level:.2g}x"
    return (name, *span, _verdict(log), _class(log), since, worst)


def _moment(seconds: float, digits: int) -> str:
    """A time of a table whose head has the unit; a date and time say themselves what they are."""
    words = moment(seconds)
    return f"{seconds:.{digits}f}" if words.endswith(" s") else words


def _verdict(log: WatchedLog) -> str:
    from bondgraph.runtime.fleet.watched_log import BAD

    return plural(log.alarms, "alarm") if log.alarms and log.state != BAD else log.state


def _notes(log: WatchedLog) -> tuple[str, ...]:
    from bondgraph.runtime.fleet.watched_log import CLEARED

    return (CLEARED, *log.notes) if log.state == CLEARED else log.notes


def _class(log: WatchedLog) -> str:
    alarm = log.last_alarm
    if alarm is None:
        return ""
    if alarm.group:
        return listed(alarm.group, "or")
    return " with ".join(alarm.pairs[0].faults) if alarm.pairs else "not clear"


def _short(names: Sequence[str]) -> list[str]:
    """Paths without the folders that all of them share.

    >>> _short(["runs/may/a.csv", "runs/june/a.csv"]), _short(["runs/a.csv"])
    (['may/a.csv', 'june/a.csv'], ['a.csv'])
    """
    folders = {os.path.dirname(os.path.abspath(name)) for name in names}
    shared = os.path.commonpath(folders)
    return [os.path.relpath(os.path.abspath(name), shared) for name in names]


def _fitting(rows: list[tuple[str, ...]], columns: int) -> list[tuple[str, ...]]:
    """Rows with names and classes cut as far as lines would be too long.

    Where that is not enough they do without the first and the last time.
    """
    sizes = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    over = sum(sizes) + 2 * len(sizes) - columns
    cut = [_HEAD.index("log"), _HEAD.index("class")] if len(rows[0]) == len(_HEAD) else [0, 3]
    if len(rows[0]) == len(_HEAD) and over > sum(max(0, sizes[k] - _SHORTEST) for k in cut):
        return _fitting([(row[0], *row[3:]) for row in rows], columns)
    for k in cut:
        room = max(min(sizes[k], _SHORTEST), sizes[k] - max(over, 0))
        over -= sizes[k] - room
        rows = [(*row[:k], _cut(row[k], room, k == 0), *row[k + 1 :]) for row in rows]
    return rows


def _cut(text: str, room: int, end: bool) -> str:
    """A text that fits; of a path its `end` says most."""
    if len(text) <= room:
        return text
    return f"…{text[1 - room :]}" if end else f"{text[: room - 1]}…"
