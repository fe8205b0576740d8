"""Remedies that are changes of the text: each mends what it is offered for."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import bondgraph
from bondgraph import errors
from bondgraph.editor.soundness import soundness
from bondgraph.passes.elaboration.unit_mends import changed
from bondgraph.text.diagnostic import Diagnostic

ROOT = Path(__file__).resolve().parents[3]

#: Mistakes that were seen, and the change that mends each.
SEEN = [
    ("parm R = 2 Ohm; 1:j { <- Se:U; -> R:R }", "write `param`"),
    ("param R = 2 Ohm; sensr y = j.f; 1:j { <- Se:U; -> R:R }", "write `sensor`"),
    ("param R = 2 Ohm +/- 5%; 1:j { <- Se:U; -> R:R }", "write `+-`"),
    ("param k = 2 N/m; param m = 1 kg; 1:j { <- Se:F; -> C:k; -> I:m }", "write `C:k = 1/k`"),
    ("param k = 2 N/m; input F : N; param m = 1 kg; 1:j { <- Se:F; -> C:s = k; -> I:m }",
     "write `C:s = 1/k`"),
    ("1:j { <- Se:F; -> C:k = 300 N/m; -> I:m = 2 kg }", "write `C:k = 1/(300 N/m)`"),
    ("1:j { <- Se:F; -> I:m = 2 kg; -> C:k = 300 N/m }", "write `C:k = 1/(300 N/m)`"),
    ("param k = 2 N/m; 0:x { <- p; -> C:k }; port p : in translation", "write `C:k = 1/k`"),
    ("param R = 2 mH; param L = 3 Ohm; 1:j { <- Se:U; -> R:R; -> I:L }",
     "exchange 2 mH and 3 Ohm"),
    ("param R = 2 mH; param L = 3 Ohm; port p : in electrical; 1:j { <- p; -> R:R; -> I:L }",
     "exchange 2 mH and 3 Ohm"),
    ("R:j { <- Se:U; -> R:r = 2; -> Df:i }", "write `1`"),
    ("param R : Ohm = 3\n 1:j { <- Se:U; -> R:R }", "write `= 3 Ohm`"),
    ("param n = 2; TF:n; Se:U -> n -> R:r = 2", "write `{ f1 = n*f2 }`"),
    ("param h = 10 W/m^2.K; param A = 2 m^2; 0:t { <- Sf:Q; -> C:c = 9 J/K; -> R:r = 1/(h*A) }",
     "write `W/m^2/K`"),
    ("param k = 80 %\n Se:U -> R:r = k", "write `0.8`"),
    ("param R = 3Ohm; 1:j { <- Se:U; -> R:R }", "write `3 Ohm`"),
    ("param R = 3 Ohms; 1:j { <- Se:U; -> R:R }", "write `Ohm`"),
    ("param R = .5 Ohm; 1:j { <- Se:U; -> R:R }", "write `0.`"),
    ("param R_ö = 5 Ohm; 1:j { <- Se:U; -> R:R_ö }", "write `R`"),
    ("Se:U → R:r = 2", "write `->`"),
    ("Rr:x = 2; Se:U -> x", "write `R`"),
    ("param R = 2 Ohm; 1:jay { <- Se:U; -> R:R }; jy -> Df:i", "write `jay`"),
    ("param I = 3 kg*m^2; 1:j { <- Se:U; -> I:I }", "write `3 kg.m^2`"),
    ("port p : in electricl; R:r = 2; p -> r", "write `electrical`"),
    ("0:n { <- Se:A; <- Se:B\n-> R:r = 2 }",
     "put a 1-junction with an R or an I between Se:B and 0:n"),
    ("0:n { <- Se:A; <- Se:B\n-> R:r = 2 }",
     "make 0:n a 1-junction, if its bonds share the flow and not the effort"),
    ("Sf:A -[1]-> 1:n; n -> R:r = 2; n <- Sf:B",
     "put a 0-junction with an R or a C between Sf:A and 1:n"),
]  # fmt: skip


def found(text: str, path: str = "a.bg") -> tuple[Diagnostic, ...]:
    return soundness(bondgraph.compile(path=path, text=text, open_ports=True)).diagnostics


@pytest.mark.parametrize(("body", "title"), SEEN, ids=[title for _, title in SEEN])
def test_mistakes_that_were_seen(body: str, title: str) -> None:
    text = f"bg 1\nmodel M {{ {body}\n}}\n"
    errors_before = [d for d in found(text) if d.severity == "error"]
    edits = [e for d in errors_before for e in d.edits if e.title == title]
    assert edits, [(d.message, [e.title for e in d.edits]) for d in errors_before]
    assert len(errors_before) == 1 or len({d.code for d in errors_before}) == 1
    assert not [d for d in found(changed(text, edits[0])) if d.severity == "error"]


def test_two_mistakes_in_units_are_told_one_at_each_finding() -> None:
    body = (
        "param R = 2 mH; param L = 3 Ohm; param k = 2 N/m; param g = 1 N/A; param m = 1 kg\n"
        "Se:U -> 1:i; i -> R:R; i -> I:L; i -> {} -> 1:v; v -> I:m; v -> C:k"
    )
    swap, inverse = "exchange 2 mH and 3 Ohm", "write `C:k = 1/k`"
    # Two parts, each with a mistake: each finding has the change that takes it away.
    apart = found(f"bg 1\nmodel M {{ {body.format('R:r = 1; Se:F')}\n}}\n")
    assert [e.title for d in apart for e in d.edits] == [swap, inverse]
    # In one part the first contradiction hides the second, which is told once that is mended.
    text = f"bg 1\nmodel M {{ {body.format('GY:y { e1 = g*f2 }')}\n}}\n"
    (first,) = [d for d in found(text) if d.code == "unit-mismatch"]
    assert [e.title for e in first.edits] == [swap]
    (second,) = [d for d in found(changed(text, first.edits[0])) if d.code == "unit-mismatch"]
    assert [e.title for e in second.edits] == [inverse]


def examples() -> list[tuple[str, str]]:
    """Every text of the tests and of the pages about errors that is wrong in some way."""
    texts = [(p.name, p.read_text(encoding="utf-8")) for p in (ROOT / "tests/broken").glob("*.bg")]
    for code in errors.codes():
        page = errors.page(code) or ""
        wrong = page.partition("## Mended")[0]
        texts += [(code, text) for text in re.findall(r"```bg\n(.*?)```", wrong, re.DOTALL)]
    return sorted(texts)


def test_each_change_takes_its_finding_away() -> None:
    offered = 0
    for name, text in examples():
        path = str(ROOT / "tests/broken" / (name if name.endswith(".bg") else "page.bg"))
        before = found(text, path)
        for diagnostic in before:
            for edit in diagnostic.edits:
                if any(span.source.path != path for span, _ in edit.changes):
                    continue
                offered += 1
                text_after = changed(before[0].labels[0].span.source.text, edit)
                after = found(text_after, path)
                left, there = (
                    sum((d.code, d.message) == diagnostic[:2] for d in some)
                    for some in (after, before)
                )
                assert left < there, f"{name}: {edit.title} leaves {diagnostic.message}"
    assert offered >= 20
