"""The pages of the documentation: their blocks, headings, anchors and sections."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("codegen/**/*.md")])

#: A fenced block: its language, its text.
FENCE = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)
#: A link within a line or over two: what it says, where it leads.
LINK = re.compile(r"\[([^\[\]]*)\]\(([^)\s]+)\)")


def slug(heading: str) -> str:
    """The anchor that a heading gets, here and on the site."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def anchors(page: Path) -> set[str]:
    """The anchors that the headings of a page give."""
    return {slug(h) for h in re.findall(r"^#+ (.+)$", prose(page), re.MULTILINE)}


def prose(page: Path) -> str:
    """A page without its fenced blocks."""
    return FENCE.sub("", page.read_text(encoding="utf-8"))


def sections(page: Path) -> dict[str, str]:
    """The text below each heading by its anchor, down to the next heading of its rank or above."""
    text = FENCE.sub(lambda m: re.sub(r"^#", " #", m[0], flags=re.MULTILINE),
                     page.read_text(encoding="utf-8"))  # fmt: skip
    found = {}
    marks = [*re.finditer(r"^(#+) (.+)$", text, re.MULTILINE)]
    for number, mark in enumerate(marks):
        later = (m.start() for m in marks[number + 1 :] if len(m[1]) <= len(mark[1]))
        found[slug(mark[2])] = text[mark.start() : next(later, len(text))]
    return found


def target(page: Path, link: str) -> tuple[Path, str]:
    """The file that a link of a page leads to, and the anchor in it."""
    path, _, anchor = link.partition("#")
    return ((page.parent / path).resolve() if path else page), anchor


def named(page: Path) -> str:
    """A page as a test says it: its path in the checkout."""
    return str(page.relative_to(ROOT))
