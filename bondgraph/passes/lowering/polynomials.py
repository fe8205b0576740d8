"""The low orders of a large residual in numbers: how large they are, what they depend on."""

from __future__ import annotations

import math

from bondgraph.ir.expr import Expr
from bondgraph.ir.normal import Tape, Term
from bondgraph.passes.lowering.builder import Builder
from bondgraph.passes.lowering.visible import frequency


def low_orders(
    builder: Builder, tape: Tape, unit: float, highest: int
) -> dict[int, list[float]] | None:
    """The first `highest` coefficients times unit**-k, by node; None without numbers."""
    factors = _factors(builder, tape)
    if factors is None:
        return None
    rows: dict[int, list[float]] = {0: [1.0]}
    for edge in tape.edges:
        factor = factors[edge.scale] / unit**edge.shift
        source = rows[edge.source]
        target = rows.setdefault(edge.target, [])
        size = min(len(source) + edge.shift, highest)
        target += [0.0] * (size - len(target))
        place = slice(edge.shift, size)
        sums = zip(target[place], source, strict=False)  # what is of higher order is left out
        target[place] = [t + factor * s for t, s in sums]
    return rows


def _factors(builder: Builder, tape: Tape) -> dict[Expr, float] | None:
    scales = list(dict.fromkeys(e.scale for e in tape.edges))
    resolved = builder.resolve(scales)
    values = [x for r in resolved if (x := builder.nominal.value(r)) is not None]
    if len(values) < len(resolved):
        return None
    return dict(zip(scales, map(float, values), strict=True))


class Effects:
    """How much a low coefficient of a large residual depends on a parameter.

    One pass back over the tape gives the derivative by every factor on it; the derivatives of the
    factors by the parameters do the rest.
    """

    def __init__(self, builder: Builder, tape: Tape, rate: float, highest: int) -> None:
        self.builder = builder
        self.tape = tape
        self.unit = 1 / frequency(rate)
        self.highest = highest
        self._found: dict[tuple[Expr, int], dict[str, float]] = {}
        self._rows: dict[int, dict[int, list[float]]] = {}

    def __call__(self, term: Term, name: str) -> float | None:
        """theta * d coefficient / d theta of a term."""
        key = term.atom, term.order
        if key not in self._found:
            self._found[key] = self._effects(term)
        own = self._found[key].get(name, 0.0) * self.unit**term.order
        return None if math.isnan(own) else own

    def _effects(self, term: Term) -> dict[str, float]:
        """By parameter, for the coefficient times unit**-order."""
        builder, size = self.builder, term.order + 1
        factors = _factors(builder, self.tape)
        if size not in self._rows:
            self._rows[size] = low_orders(builder, self.tape, self.unit, size) or {}
        rows = self._rows[size]
        assert factors is not None
        leaf = next(f for f in self.tape.leaves if f.atom is term.atom)
        adjoint: dict[int, list[float]] = {leaf.node: [0.0] * term.order + [1.0]}
        slopes: dict[Expr, float] = {}
        for edge in reversed(self.tape.edges):
            above = adjoint.get(edge.target)
            if above is None:
                continue
            gain = 1 / self.unit**edge.shift
            source = rows[edge.source]
            product = sum(a * s for a, s in zip(above[edge.shift :], source, strict=False))
            if product:
                slopes[edge.scale] = slopes.get(edge.scale, 0.0) + gain * product
            factor = gain * factors[edge.scale]
            below = adjoint.setdefault(edge.source, [0.0] * size)
            for i, value in enumerate(above[edge.shift :]):
                below[i] += factor * value
        weights: dict[Expr, float] = {}
        scales = list(slopes)
        for scale, resolved in zip(scales, builder.resolve(scales), strict=True):
            weights[resolved] = weights.get(resolved, 0.0) + slopes[scale]
        return builder.nominal.sensitivities(weights) or {}
