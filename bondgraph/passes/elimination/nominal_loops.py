"""Loops without delay that have no unique solution at the very numbers that the model gives.

A loop of gain g is solved by dividing by 1 - g. Where that vanishes for all parameters the
structure is singular and elimination says so; where it vanishes at the nominal values only, the
relations hold, but the machine they are used on is the one they do not determine. The Jacobian of
the algebraic equations is compared at the nominal values and at random ones, in a prime field:
decimals are exact there, so that a gain of exactly 1 is told from one that is close to it.
"""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import TypeVar

from bondgraph.field.prime import ONE, PrimeField
from bondgraph.field.random_point import RandomPoint
from bondgraph.field.sparse import Row, eliminate
from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import Expr, Kind, symbols
from bondgraph.notation.line import show
from bondgraph.passes.causality.node_words import listing, name
from bondgraph.text.diagnostic import Label, Report

_LARGE = 1500  # equations in loops beyond which nothing is tried
_TOLD = 3

_Row = dict[Expr, int]
K = TypeVar("K")


def nominal_loops(system: EquationSystem, report: Report) -> None:
    """Warn (`loop-gain-one`) of each loop that is singular at the nominal values alone."""
    equations, computed = _in_loops(system)
    if not 0 < len(equations) <= _LARGE:
        return
    given = {v.symbol: v.value for v in system.graph.values if v.value is not None}
    generic = _circuits(_gradients(equations, computed))
    basis = [k for k, circuit in enumerate(generic) if circuit is None]
    if not any(s in given for k in basis for s in symbols(equations[k].zero)):
        return
    found = _circuits(_gradients([equations[k] for k in basis], computed, given))
    singular = [[basis[k] for k in circuit] for circuit in found if circuit is not None]
    for members in singular[:_TOLD]:
        loop = [equations[k] for k in members]
        _tell(system, loop, _decisive(loop, given, computed), given, report)


def _in_loops(system: EquationSystem) -> tuple[list[Equation], set[Expr]]:
    """The equations that remain when what can be computed one by one is taken away, and that.

    That is each unknown of an equation without another, and each that no other equation has.
    """
    computed: set[Expr] = set()
    equations = [e for e in system.equations if e.kind in ("balance", "law")]
    rows = [set(row) for row in _gradients(equations, ())]
    holders: dict[Expr, set[int]] = {}
    for k, row in enumerate(rows):
        for variable in row:
            holders.setdefault(variable, set()).add(k)
    alive = set(range(len(rows)))
    work = [*range(len(rows))]
    lonely = [v for v, at in holders.items() if len(at) == 1]
    while work or lonely:
        if work:
            k = work.pop()
            if k not in alive or len(rows[k]) > 1:
                continue
            taken = next(iter(rows[k]), None)
        else:
            taken = lonely.pop()
            if len(holders.get(taken, ())) != 1:
                continue
            (k,) = holders[taken]
        alive.discard(k)
        for variable in rows[k]:
            holders[variable].discard(k)
            if len(holders[variable]) == 1:
                lonely.append(variable)
        if taken is not None:
            computed.add(taken)
            for other in holders.pop(taken, set()):
                rows[other].discard(taken)
                work.append(other)
    return [equations[k] for k in sorted(alive)], computed


def _gradients(
    equations: list[Equation], computed: Container[Expr], given: Mapping[Expr, Expr] | None = None
) -> list[_Row]:
    """The derivatives of equations by their efforts and flows; what is `computed` is no unknown."""
    point = RandomPoint(1, given)
    sides = (Kind.EFFORT, Kind.FLOW)
    return [
        point.gradient(e.zero, lambda n: n.kind in sides and n not in computed) for e in equations
    ]


def _circuits(rows: list[_Row]) -> list[list[int] | None]:
    """For each row None if it is independent of the others so marked, else those it is a sum of.

    Such a set loses its dependence with any one of its members. Elimination takes the shortest row
    first, each pivot in its rarest column (Markowitz 1957).
    """
    numbers = PrimeField(1)
    marked: list[Row] = []  # each row has a mark of its own: what is left of one is what it is of
    for k, row in enumerate(rows):
        marked.append({v.id: numbers.number(c) for v, c in row.items()} | {-2 - k: ONE})
    left: dict[int, Row] = {}
    eliminate(numbers, marked, left)
    return [sorted(-2 - c for c in left[k]) if k in left else None for k in range(len(rows))]


# ------------------------------------------------------------------ what is told


def _decisive(
    equations: list[Equation], given: dict[Expr, Expr], computed: set[Expr]
) -> list[Expr]:
    """The parameters of which each alone could take the loop off its gain."""
    found = []
    for symbol in symbols(*[e.zero for e in equations]):
        if symbol in given:
            others = {s: v for s, v in given.items() if s is not symbol}
            if all(c is None for c in _circuits(_gradients(equations, computed, others))):
                found.append(symbol)
    return found


def _tell(
    system: EquationSystem,
    equations: list[Equation],
    decisive: list[Expr],
    given: dict[Expr, Expr],
    report: Report,
) -> None:
    nodes = system.graph.nodes
    members = sorted({e.node for e in equations if e.node >= 0})
    elements = [n for n in members if nodes[n].kind not in ("0", "1")]
    members = elements if len(elements) > 1 else members
    spoken = listing([name(nodes[n]) for n in members])
    numbers = [f"{s.symbol.name} = {show(given[s])}" for s in decisive]
    why = f"{listing(numbers)} cancel in it. " if len(numbers) > 1 else ""
    if len(numbers) == 1:
        why = f"{numbers[0]} makes it so. "
    report.warning(
        "loop-gain-one",
        f"At the nominal values the loop of {spoken} has the gain 1: its equations have no unique "
        "solution.",
        *[Label(nodes[n].origin, "in the loop") for n in members[:6]],
        help=f"{why}The relations hold for all other values; at these the machine itself is "
        "undetermined, and what they can tell may differ. Correct the numbers, or put the C or I "
        "into the model that the loop has in the machine.",
    )
