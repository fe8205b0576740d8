"""Published case studies: relations by hand beside those compiled, and the page about them."""

from __future__ import annotations

import re
from functools import cache, partial
from pathlib import Path
from typing import Any

import pytest
import sympy as sp

from bondgraph.compilation import Compilation
from bondgraph.ir.signature_matrix import SignatureMatrix
from bondgraph.text.source import Source
from tests.case_studies.by_hand import CASES, DRIVE_TRAIN, Case
from tests.unit.passes.relations import integral, is_multiple, t

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PAGE = ROOT / "docs" / "case_studies.md"
each_case = pytest.mark.parametrize("case", CASES, ids=lambda c: c.model)


@cache
def compiled(model: str, isolate: bool = False) -> Compilation:
    path = HERE / f"{model}.bg"
    plain = Compilation(Source(str(path), path.read_text(encoding="utf-8")))
    return plain.with_options(isolate=True) if isolate else plain


# ----------------------------------------------------------- relations by hand, read


def applied(name: str) -> Any:
    """What a function of the relations by hand is on expressions in t."""
    return {
        "D": lambda x, k=1: sp.diff(x, t, k),
        "Int": lambda x: integral(sp.Integral(x, (t, 0, t))),
        "ssqrt": lambda x: sp.sign(x) * sp.sqrt(sp.Abs(x)),
        "reading": lambda x: x,
    }[name]


def formulas(case: Case) -> dict[str, str]:
    """All relations by their names; ours may name those by hand."""
    return case.hand | case.ours


def evaluated(case: Case, name: str, known: dict[str, Any], functions: dict[str, Any]) -> Any:
    """A relation by hand at given symbols and functions, its steps and other relations put in."""
    *steps, last = formulas(case)[name].split(";")
    names = dict(known) | functions
    for other in case.hand:
        if other != name and re.search(rf"\b{other}\b", last):
            names[other] = evaluated(case, other, known, functions)
    for step in steps:
        symbol, _, value = step.partition("=")
        assert symbol.strip() not in names, f"{symbol} is a name of the model already"
        names[symbol.strip()] = sp.parse_expr(value, local_dict=names)
    return sp.parse_expr(last, local_dict=names)


FUNCTIONS = ("D", "Int", "ssqrt", "reading")


def in_time(case: Case, name: str, **known: Any) -> Any:
    """A relation by hand as an expression in t."""
    return evaluated(case, name, known, {f: applied(f) for f in FUNCTIONS})


def written(case: Case, name: str, faults: tuple[str, ...]) -> Any:
    """A relation by hand as it is written, its signals symbols."""
    known = {s: sp.Symbol(s) for s in [*faults, *constants(case), *case.signals.split()]}
    return sp.expand(evaluated(case, name, known, {f: sp.Function(f) for f in FUNCTIONS}))


def constants(case: Case) -> list[str]:
    return [v.name for v in compiled(case.model).graph.values]


def names_in(expr: Any) -> set[str]:
    return {s.name for s in expr.free_symbols}


def sensitive(expr: Any) -> set[str]:
    """What a relation reacts to: all that it contains, but not the errors of readings."""
    return names_in(expr.replace(sp.Function("reading"), lambda x: sp.Integer(1)))


def groups(rows: dict[str, tuple[bool, ...]]) -> int:
    return len(set(rows.values()))


def row_of(sets: list[set[str]], fault: str) -> tuple[bool, ...]:
    return tuple(fault in s for s in sets)


# ----------------------------------------------------------- relations


RELATIONS = [
    pytest.param(case, name, marks=[pytest.mark.slow] if name in case.slow.split() else [])
    for case in CASES
    for name in case.ours
]


@pytest.mark.parametrize(("case", "name"), RELATIONS, ids=lambda x: getattr(x, "model", x))
def test_a_compiled_relation_is_what_was_derived_by_hand(case: Case, name: str) -> None:
    relations = compiled(case.model, isolate=True).residuals
    params = {
        value: sp.Rational(7 + 3 * k, 5 + 2 * k) + k % 3
        for k, value in enumerate([*constants(case), "pump", "positioner"])
    }
    hand = partial(in_time, case, name)
    assert is_multiple(relations[name], hand, params, tuple(case.signals.split()))


@each_case
def test_there_are_no_relations_besides(case: Case) -> None:
    assert [r.name for r in compiled(case.model, isolate=True).residuals] == [*case.ours]
    default = [r.name for r in compiled(case.model).residuals]
    assert default == sorted(case.beside.values())


# ----------------------------------------------------------- signatures


@each_case
def test_a_compiled_relation_sees_what_it_contains(case: Case) -> None:
    matrix = compiled(case.model, isolate=True).signatures
    for name in case.ours:
        expected = sensitive(written(case, name, matrix.faults)) & {*matrix.faults}
        assert {*matrix.signature(name)} == expected, name


