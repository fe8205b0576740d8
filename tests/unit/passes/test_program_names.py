"""What values are called in code and comments."""

from __future__ import annotations

import pytest

from bondgraph.ir.expr import ZERO_START, Expr, Kind, Pool
from bondgraph.passes.lowering.program_names import Names, brief, identifier, short, spoken

p = Pool()
R, L, N, k = (p.symbol(name, Kind.PARAM) for name in ("R", "m[2].L", "N", "k"))
x, on = p.symbol("x", Kind.SENSOR), p.symbol("on", Kind.MODE)
zero = p.symbol(ZERO_START, Kind.INITIAL)


def plus(*terms: Expr) -> Expr:
    return p.add(*[(1, term) for term in terms])


@pytest.mark.parametrize(
    ("value", "name"),
    [
        (L, "L"),
        (p.symbol("a.b[3]", Kind.PARAM), "b"),
        (p.fn("tanh", x), "tanh_x"),
        (p.fn("table:pump.csv", x), "table_x"),
        (p.scale(3, R), "scaled_R"),
        (p.neg(p.mul(R, L)), "scaled_R_times_L"),
        (p.mul(R, L), "R_times_L"),
        (p.mul(R, L, N), "R_times_L_times_N"),
        (p.mul(R, L, N, k), "product"),
        (p.div(R, L), "R_over_L"),
        (p.power(R, -1), "one_over_R"),
        (p.mul(R, p.power(L, -1), p.power(N, -1)), "R_over_L_over_N"),
        (p.mul(R, p.fn("tanh", x)), "product"),  # of what is no name there is none
        (p.mul(p.fn("tanh", x), R), "product"),
        (plus(R, L), "R_plus_L"),
        (p.sub(R, L), "R_minus_L"),
        (p.add((-1, R), (2, L)), "L_minus_R"),
        (p.add((-1, R), (-2, L)), "sum"),
        (plus(R, L, N), "R_plus_L_plus_N"),
        (plus(R, L, N, k), "sum"),
        (plus(R, p.fn("tanh", x)), "sum"),
        (p.choose(on, R, L), "choice"),
        (p.integral(x, zero), "integral"),
        (p.compare("<", x, R), "holds"),
        (p.der(x), "value"),
        (p.num(3), "value"),
    ],
)
def test_what_a_person_would_call_a_value(value: Expr, name: str) -> None:
    assert spoken(value) == name


def test_formulas_are_whole_or_none() -> None:
    total = plus(R, p.mul(N, k))
    assert brief(total) == "R + N*k"
    assert brief(total, len("R + N*k")) == "R + N*k"
    assert brief(total, len("R + N*k") - 1) == "a sum"
    long = p.mul(*[p.symbol(f"parameter{i}", Kind.PARAM) for i in range(30)])
    assert brief(long) == "a product"


def test_signals_with_their_derivatives() -> None:
    law = p.fn("tanh", x)
    assert [short(x, order) for order in range(-2, 5)] == [
        "Int(Int(x))", "Int(x)", "x", "x'", "x''", "x'''", "D(x, 4)",
    ]  # fmt: skip
    assert short(law) == "tanh(x)" and short(law, -1) == "Int(tanh(x))"
    assert short(law, 1).startswith("D(tanh(x)") and short(law, 2) == "D(tanh(x), 2)"


def test_names_that_are_taken_get_numbers() -> None:
    names = Names()
    assert [names.new(wish) for wish in ("g", "g", "g_2", "g", "g_2", "h")] == [
        "g", "g_2", "g_2_2", "g_3", "g_2_3", "h",
    ]  # fmt: skip
    assert identifier("m[1].wh") == "m__1__wh" and identifier("2x") == "_2x"
    assert identifier("") == "_" and identifier("a-b") == "au2db"
