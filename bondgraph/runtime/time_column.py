"""The time in a log: which column has it, in which unit, as numbers or as ISO 8601, how fast."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from datetime import UTC, datetime

import numpy as np

from bondgraph.ir.unit import Unit
from bondgraph.library.units import parse_unit
from bondgraph.runtime.log import TIME_UNIT, Array, Log, LogError, labelled

ISO = "ISO 8601"

_NAME = re.compile(r"t|time|timestamp|ts|date|date[ _-]?time|epoch", re.IGNORECASE)
_GLUED = re.compile(r"t[mun]?s", re.IGNORECASE)
_BEHIND = re.compile(r"(.+?)[ _.,/]+(s|sec|seconds|ms|[uµμ]s|ns|min|h|hours|d)|(t)(ms|us|ns)", re.I)
_SAME = {"sec": "s", "seconds": "s", "hours": "h", "µs": "us", "μs": "us"}
_UNITS = ("s", "ms", "us", "ns", "min", "h", "d")
_EPOCH = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}
_FROM, _TO = 9.4e8, 4.2e9  # s since 1970: the years 2000 to 2100
_FEWEST, _MOST = 0.01, 10.0  # steps of the grid in one of the log: thinned, or far apart
_ASKED = 2.0  # at most, of a rate that somebody has asked for
_STEPS = 16  # after which the rate of a log is known


def stamp(cell: str) -> float | None:
    """Seconds since 1970 of a date and time in ISO 8601, UTC where it has no zone; else None.

    >>> stamp("2024-01-01T01:00:00.5+01:00"), stamp("2024-01-01 00:00:00,5"), stamp("noon")
    (1704067200.5, 1704067200.5, None)
    """
    try:
        found = datetime.fromisoformat(cell.strip().strip('"'))
        return (found if found.tzinfo else found.replace(tzinfo=UTC)).timestamp()
    except (ValueError, OverflowError):
        return None


def named_unit(name: str) -> tuple[str, str]:
    """What a column of time is called, and the unit in its name, "" where there is none.

    >>> named_unit("t_ms"), named_unit("Time (s)"), named_unit("stamp"), named_unit("Ts")
    (('t', 'ms'), ('Time', 's'), ('stamp', ''), ('Ts', ''))
    """
    plain, unit = labelled(name.strip())
    found = None if unit else _BEHIND.fullmatch(plain)
    if found:
        plain, unit = found[1] or found[3], (found[2] or found[4]).lower()
    return plain, _SAME.get(unit, unit)


def weak(name: str) -> bool:
    """Whether a name may as well be that of a temperature, or of anything called T or Ts."""
    return name.strip() == "T" or _GLUED.fullmatch(name.strip()) is not None


def candidates(names: Iterable[str], wanted: str | None = None) -> list[str]:
    """The columns that may be the time by their names, the likeliest first.

    A name with a unit that measures something else is none; nor is any other one than `wanted`.

    >>> candidates(["T", "T [degC]", "Ts", "U", "time (s)"])
    ['time (s)', 'T', 'Ts']
    """
    if wanted is not None:
        return [n for n in names if wanted in (n, labelled(n)[0])][:1]
    found = []
    for name in names:
        plain, unit = named_unit(name)
        if _NAME.fullmatch(plain) and (not unit or timely(unit)):
            found.append(name)
    return sorted(found, key=weak)


def timely(unit: str) -> Unit | None:
    """A unit of time, or None."""
    found, second = parse_unit(_SAME.get(unit, unit)), parse_unit("s")
    return found if found and second and found.dimension == second.dimension else None


def running(values: Array, strictly: bool = False) -> bool:
    """Whether numbers are a time: they grow, but for a few steps (a reset, samples that are late).

    >>> running(np.array([0.0, 1.0, 2.0, 0.0, 1.0, 2.0])), running(np.array([20.0, 21.0, 20.0]))
    (True, False)
    """
    there = values[np.isfinite(values)]
    up, down = int((there[1:] > there[:-1]).sum()), int((there[1:] < there[:-1]).sum())
    if len(there) < 2 or strictly:
        return up == max(0, len(there) - 1)
    return up > 0 and up >= 4 * down


def chosen(columns: Mapping[str, Array], path: str, timeless: bool) -> str | None:
    """The first of the candidates that runs.

    Raises LogError where none does, unless the log may be `timeless`.
    """
    for name, values in columns.items():
        if np.isfinite(values).any() and running(values, weak(name)):
            return name
    if timeless or not columns:
        return None
    name, values = next(iter(columns.items()))
    seen = [f"{x:.10g}" for x in values[np.isfinite(values)][:3]]
    what = f"it is {', '.join(seen)} ..." if seen else "it has no numbers"
    raise LogError(
        path, None, f"the column `{name}` is no time, it does not grow: {what}",
        "name the one that is (--time), or give the rate of the samples (--rate)",
    )  # fmt: skip


def unit_of(name: str, values: Array, told: str | None, written: str) -> tuple[str, str]:
    """The unit that the column of time is in, and how that is known.

    `told` by who reads the log (None: not), `written` elsewhere in it ("": not); "s" where nothing
    says more, unless the numbers are those of a clock that counts from 1970.
    """
    if told is not None:
        return _SAME.get(told, told), "as told"
    if written:
        return _SAME.get(written, written), "as the file says"
    if own := named_unit(name)[1]:
        return own, "as its name says"
    first = values[np.isfinite(values)][:1]
    for unit, scale in _EPOCH.items():
        if len(first) and _FROM <= first[0] / scale < _TO:
            return unit, "since 1970 as its numbers say"
    return "s", "as nothing says otherwise"


def seconds(values: Array, unit: str, path: str) -> Array:
    """Times of a `unit` in s; raises LogError for a unit that is none of time."""
    found = timely(unit)
    if found is None:
        raise LogError(path, None, f"time in `{unit}`", f"{', '.join(_UNITS)} are known")
    above, below = found.factor.numerator, found.factor.denominator
    values = values if above == 1 else values * above
    return values if below == 1 else values / below


class Pace:
    """Holds the steps of a log against the rate that it is read at, once enough of them came."""

    def __init__(self, sample_time: float, name: str, asked: bool = False) -> None:
        self._sample_time, self._name = sample_time, name
        self._most, self._said = (
            (_ASKED, "--rate asks for") if asked else (_MOST, "the residuals are made for")
        )
        self._times: list[float] | None = []
        self._unit = "s"

    def look(self, log: Log) -> None:
        """Look at further samples; raises LogError if their steps are no steps of this rate."""
        if self._times is None:
            return
        self._unit = log.meta.get(TIME_UNIT, "s")
        self._times += log.fastest()[: 64 * _STEPS].tolist()
        steps = np.diff([t for t in self._times if t == t])
        steps = steps[steps > 0.0]
        if len(steps) < _STEPS:
            return
        self._times = None
        step = float(np.median(steps))
        share = step / self._sample_time
        if not _FEWEST * (1 - 1e-9) <= share <= self._most:
            raise self._unlike(step)

    def _unlike(self, step: float) -> LogError:
        wanted = self._sample_time
        read = timely(self._unit)
        assert read is not None
        likely = [
            unit for unit in _UNITS
            if (own := timely(unit)) and own.factor != read.factor
            and 0.7 < step * float(own.factor / read.factor) / wanted < 1.4
        ]  # fmt: skip
        message = (
            f"the samples are {step:.6g} s apart, {1 / step:.6g} a second, and {self._said}"
            f" {1 / wanted:.6g} a second, {wanted:.6g} s apart"
        )
        help = [f"give the rate of the log (--rate {1 / step:.6g})"]
        if likely:
            unit = likely[0]
            at = 0 if self._most == _ASKED else 1  # nobody may have meant the rate
            other = f"the time is probably in {unit}, not in {self._unit} (--time-unit {unit})"
            help.insert(at, other)
        return LogError(self._name, None, message, "; or ".join(help))


def no_time(path: str, names: Sequence[str]) -> LogError:
    """What to say of a file without a column of time."""
    help = "name the one that holds it (--time), or give the rate of the samples (--rate)"
    message = "no column of time (t, time or timestamp)"
    return LogError(path, None, message, f"{help}; there is {', '.join(names)}")
