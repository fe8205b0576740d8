"""The canonical layout: what it looks like, and that it never changes what is said."""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from bondgraph.frontend.formatter import format_text
from bondgraph.frontend.lexer import split
from bondgraph.frontend.parser import parse
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source
from tests.unit.frontend import corpus, texts
from tests.unit.frontend.trees import bare, good, read

MODELS = sorted((Path(__file__).parents[3] / "models").glob("*.bg"))


def _formatted(text: str) -> str:
    report = Report()
    out = format_text(Source("test.bg", text), report)
    assert report.diagnostics == []
    assert out is not None
    return out


def _comments(text: str) -> list[str]:
    gaps = split(text).gaps
    lines = [line for at in sorted(gaps) for line in gaps[at][1].split("\n")]
    return [line.strip() for line in lines if line.strip()]


def _same(text: str) -> str:
    """Format, and compare what must not change."""
    out = _formatted(text)
    assert bare(good(out)) == bare(good(text))
    assert _comments(out) == _comments(text)
    assert [w for w in split(out).words if w != ";"] != []
    assert _formatted(out) == out
    return out


LAYOUTS = {
    "indent": (
        "bg 1\nmodel M{\n1:i{\n<-Se:U\n->R:r=2*a\n}\n}",
        "bg 1\nmodel M {\n    1:i {\n        <- Se:U\n        -> R:r = 2*a\n    }\n}\n",
    ),
    "one statement in a line": (
        "bg 1; model M {\n a->b;R:r; ;\n}",
        "bg 1\nmodel M {\n    a -> b\n    R:r\n}\n",
    ),
    "blank lines": (
        "\n\nbg 1\n\n\n\nmodel M {\n\n\n  R:a\n\n\n  R:b\n  R:c\n\n}\n\n\n",
        "bg 1\n\nmodel M {\n    R:a\n\n    R:b\n    R:c\n}\n",
    ),
    "short braces": (
        "bg 1\nmodel M {\nif a{R:x}\nelse{R:y}\nR:z{e=f;}\n1:i{}\n0:j{\n}\n}",
        "bg 1\nmodel M {\n    if a { R:x } else { R:y }\n    R:z { e = f }\n"
        "    1:i {}\n    0:j {}\n}\n",
    ),
    "declarations": (
        "bg 1\nmodel M(n:int=1,b:bool) {\nport a:in electrical\nparam R:Ohm\nparam k=3 N.m/A+-5 %\n"
        "const c=-2\ninput x:bool\nsensor s:rad=int(a.f,0 rad)counts 24/turn\n"
        "fault f:line.R+=100 Ohm\nfor j in 1 .. n{a[j]->b}\nTF : N(a=1 , b=-w)\na-[ 7 ]->b\n}",
        "bg 1\nmodel M(n : int = 1, b : bool) {\n    port a : in electrical\n    param R : Ohm\n"
        "    param k = 3 N.m/A +- 5%\n    const c = -2\n    input x : bool\n"
        "    sensor s : rad = int(a.f, 0 rad) counts 24/turn\n    fault f : line.R += 100 Ohm\n"
        "    for j in 1..n { a[j] -> b }\n    TF:N(a = 1, b = -w)\n    a -[7]-> b\n}\n",
    ),
    "operators": (
        "bg 1\nmodel M {\nlet a=x<-1\nlet b=5 m / x+5 m*y ^ -2-( -z )\n"
        "let c=not(a)and - b<=m [ 1 ] . f\n"
        "let d = 5 m ^ 2\nlet e = if( a,b , - c )\nlet f = - - x/ -y\n}",
        "bg 1\nmodel M {\n    let a = x < -1\n    let b = 5 m / x + 5 m*y^-2 - (-z)\n"
        "    let c = not (a) and -b <= m[1].f\n    let d = 5 m ^ 2\n    let e = if(a, b, -c)\n"
        "    let f = --x/-y\n}\n",
    ),
    "comments": (
        "# top  \n\nbg 1 # one\n#two\nmodel M { # opened\n## doc\n R:a #short\n"
        " R:bcd    # longer\n\n\n"
        " # own\n\n R:e\n # last\n}\n# end",
        "# top\n\nbg 1  # one\n#two\nmodel M {  # opened\n    ## doc\n    R:a    #short\n"
        "    R:bcd  # longer\n\n    # own\n\n    R:e\n    # last\n}\n# end\n",
    ),
    "comments inside": (
        "bg 1\nmodel M {\n a -> # first\n # between\n b\n let x = f(1, # one\n 2)\n}",
        "bg 1\nmodel M {\n    a ->  # first\n            # between\n            b\n"
        "    let x = f(1,  # one\n            2)\n}\n",
    ),
    "continued lines": (
        "bg 1\nmodel M {\n a ->\n b ->\n c\n let x = f(\n 1,\n 2\n )\n}",
        "bg 1\nmodel M {\n    a -> b -> c\n    let x = f(1, 2)\n}\n",
    ),
}


