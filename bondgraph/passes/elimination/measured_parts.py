"""Put a sensor in place of what it measures, wherever that stands in another equation.

The limited output of a controller is logged, and is the voltage of a motor. To find the one from
the other what is limited would have to be known, which a limit that is reached does not tell. And
an accelerometer tells what acts on a mass without its speed, which it tells by an integral only.
"""

from __future__ import annotations

from collections.abc import Container

from bondgraph.algebra.affine import affine
from bondgraph.algebra.zero import is_zero
from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import Expr, Kind, Op, Pool, below, variables
from bondgraph.ir.nodes import constant

_WHOLE = (Op.FN, Op.IF)  # what sums and products are made of, elimination takes apart and back


def with_sensors(system: EquationSystem) -> EquationSystem:
    """The same equations with sensors for the functions and choices of unknowns that they measure.

    The equation of the sensor itself says what it measures as before, so that nothing is lost.
    """
    pool = system.graph.pool
    measured: dict[Expr, tuple[str, Expr]] = {}
    for sensor in system.graph.sensors:
        if sensor.same_as is None:
            reads = pool.substitute([sensor.reads], system.shared)[0]
            for part, value in _measured(pool, reads, sensor.symbol).items():
                measured.setdefault(part, (sensor.name, value))

    def told(equation: Equation) -> Equation:
        own = {part: value for part, (name, value) in measured.items() if name != equation.name}
        if own.keys().isdisjoint(below([equation.zero])):
            return equation
        (zero,) = pool.substitute([equation.zero], own)
        if equation.rate is None or equation.state is None:
            return equation._replace(zero=zero, variables=tuple(variables(zero)))
        (rate,) = pool.substitute([equation.rate], own)
        others = [v for v in variables(zero) if v is not equation.state]
        return equation._replace(zero=zero, rate=rate, variables=(equation.state, *others))

    return system._replace(equations=tuple(map(told, system.equations))) if measured else system


def with_rates(system: EquationSystem) -> EquationSystem:
    """The same equations with sensors of derivatives in the balances of storages.

    Of p = m v and e = p', with a sensor of v', this is e = m v': what a storage takes is known
    before what it holds is. The law and the sensor still say what that is.
    """
    pool = system.graph.pool
    rates: dict[Expr, Expr] = {}
    for sensor in system.graph.sensors:
        if sensor.same_as is None:
            reads = pool.substitute([sensor.reads], system.shared)[0]
            for node, value in _measured(pool, reads, sensor.symbol, (Op.DER,)).items():
                if node.op is Op.DER and node.order == 1 and node.args[0] in system.unknowns:
                    rates.setdefault(node.args[0], value)
    two = [e for e in system.equations if e.kind == "law" and len(e.variables) == 2 and rates]
    laws = {v: e for e in two for v in e.variables if v.kind is Kind.STATE}

    def told(equation: Equation) -> Equation:
        state, law = equation.state, laws.get(equation.state or pool.zero)
        if state is None or law is None or equation.rate is None:
            return equation
        (other,) = [v for v in law.variables if v is not state]
        own = affine(pool, law.zero, state) if other in rates else None
        beside = None if own is None else affine(pool, own[1], other)
        if own is None or beside is None or is_zero(own[0]):
            return equation
        if not all(map(constant, (own[0], *beside))):
            return equation
        change = pool.neg(pool.div(pool.mul(beside[0], rates[other]), own[0]))
        zero = pool.sub(change, equation.rate)
        inside = tuple(variables(zero))
        return equation._replace(zero=zero, variables=inside, state=None, rate=None, initial=None)

    equations = tuple(map(told, system.equations)) if laws else system.equations
    same = all(new is old for new, old in zip(equations, system.equations, strict=True))
    return system if same else system._replace(equations=equations)


def _measured(
    pool: Pool, reads: Expr, sensor: Expr, kinds: Container[Op] = _WHOLE
) -> dict[Expr, Expr]:
    """What a sensor reads, and the one part of some `kinds` in it, with what it tells of that.

    A multiple of that beside a constant, as a pressure `p0*exp(...) - pa`; nothing if it is more.
    """
    inside = below([reads], stop=lambda n: n.op not in (Op.ADD, Op.MUL))
    parts = [n for n in inside if n.op in kinds and variables(n)]
    found = affine(pool, reads, parts[0]) if len(parts) == 1 else None
    if found is None or variables(*found) or not constant(found[0]) or is_zero(found[0]):
        return {}
    slope, rest = found
    return {parts[0]: pool.div(pool.sub(sensor, rest), slope), reads: sensor}
