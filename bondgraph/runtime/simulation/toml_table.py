"""One table of a scenario file: values with their places, wrong and unknown keys told.

Python's reader of TOML tells values but no places: `places` finds these in the same text.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from difflib import get_close_matches
from itertools import pairwise
from typing import Any

from bondgraph.ir.expr import Expr
from bondgraph.ir.unit import Dimension
from bondgraph.passes.elaboration.outside import Outside
from bondgraph.runtime.log import LogError
from bondgraph.runtime.log_file import read_log
from bondgraph.runtime.simulation.parameters import Values
from bondgraph.runtime.simulation.scenario import Course
from bondgraph.text.diagnostic import Label
from bondgraph.text.source import Source, Span

SECOND: Dimension = (0, 0, 1, 0, 0, 0, 0)
HERTZ: Dimension = (0, 0, -1, 0, 0, 0, 0)
PURE: Dimension = (0, 0, 0, 0, 0, 0, 0)

Path = tuple[str | int, ...]
Place = tuple[int, int]
_BLANK = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_KEY = re.compile(r"""\s*(?:([\w-]+)|"((?:\\.|[^"\\])*)"|'([^']*)')[ \t]*""")
_TEXT = re.compile(
    r'''"""(?:\\.|[^\\])*?"""+|\'\'\'.*?\'\'\'+|"(?:\\.|[^"\\])*"|'[^']*\'''', re.DOTALL
)
_BARE = re.compile(r"[^,\]}\n#]*")


def _named(path: Path) -> str:
    """What a person calls a value: its key, not its place in a list."""
    return next((key for key in reversed(path) if isinstance(key, str)), "")


class Document:
    """What all tables of one file share."""

    def __init__(
        self, source: Source, where: Mapping[Path, tuple[int, int]], terms: Outside, values: Values
    ) -> None:
        self.source = source
        self.where = where
        self.terms = terms
        self.report = terms.report
        self.values = values

    def span(self, path: Path) -> Span:
        """The place of a value, else that of what it is in."""
        while path and path not in self.where:
            path = path[:-1]
        return Span(self.source, *self.where.get(path, (0, 0)))

    def wrong(self, path: Path, message: str, help: str) -> None:
        """Report a value that makes no sense."""
        self.report.error("scenario-value", message, Label(self.span(path)), help=help)

    def no_key(self, path: Path, message: str, help: str) -> None:
        """Report a key that means nothing, or one that is missing."""
        self.report.error("scenario-key", message, Label(self.span(path)), help=help)

    def no_name(self, path: Path, message: str, help: str) -> None:
        """Report something that the model has not."""
        self.report.error("scenario-name", message, Label(self.span(path)), help=help)


