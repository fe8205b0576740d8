"""The statements of a procedure as lines of code, each with the model line it comes from."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from bondgraph.backends import listing
from bondgraph.backends.spelling import Spelling
from bondgraph.ir.program import Assign, Dot, PolynomialTape
from bondgraph.notation.dialect import CodeSpeller


def lines(
    statements: Iterable[Assign | Dot | PolynomialTape],
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
        left = speller.name(statement.target)
        style = target.statements
        pattern = style.local if statement.target.space == "local" else style.assign
        if isinstance(statement, Dot):
            value = _dot(statement, spelling)
        else:
            value = speller.expression(statement.value)
        # only the value is left open: braces of neither side are holes
        prefix = pattern.replace("{0}", left).replace("{1}", "{0}")
        found += listing.statement(prefix, value, target, indent)
    return found


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
