"""Bring a relation to the form in which a person would write it: constants out of derivatives,
shared parts named by the variable of the model that they are."""

from __future__ import annotations

from typing import NamedTuple

from bondgraph.ir.expr import Expr, Op, Pool, topological
from bondgraph.ir.residuals import Residual
from bondgraph.ir.show import show
from bondgraph.passes.solve import constant

_SHORT = 3  # a shared part of fewer nodes than this reads better in full


class ClosedForm(NamedTuple):
    """`text` of a relation, with `where` as (name, text) for its shared parts, outermost first."""

    text: str
    where: tuple[tuple[str, str], ...]

    def __str__(self) -> str:
        lines = [self.text]
        for position, (name, text) in enumerate(self.where):
            lines.append(f"{'where' if position == 0 else '     '} {name} = {text}")
        return "\n".join(lines)


def tidy(pool: Pool, *exprs: Expr) -> list[Expr]:
    """The expressions with constant factors and terms moved out of time derivatives.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); y = p.symbol("y", Kind.SENSOR); C = p.symbol("C", Kind.PARAM)
    >>> tidy(p, p.der(p.mul(C, y)))
    [C*D(y)]
    """
    new: dict[Expr, Expr] = {}
    memo: dict[Expr, bool] = {}
    for node in topological(exprs):
        args = tuple(new[a] for a in node.args)
        if node.op is Op.DER:
            new[node] = _derivative(pool, args[0], memo)
        else:
            new[node] = pool.rebuild(node, args)
    return [new[e] for e in exprs]


def _derivative(pool: Pool, node: Expr, memo: dict[Expr, bool]) -> Expr:
    if constant(node, memo):
        return pool.zero
    if node.op is Op.ADD:
        terms = zip(node.coefficients, node.args, strict=True)
        moving = [(c, a) for c, a in terms if not constant(a, memo)]
        if len(moving) == 1:
            return pool.add((moving[0][0], _derivative(pool, moving[0][1], memo)))
        return pool.der(pool.add(*moving))
    if node.op is Op.MUL:
        factors = list(zip(node.args, node.exponents, strict=True))
        still = [pool.power(a, e) for a, e in factors if constant(a, memo)]
        moving_part = pool.mul(*[pool.power(a, e) for a, e in factors if not constant(a, memo)])
        return pool.mul(*still, pool.der(moving_part)) if still else pool.der(node)
    return pool.der(node)


def closed_form(pool: Pool, residual: Residual) -> ClosedForm:
    """The relation as nested text; what occurs more than once is named and written once."""
    known = [s for s in residual.steps if s.closed.args]
    root, *values = tidy(pool, residual.expr, *[s.closed for s in known])
    names: dict[Expr, str] = {}
    for step, value in zip(known, values, strict=True):
        if value.args:
            names.setdefault(value, step.variable.symbol.name)
    order = topological([root])
    uses: dict[Expr, int] = dict.fromkeys(order, 0)
    size: dict[Expr, int] = {}
    for node in order:
        size[node] = 1 + sum(min(size[a], _SHORT) for a in node.args)
        for arg in node.args:
            uses[arg] += 1
    chosen: dict[Expr, str] = {}
    for node in order:
        if uses[node] > 1 and size[node] > _SHORT and node.op is not Op.NUM:
            chosen[node] = names.get(node) or f"x{len(chosen) + 1}"
    where = [
        (chosen[node], show(node, lambda n, own=node: None if n is own else chosen.get(n)))
        for node in reversed(order)
        if node in chosen
    ]
    return ClosedForm(show(root, chosen.get), tuple(where))
