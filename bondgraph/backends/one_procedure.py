"""`first` and `step` of a block as one procedure, which differ in few values.

Most statements of the two are the same. Where the values differ there is a choice by whether this
is the first sample, and what is only there at the start stands in a branch. An observer starts with
another computation altogether: there the whole is one choice between two procedures.
"""

from __future__ import annotations

from collections.abc import Sequence

from bondgraph.ir.program import (
    Assign,
    Assignment,
    Branch,
    Choice,
    Condition,
    Expression,
    First,
    Function,
    Product,
    Ref,
    Sum,
    flat,
)
from bondgraph.text.tuples import NamedTuple


class Start(NamedTuple):
    """Statements that only the first sample has."""

    statements: tuple[Assignment, ...]


class Procedure(NamedTuple):
    """What a block does with a sample; with `apart` the first sample takes those instead."""

    statements: tuple[Assignment | Start, ...]
    apart: tuple[Assignment, ...] = ()

    @property
    def asks(self) -> bool:
        """Whether it has to know if this is the first sample."""
        return bool(self.apart) or any(
            isinstance(s, Start) or asks(s) for s in self.statements
        )


def one_procedure(first: Sequence[Assignment], step: Sequence[Assignment]) -> Procedure:
    """Both procedures of a block as one.

    >>> x, y = Ref("known", "x"), Ref("local", "y")
    >>> b, s = Ref("coef", "b"), Ref("state", "s")
    >>> new = Assign(y, Sum(((True, s), (True, Product((b, x))))), "", None)
    >>> keep = Assign(s, y, "", None)
    >>> found = one_procedure([Assign(y, x, "", None), keep], [new, keep])
    >>> found.statements == (new._replace(value=Choice(First(), x, new.value)), keep)
    True
    """
    apart = Procedure(tuple(step), tuple(first))
    places = {s.target: at for at, s in enumerate(first)}  # the last, if it is emptied before
    found: list[Assignment | Start] = []
    done = 0
    for statement in step:
        at = places.get(statement.target, -1)
        if at < done:
            return apart
        starts, own, done = first[done:at], first[at], at + 1
        if any(s.target.space == "local" for s in starts):
            return apart
        found += [Start((s,)) for s in starts]
        if own == statement or (own.value == statement.value and not isinstance(own, Branch)):
            found.append(statement)
        elif isinstance(own, Assign) and isinstance(statement, Assign):
            value = Choice(First(), own.value, statement.value)
            found.append(statement._replace(value=value))
        else:
            return apart
    return apart if done < len(first) else Procedure(_joined(found))


def _joined(statements: Sequence[Assignment | Start]) -> tuple[Assignment | Start, ...]:
    """Starts that stand behind each other as one."""
    found: list[Assignment | Start] = []
    for statement in statements:
        if isinstance(statement, Start) and found and isinstance(found[-1], Start):
            found[-1] = Start((*found[-1].statements, *statement.statements))
        else:
            found.append(statement)
    return tuple(found)


def asks(statement: Assignment) -> bool:
    """Whether a statement has the condition `First` in it."""
    stack: list[object] = [s.value for s in flat([statement])]
    while stack:
        node = stack.pop()
        if isinstance(node, First):
            return True
        if isinstance(node, tuple):
            stack.extend(node)
    return False


def heard(procedure: Procedure) -> frozenset[str]:
    """The signals whose NaN or infinity makes a residual so: those that it is a sum of.

    What stands under a function, in a condition or below a fraction bar need not.
    """
    reach: dict[Ref, frozenset[str]] = {}
    found: frozenset[str] = frozenset()
    if procedure.apart:
        return found
    for statement in procedure.statements:
        if isinstance(statement, Start):
            continue
        own = frozenset[str]() if isinstance(statement, Branch) else _heard(statement.value, reach)
        if statement.target.space == "local":
            reach[statement.target] = own
        elif statement.target.space == "residual":
            found |= own
    return found


def _heard(value: Expression | Condition, reach: dict[Ref, frozenset[str]]) -> frozenset[str]:
    nothing = frozenset[str]()
    match value:
        case Ref():
            return frozenset({value.name}) if value.space == "known" else reach.get(value, nothing)
        case Sum():
            return nothing.union(*(_heard(term, reach) for _, term in value.terms))
        case Product():
            return nothing.union(*(_heard(factor, reach) for factor in value.factors))
        case Choice(First(), yes, no):
            return _heard(yes, reach) & _heard(no, reach)
        case Function("abs", (inside,)):
            return _heard(inside, reach)
        case _:
            return nothing
