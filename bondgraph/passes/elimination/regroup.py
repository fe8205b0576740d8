"""Let relations of a switched plant speak of the same part of it in both positions of a switch.

In each position a set of relations holds, and which of one position is joined to which of the
other is free. Joined as the elimination met them, the balance of a coil may stand beside that of a
capacitor, and both faults look alike over all modes; joined by what they have in common, the
relations keep apart what each position keeps apart.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import permutations

from bondgraph.algebra.in_mode import in_mode
from bondgraph.algebra.summands import summands
from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols, topological
from bondgraph.ir.nodes import holding
from bondgraph.ir.residuals import Closing, InPosition, ReducedSystem, Step
from bondgraph.passes.elimination.each_mode import chosen, opposed
from bondgraph.text.tuples import NamedTuple

_MOST = 5  # relations whose halves are tried in every order
_MODES = 8  # switches that are looked at
_LARGE = 2000  # nodes of a relation that is left as it is


class _Halves(NamedTuple):
    """A relation in both positions: `told` is its expression, `raw` as in `Closing`."""

    told: tuple[Expr, Expr]
    raw: tuple[Expr, Expr]


def regroup(system: ReducedSystem) -> ReducedSystem:
    """The reduced system with the halves of its relations joined by what they hold.

    The relations of each mode stay the same ones. Fewer parameters and signals in a relation is
    better; where nothing is gained, or an integral holds a switch, nothing is changed.
    """
    pool = system.system.graph.pool
    closings = list(system.closings)
    order = [s.variable for s in system.steps]
    modes = [s for s in symbols(*[c.expr for c in closings]) if s.symbol.kind is Kind.MODE]
    for mode in modes[:_MODES]:
        members = [at for at, c in enumerate(closings) if _switched(c, mode)]
        if 1 < len(members) <= _MOST:
            _exchange(pool, order, closings, members, mode)
    return system._replace(closings=tuple(closings))


def _switched(closing: Closing, mode: Expr) -> bool:
    """Whether a relation holds a switch, no integral of it, and is small enough to look at."""
    nodes = topological([closing.expr, closing.raw])
    if len(nodes) > _LARGE:
        return False
    holders = holding([closing.expr, closing.raw], lambda n: n is mode)
    return closing.expr in holders and not any(n.op in (Op.INT, Op.ROOT) for n in holders)


def _exchange(
    pool: Pool, order: list[Expr], closings: list[Closing], members: list[int], mode: Expr
) -> None:
    """Join the halves of some relations in the best order."""
    try:
        halves = [_halves(pool, closings[at], mode) for at in members]
    except ZeroDivisionError:
        return
    held = [tuple(_held(expr) for expr in half.told) for half in halves]
    alone = [tuple(summands(expr) for expr in half.told) for half in halves]

    def cost(partners: tuple[int, ...]) -> tuple[int, int]:
        pairs = list(enumerate(partners))
        union = sum(len(held[a][0] | held[b][1]) for a, b in pairs)
        shared = sum(len(alone[a][0].keys() & alone[b][1].keys()) for a, b in pairs)
        return union, -shared

    same = tuple(range(len(members)))
    best = min(permutations(same), key=cost)
    if cost(best)[0] >= cost(same)[0]:
        return
    old = [closings[at] for at in members]
    for at, (yes, no) in zip(members, enumerate(best), strict=True):
        one, other = halves[yes], halves[no]
        turned = opposed(alone[no][1], alone[yes][0])
        closings[at] = old[yes]._replace(
            expr=_joined(pool, mode, one.told[0], other.told[1], turned),
            raw=_joined(pool, mode, one.raw[0], other.raw[1], turned),
            steps=_steps((*old[no].steps, *old[yes].steps), order),
            differentiated=max(old[yes].differentiated, old[no].differentiated),
            each=(*_there(old[yes], mode, True), *_there(old[no], mode, False)),
        )


def _halves(pool: Pool, closing: Closing, mode: Expr) -> _Halves:
    yes = in_mode(pool, [closing.expr, closing.raw], {mode: True})
    no = in_mode(pool, [closing.expr, closing.raw], {mode: False})
    return _Halves((yes[0], no[0]), (yes[1], no[1]))


def _there(closing: Closing, mode: Expr, on: bool) -> list[InPosition]:
    """What a relation is in one position of a switch."""
    each = closing.each or (InPosition((), closing),)
    return [
        InPosition((*[s for s in setting if s[0] is not mode], (mode, on)), own)
        for setting, own in each
        if dict(setting).get(mode, on) is on
    ]


def _held(expr: Expr) -> frozenset[Expr]:
    """What of a relation may fail or be wrong; switches are in any case."""
    return frozenset(s for s in symbols(expr) if s.symbol.kind is not Kind.MODE)


def _joined(pool: Pool, mode: Expr, yes: Expr, no: Expr, turned: bool) -> Expr:
    """The choice between two halves, either of which vanishes."""
    return chosen(pool, [mode], [yes, pool.neg(no) if turned else no])


def _steps(steps: Iterable[Step], order: Iterable[Expr]) -> tuple[Step, ...]:
    """The steps in the order of the elimination, each variable once: of several the last."""
    found = {step.variable: step for step in steps}
    return tuple([found[v] for v in order if v in found])
