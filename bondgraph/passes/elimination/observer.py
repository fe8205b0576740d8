"""A relation solved for the rates of its storages, with one of its sensors to be predicted.

The other realisation of a relation: where elimination differentiates a sensor to know a hidden
state, here the state is integrated, and the sensor corrects it. The other sensors are known
signals as in derivative causality.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from bondgraph.algebra.nominal import Nominal
from bondgraph.algebra.sensitivity import sensitivity
from bondgraph.algebra.zero import agree, is_zero
from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols
from bondgraph.ir.nodes import has, rebuilt
from bondgraph.ir.residuals import Observer, Residual
from bondgraph.ir.state import Block
from bondgraph.passes.elimination.linear_block import LinearEquation, solve_block
from bondgraph.passes.elimination.state_equations import Wanted, state_equations
from bondgraph.text.diagnostic import Report

#: States of an observer: its gain is made of determinants that are written out.
MOST = 5
_OFF = "value of the relation"  # the name of w


def observer(
    system: EquationSystem, integral: CausalGraph, residual: Residual
) -> Observer | str:
    """The observer of a relation, or in words why there is none.

    The equations behind the relation, with its value w as what the closing one is off. Each sensor
    is tried in turn: it can be predicted if all storages are then states, nothing known has to be
    differentiated, and w comes to it through all of them, y^(n) = ... + w/c. Of an observer with
    all poles at -b the error of y is then w/c through 1/(p + b)^n (Luenberger, 1964).
    """
    own = list(dict.fromkeys((residual.closing, *[s.equation for s in residual.steps])))
    kinds = {s.symbol.kind for s in symbols(*[e.zero for e in own])}
    if Kind.MODE in kinds:
        return "its equations are others in each position of a switch"
    if Kind.READING in kinds:
        return "a law in it acts on what a sensor says"
    if not system.graph.lags().keys().isdisjoint(symbols(residual.expr)):
        return "its signals are delayed"
    pool = system.graph.pool
    closed = {step.variable: step.closed for step in residual.steps}
    inserted = pool.substitute([residual.closing.zero], closed)[0]
    same, turned = agree([(inserted, residual.expr), (pool.neg(inserted), residual.expr)])
    if not (same or turned):
        if residual.differentiated > 0:
            return "it was differentiated, as an initial value is not declared"
        if residual.differentiated < 0:
            return "it holds what rates add up to from declared initial values"
        return "it is a combination of relations"
    value = pool.scale(1 if same else -1, pool.symbol(_OFF, Kind.INPUT))
    nominal = Nominal(system.graph)

    def size(coefficient: Expr) -> float:
        number = nominal.value(coefficient)
        return 1.0 if number is None else abs(number)

    reason = "none of its equations is that of a sensor"
    for equation in own:
        if equation.kind == "sensor":
            try:
                found = _predicting(system, integral, residual, own, equation, value, size)
            except ZeroDivisionError:
                found = f"without `{equation.name}` a step divides by zero"
            if isinstance(found, Observer):
                return found
            reason = found
    return reason


def _predicting(
    system: EquationSystem,
    integral: CausalGraph,
    residual: Residual,
    own: Sequence[Equation],
    reading: Equation,
    value: Expr,
    size: Callable[[Expr], float],
) -> Observer | str:
    """The observer that predicts one sensor, or why there is none."""
    pool = system.graph.pool
    sensor = next(s for s in system.graph.sensors if s.name == reading.name)
    order = residual.orders.get(sensor.name, 0)  # of y is the number of states
    if order > MOST:
        return f"it has {order} states, more than {MOST}"
    counted = {s.symbol for s in system.graph.sensors if s.counts is not None}
    read = pool.symbol(f"{sensor.name} as predicted", Kind.EFFORT)

    def put(equation: Equation) -> Equation:
        zero = equation.zero
        if equation is residual.closing:
            zero = pool.sub(zero, value)
        if equation is reading:
            zero = pool.substitute([zero], {sensor.symbol: read})[0]
        return equation._replace(zero=zero)

    part = system._replace(equations=tuple(put(e) for e in own))
    solved = state_equations(part, integral, Wanted(measured=True), Report())
    if solved is None:
        return f"its equations do not say what `{sensor.name}` reads"
    values: dict[Expr, Expr] = {}
    for block in solved.blocks:
        found = _solved(pool, block, size)
        if found is None:
            return f"`{block.names[0]}` is in an algebraic loop that has no closed form"
        values |= zip(found, pool.substitute(found.values(), values), strict=True)
    if read not in values:
        return f"its equations do not say what `{sensor.name}` reads"
    rates = [values[s.rate] for s in solved.states]
    predicted = values[read]
    if has([*rates, predicted], Op.DER, Op.INT):
        return f"to predict `{sensor.name}` another signal would have to be differentiated"
    if not counted.isdisjoint(symbols(*rates, predicted, sensor.symbol)):
        return "a sensor that counts has no exact position"
    if not solved.states:
        return "it holds no storage that could be integrated"
    if len(solved.states) > MOST:
        return f"it has {len(solved.states)} states, more than {MOST}"
    known = {step.variable for step in residual.steps}
    if any(s.symbol not in known for s in solved.states):
        return "one of its states is none of its variables"
    off = pool.symbol(_OFF, Kind.INPUT)
    entry = [sensitivity(pool, rate, [off])[off] for rate in rates]
    *rates, output = pool.substitute([*rates, predicted], {off: pool.zero})
    states = tuple(s.symbol for s in solved.states)
    made = Observer(
        sensor.name,
        sensor.symbol,
        states,
        tuple(rates),
        output,
        tuple(pool.substitute(entry, {off: pool.zero})),
        tuple(_at_rest(pool, residual, states)),
    )
    direct = sensitivity(pool, predicted, [off])[off]
    if direct is not pool.zero or not _through_all(pool, made):
        return f"`{sensor.name}` is moved before all storages are"
    return made


def _solved(
    pool: Pool, block: Block, size: Callable[[Expr], float]
) -> dict[Expr, Expr] | None:
    """The unknowns of a block in what was found before; None for a nonlinear loop."""
    if block.value is not None:
        return {block.unknowns[0]: block.value}
    lines = [
        LinearEquation(k, {x: s for x, s in zip(block.unknowns, slopes, strict=True)
                           if s is not pool.zero}, rest)
        for k, (slopes, rest) in enumerate(zip(block.slopes, block.rests, strict=False))
    ]  # fmt: skip
    found = solve_block(pool, lines, size) if lines else None
    return None if found is None else {one.variable: one.value for one in found.solved}


def _through_all(pool: Pool, observer: Observer) -> bool:
    """Whether c A^k b, with c = d output/d states, A = d rates/d states and b = `entry`, vanishes
    for k < n - 1 and not for k = n - 1."""
    rows = [list(sensitivity(pool, f, observer.states).values()) for f in observer.rates]
    c = list(sensitivity(pool, observer.output, observer.states).values())
    b: Sequence[Expr] = observer.entry
    for k in range(len(rows)):
        if is_zero(pool.dot(c, b)) != (k < len(rows) - 1):
            return False
        b = [pool.dot(row, b) for row in rows]
    return True


def _at_rest(pool: Pool, residual: Residual, states: Sequence[Expr]) -> list[Expr]:
    """What elimination says of the states while nothing changes; zero where that has no value."""
    closed = {step.variable: step.closed for step in residual.steps}
    found = [closed[state] for state in states]
    try:
        return rebuilt(pool, found, lambda n, _: pool.zero if n.op in (Op.DER, Op.INT) else None)
    except ZeroDivisionError:
        return [pool.zero] * len(states)
