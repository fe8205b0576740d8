"""What occurs in expressions and statements of the residual program: names and functions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from operator import attrgetter
from typing import Any, assert_never

from bondgraph.ir.program import (
    Assign,
    Choice,
    Compare,
    Condition,
    Const,
    Dot,
    Expression,
    First,
    Function,
    Logic,
    Mode,
    PolynomialTape,
    Product,
    Ref,
    Statement,
    Sum,
    called,
    flat,
)
from bondgraph.notation.dialect import is_written_out

_OPERANDS: dict[type, Callable[[Any], tuple[Expression | Condition, ...]]] = {
    Const: lambda value: (),
    Ref: lambda value: (),
    Mode: lambda value: (),
    First: lambda value: (),
    Sum: lambda value: tuple([term for _, term in value.terms]),
    Product: lambda value: value.factors + value.divisors,
    Function: attrgetter("args"),
    Logic: attrgetter("args"),
    Choice: attrgetter("condition", "yes", "no"),
    Compare: attrgetter("left", "right"),
}


def operands(value: Expression | Condition) -> tuple[Expression | Condition, ...]:
    """What a node is directly made of."""
    return _OPERANDS[type(value)](value)


def nodes(values: Iterable[Expression | Condition]) -> Iterator[Expression | Condition]:
    """All nodes of all expressions; a parent comes before what it is made of."""
    stack = list(values)[::-1]
    while stack:
        node = stack.pop()
        yield node
        stack += _OPERANDS[type(node)](node)[::-1]


def references(value: tuple[object, ...]) -> list[Ref]:
    """The names in an expression, or in an instruction; a mode is read as a known signal."""
    found: list[Ref] = []
    stack: list[object] = [value]
    while stack:
        node = stack.pop()
        if type(node) is Ref:
            found.append(node)
        elif type(node) is Mode:
            found.append(Ref("known", node.name))
        elif isinstance(node, tuple) and type(node) is not Const:
            stack += node[::-1]  # of operands, or a node: both hold them from left to right
    return found


def reads(statements: Iterable[Statement]) -> list[Ref]:
    """Everything that statements read, and what they write."""
    found: list[Ref] = []
    for statement in flat(statements):
        match statement:
            case Assign():
                found += [statement.target, *references(statement.value)]
            case Dot():
                found.append(statement.target)
                for term in statement.terms:
                    found += [Ref("coef", term.array), Ref("known", term.signal)]
            case PolynomialTape():
                found += [Ref("coef", output.array) for output in statement.outputs]
                for scale in statement.scales:
                    found += references(scale)
            case _:
                assert_never(statement)
    return found


def functions(values: Iterable[Expression | Condition]) -> set[str]:
    """The functions that occur, as they are `called`; `equal` for ==."""
    found: set[str] = set()
    for node in nodes(values):
        if isinstance(node, Compare) and node.op == "==":
            found.add("equal")
        elif isinstance(node, Function) and not is_written_out(node):
            found.add(called(node).partition(":")[0])
    return found
