"""Values of expressions over any kind of number: the walk is written once, a number is a table."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Generic, TypeAlias, TypeVar

from bondgraph.ir.expr import Expr, Op, topological

X = TypeVar("X")
#: What nodes do with one kind of number. An operation gives None, or raises ArithmeticError or
#: ValueError, where there is no value; one that is not there never has any.
Operations: TypeAlias = Mapping[Op, Callable[[Expr, list[X]], X | None]]


class Evaluated(Generic[X]):
    """Values of expressions at one point, each node once; None where a part has no value.

    `leaf` gives the value of a symbol, and may ask for that of the expression it stands for;
    `known` are values that are there already.
    """

    def __init__(
        self,
        operations: Operations[X],
        leaf: Callable[[Expr], X | None],
        known: Mapping[Expr, X | None] | None = None,
    ) -> None:
        self.known: dict[Expr, X | None] = dict(known or {})
        self._operations: Operations[X] = {**operations, Op.SYM: lambda node, _: leaf(node)}

    def value(self, root: Expr) -> X | None:
        """The value of an expression."""
        known = self.known
        if root not in known:
            self.run([root])
        return known[root]

    def values(self, roots: Iterable[Expr]) -> dict[Expr, X]:
        """The values of all that is `known` afterwards, without those that there are not."""
        self.run(roots)
        return {node: x for node, x in self.known.items() if x is not None}

    def run(self, roots: Iterable[Expr]) -> None:
        """Make the values of some expressions, and of all that they are made of, `known`."""
        known, operations = self.known, self._operations
        for node in topological(roots, stop=known.__contains__):
            if node in known:
                continue
            known[node] = None  # also the answer for a definition that runs in a circle
            args: list[X] = []
            for a in node.args:
                x = known[a]
                if x is None:
                    break
                args.append(x)
            else:
                operation = operations.get(node.op)
                try:
                    known[node] = None if operation is None else operation(node, args)
                except (ArithmeticError, ValueError):
                    continue
