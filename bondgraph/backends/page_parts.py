"""What pages with charts share: scripts and styles as files by the path that they are served at."""

from __future__ import annotations

from functools import cache

from bondgraph.backends.templates import codegen

_SCRIPTS = ("dom.js", "charts.js", "uplot.js")


@cache
def part(path: str) -> str:
    """The text of a file in `codegen/`, as it is."""
    return (codegen() / path).read_text(encoding="utf-8")


def scripts(folder: str, names: tuple[str, ...]) -> dict[str, tuple[str, str]]:
    """These of a folder and the shared ones, each as (type, text), with the licenses of others."""
    own = {f"/{name}": ("text/javascript", part(f"{folder}/{name}")) for name in names}
    shared = {f"/{name}": ("text/javascript", part(f"pages/{name}")) for name in _SCRIPTS}
    licenses = {"/uplot.LICENSES.txt": ("text/plain", part("pages/uplot.LICENSES.txt"))}
    return own | shared | licenses


def chart_style() -> str:
    """The style of charts."""
    return part("pages/uplot.css") + "\n" + part("pages/charts.css")
