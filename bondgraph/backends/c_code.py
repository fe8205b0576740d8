"""The procedures of the residual program as lines of C."""

from __future__ import annotations

from collections.abc import Iterable

from bondgraph.backends import listing
from bondgraph.backends.blocks import Block
from bondgraph.backends.procedure_lines import lines
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.walk import reads
from bondgraph.ir.program import (
    Assignment,
    Const,
    PolynomialTape,
    Program,
    Ref,
    ResidualInfo,
    Statement,
)
from bondgraph.notation.dialect import CodeSpeller
from bondgraph.text.numerals import joined

_OPTIONS = ("sample_time", "bandwidth", "time_unit")


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
