"""What fills the holes of the templates of C: files, headers and tests around the programs."""

from __future__ import annotations

import math
import textwrap

from bondgraph.backends import decision, listing
from bondgraph.backends.c_code import Code
from bondgraph.backends.c_declarations import Declarations
from bondgraph.backends.decision import UNTUNED, Tuned
from bondgraph.backends.facts import (
    ABI,
    SLOWEST,
    SLOWEST_FLOAT,
    Facts,
    exponential,
    facts,
    near,
)
from bondgraph.backends.golden import Golden
from bondgraph.backends.members import derivatives
from bondgraph.backends.parts import exact_part, step_part
from bondgraph.backends.procedure_lines import roots, tables
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import Target
from bondgraph.backends.templates import fill
from bondgraph.backends.vectors import Vectors
from bondgraph.ir.functions import FUNCTIONS
from bondgraph.ir.program import (
    Dot,
    Program,
)
from bondgraph.notation.dialect import digits

#: Helpers of the generated code that need nothing of it, each before those that call it.
PURE = "near_tanh sign ssqrt ssq equal min max power table along map inverse root".split()
_ARITHMETIC = frozenset({"sign", "ssq", "min", "max"})  # functions that take no library

_SCALED = ";\n * derivative k times time_unit to the power k"


def files(
    program: Program,
    target: Target,
    tuned: Tuned = UNTUNED,
    bounds: Program | None = None,
    decides: bool = True,
) -> dict[str, object]:
    """The holes of all templates of C but those of `exact`, of `tests` and of the example.

    The thresholds `bounds` stand beside the residuals, and take the same parameters and samples.
    """
    program = step_part(program)
    about = facts(program)
    spelling = Spelling(program, target)
    code = Code(program, spelling, about.stem)
    codes = [code]
    if bounds is not None:
        own = Spelling(bounds, target, spelling)
        codes.append(Code(bounds, own, facts(bounds).stem, about.stem, "bound_"))
    every = [facts(c.program) for c in codes]
    laws = frozenset[str]().union(*(f.laws for f in every))
    shared = about._replace(
        laws=laws, beyond_float=tuple(dict.fromkeys(n for f in every for n in f.beyond_float))
    )
    found = {
        **_file(shared, codes, target),
        **_limits(program, about, code),
        **Declarations([c.program for c in codes], spelling, about.stem).all(),
        "encoders": any(c.spelling.encoders for c in codes),
        **decision.c_holes(program, tuned, target),
        "noun": about.noun,
        "digest": program.digest,
        "about": header(program, target, about, bounds is not None),
        "own": about.stem,
        "of": "",
        "settles": any(not r.unavailable for c in codes for r in c.program.residuals),
        "bounded": bounds is not None,
        "fixed": False,
    }
    found["decides"] = bool(found["decides"]) and decides
    for name in ("has_math", "needs_stddef"):  # an amount, and NULL where there are no bounds
        found[name] = found[name] or found["decides"]
    cores = [one.core() for one in codes]
    found["constants"] = cores[0]["constants"]
    for name, core in zip(("residuals", "thresholds"), cores, strict=False):
        holes = found | core
        found[f"{name}_header"] = fill("c/core.h.j2", holes).rstrip("\n")
        found[f"{name}_code"] = fill("c/core.c.j2", holes).rstrip("\n")
    return {"thresholds_header": "", "thresholds_code": "", **found}


def vectors(program: Program, target: Target, golden: Golden) -> dict[str, object]:
    """The holes of the templates of `tests` and of the example."""
    return Vectors(program, Spelling(program, target), golden).c()


def tests(
    bounds: Program, program: Program, target: Target, golden: Golden, base: Golden
) -> dict[str, object]:
    """The holes of the templates of `tests` for thresholds; `base` belongs to the residuals."""
    spelling = Spelling(step_part(program), target)
    own = Spelling(bounds, target, spelling)
    found = Vectors(bounds, own, golden, (program, base)).c()
    return found | {"own": facts(bounds).stem, "noun": "thresholds", "of": "_thresholds"}


def exact(program: Program, target: Target) -> dict[str, object]:
    """The holes of the templates of `exact`."""
    spelling = Spelling(program, target)
    part = exact_part(program)
    own = Spelling(part, target, spelling)
    about = facts(part)
    code = Code(part, own, f"{about.stem}_exact", about.stem)
    core = code.core()
    declared = Declarations([part], own, about.stem)
    found = {
        **_file(about, [code], target),
        "time_unit": digits(program.time_unit),
        "derivatives": declared.struct(derivatives(part, own)),
        "derivative_scale": "" if program.time_unit == 1.0 else _SCALED,
        "coefficients": core["coefficients"] or ["    char unused;"],
        "coefficients_code": fill("c/coefficients.c.j2", core).rstrip("\n"),
        "coefficient_values": core["coefficient_values"],
        **code.exact(),
    }
    return found


