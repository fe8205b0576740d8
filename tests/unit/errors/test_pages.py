"""Each error code has a page, and what it shows is run: wrong in this way only, and then mended."""

from __future__ import annotations

import ast
import re
import shlex
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest

import bondgraph
from bondgraph import errors
from bondgraph.cli.main import main
from bondgraph.compilation import Compilation
from bondgraph.compilation import compile as open_model
from bondgraph.frontend.incidence import read_table
from bondgraph.passes.analysis.signatures import signatures
from bondgraph.passes.elimination import chaining as chain
from bondgraph.passes.elimination import shortfall
from bondgraph.passes.relation.form import relations
from bondgraph.text.diagnostic import CompileError, Diagnostic, Report, Severity
from bondgraph.text.limits import MODEL_BYTES
from bondgraph.text.source import Source
from tests.unit.passes.test_linear_block import grid

PACKAGE = Path(bondgraph.__file__).parent
ROOT = PACKAGE.parent
BRIEF = """bg 1
model M {{
    param R = 2 Ohm
    Se:U -> 1:i
    i -> R:R
    i -> Df:y
    {}
}}
"""
_CODE = re.compile(r"[a-z]+(-[a-z]+)*")
_REPORTING = frozenset(
    "error warning info complain problem fail Odd SyntaxProblem Diagnostic _refuse _foreign".split()
)
_PAGE = re.compile(
    r"# (?P<code>[a-z-]+)\n\n(?P<text>.+?)\n\n## Wrong\n\n(?P<wrong>.+?)\n\n"
    r"## Mended\n\n(?P<mended>.+)",
    re.DOTALL,
)
_BLOCK = re.compile(r"```(?P<kind>bg|toml|csv|sh|text)\n(?P<text>.*?)```\s*", re.DOTALL)
_SAID = re.compile(r"^(error|warning|note)\[([a-z-]+)\]", re.MULTILINE)


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


class Block(NamedTuple):
    """A fenced block of a page."""

    kind: str
    text: str

    def save(self, name: str) -> Path:
        """Write it here, under the name in its first line (`# name`) if there is one."""
        named = re.match(r"# ([\w-]+\.(?:bg|toml|csv))\n", self.text)
        path = Path(named[1] if named else name)
        path.write_text(self.text, encoding="utf-8")
        return path


def _section(code: str, section: str) -> list[Block]:
    """The blocks below a heading of a page, which has nothing else there."""
    text = errors.page(code)
    assert text is not None
    form = _PAGE.fullmatch(text)
    assert form is not None, f"{code}.md has not the form of a page"
    assert form["code"] == code
    assert max(map(len, text.splitlines())) <= 100
    found = [Block(m["kind"], m["text"]) for m in _BLOCK.finditer(form[section])]
    assert "".join(m[0] for m in _BLOCK.finditer(form[section])) == form[section]
    assert found
    return found


# ---------------------------------------------------------------- what a page shows is run


def _compiled(compilation: Compilation, until: str | None) -> list[Diagnostic]:
    """What the compiler says of a model, as far as it takes to meet the code `until`."""
    try:
        for stage in ("integral", "derivative", "reduced", "signatures", "verification"):
            getattr(compilation, stage)
            if any(d.code == until for d in compilation.report.diagnostics):
                break
    except CompileError as error:
        return list(error.diagnostics)
    return list(compilation.report.diagnostics)


def _model(path: Path, until: str | None) -> list[Diagnostic]:
    try:
        return _compiled(open_model(path), until)
    except CompileError as error:  # the file itself
        return list(error.diagnostics)


def _scenario(path: Path, model: Path | None) -> list[Diagnostic]:
    """Of a scenario for the motor, or for a model of its own that it moves."""
    compilation = open_model(model or ROOT / "models" / "dc_motor.bg")
    try:
        scenario = compilation.scenario(path)
        if model is not None:
            compilation.simulate(scenario)
    except CompileError as error:
        return list(error.diagnostics)
    return list(compilation.report.diagnostics)


def _table(text: str) -> list[Diagnostic]:
    report = Report()
    read_table(Source("table.csv", text), report)
    return report.diagnostics


