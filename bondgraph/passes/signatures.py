"""Find which fault moves which relation, exactly, and take out of the relations what cancels.

A relation is differentiated with respect to every parameter and signal by reverse mode, over a
prime field, at a random point: once at free signals, which shows what cancels for every signal
(the backlash torque in the drives' first relation), and once on a healthy trajectory of the
plant, which decides the signature. Parameters are functions of time here, so that a fault is
found whatever its course. Presence of a symbol proves nothing; a derivative that vanishes does.
"""

from __future__ import annotations

from bondgraph.exact.evaluate import Sensitivity
from bondgraph.exact.plant import Plant
from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols, topological
from bondgraph.ir.residuals import Closing, ReducedSystem, Residual, ResidualSet
from bondgraph.ir.signatures import SignatureMatrix
from bondgraph.passes.cleared import cleared, moduli, nothings
from bondgraph.passes.nominal import Nominal
from bondgraph.passes.present import upright
from bondgraph.passes.reactions import Reactions
from bondgraph.text.diagnostic import Report

_LONG = 2000  # nodes


def signatures(
    reduced: ReducedSystem, report: Report, seed: int = 1, plant: Plant | None = None
) -> tuple[ResidualSet, SignatureMatrix]:
    """The relations, named in the order of the model, and their fault signature matrix.

    Exact up to a probability below 1e-12 (Schwartz and Zippel). Where no trajectory of the plant
    can be had, the signatures are those at free signals and the verification says so.
    """
    return _Analysis(reduced, seed, plant or Plant(reduced.system.graph)).run()


class _Analysis:
    def __init__(self, reduced: ReducedSystem, seed: int, plant: Plant) -> None:
        self.reduced = reduced
        self.graph = reduced.system.graph
        self.pool = self.graph.pool
        self.reactions = Reactions(plant, seed)
        self.nominal = Nominal(self.graph)

    def run(self) -> tuple[ResidualSet, SignatureMatrix]:
        relations: list[tuple[Closing, Expr, dict[Expr, int]]] = []
        for closing in self.reduced.closings:
            free = self.reactions.at_free_signals(closing.expr)
            if any(v and s.symbol.kind is not Kind.CONST for s, v in free.depends.items()):
                own = pruned(self.pool, closing, free)
                bases = moduli(self.reduced.system, own.steps)
                bases += [b for b in nothings(self.nominal, own.expr) if symbols(b)]
                expr = cleared(self.pool, own.expr, bases)
                expr = upright(self.pool, expr)
                if all(expr is not other for _, other, _ in relations):  # two equal gyrators
                    relations.append((own, expr, free.orders))
        reacts = self.reactions.on_trajectories(
            [with_moving_parameters(c, e) for c, e, _ in relations],
            [_behind(c) for c, _, _ in relations],
        )
        names = [f"r{i + 1}" for i in range(len(relations))]
        residuals = tuple(
            Residual(name, expr, c.equation, c.steps, c.differentiated, c.free_of)
            for name, (c, expr, _) in zip(names, relations, strict=True)
        )
        faults = self.graph.fault_symbols()
        rows = [tuple(symbol in seen for seen in reacts) for symbol in faults.values()]
        orders = tuple({s.symbol.name: k for s, k in own.items()} for _, _, own in relations)
        reduced = self.reduced
        return (
            ResidualSet(reduced.system, residuals, reduced.unsolved, reduced.unmonitored),
            SignatureMatrix(tuple(names), tuple(faults), tuple(rows), orders),
        )


def _behind(closing: Closing) -> list[Expr]:
    """The symbols that a relation was made of, those included that have dropped out of it.

    A parameter may drop out only because it is constant: that of a storage whose flow is zero.
    """
    if len(closing.steps) > _LONG:
        return symbols(closing.raw)
    zeros = [s.equation.zero for s in closing.steps]
    return symbols(closing.raw, closing.equation.zero, *zeros)


def with_moving_parameters(closing: Closing, expr: Expr) -> Expr:
    """The form of a relation that shows what a parameter does that moves.

    Differentiating takes an undeclared initial value away only while its parameter is constant.
    A long relation is left as it is: there the random points are exponentials, without integrals.
    """
    nodes = topological([closing.raw])
    moved = any(n.op is Op.INT and n.symbol.kind is Kind.FREE for n in nodes)
    return closing.raw if moved and len(nodes) <= _LONG else expr


def moving(reduced: ReducedSystem, residuals: ResidualSet) -> list[Expr]:
    """The residuals of a model in the form that shows what a parameter does that moves."""
    closings = {id(c.equation): c for c in reduced.closings}
    return [with_moving_parameters(closings[id(r.closing)], r.expr) for r in residuals.residuals]


def pruned(pool: Pool, closing: Closing, free: Sensitivity) -> Closing:
    """The relation without the parts that cancel whatever the signals are.

    A part cancels when the relation's derivative with respect to it vanishes; the relation keeps
    its value when the part is put to zero. (What decides between branches counts as influence.)
    What the equation of an iteration holds stays: its root is then still the variable it is of.
    """
    nodes = topological([closing.expr])
    kept = set(topological([a for n in nodes if n.op is Op.ROOT for a in n.args]))
    dead = {n: pool.zero for n in nodes if n in free.dead and n not in kept}
    dead = {n: zero for n, zero in dead.items() if n.op is not Op.NUM}
    if not dead:
        return closing
    try:
        expr, *values = pool.substitute([closing.expr, *[s.closed for s in closing.steps]], dead)
    except ZeroDivisionError:
        return closing
    steps = [s._replace(closed=v) for s, v in zip(closing.steps, values, strict=True)]
    return closing._replace(expr=expr, steps=tuple(steps))
