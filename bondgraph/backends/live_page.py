"""The live page as files by the path that they are served at: HTML, style and scripts."""

from __future__ import annotations

from bondgraph.backends.drawing.style import colours, inside
from bondgraph.backends.page_parts import chart_style, part, scripts
from bondgraph.backends.templates import fill
from bondgraph.text.printable import printable

_SCRIPTS = (
    "main.js", "choice.js", "courses.js", "csv.js", "graph.js", "plane.js", "record.js", "said.js",
    "strips.js", "view.js",
)  # fmt: skip
_LIGHT, _DARK = (
    "--mark:#fff0b8;--band:#e4edf4;--trace:#a3a3a3;--line:#e7e3dc",
    ("--mark:#4d4212;--band:#22303a;--trace:#8a8a8a;--line:#2b3037"),
)


def live(title: str, doc: str, drawing: str) -> dict[str, tuple[str, str]]:
    """Each file as (type, text); `drawing` is a bare SVG. Nothing in them comes from elsewhere."""
    from markupsafe import Markup

    holes: dict[str, object] = {"title": title, "doc": doc, "drawing": Markup(drawing.rstrip())}
    html = fill("live/page.html.j2", holes, html=True)
    return {
        "/": ("text/html", printable(html)),
        "/live.css": ("text/css", _style()),
        **scripts("live", _SCRIPTS),
    }


def _style() -> str:
    """The style sheet; dark where that is asked for."""
    light, dark = f"{colours(False)};{_LIGHT}", f"{colours(True)};{_DARK}"
    themes = f":root{{{light}}}\n@media (prefers-color-scheme:dark){{:root{{{dark}}}}}"
    return "\n".join([themes, inside(".bondgraph"), chart_style(), part("live/live.css")])
