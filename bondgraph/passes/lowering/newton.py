"""Roots of equations without a closed solution as blocks of a residual program."""

from __future__ import annotations

from collections.abc import Iterable

from bondgraph.algebra.derivative import partial
from bondgraph.ir.expr import Expr, Op, Pool, Root, topological
from bondgraph.ir.program import Assignment, Expression, NewtonBlock, Ref
from bondgraph.notation.line import show
from bondgraph.passes.lowering.procedure import Procedure
from bondgraph.passes.lowering.program_names import Names

#: Steps of Newton's method and bisection at most.
MOST = 200


def roots_in(exprs: Iterable[Expr]) -> list[Root]:
    """The roots that expressions rest on, inner ones first."""
    found: dict[str, Root] = {}

    def look(roots: Iterable[Expr]) -> None:
        for node in topological(roots):
            if node.op is Op.ROOT and node.root.name not in found:
                look([node.root.zero])
                found[node.root.name] = node.root

    look(exprs)
    return list(found.values())


def newton_blocks(pool: Pool, exprs: Iterable[Expr]) -> tuple[NewtonBlock, ...]:
    """A block for each root that the expressions rest on, inner ones first."""
    return tuple(_block(pool, root) for root in roots_in(exprs))


def _block(pool: Pool, root: Root) -> NewtonBlock:
    names = Names()
    arguments = tuple(names.new(f"c{k}") for k in range(len(root.places)))
    given: dict[Expr, Expression] = {root.unknown: Ref("local", names.new("x"))}
    given |= {p: Ref("local", a) for p, a in zip(root.places, arguments, strict=True)}
    body: list[Assignment] = []
    work = Procedure(pool, given.get, body.append, names, "v")
    slope = partial(pool, root.zero, root.unknown)
    value = work.value(root.zero, None)
    size = len(body)
    steep = work.value(slope, None)
    called = {root.unknown: "x", **dict(zip(root.places, arguments, strict=True))}
    comment = f"{root.name} is the x at which {show(root.zero, called)} is zero"
    return NewtonBlock(
        root.name, arguments, tuple(body[:size]), value, tuple(body[size:]), steep, root.rising,
        float(root.guess), MOST, comment, None,
    )  # fmt: skip