class Table:
    """Reads one table; `finish` tells of the keys that nothing asked for."""

    def __init__(self, document: Document, path: Path, content: Mapping[str, Any]) -> None:
        self.document = document
        self.path = path
        self.content = content
        self._asked: dict[str, None] = {}

    def __contains__(self, key: str) -> bool:
        return key in self.content

    def _take(self, key: str) -> Any:
        self._asked[key] = None
        return self.content.get(key)

    def wrong(self, key: str, message: str, help: str) -> None:
        """Report the value of a key."""
        self.document.wrong((*self.path, key), message, help)

    def _taken(self, key: str, fits: Callable[[Any], bool], message: str, help: str) -> Any:
        """The value of a key; None where there is none, and where it is told to be none."""
        value = self._take(key)
        if value is None or fits(value):
            return value
        self.wrong(key, f"`{key}` {message}", help)
        return None

    def text(self, key: str, default: str = "", choices: Iterable[str] = ()) -> str:
        """A text; one of the `choices` where there are some."""
        value = self._taken(
            key, lambda v: isinstance(v, str), "is a text.", f'Write it in quotes: {key} = "...".'
        )
        if value is None:
            return default
        known = list(choices)
        if known and value not in known:
            self.wrong(key, f"`{key}` cannot be `{value}`.", f"It is one of {', '.join(known)}.")
            return default
        return str(value)

    def flag(self, key: str) -> bool:
        """True or false."""
        help = f"Write {key} = true."
        return bool(self._taken(key, lambda v: isinstance(v, bool), "is true or false.", help))

    def whole(self, key: str, default: int) -> int:
        """A whole number that is not negative."""
        value = self._taken(
            key,
            lambda v: isinstance(v, int) and not isinstance(v, bool) and v >= 0,
            "is a whole number.",
            f"Write for instance {key} = 1.",
        )
        return default if value is None else int(value)

    def names(self, key: str) -> tuple[str, ...]:
        """A list of texts."""
        return tuple(
            self._taken(
                key,
                lambda v: isinstance(v, list) and all(isinstance(n, str) for n in v),
                "is a list of names.",
                f'Write {key} = ["a", "b"].',
            )
            or ()
        )

    def number(
        self,
        key: str,
        dimension: Dimension | None,
        default: float,
        low: float | None = None,
        high: float | None = None,
        above: bool = False,
    ) -> float:
        """A quantity: a plain number in SI, or a text with a unit; `low` and `high` bound it.

        With `above` it must be larger than `low`.
        """
        value = self._take(key)
        if value is None:
            return default
        number = self._quantity((*self.path, key), value, dimension)
        if number is None:
            return default
        if (low is not None and (number < low or (above and number == low))) or (
            high is not None and number > high
        ):
            least = "" if low is None else f"{'above' if above else 'at least'} {low:g}"
            most = "" if high is None else f"at most {high:g}"
            limits = " and ".join(filter(None, (least, most)))
            self.wrong(key, f"`{key}` is {number:g}.", f"It has to be {limits}.")
            return default
        return number

    def limits(self, key: str, dimension: Dimension | None) -> tuple[float, float]:
        """A list of a lower and an upper quantity; no limits where there is none."""
        none = (-float("inf"), float("inf"))
        value = self._taken(
            key,
            lambda v: isinstance(v, list) and len(v) == 2,
            "is a lower and an upper limit.",
            f"Write {key} = [-5, 5].",
        )
        if value is None:
            return none
        ends = [self._quantity((*self.path, key, k), v, dimension) for k, v in enumerate(value)]
        if ends[0] is None or ends[1] is None:
            return none
        if ends[0] >= ends[1]:
            self.wrong(key, f"`{key}` ends before it begins.", "Give the lower limit first.")
            return none
        return ends[0], ends[1]

    def _quantity(self, path: Path, value: Any, dimension: Dimension | None) -> float | None:
        document = self.document
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            if abs(value) <= sys.float_info.max:
                return float(value)
            document.wrong(path, f"`{_named(path)}` is no finite number.",
                           "Leave it out if there is to be no limit.")  # fmt: skip
            return None
        if not isinstance(value, str):
            document.wrong(path, f"`{_named(path)}` is a quantity.",
                           'Write a number in SI units, or "5 mV".')  # fmt: skip
            return None
        expr = self.term(path, value, dimension, timely=False)
        if expr is None:
            return None
        number = document.values.constant(expr)
        if number is None:
            document.wrong(path, f"`{value}` has no number.",
                           "A parameter in it has no value: give it under"
                           " [parameters].")  # fmt: skip
        return number

    def term(
        self,
        path: Path,
        text: str,
        dimension: Dimension | None,
        timely: bool,
        truth: bool = False,
    ) -> Expr | None:
        """An expression, at its place in the file."""
        document = self.document
        span = document.span(path)
        if span.text != text:  # written over several lines, or with escapes: no place inside
            span = Span(Source(document.source.path, text), 0, len(text))
        return document.terms.read(span, dimension, f"`{_named(path)}`", timely, truth)

    def course(self, key: str, dimension: Dimension | None, truth: bool = False) -> Course | None:
        """A signal over time: number, expression of t, table of points, or column of a file.

        A `truth` may be a condition of t, or true or false.
        """
        value = self._take(key)
        path = (*self.path, key)
        if value is None:
            return None
        if truth and isinstance(value, bool):
            return Course.constant(float(value))
        if isinstance(value, str):
            expr = self.term(path, value, dimension, timely=True, truth=truth)
            return None if expr is None else Course(expr)
        if isinstance(value, Mapping):
            return Table(self.document, path, value).points(dimension)
        number = self._quantity(path, value, dimension)
        return None if number is None else Course.constant(number)

    def points(self, dimension: Dimension | None) -> Course | None:
        """A course from `table = [[t, value], ...]` or from `file`, `column`."""
        hold = self.text("hold", "line", ("line", "previous")) == "previous"
        table, file = self._take("table"), self.text("file")
        found: tuple[tuple[float, float], ...] | None = None
        if isinstance(table, list):
            found = self._pairs(table, dimension)
        elif file:
            found = self._column(file, self.text("column"))
        else:
            self.document.wrong(self.path, f"`{self.path[-1]}` says neither `table` nor `file`.",
                                'Write { table = [[0, 0], [1, 5]] } or { file = "run.csv", column ='
                                ' "U" }.')  # fmt: skip
        self.finish()
        return None if found is None else Course(None, found, hold)

    def _pairs(
        self, table: list[Any], dimension: Dimension | None
    ) -> tuple[tuple[float, float], ...] | None:
        pairs = []
        for k, row in enumerate(table):
            if not isinstance(row, list) or len(row) != 2:
                self.wrong("table", "A table has two columns, time and value.",
                           "Write table = [[0, 0], [1, 5]].")  # fmt: skip
                return None
            t = self._quantity((*self.path, "table", k, 0), row[0], SECOND)
            v = self._quantity((*self.path, "table", k, 1), row[1], dimension)
            if t is None or v is None:
                return None
            pairs.append((t, v))
        if not pairs or any(b[0] <= a[0] for a, b in pairwise(pairs)):
            self.wrong("table", "The times of a table ascend.", "Sort the rows by time.")
            return None
        return tuple(pairs)

    def _column(self, file: str, column: str) -> tuple[tuple[float, float], ...] | None:
        beside = os.path.join(os.path.dirname(self.document.source.path), file)
        try:
            log = read_log(beside)
        except (LogError, OSError) as error:
            self.wrong("file", f"The file `{file}` cannot be read: {error}.",
                       "Its place is relative to that of the scenario.")  # fmt: skip
            return None
        if column not in log.columns:
            close = get_close_matches(column, log.columns, 3, 0.3)
            self.wrong("column", f"`{file}` has no column `{column}`.",
                       f"It has {', '.join(close or list(log.columns)[:6])}.")  # fmt: skip
            return None
        pairs = zip(log.time.tolist(), log.columns[column].tolist(), strict=True)
        kept = [(t, v) for t, v in pairs if v == v]
        return tuple(kept) or None

    def table(self, key: str) -> Table:
        """A table inside; an empty one where there is none."""
        help = f"Write [{key}] on a line of its own."
        value = self._taken(key, lambda v: isinstance(v, Mapping), "is a table.", help)
        return Table(self.document, (*self.path, key), value or {})

    def tables(self, key: str, most: int) -> Iterator[Table]:
        """The tables of an array of so many tables at most."""
        value = self._taken(
            key,
            lambda v: isinstance(v, list) and all(isinstance(t, Mapping) for t in v),
            "is a table, once for each.",
            f"Write [[{key}]] above it.",
        )
        if value is not None and len(value) > most:
            self.wrong(key, f"There are {len(value)} of `[[{key}]]`.", f"{most} are the most.")
            return
        for k, item in enumerate(value or ()):
            yield Table(self.document, (*self.path, key, k), item)

    @property
    def keys(self) -> tuple[str, ...]:
        """All keys; where they are names of the model, each is asked for."""
        return tuple(self.content)

    def finish(self) -> None:
        """Tell of the keys that mean nothing."""
        for key in self.content:
            if key not in self._asked:
                close = get_close_matches(key, self._asked, 1, 0.5)
                known = ", ".join(f"`{k}`" for k in sorted(self._asked))
                help = f"Did you mean `{close[0]}`?" if close else f"There is {known}."
                self.document.no_key((*self.path, key), f"`{key}` means nothing here.", help)


