"""Functions of the library in `step` become those near them, which cost a fraction."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, TypeVar

from bondgraph.ir.program import Assignment, Branch, Const, Function, Program, Ref

_NEAR = {"tanh": "near_tanh"}

_T = TypeVar("_T")


def near_functions(program: Program) -> Program:
    """The program with `near_tanh` in place of `tanh` in `step`; `exact` keeps what it has."""
    return program._replace(first=_all(program.first), step=_all(program.step))


def _all(statements: Iterable[Assignment]) -> tuple[Assignment, ...]:
    found: list[Assignment] = []
    for statement in statements:
        if isinstance(statement, Branch):
            own = statement._replace(yes=_all(statement.yes), no=_all(statement.no))
            found.append(own._replace(value=_near(statement.value)))
        else:
            found.append(statement._replace(value=_near(statement.value)))
    return tuple(found)


def _near(value: _T) -> _T:
    """An expression, a condition or a part of one with other names of functions."""
    if not isinstance(value, tuple) or isinstance(value, (Ref, Const)):
        return value
    node: Any = value
    parts = [_near(part) for part in node]
    made: _T = node._make(parts) if hasattr(node, "_make") else tuple(parts)  # type: ignore[assignment]
    if isinstance(made, Function) and made.name in _NEAR:
        return made._replace(name=_NEAR[made.name])
    return made
