"""The print tree: a formula as a person would write it, before it is spelled in any notation."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from types import MappingProxyType
from typing import Any, TypeVar

from bondgraph.ir.expr import ZERO_START, Expr, Op, Symbol
from bondgraph.ir.past import past_of
from bondgraph.text.enumeration import Enum

_Node = TypeVar("_Node")
_Made = TypeVar("_Made")


class Shape(Enum):
    """What is written around the parts of a formula."""

    NUMBER = "number"  # data: a rational; what is negative is a sum of one term
    NAME = "name"  # data: a name of the model, or of a part that is written elsewhere
    SUM = "sum"  # data: what each part is multiplied by, its sign with it
    PRODUCT = "product"  # data: integer exponents, one per part
    CALL = "call"  # data: the function
    RATE = "rate"  # data: order of the time derivative
    AREA = "area"  # integral from the start of the first part, beginning at the second if any
    CHOICE = "choice"  # condition, value if it holds, value if not
    COMPARE = "compare"  # data: "<", "<=" or "=="
    LOGIC = "logic"  # data: "and", "or" or "not"
    ROOT = "root"  # the name that is the first part, where the second is zero; data: a guess


class Formula:
    """A node of the print tree, compared by identity; equal parts of a formula are one object."""

    __slots__ = ("data", "parts", "shape")

    def __init__(self, shape: Shape, parts: tuple[Formula, ...] = (), data: Any = None) -> None:
        self.shape = shape
        self.parts = parts
        self.data = data


def bottom_up(
    root: _Node,
    done: dict[_Node, _Made],
    parts: Callable[[_Node], Iterable[_Node]],
    make: Callable[[_Node], _Made],
) -> _Made:
    """What is made of a node after all that it is made of; `done` keeps it, however deep."""
    stack = [root]
    while stack:
        node = stack.pop()
        if node in done:
            continue
        waiting = [part for part in parts(node) if part not in done]
        if waiting:
            stack += [node, *waiting[::-1]]
        else:
            done[node] = make(node)
    return done[root]


def below(roots: Iterable[_Node], parts: Callable[[_Node], Iterable[_Node]]) -> list[_Node]:
    """All nodes that the roots are made of, parts first."""
    found: dict[_Node, _Node] = {}
    for root in roots:
        bottom_up(root, found, parts, lambda node: node)
    return list(found)


def _name(name: str) -> Formula:
    """A name; a past value is written as what it is of, and how old."""
    past = past_of(name)
    if past is None:
        return Formula(Shape.NAME, (), name)
    of, seconds = past
    return Formula(Shape.CALL, (_name(of), Formula(Shape.NUMBER, (), seconds)), "delay")


class Reader:
    """Reads expressions as formulas.

    `named` nodes stand as these names. `starts` are the values of initial values, wherever they
    occur: an integral that begins at zero does not say so, and a sum has no zero in it.
    """

    def __init__(
        self,
        named: Mapping[Expr, str] = MappingProxyType({}),
        starts: Mapping[Symbol, Expr] = MappingProxyType({}),
    ) -> None:
        self.starts = starts
        self._done = {node: Formula(Shape.NAME, (), name) for node, name in named.items()}

    def of(self, expr: Expr) -> Formula:
        """The formula of an expression."""
        return bottom_up(expr, self._done, self._parts, self._read)

    def definition(self, expr: Expr) -> Formula:
        """The formula that a named expression stands for."""
        for part in self._parts(expr):
            self.of(part)
        return self._read(expr)

    def vanishing(self, node: Expr, name: str) -> Formula:
        """What vanishes where a root has its value, which is called `name` in it."""
        for part in self._parts(node):
            self.of(part)
        return self._root(node, name)[1]

    def _root(self, node: Expr, name: str) -> tuple[Formula, Formula]:
        """The unknown of a root, and what vanishes where it has its value."""
        root = node.root
        inside = Reader({root.unknown: name}, self.starts)
        inside._done.update({p: self._done[a] for p, a in zip(root.places, node.args, strict=True)})
        return inside.of(root.unknown), inside.of(root.zero)

    def _parts(self, node: Expr) -> tuple[Expr, ...]:
        value = self.starts.get(node.symbol) if node.op in (Op.INT, Op.SYM) else None
        if value is not None and value.op is Op.NUM and not value.number and node.op is Op.SYM:
            value = None  # a name says more in a product, and a sum does without it
        return node.args if value is None else (*node.args, value)

    def _read(self, node: Expr) -> Formula:
        parts = tuple([self._done[part] for part in self._parts(node)])
        match node.op:
            case Op.NUM:
                size = Formula(Shape.NUMBER, (), abs(node.number))
                return size if node.number >= 0 else Formula(Shape.SUM, (size,), (-1,))
            case Op.SYM:
                return parts[0] if parts else _name(node.symbol.name)
            case Op.ADD:
                return self._sum(node)
            case Op.MUL:
                return Formula(Shape.PRODUCT, parts, node.exponents)
            case Op.FN:
                return Formula(Shape.CALL, parts, node.name)
            case Op.DER:
                inner = parts[0]
                if inner.shape is Shape.RATE:
                    return Formula(Shape.RATE, inner.parts, inner.data + 1)
                return Formula(Shape.RATE, parts, 1)
            case Op.INT:
                if len(parts) == 1 and node.symbol.name != ZERO_START:
                    parts = (*parts, Formula(Shape.NAME, (), node.symbol.name))
                zero = parts[-1].shape is Shape.NUMBER and not parts[-1].data
                return Formula(Shape.AREA, parts[:1] if zero else parts)
            case Op.IF:
                return Formula(Shape.CHOICE, parts)
            case Op.CMP:
                return Formula(Shape.COMPARE, parts, node.name)
            case Op.LOGIC:
                return Formula(Shape.LOGIC, parts, node.name)
            case Op.ROOT:
                return Formula(Shape.ROOT, self._root(node, node.root.name), node.root.guess)

    def _sum(self, node: Expr) -> Formula:
        coefficients, parts = [], []
        for c, arg in zip(node.coefficients, node.args, strict=True):
            part = self._done[arg]
            told = self.starts.get(arg.symbol, arg) if arg.op is Op.SYM else arg
            if told.op is Op.NUM:
                value = c * told.number
                if not value:
                    continue
                c, part = Fraction(1 if value > 0 else -1), Formula(Shape.NUMBER, (), abs(value))
            coefficients.append(c)
            parts.append(part)
        if not parts:
            return Formula(Shape.NUMBER, (), Fraction(0))
        if coefficients == [1]:
            return parts[0]
        return Formula(Shape.SUM, tuple(parts), tuple(coefficients))
