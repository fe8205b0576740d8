"""How nodes and lists of them are spoken of in findings about causality."""

from __future__ import annotations

from bondgraph.ir.graph import Node


def name(node: Node) -> str:
    """A node as it is spoken of: `R:fe`, `0:bus`."""
    return f"{node.keyword}:{node.path}"


def listing(names: list[str], most: int = 6) -> str:
    """Names joined as in a sentence; the many are counted."""
    if len(names) > most:
        names = [*names[: most - 1], f"{len(names) - most + 1} more"]
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def sentence(text: str) -> str:
    """The text with a capital letter, unless it begins with a name, and with a full stop."""
    first = text if ":" in text.split(" ", 1)[0] else text[:1].upper() + text[1:]
    return f"{first}."
