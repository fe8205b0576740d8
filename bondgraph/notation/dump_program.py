"""A residual program as text, in no language: what `dump --stage program` prints."""

from __future__ import annotations

from collections.abc import Iterable
from typing import assert_never

from bondgraph.ir.program import (
    Assign,
    Choice,
    Compare,
    Condition,
    Const,
    Dot,
    Expression,
    Function,
    Logic,
    Mode,
    PolynomialTape,
    Product,
    Program,
    Ref,
    Sum,
)
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
        "",
        "residuals",
    ]
    for info in program.residuals:
        lines.append(
            f"  {info.name}: order {info.order}, {info.stages} stages,"
            f" settled after {info.settle:g} time constants"
        )
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


def _procedure(statements: Iterable[Assign | PolynomialTape | Dot]) -> list[str]:
    rows: list[tuple[str, ...]] = []
    for statement in statements:
        where = "" if statement.origin is None else f"  # {place(statement.origin)}"
        match statement:
            case Assign():
                rows.append((_text(statement.target), f"= {_text(statement.value)}{where}"))
            case Dot():
                terms = [f"{t.array} . D({t.signal}, 0..{t.length - 1})" for t in statement.terms]
                rows.append((_text(statement.target), f"= {' + '.join(terms)}{where}"))
            case PolynomialTape():
                outputs = ", ".join(o.array for o in statement.outputs)
                rows.append((outputs, f"= tape of {len(statement.ops)} steps{where}"))
            case _:
                assert_never(statement)
    return table(rows)


def _text(node: Expression | Condition) -> str:
    match node:
        case Const():
            return repr(node.value)
        case Ref():
            order = f"[{node.order}]" if node.order else ""
            return f"{node.space}.{node.name}{order}"
        case Sum():
            signed = [("+ " if plus else "- ") + _text(term) for plus, term in node.terms]
            return f"({' '.join(signed).removeprefix('+ ')})"
        case Product():
            text = "*".join(_text(f) for f in node.factors) or "1"
            return text + "".join(f"/{_text(d)}" for d in node.divisors)
        case Function():
            return f"{node.name}({', '.join(_text(a) for a in node.args)})"
        case Choice():
            return f"if({_text(node.condition)}, {_text(node.yes)}, {_text(node.no)})"
        case Compare():
            return f"{_text(node.left)} {node.op} {_text(node.right)}"
        case Logic():
            if node.op == "not":
                return f"not {_text(node.args[0])}"
            return f"({f' {node.op} '.join(_text(a) for a in node.args)})"
        case Mode():
            return node.name
        case _:
            assert_never(node)
