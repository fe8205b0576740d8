"""What fills the holes of the Python templates."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable

from bondgraph.backends import decision, listing
from bondgraph.backends.blocks import Block
from bondgraph.backends.c_code import block_about, block_text
from bondgraph.backends.decision import UNTUNED, Tuned
from bondgraph.backends.facts import (
    ABI,
    SLOWEST,
    Facts,
    about_field,
    about_residual,
    exponential,
    facts,
    near,
)
from bondgraph.backends.golden import Golden
from bondgraph.backends.members import Member, derivatives, samples, signals
from bondgraph.backends.parts import exact_part, step_part
from bondgraph.backends.procedure_lines import lines, procedure, roots, tables
from bondgraph.backends.repeated import repeated
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import Target
from bondgraph.backends.templates import fill
from bondgraph.backends.vectors import Vectors
from bondgraph.ir.program import Dot, Field, PolynomialTape, Program, ResidualInfo
from bondgraph.notation.dialect import CodeSpeller, digits
from bondgraph.notation.walk import reads
from bondgraph.text.numerals import joined

_HELPERS = "near_tanh sign ssqrt ssq power table along map inverse root".split()
_OPTIONS = ("sample_time", "bandwidth", "time_unit")
_TYPES = {"real": "float", "bool": "bool", "count": "int"}


def files(
    program: Program,
    target: Target,
    tuned: Tuned = UNTUNED,
    bounds: Program | None = None,
    decides: bool = True,
) -> dict[str, object]:
    """The holes of the templates of Python, as those of `c.files`."""
    program = step_part(program)
    about = facts(program)
    spelling = Spelling(program, target)
    parts = [_Part(program, spelling)]
    if bounds is not None:
        parts.append(_Part(bounds, Spelling(bounds, target, spelling)))
    found: dict[str, object] = {
        **_file(about, parts, target),
        **_declared(about, parts, target),
        **decision.python_holes(program, tuned, target),
        "noun": about.noun,
        "class_name": "Monitor",
        "digest": program.digest,
        "bounded": bounds is not None,
    }
    found["decides"] = bool(found["decides"]) and decides
    found["imports"] = _imports(parts, bool(found["decides"]))
    cores = [fill("python/core.py.j2", found | p.core()).rstrip("\n") for p in parts]
    return found | {"cores": cores}


def vectors(program: Program, target: Target, golden: Golden) -> dict[str, object]:
    """The holes of the templates of `tests` and of the example."""
    return Vectors(program, Spelling(program, target), golden).python()


def tests(
    bounds: Program, program: Program, target: Target, golden: Golden, base: Golden
) -> dict[str, object]:
    """The holes of the templates of `tests` for thresholds; `base` belongs to the residuals."""
    spelling = Spelling(step_part(program), target)
    own = Spelling(bounds, target, spelling)
    found = Vectors(bounds, own, golden, (program, base)).python()
    return found | {"class_name": "Thresholds", "noun": "thresholds"}


def exact(program: Program, target: Target) -> dict[str, object]:
    """The holes of the templates of `exact`."""
    spelling = Spelling(program, target)
    part = exact_part(program)
    own = _Part(part, Spelling(part, target, spelling))
    return {
        **_file(facts(part), [own], target),
        **own.core(),
        "imports": _imports([own], False),
        "time_unit": digits(program.time_unit),
        "derivatives": own.struct(derivatives(part, own.spelling), "no signals"),
        "derivative_scale": "" if program.time_unit == 1.0 else _SCALED,
        "exact": own.exact(),
    }


def _file(about: Facts, parts: list[_Part], target: Target) -> dict[str, object]:
    """What every file with code needs: its helpers and its tables."""
    first, laws = parts[0], frozenset[str]().union(*(facts(p.program).laws for p in parts))
    shown = [r for p in parts for r in roots(p.program, p.spelling, "{0}: float", 12)]
    rows = [t for p in parts for t in tables(p.program, p.spelling, "({0})", _number, ("",))]
    rows += [t for p in parts for tape in p.tapes for t in _tape_tables(tape, target)]
    return {
        "stem": about.stem,
        "file": about.file,
        "headline": listing.harmless(about.headline, target),
        "model": listing.harmless(first.program.name, target),
        "abi": ABI,
        "near": near(),
        "unset": "; those without a value are yours to set" if first.unset else "",
        "unwritten": any(r.unwritten for r in first.program.residuals),
        "parameters_default": "" if first.unset else " | None = None",
        "helpers": _helpers(laws, parts),
        "roots": list({r["name"]: r for r in shown}.values()),
        "tables": list({r["name"]: r for r in rows}.values()),
    }


def _declared(about: Facts, parts: list[_Part], target: Target) -> dict[str, object]:
    """What the programs of a file share: parameters, samples, residuals."""
    first, program = parts[0], parts[0].program
    fields: dict[str, Field] = {}
    for field in (f for p in parts for f in p.program.params):
        fields.setdefault(field.name, field)
    title = listing.harmless(program.title, target)
    source = listing.harmless(program.source, target)
    text = f"Generated by bondgraph from {source}: change the model, not this file."
    said = [textwrap.wrap(p, target.width) for p in (title, text) if p]
    return {
        "about": [line for at, part in enumerate(said) for line in (*[""] * (at > 0), *part)],
        "sample_time": digits(1.0 / program.rate),
        "bandwidth": digits(program.bandwidth),
        "parameters": first.parameters(list(fields.values())),
        "samples": first.struct(samples(program, first.spelling), "no signals"),
        "residuals": first.members(
            [
                (f"{first.spelling.residuals[r.name]}: float = 0.0", about_residual(r))
                for r in program.residuals
            ]
        ),
        "encoders": any(p.spelling.encoders for p in parts),
        "checks": first.checks(about),
    }


def _imports(parts: list[_Part], decides: bool) -> list[str]:
    encoders = any(p.spelling.encoders for p in parts)
    found = ["from dataclasses import dataclass" + (", field" * encoders)]
    exact = [p for p in parts if p.program.exact]
    if decides or any(k.highest >= 1 for p in exact for k in p.program.knowns):
        found.insert(0, "from collections.abc import Sequence")
    return ["import math", *found]


def _helpers(laws: frozenset[str], parts: list[_Part]) -> list[str]:
    laws |= {"table"} if "along" in laws else set()
    found = [name for name in _HELPERS if name in laws]
    wanted = {
        "exponential": any(exponential(p.program) for p in parts),
        "dot": any(isinstance(s, Dot) for p in parts for s in p.program.exact),
        "tape": any(p.tapes for p in parts),
        "line": any(p.spelling.lines for p in parts),
    }
    return found + [name for name, needed in wanted.items() if needed]


class _Part:
    """One program of a file: residuals, thresholds, or `exact`."""

    def __init__(self, program: Program, spelling: Spelling) -> None:
        self.program = program
        self.target = spelling.target
        self.spelling = spelling
        self.tapes = [s for s in program.configure if isinstance(s, PolynomialTape)]
        self.unset = any(f.default is None for f in program.params)

    def core(self) -> dict[str, object]:
        """The holes of core.py.j2."""
        program, blocks = self.program, self.spelling.blocks
        kind = "Threshold" if program.bounds else ""
        lines = self.spelling.lines
        states = [(f"{self.spelling.states[f.name]}: float", f.doc) for f in program.states]
        return {
            **self._configure(),
            **self._lines(f"{kind}Signals"),
            "kind": kind,
            "class_name": "Thresholds" if program.bounds else "Monitor",
            "noun": "thresholds" if program.bounds else "residuals",
            "memory": self.members(states),
            "attributes": self._attributes(kind),
            "signals": self.struct(signals(program, self.spelling), "no signals"),
            "taken": f"{kind}Signals" if lines else "Samples",
            "encoder_fields": self._encoders(),
            "step": self._step(),
            "blocks": [self._block(k, b) for k, b in enumerate(blocks)],
            "block_count": len(blocks),
        }

    # ----------------------------------------------------------------- declarations

    def members(self, pairs: list[tuple[str, str]]) -> list[str]:
        """Fields of a class, with what they are."""
        return listing.members(pairs, self.target, 4)

    def parameters(self, fields: list[Field]) -> list[str]:
        """The fields of the class of parameters."""
        pairs = []
        for field in fields:
            value = "" if field.default is None else f" = {digits(field.default)}"
            pairs.append((f"{self.spelling.params[field.name]}: float{value}", about_field(field)))
        return self.members(pairs) if pairs else ["    # the code reads none"]

    def struct(self, found: Iterable[Member], none: str) -> list[str]:
        """Signals as fields of a class."""
        pairs = []
        for member in found:
            kind = _TYPES[member.type]
            if member.size:
                kind = f"Sequence[{kind}]"
            pairs.append((f"{member.name}: {kind}", member.text))
        return self.members(pairs) if pairs else [f"    # the model has {none}"]

    def _lines(self, kind: str) -> dict[str, object]:
        """The memory of past values: how long it is, what is kept in it and what recalled."""
        spelling = self.spelling
        back = [
            (k, past) for k, line in enumerate(spelling.lines.values()) for past in line.past
        ]
        names = [m.name for m in samples(self.program, spelling)]
        return {
            "lines": " ".join(f"_Line({line.length})," for line in spelling.lines.values()),
            "ages": [f"{digits(past.seconds)} / sample_time," for _, past in back],
            "kept": [
                f"self._lines[{k}].keep(samples.{spelling.knowns[name]})"
                for k, name in enumerate(spelling.lines)
            ],
            "signals_class": kind,
            "recall": [f"{name}=samples.{name}," for name in names]
            + [
                f"{spelling.knowns[past.known.name]}=self._lines[{k}].recalled(self._back[{j}]),"
                for j, (k, past) in enumerate(back)
            ],
        }

    def _encoders(self) -> list[str]:
        members = {b.name: joined(b.residuals) for b in self.spelling.blocks}
        return self.members(
            [
                (f"{name}: Encoder = field(default_factory=Encoder)", f"for {members[block]}")
                for (block, _), name in self.spelling.encoders.items()
            ]
        )

    # -------------------------------------------------------------------- configure

    def _configure(self) -> dict[str, object]:
        program, spelling = self.program, self.spelling
        speller = CodeSpeller(self.target.configure, spelling.value, spelling.tables)
        read = reads(program.configure)
        options = {ref.name for ref in read if ref.space == "option"}
        arguments, values = ["self"], []
        if any(ref.space == "param" for ref in read):
            arguments.append("p: Parameters" if not program.exact else "p: m.Parameters")
            values.append("p")
        arguments += [f"{name}: float" for name in _OPTIONS if name in options]
        values += [
            name if name != "time_unit" or program.exact else digits(program.time_unit)
            for name in _OPTIONS
            if name in options
        ]
        body = lines(program.configure, spelling, speller, 8, self._tape)
        head = ["        c = self._c", ""] if program.coefs else []
        coefs = [
            (f"{spelling.coefs[f.name]}: {'list[float]' if f.size else 'float'}", f.doc)
            for f in program.coefs
        ]
        return {
            "coefficients": self.members(coefs),
            "configure_head": _head("_configure", arguments, self.target),
            "configure_values": ", ".join(values),
            "configure": [*head, *body] or ["        # the model needs no coefficients"],
            "coefficients_are_finite": self._coefficients_are_finite(),
            "parameters_are_finite": self.parameters_are_finite(),
            "settle": self._settle(),
        }

    def _attributes(self, kind: str) -> list[str]:
        found = []
        if self.program.coefs:
            found.append(f"        self._c = {kind}Coefficients()")
        if self.program.states:
            found.append(f"        self._x = {kind}Memory()")
        if self.spelling.encoders:
            found.append(f"        self._e = {kind}Encoders()")
        return found

    def parameters_are_finite(self) -> list[str]:
        """What refuses parameters that are no numbers."""
        params = [f"p.{self.spelling.params[f.name]}" for f in self.program.params]
        if not params:
            return []
        own = "m.Parameters" if self.program.exact else "Parameters"
        given = "parameters" if self.unset else f"parameters or {own}()"
        return [
            f"        p = {given}",
            *self._if("not math.isfinite({0})", params, 8),
            '            raise ValueError("a parameter is not a finite number")',
        ]

    def checks(self, about: Facts) -> list[str]:
        """What refuses a bad sample time or bandwidth."""
        least, fastest = about.least_sample_time, digits(about.fastest)
        limit = f">= {digits(least)}" if least else "> 0.0"
        return [
            f"    if not (sample_time {limit} and math.isfinite(sample_time)):",
            f'        raise ValueError("sample_time must be finite and {limit} s")',
            f"    if not {digits(SLOWEST)} <= bandwidth * sample_time <= {fastest}:",
            "        raise ValueError("
            f'"bandwidth * sample_time must be {digits(SLOWEST)} to {fastest}")',
        ]

    def _coefficients_are_finite(self) -> list[str]:
        names = [
            f"self._c.{self.spelling.coefs[f.name]}{'[0]' if f.size else ''}"
            for f in self.program.coefs
        ]
        if not names:
            return []
        test = self._if("not math.isfinite({0})", names, 12)
        return [*test, '                raise ValueError("not finite")']

    def _if(self, test: str, names: list[str], indent: int) -> list[str]:
        head = f"if {test}:".replace("{0}", "\1").replace("{", "{{").replace("\1", "{0}")
        total = " + ".join(names)
        if len(" " * indent + head.format(total)) <= self.target.width:
            return [" " * indent + head.format(total)]
        *_, last = (head.format("\0")).split("\0")
        inner = listing.statement("{0}", total, self.target, indent + 4)
        inner = inner[1:-1] if inner[0].strip() == "(" else inner
        first = " " * indent + head.format("\0").split("\0")[0]
        return [first, *inner, " " * indent + last]

    def _settle(self) -> list[str]:
        owner = {r: at for at, block in enumerate(self.spelling.blocks) for r in block.residuals}
        rows = [
            f'("{r.name}", {owner[r.name]}, '
            f"math.ceil({digits(r.settle)} / (bandwidth * sample_time){self._begun(r)})),"
            for r in self.program.residuals
            if r.name in owner and not r.unavailable
        ]
        if not rows:
            return []
        space = " " * 8
        return [
            f"{space}# a residual is valid when its block has seen more samples than it needs",
            f"{space}self._settle = (",
            *[f"{space}    {row}" for row in rows],
            f"{space})",
        ]

    def _begun(self, info: ResidualInfo) -> str:
        """The samples until laws begin, to be added."""
        return f" + 1.0 / self._c.{self.spelling.coefs[info.begins]}" if info.begins else ""

    # ------------------------------------------------------------------------- tapes

    def _tape(self, tape: PolynomialTape, speller: CodeSpeller) -> list[str]:
        coef = self.target.reference["coef"]
        scales = [speller.expression(s) for s in tape.scales]
        body = [
            "scales = (",
            *[f"    {line}" for line in listing.table([*scales, ""], self.target, 0)],
            ")",
            f"rows = _run_tape({_tape_name(tape)}, {_tape_name(tape)}_RUNS, scales, {tape.rows},"
            f" {tape.length})",
        ]
        for output in tape.outputs:
            array = coef.format(self.spelling.coefs[output.array])
            body.append(f"{array} = rows[{output.row}][:{output.length}]")
        why = listing.words(listing.place(tape.origin), tape.comment or tape.residual)
        return [*listing.comment(why, self.target, 8), *[f"        {line}" for line in body]]

    # ---------------------------------------------------------------- exact and step

    def exact(self) -> list[str]:
        """The body of exact."""
        spelling = self.spelling
        speller = CodeSpeller(self.target.dialect, spelling.exact, spelling.tables)
        written = [r for r in self.program.residuals if not r.unwritten]
        names = ", ".join(f'"{r.name}"' for r in written)
        call = "r = m.Residuals(valid=frozenset({0}))"
        head = listing.statement(call, f"[{names}]", self.target, 8)
        if any(ref.space == "coef" for ref in reads(self.program.exact)):
            head.insert(0, "        c = self._c")
        body = lines(self.program.exact, spelling, speller, 8)
        for info in self.program.residuals:
            if info.unwritten:
                why = listing.words(listing.place(info.origin), f"{info.name}: {info.unwritten}")
                body += ([""] if body else []) + listing.comment(why, self.target, 8)
                body.append(f"        r.{spelling.residuals[info.name]} = math.nan")
        return [*head, "", *body]

    def _step(self) -> list[str]:
        found = [f"        self._run_{block.name}(s, r)" for block in self.spelling.blocks]
        if self._settle():
            found += [
                "        r.valid = frozenset(",
                "            name for name, block, settle in self._settle "
                "if self._age[block] > settle",
                "        )",
            ]
        return found + self._opened()

    def _opened(self) -> list[str]:
        """What takes back the validity of residuals that started anew a moment ago."""
        rows = [f'("{name}", "{state}"),' for name, state in self.spelling.progress.items()]
        if not rows:
            return []
        return [
            "        # one that a switch has started anew has to come to 1 first",
            "        begun = (",
            *[f"            {row}" for row in rows],
            "        )",
            "        r.valid -= {",
            "            name for name, state in begun "
            "if name in r.valid and not getattr(self._x, state) >= 1.0",
            "        }",
        ]

    def _block(self, number: int, block: Block) -> dict[str, object]:
        spelling, target = self.spelling, self.target
        infos = spelling.infos(block)
        unheard = [f"s.{name}" for name in spelling.unheard(block)]
        results = [f"r.{spelling.residuals[r]}" for r in block.residuals]
        return {
            "name": block.name,
            "number": number,
            "comment": listing.comment("\n".join(block_text(infos)), target, 4),
            "run": self._run(block, infos),
            "finite": self._if("not math.isfinite({0})", [*unheard, *results], 12),
            "zero": [f"            {name} = 0.0" for name in results],
            "names": joined(block.residuals),
        }

    def _run(self, block: Block, infos: list[ResidualInfo]) -> list[str]:
        spelling = self.spelling
        speller = CodeSpeller(
            self.target.dialect, lambda ref: spelling.value(ref, block.name), spelling.tables
        )
        spaces, head = block.spaces, list[str]()
        if "coef" in spaces:
            head.append("            c = self._c")
        if "state" in spaces:
            head.append("            x = self._x")
        counts = spelling.counted(block)
        if block.run.asks or counts:
            head.append("            first = age == 0")
        head += [
            f"            self._e.{memory}.count_on(s.{member}, first)" for memory, member in counts
        ]
        if spaces & {"increment", "total"}:
            head.append("            e = self._e")
        body = procedure(block.run, spelling, speller, 12, block_about(infos))
        return [*head, *([""] if head else []), *body]


def _tape_tables(tape: PolynomialTape, target: Target) -> list[dict[str, object]]:
    ops, runs = repeated(tape.ops)
    lines = [
        f"({o.target}, {o.source}, {o.shift}, {o.scale}, {o.length}, {o.fresh})" for o in ops
    ]
    return [
        {
            "comment": "target, source, shift, scale, length, fresh: see _run_tape",
            "name": _tape_name(tape),
            "lines": listing.table([*lines, ""], target, 4),
        },
        {
            "comment": "first, count, times, grow",
            "name": f"{_tape_name(tape)}_RUNS",
            "lines": listing.table([*[str(tuple(run)) for run in runs], ""], target, 4),
        },
    ]


_SCALED = ";\n\n    derivative k times time_unit to the power k."


def _head(name: str, arguments: list[str], target: Target) -> list[str]:
    """The first line of a method, or its first lines where one is too short."""
    whole = f"    def {name}({', '.join(arguments)}) -> None:"
    if len(whole) <= target.width:
        return [whole]
    return [f"    def {name}(", *[f"        {a}," for a in arguments], "    ) -> None:"]


def _tape_name(tape: PolynomialTape) -> str:
    return f"_{tape.residual.upper()}_TAPE"


def _number(value: float) -> str:
    return "math.nan" if math.isnan(value) else digits(value)
