"""A log: samples of signals over time, with units; what all files of logs have in common."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from bondgraph.library.units import parse_unit
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.tuples import NamedTuple

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]

#: What files of this program say that they are, and in which edition.
MARK, EDITION = "bondgraph log", "1"

#: Where a reader says which columns hold no numbers, which one is the time and in which unit.
LEFT_OUT, TIME, TIME_UNIT = "left-out", "time", "time-unit"

_LABELLED = re.compile(r"(.*\S)(\s*)([\[(])\s*([^\[\]()]+?)\s*[\])]")
_SPELT = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻·*", "0123456789-..")
_LONG = 500  # letters: no name with a unit is so long
_PURE = {"-": "1", "count": "count", "counts": "count"}


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

    def fastest(self) -> Array:
        """The times at which the signal that is sampled most has samples.

        Signals that come at moments of their own make rows between those of others.

        >>> half = np.array([1.0, np.nan, 1.0, np.nan])
        >>> Log(np.arange(4.0), {"half": half, "other": half[::-1]}, {}, {}).fastest()
        array([0., 2.])
        """
        there = [~np.isnan(column) for column in self.columns.values()]
        most = max(there, key=np.count_nonzero, default=None)
        return self.time if most is None or most.all() else self.time[most]

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


def labelled(name: str) -> tuple[str, str]:
    """The name in the header of a column, and the unit in brackets behind it, "" if there is none.

    An index is no unit: a column of a signal may be called `U[1]`.

    >>> labelled("T1 [°C]"), labelled("p(bar)"), labelled("U[1]"), labelled("flow [m³/h]")
    (('T1', '°C'), ('p', 'bar'), ('U[1]', ''), ('flow', 'm^3/h'))
    """
    found = _LABELLED.fullmatch(name.strip()) if len(name) < _LONG else None
    if found is None or found[4].isdigit():
        return name, ""
    unit = re.sub(r"(?<=[^\W\d_])(-?\d)", r"^\1", found[4].translate(_SPELT))
    unit = _PURE.get(found[4].lower()) or unit
    return (found[1], unit) if unit == "count" or parse_unit(unit) else (name, "")
