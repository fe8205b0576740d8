"""Where the templates are, and how they are filled."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from jinja2 import Environment


@cache
def codegen() -> Path:
    """The folder of the target languages: inside the package when installed, else beside it.

    Raises FileNotFoundError when the installation is incomplete.
    """
    package = Path(__file__).resolve().parent.parent
    for place in (package / "codegen", package.parent / "codegen"):
        if (place / "README.md").is_file():
            return place
    raise FileNotFoundError(f"the templates of the target languages are missing beside {package}")


@cache
def environment(html: bool = False) -> Environment:
    """The Jinja environment: a hole that nobody fills is an error, lines are kept as they are.

    For `html` what fills a hole is escaped; C, Python and Markdown take it as it is.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    from bondgraph.backends.bytecode import kept_templates

    made = Environment(
        loader=FileSystemLoader(codegen()),
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        undefined=StrictUndefined,
        autoescape=html,
    )
    options = (made.trim_blocks, made.lstrip_blocks, made.keep_trailing_newline, html)
    made.bytecode_cache = kept_templates(repr(options))
    return made


def fill(template: str, holes: dict[str, object], html: bool = False) -> str:
    """The text of `template` (`c/residuals.h.j2`); raises UndefinedError for an unfilled hole.

    With `html` what fills a hole is escaped, for XML too.
    """
    return environment(html).get_template(template).render(holes)
