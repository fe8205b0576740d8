"""What a program computes and nobody reads is left out: locals, coefficients, parameters."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TypeVar

from bondgraph.ir.program import Assign, Dot, PolynomialTape, Program, Ref, Statement

_S = TypeVar("_S", bound="Assign | Dot | PolynomialTape")


def pruned(program: Program) -> Program:
    """The program without the statements whose result has no use, and what only they need."""
    exact = _live(program.exact, {})
    first = _live(program.first, {})
    step = _live(program.step, {})
    wanted = {
        name: None for s in (*exact, *first, *step) for space, name in _reads(s) if space == "coef"
    }
    configure = tuple(_narrow(s, wanted) for s in _live(program.configure, wanted))
    given = {name for s in configure for space, name in _reads(s) if space == "param"}
    return program._replace(
        params=tuple(p for p in program.params if p.name in given),
        exact=exact,
        first=first,
        step=step,
        configure=configure,
        coefs=tuple(c for c in program.coefs if c.name in wanted),
    )


def _live(statements: Sequence[_S], coefs: dict[str, None]) -> tuple[_S, ...]:
    """The statements that something rests on; the coefficients that they read join `coefs`."""
    local: set[str] = set()
    kept: list[_S] = []
    for statement in reversed(statements):
        if isinstance(statement, PolynomialTape):
            used = any(out.array in coefs for out in statement.outputs)
        else:
            target = statement.target
            used = target.space not in ("local", "coef")
            used |= target.name in (local if target.space == "local" else coefs)
        if used:
            kept.append(statement)
            for space, name in _reads(statement):
                if space == "local":
                    local.add(name)
                elif space == "coef":
                    coefs[name] = None
    return tuple(reversed(kept))


def _narrow(statement: Statement, coefs: dict[str, None]) -> Statement:
    """A tape without the outputs that nobody reads."""
    if not isinstance(statement, PolynomialTape):
        return statement
    outputs = tuple(out for out in statement.outputs if out.array in coefs)
    return statement._replace(outputs=outputs)


def _reads(statement: Assign | Dot | PolynomialTape) -> Iterable[tuple[str, str]]:
    """Space and name of everything that a statement reads."""
    if isinstance(statement, Dot):
        return [("coef", term.array) for term in statement.terms]
    found: dict[tuple[str, str], None] = {}
    stack: list[object] = [
        statement.scales if isinstance(statement, PolynomialTape) else statement.value
    ]
    while stack:
        node = stack.pop()
        if isinstance(node, Ref):
            found[node.space, node.name] = None
        elif isinstance(node, tuple):
            stack.extend(node)
    return found
