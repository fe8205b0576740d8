"""What fills the holes of the C templates."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable

from bondgraph.backends import decision, listing
from bondgraph.backends.blocks import Block
from bondgraph.backends.decision import UNTUNED, Tuned
from bondgraph.backends.facts import (
    ABI,
    SLOWEST,
    SLOWEST_FLOAT,
    Facts,
    about_field,
    about_residual,
    exponential,
)
from bondgraph.backends.golden import Golden
from bondgraph.backends.members import Member, derivatives, samples, signals
from bondgraph.backends.procedure_lines import lines, roots, tables
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import Target
from bondgraph.backends.vectors import Vectors
from bondgraph.ir.functions import FUNCTIONS
from bondgraph.ir.program import (
    Assignment,
    Const,
    Dot,
    PolynomialTape,
    Program,
    Ref,
    ResidualInfo,
    Statement,
)
from bondgraph.notation.dialect import CodeSpeller, digits
from bondgraph.notation.walk import reads
from bondgraph.text.numerals import joined

#: Helpers of the generated code that need nothing of it, each before those that call it.
PURE = "sign ssqrt ssq equal min max power table along map inverse root".split()
_ARITHMETIC = frozenset({"sign", "ssq", "min", "max"})  # functions that take no library

_SCALED = ";\n * derivative k times time_unit to the power k"
_OPTIONS = ("sample_time", "bandwidth", "time_unit")


def holes(
    program: Program, target: Target, facts: Facts, golden: Golden, tuned: Tuned = UNTUNED
) -> dict[str, object]:
    """Everything that the templates of C leave open."""
    spelling = Spelling(program, target)
    code = Code(program, spelling, facts.stem)
    stem, unset = facts.stem, any(f.default is None for f in program.params)
    has_dot = any(isinstance(s, Dot) for s in program.exact)
    unwritten = any(r.unwritten for r in program.residuals)
    gaps = "inverse" in facts.laws or any(
        math.isnan(y) for _, points in program.tables for y in points[0]
    )
    return {
        **_limits(program, facts, code),
        **_Declarations(program, spelling, stem).all(),
        **code.configure(),
        **Vectors(program, spelling, golden).c(),
        **decision.c_holes(program, tuned, target),
        "stem": stem,
        "file": facts.file,
        "noun": facts.noun,
        "programs": " selftest" if program.bounds else " example selftest",
        "PREFIX": stem.upper(),
        "guard": f"{stem.upper()}_RESIDUALS_H",
        "abi": ABI,
        "digest": program.digest,
        "about": about(program, target, facts),
        "model": listing.harmless(program.name, target),
        "unset": " (NaN where the model has none)" if unset else "",
        "helpers": _helpers(program, facts, spelling, has_dot, code),
        "tables": tables(program, spelling, "{{{0}}}", code.number),
        "roots": roots(program, spelling, "real {0}", 8),
        "needs_functions": needs_library(facts),
        "libm": " -lm" if needs_library(facts) else "",
        "needs_math": needs_library(facts) or unset or unwritten or bool(program.roots) or gaps
        or bool(spelling.lines),
        "unwritten": unwritten,
        "needs_stddef": bool(program.tables) or has_dot or bool(code.tapes),
        "beyond_float": ", ".join(f"{n:g}" for n in facts.beyond_float[:8]),
        "exact": code.exact(),
        "blocks": [code.block(k, b) for k, b in enumerate(spelling.blocks)],
        "block_count": max(1, len(spelling.blocks)),
        "block_names": listing.comment(
            "samples since the start of "
            + ("; ".join(joined(b.residuals) for b in spelling.blocks) or "nothing"),
            target,
            4,
        ),
        "unavailable": code.unavailable(),
        "opens": any(o.modes for o in program.openings),
        "lines": list(range(len(spelling.lines))),
        "recall": _recall(program, spelling),
        "ages": [
            f"monitor->p.back_{k}_{j} = {code.real(past.seconds)} / sample_time;"
            for k, line in enumerate(spelling.lines.values())
            for j, past in enumerate(line.past)
        ],
    }


def _recall(program: Program, spelling: Spelling) -> list[str]:
    """How step makes its signals from a sample."""
    found = [f"s->{m.name} = samples->{m.name};" for m in samples(program, spelling)]
    for k, (name, line) in enumerate(spelling.lines.items()):
        place = f"p->past_{k}, {line.length}u, {{0}}p->next_{k}"
        found.append(f"remember({place.format('&')}, s->{spelling.knowns[name]});")
        found += [
            f"s->{spelling.knowns[past.known.name]} = "
            f"recalled({place.format('')}, p->back_{k}_{j});"
            for j, past in enumerate(line.past)
        ]
    return found


def about(program: Program, target: Target, facts: Facts) -> list[str]:
    """The lines of the first comment of the header."""
    title = listing.harmless(program.title, target)
    source = listing.harmless(program.source, target)
    name = listing.harmless(program.name, target)
    first = f"residuals of the model {name}, near zero while the machine is well."
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
        "time_unit": digits(program.time_unit),
        "slowest": digits(SLOWEST),
        "slowest_float": digits(SLOWEST_FLOAT),
        "fastest": digits(facts.fastest),
        "fastest_limit": code.real(facts.fastest),
        "sample_time_test": limit,
        "rate_limit": f", or below {1.0 / program.rate:g} s" if least else "",
    }


class _Declarations:
    """The structs and the list of residuals."""

    def __init__(self, program: Program, spelling: Spelling, stem: str) -> None:
        self.program = program
        self.spelling = spelling
        self.stem = stem
        self.real = f"{stem}_real"

    def all(self) -> dict[str, object]:
        """The holes of structs.h.j2."""
        program, spelling, real = self.program, self.spelling, self.real
        numbers = [
            (f"{spelling.prefix}{spelling.numbers[r.name]} = {k},", about_residual(r))
            for k, r in enumerate(program.residuals)
        ]
        parameters = [
            (f"{real} {spelling.params[f.name]};", about_field(f)) for f in program.params
        ]
        return {
            "residual_numbers": self._members(numbers),
            "residual_count": len(program.residuals),
            "parameters": self._members(parameters or [_empty("the code reads no parameters")]),
            "samples": self._struct(samples(program, spelling)),
            "signals": self._struct(signals(program, spelling)),
            "taken": "signals" if spelling.lines else "samples",
            "derivatives": self._struct(derivatives(program, spelling)),
            "derivative_scale": "" if program.time_unit == 1.0 else _SCALED,
            "parts": self._parts(),
            "encoders": bool(spelling.encoders),
        }

    def _members(self, pairs: list[tuple[str, str]]) -> list[str]:
        return listing.members(pairs, self.spelling.target, 4)

    def _struct(self, found: Iterable[Member]) -> list[str]:
        types = {"real": self.real, "bool": "bool", "count": "int32_t"}
        pairs = [
            (f"{types[m.type]} {m.name}{f'[{m.size}]' if m.size else ''};", m.text) for m in found
        ]
        return self._members(pairs or [_empty("the model has no signals")])

    def _past(self) -> list[tuple[str, str]]:
        """The memory of each line: its samples, the place of the next, and how far back to go."""
        found = []
        for k, (name, line) in enumerate(self.spelling.lines.items()):
            found.append((f"{self.real} past_{k}[{line.length}];", f"samples of {name}"))
            found.append((f"uint32_t next_{k};", "the place of the next"))
            found += [
                (f"{self.real} back_{k}_{j};", f"samples, {past.seconds:g} s")
                for j, past in enumerate(line.past)
            ]
        return found

    def _parts(self) -> list[dict[str, object]]:
        spelling, real = self.spelling, self.real
        coefs = [
            (f"{real} {spelling.coefs[f.name]}{f'[{f.size}]' if f.size else ''};", f.doc)
            for f in self.program.coefs
        ]
        states = [(f"{real} {spelling.states[f.name]};", f.doc) for f in self.program.states]
        members = {b.name: joined(b.residuals) for b in spelling.blocks}
        encoders = [
            (f"{self.stem}_encoder {name};", f"{signal}, read by {members[block]}")
            for (block, signal), name in spelling.encoders.items()
        ]
        parts = (
            ("coefficients", "c", "What configure computes from the parameters.", coefs),
            ("memory", "x", "What the filters remember from sample to sample.", states),
            ("encoders", "e", "The encoders, each with the residuals that read it.", encoders),
            ("past", "p", "The last samples of signals that are needed late.", self._past()),
        )
        return [
            {"name": name, "member": member, "doc": doc, "lines": self._members(pairs)}
            for name, member, doc, pairs in parts
            if pairs
        ]


def needs_library(facts: Facts) -> bool:
    """Whether the code calls the mathematical library of C."""
    return bool(facts.laws & (FUNCTIONS.keys() - _ARITHMETIC))


def _empty(what: str) -> tuple[str, str]:
    return "char unused;", what


def _helpers(
    program: Program, facts: Facts, spelling: Spelling, has_dot: bool, code: Code
) -> list[str]:
    found = [name for name in PURE if name in facts.laws]
    wanted = {
        "exponential": exponential(program),
        "dot": has_dot,
        "tape": bool(code.tapes),
        "encoder": bool(spelling.encoders),
        "line": bool(spelling.lines),
    }
    return found + [name for name, needed in wanted.items() if needed]


class Code:
    """Writes configure, exact and step of one program; `stem` begins every name."""

    def __init__(self, program: Program, spelling: Spelling, stem: str) -> None:
        self.program = program
        self.spelling = spelling
        self.target = spelling.target
        self.stem = stem
        self._configure = CodeSpeller(self.target.configure, spelling.value, spelling.tables)

    def real(self, value: float) -> str:
        """A number as a constant of the type `real`."""
        return self._configure.expression(Const(value))

    # -------------------------------------------------------------------- configure

    def number(self, value: float) -> str:
        """A number, or none, as C has it."""
        return "(real)NAN" if math.isnan(value) else self.real(value)

    def configure(self) -> dict[str, object]:
        """The holes of configure.c.j2."""
        program, spelling = self.program, self.spelling
        params = [f"p->{spelling.params[f.name]}" for f in program.params]
        coefs = [
            f"monitor->c.{spelling.coefs[f.name]}{'[0]' if f.size else ''}" for f in program.coefs
        ]
        head = self._pointers(program.configure, "c")
        body = lines(program.configure, spelling, self._configure, 4, self._tape)
        return {
            "nominal": self._nominal(),
            "tapes": [self._tape_table(t) for t in self.tapes],
            **self._coefficient_arguments(),
            "configure": [*head, *body] if body else head[:-1],
            "parameters_are_finite": self._finite(params, "p"),
            "coefficients_are_finite": self._finite(coefs, "monitor"),
            "settle": [
                line for r in program.residuals if not r.unavailable for line in self._settle(r)
            ],
        }

    def _settle(self, info: ResidualInfo) -> list[str]:
        prefix = f"monitor->settle[{self._number(info.name)}] ="
        call = f"samples({self.real(info.settle)}, sample_time, bandwidth);"
        if len(prefix) + len(call) + 5 <= self.target.width:
            return [f"    {prefix} {call}"]
        return [f"    {prefix}", f"        {call}"]

    def _coefficient_arguments(self) -> dict[str, object]:
        read = reads(self.program.configure)
        pairs = [(f"{self.stem}_monitor *monitor", "monitor")]
        if any(ref.space == "param" for ref in read):
            pairs.append((f"const {self.stem}_parameters *p", "parameters"))
        used = {ref.name for ref in read if ref.space == "option"}
        pairs += [(f"real {name}", name) for name in _OPTIONS if name in used]
        head = "static void compute_coefficients({0})"
        return {
            "coefficient_head": listing.statement(
                head, ", ".join(a for a, _ in pairs), self.target, 0
            ),
            "coefficient_values": ", ".join(v for _, v in pairs),
        }

    def _nominal(self) -> list[str]:
        pairs: list[tuple[str, str]] = []
        for field in self.program.params:
            value = "(real)NAN" if field.default is None else self.real(field.default)
            unit = field.unit if field.default is not None else f"{field.unit} yours to set"
            name = self.spelling.params[field.name]
            pairs.append((f"parameters->{name} = {value};", unit.strip()))
        return listing.members(pairs, self.target, 4) if pairs else ["    (void)parameters;"]

    def _finite(self, names: list[str], unused: str) -> list[str]:
        if not names:
            return [f"    (void){unused};", "    return true;"]
        total = " + ".join(names)
        return listing.statement("return finite_number({0});", total, self.target, 4)

    # ------------------------------------------------------------------------- tapes

    @property
    def tapes(self) -> list[PolynomialTape]:
        """The polynomial tapes of configure."""
        return [s for s in self.program.configure if isinstance(s, PolynomialTape)]

    def _tape_table(self, tape: PolynomialTape) -> dict[str, object]:
        rows = [
            f"{{{o.target}, {o.source}, {o.shift}, {o.scale}, {o.length}, {str(o.fresh).lower()}}}"
            for o in tape.ops
        ]
        why = listing.words(listing.place(tape.origin), tape.comment or tape.residual)
        return {
            "comment": listing.harmless(why, self.target),
            "name": f"{tape.residual}_tape",
            "length": len(rows),
            "lines": listing.table(rows, self.target, 4),
        }

    def _tape(self, tape: PolynomialTape, speller: CodeSpeller) -> list[str]:
        scales = [speller.expression(s) for s in tape.scales]
        coef = self.target.reference["coef"]
        body = [
            "const real scales[] = {",
            *listing.table(scales, self.target, 4),
            "};",
            f"real rows[{tape.rows * tape.length}]; /* on the stack, only here */",
            "",
            f"run_tape({tape.residual}_tape, {len(tape.ops)}, scales, rows, {tape.rows},"
            f" {tape.length});",
        ]
        for output in tape.outputs:
            array = coef.format(self.spelling.coefs[output.array])
            body.append(f"keep({array}, &rows[{output.row * tape.length}], {output.length});")
        return ["    {", *[f"        {line}" if line else "" for line in body], "    }"]

    # ---------------------------------------------------------------- exact and step

    def exact(self) -> list[str]:
        """The body of exact."""
        speller = CodeSpeller(self.target.dialect, self.spelling.exact, self.spelling.tables)
        spaces = {ref.space for ref in reads(self.program.exact)}
        head: list[str] = []
        unused: list[str] = []
        if "coef" in spaces:
            head.append(f"    const {self.stem}_coefficients *c = &monitor->c;")
        else:
            unused.append("    (void)monitor;")
        if spaces & {"known", "start", "integral", "time"}:
            head.append(f"    const {self.stem}_derivatives *d = derivatives;")
        else:
            unused.append("    (void)derivatives;")
        head.append("    real *r = residuals;")
        body = lines(self.program.exact, self.spelling, speller, 4)
        for info in self.program.residuals:
            if info.unwritten:
                why = listing.words(listing.place(info.origin), f"{info.name}: {info.unwritten}")
                body += ([""] if body else []) + listing.comment(why, self.target, 4)
                body.append(f"    r[{self._number(info.name)}] = (real)NAN;")
        return [*head, *([""] if unused else []), *unused, "", *body]

    def block(self, number: int, block: Block) -> dict[str, object]:
        """The holes of block.c.j2."""
        samples = [f"s->{name}" for name in self.spelling.measured(block)]
        numbers = [self._number(r) for r in block.residuals]
        results = [f"r[{number}]" for number in numbers]
        return {
            "name": block.name,
            "number": number,
            "title": joined(block.residuals),
            "begins": block.begins,
            "first": self._run(block, block.first, "count_from"),
            "step": self._run(block, block.step, "count_on"),
            "numbers": numbers,
            "valid": [self._valid(r) for r in block.residuals],
            "finite": self._if_finite([*samples, *results]),
        }

    def _valid(self, residual: str) -> str:
        number = self._number(residual)
        progress = self.spelling.progress.get(residual)
        begun = "" if progress is None else f" && monitor->x.{progress} >= {self.real(1.0)}"
        return f"residuals->valid[{number}] = age > monitor->settle[{number}]{begun};"

    def _if_finite(self, names: list[str]) -> list[str]:
        test = "if (finite_number({0})) \1"
        rows = listing.statement(test, " + ".join(names), self.target, 4)
        return [row.replace("\1", "{") for row in rows]

    def _run(self, block: Block, statements: tuple[Assignment, ...], count: str) -> list[str]:
        spelling = self.spelling
        speller = CodeSpeller(
            self.target.dialect, lambda ref: spelling.value(ref, block.name), spelling.tables
        )
        counts = [
            f"    {count}(&monitor->e.{memory}, s->{member});"
            for memory, member in spelling.counted(block)
        ]
        head = self._pointers(statements, "cxe", bool(counts))
        if counts:
            counts.append("")
        return [*head, *counts, *lines(statements, spelling, speller, 4)]

    def _pointers(
        self, statements: Iterable[Statement], members: str, counts: bool = False
    ) -> list[str]:
        """Short names for the parts of the monitor that the statements use."""
        found = reads(statements)
        spaces = {ref.space for ref in found}
        head: list[str] = []
        if "coef" in spaces:
            fixed = "" if members == "c" else "const "
            head.append(f"    {fixed}{self.stem}_coefficients *c = &monitor->c;")
        if "state" in spaces and "x" in members:
            head.append(f"    {self.stem}_memory *x = &monitor->x;")
        if spaces & {"increment", "total"}:
            head.append(f"    const {self.stem}_encoders *e = &monitor->e;")
        unused: list[str] = []
        if not head and not counts:
            unused.append("    (void)monitor;")
        if "x" in members and not counts and not _samples(found):
            unused.append("    (void)s;")
        if head and unused:
            head.append("")
        head += unused
        return [*head, ""] if head else []

    def unavailable(self) -> list[str]:
        """The numbers of the residuals that step never computes."""
        owned = {r for block in self.spelling.blocks for r in block.residuals}
        return [self._number(r.name) for r in self.program.residuals if r.name not in owned]

    def _number(self, residual: str) -> str:
        return self.spelling.prefix + self.spelling.numbers[residual]


def _samples(refs: Iterable[Ref]) -> bool:
    return any(ref.space == "known" for ref in refs)
