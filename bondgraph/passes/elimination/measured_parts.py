"""Put a sensor in place of what it measures, wherever that stands in another equation.

The limited output of a controller is logged, and is the voltage of a motor. To find the one from
the other what is limited would have to be known, which a limit that is reached does not tell.
"""

from __future__ import annotations

from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import Expr, Op, below, variables

_WHOLE = (Op.FN, Op.IF)  # what sums and products are made of, elimination takes apart and back


def with_sensors(system: EquationSystem) -> EquationSystem:
    """The same equations with sensors for the functions and choices of unknowns that they measure.

    The equation of the sensor itself says what it measures as before, so that nothing is lost.
    """
    pool = system.graph.pool
    measured: dict[Expr, Expr] = {}
    for sensor in system.graph.sensors:
        part = pool.substitute([sensor.reads], system.shared)[0]
        if sensor.same_as is None and part.op in _WHOLE and variables(part):
            measured.setdefault(part, sensor.symbol)

    def told(equation: Equation) -> Equation:
        own = {p: s for p, s in measured.items() if s.symbol.name != equation.name}
        if own.keys().isdisjoint(below([equation.zero])):
            return equation
        (zero,) = pool.substitute([equation.zero], own)
        if equation.rate is None or equation.state is None:
            return equation._replace(zero=zero, variables=tuple(variables(zero)))
        (rate,) = pool.substitute([equation.rate], own)
        others = [v for v in variables(zero) if v is not equation.state]
        return equation._replace(zero=zero, rate=rate, variables=(equation.state, *others))

    return system._replace(equations=tuple(map(told, system.equations))) if measured else system
