"""The members of the structs of signals: what exact and step take."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from bondgraph.backends.facts import about_field, about_known, reads_time
from bondgraph.backends.spelling import DOUBLE_INTEGRAL, INTEGRAL, START, Spelling, suffixes
from bondgraph.ir.program import Known, Program, Ref
from bondgraph.notation.walk import reads
from bondgraph.text.tuples import NamedTuple

_SUFFIXES = {
    INTEGRAL: ("its integral since the start, by time_unit", -1),
    DOUBLE_INTEGRAL: ("the integral of that, by time_unit again", -2),
    START: ("its value at the start", None),
}


class Member(NamedTuple):
    """A member of a struct: `size` is the length of an array, 0 for a plain value.

    `refs` are the values of the program that it holds, one for each element.
    """

    name: str
    type: Literal["real", "bool", "count"]
    size: int
    text: str
    refs: tuple[Ref, ...]


def samples(program: Program, spelling: Spelling) -> list[Member]:
    """What step takes: one value of every known signal."""
    return [_sample(known, spelling.knowns[known.name]) for known in program.knowns]


def _sample(known: Known, name: str) -> Member:
    text, refs = about_known(known), (Ref("known", known.name),)
    if known.kind == "mode":
        return Member(name, "bool", 0, text, refs)
    if not known.sampled:
        text += "; step does not read it"
    if known.counts is None:
        return Member(name, "real", 0, text, refs)
    what = f"{known.counts:g} counts a turn" if known.counts else "counts"
    return Member(name, "count", 0, f"{what}; {text}", refs)


def signals(program: Program, spelling: Spelling) -> list[Member]:
    """What the blocks of step take: the samples, and the past values that they need."""
    past = [d.known for line in spelling.lines.values() for d in line.past]
    return samples(program, spelling) + [_sample(k, spelling.knowns[k.name]) for k in past]


def derivatives(program: Program, spelling: Spelling) -> Iterator[Member]:
    """What exact takes: every known signal with the derivatives that the residuals contain."""
    inputs = spelling.inputs
    sources = {past.of for past in program.delayed} - {ref.name for ref in reads(program.exact)}
    for known in (k for k in program.read if k.name not in sources):
        name, text = inputs[known.name, ""], about_known(known)
        if known.kind == "mode":
            yield Member(name, "bool", 0, text, (Ref("known", known.name),))
        elif known.highest >= 1:
            size = known.highest + 1
            refs = tuple(Ref("known", known.name, k) for k in range(size))
            yield Member(name, "real", size, f"{text}; [k]: its derivative k", refs)
        elif known.highest == 0 or not suffixes(known):
            yield Member(name, "real", 0, text, (Ref("known", known.name),))
        for suffix in suffixes(known):
            more, order = _SUFFIXES[suffix]
            ref = Ref("start", known.name) if order is None else Ref("known", known.name, order)
            member = inputs[known.name, suffix]
            yield Member(member, "real", 0, f"{known.path}: {more}", (ref,))
    for field in program.integrals:
        ref = Ref("integral", field.name)
        yield Member(inputs["", field.name], "real", 0, about_field(field), (ref,))
    if reads_time(program):
        yield Member("time", "real", 0, "since the start, by time_unit", (Ref("time", "time"),))
