"""The statements of a procedure as lines of code, each with the model line it comes from."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from bondgraph.backends import listing
from bondgraph.backends.spelling import Spelling
from bondgraph.ir.program import Assignment, Branch, Dot, Expression, PolynomialTape, Ref, Statement
from bondgraph.notation.dialect import CodeSpeller


def lines(
    statements: Iterable[Statement],
    spelling: Spelling,
    speller: CodeSpeller,
    indent: int,
    tape: Callable[[PolynomialTape, CodeSpeller], list[str]] | None = None,
) -> list[str]:
    """The code; statements that come from the same equation share one comment above them.

    `tape` writes a polynomial tape, which each language does in its own way.
    """
    target = spelling.target
    found: list[str] = []
    last = ""
    for statement in statements:
        why = listing.words(listing.place(statement.origin), statement.comment)
        if why and why != last:
            found += ([""] if found else []) + listing.comment(why, target, indent)
        last = why
        if isinstance(statement, PolynomialTape):
            assert tape is not None, "a tape stands only in configure"
            found += tape(statement, speller)
            continue
        style = target.statements
        if isinstance(statement, Branch):
            found += _branch(statement, spelling, speller, indent)
            continue
        pattern = style.local if statement.target.space == "local" else style.assign
        if isinstance(statement, Dot):
            value = _dot(statement, spelling)
        else:
            value = speller.expression(statement.value)
        found += _assigned(pattern, statement.target, value, spelling, speller, indent)
    return found


def _assigned(
    pattern: str, left: Ref, value: str, spelling: Spelling, speller: CodeSpeller, indent: int
) -> list[str]:
    # only the value is left open: braces of neither side are holes
    prefix = pattern.replace("{0}", speller.name(left)).replace("{1}", "{0}")
    return listing.statement(prefix, value, spelling.target, indent)


def _branch(branch: Branch, spelling: Spelling, speller: CodeSpeller, indent: int) -> list[str]:
    target = spelling.target
    style, space = target.statements, " " * indent

    def side(statements: tuple[Assignment, ...], value: Expression) -> list[str]:
        deeper = indent + target.tab
        before = lines(statements, spelling, speller, deeper)
        text = speller.expression(value)
        last = _assigned(style.assign, branch.target, text, spelling, speller, deeper)
        return [*before, "", *last] if before else last

    if_, else_, end = style.branch
    found = [space + style.declared.format(speller.name(branch.target))] if style.declared else []
    found += listing.statement(if_, speller.expression(branch.value.condition), target, indent)
    found += [*side(branch.yes, branch.value.yes), space + else_]
    found += side(branch.no, branch.value.no)
    return [*found, space + end] if end else found


def _dot(statement: Dot, spelling: Spelling) -> str:
    pattern = spelling.target.reference
    texts: list[str] = []
    for term in statement.terms:
        array = pattern["coef"].format(spelling.coefs[term.array])
        member = pattern["derivative"].format(spelling.inputs[term.signal, ""])
        several = spelling.has_derivatives(term.signal)
        signal = pattern["many" if several else "one"].format(member)
        texts.append(spelling.target.statements.dot.format(array, signal, term.length))
    return " + ".join(texts) or spelling.target.dialect.constant.format("0.0")
