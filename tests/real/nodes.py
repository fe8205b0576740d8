"""Expressions of the judge: one small tree for laws, sensors and residuals, and its .bg text."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction

Number = int | Fraction


class Node:
    """An operation on other nodes; `data` is a number, a name, coefficients or a table.

    Operations: num, sym, add (data: coefficients), mul, div, pow (data: exponent), fn (data:
    name), if (condition, yes, no), cmp (data: sign), and, or, not, der (data: order),
    int (integrand, start), table (data: points; a name in `label`).
    """

    __slots__ = ("args", "data", "label", "op")

    def __init__(
        self, op: str, args: tuple[Node, ...] = (), data: object = None, label: str = ""
    ) -> None:
        self.op, self.args, self.data, self.label = op, args, data, label

    def __add__(self, other: Node | Number) -> Node:
        return total((1, self), (1, node(other)))

    def __radd__(self, other: Number) -> Node:
        return node(other) + self

    def __sub__(self, other: Node | Number) -> Node:
        return total((1, self), (-1, node(other)))

    def __rsub__(self, other: Number) -> Node:
        return node(other) - self

    def __neg__(self) -> Node:
        return total((-1, self))

    def __mul__(self, other: Node | Number) -> Node:
        return Node("mul", (self, node(other)))

    def __rmul__(self, other: Number) -> Node:
        return node(other) * self

    def __truediv__(self, other: Node | Number) -> Node:
        return Node("div", (self, node(other)))

    def __pow__(self, exponent: Number) -> Node:
        return Node("pow", (self,), Fraction(exponent))


def node(value: Node | Number) -> Node:
    return value if isinstance(value, Node) else Node("num", data=Fraction(value))


def sym(name: str) -> Node:
    return Node("sym", data=name)


def total(*terms: tuple[Number, Node]) -> Node:
    """A sum of multiples."""
    return Node("add", tuple(n for _, n in terms), tuple(Fraction(c) for c, _ in terms))


def fn(name: str, *args: Node | Number) -> Node:
    return Node("fn", tuple(node(a) for a in args), name)


def compare(sign: str, left: Node | Number, right: Node | Number) -> Node:
    return Node("cmp", (node(left), node(right)), sign)


def choose(condition: Node, yes: Node | Number, no: Node | Number) -> Node:
    return Node("if", (condition, node(yes), node(no)))


def der(x: Node, order: int = 1) -> Node:
    return Node("der", (x,), order)


def integral(x: Node, start: Node | Number = 0) -> Node:
    return Node("int", (x, node(start)))


def table(name: str, points: tuple[tuple[Fraction, Fraction], ...], x: Node) -> Node:
    return Node("table", (x,), points, name)


def ordered(roots: Iterable[Node]) -> list[Node]:
    """All nodes below the roots, arguments first, each once."""
    done: dict[int, Node] = {}
    stack = [(n, False) for n in roots]
    while stack:
        here, ready = stack.pop()
        if ready:
            done[id(here)] = here
        elif id(here) not in done:
            stack.append((here, True))
            stack += [(a, False) for a in here.args if id(a) not in done]
    return list(done.values())


def names(*roots: Node) -> set[str]:
    """The names of all symbols."""
    return {str(n.data) for n in ordered(roots) if n.op == "sym"}


def replaced(root: Node, new: Mapping[str, Node]) -> Node:
    """The expression with other expressions for some symbols."""
    made: dict[int, Node] = {}
    for n in ordered([root]):
        if n.op == "sym" and n.data in new:
            made[id(n)] = new[str(n.data)]
        elif n.args:
            made[id(n)] = Node(n.op, tuple(made[id(a)] for a in n.args), n.data, n.label)
        else:
            made[id(n)] = n
    return made[id(root)]


_SUM, _PRODUCT, _POWER, _ATOM = range(4)


def number(value: Fraction) -> str:
    """A number as it stands in a model: a decimal, which is exact there."""
    text = str(value.numerator) if value.denominator == 1 else format(float(value), ".12g")
    if Fraction(text) != value:
        raise ValueError(f"{value} is no short decimal")
    return text


def text(root: Node, spelled: Callable[[str], str] = str) -> str:
    """The expression in the .bg language; `spelled` gives the text of a symbol."""
    return _written(root, spelled)[0]


def _written(n: Node, spelled: Callable[[str], str]) -> tuple[str, int]:
    def inner(arg: Node, level: int) -> str:
        written, own = _written(arg, spelled)
        return written if own >= level else f"({written})"

    match n.op:
        case "num":
            assert isinstance(n.data, Fraction)
            return number(n.data), _ATOM if n.data >= 0 else _SUM
        case "sym":
            return spelled(str(n.data)), _ATOM
        case "add":
            return _sum(n, inner), _SUM
        case "mul":
            return "*".join(inner(a, _POWER) for a in n.args), _PRODUCT
        case "div":
            return f"{inner(n.args[0], _PRODUCT)}/{inner(n.args[1], _POWER)}", _PRODUCT
        case "pow":
            assert isinstance(n.data, Fraction)
            exponent = number(n.data)
            return (
                f"{inner(n.args[0], _ATOM)}^{exponent if n.data > 0 else f'({exponent})'}",
                _POWER,
            )
        case "fn":
            return f"{n.data}({', '.join(inner(a, _SUM) for a in n.args)})", _ATOM
        case "if":
            return f"if({', '.join(inner(a, _SUM) for a in n.args)})", _ATOM
        case "cmp":
            return f"{inner(n.args[0], _PRODUCT)} {n.data} {inner(n.args[1], _PRODUCT)}", _SUM
        case "der":
            return f"der({inner(n.args[0], _SUM)})", _ATOM
        case "int":
            start = n.args[1]
            zero = start.op == "num" and start.data == 0
            return f"int({', '.join(inner(a, _SUM) for a in n.args[: 1 if zero else 2])})", _ATOM
        case "table":
            return f'table("{n.label}", {inner(n.args[0], _SUM)})', _ATOM
    raise ValueError(n.op)


def _sum(n: Node, inner: Callable[[Node, int], str]) -> str:
    assert isinstance(n.data, tuple)
    out = ""
    for c, arg in zip(n.data, n.args, strict=True):
        size = abs(c)
        term = inner(arg, _PRODUCT) if size == 1 else f"{number(size)}*{inner(arg, _POWER)}"
        sign = "-" if c < 0 else "+"
        out += f" {sign} {term}" if out else term if c > 0 else f"-{term}"
    return out
