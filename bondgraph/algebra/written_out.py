"""How long an expression is as one sum with all derivatives taken, without taking them."""

from __future__ import annotations

from bondgraph.ir.expr import CONSTANTS, Expr, Kind, Op, topological

_POWER = 4  # up to which a power of a sum is multiplied out here


def terms_written_out(expr: Expr) -> int:
    """About how many terms the sum has; like terms that would be collected are counted apart.

    Where laws of a chain are nonlinear and each differentiates the one before it, the product rule
    makes this grow by a power a law.

    >>> from bondgraph.ir.expr import Kind, Pool
    >>> pool = Pool()
    >>> x, y = (pool.symbol(name, Kind.SENSOR) for name in "xy")
    >>> terms_written_out(pool.der(pool.mul(x, y), 2))  # x'' y + 2 x' y' + x y''
    3
    """
    nodes = list(topological([expr]))
    asked = dict.fromkeys(nodes, 0)  # the highest derivative of each that is needed
    for node in reversed(nodes):
        for arg in node.args:
            asked[arg] = max(asked[arg], asked[node] + node.order)
    found: dict[Expr, list[int]] = {}
    for node in nodes:
        found[node] = _terms(node, [found[arg] for arg in node.args], asked[node])
    return found[expr][0]


def _terms(node: Expr, args: list[list[int]], order: int) -> list[int]:
    """The terms of a node and of its derivatives, by those of its arguments."""
    orders = range(order + 1)
    if node.op is Op.NUM or (node.op is Op.SYM and node.symbol.kind in {*CONSTANTS, Kind.MODE}):
        return [1] + [0] * order
    if node.op is Op.SYM:
        return [1] * (order + 1)
    if node.op is Op.DER:
        return args[0][1 : order + 2]
    if node.op is Op.INT:
        return [1, *args[0][:order]]
    if node.op is Op.ADD:
        return [sum(arg[k] for arg in args) for k in orders]
    if node.op is Op.MUL:
        found = [1] + [0] * order
        for (_, exponent), arg in zip(node.factors, args, strict=True):
            own = [arg] * exponent if 0 < exponent <= _POWER else [_function([arg], order)]
            for factor in own:
                if not any(factor[1:]):  # a constant
                    continue
                found = [sum(found[j] * factor[k - j] for j in range(k + 1)) for k in orders]
        return found
    return _function(args, order)


def _function(args: list[list[int]], order: int) -> list[int]:
    """Of something that stays as it is: its derivative is a slope times that of an argument."""
    found = [1]
    for k in range(1, order + 1):
        found.append(sum(found[j] * arg[k - j] for arg in args for j in range(k)))
    return found
