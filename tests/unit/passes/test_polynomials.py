"""Coefficients of a tape in numbers, against polynomials that are multiplied out here."""

from __future__ import annotations

from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import pytest

from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.ir.normal import Edge, Leaf, Tape, Term
from bondgraph.passes.lowering.polynomials import Effects, low_orders
from bondgraph.passes.lowering.visible import frequency

_VALUES = {"a": Fraction(3), "b": Fraction(-1, 2), "c": Fraction(2)}
_POOL = Pool()
_A, _B, _C = (_POOL.symbol(name, Kind.PARAM) for name in _VALUES)
_Y = _POOL.symbol("y", Kind.SENSOR)
#: A node is fed twice, one edge has the factor 1, and node 3 is reached over two ways.
_EDGES = (
    Edge(1, 0, 1, _A), Edge(1, 0, 0, _POOL.one), Edge(2, 1, 2, _B), Edge(2, 0, 0, _C),
    Edge(3, 1, 0, _POOL.one), Edge(3, 2, 1, _A),
)  # fmt: skip
_TAPE = Tape(_EDGES, (Leaf(_Y, 3, 4, True),), 4)


def _builder(values: dict[str, Fraction]) -> Any:
    """Which knows the numbers of parameters, and what of a sum depends on each, in its share."""

    def value(expr: Expr) -> Fraction | None:
        return expr.number if expr is _POOL.one else values.get(expr.symbol.name)

    def shares(weights: dict[Expr, float]) -> dict[str, float]:
        own = {e: w for e, w in weights.items() if e is not _POOL.one}
        return {e.symbol.name: w * float(values[e.symbol.name]) for e, w in own.items()}

    nominal = SimpleNamespace(value=value, sensitivities=shares)
    return SimpleNamespace(resolve=list, nominal=nominal)


def _multiplied(values: dict[str, Fraction]) -> list[list[Fraction]]:
    """The polynomials of the nodes, each coefficient exact."""
    numbers = {_A: values["a"], _B: values["b"], _C: values["c"], _POOL.one: Fraction(1)}
    found = [[Fraction(1)] + [Fraction(0)] * 9, *[[Fraction(0)] * 10 for _ in range(3)]]
    for target, source, shift, scale in _EDGES:
        for k in range(10 - shift):
            found[target][k + shift] += numbers[scale] * found[source][k]
    return found


@pytest.mark.parametrize("highest", [1, 2, 3, 5, 8])
@pytest.mark.parametrize("unit", [1.0, 0.25])
def test_low_orders_are_those_of_the_polynomials_in_a_unit_of_time(
    unit: float, highest: int
) -> None:
    found = low_orders(_builder(_VALUES), _TAPE, unit, highest)
    assert found is not None and found.shape == (4, highest)
    for node, polynomial in enumerate(_multiplied(_VALUES)):
        expected = [float(polynomial[k]) * unit**-k for k in range(highest)]
        assert found[node].tolist() == pytest.approx(expected)


def test_without_all_numbers_there_are_no_orders() -> None:
    known = {name: x for name, x in _VALUES.items() if name != "b"}
    assert low_orders(_builder(known), _TAPE, 1.0, 3) is None


@pytest.mark.parametrize("order", range(5))
def test_effects_are_the_derivatives_of_coefficients_by_parameters(order: int) -> None:
    """theta d c/d theta: every coefficient is a polynomial, so that exact differences tell it."""
    rate = 50.0
    builder = _builder(_VALUES)
    low = low_orders(builder, _TAPE, 1.0 / frequency(rate), 6)
    assert low is not None
    effects = Effects(builder, _TAPE, rate, low)
    term = Term(_Y, order, _POOL.one, True)
    for name, x in _VALUES.items():
        # of second degree at most: the central difference is the derivative
        above, below = (
            _multiplied(_VALUES | {name: x + d})[3][order] for d in (Fraction(1), Fraction(-1))
        )
        expected = float(x * (above - below) / 2)
        assert effects(term, name) == pytest.approx(expected, abs=1e-9), name
    assert effects(term, "d") == 0.0
