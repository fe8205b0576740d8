"""What configure, exact and step of one program are in C."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cache, cached_property

from bondgraph.backends import listing
from bondgraph.backends.blocks import Block
from bondgraph.backends.c_declarations import Declarations, parameters_of
from bondgraph.backends.c_functions import Functions, Unit, Written
from bondgraph.backends.members import samples, signals
from bondgraph.backends.nominal_coefficients import Nominal, nominal
from bondgraph.backends.one_procedure import Start
from bondgraph.backends.procedure_lines import ANYTHING, About, code_lines, commented
from bondgraph.backends.program_units import grouped, units
from bondgraph.backends.repeated import repeated
from bondgraph.backends.short_functions import parts
from bondgraph.backends.spelling import Spelling
from bondgraph.ir.program import (
    Const,
    Mode,
    PolynomialTape,
    Program,
    Ref,
    ResidualInfo,
    Statement,
)
from bondgraph.notation.dialect import CodeSpeller
from bondgraph.notation.walk import reads
from bondgraph.text.numerals import joined

_ON_STACK = 128  # numbers at most, 1 kB
_OPTIONS = ("sample_time", "bandwidth", "time_unit")


class Code:
    """Writes configure, exact and step of one program; `stem` begins the names of its functions.

    `base` begins those of what it shares with others in the same file, `own` those of static
    functions that another program has as well.
    """

    def __init__(
        self, program: Program, spelling: Spelling, stem: str, base: str = "", own: str = ""
    ) -> None:
        self.program = program
        self.spelling = spelling
        self.target = spelling.target
        self.stem, self.base, self.own = stem, base or stem, own
        self.type = f"{self.base}_real"
        self._configure = CodeSpeller(self.target.configure, self._in_configure, spelling.tables)

    def _in_configure(self, ref: Ref | Mode) -> str:
        if ref == Ref("option", "time_unit") and not self.stem.endswith("_exact"):
            return self.real(self.program.time_unit)  # scales what cancels in step
        return self.spelling.value(ref)

    def real(self, value: float) -> str:
        """A number as a constant of the type `real`."""
        return self._configure.expression(Const(value))

    def number(self, value: float) -> str:
        """A number, or none, as C has it."""
        return "(real)NAN" if math.isnan(value) else self.real(value)

    def core(self) -> dict[str, object]:
        """The holes of core.h.j2 and core.c.j2."""
        program, spelling = self.program, self.spelling
        past = spelling.lines.values()
        return {
            **self._coefficient_lines(),
            **self._structs(),
            **self._counting(),
            "stem": self.stem,
            "base": self.base,
            "own": self.own,
            "run": self._verb,
            "bounds": program.bounds,
            "noun": "thresholds" if program.bounds else "residuals",
            "tapes": [self._tape_table(t) for t in self.tapes],
            "blocks": [self._block(k, b) for k, b in enumerate(spelling.blocks)],
            "block_count": max(1, len(spelling.blocks)),
            "block_names": listing.comment(
                "samples since the start of "
                + ("; ".join(joined(b.residuals) for b in spelling.blocks) or "nothing"),
                self.target,
                4,
            ),
            "unavailable": self._unavailable(),
            "lines": list(range(len(spelling.lines))),
            "recall": self._recall(),
            "ages": [
                f"c->back_{k}_{j} = {self.real(one.seconds)} / sample_time;"
                for k, line in enumerate(past)
                for j, one in enumerate(line.past)
            ],
        }

    # -------------------------------------------------------------------- structs

    def _structs(self) -> dict[str, object]:
        program, spelling, real = self.program, self.spelling, self.type
        coefs = [
            (f"{real} {spelling.coefs[f.name]}{f'[{f.size}]' if f.size else ''};", f.doc)
            for f in program.coefs
        ]
        states = [(f"{real} {spelling.states[f.name]};", f.doc) for f in program.states]
        encoders = [
            (f"{self.base}_encoder {name};", f"{signal}, read by {joined(block.residuals)}")
            for block in spelling.blocks
            for (of, signal), name in spelling.encoders.items()
            if of == block.name
        ]
        past: list[tuple[str, str]] = []
        for k, (name, line) in enumerate(spelling.lines.items()):
            past.append((f"{real} past_{k}[{line.length}];", f"samples of {name}"))
            past.append((f"uint32_t next_{k};", "the place of the next"))
            coefs += [
                (f"{real} back_{k}_{j};", f"{one.seconds:g} s in samples")
                for j, one in enumerate(line.past)
            ]
        kinds = (
            ("encoders", "e", "The encoders, each with the residuals that read it.", encoders),
            ("past", "p", "The last samples of signals that are needed late.", past),
        )
        declared = Declarations([program], spelling, self.base)
        found = None if self._work() else nominal(program)
        coefs += self._work()
        return {
            "coefficients": declared.members(coefs),
            "memory": declared.members(states),
            "parts": [
                {"name": name, "member": member, "doc": doc, "lines": declared.members(pairs)}
                for name, member, doc, pairs in kinds
                if pairs
            ],
            "signals": declared.struct(signals(program, spelling)),
            "taken": self._taken,
            "constants": [] if found is None else self._constants(found),
        }

    def _constants(self, found: Nominal) -> list[str]:
        """The coefficients at the model's own parameters, as the value of their struct."""
        pairs = []
        for field, values in zip(self.program.coefs, found.coefficients, strict=True):
            name = self.spelling.coefs[field.name]
            if field.size:
                pairs.append((f"{{{', '.join(map(self._constant, values))}}},", name))
            else:
                pairs.append((f"{self._constant(values[0])},", name))
        pairs += [(f"{self._constant(back)},", "a delay in samples") for back in found.back]
        ages = ", ".join("UINT32_MAX" if n is None else f"{n}u" for n in found.settle)
        pairs.append((f"{{{ages}}},", "samples until each is valid"))
        known = [n for n in found.settle if n is not None]
        pairs.append((f"{max(known)}u" if known else "UINT32_MAX", "the longest of these"))
        return listing.members(pairs, self.target, 4)

    def _constant(self, value: float) -> str:
        return self.real(value)

    # -------------------------------------------------------------------- configure

    def _coefficient_lines(self) -> dict[str, object]:
        program, spelling = self.program, self.spelling
        coefs = [f"c->{spelling.coefs[f.name]}{'[0]' if f.size else ''}" for f in program.coefs]
        read = reads(program.configure)
        pairs = [(f"{self.stem}_coefficients *c", "c")]
        if any(ref.space == "param" for ref in read):
            pairs.append((f"const {self.base}_parameters *p", "parameters"))
        used = {ref.name for ref in read if ref.space == "option"}
        if not self.stem.endswith("_exact"):
            used -= {"time_unit"}
        pairs += [(f"real {name}", name) for name in _OPTIONS if name in used]
        head = f"static void {self.own}compute_coefficients({{0}})"
        written = self._computed([declared for declared, _ in pairs])
        return {
            "coefficient_head": listing.statement(
                head, ", ".join(a for a, _ in pairs), self.target, 0
            ),
            "coefficient_values": ", ".join(v for _, v in pairs),
            "coefficient_pieces": written.functions,
            "configure": written.body or ["    (void)c;"],
            "coefficients_are_finite": self._finite("return", coefs, "c"),
            "settle": [
                line for r in program.residuals if not r.unavailable for line in self._settle(r)
            ],
        }

    def _computed(self, arguments: Sequence[str]) -> Written:
        """What computes the coefficients from these arguments, in parts if it is long."""
        named = {declared.split("*")[-1].split()[-1]: declared for declared in arguments}
        name, program = f"{self.own}compute", self.program
        own, write = self._statements(program.configure, self._configure, tape=self._tape)
        functions = self._functions(named, noun="coefficients")
        whole = functions.whole(own, write)
        if whole is not None:
            return whole
        rows = grouped(program.configure)
        keyed = [own[at]._replace(key=key) for key, at in rows]

        def write_rows(numbers: Sequence[int], indent: int) -> list[list[str]]:
            return write([rows[k][1] for k in numbers], indent)

        return functions.procedure(name, keyed, write_rows, cut=parts)

    def _settle(self, info: ResidualInfo) -> list[str]:
        prefix = f"c->settle[{self._number(info.name)}] ="
        wait = self.real(info.settle)
        if info.begins:
            coef = self.spelling.coefs[info.begins]
            wait += f" + bandwidth * sample_time / c->{coef}"
        call = f"samples({wait}, sample_time, bandwidth);"
        if len(prefix) + len(call) + 5 <= self.target.width:
            return [f"    {prefix} {call}"]
        return [f"    {prefix}", f"        {call}"]

    def nominal(self, programs: Sequence[Program]) -> list[str]:
        """The body of the function that sets the parameters to those of the model."""
        pairs: list[tuple[str, str]] = []
        for field in parameters_of(programs):
            value = "(real)NAN" if field.default is None else self.real(field.default)
            unit = field.unit if field.default is not None else f"{field.unit} yours to set"
            name = self.spelling.params[field.name]
            pairs.append((f"parameters->{name} = {value};", unit.strip()))
        return listing.members(pairs, self.target, 4) if pairs else ["    (void)parameters;"]

    def parameters_are_finite(self) -> list[str]:
        """Whether all parameters are numbers, as a statement."""
        params = [f"p->{self.spelling.params[f.name]}" for f in self.program.params]
        return self._finite("const bool finite =", params, "p")

    def _finite(self, prefix: str, names: list[str], unused: str) -> list[str]:
        if not names:
            before = [] if prefix != "return" else [f"    (void){unused};"]
            after = [] if prefix == "return" else [f"    (void){unused};"]
            return [*before, f"    {prefix} true;", *after]
        total = " + ".join(names)
        return listing.statement(f"{prefix} finite_number({{0}});", total, self.target, 4)

    # ------------------------------------------------------------------------- tapes

    @property
    def tapes(self) -> list[PolynomialTape]:
        """The polynomial tapes of configure."""
        return [s for s in self.program.configure if isinstance(s, PolynomialTape)]

    def _tape_table(self, tape: PolynomialTape) -> dict[str, object]:
        ops, runs = repeated(tape.ops)
        rows = [
            f"{{{o.target}, {o.source}, {o.shift}, {o.scale}, {o.length}, {str(o.fresh).lower()}}}"
            for o in ops
        ]
        why = listing.words(listing.place(tape.origin), tape.comment or tape.residual)
        return {
            "comment": listing.harmless(why, self.target),
            "name": f"{tape.residual}_tape",
            "length": len(rows),
            "lines": listing.table(rows, self.target, 4),
            "run_count": len(runs),
            "runs": listing.table([f"{{{', '.join(map(str, r))}}}" for r in runs], self.target, 4),
        }

    def _tape(self, tape: PolynomialTape, speller: CodeSpeller) -> list[str]:
        scales = [speller.expression(s) for s in tape.scales]
        coef = self.target.reference["coef"]
        size, name = tape.rows * tape.length, f"{tape.residual}_tape"
        if _work(tape):
            body = [
                f"real *rows = c->{tape.residual}_work;",
                f"real *scales = rows + {size};",
                "",
                *[f"scales[{k}] = {scale};" for k, scale in enumerate(scales)],
            ]
        else:
            body = [
                "const real scales[] = {",
                *listing.table(scales, self.target, 4),
                "};",
                f"real rows[{size}];",
                "",
            ]
        body += [
            f"run_tape({name}, {name}_runs, {len(repeated(tape.ops)[1])}, scales, rows,"
            f" {tape.rows}, {tape.length});",
        ]
        for output in tape.outputs:
            array = coef.format(self.spelling.coefs[output.array])
            body.append(f"keep({array}, &rows[{output.row * tape.length}], {output.length});")
        return ["    {", *[f"        {line}" if line else "" for line in body], "    }"]

    def _work(self) -> list[tuple[str, str]]:
        """What configure needs that is too large for a stack, as members of the coefficients."""
        return [
            (f"{self.type} {tape.residual}_work[{size}];", "for configure")
            for tape in self.tapes
            if (size := _work(tape))
        ]

    # ---------------------------------------------------------------- exact and step

    def exact(self) -> dict[str, object]:
        """The holes of exact: its body, and the functions that it calls."""
        speller = CodeSpeller(self.target.dialect, self.spelling.exact, self.spelling.tables)
        spaces = {ref.space for ref in reads(self.program.exact)}
        head: list[str] = []
        unused: list[str] = []
        if "coef" in spaces:
            head.append(f"    const {self.stem}_coefficients *c = coefficients;")
        else:
            unused.append("    (void)coefficients;")
        if spaces & {"known", "start", "integral", "time"}:
            head.append(f"    const {self.base}_derivatives *d = derivatives;")
        else:
            unused.append("    (void)derivatives;")
        head.append("    real *r = residuals;")
        refused: list[str] = []
        for info in self.program.residuals:
            if info.unwritten:
                why = listing.words(listing.place(info.origin), f"{info.name}: {info.unwritten}")
                refused += ["", *listing.comment(why, self.target, 4)]
                refused.append(f"    r[{self._number(info.name)}] = (real)NAN;")
        head += [*([""] if unused else []), *unused]
        arguments = {
            "c": f"const {self.stem}_coefficients *c",
            "d": f"const {self.base}_derivatives *d",
            "r": "real *r",
        }
        statements = self._statements(self.program.exact, speller)
        around = len(head) + 1 + len(refused)
        written = self._functions(arguments).procedure("exact", *statements, around)
        body = ["", *written.body] if written.body else []
        return {"exact": [*head, *body, *refused], "exact_pieces": written.functions}

    def _recall(self) -> list[str]:
        """How step makes its signals from a sample."""
        spelling = self.spelling
        found = [f"s->{m.name} = samples->{m.name};" for m in samples(self.program, spelling)]
        for k, (name, line) in enumerate(spelling.lines.items()):
            place = f"p->past_{k}, {line.length}u, {{0}}p->next_{k}"
            found.append(f"remember({place.format('&')}, s->{spelling.knowns[name]});")
            found += [
                f"s->{spelling.knowns[one.known.name]} = "
                f"recalled({place.format('')}, c->back_{k}_{j});"
                for j, one in enumerate(line.past)
            ]
        return found

    def _block(self, number: int, block: Block) -> dict[str, object]:
        """The holes of block.c.j2."""
        spelling, target = self.spelling, self.target
        infos = self.spelling.infos(block)
        about = block_about(infos)
        speller = CodeSpeller(
            target.dialect, lambda ref: spelling.value(ref, block.name), spelling.tables
        )
        counts = spelling.counted(block)
        spaces, head = block.spaces, list[str]()
        if block.run.asks or counts:
            head.append(f"const bool first = x->youngest == 0u && x->age[{number}] == 0u;")
        run = [f"    count_on(&x->e.{memory}, s->{member}, first);" for memory, member in counts]
        run += [""] if run else []
        around = len(head) + bool(spaces & {"increment", "total"})
        written = self._run(block, speller, about, around + bool(around) + len(run))
        if "e" in written.uses:
            head.append(f"const {self.stem}_encoders *e = &x->e;")
        unused = [name for name, is_used in (
            ("c", "coef" in spaces), ("x", "state" in spaces or bool(head) or bool(counts)),
            ("s", bool(block.knowns)),
        ) if not is_used]  # fmt: skip
        if unused:
            run = [*(f"    (void){name};" for name in unused), "", *run]
        title = f"{joined(block.residuals)} on one sample."
        return {
            "name": block.name,
            "number": number,
            "comment": listing.comment("\n".join([title, *block_text(infos)]), target, 0),
            "head": head,
            "pieces": written.functions,
            "run": [*run, *written.body],
        }

    def _run(self, block: Block, speller: CodeSpeller, about: About, around: int) -> Written:
        """What a block does with a sample, in a function with so many lines around that."""
        arguments = {
            "c": f"const {self.stem}_coefficients *c",
            "x": f"{self.stem}_memory *x",
            "s": f"const {self._taken} *s",
            "r": "real *r",
            "first": "bool first",
        }
        encoders = {"e": f"    const {self.stem}_encoders *e = &x->e;"}
        functions = self._functions(arguments, encoders)
        name, run = f"{self._verb}_{block.name}", block.run
        if not run.apart:
            statements = self._statements(run.statements, speller, about)
            return functions.procedure(name, *statements, around)
        sides = tuple(
            (f"{name}_{way}", *self._statements(statements, speller, about))
            for way, statements in (("first", run.apart), ("next", run.statements))
        )
        if_, else_, end = self.target.statements.branch
        return functions.choice((if_.format("first"), else_, end), sides, around)

    @property
    def _verb(self) -> str:
        """What the functions of blocks begin with."""
        return "bound" if self.own else "run"

    @property
    def _taken(self) -> str:
        """The type of what a block takes: samples, or signals with what they were."""
        return f"{self.stem}_signals" if self.spelling.lines else f"{self.base}_samples"

    def _functions(
        self,
        arguments: Mapping[str, str],
        heads: Mapping[str, str] | None = None,
        noun: str = "a part",
    ) -> Functions:
        return Functions(self.target, "real", arguments, self._reserved, heads, noun)

    @cached_property
    def _reserved(self) -> set[str]:
        """The names of functions that there are whatever is cut into parts."""
        taken = {f"{self._verb}_{block.name}" for block in self.spelling.blocks}
        return taken | {*self.spelling.tables.values(), f"{self.own}compute_coefficients"}

    def _statements(
        self,
        statements: Sequence[Statement | Start],
        speller: CodeSpeller,
        about: About = ANYTHING,
        tape: Callable[[PolynomialTape, CodeSpeller], list[str]] | None = None,
    ) -> tuple[list[Unit], Callable[[Sequence[int], int], list[list[str]]]]:
        """Statements as what functions are made of, and what writes some of them."""

        @cache
        def codes(indent: int) -> list[list[str]]:
            return [code_lines(s, self.spelling, speller, indent, tape) for s in statements]

        def write(numbers: Sequence[int], indent: int) -> list[list[str]]:
            own = [statements[k] for k in numbers], [codes(indent)[k] for k in numbers]
            return commented(*own, self.target, indent, about)

        return units(statements, speller, about.prefix), write

    def _counting(self) -> dict[str, object]:
        """The holes of count.c.j2: what is computed, what goes with what, what has to be finite."""
        spelling, target = self.spelling, self.target
        blocks = spelling.blocks
        places = {r: at for at, block in enumerate(blocks) for r in block.residuals}
        order = {r.name: at for at, r in enumerate(self.program.residuals)}
        computed = [name for name in order if name in places]
        unheard = [[f"s->{name}" for name in spelling.unheard(block)] for block in blocks]
        starts = []
        for at, names in enumerate(unheard):
            value = f"finite_number({' + '.join(names)})" if names else "true"
            starts += listing.statement(f"finite[{at}] = {{0}};", value, target, 4)
        progress = [
            f"out->valid[{self._number(r)}] = out->valid[{self._number(r)}]"
            f" && x->{state} >= {self.real(1.0)};"
            for r, state in spelling.progress.items()
        ]
        whole = len(computed) == len(order) and not progress
        names = [f"r[{self._number(r)}]" for r in computed] + [n for ns in unheard for n in ns]
        settled = "if (x->youngest > c->longest && finite_number({0})) \1"
        rows = listing.statement(settled, " + ".join(names), target, 4)
        waits = [r for r in self.program.residuals if not r.unavailable]
        waits.sort(key=lambda r: (r.settle, r.held), reverse=True)
        longest = waits[0] if waits and waits[0].held == max(r.held for r in waits) else None
        return {
            "index_type": "uint8_t" if len(order) < 256 else "uint16_t",
            "numbers": listing.table([str(order[r]) for r in computed], target, 8),
            "block_of": listing.table([str(places[r]) for r in computed], target, 8),
            "computed": len(computed),
            "unheard": starts,
            "hears": any(unheard),
            "progress": progress,
            "all_settled": [row.replace("\1", "{") for row in rows] if whole else [],
            "longest": "" if longest is None else f"c->settle[{self._number(longest.name)}]",
        }

    def _unavailable(self) -> list[str]:
        """The numbers of the residuals that step never computes."""
        owned = {r for block in self.spelling.blocks for r in block.residuals}
        return [self._number(r.name) for r in self.program.residuals if r.name not in owned]

    def _number(self, residual: str) -> str:
        return self.spelling.prefix + self.spelling.numbers[residual]


def _work(tape: PolynomialTape) -> int:
    """The numbers that a tape needs besides its results, 0 where a stack can hold them."""
    size = tape.rows * tape.length + len(tape.scales)
    return size if size > _ON_STACK else 0


def block_about(infos: Sequence[ResidualInfo]) -> About:
    """What the comments of a block need not say, since the one above it does."""
    info = infos[0]
    place = listing.place(info.origin)
    return About(place, info.text, f"{info.name}: ") if len(infos) == 1 else About("", "", "")


def block_text(infos: Sequence[ResidualInfo]) -> list[str]:
    """What a block computes: each residual with its place in the model."""
    return [listing.words(listing.place(r.origin), r.text or r.name) for r in infos]
