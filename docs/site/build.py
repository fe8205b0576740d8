"""Builds the site of the documentation below build/site and checks it: `python docs/site/build.py`.

The pages stay where they are in the repository. They are copied with their folders into
build/site/pages, so that their links hold there as they do here; what a link leads to beside pages
(a model, a folder) becomes a page that shows it. Gallery, interface and diagnostics are made here.
A warning of Sphinx, a link that leads nowhere or a file of another host is an error.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import sys
import tomllib
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

import gallery
from sphinx.cmd.build import main as sphinx

import bondgraph

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
OUT = ROOT / "build" / "site"
PAGES = OUT / "pages"
HTML = OUT / "html"

_FENCE = re.compile(r"^( *)(```+).*?^\1\2 *$", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"(\]\()([^)\s]+)(\))")
_ELSEWHERE = re.compile(r"(?:url\(|@import)\s*['\"]?((?:https?:)?//[^'\")]+)")
_ORPHAN = "---\norphan: true\n---\n"
_INSTALLED = {"node_modules", "dist"}  # folders of what others wrote, and of what is built

#: Names of Python in the order in which a reader meets them, from where they are.
INTERFACE = {
    "Compiling": ["bondgraph.compile", "bondgraph.Compilation", "bondgraph.Options"],
    "Relations": ["bondgraph.views.Relations", "bondgraph.views.Relation"],
    "Simulation": [
        "bondgraph.Scenario", "bondgraph.Course", "bondgraph.Fault", "bondgraph.Instrument",
        "bondgraph.Controller", "bondgraph.Sampling", "bondgraph.Plane",
        "bondgraph.SimulationError",
    ],
    "Monitoring": [
        "bondgraph.monitor", "bondgraph.Fleet", "bondgraph.Log", "bondgraph.Tuning",
        "bondgraph.Limit", "bondgraph.NativeError",
    ],
    "Errors and files": [
        "bondgraph.CompileError", "bondgraph.Source", "bondgraph.ForeignFiles",
    ],
}  # fmt: skip


def main() -> int:
    """Stage the pages, build those that have changed, and check what was built."""
    os.environ["COLUMNS"] = "88"  # of what commands would print, as wide as a page is
    Stage().all()
    cache = OUT / "cache"
    failed = sphinx(["-b", "html", "-W", "--keep-going", "-q", "-j", "auto", "-c", str(HERE),
                     "-d", str(cache), str(PAGES), str(HTML)])  # fmt: skip
    if failed:
        shutil.rmtree(cache)  # it would not warn of these pages again
        return failed
    wrong = [*outside(HTML), *broken(HTML)]
    print(*wrong, sep="\n", end="\n" if wrong else "")
    pages = sum(1 for _ in HTML.rglob("*.html"))
    print(f"{pages} pages in {HTML.relative_to(ROOT)}, {len(wrong)} links or files that are wrong")
    return 1 if wrong else 0


class Stage:
    """The pages of the site, being put together."""

    def __init__(self) -> None:
        with (HERE / "contents.toml").open("rb") as file:
            self.parts = tomllib.load(file)["part"]
        listed = [path(page) for part in self.parts for page in part["pages"]]
        self.models = sorted((ROOT / "models").glob("*.bg"))
        self.shown = {
            *(ROOT / page for page in listed if not page.startswith("made:")),
            *ROOT.glob("docs/decisions/*.md"),
            *ROOT.glob("bondgraph/errors/*.md"),
        }
        missing = {*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")} - self.shown
        if missing:
            raise SystemExit(f"not in contents.toml: {sorted(map(str, missing))}")
        #: Files and folders that links lead to, with the pages that show them.
        self.wanted: dict[Path, Path] = {}
        self.written: set[Path] = set()

    def all(self) -> None:
        """Write every page."""
        for page in sorted(self.shown):
            self.write(page.relative_to(ROOT), self.head(page) + self.links(page) + self.tail(page))
        for picture in (ROOT / "docs" / "pictures").iterdir():
            self.write(picture.relative_to(ROOT), picture.read_bytes())
        for model in self.models:
            for name, text in gallery.page(model).items():
                self.write(Path("models", name), text)
        self.write(Path("models", "gallery.md"), gallery.index(self.models))
        self.write(Path("interface.md"), interface())
        self.write(Path("diagnostics.md"), diagnostics())
        self.listings()
        for old in {path for path in PAGES.rglob("*") if path.is_file()} - self.written:
            old.unlink()

    def write(self, path: Path, text: str | bytes) -> None:
        """One file, at its path in the repository; Sphinx goes by the time at which it changed."""
        place = PAGES / path
        self.written.add(place)
        data = text.encode() if isinstance(text, str) else text
        if place.exists() and place.read_bytes() == data:
            return
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(data)

    def head(self, page: Path) -> str:
        """Diagnostics are too many for the menu, which every page has; their list leads to them."""
        return _ORPHAN if page.parent == ROOT / "bondgraph" / "errors" else ""

    def tail(self, page: Path) -> str:
        """What the front page of the site or of a folder has below its text: the menu."""
        if page == ROOT / "README.md":
            return "".join(self.menu(part) for part in self.parts)
        if page.name == "README.md" and page.parent.name == "decisions":
            names = sorted(p.name for p in page.parent.glob("*.md") if p != page)
            return menu("", names)
        return ""

    def menu(self, part: dict[str, list[str]]) -> str:
        """A part of the menu, as the front page holds it."""
        made = {"made:gallery": "models/gallery.md", "made:interface": "interface.md",
                "made:diagnostics": "diagnostics.md"}  # fmt: skip
        made["README.md"] = "self"
        entries = part["pages"]
        entries = [e.replace(path(e), made.get(path(e), path(e))) for e in entries]
        return menu(part["title"], entries)

    def links(self, page: Path) -> str:
        """The text of a page, its links led to where the site has what they mean."""
        text = page.read_text(encoding="utf-8")
        fences = [m.span() for m in _FENCE.finditer(text)]

        def led(match: re.Match[str]) -> str:
            inside = any(a <= match.start() < b for a, b in fences)
            if inside or re.match(r"\w+:", match[2]) or match[2].startswith("#"):
                return match[0]
            path, hash_, anchor = match[2].partition("#")
            target = (page.parent / path).resolve()
            if target in self.shown or target.suffix in (".svg", ".png"):
                return match[0]
            there = relative(self.place(target), page.relative_to(ROOT).parent)
            return f"{match[1]}{there}{hash_}{anchor}{match[3]}"

        return _LINK.sub(led, text)

    def place(self, target: Path) -> Path:
        """The page that shows a file or folder of the repository."""
        path = target.relative_to(ROOT)
        if target in self.models:
            return path.with_name(f"{path.name}.md")
        special = {"models": "models/gallery.md", "docs/decisions": "docs/decisions/README.md"}
        if str(path) in special:
            return Path(special[str(path)])
        where = path / "contents.md" if target.is_dir() else path.with_name(f"{path.name}.md")
        self.wanted[target] = where
        return where

    def listings(self) -> None:
        """Pages of what links lead to beside pages: files as they are, folders as lists."""
        done: set[Path] = set()
        while left := [target for target in self.wanted if target not in done]:
            for target in left:
                done.add(target)
                where = self.wanted[target]
                title = str(target.relative_to(ROOT))
                body = self.listing(target) if target.is_dir() else block(target)
                self.write(where, f"{_ORPHAN}# {title}\n\n{body}\n")

    def listing(self, folder: Path) -> str:
        """What is in a folder, with links to what a person reads."""
        lines = []
        for entry in sorted(folder.iterdir()):
            if entry.name.startswith((".", "__")) or entry.name in _INSTALLED:
                continue
            read = entry.is_dir() or entry.name.endswith((".bg", ".md", ".toml", ".c"))
            where = relative(self.place(entry), self.wanted[folder].parent) if read else ""
            lines.append(f"- [{entry.name}]({where})" if read else f"- `{entry.name}`")
        return "\n".join(lines)


def path(entry: str) -> str:
    """The page that a line of the menu is for, `page.md` or `Title <page.md>`."""
    return entry.partition("<")[2].rstrip(">") or entry


def block(file: Path) -> str:
    """A file as it is, in a fence that nothing in it closes; of a notebook its cells."""
    if file.suffix == ".ipynb":
        return notebook(json.loads(file.read_text(encoding="utf-8")))
    kinds = {".bg": "bg", ".c": "c", ".h": "c", ".py": "python", ".toml": "toml", ".json": "json"}
    text = file.read_text(encoding="utf-8")
    return f"````{kinds.get(file.suffix, 'text')}\n{text}\n````"


def notebook(book: dict[str, Any]) -> str:
    """The cells of a notebook with their outputs, formulas as formulas."""
    parts = []
    for cell in book["cells"]:
        source = "".join(cell["source"])
        parts.append(source if cell["cell_type"] == "markdown" else f"```python\n{source}\n```")
        for output in cell.get("outputs", ()):
            data = output.get("data", {"text/plain": output.get("text", "")})
            formula = "".join(data.get("text/latex", "")).strip("$ \n")
            formula = formula.removeprefix("\\displaystyle")
            text = "".join(data.get("text/plain", ""))
            parts.append(f"```math\n{formula}\n```" if formula else f"```text\n{text}\n```")
    return "\n\n".join(parts)


def relative(path: Path, folder: Path) -> str:
    """The path of a page as a link in this folder says it."""
    up = [".."] * len(folder.parts)
    return "/".join([*up, *path.parts])


def menu(title: str, pages: list[str]) -> str:
    """A list of pages for the menu, hidden in the text."""
    caption = f":caption: {title}\n" if title else ""
    lines = "\n".join(pages)
    return f"\n```{{toctree}}\n:hidden:\n{caption}\n{lines}\n```\n"


def interface() -> str:
    """The page about Python, made of the docstrings."""
    public = {f"bondgraph.{name}" for name in bondgraph.__all__}
    listed = {name for names in INTERFACE.values() for name in names}
    if forgotten := sorted(public - listed):
        raise SystemExit(f"docs/site/build.py: INTERFACE has no {forgotten}")
    lines = ["# Python reference", "", "What `import bondgraph` gives, from its docstrings. A"
             " tour is on [another page](docs/python.md).", ""]  # fmt: skip
    for title, names in INTERFACE.items():
        lines += [f"## {title}", ""]
        for name in names:
            lines += ["```{eval-rst}", *documented(name), "```", ""]
    return "\n".join(lines)


def documented(name: str) -> list[str]:
    """The directive that documents one name: a function, or a class with its members."""
    *_, last = name.split(".")
    if last[0].islower():
        return [f".. autofunction:: {name}"]
    kept = ["   :inherited-members:"] if name == "bondgraph.Compilation" else []  # the stages
    return [f".. autoclass:: {name}", "   :members:", *kept]


def diagnostics() -> str:
    """The list of all codes of errors, warnings and notes, each with its page's first sentence."""
    rows = []
    for page in sorted((ROOT / "bondgraph" / "errors").glob("*.md")):
        text = page.read_text(encoding="utf-8").split("\n\n")[1]
        first = re.split(r"(?<=[.:])\s", " ".join(text.split()))[0]
        rows.append(f"| [{page.stem}](bondgraph/errors/{page.name}) | {first} |")
    head = ["# Diagnostics", "", "Each code of an error, warning or note: what it means, a model"
            " that has it, and the same model mended, as `bondgraph explain CODE` prints it.", "",
            "| Code | |", "|---|---|"]  # fmt: skip
    return "\n".join([*head, *rows, ""])


