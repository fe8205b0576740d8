"""What every target says about a program, whatever its language: limits, comments."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache

from bondgraph.algebra.near import ABOVE, BELOW, BOUND, FAR
from bondgraph.backends import listing
from bondgraph.backends.identifiers import file_name, snake
from bondgraph.ir.program import (
    Assign,
    Const,
    Expression,
    Field,
    Known,
    PolynomialTape,
    Program,
    ResidualInfo,
    Statement,
    flat,
)
from bondgraph.notation.dialect import digits
from bondgraph.notation.walk import functions, nodes, reads
from bondgraph.text.tuples import NamedTuple

#: Changes when a struct or a function of the generated code changes.
ABI = 4

#: The least bandwidth * sample_time at which a filter still moves, for double and for float.
SLOWEST, SLOWEST_FLOAT = 1e-9, 1e-4

_FLOAT_MIN, _FLOAT_MAX = 1.2e-38, 3.4e38


class Facts(NamedTuple):
    """Numbers and texts about a program, ready to be written.

    `fastest` is the largest bandwidth * sample_time; `least_sample_time` is 0.0 where no term was
    left out and no sample is remembered, and so any rate will do. `stem` begins all names, `file`
    those of the files, `noun` is what they compute, `headline` both in one sentence. `laws` are the
    functions that the code needs.
    """

    stem: str
    file: str
    noun: str
    headline: str
    fastest: float
    least_sample_time: float
    laws: frozenset[str]
    beyond_float: tuple[float, ...]


@lru_cache(maxsize=4)  # each target language asks
def facts(program: Program) -> Facts:
    """The facts of a program."""
    default = program.bandwidth / program.rate
    run = dict.fromkeys(_values((*program.exact, *program.first, *program.step)))
    for block in program.roots:
        run |= dict.fromkeys([*_values(block.body + block.further), block.value, block.slope])
    every = [*_values(program.configure), *run]
    numbers = [node.value for node in nodes(every) if isinstance(node, Const)]
    numbers += [z for _, points in program.tables for point in points for z in point if z == z]
    numbers += [f.default for f in program.params if f.default is not None]
    beyond = [n for n in numbers if n and not _FLOAT_MIN <= abs(n) <= _FLOAT_MAX]
    laws = functions(run) | (functions(_values(program.configure)) - {"exp"})
    laws |= {"along"} if laws & {"map", "inverse"} else set()
    stem = snake(program.name)
    headline = f"{program.name}: residuals that are near zero while the machine is well."
    if program.bounds:
        headline = f"{program.name}: how far residuals can be from zero while the machine is well."
    return Facts(
        stem,
        file_name(stem),
        "thresholds" if program.bounds else "residuals",
        headline,
        max(3.0, 1.01 * default),
        0.999999 / program.rate if program.dropped or program.delayed else 0.0,
        frozenset(laws),
        tuple(dict.fromkeys(beyond)),
    )


def _values(statements: Iterable[Statement]) -> Iterator[Expression]:
    for statement in flat(statements):
        if isinstance(statement, Assign):
            yield statement.value
        elif isinstance(statement, PolynomialTape):
            yield from statement.scales


def exponential(program: Program) -> bool:
    """Whether configure needs the exponential function."""
    return "exp" in functions(_values(program.configure))


def reads_time(program: Program) -> bool:
    """Whether exact needs the time since the start."""
    return any(ref.space == "time" for ref in reads(program.exact))


def about_field(field: Field) -> str:
    """`H: armature inductance, el.L, motor.bg:9`: unit, meaning, path and line."""
    where = listing.place(field.origin)
    return _about(field.unit, field.doc, field.path, field.name, where)


def about_known(known: Known) -> str:
    """The same for a known signal."""
    return _about(known.unit, known.doc, known.path, known.name, listing.place(known.origin))


def _about(unit: str, doc: str, path: str, name: str, where: str) -> str:
    doc = " ".join(doc.split()).rstrip(".")
    meaning = ", ".join(part for part in (doc, path if path != name else "") if part)
    text = f"{unit or '-'}: {meaning}" if meaning else (unit or "-")
    return f"{text} ({where})" if where else text


def about_residual(info: ResidualInfo) -> str:
    """Two paragraphs: `r1 = ...`, what it is, and the faults that it reacts to."""
    sees = "sees " + (", ".join(info.faults) or "no fault")
    if info.unavailable:
        sees += f"\nstep never has it: {info.unavailable}"
    if info.unwritten:
        sees += f"\nexact gives NaN for it: {info.unwritten}"
    if not info.text:
        return sees
    named = info.text.startswith((f"{info.name} = ", f"{info.name}: "))
    return f"{info.text if named else f'{info.name} = {info.text}'}\n{sees}"


def near() -> dict[str, object]:
    """The numbers of the functions that are near those of the library, from the highest power."""
    return {
        "bound": f"{BOUND:g}",
        "far": digits(FAR),
        "above": [digits(x) for x in reversed(ABOVE)],
        "below": [digits(x) for x in reversed(BELOW)],
    }
