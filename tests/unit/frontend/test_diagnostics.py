"""One cause, one error: with the right code, at the right place, with a remedy."""

from __future__ import annotations

import pytest

from bondgraph import errors
from bondgraph.passes.elaboration.unit_mends import changed
from bondgraph.text.diagnostic import Diagnostic
from tests.unit.frontend import corpus
from tests.unit.frontend.trees import read

#: In each text one place is marked by `@`: there the error is, and nothing else is wrong.
STATEMENTS = [
    ("unit-space", "param x = 5@kg"),
    ("unit-space", "param x = 5  @kg"),
    ("unit-space", "let x = 1@or c"),
    ("number-form", "param x = @.5"),
    ("number-form", "param x = 5@."),
    ("number-form", "param x = @1e999"),
    ("syntax-unexpected", "param x = 3 @3"),
    ("syntax-unexpected", "param x =@"),
    ("syntax-unexpected", "param x = 1 @param y = 2"),
    ("param-unit-and-value", "param R : Ohm @= 5 Ohm"),
    ("syntax-unclosed", "param x = @(1 + 2"),
    ("syntax-unclosed", "R:x@(\n  q0 = 1"),
    ("syntax-unclosed", "let x = m@[1"),
    ("syntax-unclosed", 'let x = @"abc'),
    ("syntax-unexpected", "a ->@"),
    ("syntax-unexpected", "a -> @-> b"),
    ("syntax-character", "a @=> b"),
    ("syntax-character", "a @--> b"),
    ("syntax-character", "a @→ b"),
    ("syntax-character", "param x = 5 @− 3"),
    ("syntax-character", "let a = b *@* c"),
    ("bond-without-start", "@-> b"),
    ("bond-without-start", "a\n    @-> b"),
    ("name-alone", "@x"),
    ("syntax-unexpected", "1:i @wen on { -> R:x }"),
    ("syntax-unexpected", "1:i when on@\n        -> R:x\n        -> R:y\n    }"),
    ("syntax-unexpected", "for j in 1..2@\n        a -> b\n    }"),
    ("syntax-unexpected", "R:x { e = R*f@, f = 2 }"),
    ("not-a-junction", "R:x { @-> b }"),
    ("law-empty", "R:x @{ }"),
    ("junction-value", "0:j @= 3"),
    ("junction-in-chain", "a -> 1:j { -> b } @-> c"),
    ("junction-in-chain", "a -> 1:j[3] @{ -> b }"),
    ("junction-in-chain", "for i in 1..2 { a -> 1:j[3] @{ -> b } }"),
    ("brace-on-next-line", "a -> 1:j\n    @{ -> b }"),
    ("syntax-unexpected", "a -> R:r @when on { -> b }"),
    ("syntax-unexpected", "a -> j @when on { -> b }"),
    ("syntax-unexpected", "a -> 1:j { -> b } @c"),
    ("syntax-unexpected", "Cell:c(@3)"),
    ("syntax-unexpected", "Cell:c(n = 1 @2,\n      L = 3)"),
    ("comparison-chain", "let b = a < c @< d"),
    ("tolerance-misplaced", "let b = x@+-1"),
    ("name-double-underscore", "param @a__b = a__b"),
    ("name-letters", "param @θ = 1"),
    ("name-letters", "R:@_a"),
    ("name-reserved", "param @not = 1"),
    ("counts-per-turn", "sensor s = x counts @24"),
    ("counts-per-turn", "sensor s = x counts @1 + 24/turn"),
    ("counts-per-turn", "sensor s = x counts @24 counts/turn"),
    ("brace-on-next-line", "1:i\n    @{\n    -> R:x\n    }"),
    ("model-in-model", "@model Q { a -> b }"),
    ("nesting-too-deep", "let x = " + "(" * 99 + "@(1" + ")" * 100),
    ("nesting-too-deep", "let x = " + "a+" * 200 + "a@+a"),
    ("nesting-too-deep", "1:a { " * 99 + "1:a @{ } " + "}" * 99),
    ("nesting-too-deep", "let x = " + "-" * 99 + "@-1"),
    ("syntax-unexpected", "if a { R:x } else @b"),
    ("syntax-unexpected", "R:x\n    @else { R:y }"),
    ("input-value", "input U @= 12 V"),
    ("input-value", "input U[2] : V @= 12 V"),
    ("input-value", "input on : bool @= true"),
    ("syntax-unexpected", "param a = 1 Ohm@, b = 2 H, c = 3"),
    ("syntax-unexpected", "param a@, b"),
    ("syntax-unexpected", "sensor a = max(1, x.f)@, b = x.f"),
    ("syntax-unexpected", "input x @y"),
    ("syntax-unexpected", "R:x { e = R @f }"),
    ("syntax-unexpected", "R:x { e = 2*(a + b) @(c + d) }"),
    ("syntax-unexpected", "R:x { e = (a @b)/2 }"),
    ("syntax-unexpected", "R:x { e = @if f > 0 then f else 2*f }"),
    ("syntax-unexpected", "let x = if(f > 0) @then f else 2*f"),
    ("syntax-unexpected", "let x = f @if f > 0 else 2*f"),
    ("syntax-character", "let x = f > 0 @? f : 2*f"),
    ("syntax-unexpected", "const g = 9@,81 m/s^2"),
    ("syntax-character", "let a = v.f@'"),
    ("syntax-unexpected", "Se:F @- 1:v"),
    ("syntax-unexpected", "v @-- I:m"),
    ("syntax-unexpected", "R:x { e = 3*abs @f }"),
    ("syntax-unexpected", "R:x { e @:= 3*f }"),
    ("syntax-unexpected", "R:x { e @== 3*f }"),
    ("syntax-character", "R:x { e = 3*@|f| }"),
    ("syntax-unexpected", "param x = 3 @[Ohm]"),
    ("syntax-unexpected", "input on : @boolean"),
    ("syntax-unexpected", "fault f : R = 3 Ohm @at 2 s"),
    ("unknown-statement", "@output x = i.f"),
    ("unknown-statement", "@state x = 1"),
    ("unknown-statement", "@connect(a, b)"),
    ("unknown-statement", "@resistor R = 3 Ohm"),
]
FILES = [
    ("empty-file", "@"),
    ("empty-file", "@# only a comment\n\n"),
    ("missing-edition", "@model M { R:r }"),
    ("missing-edition", "@Se:U -> R:r"),
    ("missing-edition", "@bg one\nmodel M { }"),
    ("unknown-edition", "bg @2\nmodel M { ??? }"),
    ("not-text", "@\0\1\2"),
    ("not-bondgraph-json", '@{"a": 1}'),
    ("not-bondgraph-yaml", '@version: "0.1"\nroot: "rc"\nmodels:\n  rc:\n    netlist:\n    - a b'),
    ("not-bondgraph-yaml", "# rc\n@---\nversion: 1\n"),
    ("not-bondgraph-modelica", "model Foo\n  Real x;\n@equation\n  x = 1;\nend Foo;\n"),
    ("syntax-unclosed", "bg 1\nmodel M @{\n    a -> b\n"),
    ("syntax-unclosed", "bg 1\nmodel M {\n    1:i @{\n        -> a\n    R:r\n}\nmodel N { }\n"),
    ("syntax-unclosed", "bg 1\nmodel M @{\n    a -> b\nmodel N {\n    a -> b\n}\n"),
    ("syntax-unclosed", "bg 1\nmodel M {\n    R:r @{ e = f\n    1:i { }\n}\n"),
    ("syntax-unopened", "bg 1\n@}\nmodel M { }"),
    ("syntax-unopened", "bg 1\nmodel M {\n    1:i { -> a } }\n@}\n"),
    ("statement-outside-model", "bg 1\nmodel M {\n    }\n    @param b = 1\n    a -> b\n}\n"),
    ("syntax-unexpected", "bg 1\nmodel M(n@) { R:r }"),
    ("syntax-unexpected", "bg 1\nmodel@"),
]


