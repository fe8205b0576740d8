"""The page of the workbench as files by the path that they are served at, with their types."""

from __future__ import annotations

from bondgraph.backends.drawing.style import KINDS, colours, inside
from bondgraph.backends.page_parts import chart_style, part, scripts
from bondgraph.backends.templates import fill
from bondgraph.frontend.words import KEYWORDS, RESERVED
from bondgraph.library.elements import KINDS as ELEMENTS
from bondgraph.text.printable import printable

_SCRIPTS = (
    "main.js", "editor.js", "language.js", "picture.js", "residuals.js", "signatures.js",
    "trial.js", "curves.js", "panes.js", "vendored.js",
)  # fmt: skip
_LIGHT = (
    "--mark:#ffe9a8;--band:#e8eef4;--trace:#8f8f8f;--ground:#f4f2ee;--raised:#ffffff;"
    "--line:#dedad2;--select:#cfe3f5;--shade:rgb(40 34 20/.16)"
)
_DARK = (
    "--mark:#5c4f14;--band:#22303a;--trace:#8a8a8a;--ground:#0f1114;--raised:#1f2329;"
    "--line:#30353d;--select:#24435e;--shade:rgb(0 0 0/.55)"
)


def workbench(title: str, nonce: str) -> dict[str, tuple[str, str]]:
    """Each file as (type, text). Styles that the editor makes have the nonce."""
    html = fill("workbench/page.html.j2", {"title": title, "nonce": nonce}, html=True)
    return {
        "/": ("text/html", printable(html)),
        "/workbench.css": ("text/css", _style()),
        "/vendored.LICENSES.txt": ("text/plain", part("workbench/vendored.LICENSES.txt")),
        **scripts("workbench", _SCRIPTS),
    }


def words() -> dict[str, object]:
    """The words of the language, and in which colour a drawing has the elements of a keyword."""
    return {
        "keywords": sorted(KEYWORDS),
        "reserved": sorted(RESERVED),
        "kinds": {e.keyword: KINDS[e.kind] for e in ELEMENTS.values()},
    }


def _style() -> str:
    """The style sheet: the colours of drawings, light or dark as the system or a person wants."""
    light, dark = f"{colours(False)};{_LIGHT}", f"{colours(True)};{_DARK}"
    themes = (
        f":root{{color-scheme:light;{light}}}\n"
        f"@media (prefers-color-scheme:dark){{:root:not([data-theme=light]){{color-scheme:dark;"
        f"{dark}}}}}\n:root[data-theme=dark]{{color-scheme:dark;{dark}}}"
    )
    report = [part(f"report/{name}.css") for name in ("formulas", "tables")]
    own = [chart_style(), *report, inside(".bondgraph"), part("workbench/workbench.css")]
    return "\n".join([themes, *own])
