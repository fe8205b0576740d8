"""The logs that files, folders and patterns name."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from glob import glob, has_magic
from pathlib import Path
from typing import TypeVar

from bondgraph.runtime.fleet.watcher import LogFile, LogTable
from bondgraph.text.numerals import plural

_Log = TypeVar("_Log", LogFile, LogTable)

_SUFFIXES = (".csv", ".tsv", ".parquet", ".mcap", ".jsonl", ".ndjson")


def many(names: Iterable[str]) -> bool:
    """Whether names stand for more than one file that is read as it is."""
    listed = list(names)
    return len(listed) > 1 or any(os.path.isdir(n) or _pattern(n) for n in listed)


def log_files(
    names: Iterable[str], tell: Callable[[str], object], states: str = ""
) -> list[LogFile]:
    """The logs in order, each once; what a folder has besides is told.

    What is in the folder of `states` is none; raises ValueError where that is one of logs, or above
    it.

    A folder stands for the logs in it and in the folders below, in order of their paths: `.csv`,
    `.tsv`, `.parquet`, `.mcap`, `.jsonl` and `.ndjson`. Names that begin with a dot or an
    underscore are left out, as data sets of Parquet have them. A name that is not there is one log,
    which is bad.
    """
    found: dict[str, LogFile] = {}
    for name in names:
        if states and _is_inside(name, states):
            raise ValueError(f"{states} is where logs are ({name}): name another folder for states")
        paths = (sorted(glob(name, recursive=True)) or [name]) if _pattern(name) else [name]
        for path in paths:
            inside = _inside(path, tell) if os.path.isdir(path) else [path]
            for one in inside:
                found.setdefault(os.path.realpath(one), LogFile(one, os.path.abspath(one)))
    return [f for f in found.values() if not (states and _is_inside(f.path, states))]


def with_states(log: _Log, folder: str) -> _Log:
    """A log whose states are written below a folder, if any, under the name by which it was called.

    A name that is no table has `.csv` behind it; a path that leads out of the working folder is
    there in full. So two files never share one, whichever are watched together.

    >>> with_states(LogFile("runs/may.csv", "/a/runs/may.csv"), "/out").states
    '/out/runs/may.csv'
    >>> with_states(LogFile("../may.jsonl", "/b/may.jsonl"), "/out").states
    '/out/b/may.jsonl.csv'
    """
    if not folder:
        return log
    name = os.path.normpath(log.name)
    if os.path.isabs(name) or name.startswith(os.pardir):
        name = os.path.splitdrive(os.path.abspath(log.path))[1].lstrip(os.sep)
    kept = name if name.lower().endswith((".csv", ".parquet")) else f"{name}.csv"
    return log._replace(states=os.path.join(os.path.abspath(folder), kept))


def _is_inside(path: str, folder: str) -> bool:
    """Whether a path, or the folder of a pattern before its first wildcard, is in a folder."""
    while _pattern(path):
        path = os.path.dirname(path) or os.curdir
    return Path(os.path.realpath(path)).is_relative_to(os.path.realpath(folder))


def _pattern(name: str) -> bool:
    return has_magic(name) and not os.path.exists(name)


def _inside(folder: str, tell: Callable[[str], object]) -> list[str]:
    """The logs in a folder."""
    every = sorted(_files(folder, tell))
    found = [path for path in every if path.lower().endswith(_SUFFIXES)]
    other = len(every) - len(found)
    if other:
        verb = "is" if other == 1 else "are"
        tell(f"{folder}: {plural(other, 'file')} {verb} left out, no log by the name")
    if not found:
        tell(f"{folder}: no log in it ({', '.join(_SUFFIXES)})")
    return found


def _files(folder: str, tell: Callable[[str], object]) -> Iterator[str]:
    def unread(error: OSError) -> None:
        tell(f"{error.filename}: left out, it cannot be read: {error.strerror}")

    for path, folders, names in os.walk(folder, onerror=unread):
        folders[:] = [f for f in folders if not f.startswith((".", "_"))]
        yield from (os.path.join(path, n) for n in names if not n.startswith((".", "_")))
