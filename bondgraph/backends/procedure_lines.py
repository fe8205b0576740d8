"""The statements of a procedure as lines of code, each with the model line it comes from.

So are the blocks of Newton's method, which fill the holes of the templates `root.*`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from bondgraph.backends import listing
from bondgraph.backends.one_procedure import Procedure, Start
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import Target
from bondgraph.ir.program import (
    Assignment,
    Branch,
    Dot,
    Expression,
    NewtonBlock,
    PolynomialTape,
    Program,
    Ref,
    Statement,
)
from bondgraph.notation.dialect import CodeSpeller, digits
from bondgraph.text.tuples import NamedTuple


class About(NamedTuple):
    """What a function is about: a `place`, the `text` of its residual, a `prefix` of comments."""

    place: str
    text: str
    prefix: str


ANYTHING = About("", "", "")


def lines(
    statements: Sequence[Statement | Start],
    spelling: Spelling,
    speller: CodeSpeller,
    indent: int,
    tape: Callable[[PolynomialTape, CodeSpeller], list[str]] | None = None,
    about: About = ANYTHING,
) -> list[str]:
    """The code; statements that come from the same equation share one comment above them.

    `tape` writes a polynomial tape, which each language does in its own way. What the function is
    `about` anyway is not said again.
    """
    own = [code_lines(s, spelling, speller, indent, tape) for s in statements]
    found = commented(statements, own, spelling.target, indent, about)
    return [line for lines in found for line in lines]


def code_lines(
    statement: Statement | Start,
    spelling: Spelling,
    speller: CodeSpeller,
    indent: int,
    tape: Callable[[PolynomialTape, CodeSpeller], list[str]] | None = None,
) -> list[str]:
    """The lines of one statement, without the comment above them."""
    style = spelling.target.statements
    match statement:
        case Start():
            return _start(statement, spelling, speller, indent)
        case PolynomialTape():
            assert tape is not None, "a tape stands only in configure"
            return tape(statement, speller)
        case Branch():
            return _branch(statement, spelling, speller, indent)
        case Dot():
            value = _dot(statement, spelling)
        case _:
            value = speller.expression(statement.value)
    pattern = style.local if statement.target.space == "local" else style.assign
    return _assigned(pattern, statement.target, value, spelling, speller, indent)


def commented(
    statements: Sequence[Statement | Start],
    codes: Sequence[list[str]],
    target: Target,
    indent: int,
    about: About = ANYTHING,
) -> list[list[str]]:
    """The lines of each of some statements behind each other, with the comments above them."""
    found: list[list[str]] = []
    last, last_place = "", about.place
    for statement, own in zip(statements, codes, strict=True):
        head = [""] if found else []
        if isinstance(statement, Start):
            found.append(head + own)
            last = ""
            continue
        place = listing.place(statement.origin)
        comment = "" if statement.comment == about.text else statement.comment
        comment = comment.removeprefix(about.prefix)
        why = listing.words("" if place == last_place else place, comment)
        if comment == last and head:
            head = []
        elif why:
            head += listing.comment(why, target, indent)
        last, last_place = comment, place
        found.append(head + own)
    return found


def procedure(
    run: Procedure, spelling: Spelling, speller: CodeSpeller, indent: int, about: About
) -> list[str]:
    """What a block does with a sample."""
    if not run.apart:
        return lines(run.statements, spelling, speller, indent, about=about)
    target = spelling.target
    space, deeper = " " * indent, indent + target.tab
    if_, else_, end = target.statements.branch
    sides = [lines(s, spelling, speller, deeper, about=about) for s in (run.apart, run.statements)]
    return [
        space + if_.format("first"),
        *sides[0],
        space + else_,
        *sides[1],
        *([space + end] if end else []),
    ]


def _start(start: Start, spelling: Spelling, speller: CodeSpeller, indent: int) -> list[str]:
    """What only the first sample does."""
    target, space = spelling.target, " " * indent
    if_, _, end = target.statements.branch
    own = [
        line
        for s in start.statements
        for line in lines([s._replace(comment="", origin=None)], spelling, speller,
                          indent + target.tab)
    ]  # fmt: skip
    comment = start.statements[0].comment
    head = listing.comment(comment, target, indent + target.tab) if comment else []
    if_ = space + if_.format("first")
    return [if_, *head, *own, *([space + end] if end else [])]


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


def tables(
    program: Program,
    spelling: Spelling,
    row: str,
    number: Callable[[float], str],
    end: tuple[str, ...] = (),
) -> list[dict[str, object]]:
    """The tables of a program; a `row` holds numbers, and `end` stands behind the last one."""
    found: dict[str, dict[str, object]] = {}
    for name, points in program.tables:
        pairs = points if len(points) > 1 else points * 2  # a single point is a constant
        rows = [row.format(", ".join(map(number, pair))) for pair in pairs]
        found.setdefault(
            spelling.tables[name],
            {
                "comment": listing.harmless(f"The table {name}.", spelling.target),
                "name": spelling.tables[name],
                "columns": len(points[0]),
                "lines": listing.table([*rows, *end], spelling.target, 4),
            },
        )
    return list(found.values())
