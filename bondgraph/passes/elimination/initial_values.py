"""Declared initial values that contradict each other: storages that share their state.

Two capacitors in parallel have one voltage, two inertias on one shaft one speed. With the declared
states and the nominal parameters put in, the equations at the start are linear in what they leave
open; what is not (laws, inputs, modes) is an unknown of its own. A sum of equations in which every
unknown cancels and a number is left over cannot hold.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TypeVar

from bondgraph.algebra.numeric import Number, evaluate, nominal
from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import Expr, Kind, Op, topological
from bondgraph.library.units import DOMAINS
from bondgraph.passes.causality.node_words import listing, name
from bondgraph.text.diagnostic import Label, Report

_LARGE = 1500  # equations beyond which nothing is tried
_TOLD = 3
_ROUNDING = Fraction(1, 10**9)  # of what adds up, where functions made it

#: What an equation leaves open, with its coefficients; None for the number.
_Row = dict[Expr | None, Fraction]
_K = TypeVar("_K")


def initial_values(system: EquationSystem, report: Report) -> None:
    """Warn (`initial-values-contradict`) of declared states that no machine begins with."""
    graph = system.graph
    numbers = nominal(graph)
    given: dict[Expr, Number] = {}
    for node in graph.nodes:
        for port in node.ports:
            if port.state is not None and port.initial is not None:
                value = evaluate(port.initial, numbers)
                if value is not None:
                    given[port.state] = value
    equations = [e for e in system.equations if e.kind in ("balance", "law")]
    if not given or len(equations) > _LARGE:
        return
    start = _Start(numbers, given)
    rows = [start.row(e.zero) for e in equations]
    told = 0
    for members in _impossible(rows):
        involved = [equations[k] for k in members if start.declared(equations[k].zero)]
        if involved and told < _TOLD:
            _tell(system, involved, start, report)
            told += 1


class _Start:
    """The equations at the first moment."""

    def __init__(self, numbers: Mapping[str, Number], given: Mapping[Expr, Number]) -> None:
        self.given = given
        self._values = {**numbers, **{s.symbol.name: v for s, v in given.items()}}
        self._rows: dict[Expr, _Row] = {}

    def declared(self, zero: Expr) -> list[Expr]:
        """The declared states that an equation holds."""
        return [n for n in topological([zero]) if n in self.given]

    def row(self, zero: Expr) -> _Row:
        """An expression as a sum over what is open."""
        for node in topological([zero]):
            if node not in self._rows:
                self._rows[node] = self._row(node)
        return self._rows[zero]

    def _row(self, node: Expr) -> _Row:
        if node.op is Op.ADD:
            total: _Row = {}
            for c, arg in node.terms:
                _add(total, self._rows[arg], Fraction(c))
            return total
        if node.order:
            return {node: Fraction(1)}
        if all(set(self._rows[a]) <= {None} for a in node.args):
            value = evaluate(node, self._values)
            if value is not None:
                return {None: Fraction(value)} if value else {}
        if node.op is Op.MUL:
            scaled = self._scaled(node)
            if scaled is not None:
                return scaled
        return {node: Fraction(1)}

    def _scaled(self, node: Expr) -> _Row | None:
        """A product of numbers with one thing that is open."""
        factor = Fraction(1)
        open_: Expr | None = None
        for arg, exponent in node.factors:
            row = self._rows[arg]
            if set(row) <= {None}:
                value = row.get(None, Fraction(0))
                if not value and exponent < 0:
                    return None
                factor *= value**exponent
            elif open_ is None and exponent == 1:
                open_ = arg
            else:
                return None
        found: _Row = {}
        if open_ is not None:
            _add(found, self._rows[open_], factor)
        return found


def _impossible(rows: list[_Row]) -> list[list[int]]:
    """Sets of equations of which a sum says that a number other than zero is zero."""
    done: dict[Expr, tuple[_Row, dict[int, Fraction]]] = {}
    found = []
    for k in sorted(range(len(rows)), key=lambda k: (len(rows[k]), k)):
        row, made = dict(rows[k]), {k: Fraction(1)}
        size = abs(row.get(None, Fraction(0)))
        while True:
            pivot = next((v for v in row if v in done), None)
            if pivot is None:
                break
            other, parts = done[pivot]
            factor = -row[pivot]
            size += abs(factor * other.get(None, Fraction(0)))
            _add(row, other, factor)
            _add(made, parts, factor)
        left = [v for v in row if v is not None]
        if left:
            pivot = min(left, key=lambda v: v.id)
            inverse = 1 / row[pivot]
            done[pivot] = (
                {v: c * inverse for v, c in row.items()},
                {e: c * inverse for e, c in made.items()},
            )
        elif abs(row.get(None, Fraction(0))) > _ROUNDING * size:
            found.append(sorted(made))
    return found


def _add(total: dict[_K, Fraction], row: Mapping[_K, Fraction], factor: Fraction) -> None:
    for key, c in row.items():
        left = total.get(key, Fraction(0)) + factor * c
        if left:
            total[key] = left
        else:
            total.pop(key, None)


def _tell(system: EquationSystem, laws: list[Equation], start: _Start, report: Report) -> None:
    nodes = system.graph.nodes
    members = list(dict.fromkeys(e.node for e in laws))
    begins = listing([_begins(system, law, start) for law in laws])
    why = "and the junctions between make one follow from the other"
    if len(members) == 1:
        why = "but what is around it gives it another value"
    report.warning(
        "initial-values-contradict",
        f"Initial values contradict the rest of the model: {begins}, {why}.",
        *[Label(nodes[n].origin, "begins with this") for n in members[:6]],
        help="No machine begins like that, and a simulation would begin with a jump. Leave all "
        "but one of these initial values out, make them agree, or put the R, C or I that lies "
        "between the storages into the model.",
    )


def _begins(system: EquationSystem, law: Equation, start: _Start) -> str:
    """`C:C1 begins with a voltage of 2 V`."""
    node = system.graph.nodes[law.node]
    domain = DOMAINS[node.domain or "any"]
    row = start.row(law.zero)
    open_ = [v for v in row if v is not None]
    if len(open_) != 1:
        return f"{name(node)} begins as declared"
    effort = open_[0].symbol.kind is Kind.EFFORT
    what = domain.effort_name if effort else domain.flow_name
    unit = domain.effort_unit if effort else domain.flow_unit
    value = float(-row.get(None, Fraction(0)) / row[open_[0]])
    article = "an" if what[0] in "aeiou" else "a"
    return f"{name(node)} begins with {article} {what} of {value:g} {unit}".rstrip()
