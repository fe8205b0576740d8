"""How many relations a model has: its equations less the generic rank of its unknowns.

The equations are linearised at a random point of a prime field, with d/dt as multiplication by a
random number; every function gets a random slope. The rank of that matrix is the rank of the
unknowns for almost all parameters, so the number of relations is exact where a count of equations
and variables is misled by loops of the junction structure that cancel.
"""

from __future__ import annotations

from bondgraph.field.prime import P, PrimeField
from bondgraph.field.random_point import RandomPoint
from bondgraph.field.sparse import eliminate
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.expr import VARIABLES

_RATE = 0x3A5C_9E17_6B2D_4F81 % P  # what d/dt multiplies by: any number


def relations(system: EquationSystem) -> int:
    """The number of independent relations, those that hold identically included.

    It equals sensors minus the rank of the unknown inputs that they see where the model without
    sensors determines its variables. Time grows with the fill of the elimination: for checks.
    """
    point, numbers = RandomPoint(7), PrimeField(7)
    rows = []
    for equation in system.equations:
        row = point.gradient(equation.zero, lambda n: n.kind in VARIABLES, _RATE)
        rows.append({v.id: numbers.number(c) for v, c in row.items()})
    return len(rows) - len(eliminate(numbers, rows))
