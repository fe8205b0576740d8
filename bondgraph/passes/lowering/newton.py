"""Roots of equations without a closed solution as blocks of a residual program."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable

from bondgraph.algebra.derivative import partial
from bondgraph.ir.expr import Expr, Op, Pool, Root, topological
from bondgraph.ir.program import Assign, Expression, NewtonBlock, Ref
from bondgraph.ir.show import show
from bondgraph.passes.lowering.procedure import Procedure
from bondgraph.passes.lowering.program_names import Names

#: Steps of Newton's method and bisection at most.
MOST = 200
#: A bracket this narrow, next to the widest step, ends the search: at a jump across zero.
NARROW = 1e-36


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
    body: list[Assign] = []
    work = Procedure(pool, given.get, body.append, names, "v")
    slope = partial(pool, root.zero, root.unknown)
    value = work.value(root.zero, None)
    size = len(body)
    steep = work.value(slope, None)
    called = {root.unknown: "x", **dict(zip(root.places, arguments, strict=True))}
    comment = f"{root.name} is the x at which {show(root.zero, called.get)} is zero"
    return NewtonBlock(
        root.name, arguments, tuple(body[:size]), value, tuple(body[size:]), steep, root.rising,
        float(root.guess), MOST, comment, None,
    )  # fmt: skip


def newton(
    look: Callable[[float], tuple[float, float]], rising: bool, guess: float, most: int
) -> float:
    """The zero of a function that grows (or falls) everywhere; NaN if `most` steps find none.

    `look(x)` gives value and slope, NaN where there is none; a value that is NaN sends the search
    back towards the guess. A step of Newton that leaves the bracket, or does not halve the value,
    is replaced by a bisection, or while one side is open by a step twice as wide as the last
    (Press et al., Numerical Recipes, 2007, section 9.4). Where the function jumps across zero, the
    jump is the answer: friction that stands still.

    >>> round(newton(lambda x: (x**3 + x - 10, 3 * x**2 + 1), True, 0.0, 200), 12)
    2.0
    """
    x, low, high, wide, last = guess, -math.inf, math.inf, 1.0, math.inf
    for _ in range(most):
        value, slope = look(x)
        if value == 0.0:
            return x
        up = x > guess if math.isnan(value) else (value > 0.0) == rising
        low, high = (low, x) if up else (x, high)
        after = x - value / slope if slope and math.isfinite(slope) else math.nan
        slow = not abs(value) <= 0.5 * last
        if not low < after < high or (slow and math.isfinite(low) and math.isfinite(high)):
            if math.isfinite(low) and math.isfinite(high):
                after = low + 0.5 * (high - low)
            else:
                after = x - wide if up else x + wide
                wide *= 2.0
        last = abs(value)
        if x + 0.125 * (after - x) == x or high - low <= NARROW * wide:
            return after
        x = after
    return math.nan


def or_nan(compute: Callable[[], float]) -> float:
    """A number, or NaN where there is none."""
    try:
        return compute()
    except (ArithmeticError, ValueError):
        return math.nan
