"""The low orders of a large residual in numbers: how large they are, what they depend on."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypeAlias

from bondgraph.ir.expr import Expr
from bondgraph.ir.normal import Tape, Term
from bondgraph.passes.lowering.builder import Builder
from bondgraph.passes.lowering.visible import frequency

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

#: Coefficients by node of a tape (rows) and order (columns).
Orders: TypeAlias = "npt.NDArray[np.float64]"


def low_orders(
    builder: Builder, tape: Tape, unit: float, highest: int
) -> Orders | None:
    """The first `highest` coefficients times unit**-k, a row a node; None without numbers."""
    import numpy as np  # few models have so long a relation

    factors = _factors(builder, tape)
    if factors is None:
        return None
    table = np.zeros((tape.nodes, highest))
    table[0, 0] = 1.0
    rows = list(table)
    with np.errstate(all="ignore"):  # too large is infinite, and said to be
        for target, source, shift, scale in tape.edges:  # what is of higher order is left out
            if shift:
                factor = factors[scale] / unit**shift
                rows[target][shift:] += factor * rows[source][: highest - shift]
            elif (factor := factors[scale]) == 1.0:
                rows[target] += rows[source]
            else:
                rows[target] += factor * rows[source]
    return table


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

    def __init__(self, builder: Builder, tape: Tape, rate: float, low: Orders) -> None:
        self.builder = builder
        self.tape = tape
        self.unit = 1 / frequency(rate)
        self.low = low
        self._found: dict[tuple[Expr, int], dict[str, float]] = {}

    def __call__(self, term: Term, name: str) -> float | None:
        """theta * d coefficient / d theta of a term."""
        key = term.atom, term.order
        if key not in self._found:
            self._found[key] = self._effects(term)
        own = self._found[key].get(name, 0.0) * self.unit**term.order
        return None if math.isnan(own) else own

    def _effects(self, term: Term) -> dict[str, float]:
        """By parameter, for the coefficient times unit**-order."""
        import numpy as np

        builder, size = self.builder, term.order + 1
        factors = _factors(builder, self.tape)
        assert factors is not None  # or there were no terms to ask about
        rows = self.low[:, :size]
        leaf = next(f for f in self.tape.leaves if f.atom is term.atom)
        adjoint = np.zeros_like(rows)
        adjoint[leaf.node, term.order] = 1.0
        met = {leaf.node}
        slopes: dict[Expr, float] = {}
        for edge in reversed(self.tape.edges):
            if edge.target not in met:
                continue
            met.add(edge.source)
            gain = 1 / self.unit**edge.shift
            above, low = adjoint[edge.target, edge.shift :], size - edge.shift
            product = float(above @ rows[edge.source, :low])
            if product:
                slopes[edge.scale] = slopes.get(edge.scale, 0.0) + gain * product
            adjoint[edge.source, :low] += gain * factors[edge.scale] * above
        weights: dict[Expr, float] = {}
        scales = list(slopes)
        for scale, resolved in zip(scales, builder.resolve(scales), strict=True):
            weights[resolved] = weights.get(resolved, 0.0) + slopes[scale]
        return builder.nominal.sensitivities(weights) or {}
