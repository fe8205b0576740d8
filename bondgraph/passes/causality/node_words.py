"""How nodes and lists of them are spoken of in findings about causality."""

from __future__ import annotations

from bondgraph.ir.graph import Node
from bondgraph.text.numerals import listed


def name(node: Node) -> str:
    """A node as it is spoken of: `R:fe`, `0:bus`."""
    return f"{node.keyword}:{node.path}"


def listing(names: list[str], most: int = 6) -> str:
    """Names joined as in a sentence; the many are counted."""
    return listed(names, "and", most)


def sentence(text: str) -> str:
    """The text with a capital letter, unless it begins with a name, and with a full stop."""
    first = text if ":" in text.split(" ", 1)[0] else text[:1].upper() + text[1:]
    return f"{first}."
