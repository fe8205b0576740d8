"""Each error code has a page, and its two models do what the page says."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

import bondgraph
from bondgraph import errors
from bondgraph.pipeline import Compilation
from bondgraph.text.diagnostic import CompileError, Diagnostic
from bondgraph.text.source import Source

PACKAGE = Path(bondgraph.__file__).parent
_CODE = re.compile(r"[a-z]+(-[a-z]+)*")
_REPORTING = frozenset(
    "error warning info complain problem fail Odd SyntaxProblem Diagnostic _refuse _foreign".split()
)
_FORM = re.compile(
    r"# (?P<code>[a-z-]+)\n\n(?P<text>.+?)\n\n"
    r"## Wrong\n\n```(?P<kind>bg|sh|text)\n(?P<wrong>.*?)```\n\n"
    r"## Mended\n\n```(?P<other>bg|sh|text)\n(?P<mended>.*?)```\n",
    re.DOTALL,
)


def _reported() -> set[str]:
    """The codes that the source reports."""
    found = set()
    for file in PACKAGE.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.Call):
                continue
            name = getattr(node.func, "attr", getattr(node.func, "id", ""))
            if name in _REPORTING:
                words = [a.value for a in node.args[:3] if isinstance(a, ast.Constant)]
                if words and isinstance(words[0], str) and _CODE.fullmatch(words[0]):
                    found.add(words[0])
    return found


def _parts(code: str) -> re.Match[str]:
    text = errors.page(code)
    assert text is not None
    form = _FORM.fullmatch(text)
    assert form is not None, f"{code}.md has not the form of a page"
    assert form["code"] == code
    assert form["kind"] == form["other"]
    assert max(map(len, text.splitlines())) <= 100
    return form


def _diagnostics(text: str, code: str) -> tuple[Diagnostic, ...]:
    """What the compiler says about a model, as far as it takes to meet `code`."""
    compilation = Compilation(Source("page.bg", text))
    try:
        for stage in ("integral", "derivative", "reduced", "signatures", "verification"):
            getattr(compilation, stage)
            if any(d.code == code for d in compilation.report.diagnostics):
                break
    except CompileError as error:
        return error.diagnostics
    return tuple(compilation.report.diagnostics)


def test_every_code_has_a_page_and_every_page_a_code() -> None:
    reported = _reported()
    assert sorted(reported - set(errors.codes())) == []
    assert sorted(set(errors.codes()) - reported) == []


@pytest.mark.parametrize("code", errors.codes())
def test_wrong_is_wrong_in_this_way_only(code: str) -> None:
    form = _parts(code)
    if form["kind"] == "bg":
        found = _diagnostics(form["wrong"], code)
        severities = {d.severity for d in found if d.code == code}
        assert len(severities) == 1, [(d.code, d.message) for d in found]
        wrong = [d.code for d in found if d.severity == "error"]
        assert wrong == ([code] if severities == {"error"} else [])


@pytest.mark.parametrize("code", errors.codes())
def test_mended_is_sound(code: str) -> None:
    form = _parts(code)
    if form["kind"] == "bg":
        compilation = Compilation(Source("page.bg", form["mended"]))
        assert compilation.integral.graph is not None
        found = _diagnostics(form["mended"], code)
        assert code not in [d.code for d in found]


def test_no_page() -> None:
    assert errors.page("no-such-code") is None
    assert errors.page("../__init__") is None
