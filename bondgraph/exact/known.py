"""Laws at a point that is known: their values, and their partial derivatives."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from bondgraph.exact.adjoints import pull
from bondgraph.exact.evaluate import values_of
from bondgraph.exact.outline import plan
from bondgraph.exact.plant_equations import Setting, constant
from bondgraph.exact.signal_algebra import Mixed, Taylor
from bondgraph.field import series
from bondgraph.field.numbers import Number
from bondgraph.field.series import Series
from bondgraph.ir.expr import Expr, Op


class KnownSample:
    """Variables as series, for laws; missing coefficients count as zero."""

    def __init__(
        self,
        place: Mapping[Expr, tuple[int, int]],
        setting: Setting,
        variables: Mapping[int, Series] | list[Series],
    ) -> None:
        self.algebra = Taylor(setting.numbers)
        self._place = place
        self._values = setting.values
        self._variables = variables

    def value(self, symbol: Expr) -> Series:
        """The series of a constant or a variable."""
        where = self._place.get(symbol)
        if where is None:
            return constant(self._values, symbol)
        known = self._variables[where[0]]
        return known if where[1] == 1 else series.scale(where[1], known)

    def start(self, initial: Any) -> int:
        """Laws have their integrals as variables."""
        raise Mixed("an integral in a law")


def gradient(
    rest: Expr, sample: KnownSample, place: Mapping[Expr, tuple[int, int]]
) -> dict[tuple[int, int], Number]:
    """The partial derivatives of an expression at the point by (variable, derivative)."""
    nodes, need = plan(rest, 1)
    values, failures = values_of(nodes, need, sample)
    if rest in failures:
        raise failures[rest]
    adjoints: dict[Expr, Any] = {rest: [1]}
    pull(nodes, need, values, sample.algebra, adjoints)
    out: dict[tuple[int, int], Number] = {}
    numbers = sample.algebra.numbers
    for node, adjoint in adjoints.items():
        if node.op is Op.SYM and node in place:
            variable, s = place[node]
            factorial = 1
            for order, x in enumerate(adjoint):
                factorial *= max(order, 1)
                if x:
                    key = (variable, order)
                    out[key] = out.get(key, 0) + s * x * numbers.inverse(factorial)
    return out
