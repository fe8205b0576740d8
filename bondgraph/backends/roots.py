"""The blocks of Newton's method as code: what fills the holes of the templates `root.*`."""

from __future__ import annotations

from bondgraph.backends import listing
from bondgraph.backends.procedure_lines import lines
from bondgraph.backends.spelling import Spelling
from bondgraph.ir.program import Assignment, Expression, NewtonBlock, Program
from bondgraph.notation.dialect import CodeSpeller, digits


def roots(
    program: Program, spelling: Spelling, argument: str, indent: int
) -> list[dict[str, object]]:
    """A function for each block, inner ones first; `argument` is the declaration of one."""
    return [_root(block, spelling, argument, indent) for block in program.roots]


def _root(block: NewtonBlock, spelling: Spelling, argument: str, indent: int) -> dict[str, object]:
    target = spelling.target
    speller = CodeSpeller(target.dialect, spelling.value, spelling.tables)

    def part(statements: tuple[Assignment, ...], name: str, value: Expression) -> list[str]:
        prefix = target.statements.local.replace("{0}", name).replace("{1}", "{0}")
        last = listing.statement(prefix, speller.expression(value), target, indent)
        return [*lines(statements, spelling, speller, indent), *last]

    return {
        "name": spelling.tables[f"root:{block.name}"],
        "arguments": ", ".join(argument.format(spelling.locals[a]) for a in block.arguments),
        "x": spelling.locals["x"],
        "guess": digits(block.guess),
        "rising": block.rising,
        "most": block.most,
        "value": part(block.body, "value", block.value),
        "slope": part(block.further, "slope", block.slope),
        "comment": listing.comment(block.comment, target, 0),
    }