class _Page(HTMLParser):
    """What a page of the site loads, what it links to, and the anchors it has."""

    def __init__(self) -> None:
        super().__init__()
        self.loads: list[str] = []
        self.leads: list[str] = []
        self.anchors: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Take note of one tag."""
        values = {name: value or "" for name, value in attrs}
        self.anchors |= {values[name] for name in ("id", "name") if name in values}
        if tag == "a" and "href" in values:
            self.leads.append(values["href"])
        elif tag == "link" and values.get("rel") in ("stylesheet", "icon", "preload"):
            self.loads.append(values.get("href", ""))
        elif "src" in values:
            self.loads.append(values["src"])


def read(folder: Path) -> dict[Path, _Page]:
    """All pages of the site."""
    pages = {}
    for file in folder.rglob("*.html"):
        pages[file] = _Page()
        pages[file].feed(file.read_text(encoding="utf-8"))
    return pages


def outside(folder: Path) -> Iterator[str]:
    """What a page or a style sheet would load from another host."""
    for file, page in read(folder).items():
        for load in page.loads:
            if urlsplit(load).netloc:
                yield f"{file.relative_to(folder)} loads {load}"
    for sheet in folder.rglob("*.css"):
        for load in re.findall(_ELSEWHERE, sheet.read_text(encoding="utf-8")):
            yield f"{sheet.relative_to(folder)} loads {load}"


def broken(folder: Path) -> Iterator[str]:
    """Links within the site that lead nowhere, be it page or anchor."""
    pages = read(folder)
    for file, page in pages.items():
        for lead in page.leads:
            parts = urlsplit(lead)
            if parts.scheme or parts.netloc:
                continue
            target = (file.parent / unquote(parts.path)).resolve() if parts.path else file
            if target in pages:
                if not parts.fragment or unquote(parts.fragment) in pages[target].anchors:
                    continue
            elif target.exists():
                continue
            yield f"{file.relative_to(folder)} leads to {lead}"


if __name__ == "__main__":
    sys.exit(main())
