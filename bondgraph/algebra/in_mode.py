"""What an expression is in each mode of the switches that it holds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product

from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological

_MOST = 5  # switches; each doubles the number of modes


def in_each_mode(pool: Pool, expr: Expr) -> list[Expr] | None:
    """The expression for every setting of its boolean inputs.

    None where something else decides as well, or the expression has no value in a mode.

    >>> p = Pool(); on = p.symbol("on", Kind.MODE); R = p.symbol("R", Kind.PARAM)
    >>> in_each_mode(p, p.choose(on, R, p.one))
    [1, R]
    """
    modes = []
    for node in topological([expr]):
        if node.kind is Kind.MODE:
            modes.append(node)
        elif node.op is Op.CMP:
            return None
    if len(modes) > _MOST:
        return None
    out = []
    for setting in product((False, True), repeat=len(modes)):
        try:
            out += in_mode(pool, [expr], dict(zip(modes, setting, strict=True)))
        except ZeroDivisionError:
            return None
    return out


def in_mode(pool: Pool, exprs: Sequence[Expr], setting: Mapping[Expr, bool]) -> list[Expr]:
    """The expressions while boolean inputs have these values.

    Raises ZeroDivisionError where one has no value then.

    >>> p = Pool(); on = p.symbol("on", Kind.MODE); R = p.symbol("R", Kind.PARAM)
    >>> in_mode(p, [p.choose(on, R, p.one)], {on: False})
    [1]
    """
    truth = dict(setting)
    new: dict[Expr, Expr] = {}
    for node in topological(exprs):
        if node.op is Op.LOGIC:
            held = [truth[a] for a in node.args if a in truth]
            decides = node.name == "or"  # what one argument alone decides by being so
            if node.name == "not" and held:
                truth[node] = not held[0]
            elif decides in held or len(held) == len(node.args):
                truth[node] = decides if decides in held else not decides
        if node in truth:  # as a number
            new[node] = pool.one if truth[node] else pool.zero
        elif node.op is Op.IF and node.args[0] in truth:
            new[node] = new[node.args[1] if truth[node.args[0]] else node.args[2]]
        elif node.op is Op.LOGIC and node.name != "not":
            rest = [new[a] for a in node.args if a not in truth]
            new[node] = pool.logic(node.name, *rest) if len(rest) > 1 else rest[0]
        else:
            new[node] = pool.rebuild(node, tuple(new[a] for a in node.args))
    return [new[expr] for expr in exprs]
