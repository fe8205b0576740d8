"""The members of the structs of signals: what exact and step take."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, NamedTuple

from bondgraph.backends.facts import about_field, about_known, reads_time
from bondgraph.backends.spelling import DOUBLE_INTEGRAL, INTEGRAL, START, Spelling, suffixes
from bondgraph.ir.program import Known, Program

_SUFFIXES = {
    INTEGRAL: "its integral since the start, by time_unit",
    DOUBLE_INTEGRAL: "the integral of that, by time_unit again",
    START: "its value at the start",
}


class Member(NamedTuple):
    """A member of a struct: `size` is the length of an array, 0 for a plain value."""

    name: str
    type: Literal["real", "bool", "count"]
    size: int
    text: str


def samples(program: Program, spelling: Spelling) -> list[Member]:
    """What step takes: one value of every known signal."""
    return [_sample(known, spelling.knowns[known.name]) for known in program.knowns]


def _sample(known: Known, name: str) -> Member:
    text = about_known(known)
    if known.kind == "mode":
        return Member(name, "bool", 0, text)
    if not known.sampled:
        text += "; step does not read it"
    if known.counts is None:
        return Member(name, "real", 0, text)
    what = f"{known.counts:g} counts a turn" if known.counts else "counts"
    return Member(name, "count", 0, f"{what}; {text}")


def derivatives(program: Program, spelling: Spelling) -> Iterator[Member]:
    """What exact takes: every known signal with the derivatives that the residuals contain."""
    inputs = spelling.inputs
    for known in program.knowns:
        name, text = inputs[known.name, ""], about_known(known)
        if known.kind == "mode":
            yield Member(name, "bool", 0, text)
        elif known.highest >= 1:
            yield Member(name, "real", known.highest + 1, f"{text}; [k]: its derivative k")
        elif known.highest == 0 or not suffixes(known):
            yield Member(name, "real", 0, text)
        for suffix in suffixes(known):
            more = f"{known.path}: {_SUFFIXES[suffix]}"
            yield Member(inputs[known.name, suffix], "real", 0, more)
    for field in program.integrals:
        yield Member(inputs["", field.name], "real", 0, about_field(field))
    if reads_time(program):
        yield Member("time", "real", 0, "since the start, by time_unit")
