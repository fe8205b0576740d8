"""Parity rows of a motor and of a switched circuit against relations written down by hand."""

from __future__ import annotations

import pytest

from bondgraph.exact.parity import parity
from bondgraph.exact.plant import Plant
from bondgraph.field.numbers import Number
from bondgraph.field.prime import PrimeField, inverse
from bondgraph.field.series import Series, add, derivative, mul, scale
from tests.unit.exact.models import MOTOR, graph, symbols

_N = 12  # coefficients, more than any row has


def _rate(a: Series) -> Series:
    return derivative(a)


def _dense(rows: list[dict[int, Number]], height: int) -> list[list[Number]]:
    """The entries of a fault: a list for each row that is free of unknowns."""
    return [[column.get(at, 0) for column in rows] for at in range(height)]


@pytest.mark.parametrize("times", [2, 3, 5])
@pytest.mark.parametrize("number", [1, 2])
def test_every_row_of_a_motor_is_a_sum_of_its_relation_and_derivatives(
    times: int, number: int
) -> None:
    """dU + op(dw) = i dRe + (L i' with another L)' ...: of r = U - Re i - (L i)' - k w with
    i = (b w + (J w)')/k, along changes of what is told of U and w and of Re, L, J."""
    plant = Plant(graph(MOTOR))
    s = symbols(plant.graph)
    roots, faults = [s["U"], s["w"]], ["U", "w", "Re", "L", "J"]
    numbers, found = parity(plant, faults, roots, times, number)
    assert isinstance(numbers, PrimeField)
    part = plant.structure.part_for(roots)
    t = plant.trajectory(number, times + 2, part=part, roots=roots)
    L, Re, k, J, b = (t.value(s[n])[0] for n in ("L", "Re", "k", "J", "b"))
    w = t.value(s["w"])
    over = inverse(k)
    i = scale(over, add(scale(b, w), scale(J, _rate(w))))

    def coil(current: Series) -> Series:
        return add(scale(Re, current), scale(L, _rate(current)))

    def moved(fault: str, change: Series) -> Series:
        """What the relation is off by, to the first order."""
        if fault == "U":
            return change
        if fault == "w":  # the speed is less than what is read
            current = scale(over, add(scale(b, change), scale(J, _rate(change))))
            return add(coil(current), scale(k, change))
        if fault == "Re":
            return scale(-1, mul(i, change, _N))
        if fault == "L":
            return scale(-1, _rate(mul(i, change, _N)))
        return scale(-over, coil(_rate(mul(w, change, _N))))

    height = max(at for rows in found.values() for row in rows for at in row) + 1
    weights = _dense(found["U"], height)
    assert height == times - 1  # the relation needs w'', and so many derivatives of it are left
    for fault in faults[1:]:
        for row, weight in zip(_dense(found[fault], height), weights, strict=True):
            for j, x in enumerate(row):
                unit = [numbers.number(int(m == j)) for m in range(_N)]
                off = moved(fault, unit)
                assert x == sum(c * off[m] for m, c in enumerate(weight)), (fault, j)
        assert any(any(row) for row in _dense(found[fault], height))


def test_what_a_relation_does_not_rest_on_has_no_column() -> None:
    """Two loops without anything in common: a resistance of the other one is nowhere."""
    plant = Plant(
        graph("""
model A { param R = 2; param S = 3
    1:a { <- Se:u; -> R:ra = R; -> Df:i }
    1:b { <- Se:v; -> R:rb = S; -> Df:j }
}""")
    )
    s = symbols(plant.graph)
    _, found = parity(plant, ["R", "S", "i", "j"], [s["u"], s["i"]], 1, 1)
    assert {fault: len(rows) for fault, rows in found.items()} == {"R": 2, "S": 0, "i": 2, "j": 0}


@pytest.mark.parametrize("on", [0, 1])
def test_a_switched_junction_carries_nothing_while_it_is_off(on: int) -> None:
    """On, u = R i: all three show in one row for each derivative. Off, i = 0: the meter alone."""
    plant = Plant(
        graph("""
model A { param R = 2
    input on : bool
    1:sw when on { <- Se:u; -> R:R = R; -> Df:i }
}""")
    )
    s = symbols(plant.graph)
    modes = {s["on"]: on}
    numbers, found = parity(plant, ["R", "i", "u"], [s["u"], s["i"]], 2, 1, modes)
    sizes = {fault: len(rows) for fault, rows in found.items()}
    assert sizes == ({"R": 3, "i": 3, "u": 3} if on else {"R": 0, "i": 3, "u": 0})
    if on:
        for by_i, by_u in zip(found["i"], found["u"], strict=True):  # u + 2 di = i dR
            assert by_i == {at: 2 * x for at, x in by_u.items()}
            assert all(numbers.nonzero(x) for x in by_i.values())


def test_a_reading_that_a_law_uses_errs_for_the_law_and_for_the_relation() -> None:
    """With y and i as told, e is less by dy and the current by di, of which the law takes 3 y as
    it is told: di = 2 dy. The loop u = 2 i + e says du + 2 di + dy = 0
    besides, where u is larger by du."""
    plant = Plant(
        graph("""
model A { param a = 3
    1:s { <- Se:u; -> R:r = 2; -> 0:n; -> Df:i }
    n { -> De:y; -> R:load { f = a*y + 2*e } }
}""")
    )
    s = symbols(plant.graph)
    faults = ["u", "y", "i"]
    numbers, found = parity(plant, faults, [s["u"], s["i"], s["y"]], 0, 1)
    assert all(len(found[fault]) == 1 for fault in faults)
    (u0, y0, i0), (u1, y1, i1) = _dense([row for f in faults for row in found[f]], 2)
    y, i = y0 * u1 - y1 * u0, i0 * u1 - i1 * u0  # what is left where u cancels
    assert numbers.nonzero(i) and y == -2 * i
    u, y = u0 * i1 - u1 * i0, y0 * i1 - y1 * i0
    assert u * 5 == y  # with di = 2 dy in du + 2 di + dy = 0
