"""The monitor in an FMU: samples in; residuals, thresholds, and what is beyond them out."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping

from bondgraph.backends import c
from bondgraph.backends.facts import facts
from bondgraph.backends.fmu.fmu_variables import Role, Type, Variable, Variables
from bondgraph.backends.fmu.package import Core
from bondgraph.backends.listing import place
from bondgraph.backends.members import samples
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import load
from bondgraph.backends.templates import fill
from bondgraph.ir.artifact import Artifact
from bondgraph.ir.program import Field, Known, Program
from bondgraph.notation.dialect import digits

_TYPES: dict[str, Type] = {"real": "real", "bool": "boolean", "count": "integer"}
_READ = {"real": "value[{0}]", "bool": "value[{0}] != 0.0", "count": "(int32_t)value[{0}]"}
_LONG = 200  # letters of a description


def monitor_core(program: Program, bounds: Program | None, units: Mapping[str, str]) -> Core:
    """The monitor of a residual program and its thresholds, if it has some.

    `units` are those of the residuals, by the name of the relation.
    """
    listed = Variables()
    listed.add(Variable("time", "real", "time", 0.0, "s", "time"))
    programs = [program] if bounds is None else [program, bounds]
    inputs = _inputs(programs, listed)
    parameters = _parameters(programs, listed)
    places = _outputs(program, units, listed)
    part = _part(program, bounds, inputs, parameters)
    description = (
        f"Residuals of {program.name}: near zero while the machine is well. Outputs at the end of"
        " a step are of the sample at its begin."
    )
    step = digits(1.0 / program.rate)
    return Core(
        "monitor",
        program.name,
        f"{facts(program).stem}_monitor",
        description,
        tuple(listed.all),
        {
            "residuals": part,
            "thresholds": bounds is not None,
            "places": places,
        },
        _files(program, bounds),
        (f"{facts(program).file}.c",),
        step,
        step,
    )


def _inputs(programs: list[Program], listed: Variables) -> dict[str, int]:
    """The place of each signal that a step reads."""
    found: dict[str, int] = {}
    for program in programs:
        kinds = {m.refs[0].name: m.type for m in samples(program, Spelling(program, load("c")))}
        for known in program.knowns:
            if known.sampled and known.name not in found:
                own = _TYPES[kinds[known.name]]
                unit = known.unit if own == "real" else ""
                said = _about(known, "" if own != "integer" else "counts of an encoder")
                found[known.name] = listed.add(
                    Variable(known.path, own, "input", 0.0, unit, said)
                )
    return found


def _parameters(programs: list[Program], listed: Variables) -> dict[str, int]:
    found: dict[str, int] = {}
    for field in (f for p in programs for f in p.params):
        if field.name not in found:
            start = float("nan") if field.default is None else field.default
            said = _about(field, "" if field.default is not None else "to be set: no value")
            found[field.name] = listed.add(
                Variable(field.path, "real", "tunable", start, field.unit, said)
            )
    return found


def _about(item: Field | Known, more: str) -> str:
    """What the model says of a parameter or a signal, and where."""
    parts = [" ".join(item.doc.split()).rstrip("."), more, place(item.origin)]
    return textwrap.shorten(", ".join(p for p in parts if p), _LONG)


def _outputs(program: Program, units: Mapping[str, str], listed: Variables) -> dict[str, int]:
    """The margins and all outputs; the place of the first of each kind."""

    def add(kind: str, type_: Type, texts: Iterable[str]) -> int:
        first = len(listed.all)
        for info, text in zip(program.residuals, texts, strict=True):
            unit = units.get(info.path, "") if type_ == "real" else ""
            role: Role = "setting" if kind == "margin" else "output"
            name = f"{kind}.{info.name}"
            listed.add(Variable(name, type_, role, 0.0, unit, text, role == "output"))
        return first

    names = [r.name for r in program.residuals]
    equations = [textwrap.shorten(r.text or r.name, _LONG) for r in program.residuals]
    beyond = [f"{n} is valid and beyond its threshold, which is not 0" for n in names]
    return {
        "margin": add("margin", "real",
            [f"how far {n} of the healthy machine is from 0, apart from tolerances" for n in names]
        ),
        "residual": add("residual", "real", equations),
        "valid": add("valid", "boolean", [f"the filter of {n} has settled" for n in names]),
        "threshold": add("threshold", "real",
            [f"margin and tolerances together: how far {n} may be from 0" for n in names]
        ),
        "fired": add("fired", "boolean", beyond),
    }  # fmt: skip


def _part(
    program: Program,
    bounds: Program | None,
    inputs: Mapping[str, int],
    parameters: Mapping[str, int],
) -> dict[str, object]:
    """What the template needs of both programs, which share samples and parameters."""
    spelling, about = Spelling(program, load("c")), facts(program)
    taken = []
    for member in samples(program, spelling):
        at = inputs.get(member.refs[0].name)
        read = "0" if at is None else _READ[member.type].format(at)
        taken.append(f"{member.name} = {read}")
    names = dict.fromkeys(f.name for p in (program, bounds) if p is not None for f in p.params)
    own = spelling if bounds is None else Spelling(bounds, load("c"), spelling)
    given = [f"{own.params[name]} = value[{parameters[name]}]" for name in names]
    has_bound = [str(not r.unavailable).lower() for r in (bounds or program).residuals]
    return {
        "stem": about.stem,
        "PREFIX": about.stem.upper(),
        "file": about.file,
        "given": given or ["unused = 0"],
        "taken": taken or ["unused = 0"],
        "has_bound": has_bound,
    }


def _files(program: Program, bounds: Program | None) -> tuple[Artifact, ...]:
    """The header and the code, as `compile --target c` writes them."""
    holes, file = c.files(program, load("c"), bounds=bounds), facts(program).file
    return tuple(
        Artifact(f"{file}.{name}", fill(f"c/model.{name}.j2", holes)) for name in ("h", "c")
    )
