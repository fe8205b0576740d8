"""A log: samples of signals over time, with units; what all files of logs have in common."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from bondgraph.text.diagnostic import Trouble
from bondgraph.text.tuples import NamedTuple

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]

#: What files of this program say that they are, and in which edition.
MARK, EDITION = "bondgraph log", "1"

#: Where a reader says which columns hold no numbers, and in which unit time was written.
LEFT_OUT, TIME_UNIT = "left-out", "time-unit"

_TIME = re.compile(r"(?:t|time|timestamp)(?:[ _.]*[\[(]?(s|ms|us|µs|ns)[\])]?)?", re.IGNORECASE)
_PER_SECOND = {"": 1.0, "s": 1.0, "ms": 1e3, "us": 1e6, "µs": 1e6, "ns": 1e9}


class LogError(Trouble):
    """A log that cannot be read: file, line (None: the file as a whole), what is wrong, a remedy.

    >>> print(LogError("run.csv", 7, "4 cells where the header names 5", "mend or delete the line"))
    run.csv:7: 4 cells where the header names 5; mend or delete the line
    """

    def __init__(self, path: str, line: int | None, message: str, help: str = "") -> None:
        self.path, self.line, self.message, self.help = path, line, message, help
        place = path if line is None else f"{path}:{line}"
        super().__init__(f"{place}: {message}" + (f"; {help}" if help else ""))


class Log(NamedTuple):
    """Samples of signals, all of the same length.

    `time` in s; `columns` by name, NaN where there is no sample, encoders in whole counts, modes
    as 0 and 1; `units` by name, as in the model ("count" for encoders, "" or absent: unknown);
    `meta` is free text by key: model, scenario, seed.
    """

    time: Array
    columns: dict[str, Array]
    units: dict[str, str]
    meta: dict[str, str]

    @property
    def rows(self) -> int:
        """How many samples there are."""
        return len(self.time)

    def part(self, start: int, stop: int | None = None) -> Log:
        """The samples from `start` up to and without `stop`."""
        cut = slice(start, stop)
        return self._replace(
            time=self.time[cut], columns={k: v[cut] for k, v in self.columns.items()}
        )


def joined(logs: Iterable[Log]) -> Log:
    """Logs of the same columns, one after the other; raises ValueError where there is none."""
    parts = list(logs)
    if not parts:
        raise ValueError("no log to join")
    first = parts[0]
    return first._replace(
        time=np.concatenate([p.time for p in parts]),
        columns={k: np.concatenate([p.columns[k] for p in parts]) for k in first.columns},
    )


def name_of_time(columns: Iterable[str]) -> str:
    """What the column of time is called beside these columns."""
    taken, name = set(columns), "t"
    while name in taken:
        name += "_"
    return name


def time_column(names: list[str], wanted: str | None, path: str, line: int | None) -> str | None:
    """The name of the column of time among `names`, None where there is none.

    Raises LogError where the `wanted` one is not there.
    """
    if wanted is not None:
        if wanted not in names:
            there = ", ".join(names) or "no column"
            raise LogError(path, line, f"no column `{wanted}`", f"there is {there}")
        return wanted
    return next((name for name in names if _TIME.fullmatch(name.strip())), None)


def no_time(path: str, line: int | None, names: list[str]) -> LogError:
    """What to say of a file without a column of time."""
    there = ", ".join(names)
    return LogError(
        path,
        line,
        "no column of time (t, time or timestamp)",
        f"name the one that holds it, or give the rate of the samples; there is {there}",
    )


def unit_of_time(name: str, units: Mapping[str, str]) -> str:
    """The unit that the column of time is in: told apart, or behind its name; "" for s."""
    found = _TIME.fullmatch(name.strip())
    unit = units.get(name) or (found[1] if found and found[1] else "")
    return "" if unit == "s" else unit.replace("µ", "u").lower()


def seconds(values: Array, unit: str, path: str) -> Array:
    """Times of a `unit` in s; raises LogError for a unit that is none of time."""
    if unit not in _PER_SECOND:
        raise LogError(path, None, f"time in `{unit}`", "s, ms, us or ns are known")
    return values if _PER_SECOND[unit] == 1.0 else values / _PER_SECOND[unit]
