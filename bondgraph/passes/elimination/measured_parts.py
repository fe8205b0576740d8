"""Put a sensor in place of what it measures, wherever that stands in another equation.

The limited output of a controller is logged, and is the voltage of a motor. To find the one from
the other what is limited would have to be known, which a limit that is reached does not tell.
"""

from __future__ import annotations

from bondgraph.algebra.affine import affine
from bondgraph.algebra.zero import is_zero
from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import Expr, Op, Pool, below, variables
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


def _measured(pool: Pool, reads: Expr, sensor: Expr) -> dict[Expr, Expr]:
    """What a sensor reads, and the function or choice of unknowns in it, with what it tells of it.

    A multiple of that beside a constant, as a pressure `p0*exp(...) - pa`; nothing if it is more.
    """
    inside = below([reads], stop=lambda n: n.op not in (Op.ADD, Op.MUL))
    functions = [n for n in inside if n.op in _WHOLE and variables(n)]
    parts = affine(pool, reads, functions[0]) if len(functions) == 1 else None
    if parts is None or variables(*parts) or not constant(parts[0]) or is_zero(parts[0]):
        return {}
    slope, rest = parts
    return {functions[0]: pool.div(pool.sub(sensor, rest), slope), reads: sensor}
