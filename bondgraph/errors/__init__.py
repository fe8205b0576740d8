"""One page for each error code: what it means, a model that fails, the same model mended."""

from __future__ import annotations

import os

_FOLDER = os.path.dirname(__file__)


def page(code: str) -> str | None:
    """The page of `code` (Markdown: `# code`, a paragraph, `## Wrong`, `## Mended`), or None.

    >>> page("unknown-unit").splitlines()[0]
    '# unknown-unit'
    """
    if code not in codes():
        return None
    with open(os.path.join(_FOLDER, f"{code}.md"), encoding="utf-8") as file:
        return file.read()


def codes() -> tuple[str, ...]:
    """All codes that have a page, in alphabetical order."""
    return tuple(sorted(n.removesuffix(".md") for n in os.listdir(_FOLDER) if n.endswith(".md")))
