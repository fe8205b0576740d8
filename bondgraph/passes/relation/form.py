"""The form in which a relation goes on: without what cancels, without denominators, upright.

What the elimination leaves over gets its final form here and nowhere else. A part of a relation
that cancels for every signal and number (as the backlash torque in the first relation of a drive
does) is found by differentiating it at free signals over a prime field; presence of a symbol
proves nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from bondgraph.algebra.cancelled import without
from bondgraph.algebra.cleared import cleared
from bondgraph.algebra.nominal import Nominal
from bondgraph.algebra.present import upright
from bondgraph.exact.dependence import Sensitivity
from bondgraph.exact.plant import Plant
from bondgraph.exact.reactions import Reactions
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.expr import KNOWN_SIGNALS, Expr, Kind, Op, Pool, symbols, topological
from bondgraph.ir.residuals import Closing, ReducedSystem, Residual, ResidualSet
from bondgraph.passes.relation.moduli import moduli, signals_below, vanishing_divisors


def relations(reduced: ReducedSystem, plant: Plant, seed: int = 1) -> ResidualSet:
    """The relations of a reduced system in their final form, named in the order of the model.

    One that says nothing about the machine, and the second of two that are the same, are left out.
    """
    former = _Former(reduced.system, plant, seed)
    return ResidualSet(
        reduced.system,
        former.formed(reduced.closings, ()),
        reduced.unsolved,
        reduced.unmonitored,
        reduced.missing,
    )


def with_further(
    residuals: ResidualSet, closings: Iterable[Closing], plant: Plant, seed: int = 1
) -> ResidualSet:
    """The relations and behind them further ones."""
    former = _Former(residuals.system, plant, seed)
    found = former.formed(closings, residuals.residuals)
    return residuals._replace(residuals=(*residuals.residuals, *found))


class _Former:
    """Gives relations of one plant their form."""

    def __init__(self, system: EquationSystem, plant: Plant, seed: int) -> None:
        self.system = system
        self.pool: Pool = system.graph.pool
        self.reactions = Reactions(plant, seed)
        self.nominal = Nominal(system.graph)

    def formed(
        self, closings: Iterable[Closing], before: tuple[Residual, ...]
    ) -> tuple[Residual, ...]:
        """What is not among the residuals `before`, which have the first names."""
        met = {residual.expr for residual in before}
        found: list[Residual] = []
        for closing in closings:
            free = self.reactions.at_free_signals(closing.expr)
            alive = any(v and s.symbol.kind is not Kind.CONST for s, v in free.depends.items())
            if not alive or not self._says_something(closing.expr):
                continue
            own = self._pruned(closing, free)
            expr = upright(self.pool, cleared(self.pool, own.expr, self._denominators(own)))
            if expr not in met:  # two equal gyrators
                met.add(expr)
                name = f"r{len(before) + len(found) + 1}"
                orders = _by_name(free.orders)
                found.append(
                    Residual(
                        name, expr, own.equation, own.steps, own.differentiated, own.free_of,
                        own.raw, orders, own.loop, own.each,
                    )
                )  # fmt: skip
        return tuple(found)

    def _pruned(self, closing: Closing, free: Sensitivity) -> Closing:
        """The relation without the parts that cancel whatever the signals are.

        A part may cancel when the relation's derivative with respect to it vanishes; it does where
        the relation keeps its value `without` it, which (n - x)^2 does not, where n is x at all
        times. (What decides between branches counts as influence.)
        What the equation of an iteration holds stays: its root is then still the variable it is of.
        """
        nodes = topological([closing.expr])
        kept = set(topological([a for n in nodes if n.op is Op.ROOT for a in n.args]))
        dead = [n for n in nodes if n in free.dead and n not in kept]
        if not self._cancel(closing.expr, dead):
            told, dead = dead, []
            for node in told:
                if self._cancel(closing.expr, [*dead, node]):
                    dead.append(node)
        closed = [s.closed for s in closing.steps]
        expr, *values = without(self.pool, closing.expr, dead, closed)
        steps = [s._replace(closed=v) for s, v in zip(closing.steps, values, strict=True)]
        return closing._replace(expr=expr, steps=tuple(steps))

    def _cancel(self, expr: Expr, parts: list[Expr]) -> bool:
        """Whether the relation has the same value without the parts, at free signals."""
        return self.reactions.agree_at_free_signals(expr, without(self.pool, expr, parts)[0])

    def _denominators(self, closing: Closing) -> list[Expr]:
        """What a relation is multiplied with, because it may be zero while the machine runs."""
        if closing.free_of is None:
            bases = moduli(self.system, closing.steps)
        else:  # what an unknown fault stood before is a modulus as well
            bases = signals_below(closing.expr)
        gone = [b for b in vanishing_divisors(self.nominal, closing.expr) if symbols(b)]
        return [*bases, *gone]

    def _says_something(self, expr: Expr) -> bool:
        """Whether a relation holds more than that a reading is what its sensor says."""
        merged = self.pool.logged([expr])[0]
        if merged is expr:
            return True
        free = self.reactions.at_free_signals(merged)
        return any(v and s.symbol.kind in KNOWN_SIGNALS for s, v in free.depends.items())


def _by_name(orders: Mapping[Expr, int]) -> dict[str, int]:
    """The order of each known signal; a sensor and its reading are one."""
    found: dict[str, int] = {}
    for symbol, order in orders.items():
        name = symbol.symbol.name
        found[name] = max(found.get(name, order), order)
    return found
