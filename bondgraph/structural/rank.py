"""How many relations a model has: its equations less the generic rank of its unknowns.

The equations are linearised at a random point of a prime field, with d/dt as multiplication by a
random number; every function gets a random slope. The rank of that matrix is the rank of the
unknowns for almost all parameters, so the number of relations is exact where a count of equations
and variables is misled by loops of the junction structure that cancel.
"""

from __future__ import annotations

import random

from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.expr import VARIABLES, Expr, Kind, Op, topological

#: The order of the field.
P = (1 << 61) - 1

#: The derivative of something by each variable.
Row = dict[Expr, int]


def relations(system: EquationSystem) -> int:
    """The number of independent relations, those that hold identically included.

    It equals sensors minus the rank of the unknown inputs that they see where the model without
    sensors determines its variables. Time grows with the fill of the elimination: for checks.
    """
    point = Point()
    rows = [point.gradient(e.zero) for e in system.equations]
    return len(rows) - _rank(rows)


class Point:
    """A random point at which equations are linearised, in the variables of some kinds."""

    def __init__(self, kinds: frozenset[Kind] = VARIABLES) -> None:
        self.kinds = kinds
        self.draw = random.Random(7)
        self.values: dict[Expr, int] = {}
        self.s = self.draw.randrange(2, P)

    def gradient(self, zero: Expr) -> Row:
        """The derivative of an expression by each of its variables."""
        rows: dict[Expr, Row] = {}
        for node in topological([zero]):
            rows[node] = self._node(node, rows)
        return {v: c for v, c in rows[zero].items() if c}

    def _node(self, node: Expr, rows: dict[Expr, Row]) -> Row:
        value = self._value(node)
        if node.op is Op.SYM:
            return {node: 1} if node.symbol.kind in self.kinds else {}
        if node.op is Op.ADD:
            slopes = [c.numerator * pow(c.denominator, -1, P) for c in node.coefficients]
        elif node.op is Op.MUL:
            slopes = [
                e * value * pow(self.values[a], -1, P)
                for a, e in node.factors
            ]
        elif node.op is Op.DER:
            slopes = [self.s]
        elif node.op is Op.INT:
            slopes = [pow(self.s, -1, P)]
        else:
            slopes = [self.draw.randrange(1, P) for _ in node.args]
        total: Row = {}
        for slope, arg in zip(slopes, node.args, strict=True):
            for variable, c in rows[arg].items():
                total[variable] = (total.get(variable, 0) + slope * c) % P
        return total

    def _value(self, node: Expr) -> int:
        """The value at the point; what is no sum, product or number is drawn."""
        if node not in self.values:
            args = [self.values[a] for a in node.args]
            if node.op is Op.NUM:
                found = node.number.numerator * pow(node.number.denominator, -1, P)
            elif node.op is Op.ADD:
                terms = zip(node.coefficients, args, strict=True)
                found = sum(c.numerator * pow(c.denominator, -1, P) * x for c, x in terms)
            elif node.op is Op.MUL:
                found = 1
                for x, e in zip(args, node.exponents, strict=True):
                    found = found * pow(x, e, P) % P
            else:
                found = self.draw.randrange(1, P)
            self.values[node] = found % P or self.draw.randrange(1, P)
        return self.values[node]


def _rank(rows: list[Row]) -> int:
    """Rank by elimination, shortest row first, each pivot in its rarest column."""
    rows = [r for r in rows if r]
    holders: dict[Expr, set[int]] = {}
    for k, row in enumerate(rows):
        for variable in row:
            holders.setdefault(variable, set()).add(k)
    alive = set(range(len(rows)))
    rank = 0
    while alive:
        k = min(alive, key=lambda i: (len(rows[i]), i))
        alive.discard(k)
        row = rows[k]
        for variable in row:
            holders[variable].discard(k)
        if not row:
            continue
        rank += 1
        pivot = min(row, key=lambda v: (len(holders[v]), v.id))
        inverse = pow(row[pivot], -1, P)
        for other in sorted(holders[pivot]):
            factor = rows[other][pivot] * inverse % P
            for variable, c in row.items():
                left = (rows[other].get(variable, 0) - factor * c) % P
                if left:
                    rows[other][variable] = left
                    holders[variable].add(other)
                else:
                    rows[other].pop(variable, None)
                    holders[variable].discard(other)
    return rank
