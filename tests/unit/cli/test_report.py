"""The report of a model: one page, whole, fetching nothing, the same bytes every time."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

import pytest

from bondgraph.cli.main import main

ROOT = Path(__file__).parents[3]
MODELS = [
    ROOT / "models" / f"{name}.bg"
    for name in "cable chassis dc_motor khepera microphone rc_loop slider_crank".split()
]
VOID = frozenset("br hr img input link meta wbr col".split())


class Page(HTMLParser):
    """What a page holds: elements with attributes, text, and whether all tags are closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.words: list[str] = []
        self.feed(text)
        self.close()
        assert not self.open, self.open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self.open, tag
        assert self.open.pop() == tag, tag

    def handle_data(self, data: str) -> None:
        if not {"style", "script"} & set(self.open):
            self.words.append(data)

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.words).split())


def report(model: Path, folder: Path, *more: str, status: int = 0) -> str:
    out = folder / "page.html"
    assert main(["report", str(model), "-o", str(out), *more]) == status
    return out.read_text(encoding="utf-8")


@pytest.mark.parametrize("model", MODELS, ids=lambda p: p.stem)
def test_a_page_is_whole_and_fetches_nothing(model: Path, tmp_path: Path) -> None:
    text = report(model, tmp_path)
    page = Page(text)
    for tag, attributes in page.elements:
        for name in ("src", "href", "srcset", "action", "data", "poster", "xlink:href"):
            value = attributes.get(name)
            assert value is None or value.startswith("#"), (tag, value)
        assert tag not in ("link", "iframe", "object", "embed", "base")
    assert not re.search(r"url\(|@import", text)
    policy = next(a["content"] for t, a in page.elements if a.get("http-equiv"))
    assert policy is not None and policy.startswith("default-src 'none'")
    ids = [a["id"] for _, a in page.elements if "id" in a]
    assert len(ids) == len(set(ids))
    links = [a["href"] for t, a in page.elements if t == "a"]
    assert links and all(link is not None and link[1:] in ids for link in links)


def test_any_hash_seed_gives_the_same_bytes(tmp_path: Path) -> None:
    pages = []
    for seed in ("0", "7"):
        out = tmp_path / f"{seed}.html"
        subprocess.run(
            [sys.executable, "-m", "bondgraph", "report", "models/chassis.bg", "-o", str(out)],
            cwd=ROOT,
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT)},
            check=True,
            capture_output=True,
        )
        pages.append(out.read_bytes())
    assert pages[0] == pages[1]
