"""The live page as files by the path that they are served at: HTML, style and scripts."""

from __future__ import annotations

from functools import cache

from bondgraph.backends.drawing.style import colours, inside
from bondgraph.backends.templates import codegen
from bondgraph.text.printable import printable

_SCRIPTS = ("main.js", "graph.js", "plane.js", "said.js", "strips.js")
_LIGHT, _DARK = (
    "--mark:#fff0b8;--band:#eef3f7;--trace:#a3a3a3",
    ("--mark:#4d4212;--band:#22303a;--trace:#8a8a8a"),
)


def live(title: str, doc: str, drawing: str) -> dict[str, tuple[str, str]]:
    """Each file as (type, text); `drawing` is a bare SVG. Nothing in them comes from elsewhere."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    from markupsafe import Markup

    environment = Environment(
        loader=FileSystemLoader(codegen()),
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
        autoescape=True,
    )
    template = environment.get_template("live/page.html.j2")
    html = template.render(title=title, doc=doc, drawing=Markup(drawing.rstrip()))
    scripts = {f"/{name}": ("text/javascript", _text(name)) for name in _SCRIPTS}
    return {"/": ("text/html", printable(html)), "/live.css": ("text/css", _style()), **scripts}


def _style() -> str:
    """The style sheet; dark where that is asked for."""
    light, dark = f"{colours(False)};{_LIGHT}", f"{colours(True)};{_DARK}"
    themes = f":root{{{light}}}\n@media (prefers-color-scheme:dark){{:root{{{dark}}}}}"
    return "\n".join([themes, inside(".bondgraph"), _text("live.css")])


@cache
def _text(name: str) -> str:
    return (codegen() / "live" / name).read_text(encoding="utf-8")
