"""What a program computes and nobody reads is left out: locals, coefficients, parameters."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TypeVar

from bondgraph.ir.program import Dot, PolynomialTape, Program, Ref, Statement, flat

_S = TypeVar("_S", bound=Statement)


def pruned(program: Program) -> Program:
    """The program without the statements whose result has no use, and what only they need."""
    exact = _live(program.exact, {})
    first = _live(program.first, {})
    step = _live(program.step, {})
    wanted = {
        name: None for s in (*exact, *first, *step) for space, name in _reads(s) if space == "coef"
    }
    live = _live(program.configure, wanted)
    configure = tuple(_narrow(s, wanted) if isinstance(s, PolynomialTape) else s for s in live)
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


def _narrow(tape: PolynomialTape, coefs: dict[str, None]) -> PolynomialTape:
    """A tape without the outputs that nobody reads."""
    return tape._replace(outputs=tuple(out for out in tape.outputs if out.array in coefs))


def _reads(statement: Statement) -> Iterable[tuple[str, str]]:
    """Space and name of everything that a statement reads."""
    if isinstance(statement, Dot):
        return [("coef", term.array) for term in statement.terms]
    found: dict[tuple[str, str], None] = {}
    stack: list[object] = [
        s.scales if isinstance(s, PolynomialTape) else s.value
        for s in flat([statement])
        if not isinstance(s, Dot)
    ]
    while stack:
        node = stack.pop()
        if isinstance(node, Ref):
            found[node.space, node.name] = None
        elif isinstance(node, tuple):
            stack.extend(node)
    return found
