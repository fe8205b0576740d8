"""Figures of matplotlib as SVG for inside of a page, in its colours and fonts."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from bondgraph.backends.drawing.paint import escape
from bondgraph.backends.drawing.style import palette

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SETTINGS = {
    "svg.fonttype": "none",
    "svg.hashsalt": "bondgraph",
    "font.family": "sans-serif",
    "font.size": 10.0,
    "axes.labelsize": 10.0,
    "axes.unicode_minus": True,
    "legend.fontsize": 9.5,
    "path.simplify": True,
}


_NOISE = re.compile(r"<metadata>.*?</metadata>|<style[^>]*>.*?</style>|<!--.*?-->", re.S)


def colour(name: str) -> str:
    """The colour of a figure by its name on the page (`ink`, `faint`, `inertia`, ...)."""
    return palette()[name]


@contextmanager
def looks() -> Iterator[None]:
    """Figures made inside look like those of the page, whatever the user's settings are."""
    import matplotlib

    ink = {f"{part}.color": colour("ink") for part in ("xtick", "ytick", "text")}
    ink |= {"axes.edgecolor": colour("ink"), "axes.labelcolor": colour("ink")}
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update({**_SETTINGS, **ink})
        yield


def drawn(figure: Figure, key: str, title: str, told: str) -> str:
    """The figure as SVG with `title` and `told` as what it says in words.

    Colours become those of the page, so that dark and light both work; identifiers begin with
    `key`; lengths have a tenth of a point. The same figure gives the same text.
    """
    stream = io.StringIO()
    metadata = {"Date": None, "Creator": None, "Format": None, "Type": None}
    figure.savefig(stream, format="svg", transparent=True, metadata=metadata)
    return _inlined(stream.getvalue(), key, title, told)


def _inlined(text: str, key: str, title: str, told: str) -> str:
    head, _, body = text[text.index("<svg") :].partition(">")
    box = re.search(r'viewBox="([^"]*)"', head)
    assert box is not None
    wide, high = box[1].split()[2:]
    body = _NOISE.sub("", body)
    body = re.sub(r'(?<= id=")', f"{key}-", body)
    body = re.sub(r"url\(#", f"url(#{key}-", body)
    body = re.sub(r'xlink:href="#', f'href="#{key}-', body)
    body = re.sub(r"<[^>]*>", lambda tag: re.sub(r"(\d+\.\d)\d+", r"\1", tag[0]), body)
    body = re.sub(r"font: ([\d.]+)px [^;\"]*", r"font-size: \1px", body)
    body = re.sub(r"font-family: [^;\"]*; ?", "", body)
    for name, value in palette().items():
        body = body.replace(value, f"var(--{name})")
    body = re.sub(r"#000000\b|(?<=: )black\b", "var(--ink)", body)
    body = re.sub(r"\n\s*", "\n", body)
    return (
        f'<svg class="plot" viewBox="0 0 {wide} {high}" width="{wide}" height="{high}" role="img"'
        f' aria-labelledby="{key}-title"><title id="{key}-title">{escape(title)}</title>'
        f"<desc>{escape(told)}</desc>{body.rstrip()}\n"
    )
