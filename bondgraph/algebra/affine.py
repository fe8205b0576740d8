"""Equations that are linear in a variable: its slope, and what is left beside it."""

from __future__ import annotations

from collections.abc import Sequence

from bondgraph.ir.expr import Expr, Op, Pool, topological
from bondgraph.ir.nodes import holding


def plainly_affine(pool: Pool, zero: Expr, variable: Expr) -> tuple[Expr, Expr] | None:
    """`affine` for the usual balance or linear law: a sum of symbols and products of symbols.

    None where the equation is of another form or holds the variable more than once.
    """
    if zero.op is not Op.ADD:
        return None
    found: tuple[Expr, Expr] | None = None
    rest = []
    for c, arg in zero.terms:
        if arg.op is Op.MUL:
            if any(a.op is not Op.SYM for a in arg.args):
                return None
            if variable not in arg.args:
                rest.append((c, arg))
                continue
            if arg.exponents[arg.args.index(variable)] != 1:
                return None
        elif arg.op is not Op.SYM:
            return None
        elif arg is not variable:
            rest.append((c, arg))
            continue
        if found is not None:
            return None
        found = pool.scale(c, pool.div(arg, variable)), pool.zero
    return None if found is None else (found[0], pool.add(*rest))


def affine(pool: Pool, node: Expr, variable: Expr) -> tuple[Expr, Expr] | None:
    """`slope`, `rest` with node = slope * variable + rest, both free of it; None if not affine."""
    holders = holding([node], lambda n: n is variable)
    if node not in holders:
        return pool.zero, node
    parts: dict[Expr, tuple[Expr, Expr]] = {variable: (pool.one, pool.zero)}
    for item in holders:
        if item is variable:
            continue
        if item.op is Op.ADD:
            slopes, rests = [], []
            for c, arg in item.terms:
                slope, rest = parts.get(arg, (pool.zero, arg))
                slopes.append((c, slope))
                rests.append((c, rest))
            parts[item] = pool.add(*slopes), pool.add(*rests)
        elif item.op is Op.MUL:
            inside = [a for a in item.args if a in parts]
            power = item.exponents[item.args.index(inside[0])]
            if len(inside) != 1 or power != 1:
                return None
            slope, rest = parts[inside[0]]
            others = [
                pool.power(a, e)
                for a, e in item.factors
                if a is not inside[0]
            ]
            parts[item] = pool.mul(slope, *others), pool.mul(rest, *others)
        elif item.op is Op.IF and item.args[0] not in parts:
            yes, no = (parts.get(a, (pool.zero, a)) for a in item.args[1:])
            slope = pool.choose(item.args[0], yes[0], no[0])
            parts[item] = slope, pool.choose(item.args[0], yes[1], no[1])
        else:
            return None
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