#: The files that command lines in pages name, beside the shipped models.
FILES: dict[str, Callable[[], bytes]] = {
    "machine.bg": (ROOT / "models" / "dc_motor.bg").read_bytes,
    "model.bg": (ROOT / "models" / "dc_motor.bg").read_bytes,
    "measurements.bg": lambda: b"0.001,12.5,0.3\n" * (MODEL_BYTES // 15 + 1),
    "model.fmu": lambda: b"PK\x03\x04\x14\x00\x00\x00\x08\x00",  # how packed files begin
}
_SEVERITY: dict[str, Severity] = {"error": "error", "warning": "warning", "note": "info"}


def _command(line: str, capsys: pytest.CaptureFixture[str]) -> list[Diagnostic]:
    """What a command line prints, with the files that it names."""
    if not Path("models").exists():
        shutil.copytree(ROOT / "models", "models")
    words = shlex.split(line)
    for name in FILES.keys() & set(words):
        Path(name).write_bytes(FILES[name]())
    capsys.readouterr()
    main(words[1:])
    printed = capsys.readouterr().err
    return [Diagnostic(c, "", severity=_SEVERITY[s]) for s, c in _SAID.findall(printed)]


def _shown(
    blocks: list[Block], until: str | None, capsys: pytest.CaptureFixture[str]
) -> list[Diagnostic]:
    """What is said of the files of a section: its first one, in a folder with the others."""
    saved = [b.save(f"page.{b.kind}") for b in blocks if b.kind != "sh"]
    by_kind = {b.kind: b for b in reversed(blocks)}
    if "sh" in by_kind:
        return _command(by_kind["sh"].text, capsys)
    if "toml" in by_kind:
        model = next((p for p in saved if p.suffix == ".bg"), None)
        return _scenario(next(p for p in saved if p.suffix == ".toml"), model)
    if "bg" in by_kind:
        return _model(saved[0], until)
    return _table(by_kind["csv"].text)


# ------------------------------------------------------ what no page can show is provoked


def _deep(monkeypatch: pytest.MonkeyPatch, wrong: bool) -> str:
    """Ninety brackets are too many to print."""
    lets = "let low = tanh(tanh(y))\n    let x = tanh(tanh(low))"
    return BRIEF.format("let x = " + "tanh(" * 90 + "y" + ")" * 90 if wrong else lets)


def _many(monkeypatch: pytest.MonkeyPatch, wrong: bool) -> str:
    """So are forty wrong lines."""
    return BRIEF.format("?\n" * 50 if wrong else "")


def _large(monkeypatch: pytest.MonkeyPatch, wrong: bool) -> str:
    """The grid of the page has ten thousand junctions: one of 49, with a lower limit."""
    monkeypatch.setattr(chain, "LARGEST", 800)
    text = "bg 1\n" + grid(7)[0]
    for k in [] if wrong else [k for k in range(49) if 3 in divmod(k, 7) and k != 24]:
        text = text.replace(f"0:n{k} {{", f"0:n{k} {{ -> De:z{k};")  # the middle row and column
    return text


def _mistaken(monkeypatch: pytest.MonkeyPatch, wrong: bool) -> str:
    """Only a mistake of the compiler: here it forgets a term of the residual."""

    def forgetful(*args: Any) -> Any:
        residuals = relations(*args)
        first, *others = residuals.residuals
        pool = residuals.system.graph.pool
        sensor = residuals.system.graph.sensors[0].symbol
        wrong_one = first._replace(expr=pool.add((1, first.expr), (1, pool.der(sensor))))
        return residuals._replace(residuals=(wrong_one, *others))

    if wrong:
        monkeypatch.setattr("bondgraph.passes.relation.form.relations", forgetful)
    return BRIEF.format("")


def _denied(monkeypatch: pytest.MonkeyPatch, wrong: bool) -> str:
    """A branch that only the points of the check meet; here an entry is turned round."""

    def denied(*args: Any) -> Any:
        matrix = signatures(*args)
        first = tuple(not entry for entry in matrix.rows[0])
        return matrix._replace(rows=(first, *matrix.rows[1:]))

    if wrong:
        monkeypatch.setattr("bondgraph.passes.analysis.signatures.signatures", denied)
    return BRIEF.format("")


def _short(monkeypatch: pytest.MonkeyPatch, wrong: bool) -> str:
    """Only a model that the compiler does not master; here theory asks for one relation more."""
    if wrong:
        monkeypatch.setattr(shortfall, "match", lambda rows, n, _: ([-1] * n, [-1] * len(rows)))
        monkeypatch.setattr(shortfall, "independent", lambda system: 2)
    return BRIEF.format("")


#: Why the page cannot show it, with a model that is wrong in this way, and mended.
PROVOKED: dict[str, Callable[[pytest.MonkeyPatch, bool], str]] = {
    "expression-too-deep": _deep,
    "syntax-many": _many,
    "loop-too-large": _large,
    "signature-unconfirmed": _denied,
    "verification-failed": _mistaken,
    "relations-missing": _short,
}

#: What is said beside the code, for it is true of what is wrong there too.
BESIDE = {
    "syntax-many": {"syntax-character", "syntax-unexpected"},  # the many themselves
    "residual-undefined": {"part-not-driven"},  # it divides by what rests
    "sources-contradict": {"algebraic-loop"},  # the ring in which the flow of the source cancels
}


@pytest.fixture
def said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[[str, str], list[Diagnostic]]:
    """What is said of one section of a page, with all that it shows in a folder of its own."""
    monkeypatch.chdir(tmp_path)

    def run(code: str, section: str) -> list[Diagnostic]:
        blocks = _section(code, section)
        provoke = PROVOKED.get(code)
        assert ([b.kind for b in blocks] == ["text"]) == (provoke is not None)
        if provoke is not None:
            with monkeypatch.context() as patch:
                blocks = [Block("bg", provoke(patch, section == "wrong"))]
                return _shown(blocks, None, capsys)
        return _shown(blocks, code, capsys)

    return run


def test_every_code_has_a_page_and_every_page_a_code() -> None:
    reported = _reported()
    assert sorted(reported - set(errors.codes())) == []
    assert sorted(set(errors.codes()) - reported) == []


@pytest.mark.parametrize("code", errors.codes())
def test_wrong_is_wrong_in_this_way_only_and_mended_is_not(
    code: str, said: Callable[[str, str], list[Diagnostic]]
) -> None:
    """Exactly this code tells the two apart: as the only error, or beside none."""
    found = said(code, "wrong")
    told = {d.code for d in found}
    assert code in told, [(d.code, d.message) for d in found]
    severities = {d.severity for d in found if d.code == code}
    wrong = {d.code for d in found if d.severity == "error"} - BESIDE.get(code, set())
    assert wrong == ({code} if severities == {"error"} else set())
    mended = said(code, "mended")
    assert [d.code for d in mended if d.severity == "error"] == []
    rest = {d.code for d in mended}
    assert code not in rest
    assert told - rest - BESIDE.get(code, set()) == {code}


def test_no_page() -> None:
    assert errors.page("no-such-code") is None
    assert errors.page("../__init__") is None
