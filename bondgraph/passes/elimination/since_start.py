"""Use declared initial values where a relation holds nothing but the rates of states.

Two springs on one velocity that nobody knows: it drops out of their rates, and they have kept the
difference that they began with. Told of the states the relation needs no derivative, and sees what
stands still.
"""

from __future__ import annotations

from bondgraph.algebra.affine import affine
from bondgraph.algebra.summands import summands
from bondgraph.algebra.zero import is_zero
from bondgraph.ir.equation_system import Equation
from bondgraph.ir.expr import Expr, Op, Pool
from bondgraph.ir.nodes import constant
from bondgraph.ir.residuals import Closing, ReducedSystem


def since_start(system: ReducedSystem) -> ReducedSystem:
    """The reduced system with relations of states in place of those of their rates alone.

    Those of loops, of single positions of switches and with undeclared initial values stay.
    """
    pool, fixed = system.system.graph.pool, dict[Expr, bool]()
    closings = [_since_start(pool, c, fixed) for c in system.closings]
    return system._replace(closings=tuple(closings))


def _since_start(pool: Pool, closing: Closing, fixed: dict[Expr, bool]) -> Closing:
    plain = not (closing.loop or closing.each or closing.differentiated)
    if not plain or not all(_is_rate(term, fixed) for term in summands(closing.expr)):
        return closing
    states: dict[Expr, Equation] = {}  # by their rates, for which nothing is put in
    used = [(s.equation, s.how) for s in closing.steps]
    for equation, how in [*used, (closing.equation, "differentiated")]:
        if equation.initial is not None and how != "integrated":
            assert equation.state is not None
            states[pool.der(equation.state)] = equation
    values = {rate: rate for rate in states}
    for step in closing.steps:
        if step.how == "loop":
            return closing
        values[step.variable] = pool.substitute([step.value], values)[0]
    told = pool.substitute([closing.equation.zero], values)[0]
    known = {step.variable: step.closed for step in closing.steps}
    kept = []
    for rate, equation in states.items():
        parts = affine(pool, told, rate)
        if parts is None or not constant(parts[0], fixed):
            return closing
        slope, told = parts
        assert equation.state is not None and equation.initial is not None
        kept.append((1, pool.mul(slope, pool.sub(known[equation.state], equation.initial))))
    found = pool.add(*kept)
    return closing._replace(expr=found, raw=found, differentiated=-1) if is_zero(told) else closing


def _is_rate(term: Expr, fixed: dict[Expr, bool]) -> bool:
    """Whether a term is a derivative with a constant factor; `fixed` is known of parts."""
    factors = term.factors if term.op is Op.MUL else ((term, 1),)
    moving = [(a, e) for a, e in factors if not constant(a, fixed)]
    return len(moving) == 1 and moving[0][1] == 1 and moving[0][0].op is Op.DER
