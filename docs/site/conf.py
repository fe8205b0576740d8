"""Settings of the site for Sphinx; `build.py` beside it stages the pages and calls Sphinx."""

from __future__ import annotations

import re

import latex2mathml.converter
from docutils import nodes
from pygments.lexers.special import TextLexer
from sphinx.application import Sphinx

import bondgraph

project = "bondgraph"
release = version = bondgraph.__version__
root_doc = "README"
extensions = ["myst_parser", "sphinx.ext.autodoc"]
source_suffix = {".md": "markdown"}
myst_heading_anchors = 6
myst_fence_as_directive = {"math"}
nitpicky = False

# Single backticks in docstrings are code, as in all other texts here.
default_role = "code"
autodoc_member_order = "bysource"
autodoc_typehints = "none"

# Pages of diagnostics show models that are wrong: what no token is, is coloured as that.
suppress_warnings = ["misc.highlighting_failure"]

html_theme = "furo"
html_title = "bondgraph"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False
html_last_updated_fmt = None
html_math_renderer = "mathml"
pygments_style = "default"
pygments_dark_style = "monokai"


def _inline_math(writer: object, node: nodes.math) -> None:
    writer.body.append(latex2mathml.converter.convert(node.astext()))  # type: ignore[attr-defined]
    raise nodes.SkipNode


def _block_math(writer: object, node: nodes.math_block) -> None:
    formula = latex2mathml.converter.convert(node.astext(), display="block")
    writer.body.append(f'<div class="math" tabindex="0">{formula}</div>')  # type: ignore[attr-defined]
    raise nodes.SkipNode


def _plain(*about: object) -> None:
    """Docstrings are plain text with code in backticks: nothing else in them is markup."""
    lines: list[str] = about[-1]  # type: ignore[assignment]
    example = False
    for number, line in enumerate(lines):
        example = bool(line.strip()) and (example or line.lstrip().startswith(">>>"))
        if not example:
            parts = re.split(r"(`[^`]*`)", line)
            parts[::2] = [re.sub(r"([|*\\])", r"\\\1", part) for part in parts[::2]]
            lines[number] = re.sub(r"(`[^`]*`)(?=\w)", r"\1\\ ", "".join(parts))


def setup(app: Sphinx) -> dict[str, bool]:
    """Formulas become MathML, which no script has to draw; docstrings and .bg are read our way."""
    app.add_html_math_renderer("mathml", (_inline_math, None), (_block_math, None))
    app.connect("autodoc-process-docstring", _plain)
    app.add_lexer("ebnf", TextLexer)  # that of Pygments knows another notation
    app.add_lexer("csv", TextLexer)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
