"""Names for what a program holds: identifiers taken from the model, expressions in comments."""

from __future__ import annotations

import re

from bondgraph.ir.expr import Expr, Op, symbols
from bondgraph.notation.line import show

OPTION = "@"  # begins the names of the options of configure: no name of a model has it

_INDEX = re.compile(r"\[(\d+)\]")
_FOREIGN = re.compile(r"[^A-Za-z0-9_]")


def identifier(path: str) -> str:
    """A name of the model as an identifier: `.` and `[i]` become `__`.

    >>> identifier("m[1].wh.ws")
    'm__1__wh__ws'
    """
    text = _INDEX.sub(r"__\1", path).replace(".", "__")
    text = _FOREIGN.sub(lambda found: f"u{ord(found.group()):x}", text)
    return f"_{text}" if not text or text[0].isdigit() else text


class Names:
    """Hands out identifiers; one that is taken gets a number."""

    def __init__(self) -> None:
        self._taken: dict[str, int] = {}

    def new(self, wish: str) -> str:
        """`wish`, or `wish_2`, `wish_3`, ... where it is taken.

        >>> names = Names()
        >>> names.new("g"), names.new("g")
        ('g', 'g_2')
        """
        name = wish
        while name in self._taken:
            self._taken[wish] += 1
            name = f"{wish}_{self._taken[wish]}"
        self._taken[name] = 1
        return name


def _longer(node: Expr, most: int) -> bool:
    """Whether an expression that is written out, shared parts as often as used, has more nodes."""
    stack = [node]
    while stack and most >= 0:
        stack.extend(stack.pop().args)
        most -= 1
    return most < 0


def brief(node: Expr, most: int = 90) -> str:
    """An expression for a comment: at most so many characters, `Int(x)` where it starts at 0."""
    if _longer(node, 2 * most):
        return "..."
    text = show(node, {s: _spoken(s.symbol.name) for s in symbols(node)})
    return text if len(text) <= most else text[: most - 4] + " ..."


def _spoken(name: str) -> str:
    if name.startswith(OPTION):
        name, _, at = name.removeprefix(OPTION).partition("@")
        return f"{name}[{at}]" if at else name
    if name.startswith("?"):  # inside the equation of a root
        return name[1:] if name == "?x" else f"c{name[1:]}"
    return name


def short(node: Expr, order: int = 0) -> str:
    """A signal with its derivative the way it is written by hand: we'', D(we, 5), Int(we)."""
    text = brief(node, 60)
    if order < 0:
        return f"Int({text})" if order == -1 else f"Int(Int({text}))"
    if order > 3 or (order and node.op is not Op.SYM):
        return f"D({text}, {order})" if order > 1 else f"D({text})"
    return text + "'" * order
