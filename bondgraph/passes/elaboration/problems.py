"""How elaboration reports: one error a cause, with the name that was probably meant."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NoReturn

from bondgraph.text.diagnostic import Label, Report
from bondgraph.text.source import Span


class Skip(Exception):
    """What is being elaborated is wrong and has been reported: leave it out and go on."""


class Abort(Exception):
    """Nothing more can be said about this model; the reason has been reported."""


def fail(report: Report, code: str, message: str, *places: Label | Span, help: str) -> NoReturn:
    """Report an error and give up what is being elaborated."""
    report.error(code, message, *places, help=help)
    raise Skip


def closest(name: str, known: Iterable[str]) -> str | None:
    """The known name that `name` was probably meant to be."""
    from difflib import get_close_matches  # only for a message

    names = sorted(set(known))
    for other in names:
        if other.lower() == name.lower() and other != name:
            return other
    found = get_close_matches(name, names, 1, 0.6)
    return found[0] if found else None


def meant(name: str, known: Iterable[str], otherwise: str) -> str:
    """A remedy: the closest known name, or `otherwise`."""
    other = closest(name, known)
    return f"Did you mean `{other}`?" if other else otherwise


def listed(names: Iterable[str], most: int = 8) -> str:
    """Names as a person lists them: `a`, `b` and `c`."""
    quoted = [f"`{n}`" for n in names]
    if len(quoted) > most:
        quoted = [*quoted[: most - 1], f"{len(quoted) - most + 1} more"]
    if len(quoted) < 2:
        return "".join(quoted)
    return ", ".join(quoted[:-1]) + f" and {quoted[-1]}"
