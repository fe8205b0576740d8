"""How elaboration reports: one error a cause, with the name that was probably meant."""

from __future__ import annotations

from collections.abc import Iterable
from decimal import Decimal
from fractions import Fraction
from typing import NoReturn

from bondgraph.text import numerals
from bondgraph.text.diagnostic import Label, Remedy, Report, replacing
from bondgraph.text.source import Span


class Skip(Exception):
    """What is being elaborated is wrong and has been reported: leave it out and go on."""


class Abort(Exception):
    """Nothing more can be said about this model; the reason has been reported."""


def fail(
    report: Report, code: str, message: str, *places: Label | Span, help: str | Remedy
) -> NoReturn:
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


def meant(name: str, known: Iterable[str], otherwise: str, origin: Span) -> str | Remedy:
    """A remedy: the closest known name in the place of this one in `origin`, or `otherwise`."""
    other = closest(name, known)
    return written(origin, name, other) if other else otherwise


def written(origin: Span, name: str, other: str) -> str | Remedy:
    """That another name is meant by the one that stands in `origin`."""
    at = origin.text.find(name)
    if at < 0:
        return f"Did you mean `{other}`?"
    start = origin.start + at
    return replacing(Span(origin.source, start, start + len(name)), other)


def rough(value: Fraction) -> str:
    """A number for a message, also one that no double holds.

    >>> rough(Fraction(5, 2)), rough(Fraction(10) ** 400)
    ('2.5', '1e+400')
    """
    exact = Decimal(value.numerator) / Decimal(value.denominator)
    if abs(exact.adjusted()) > 300:
        return f"{exact.normalize():.6g}".lower()
    return f"{float(value):g}"


def listed(names: Iterable[str], most: int = 8) -> str:
    """Names as a person lists them: `a`, `b` and `c`."""
    return numerals.listed([f"`{n}`" for n in names], "and", most)
