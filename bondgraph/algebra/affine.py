"""Equations that are linear in a variable: its slope, and what is left beside it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from bondgraph.ir.expr import Expr, Op, Pool, topological
from bondgraph.ir.nodes import holding, linear_terms


def affine(
    pool: Pool, node: Expr, variable: Expr, holders: Mapping[Expr, None] | None = None
) -> tuple[Expr, Expr] | None:
    """`slope`, `rest` with node = slope * variable + rest, both free of it; None if not affine.

    `holders` are the nodes that are made of the variable, where it is known already.
    """
    if holders is None:
        holders = holding([node], lambda n: n is variable)
    if node not in holders:
        return pool.zero, node
    parts: dict[Expr, tuple[Expr, Expr]] = {variable: (pool.one, pool.zero)}
    for item in holders:
        if item is variable:
            continue
        own = [parts.get(a, (pool.zero, a)) for a in item.args]
        terms = linear_terms(item, parts)
        if terms is not None:
            held = [t for t in terms if t.arg in parts]
            slope = pool.add(*[t.of(pool, parts[t.arg][0]) for t in held])
        elif item.op is Op.IF and item.args[0] not in parts:
            slope = pool.choose(item.args[0], own[1][0], own[2][0])
        else:
            return None
        parts[item] = slope, pool.rebuild(item, tuple([rest for _, rest in own]))
    return parts[node]


def rest(pool: Pool, zero: Expr, variables: Sequence[Expr]) -> Expr | None:
    """What is left of a linear equation beside its variables; None where it is not linear in them.

    Zero in place of the variables would not do: it is no value of log(2 f) - log(3 f).
    """
    wanted = set(variables)
    for variable in [n for n in topological([zero]) if n in wanted]:
        parts = affine(pool, zero, variable)
        if parts is None or any(n in wanted for n in topological([parts[0]])):
            return None
        zero = parts[1]
    return zero
