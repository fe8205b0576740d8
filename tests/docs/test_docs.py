"""Links lead somewhere, models in the documentation are sound, its examples run."""

from __future__ import annotations

import doctest
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import bondgraph
from bondgraph.cli.main import main
from bondgraph.cli.summary import report
from bondgraph.pipeline import Compilation
from bondgraph.runtime.log_file import write_log
from bondgraph.text.source import Source

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("codegen/**/*.md")])
_FENCE = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def anchors(page: Path) -> set[str]:
    """The anchors that the headings of a page give."""
    text = _FENCE.sub("", page.read_text(encoding="utf-8"))
    headings = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda p: str(p.relative_to(ROOT)))
def test_links_lead_somewhere(page: Path) -> None:
    text = _FENCE.sub("", page.read_text(encoding="utf-8"))
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"\w+:", target):
            continue
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        assert file.exists(), f"{page.name}: {target}"
        if anchor and file.suffix == ".md":
            assert anchor in anchors(file), f"{page.name}: {target}"


@pytest.mark.parametrize("page", PAGES, ids=lambda p: str(p.relative_to(ROOT)))
def test_paths_that_are_named_exist(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for path in re.findall(r"`((?:models|docs|bondgraph|codegen|tests)/[\w/.]*)`", text):
        assert (ROOT / path).exists(), f"{page.name}: {path}"


def test_the_way_to_the_controller(tmp_path: Path) -> None:
    """The commands of firmware.md, in order, with what they print."""
    (tmp_path / "models").symlink_to(ROOT / "models")
    env = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    printed, told = "", []
    for language, text in _FENCE.findall((ROOT / "docs" / "firmware.md").read_text()):
        if language == "toml":
            (tmp_path / "healthy.toml").write_text(text)
        elif language == "sh":
            done = subprocess.run(["sh", "-e", "-c", text], cwd=tmp_path, env=env, timeout=120,
                                  capture_output=True, text=True)  # fmt: skip
            assert done.returncode == 0, done.stderr
            printed = done.stdout
        elif not language:
            told.append(text)
            assert printed.endswith(text)
    assert len(told) == 2


def complete_models() -> list[tuple[str, str]]:
    """Every block of a page that is a whole .bg file."""
    found = []
    for page in PAGES:
        for language, text in _FENCE.findall(page.read_text(encoding="utf-8")):
            whole = text.startswith("bg 1\n") and text.count("{") == text.count("}")
            if language == "bg" and whole:
                found.append((str(page.relative_to(ROOT)), text))
    return found


@pytest.mark.parametrize(("page", "text"), complete_models())
def test_whole_models_in_the_documentation_compile(page: str, text: str) -> None:
    compilation = Compilation(Source(page, text))
    assert compilation.verification
    assert compilation.signatures.residuals


def test_the_tour_keeps_its_promise() -> None:
    page = (ROOT / "docs" / "language.md").read_text(encoding="utf-8")
    text = next(t for language, t in _FENCE.findall(page) if language == "bg")
    compilation = Compilation(Source("tour.bg", text))
    assert len(compilation.signatures.residuals) == 1


def test_the_grammar_in_the_manual_has_all_statements() -> None:
    from bondgraph.frontend.words import KEYWORDS

    page = (ROOT / "docs" / "language.md").read_text(encoding="utf-8")
    grammar = next(t for language, t in _FENCE.findall(page) if language == "ebnf")
    for word in KEYWORDS:
        assert f'"{word}"' in grammar


def test_the_manual_lists_the_domains_with_their_units() -> None:
    from bondgraph.library.units import DOMAINS

    page = (ROOT / "docs" / "language.md").read_text(encoding="utf-8")
    listed = re.findall(r"^  \| `(\w+)` \|", page, re.MULTILINE)
    assert sorted(listed) == sorted(DOMAINS)


@pytest.mark.parametrize("page", PAGES, ids=lambda p: str(p.relative_to(ROOT)))
def test_nothing_of_one_machine_is_written_down(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert not re.search(r"/(?:tmp|root|home|work)/", text)


def test_the_readme_shows_both_commands_and_the_code_at_once() -> None:
    head = "\n".join((ROOT / "README.md").read_text(encoding="utf-8").splitlines()[:20])
    for part in ("make run", "make test", "bg 1", "bondgraph compile", "```c"):
        assert part in head, part


def replaced(page: Path, old: str, new: str) -> None:
    page.write_text(page.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")


def test_the_code_in_the_readme_is_what_the_robot_becomes(update: bool) -> None:
    page = ROOT / "README.md"
    shown = next(t for lang, t in _FENCE.findall(page.read_text(encoding="utf-8")) if lang == "c")
    artifacts = bondgraph.compile(ROOT / "models" / "khepera.bg").artifacts
    code = next(a.text for a in artifacts if a.path == "khepera.c")
    start = code.index("    const real g0 = ")
    lines = [line.removeprefix("    ") for line in code[start:].splitlines()]
    actual = "".join(f"{line}\n" for line in lines[: shown.count("\n")])
    if update:
        replaced(page, shown, actual)
    else:
        assert shown == actual


def test_the_report_in_the_readme_is_what_is_printed(
    monkeypatch: pytest.MonkeyPatch, update: bool
) -> None:
    monkeypatch.setenv("COLUMNS", "100")
    page = ROOT / "README.md"
    blocks = [text for _, text in _FENCE.findall(page.read_text(encoding="utf-8"))]
    shown = next(text for text in blocks if text.startswith("$ make run\n"))
    lines = report(bondgraph.compile(ROOT / "models" / "khepera.bg"), [])
    second = next(n for n, line in enumerate(lines) if line.startswith("r2"))
    actual = "\n".join(["$ make run", *lines[: second - 1], "...", ""])
    if update:
        replaced(page, shown, actual)
    else:
        assert shown == actual


@pytest.mark.parametrize("page", ["README.md", "docs/json.md"])
def test_examples_in_python_run(page: str, tmp_path: Path) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    (tmp_path / "models").symlink_to(ROOT / "models")
    command = tmp_path / "bondgraph"
    command.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m bondgraph "$@"\n')
    command.chmod(0o755)
    for language, program in _FENCE.findall(text):
        if language == "python":
            done = subprocess.run(
                [sys.executable, "-c", program],
                cwd=tmp_path,
                env={
                    **os.environ,
                    "PYTHONPATH": str(ROOT),
                    "PATH": f"{tmp_path}:{os.environ['PATH']}",
                },
                capture_output=True,
                text=True,
                check=False,
            )
            assert done.returncode == 0, done.stderr
            assert "r1" in done.stdout


def test_the_page_about_python_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    done = doctest.testfile(str(ROOT / "docs" / "python.md"), module_relative=False)
    assert done.attempted > 20
    assert done.failed == 0


def test_the_page_about_fleets_runs_and_shows_what_is_printed(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    update: bool,
) -> None:
    page = ROOT / "docs" / "fleets.md"
    text = page.read_text(encoding="utf-8")
    monkeypatch.chdir(ROOT)
    example = doctest.DocTestParser().get_doctest(text, {}, page.name, str(page), 0)
    done = doctest.DocTestRunner().run(example, clear_globs=False)
    assert done.attempted > 10 and done.failed == 0
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "100")
    Path("models").symlink_to(ROOT / "models")
    Path("runs").mkdir()
    for name, log in example.globs["runs"].items():
        write_log(log, f"runs/{name}.csv")
    Path("runs/press4.csv").write_text("t,U\n" + "".join(f"{k},6\n" for k in range(9)))
    shown = next(t for _, t in _FENCE.findall(text) if t.startswith("$ bondgraph monitor"))
    words = shown.splitlines()[0].split()[2:]
    assert main(words) == 0
    actual = f"{shown.splitlines()[0]}\n{capsys.readouterr().out}"
    if update:
        replaced(page, shown, actual)
    else:
        assert shown == actual