def _check(found: list[Diagnostic], code: str, at: int) -> None:
    assert [d.code for d in found] == [code], [(d.code, d.message) for d in found]
    (diagnostic,) = found
    assert diagnostic.labels[0].span.start == at
    assert diagnostic.help
    assert diagnostic.message.endswith(".")


@pytest.mark.parametrize(("code", "marked"), STATEMENTS)
def test_statement(code: str, marked: str) -> None:
    marked = "bg 1\nmodel M {\n    param ok = 1\n    " + marked + "\n    param fine = 2\n}\n"
    tree, report = read(marked.replace("@", "", 1))
    _check(report.diagnostics, code, marked.index("@"))
    assert tree is not None
    # What stands around the error was read.
    assert len(tree.models[0].body) >= 2 or "brace" in report.diagnostics[0].message


@pytest.mark.parametrize(("code", "marked"), FILES)
def test_file(code: str, marked: str) -> None:
    _check(read(marked.replace("@", "", 1))[1].diagnostics, code, marked.index("@"))


def test_several_errors_in_one_run() -> None:
    lines = {
        3: "param R = 5kg", 5: "a -> ", 7: "let x = (1", 9: "sensor s = x counts 3", 11: "x",
        13: "R:r { e = }", 15: "for j on 1..2 { a -> b }", 17: "port a : electrical",
    }  # fmt: skip
    body = "\n".join(lines.get(n, "param ok = 1 Ohm") for n in range(3, 20))
    _, report = read(f"bg 1\nmodel M {{\n{body}\n}}\n")
    assert [d.labels[0].span.line for d in report.diagnostics] == list(lines)


