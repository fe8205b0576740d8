"""Signals that the structure keeps at zero, and the nonlinear laws that rest there."""

from __future__ import annotations

from random import Random
from typing import Any

import pytest

from bondgraph.compilation import Compilation
from bondgraph.exact.assembly import Assembly
from bondgraph.exact.forms import ORDERS
from bondgraph.exact.plant_equations import Equation, Setting
from bondgraph.exact.point import STRIDE, Point
from bondgraph.exact.rest import settled
from bondgraph.field.prime import PrimeField
from bondgraph.field.sparse import CONSTANT, Row
from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.text.source import Source

_TWO_RATIOS = """bg 1
model M {{
  param m = 1.2; param n = 1.03; param k = 0.8; input u
  0:a {{ -> De:y; -> R:x {{ {law} }}
        -> TF:t1 {{ f1 = m*f2 }} -> b; -> TF:t2 {{ f1 = n*f2 }} -> b }}
  0:b {{ <- Sf:u; -> R:z = 2 }}
}}
"""


def _signature(text: str) -> dict[str, list[str]]:
    compilation = Compilation(Source("rest.bg", text))
    matrix = compilation.signatures
    assert compilation.verification.method.startswith("exact")
    return {
        name: [f for f, row in zip(matrix.faults, matrix.rows, strict=True) if row[at]]
        for at, name in enumerate(matrix.residuals)
    }


@pytest.mark.parametrize(
    "law",
    [
        "e = tanh(k*f) + f",
        "f = exp(k*e) - 1 + e",
        "e = k*f*abs(f)",
        "f = k*ssqrt(e)",
        "e = k*f + f^3",
        "0 = e - k*f - sinh(f)",
        "e = k*sign(f) + f",
    ],
)
def test_no_effort_between_two_ratios(law: str) -> None:
    # e_b = m e_a = n e_a leaves e_a = 0 for m != n: no parameter can be seen, only the sensor
    assert _signature(_TWO_RATIOS.format(law=law)) == {"r1": ["y"]}


def test_two_laws_that_rest_together() -> None:
    # No source: e1 = e2, f1 + f2 = 0 and both laws rise, so that only rest is left.
    text = """bg 1
model M { param a = 1; param b = 2
  0:j { -> R:x { f = exp(a*e) - 1 }; -> R:z { e = tanh(b*f) + f }; -> De:y } }
"""
    assert _signature(text) == {"r1": ["y"]}


def test_a_law_behind_a_loop_of_bonds() -> None:
    # The flow around the loop is open; the balance of the three junctions together is not.
    text = """bg 1
model M { param k = 3; param r = 2; input u
  0:a { <- Sf:u; -> De:y; -> b; -> c }
  0:b { -> R:x { f = k*ssqrt(e) }; -> c }
  0:c { -> R:r } }
"""
    assert _signature(text) == {"r1": ["k", "r", "u", "y"]}


_F = PrimeField(1)
_POOL = Pool()
_SYMBOLS = [_POOL.symbol(n, Kind.EFFORT) for n in "uvwxyz"]
_U, _V, _W, _X, _Y, _Z = _SYMBOLS
_PLACE = {s: (at, 1) for at, s in enumerate(_SYMBOLS)}
_v, _w, _x, _y, _z = (at * ORDERS for at in range(1, 6))


def _settled(
    equations: list[Equation], linear: tuple[Row, ...] = (), still: bool = False
) -> list[Equation]:
    """The equations at a point of which these rows are zero."""
    every: dict[str, Any] = dict.fromkeys(Assembly._fields, ())
    plant = Assembly(**{**every, "count_of": 6, "place": _PLACE, "pool": _POOL})
    setting = Setting({}, _F, 2, still=still)
    point = Point(_PLACE, setting, Random(1))
    for row in linear:
        point.add({c: _F.number(x) for c, x in row.items()})
    return settled(plant, equations, setting, point)


