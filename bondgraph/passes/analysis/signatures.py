"""Find which fault moves which relation, exactly, and take out of the relations what cancels.

A relation is differentiated with respect to every parameter and signal by reverse mode at random
points: over a prime field at free signals, which shows what cancels for every signal and number (as
the backlash torque in the first relation of a drive does), and on trajectories of the plant at its
declared numbers, which decide the signature (`reactions`). Presence of a symbol proves nothing.
"""

from __future__ import annotations

from collections.abc import Mapping

from bondgraph.algebra.cancelled import without
from bondgraph.algebra.nominal import Nominal
from bondgraph.algebra.present import upright
from bondgraph.exact.evaluate import Sensitivity
from bondgraph.exact.plant import Plant
from bondgraph.exact.reactions import Reactions, entries
from bondgraph.ir.expr import KNOWN_SIGNALS, Expr, Kind, Op, Pool, symbols, topological
from bondgraph.ir.residuals import Closing, ReducedSystem, Residual, ResidualSet
from bondgraph.ir.signature_matrix import SignatureMatrix
from bondgraph.passes.relation.cleared import cleared, moduli, vanishing_divisors
from bondgraph.text.diagnostic import Report

_LONG = 2000  # nodes


def signatures(
    reduced: ReducedSystem, report: Report, seed: int = 1, plant: Plant | None = None
) -> tuple[ResidualSet, SignatureMatrix]:
    """The relations, named in the order of the model, and their fault signature matrix.

    Where no trajectory of the plant can be had at the declared numbers, the signatures are those at
    other numbers, or at free signals, and the matrix says that they are unconfirmed.
    """
    return _Analysis(reduced, seed, plant or Plant(reduced.system.graph)).run()


class _Analysis:
    def __init__(self, reduced: ReducedSystem, seed: int, plant: Plant) -> None:
        self.reduced = reduced
        self.graph = reduced.system.graph
        self.pool = self.graph.pool
        self.plant, self.seed = plant, seed
        self.reactions = Reactions(plant, seed)
        self.nominal = Nominal(self.graph)

    def run(self) -> tuple[ResidualSet, SignatureMatrix]:
        relations: list[tuple[Closing, Expr, dict[Expr, int]]] = []
        met: set[Expr] = set()
        for closing in self.reduced.closings:
            free = self.reactions.at_free_signals(closing.expr)
            alive = any(v and s.symbol.kind is not Kind.CONST for s, v in free.depends.items())
            if alive and self._says_something(closing.expr):
                own = pruned(self.pool, closing, free)
                bases = moduli(self.reduced.system, own.steps)
                bases += [b for b in vanishing_divisors(self.nominal, own.expr) if symbols(b)]
                expr = cleared(self.pool, own.expr, bases)
                expr = upright(self.pool, expr)
                if expr not in met:  # two equal gyrators
                    met.add(expr)
                    relations.append((own, expr, free.orders))
        names = [f"r{i + 1}" for i in range(len(relations))]
        seen = entries(self.plant, self.seed, [(e, _behind(c)) for c, e, _ in relations])
        residuals = tuple(
            Residual(name, expr, c.equation, c.steps, c.differentiated, c.free_of)
            for name, (c, expr, _) in zip(names, relations, strict=True)
        )
        faults = self.graph.fault_symbols()
        hits = {symbol: [False] * len(names) for symbol in faults.values()}
        for at, sees in enumerate(seen):
            for symbol in sees.seen:
                if symbol in hits:
                    hits[symbol][at] = True
        apart = {
            (name, fault): tuple(v.symbol.name for v in own.apart[symbol])
            for name, own in zip(names, seen, strict=True)
            if own.apart
            for fault, symbol in faults.items()
            if symbol in own.apart
        }
        unconfirmed = {n: own.reason for n, own in zip(names, seen, strict=True) if own.reason}
        orders = tuple(_by_name(own) for _, _, own in relations)
        reduced = self.reduced
        return (
            ResidualSet(
                reduced.system, residuals, reduced.unsolved, reduced.unmonitored, reduced.missing
            ),
            SignatureMatrix(
                tuple(names),
                tuple(faults),
                tuple(map(tuple, hits.values())),
                orders,
                apart,
                unconfirmed,
            ),
        )

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


def _behind(closing: Closing) -> list[Expr]:
    """The symbols that a relation was made of, those included that have dropped out of it.

    A parameter may drop out only because it is constant: that of a storage whose flow is zero.
    """
    if len(closing.steps) > _LONG:
        return symbols(closing.raw)
    zeros = [s.equation.zero for s in closing.steps]
    return symbols(closing.raw, closing.equation.zero, *zeros)


def pruned(pool: Pool, closing: Closing, free: Sensitivity) -> Closing:
    """The relation without the parts that cancel whatever the signals are.

    A part cancels when the relation's derivative with respect to it vanishes; the relation keeps
    its value `without` it. (What decides between branches counts as influence.)
    What the equation of an iteration holds stays: its root is then still the variable it is of.
    """
    nodes = topological([closing.expr])
    kept = set(topological([a for n in nodes if n.op is Op.ROOT for a in n.args]))
    dead = [n for n in nodes if n in free.dead and n not in kept]
    expr, *values = without(pool, closing.expr, dead, [s.closed for s in closing.steps])
    steps = [s._replace(closed=v) for s, v in zip(closing.steps, values, strict=True)]
    return closing._replace(expr=expr, steps=tuple(steps))
