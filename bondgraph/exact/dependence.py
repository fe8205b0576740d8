"""What the value of an expression depends on at a point, now and in the past.

An integral remembers. One pass of adjoints says what matters of the present, and one more at each
earlier point what matters of the past.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, TypeAlias

from bondgraph.exact.adjoints import pull, static_adjoints
from bondgraph.exact.evaluate import Sample, chosen, static_values, values_of
from bondgraph.exact.outline import demands, integral_depth, outline
from bondgraph.exact.signal_algebra import Exponentials, Mixed, Taylor, Values
from bondgraph.field.numbers import Number, Numbers
from bondgraph.ir.expr import KNOWN_SIGNALS, Expr, Op, Symbol, topological

#: An IF node, and whether its condition holds.
Side: TypeAlias = tuple[Expr, bool]


class Sensitivity(NamedTuple):
    """What a residual depends on at a point.

    `depends[symbol]` for every SYM node below the root: whether the derivative with respect to it
    (as a function of time, the past included) is not zero. `orders[signal]` for the known signals
    with dependence: the highest derivative, -1 where only the past of the signal matters. `dead`
    are the nodes below the root that do not influence it. `starts` are the initial values of the
    integrals that influence it, `lasting` the symbols of which a constant change shows, too.
    """

    depends: dict[Expr, bool]
    orders: dict[Expr, int]
    dead: frozenset[Expr]
    starts: tuple[Symbol, ...]
    lasting: frozenset[Expr]


class Forward:
    """The values below some roots at a point, of which each is to be differentiated by itself."""

    def __init__(self, roots: Sequence[Expr], sample: Sample) -> None:
        self.numbers: dict[Expr, Number] | None = None
        if isinstance(sample.algebra, Taylor):
            self.numbers = static_values(tuple(roots), sample)
        if self.numbers is None:
            nodes = topological(roots)
            self.need = demands(nodes, roots, 1)
            self.values, self.failures = values_of(nodes, self.need, sample)

    def taken(self, roots: Sequence[Expr], algebra: Values[Any]) -> set[Side]:
        """The branches that the values of the roots come from."""
        if self.numbers is not None:
            return set()  # without a branch
        found: set[Side] = set()

        def inside(node: Expr) -> tuple[Expr, ...]:
            if node.op is not Op.IF:
                return node.args
            branch = chosen(node, self.values, algebra)
            found.add((node, branch is node.args[1]))
            return (node.args[0], branch)

        reached = set(roots)
        left = list(reached)
        for node in left:  # it grows as we go
            new = [arg for arg in inside(node) if arg not in reached]
            reached.update(new)
            left += new
        return found


def sensitivities(
    root: Expr, sample: Sample, jumps: bool = False, forward: Forward | None = None
) -> Sensitivity:
    """What the value of `root` depends on at a point, by reverse mode.

    With `jumps` what a decision rests on counts as having an influence.

    Signals and parameters are functions of time. An integral carries dependence on the past: it
    is followed at earlier points of the same plant, one more for each nested integral, with
    random weights. Raises like `evaluate`. What several roots share is computed once with a
    `forward` of them all.
    """
    forward = forward or Forward([root], sample)
    if isinstance(sample.algebra, Exponentials):
        while True:
            try:
                return _sensitivities(root, sample, jumps, forward)
            except Mixed as failure:
                if "cancel" not in str(failure) or sample.algebra.terms > 1 << 14:
                    raise
                sample.algebra.terms *= 4
    return _sensitivities(root, sample, jumps, forward)


def _decides(node: Expr) -> bool:
    """Whether the node's value rests on arguments that have no derivative here."""
    return node.op is Op.IF or (node.op is Op.FN and node.name in ("sign", "min", "max"))


def _static_sensitivities(root: Expr, values: dict[Expr, Number], numbers: Numbers) -> Sensitivity:
    """Of sums and products: what is seen is seen at once, and as long as it lasts."""
    found = static_adjoints(root, values, numbers)
    nodes = outline(root).nodes
    inside = outline(root).symbols
    orders = {v: 0 for v in inside if v in found and v.symbol.kind in KNOWN_SIGNALS}
    dead = frozenset(v for v in nodes if v not in found)
    lasting = frozenset(v for v in inside if v in found)
    return Sensitivity({v: v in found for v in inside}, orders, dead, (), lasting)


def _sensitivities(root: Expr, sample: Sample, jumps: bool, forward: Forward) -> Sensitivity:
    if forward.numbers is not None:
        return _static_sensitivities(root, forward.numbers, sample.algebra.numbers)
    nodes = outline(root).nodes
    integrals = [v for v in nodes if v.op is Op.INT]
    depth = integral_depth([root]) if integrals else 0
    algebra = sample.algebra
    alive: dict[Expr, None] = {}
    seen: dict[Expr, None] = {}
    orders: dict[Expr, int] = {}
    memory: dict[Expr, Number] = {}  # weight with which the past of an integral enters
    starts: dict[Symbol, None] = {}
    lasting: set[Expr] = set()
    for back in range(depth + 1):
        point = sample.earlier(back) if back else sample
        top = [root] if back == 0 else [v.args[0] for v in integrals if memory.get(v)]
        if not top:
            break
        below: Sequence[Expr]
        if back:
            below = topological(top)
            need = demands(below, top, 1)
            values, failures = values_of(below, need, point)
        else:
            below, need, values, failures = nodes, forward.need, forward.values, forward.failures
        for node in top:
            if node in failures:
                raise failures[node]
        adjoints: dict[Expr, Any] = {} if back else {root: algebra.seed(1)}
        for node in integrals:
            weight = memory.get(node)
            if weight:
                part = algebra.seed(weight)
                known = adjoints.get(node.args[0])
                adjoints[node.args[0]] = part if known is None else algebra.join(known, part)
        pull(below, need, values, algebra, adjoints, jumps)
        for node, adjoint in adjoints.items():
            if algebra.vanishes(adjoint):
                continue
            alive[node] = seen[node] = None
            if node.op is Op.SYM and algebra.lasting(adjoint):
                lasting.add(node)
            if node.op is Op.INT and algebra.numbers.nonzero(algebra.start_of(adjoint)):
                share = algebra.start_of(adjoint) * (7919 + 2 * back)
                memory[node] = memory.get(node, 0) + share
                starts[node.symbol] = None
            elif node.op is Op.SYM and node.symbol.kind in KNOWN_SIGNALS:
                orders[node] = max(orders.get(node, -1), -1 if back else algebra.order(adjoint))
            elif jumps and _decides(node):
                alive.update(dict.fromkeys(topological(node.args)))
    depends = {v: v in seen for v in nodes if v.op is Op.SYM}
    orders = {v: orders[v] for v in nodes if v in orders}
    dead = frozenset(v for v in nodes if v not in alive)
    return Sensitivity(depends, orders, dead, tuple(starts), frozenset(lasting))
