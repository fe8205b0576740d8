"""What an expression is in each mode of the switches that it holds."""

from __future__ import annotations

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
        if node.op is Op.SYM and node.symbol.kind is Kind.MODE:
            modes.append(node)
        elif node.op is Op.CMP:
            return None
    if len(modes) > _MOST:
        return None
    out = []
    for setting in product((False, True), repeat=len(modes)):
        try:
            out.append(_set(pool, expr, dict(zip(modes, setting, strict=True))))
        except ZeroDivisionError:
            return None
    return out


def _set(pool: Pool, expr: Expr, setting: dict[Expr, bool]) -> Expr:
    truth = dict(setting)
    new: dict[Expr, Expr] = {}
    for node in topological([expr]):
        if node.op is Op.LOGIC:
            held = [truth[a] for a in node.args]
            if node.name == "not":
                truth[node] = not held[0]
            else:
                truth[node] = all(held) if node.name == "and" else any(held)
        if node in truth:  # as a number
            new[node] = pool.one if truth[node] else pool.zero
        elif node.op is Op.IF and node.args[0] in truth:
            new[node] = new[node.args[1] if truth[node.args[0]] else node.args[2]]
        else:
            new[node] = pool.rebuild(node, tuple(new[a] for a in node.args))
    return new[expr]
