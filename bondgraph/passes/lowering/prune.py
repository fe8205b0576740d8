"""What a program computes and nobody reads is left out: locals, coefficients, parameters."""

from __future__ import annotations

from collections.abc import Iterable, Sequence, Set
from typing import TypeVar

from bondgraph.ir.program import Dot, PolynomialTape, Program, Statement, flat
from bondgraph.notation.walk import references

_S = TypeVar("_S", bound=Statement)


def pruned(program: Program) -> Program:
    """The program without the statements whose result has no use, and what only they need."""
    read = set[tuple[str, str]]()
    exact = _live(program.exact, read)
    first = _live(program.first, read)
    step = _live(program.step, read)
    live = _live(program.configure, read)
    configure = tuple(_narrow(s, read) if isinstance(s, PolynomialTape) else s for s in live)
    return program._replace(
        params=tuple(p for p in program.params if ("param", p.name) in read),
        exact=exact,
        first=first,
        step=step,
        configure=configure,
        coefs=tuple(c for c in program.coefs if ("coef", c.name) in read),
    )


def _live(statements: Sequence[_S], read: set[tuple[str, str]]) -> tuple[_S, ...]:
    """The statements that something rests on; what they read of other procedures joins `read`."""
    local: set[str] = set()
    kept: list[_S] = []
    for statement in reversed(statements):
        if isinstance(statement, PolynomialTape):
            used = any(("coef", out.array) in read for out in statement.outputs)
        elif statement.target.space == "local":
            used = statement.target.name in local
        else:
            used = statement.target.space != "coef" or statement.target[:2] in read
        if used:
            kept.append(statement)
            for space, name in _reads(statement):
                if space == "local":
                    local.add(name)
                else:
                    read.add((space, name))
    return tuple(reversed(kept))


def _narrow(tape: PolynomialTape, read: Set[tuple[str, str]]) -> PolynomialTape:
    """A tape without the outputs that nobody reads."""
    return tape._replace(outputs=tuple(out for out in tape.outputs if ("coef", out.array) in read))


def _reads(statement: Statement) -> Iterable[tuple[str, str]]:
    """Space and name of everything that a statement reads."""
    if isinstance(statement, Dot):
        return [("coef", term.array) for term in statement.terms]
    values = [
        s.scales if isinstance(s, PolynomialTape) else s.value
        for s in flat([statement])
        if not isinstance(s, Dot)
    ]
    return [(ref.space, ref.name) for value in values for ref in references(value)]