@each_case
def test_groups(case: Case) -> None:
    plain = compiled(case.model)
    faults = plain.signatures.faults
    contained = [names_in(written(case, name, faults)) for name in case.hand]
    by_hand = groups({f: row_of(contained, f) for f in faults})
    best = plain.maximum_isolability
    assert best is not None
    further = compiled(case.model, isolate=True).signatures.groups
    found = (by_hand, len(plain.signatures.groups), len(further), len(best))
    assert found == case.groups


@each_case
def test_what_shows_in_transients_only(case: Case) -> None:
    found = compiled(case.model).detectability
    assert {*found.only_weak} == {*case.weak.split()}


# ----------------------------------------------------------- the page


def section(case: Case) -> str:
    """The part of the page about a case: from its heading to the next one."""
    text = PAGE.read_text(encoding="utf-8")
    parts = re.split(r"^## ", text, flags=re.MULTILINE)
    (part,) = [p for p in parts if f"[{case.model}.bg](" in p]
    return part


def tables(text: str) -> list[list[list[str]]]:
    """The tables of a text: rows of cells, without the rule below the head."""
    found: list[list[list[str]]] = [[]]
    for line in text.splitlines():
        if line.startswith("|"):
            found[-1].append([c.strip() for c in line.strip("|").split("|")])
        elif found[-1]:
            found.append([])
    return [[rows[0], *rows[2:]] for rows in found if rows]


def matrix_lines(case: Case) -> list[list[str]]:
    """The table of a case: by hand what the relations contain, ours as compiled."""
    matrix: SignatureMatrix = compiled(case.model, isolate=True).signatures
    contained = {n: names_in(written(case, n, matrix.faults)) for n in case.hand}
    seen = {n: {*matrix.signature(n)} for n in case.ours}
    both = contained | seen
    lines = [["Fault", *both]]
    for fault in matrix.faults:
        lines.append([f"`{fault}`", *("1" if fault in both[n] else "." for n in both)])
    return lines


@each_case
def test_the_matrix_of_the_page_is_the_compiled_one(case: Case) -> None:
    matrices = [rows for rows in tables(section(case)) if rows[0][0] == "Fault"]
    assert matrices == [matrix_lines(case)]


def differences(case: Case) -> set[tuple[str, str, str, str, str]]:
    """Fault, relation by hand, ours beside it, entry by hand, our entry; where they differ."""
    head, *rows = matrix_lines(case)
    column = {name: k for k, name in enumerate(head)}
    found = set()
    for row in rows:
        for theirs, ours in case.beside.items():
            one, other = row[column[theirs]], row[column[ours]]
            if one != other:
                found.add((row[0].strip("`"), theirs, ours, one, other))
    return found


@each_case
def test_the_page_explains_each_entry_that_differs(case: Case) -> None:
    told = set()
    for rows in tables(section(case)):
        if rows[0][0] == "Entry":
            for entry, one, other, why in rows[1:]:
                faults, _, place = entry.rpartition(" in ")
                theirs, _, ours = place.partition(", ")
                assert why
                told |= {(f, theirs, ours, one, other) for f in re.findall(r"`(\w+)`", faults)}
    assert told == differences(case)


def shown(name: str, formula: str) -> str:
    """A relation by hand as the page has it, its steps below it."""
    *steps, last = formula.split("; ")
    return "\n".join([f"{name}: 0 = {last}", *(f"    where {step}" for step in steps), ""])


@each_case
def test_the_page_shows_the_relations(case: Case) -> None:
    blocks = re.findall(r"^```text\n(.*?)^```", section(case), re.MULTILINE | re.DOTALL)
    by_hand, ours, printed = blocks
    for block, relations in ((by_hand, case.hand), (ours, case.ours)):
        assert block == "".join(shown(n, f) for n, f in relations.items())
    assert printed == f"{compiled(case.model).residuals!r}\n"


@each_case
def test_the_page_counts_groups(case: Case) -> None:
    (overview,) = [rows for rows in tables(PAGE.read_text(encoding="utf-8")) if "Case" in rows[0]]
    (row,) = [r for r in overview if f"/{case.model}.bg)" in r[1]]
    further = len(case.ours) - len(case.beside)
    assert row[2:] == [f"{len(case.beside)} + {further}", *map(str, case.groups)]
    weak = re.search(r"^In transients only: (.*)\.$", section(case), re.MULTILINE)
    assert weak is not None
    assert weak[1] == (", ".join(f"`{f}`" for f in case.weak.split()) or "none")


def test_the_page_sums_the_differences_up() -> None:
    (said,) = re.findall(r"(\d+) differ,", PAGE.read_text(encoding="utf-8"))
    assert int(said) == sum(len(differences(case)) for case in CASES)


def test_what_samples_do_not_show_of_the_drive_train() -> None:
    torsion = compiled("drive_train").program.residuals[1]
    assert {*torsion.invisible} == {"Br", "B"}
    assert "**cannot see `Br` and `B`**" in section(DRIVE_TRAIN)
