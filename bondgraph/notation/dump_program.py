"""A residual program as text, in no language: what `dump --stage program` prints."""

from __future__ import annotations

from collections.abc import Iterable
from typing import assert_never

from bondgraph.ir.program import Assign, Branch, Dot, Mode, PolynomialTape, Program, Ref, Statement
from bondgraph.notation.dialect import PLAIN, CodeSpeller
from bondgraph.notation.dump_stages import place, table


def dump_program(program: Program) -> str:
    """The structs and procedures of a program, statement by statement."""
    lines = [
        f"program {program.name}, {program.rate:g} samples a second,"
        f" bandwidth {program.bandwidth:g} rad/s",
        "",
        "params",
        *table((f.name, f.path, _default(f.default), f.unit) for f in program.params),
        "",
        "knowns",
        *table((k.name, k.kind, f"highest D {k.highest}", k.unit) for k in program.knowns),
        *table((d.known.name, f"{d.of} {d.seconds:g} s ago", f"highest D {d.known.highest}")
               for d in program.delayed),
        "",
        "residuals",
    ]
    for info in program.residuals:
        lines.append(
            f"  {info.name}: order {info.order}, {info.stages} stages,"
            f" settled after {info.settle:g} time constants"
        )
        if info.laws:
            lines[-1] += f"; before laws {info.laws} stages, for {info.held:g} of theirs first"
        notes = [
            ("approximate", info.approximate),
            ("unavailable", info.unavailable),
            ("not in exact", info.unwritten),
            ("invisible", ", ".join(info.invisible)),
        ]
        lines += [f"    {title}: {note}" for title, note in notes if note]
    for opening in program.openings:
        when = f", anew where {' or '.join(opening.modes)} changes" if opening.modes else ""
        lines.append(f"  {opening.residual} is valid when {opening.progress} is 1{when}")
    for title, statements in (
        ("configure", program.configure),
        ("exact", program.exact),
        ("first", program.first),
        ("step", program.step),
    ):
        lines += ["", title, *_procedure(statements)]
    for block in program.roots:
        head = f"root {block.name}({', '.join(block.arguments)}), from x = {block.guess!r}"
        lines += ["", head, *_procedure((*block.body, *block.further))]
        lines += table([("value", f"= {_text(block.value)}"), ("slope", f"= {_text(block.slope)}")])
    if program.dropped:
        lines += ["", "left out of step, cannot be seen at this rate"]
        lines += table((d.residual, f"D({d.signal}, {d.order})", f"{d.share:.1g}")
                       for d in program.dropped)  # fmt: skip
    return "\n".join(lines)


def _default(value: float | None) -> str:
    return "given at configure" if value is None else repr(value)


def _procedure(statements: Iterable[Statement]) -> list[str]:
    return table(_rows(statements))


def _rows(statements: Iterable[Statement], space: str = "") -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = []
    for statement in statements:
        where = "" if statement.origin is None else f"  # {place(statement.origin)}"
        match statement:
            case Assign():
                rows.append((space + _text(statement.target), f"= {_text(statement.value)}{where}"))
            case Branch(target, (condition, x, y), yes, no):
                rows.append((f"{space}if {_text(condition)}{where}",))
                rows += _rows((*yes, Assign(target, x, "", None)), space + "  ")
                rows.append((f"{space}else",))
                rows += _rows((*no, Assign(target, y, "", None)), space + "  ")
            case Dot():
                terms = [f"{t.array} . D({t.signal}, 0..{t.length - 1})" for t in statement.terms]
                rows.append((_text(statement.target), f"= {' + '.join(terms)}{where}"))
            case PolynomialTape():
                outputs = ", ".join(o.array for o in statement.outputs)
                rows.append((outputs, f"= tape of {len(statement.ops)} steps{where}"))
            case _:
                assert_never(statement)
    return rows


def _called(value: Ref | Mode) -> str:
    if isinstance(value, Mode):
        return value.name
    return f"{value.space}.{value.name}" + (f"[{value.order}]" if value.order else "")


_text = CodeSpeller(PLAIN, _called).expression