def test_errors_in_several_models_and_blocks() -> None:
    _, report = read(
        "bg 1\nmodel A(n) {\n  1:i {\n    -> \n    -> R:r { e = 3 3\n f = = }\n  }\n}\n"
        "model B {\n  for j in 1..2 { x\n y y }\n}\n"
    )
    assert [d.labels[0].span.line for d in report.diagnostics] == [2, 4, 5, 6, 10, 11]


def test_a_long_list_of_errors_is_cut() -> None:
    _, report = read(corpus.whole("x\n" * 1000))
    assert len(report.diagnostics) == 41
    assert report.diagnostics[-1].code == "syntax-many"


@pytest.mark.parametrize("body", corpus.WRONG)
def test_every_wrong_statement_gets_one_error(body: str) -> None:
    _, report = read("bg 1\nmodel M {\n    " + body + "\n}\n")
    assert len(report.diagnostics) == 1, [(d.code, d.message) for d in report.diagnostics]
    assert errors.page(report.diagnostics[0].code) is not None


@pytest.mark.parametrize(
    ("line", "remedy"),
    [
        ("Se:U - > 1:a", "A bond is an arrow, without a space in it"),
        ("R:r < - 1:a", "A bond is an arrow, without a space in it"),
        ("Se:U -> Motor:m.el", "`Model:part`, and then its port"),
    ],
)
def test_what_was_meant_is_proposed(line: str, remedy: str) -> None:
    _, said = read(f"bg 1\nmodel M {{\n{line}\n}}\n")
    assert remedy in str(said.diagnostics[0].help)


@pytest.mark.parametrize(
    ("line", "mended"),
    [
        ("input U = 12 V", ["input U : V", "param U = 12 V"]),
        ("input U[2] : V = 2*E", ["param U[2] = 2*E"]),
        ("param a = 1 Ohm, b = 2 H, c = 3", ["param a = 1 Ohm; param b = 2 H; param c = 3"]),
        ("param a = 1 Ohm b = 2 H", ["param a = 1 Ohm; param b = 2 H"]),
        ("param a = 1 Ohm param b = 2 H", ["param a = 1 Ohm; param b = 2 H"]),
        ("param a, b", ["param a; param b"]),
        ("let a = max(1, b), c = 2", ["let a = max(1, b); let c = 2"]),
        ("input x, y : V", ["input x; input y : V"]),
        ("input x y z", ["input x; input y; input z"]),
        ("R:x { e = R f }", ["R:x { e = R*f }"]),
        ("R:x { e = (R v.f)/2 }", ["R:x { e = (R*v.f)/2 }"]),
        ("R:x { e = a[1] (b + c) }", []),
        ("R:x { e = if f > 0 then R*f else 2*R*f }", ["R:x { e = if(f > 0, R*f, 2*R*f) }"]),
        ("let x = if (f > 0) then 1 else (2 + y)", ["let x = if((f > 0), 1, (2 + y))"]),
        ("let x = if f > 0 then 1 elseif f < 1 then 2 else 3", []),
        ("sensor s = x counts 24 counts/turn", ["sensor s = x counts 24/turn"]),
        ("const g = 9,81 m/s^2", ["const g = 9.81 m/s^2"]),
        ("let a = v.f'", ["let a = der(v.f)"]),
        ("let a = (b + c)'", []),
        ("import A from 'a.bg'", []),
        ("Se:F - 1:v", ["Se:F -> 1:v"]),
        ("Se:F - > 1:v", ["Se:F -> 1:v"]),
        ("a < - 1:v", ["a <- 1:v"]),
        ("v -- I:m", ["v -> I:m"]),
        ("v > I:m", ["v -> I:m"]),
        ("R:x { e = 3*abs f }", ["R:x { e = 3*abs(f) }"]),
        ("R:x { e := 3*f }", ["R:x { e = 3*f }"]),
        ("R:x { e == 3*f }", ["R:x { e = 3*f }"]),
        ("R:x { e = 3*|f| }", []),
        ("param x = 3 [N.m/A] +- 5%", ["param x = 3 N.m/A +- 5%"]),
        ("input on : boolean", ["input on : bool"]),
        ("fault f : R = 3 Ohm at 2 s", []),
        ("output y = i.f", ["sensor y = i.f"]),
        ("connect(a, b)", []),
    ],
)
def test_changes_of_the_text(line: str, mended: list[str]) -> None:
    """What is proposed as a change, made by hand."""
    _, said = read(f"bg 1\nmodel M {{\n{line}\n}}\n")
    (found,) = said.diagnostics
    assert [changed(found.labels[0].span.source.text, e).split("\n")[2] for e in found.edits] == (
        mended
    )