@pytest.mark.parametrize("name", LAYOUTS)
def test_layout(name: str) -> None:
    before, after = LAYOUTS[name]
    assert _same(before) == after


def test_a_long_chain_is_broken_after_its_arrows() -> None:
    long = " -> ".join(f"R:resistor{n}(q0 = {n} rad)" for n in range(8))
    out = _same(corpus.whole(long)).split("\n")[2:-2]
    assert all(len(line) <= 100 for line in out)
    assert [line.endswith("->") for line in out] == [True] * (len(out) - 1) + [False]
    assert out[1].startswith("            R:resistor")


def test_a_long_sum_is_broken_between_its_terms() -> None:
    long = " + ".join(f"f(alpha{n}, beta{n}*gamma{n})" for n in range(8))
    out = _same(corpus.whole("let x = " + long)).split("\n")[2:-2]
    assert all(len(line) <= 100 for line in out)
    assert [line.endswith("+") for line in out] == [True] * (len(out) - 1) + [False]


def test_braces_that_do_not_fit_are_opened() -> None:
    bonds = "; ".join(f"-> R:resistor{n}" for n in range(8))
    out = _same(corpus.whole("1:i { " + bonds + " }")).split("\n")[2:-2]
    assert out[0] == "    1:i {"
    assert len(out) == 10


def test_a_wrong_file_is_not_formatted() -> None:
    report = Report()
    assert format_text(Source("test.bg", corpus.whole("a ->")), report) is None
    assert [d.code for d in report.diagnostics] == ["syntax-unexpected"]


def test_errors_of_other_files_do_not_matter() -> None:
    report = Report()
    parse(Source("other.bg", ""), report)
    assert format_text(Source("test.bg", "bg 1"), report) == "bg 1\n"


@pytest.mark.parametrize("body", corpus.RIGHT)
def test_right_statements(body: str) -> None:
    _same(corpus.whole(body))
    _same("bg 1\nmodel M { " + body.replace("#", "\n#") + "\n}")


@pytest.mark.parametrize("text", [*corpus.FILES_RIGHT, corpus.sample()])
def test_right_files(text: str) -> None:
    _same(text)


@pytest.mark.parametrize("path", MODELS, ids=lambda p: p.stem)
def test_models(path: Path) -> None:
    _same(path.read_text(encoding="utf-8"))


#: Shrinking a whole model takes minutes.
_PHASES = [Phase.explicit, Phase.reuse, Phase.generate]


@settings(max_examples=100, deadline=None, phases=_PHASES, suppress_health_check=list(HealthCheck))
@given(texts.models())
def test_any_model_keeps_its_meaning(text: str) -> None:
    _same(text)


@settings(max_examples=200, deadline=None)
@given(st.randoms(use_true_random=False), st.integers(1, 4))
def test_any_mutation_gives_a_file_or_a_diagnostic(chance: Random, times: int) -> None:
    pieces = split(corpus.sample())
    text = corpus.sample()
    for _ in range(times):
        at = chance.randrange(len(text))
        end = at + chance.randrange(30)
        other = chance.choice(pieces.words)
        text = text[:at] + other + text[end:]
    _answers(text)


def test_any_beginning_and_any_end_of_a_model_gets_an_answer() -> None:
    text = corpus.sample()
    for start in split(text).starts[::3]:
        read(text[:start])
        read("bg 1\nmodel M {\n" + text[start:])
    for body in corpus.RIGHT:
        for start in split(body).starts:
            _answers("bg 1\nmodel M {\n" + body[:start])


@settings(max_examples=200, deadline=None)
@given(st.text() | st.text('bgmodelRx01 :;{}()[]<->.=,+#\n"%^', max_size=80))
def test_any_text_gives_a_file_or_a_diagnostic(text: str) -> None:
    _answers(text)
    _answers("bg 1\nmodel M {\n" + text + "\n}")


def _answers(text: str) -> None:
    tree, report = read(text)
    assert tree is not None or report.diagnostics
    assert all(d.help and d.labels for d in report.diagnostics if d.code != "syntax-many")
    for diagnostic in report.diagnostics:
        for label in diagnostic.labels:
            assert 0 <= label.span.start <= label.span.end <= len(text)
    if not report.diagnostics:
        _same(text)


def test_a_text_of_many_models() -> None:
    models = [corpus.sample()[5:].replace("model ", f"model M{n}_") for n in range(125)]
    good("bg 1\n" + "\n".join(models))