def _sinh(of: Expr, **form: int) -> Equation:
    """sinh of something and a sum of variables."""
    keys = {_PLACE[s][0] * ORDERS: s.symbol.name for s in _SYMBOLS}
    told = {key: [_F.number(form[name])] for key, name in keys.items() if name in form}
    return Equation(7, told, _POOL.fn("sinh", of))


def _zero(*keys: int) -> list[tuple[int, dict[int, list[int]], None]]:
    return [(7, {key: [1]}, None) for key in keys]


def test_as_many_laws_as_signals_leave_nothing_but_rest() -> None:
    """z + sinh y and sinh y say that both are zero; one law about both leaves them free."""
    one, two = _sinh(_Y, z=1), _sinh(_Y)
    found = _settled([one, two])
    assert sorted(map(tuple, found), key=str) == sorted(_zero(_y, _z), key=str)
    assert _settled([one]) == [one]


def test_signals_that_are_multiples_of_each_other_count_once() -> None:
    """w = 2 y: one law about both leaves both at rest, and not while they are apart."""
    law = _sinh(_Y, w=3)
    tied: Row = {2 * STRIDE: 1, 4 * STRIDE: -2}
    assert [e.rest for e in _settled([law], (tied,))] == [None]
    assert _settled([law]) == [law]


def test_a_law_too_many_for_its_signals_says_nothing_more() -> None:
    found = _settled([_sinh(_Y), _sinh(_POOL.scale(2, _Y))])
    assert sorted(len(e.form) for e in found) == [0, 1]
    assert all(e.rest is None for e in found)


def test_what_does_not_hold_at_rest_or_cannot_rest_is_left_as_it_is() -> None:
    """sinh y + 1, cosh y and sinh y where y is 5 already."""
    offset = Equation(7, {CONSTANT: [_F.number(1)]}, _POOL.fn("sinh", _Y))
    other = Equation(7, {}, _POOL.fn("cosh", _Y))
    nowhere = Equation(7, {}, _POOL.fn("sinh", _POOL.power(_Y, -1)))
    for law in (offset, other, nowhere):
        assert _settled([law]) == [law]
    known: Row = {4 * STRIDE: 1, CONSTANT: -5}
    assert _settled([_sinh(_Y)], (known,)) == [_sinh(_Y)]


def test_a_signal_that_is_zero_already_makes_a_law_linear() -> None:
    """With y = 0: x + 3 z + sinh y + y z is x + 3 z."""
    law = Equation(
        7, {_x: [_F.number(1)]},
        _POOL.add((3, _Z), (1, _POOL.fn("sinh", _Y)), (1, _POOL.mul(_Y, _Z))),
    )  # fmt: skip
    (found,) = _settled([law], ({4 * STRIDE: 1},))
    assert found == Equation(7, {_x: [1], _z: [3]}, None)
    (left,) = _settled([_sinh(_POOL.mul(_Y, _Z), x=1)], ({4 * STRIDE: 1},))
    assert left == Equation(7, {_x: [1]}, None)


def test_only_a_still_plant_satisfies_a_product_by_a_factor_at_rest() -> None:
    """v cosh w + x w with x = 4 v: both are put to zero together, where v alone leaves x w."""
    held = Equation(3, {_z: [_F.number(1)], CONSTANT: [_F.number(2)]}, None)
    tied: Row = {1 * STRIDE: 4, 3 * STRIDE: -1}
    rest = _POOL.add((1, _POOL.mul(_V, _POOL.fn("cosh", _W))), (1, _POOL.mul(_X, _W)))
    product = Equation(7, {}, rest)
    assert _settled([held, product], (tied,)) == [held, product]
    found = _settled([held, product], (tied,), still=True)
    assert found[0] is held and found[1] == Equation(7, {_v: [1]}, None)
    assert _settled([held, product], still=True) == [held, product]
    beside = product._replace(form={_z: [_F.number(1)], CONSTANT: [_F.number(1)]})
    assert _settled([held, beside], (tied,), still=True) == [held, beside]