def places(text: str) -> dict[Path, Place]:
    """Start and end of each value and of each table's name, by the keys that lead to it.

    Texts are given without their quotes; entries of lists are counted from 0. The text has to be
    right as TOML.

    >>> where = places('[inputs]\\nU = "5 V"\\n')
    >>> where["inputs", "U"]
    (14, 17)
    """
    return _Scanner(text).scan()


class _Scanner:
    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.found: dict[Path, Place] = {}
        self.counts: dict[Path, int] = {}

    def scan(self) -> dict[Path, Place]:
        table: Path = ()
        self.blank()
        while self.at < len(self.text):
            before = self.at
            if self.text[self.at] == "[":
                table = self.heading()
            else:
                self.pair(table)
            self.blank()
            if self.at == before:  # nothing of TOML
                break
        return self.found

    def heading(self) -> Path:
        """The path of `[a.b]` or `[[a.b]]`."""
        brackets = 2 if self.text.startswith("[[", self.at) else 1
        self.at += brackets
        start = self.at
        names = self.keys()
        place = (start, self.at)
        self.at += brackets
        path: Path = ()
        for k, name in enumerate(names):
            path = (*path, name)
            if brackets == 2 and k == len(names) - 1:
                self.counts[path] = self.counts.get(path, -1) + 1
            if path in self.counts:
                path = (*path, self.counts[path])
        self.found.setdefault(path, place)
        return path

    def pair(self, table: Path) -> None:
        """`key = value`."""
        path = (*table, *self.keys())
        self.at += 1  # the equals sign
        self.value(path)

    def keys(self) -> list[str]:
        """The names of a dotted key."""
        names: list[str] = []
        while True:
            match = _KEY.match(self.text, self.at)
            if match is None:
                return names
            names.append(next(g for g in match.groups() if g is not None))
            self.at = match.end()
            if not self.text.startswith(".", self.at):
                return names
            self.at += 1

    def value(self, path: Path) -> None:
        """The place of a value, and those of all that is in it."""
        self.blank()
        start = self.at
        opening = self.text[start : start + 1]
        if opening in ("[", "{") and opening:
            self.at += 1
            count = 0
            self.blank()
            while self.at < len(self.text) and self.text[self.at] not in "]}":
                before = self.at
                if opening == "[":
                    self.value((*path, count))
                    count += 1
                else:
                    self.pair(path)
                self.blank()
                if self.text.startswith(",", self.at):
                    self.at += 1
                    self.blank()
                if self.at == before:
                    break
            self.at += 1
            self.found[path] = (start, self.at)
            return
        match = _TEXT.match(self.text, start)
        if match is not None:
            quotes = 3 if match[0][:3] in ('"""', "'''") and len(match[0]) > 5 else 1
            self.at = match.end()
            self.found[path] = (start + quotes, self.at - quotes)
            return
        match = _BARE.match(self.text, start)
        self.at = match.end() if match else start
        self.found[path] = (start, start + len(self.text[start : self.at].rstrip()))

    def blank(self) -> None:
        """Over blanks, ends of lines and comments."""
        match = _BLANK.match(self.text, self.at)
        self.at = match.end() if match else self.at
