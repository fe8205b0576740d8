"""The field's words stand where a reader looks: glossary, index, and the pages read first."""

from __future__ import annotations

import re

import pytest

from tests.docs.pages import LINK, ROOT, sections, target

GLOSSARY = ROOT / "docs" / "glossary.md"
INDEX = ROOT / "docs" / "reader_index.md"

#: What a reader of the field expects on the first pages.
FIRST = {
    "README.md": "ARR FSM residual detectability isolability SCAP MSO Dulmage-Mendelsohn CUSUM"
    " false-alarm dualised threshold signature causality",
    "docs/language.md": "ARR FSM residual dualised causality signature fault",
    "docs/cli.md": "ARR FSM MSO Dulmage detectability isolability causality false-alarm",
    "docs/monitoring.md": "ARR residual CUSUM Detection Isolation threshold signature",
    "docs/tuning.md": "CUSUM false-alarm threshold residual delay",
    "docs/isolability.md": "isolability signature residual",
}


def entries() -> list[tuple[str, str]]:
    """The terms of the glossary with their texts, in order."""
    text = GLOSSARY.read_text(encoding="utf-8")
    return re.findall(r"^## ([^\n]+)\n\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize(("page", "words"), FIRST.items())
def test_the_first_pages_have_the_words_of_the_field(page: str, words: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    assert [word for word in words.split() if word not in text] == []


def test_the_glossary_is_in_order_and_each_term_stands_once() -> None:
    terms = [term for term, _ in entries()]
    assert len(terms) >= 50
    assert terms == sorted(set(terms), key=str.lower)


@pytest.mark.parametrize(("term", "text"), entries())
def test_a_term_has_its_meaning_its_source_and_its_place(term: str, text: str) -> None:
    meaning, source, here = re.fullmatch(
        r"(.*?)\n\n\*Source:\* (.*?)\.?\s\*Here:\*\s(.*?)\n+", text, re.DOTALL
    ).groups()  # type: ignore[union-attr]
    assert 60 <= len(meaning) <= 700 and meaning.endswith(".") and "\n\n" not in meaning
    assert re.search(r"\b(?:19|20)\d\d\b", source) or source == "this project"
    assert LINK.search(here)


def index_rows() -> list[tuple[list[str], list[str]]]:
    """Each row of the index: the words it is for, and where it leads."""
    rows = re.findall(r"^\| ([^|]+) \| (.*) \|$", INDEX.read_text(encoding="utf-8"), re.MULTILINE)
    return [
        (words.replace("`", "").split(", "), [where for _, where in LINK.findall(links)])
        for words, links in rows
        if words != "Term"
    ]


def test_the_index_is_in_order_and_long_enough() -> None:
    terms = [words[0] for words, _ in index_rows()]
    assert len(terms) >= 40
    assert terms == sorted(set(terms), key=str.lower)


@pytest.mark.parametrize(("words", "links"), index_rows(), ids=lambda v: str(v[0]))
def test_the_index_leads_to_places_that_use_the_word(words: list[str], links: list[str]) -> None:
    assert links
    for link in links:
        page, anchor = target(INDEX, link)
        text = sections(page)[anchor] if anchor else page.read_text(encoding="utf-8")
        plain = re.sub(r"[\s`*]+", " ", re.sub(r"\]\([^)]*\)", "]", text)).lower()
        assert any(word.lower() in plain for word in words), f"{words[0]}: {link}"
