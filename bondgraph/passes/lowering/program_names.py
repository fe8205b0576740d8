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


def spoken(node: Expr) -> str:
    """What a person would call a value, as an identifier: `N_over_tau0`, `tanh_x`, `R_plus_L`.

    Of names of the model the last part is taken; what has more than three in it is a `sum`, a
    `product` or the like; `scaled_` stands before what has a number in front.

    >>> from bondgraph.ir.expr import Kind, Pool
    >>> pool = Pool()
    >>> N, tau = (pool.symbol(f"m[1].{x}", Kind.CONST) for x in ("N", "tau0"))
    >>> spoken(pool.div(N, pool.scale(4, tau))), spoken(pool.add((1, N), (-1, tau)))
    ('scaled_N_over_tau0', 'N_minus_tau0')
    """
    if node.op is Op.SYM:
        name = _spoken(node.symbol.name).rpartition(".")[2]
        return identifier(_INDEX.sub("", name)) if name else "value"
    if node.op is Op.FN:
        return identifier(f"{node.name.partition(':')[0]}_x")
    if node.op is Op.ADD and len(node.args) == 1:
        return f"scaled_{spoken(node.args[0])}"
    if node.op is Op.MUL and len(node.args) <= 3:
        above = [a for a, e in node.factors if e > 0]
        below = [a for a, e in node.factors if e < 0]
        if all(a.op is Op.SYM for a in node.args):
            words = "_times_".join(map(spoken, above)) or "one"
            return words + "".join(f"_over_{spoken(a)}" for a in below)
    if node.op is Op.ADD and len(node.args) <= 3:
        terms = sorted(node.terms, key=lambda t: t[0] < 0)
        if all(a.op is Op.SYM for a in node.args) and terms[0][0] > 0:
            (_, first), *more = terms
            return spoken(first) + "".join(
                f"_{'plus' if c > 0 else 'minus'}_{spoken(a)}" for c, a in more
            )
    return _KINDS.get(node.op, "value")


_KINDS = {
    Op.ADD: "sum",
    Op.MUL: "product",
    Op.IF: "choice",
    Op.INT: "integral",
    Op.ROOT: "root",
    Op.LOGIC: "holds",
    Op.CMP: "holds",
}


def _longer(node: Expr, most: int) -> bool:
    """Whether an expression takes more letters at least: a sign a node, each name as it is."""
    stack = [node]
    while stack and most >= 0:
        node = stack.pop()
        stack.extend(node.args)
        most -= len(_spoken(node.symbol.name)) if node.op is Op.SYM else 1
    return most < 0


def brief(node: Expr, most: int = 240) -> str:
    """An expression for a comment, `Int(x)` where it starts at 0; one that is longer by its kind.

    A formula is never cut: half of one says less than a word.
    """
    if not _longer(node, most):
        text = show(node, {s: _spoken(s.symbol.name) for s in symbols(node)})
        if len(text) <= most:
            return text
    return f"a {spoken(node)}"


def _spoken(name: str) -> str:
    if name.startswith(OPTION):
        name, _, at = name.removeprefix(OPTION).partition("@")
        return f"{name}[{at}]" if at else name
    if name.startswith("?"):  # inside the equation of a root
        return name[1:] if name == "?x" else f"c{name[1:]}"
    return name


def short(node: Expr, order: int = 0) -> str:
    """A signal with its derivative the way it is written by hand: we'', D(we, 5), Int(we)."""
    text = brief(node)
    if order < 0:
        return f"Int({text})" if order == -1 else f"Int(Int({text}))"
    if order > 3 or (order and node.op is not Op.SYM):
        return f"D({text}, {order})" if order > 1 else f"D({text})"
    return text + "'" * order
