"""TOML and JSON texts from outside as plain data: not too deep, no number too long."""

from __future__ import annotations

import json
import re
import tomllib
from typing import Any

from bondgraph.text.limits import DIGITS, NESTED

_DIGITS = re.compile(rf"[0-9_]{{{DIGITS + 1}}}")


class WrongData(ValueError):
    """A text that is none such; `line` and `column` say where, from 1, if that is known."""

    def __init__(self, message: str, line: int | None = None, column: int = 1) -> None:
        super().__init__(message)
        self.line, self.column = line, column


def toml_data(text: str) -> dict[str, Any]:
    """The tables of a TOML text; raises WrongData."""
    _look(text)
    try:
        found = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        place = re.search(r" \(at line (\d+), column (\d+)\)$", str(error))
        message = re.sub(r" \(at .*\)$", "", str(error))
        if isinstance(error, RecursionError):
            message = _deep()
        where = (int(place[1]), int(place[2])) if place else ()
        raise WrongData(message, *where) from error
    _measure(found)
    return found


def json_data(text: str | bytes) -> Any:
    """The value of a JSON text; raises WrongData."""
    try:
        found = json.loads(text)
    except json.JSONDecodeError as error:
        raise WrongData(error.msg, error.lineno, error.colno) from error
    except (ValueError, RecursionError) as error:
        deep = isinstance(error, RecursionError)
        raise WrongData(_deep() if deep else f"a number has over {DIGITS} digits") from error
    _measure(found)
    return found


def _deep() -> str:
    return f"more than {NESTED} tables or arrays stand inside each other"


def _look(text: str) -> None:
    """Raise WrongData for a number that is too long, with its place."""
    found = _DIGITS.search(text)
    if found is not None:
        line = text.count("\n", 0, found.start()) + 1
        column = found.start() - text.rfind("\n", 0, found.start())
        raise WrongData(f"a number has over {DIGITS} digits", line, column)


def _measure(found: Any) -> None:
    """Raise WrongData for what is nested too deeply."""
    level = [found] if isinstance(found, dict | list) else []
    for _ in range(NESTED):
        inside = (item.values() if isinstance(item, dict) else item for item in level)
        level = [x for items in inside for x in items if isinstance(x, dict | list)]
    if level:
        raise WrongData(_deep())
