"""Colour equations and variables by their surroundings, so that ties do not depend on names.

Colour refinement (Weisfeiler and Lehman, 1968) on the graph of equations and variables: what has
different surroundings or other numbers gets a different colour, whatever the order or the names
in the file, and however the bonds are drawn.
"""

from __future__ import annotations

from bondgraph.algebra.nominal import Nominal
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.expr import CONSTANTS, Expr, Op, topological


def colours(system: EquationSystem, rounds: int | None = None) -> tuple[list[int], dict[Expr, int]]:
    """A rank for each equation and each variable, equal only where `rounds` steps look alike.

    By default six steps, two in a large system, where they would cost more than they tell.
    """
    if rounds is None:
        rounds = 6 if len(system.equations) < 2000 else 2
    nodes, nominal = system.graph.nodes, Nominal(system.graph)
    position = {v: i for i, v in enumerate(system.unknowns)}
    members = [[position[v] for v in e.variables] for e in system.equations]
    holders: list[list[int]] = [[] for _ in system.unknowns]
    for row, columns in enumerate(members):
        for column in columns:
            holders[column].append(row)
    equation = _ranks(
        [
            (
                e.kind == "sensor",
                e.kind,
                nodes[e.node].kind if e.node >= 0 else "",
                len(m),
                *_numbers(e.zero, nominal),
            )
            for e, m in zip(system.equations, members, strict=True)
        ]
    )
    variable = _ranks(
        [(v.symbol.kind.value, len(h)) for v, h in zip(position, holders, strict=True)]
    )
    classes = 0
    for _ in range(rounds):
        equation = _ranks(
            [
                (own, *sorted(variable[c] for c in m))
                for own, m in zip(equation, members, strict=True)
            ]
        )
        variable = _ranks(
            [
                (own, *sorted(equation[r] for r in h))
                for own, h in zip(variable, holders, strict=True)
            ]
        )
        found = max(equation, default=0) + max(variable, default=0)
        if found == classes:
            break
        classes = found
    return equation, {v: variable[i] for v, i in position.items()}


def _numbers(zero: Expr, nominal: Nominal) -> list[float]:
    """The sizes of the numbers in an equation; their signs depend on how bonds are drawn."""
    sizes = []
    for node in topological([zero]):
        if node.kind in CONSTANTS:
            sizes.append(abs(nominal.value(node) or 0.0))
        elif node.op is Op.ADD:
            sizes += [abs(float(c)) for c in node.coefficients]
    return sorted(sizes)


def _ranks(keys: list[tuple[object, ...]]) -> list[int]:
    order = {key: rank for rank, key in enumerate(sorted(set(keys)))}
    return [order[key] for key in keys]
