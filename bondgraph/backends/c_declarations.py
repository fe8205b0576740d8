"""The structs of a file of C: its parameters, its samples, its residuals by number."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from bondgraph.backends import listing
from bondgraph.backends.facts import about_field, about_residual
from bondgraph.backends.members import Member, samples
from bondgraph.backends.spelling import Spelling
from bondgraph.ir.program import Field, Program


class Declarations:
    """The structs of the `programs` of a file; `stem` begins the names of their types."""

    def __init__(self, programs: Sequence[Program], spelling: Spelling, stem: str) -> None:
        self._programs, self._spelling = programs, spelling
        self._real = f"{stem}_real"

    def all(self) -> dict[str, object]:
        """The holes of signals.h.j2 and of the enum of residuals."""
        program, spelling, real = self._programs[0], self._spelling, self._real
        numbers = [
            (f"{spelling.prefix}{spelling.numbers[r.name]} = {k},", about_residual(r))
            for k, r in enumerate(program.residuals)
        ]
        parameters = [
            (f"{real} {spelling.params[f.name]};", about_field(f))
            for f in parameters_of(self._programs)
        ]
        return {
            "residual_numbers": self.members(numbers),
            "residual_count": len(program.residuals),
            "parameters": self.members(parameters or [_empty("the code reads no parameters")]),
            "samples": self.struct(samples(program, spelling)),
        }

    def members(self, pairs: list[tuple[str, str]]) -> list[str]:
        """Members of a struct, with what they are."""
        return listing.members(pairs, self._spelling.target, 4)

    def struct(self, found: Iterable[Member]) -> list[str]:
        """Signals as members of a struct."""
        types = {"real": self._real, "bool": "bool", "count": "int32_t"}
        pairs = [
            (f"{types[m.type]} {m.name}{f'[{m.size}]' if m.size else ''};", m.text) for m in found
        ]
        return self.members(pairs or [_empty("the model has no signals")])


def parameters_of(programs: Iterable[Program]) -> list[Field]:
    """The parameters of all programs of a file, those of the first one first."""
    found: dict[str, Field] = {}
    for field in (f for program in programs for f in program.params):
        found.setdefault(field.name, field)
    return list(found.values())


def _empty(what: str) -> tuple[str, str]:
    return "char unused;", what
