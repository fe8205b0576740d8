"""Rendering: what a person sees is compared whole, and nothing of a source may break it."""

from __future__ import annotations

import json
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bondgraph.text.diagnostic import Diagnostic, Label, Severity
from bondgraph.text.render import as_json, render
from bondgraph.text.source import Source, Span

TEXT = """bg 1
model M {
    Se:U1 -> 0:j
\tSe:U2 -> j -> Se:U3
    # 漢字 Se:é
    1:i {
        -> I:L
        -> R:Re

        -> C:x
    }
}
"""
SOURCE = Source("m.bg", TEXT)


def span(words: str, size: int | None = None) -> Span:
    start = TEXT.index(words)
    return Span(SOURCE, start, start + (len(words) if size is None else size))


def shown(*labels: Label, help: str = "", severity: Severity = "error") -> str:
    return render([Diagnostic("a-code", "what is wrong", labels, help, severity)], False)


def test_two_lines_and_help() -> None:
    text = shown(Label(span("Se:U2"), "this one too"), Label(span("Se:U1"), "fixes it"), help="do")
    assert (
        text
        == """\
error[a-code]: what is wrong
 --> m.bg:4:2
  |
3 |     Se:U1 -> 0:j
  |     ----- fixes it
4 |     Se:U2 -> j -> Se:U3
  |     ^^^^^ this one too
  |
  = help: do
"""
    )


def test_three_labels_on_one_line_after_a_tab() -> None:
    middle = span("j -> Se:U3", 1)
    labels = (Label(span("Se:U2"), "a"), Label(span("Se:U3"), "c"), Label(middle, "b"))
    assert (
        shown(*labels)
        == """\
error[a-code]: what is wrong
 --> m.bg:4:2
  |
4 |     Se:U2 -> j -> Se:U3
  |     ^^^^^    -    ----- c
  |     |        |
  |     |        b
  |     a
"""
    )


def test_span_of_several_lines() -> None:
    start = TEXT.index("1:i {")
    long = Span(SOURCE, start, TEXT.index("    }\n") + 5)
    assert (
        shown(Label(long, "this junction"), severity="info")
        == """\
note[a-code]: what is wrong
  --> m.bg:6:5
   |
 6 | /     1:i {
 7 | |         -> I:L
...  |
10 | |         -> C:x
11 | |     }
   | |_____^ this junction
"""
    )


def test_wide_characters_take_two_columns() -> None:
    assert (
        shown(Label(span("Se:é")))
        == """\
error[a-code]: what is wrong
 --> m.bg:5:10
  |
5 |     # 漢字 Se:é
  |            ^^^^
"""
    )


def test_no_label() -> None:
    assert (
        shown(help="write `bg 1` first")
        == """\
error[a-code]: what is wrong
  = help: write `bg 1` first
"""
    )


def test_end_of_file_and_another_file() -> None:
    other = Source("parts/b.bg", "bg 1\nmodel B {")
    labels = (Label(Span(SOURCE, len(TEXT), len(TEXT)), "here"), Label(Span(other, 5, 10), "there"))
    assert (
        shown(*labels)
        == """\
error[a-code]: what is wrong
  --> m.bg:13:1
   |
13 |
   | ^ here
  ::: parts/b.bg:2:1
   |
 2 | model B {
   | ----- there
"""
    )


def test_wide_line_is_cut_around_each_label() -> None:
    text = "let a = " + "b + " * 100 + "zz" + " + c" * 100
    source = Source("m.bg", text)
    at = text.index("zz")
    out = shown(Label(Span(source, at, at + 2), "here"), Label(Span(source, 4, 5), "there"))
    lines = out.splitlines()
    assert max(map(len, lines)) <= 110
    for number, line in enumerate(lines):
        if "^^ here" in line:
            assert lines[number - 1][line.index("^") :].startswith("zz +")
        if "- there" in line:
            assert lines[number - 1][line.index("-") :].startswith("a = b")
    assert sum("here" in line or "there" in line for line in lines) == 2


def test_a_long_line_with_many_labels_is_made_fit_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """A table of one line of a megabyte and a hundred findings took more than a minute."""
    widths: list[str] = []
    monkeypatch.setattr("bondgraph.text.render._cell_width", lambda c: widths.append(c) or 1)
    source = Source("m.bg", "é, " * 2000)
    findings = [
        Diagnostic("c", "wrong", (Label(Span(source, 3 * k, 3 * k + 1), "here"),), "mend it")
        for k in range(100)
    ]
    assert render(findings, False).count("^ here") == 100
    assert len(widths) == 6000


def test_control_characters_do_not_reach_the_terminal() -> None:
    source = Source("m\x1b[2J.bg", "bg\x1b[31m 1\u202e\x00\ud800\n")
    out = render([Diagnostic("c", "name `\x1b[0m`", (Label(Span(source, 0, 3), "\x07\n"),))], False)
    assert all(c.isprintable() or c == "\n" for c in out)
    out.encode()


def test_colours_change_nothing_else() -> None:
    labels = (Label(span("Se:U2"), "x"), Label(span("Se:U1"), "y"), Label(span("j -> Se"), "z"))
    diagnostic = Diagnostic("c", "m", labels, "help")
    plain, painted = render([diagnostic], False), render([diagnostic], True)
    assert "\x1b[1;31m^^^^^" in painted
    assert re.sub("\x1b\\[[0-9;]*m", "", painted) == plain


def test_long_text_is_wrapped_and_code_in_help_is_kept() -> None:
    help = "word " * 60 + "\n    -> R:friction\nthen"
    lines = render([Diagnostic("c", "word " * 60, (), help)], False).splitlines()
    assert max(map(len, lines)) <= 100
    assert lines[-2:] == [" " * 14 + "-> R:friction", " " * 10 + "then"]


def test_json() -> None:
    label = Label(span("1:i {\n        -> I:L"), "t")
    (data,) = as_json([Diagnostic("c", "m", (label,), "h", "warning")])
    assert json.loads(json.dumps(data)) == {
        "code": "c",
        "severity": "warning",
        "message": "m",
        "labels": [{"path": "m.bg", "line": 6, "column": 5, "end_line": 7, "end_column": 15,
                    "text": "t"}],
        "help": "h",
        "edits": [],
    }  # fmt: skip


def test_nothing_is_rendered_as_nothing() -> None:
    assert render([], False) == ""


@given(
    st.text(st.characters() | st.sampled_from("\n\n\t \u3042\u0301"), max_size=60),
    st.lists(st.tuples(st.integers(-2, 64), st.integers(-2, 64), st.text(max_size=4)), max_size=4),
    st.booleans(),
)
def test_any_text_and_any_places(
    text: str, places: list[tuple[int, int, str]], color: bool
) -> None:
    source = Source("x.bg", text)
    labels = tuple(Label(Span(source, a, b), words) for a, b, words in places)
    diagnostics = [Diagnostic("c", text, labels, text)]
    out = render(diagnostics, color)
    assert out.startswith("\x1b[1;31merror[c]" if color else "error[c]")
    out.encode()
    json.dumps(as_json(diagnostics))
    if not color:
        primary = sum("^" in line for line in out.replace(text, "").splitlines())
        assert primary >= bool(labels) or "^" in text
