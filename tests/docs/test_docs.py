"""Links lead somewhere, models in the documentation are sound, its examples run."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import bondgraph
from bondgraph.cli.summary import report
from bondgraph.compilation import Compilation
from bondgraph.text.source import Source
from tests.docs.pages import FENCE, PAGES, ROOT, anchors, named, prose, target


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_links_lead_somewhere(page: Path) -> None:
    for link in re.findall(r"\]\(([^)\s]+)\)", prose(page)):
        if re.match(r"\w+:", link):
            continue
        file, anchor = target(page, link)
        assert file.exists(), f"{page.name}: {link}"
        if anchor and file.suffix == ".md":
            assert anchor in anchors(file), f"{page.name}: {link}"


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_paths_that_are_named_exist(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for path in re.findall(r"`((?:models|docs|bondgraph|codegen|tests)/[\w/.]*)`", text):
        assert (ROOT / path).exists(), f"{page.name}: {path}"


def test_the_tour_keeps_its_promise() -> None:
    page = (ROOT / "docs" / "language.md").read_text(encoding="utf-8")
    text = next(t for language, t in FENCE.findall(page) if language == "bg")
    compilation = Compilation(Source("tour.bg", text))
    assert len(compilation.signatures.residuals) == 1


def test_the_grammar_in_the_manual_has_all_statements() -> None:
    from bondgraph.frontend.words import KEYWORDS

    page = (ROOT / "docs" / "language.md").read_text(encoding="utf-8")
    grammar = next(t for language, t in FENCE.findall(page) if language == "ebnf")
    for word in KEYWORDS:
        assert f'"{word}"' in grammar


def test_the_manual_lists_the_domains_with_their_units() -> None:
    from bondgraph.library.units import DOMAINS

    page = (ROOT / "docs" / "language.md").read_text(encoding="utf-8")
    listed = re.findall(r"^  \| `(\w+)` \|", page, re.MULTILINE)
    assert sorted(listed) == sorted(DOMAINS)


@pytest.mark.parametrize("page", PAGES, ids=named)
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
    shown = next(t for lang, t in FENCE.findall(page.read_text(encoding="utf-8")) if lang == "c")
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
    blocks = [text for _, text in FENCE.findall(page.read_text(encoding="utf-8"))]
    shown = next(text for text in blocks if text.startswith("$ make run\n"))
    lines = report(bondgraph.compile(ROOT / "models" / "khepera.bg"), [])
    second = next(n for n, line in enumerate(lines) if line.startswith("r2"))
    actual = "\n".join(["$ make run", *lines[: second - 1], "...", ""])
    if update:
        replaced(page, shown, actual)
    else:
        assert shown == actual