def _file(about: Facts, codes: list[Code], target: Target) -> dict[str, object]:
    """What every file with code needs: its helpers, its tables, what it includes."""
    code = codes[0]
    program, stem = code.program, about.stem
    unset = any(f.default is None for c in codes for f in c.program.params)
    unwritten = any(r.unwritten for r in program.residuals)
    rows = [t for c in codes for t in tables(c.program, c.spelling, "{{{0}}}", c.number)]
    shown = [r for c in codes for r in roots(c.program, c.spelling, "real {0}", 8)]
    dots = any(isinstance(s, Dot) for s in program.exact)
    gaps = "inverse" in about.laws or any(
        math.isnan(y) for c in codes for _, points in c.program.tables for y in points[0]
    )
    lines = any(c.spelling.lines for c in codes)
    return {
        "stem": stem,
        "file": about.file,
        "PREFIX": stem.upper(),
        "guard": f"{stem.upper()}_H",
        "abi": ABI,
        "near": near(),
        "model": listing.harmless(program.name, target),
        "unset": " (NaN where the model has none)" if unset else "",
        "helpers": _helpers(about, codes, dots),
        "tables": list({r["name"]: r for r in rows}.values()),
        "roots": list({r["name"]: r for r in shown}.values()),
        "needs_functions": needs_library(about),
        "has_math": needs_library(about),
        "libm": " -lm" if needs_library(about) else "",
        "needs_math": needs_library(facts(program)) or unset or bool(shown) or gaps or lines
        or (unwritten and not program.step),
        "thresholds_need_math": needs_library(about),
        "unwritten": unwritten,
        "needs_stddef": bool(rows) or dots or any(c.tapes for c in codes),
        "beyond_float": ", ".join(f"{n:g}" for n in about.beyond_float[:8]),
        "opens": any(o.modes for o in program.openings),
        "parameters_are_finite": code.parameters_are_finite(),
        "nominal": code.nominal([c.program for c in codes]),
    }


def header(program: Program, target: Target, facts: Facts, bounded: bool) -> list[str]:
    """The lines of the first comment of the header."""
    title = listing.harmless(program.title, target)
    source = listing.harmless(program.source, target)
    name = listing.harmless(program.name, target)
    first = f"residuals of the model {name}, near zero while the machine is well."
    if bounded:
        first += " With thresholds: how far they may be from it."
    if program.bounds:
        of = listing.harmless(program.bounds, target)
        first = f"thresholds for the residuals of the model {of}, in structs of the same form."
    paragraphs = [
        f"{facts.file}.h: {first}",
        title,
        f"Generated by bondgraph from {source}: change the model, not this file. No heap, no "
        "globals, nothing printed: everything lives in structs that you own.",
    ]
    lines: list[str] = []
    for paragraph in paragraphs:
        if paragraph:
            lines += ([" *"] if lines else []) + [
                f" * {line}" for line in textwrap.wrap(paragraph, target.width - 3)
            ]
    return lines


def _limits(program: Program, facts: Facts, code: Code) -> dict[str, object]:
    least = facts.least_sample_time
    limit = f">= {code.real(least)}" if least else f"> {code.real(0.0)}"
    return {
        "sample_time": digits(1.0 / program.rate),
        "bandwidth": digits(program.bandwidth),
        "slowest": digits(SLOWEST),
        "slowest_float": digits(SLOWEST_FLOAT),
        "fastest": digits(facts.fastest),
        "fastest_limit": code.real(facts.fastest),
        "sample_time_test": limit,
        "rate_limit": f", or below {1.0 / program.rate:g} s" if least else "",
    }


def needs_library(facts: Facts) -> bool:
    """Whether the code calls the mathematical library of C."""
    return bool(facts.laws & (FUNCTIONS.keys() - _ARITHMETIC))


def _helpers(about: Facts, codes: list[Code], has_dot: bool) -> list[str]:
    found = [name for name in PURE if name in about.laws]
    wanted = {
        "exponential": any(exponential(c.program) for c in codes),
        "dot": has_dot,
        "tape": any(c.tapes for c in codes),
        "encoder": any(c.spelling.encoders for c in codes),
        "line": any(c.spelling.lines for c in codes),
    }
    return found + [name for name, needed in wanted.items() if needed]
