"""Parameters that are declared to be zero, and the sign of those with which an R dissipates."""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction

from bondgraph.algebra.numeric import Number, declared_zero, evaluate, nominal
from bondgraph.ir.expr import Expr, symbols
from bondgraph.ir.graph import BondGraph, Port

_AT = tuple(side * Fraction(10) ** n for side in (-1, 1) for n in (-3, 0, 3, 6))  # either variable


def dissipating_signs(graph: BondGraph) -> dict[str, int]:
    """The sign, 1 or -1, of parameters that are zero and make an R dissipate with that sign only.

    The R does nothing while the parameter is zero, as a leak that is not there yet: e f is zero
    then, nowhere negative with the one sign and nowhere positive with the other. A law that reads
    signals tells nothing, nor does one that gives neither effort nor flow by the other.
    """
    numbers = nominal(graph)
    declared = declared_zero(graph, numbers)
    zero = {v.symbol: v.name for v in graph.values if v.name in declared}
    found: dict[str, set[int]] = {}
    for node in graph.nodes:
        if node.kind == "R" and len(node.ports) == len(node.laws) == 1:
            law, port = node.laws[0].zero, node.ports[0]
            for symbol in set(symbols(law)) & zero.keys():
                found.setdefault(zero[symbol], set()).add(_sign(law, port, numbers, symbol))
    return {name: min(own) for name, own in found.items() if len(own) == 1 and 0 not in own}


def _sign(law: Expr, port: Port, numbers: Mapping[str, Number], parameter: Expr) -> int:
    """The sign of a parameter with which the law of an R dissipates; 0 where it may have both."""
    for solved, given in ((port.effort, port.flow), (port.flow, port.effort)):
        signs = []
        for value in (1, 0, -1):
            known = {**numbers, parameter.symbol.name: value}
            powers = [_power(law, solved, given, at, known) for at in _AT]
            signs.append({None if p is None else (p > 0) - (p < 0) for p in powers})
        more, none, less = signs
        for sign, right, wrong in ((1, more, less), (-1, less, more)):
            if none == {0} and right - {0} == {1} and wrong - {0} == {-1}:
                return sign
    return 0


def _power(
    law: Expr, solved: Expr, given: Expr, at: Fraction, known: Mapping[str, Number]
) -> float | None:
    """e f where the `given` one of both has a value and a law gives the other one, alone."""
    here = {**known, given.symbol.name: at}
    left = [evaluate(law, {**here, solved.symbol.name: y}) for y in (0, 1, 2)]
    start, one, two = (math.nan if x is None else float(x) for x in left)
    step = one - start
    alone = step != 0.0 and abs(two - one - step) <= 1e-9 * abs(step)  # no NaN is
    return float(at) * -start / step if alone else None
