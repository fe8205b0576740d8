"""Columns of a log matched with the signals that the residuals read: by name or by a map file."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import Any

import numpy as np

from bondgraph.ir.program import Known
from bondgraph.library.units import parse_unit, scale, suggest_unit
from bondgraph.runtime.log import LEFT_OUT, TIME, Array, Log, LogError, labelled
from bondgraph.text.foreign_data import WrongData, toml_data
from bondgraph.text.limits import MAP_BYTES
from bondgraph.text.regular_file import check_regular
from bondgraph.text.tuples import NamedTuple

_KEYS = {"column", "scale", "offset", "unit"}
_LARGEST = 1e300  # that a scale or an offset may be
_CLOCK = "time"  # in a map file: where the time is


class Mapped(NamedTuple):
    """Where a signal is: `scale` times the column plus `offset`, or the column in a `unit`.

    Without scale and offset the unit of the log, or `unit` in its place, decides what to do.
    """

    column: str
    scale: float | None = None
    offset: float | None = None
    unit: str | None = None


class _Taken(NamedTuple):
    """What is done with one column; without a name there is nothing to read.

    It is multiplied with `scale`, then `offset` is added.
    """

    name: str | None
    scale: float
    offset: float
    whole: bool


class Columns:
    """Picks the samples of `signals` out of logs, in SI units.

    A column belongs to a signal if it has its path (`U0[1]`), else its name in C (`U0__1`), with a
    unit behind it or not, unless the `mapping` says otherwise. What samples of a signal are known
    to be too large by (`offset`) is taken off. `name` is that of the log, for messages.

    >>> import numpy as np
    >>> volts = Known("U0__1", "U0[1]", "V", "", "input", 0, False, None, None)
    >>> log = Log(np.arange(2.0), {"U0__1": np.array([1500.0, 1600.0])}, {"U0__1": "mV"}, {})
    >>> Columns([volts])(log).tolist()
    [[1.5], [1.6]]
    """

    def __init__(
        self,
        signals: Iterable[Known],
        mapping: Mapping[str, Mapped] | None = None,
        name: str = "log",
    ) -> None:
        self._signals = tuple(signals)
        self._mapping = dict(mapping or {})
        self._name = name
        self._found: tuple[tuple[str, ...], dict[str, str], list[_Taken]] | None = None

    def __call__(self, log: Log) -> Array:
        """The samples, (n, signals); NaN for signals that no step reads and the log does not have.

        Encoders come as whole counts, modes as 0 and 1. Raises LogError with the names of all
        signals that are missing, or for a unit that is not one of the signal. Once all were there
        in a log, those that are missing in a later one are NaN, if it has any.
        """
        names = tuple(log.columns)
        if self._found is None or self._found[:2] != (names, log.units):
            self._found = names, dict(log.units), self._match(log)
        samples = np.empty((log.rows, len(self._signals)))
        for k, taken in enumerate(self._found[2]):
            values: Any = np.nan if taken.name is None else log.columns[taken.name]
            if (taken.scale, taken.offset) != (1.0, 0.0):
                with np.errstate(over="ignore", invalid="ignore"):  # the clock leaves such out
                    values = values * taken.scale + taken.offset
            samples[:, k] = np.rint(values) if taken.whole else values
        return samples

    def used(self, log: Log) -> dict[str, str]:
        """The column of each signal, by path; without signals that are not there."""
        found = zip(self._signals, self._match(log), strict=True)
        return {known.path: taken.name for known, taken in found if taken.name is not None}

    def _match(self, log: Log) -> list[_Taken]:
        sources = [self._source(known, log) for known in self._signals]
        some = self._found is not None and any(
            s is not None for s, k in zip(sources, self._signals, strict=True) if k.sampled
        )
        missing = [
            known
            for known, source in zip(self._signals, sources, strict=True)
            if source is None and known.sampled and not some
        ]
        if missing:
            raise self._missing(missing, log)
        found = []
        for known, source in zip(self._signals, sources, strict=True):
            one = _Taken(None, 1.0, 0.0, False)
            if source is not None:
                one = self._taken(known, source, log)
            found.append(one._replace(offset=one.offset - known.offset))
        return found

    def _source(self, known: Known, log: Log) -> Mapped | None:
        mapped = self._mapping.get(known.path)
        if mapped is not None:
            column = called(mapped.column, log.columns)
            return None if column is None else mapped._replace(column=column)
        for name in (known.path, known.name, _identifier(known.path)):
            column = called(name, log.columns)
            if column is not None:
                return Mapped(column)
        return None

    def _missing(self, missing: list[Known], log: Log) -> LogError:
        names = list(log.columns)
        parts = []
        for known in missing:
            wanted = self._mapping.get(known.path)
            told = [known.unit] if known.unit and known.counts is None else []
            told += ["counts"] if known.counts is not None else []
            told += [f"`{wanted.column}` in the map file"] if wanted else []
            close = _close(wanted.column if wanted else known.path, names)
            told += [f"perhaps {' or '.join(f'`{c}`' for c in close)}"] if close else []
            parts.append(f"{known.path} ({', '.join(told)})" if told else known.path)
        message = f"no column for {', '.join(parts)}"
        help = "name the columns so, or say in a map file which they are"
        help += f"; there is {', '.join(names) or 'no column'}"
        if LEFT_OUT in log.meta:
            help += f"; columns without numbers: {log.meta[LEFT_OUT]}"
        if TIME in log.meta:
            help += f"; the time is {log.meta[TIME]}"
        return LogError(self._name, None, message, help)

    def _taken(self, known: Known, source: Mapped, log: Log) -> _Taken:
        if known.kind == "mode":
            return _Taken(source.column, 1.0, 0.0, False)
        whole = known.counts is not None
        if source.scale is not None or source.offset is not None:
            factor = 1.0 if source.scale is None else source.scale
            return _Taken(source.column, factor, source.offset or 0.0, whole)
        unit = log.units.get(source.column, "") if source.unit is None else source.unit
        return _Taken(source.column, *self._scale(known, source.column, unit), whole)

    def _scale(self, known: Known, column: str, unit: str) -> tuple[float, float]:
        """Factor and offset from a number in `unit` to one of the signal."""
        own = "count" if known.counts is not None else known.unit
        if unit in ("", own) or not own:
            return 1.0, 0.0
        example = f'"{known.path}" = {{ column = "{column}", ...'
        own_scale = f"give scale and offset in a map file: {example}"
        if known.counts is not None:
            if unit in ("counts", "1"):
                return 1.0, 0.0
            message = f"{known.path} is read in counts, its column {column} is in {unit}"
            raise LogError(self._name, None, message, own_scale)
        ours, theirs = parse_unit(own), parse_unit(unit)
        if ours is None or theirs is None:
            message = f"the column {column} of {known.path} is in `{unit}`, an unknown unit"
            meant = suggest_unit(unit)
            help = f"perhaps {meant}; or {own_scale}" if meant else own_scale
            raise LogError(self._name, None, message, help)
        if ours.dimension != theirs.dimension:
            message = f"{known.path} is in {own}, its column {column} is in {unit}"
            raise LogError(self._name, None, message, "see that it is the right column")
        factor, offset = scale(theirs, ours)
        return float(factor), float(offset)


def called(name: str, columns: Iterable[str]) -> str | None:
    """The column of this name, with a unit in brackets behind it or without."""
    names = list(columns)
    return name if name in names else next((n for n in names if labelled(n)[0] == name), None)


def read_map(path: str | os.PathLike[str], signals: Iterable[Known]) -> dict[str, Mapped]:
    """Which column each signal is in, by path, from a map file (TOML).

    Lines like `"U0[1]" = "volt_left"`, `"Us" = { column = "supply", unit = "mV" }` or
    `"m[1].me.we" = { column = "rpm", scale = 0.10472, offset = 0.0 }`; signals by path or by their
    name in C; `time` is for `read_time`. Raises LogError for a file that is wrong or names a
    signal that is not there.
    """
    name = os.fspath(path)
    known = {k.path: k for k in signals}
    paths = {alias: k.path for k in known.values() for alias in (_identifier(k.path), k.name)}
    paths |= {path: path for path in known}
    found: dict[str, Mapped] = {}
    for key, value in _entries(name):
        if key not in paths and key == _CLOCK:
            continue
        if key not in paths:
            close = _close(key, list(known))
            help = f"perhaps {' or '.join(close)}" if close else f"there is {', '.join(known)}"
            raise LogError(name, None, f"the residuals read no signal `{key}`", help)
        found[paths[key]] = _mapped(name, key, value)
    return found


def read_time(path: str | os.PathLike[str]) -> Mapped | None:
    """The column of time, and its unit, that a map file says as if it were a signal `time`."""
    name = os.fspath(path)
    value = dict(_entries(name)).get(_CLOCK)
    found = None if value is None else _mapped(name, _CLOCK, value)
    if found is not None and (found.scale is not None or found.offset is not None):
        message = "the time has a scale or an offset"
        raise LogError(name, None, message, 'write time = { column = "stamp", unit = "ms" }')
    return found


def read_columns(path: str | os.PathLike[str]) -> frozenset[str]:
    """The columns that a map file names."""
    name = os.fspath(path)
    return frozenset(_mapped(name, key, value).column for key, value in _entries(name))


def _entries(name: str) -> Iterable[tuple[str, Any]]:
    """The entries of a map file; raises LogError for a file that is no TOML."""
    try:
        check_regular(name, MAP_BYTES)
        with open(name, encoding="utf-8") as file:
            data = toml_data(file.read())
    except OSError as error:
        raise LogError(name, None, f"cannot be read: {error.strerror or error}") from error
    except (WrongData, UnicodeDecodeError) as error:
        line = error.line if isinstance(error, WrongData) else None
        help = 'a line is like "U0[1]" = "volt_left"'
        raise LogError(name, line, f"not TOML: {error}", help) from error
    return _flat(data)


def _flat(data: Mapping[str, Any], before: str = "") -> Iterable[tuple[str, Any]]:
    """The entries, those of dotted keys (`coil.i = ...`) under one name."""
    for key, value in data.items():
        leaf = not isinstance(value, dict) or isinstance(value.get("column"), str)
        if leaf or not value:
            yield before + key, value
        else:
            yield from _flat(value, f"{before}{key}.")


def _mapped(path: str, key: str, value: object) -> Mapped:
    example = f'write "{key}" = {{ column = "name", scale = 1.0, offset = 0.0 }}'
    if isinstance(value, str):
        return Mapped(value)
    if not isinstance(value, dict):
        raise LogError(path, None, f"{key} is no name of a column", example)
    odd = next((k for k in value if k not in _KEYS), None)
    if odd is not None:
        raise LogError(path, None, f"{key} has an unknown `{odd}`", example)
    numbers = [value.get("scale"), value.get("offset")]
    for number in numbers:
        good = number is None or (isinstance(number, int | float) and abs(number) <= _LARGEST)
        if not good or isinstance(number, bool):
            message = f"scale and offset of {key} must be numbers, up to {_LARGEST:g}"
            raise LogError(path, None, message, example)
    unit = value.get("unit")
    if unit is not None and not isinstance(unit, str):
        raise LogError(path, None, f"the unit of {key} must be a text", example)
    if unit is not None and ("scale" in value or "offset" in value):
        message = f"{key} has a unit and a scale or an offset"
        raise LogError(path, None, message, "give one of them: scale and offset lead to SI units")
    if not isinstance(value.get("column"), str):
        raise LogError(path, None, f"{key} has no column", example)
    factor, offset = (None if n is None else float(n) for n in numbers)
    return Mapped(value["column"], factor, offset, unit)


def _identifier(path: str) -> str:
    """A path as C has it."""
    return re.sub(r"\[(\d+)\]", r"__\1", path).replace(".", "__")


def _close(name: str, names: list[str]) -> list[str]:
    """Names that may be meant."""
    plain = {n: re.sub(r"[\W_]+", " ", n).strip().lower() for n in names}
    wanted = re.sub(r"[\W_]+", " ", name).strip().lower()
    close = get_close_matches(wanted, list(plain.values()), 2, 0.6)
    return [n for n in names if plain[n] in close][:2]
