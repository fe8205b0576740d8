"""What configure computes and is given, and the known signals as a program has them."""

from __future__ import annotations

import math
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import pytest

from bondgraph.algebra.interpreter import Interpreter
from bondgraph.compilation import Compilation
from bondgraph.ir.expr import ZERO_START, Expr, Kind
from bondgraph.ir.program import Assign, Choice, Const, Mode, Ref
from bondgraph.passes.lowering.builder import Builder
from bondgraph.text.source import Source

_TEXT = """bg 1
model M {
    param L = 2 H
    param R = 3
    const T = L/R
    const half = T/2
    param free : Ohm
    input on : bool
    1:el { <- Se:U; -> I:L; -> R:R { e = R*f + free*f + R*delay(i, 0.5) }; -> Df:i }
    1:s when on { <- Se:V; -> I:M(p0 = 2*half) = 4; -> R:Q = 5 }
    sensor a : rad = int(s.f) counts 100/turn
    sensor v = s.f
}
"""


@pytest.fixture
def made() -> Builder:
    return Builder(Compilation(Source("m.bg", _TEXT)).graph)


def _symbol(made: Builder, name: str) -> Expr:
    graph = made.graph
    known = {v.name: v.symbol for v in graph.values} | {i.name: i.symbol for i in graph.inputs}
    return {**known, **{s.name: s.symbol for s in graph.sensors}}[name]


def test_one_coefficient_for_each_constant_and_none_for_a_number(made: Builder) -> None:
    p, R, L = made.pool, _symbol(made, "R"), _symbol(made, "L")
    first = made.coef(p.mul(R, L), "product", "R L")
    assert first == Ref("coef", "product") == made.coef(p.mul(L, R), "other", "again")
    assert made.coef(R, "product", "R") == Ref("coef", "product_2")
    assert made.coef(p.num(Fraction(1, 4)), "quarter", "") == Const(0.25)
    assert [(f.name, f.doc) for f in made.fields] == [("product", "R L"), ("product_2", "R")]
    assert made.used == [p.mul(R, L), R]


def test_what_configure_is_given(made: Builder) -> None:
    p = made.pool
    pace = made.pace
    assert made.leaf(pace) == Ref("local", "pace") and made.pace is pace
    assert made.leaf(made.option("bandwidth")) == Ref("option", "bandwidth")
    assert made.leaf(made.element("table", 3)) == Ref("coef", "table", 3)
    assert made.leaf(_symbol(made, "R")) == Ref("param", "R")
    assert made.leaf(p.symbol("m[1].R", Kind.PARAM)) == Ref("param", "m__1__R")
    assert made.leaf(p.symbol(ZERO_START, Kind.INITIAL)) == Const(0.0)
    assert made.leaf(p.mul(pace, pace)) is None


def test_constants_are_what_they_are_made_of_unless_they_are_kept(made: Builder) -> None:
    p, R, L, T = made.pool, *(_symbol(made, n) for n in ("R", "L", "T"))
    half = _symbol(made, "half")
    assert made.resolve([half, R]) == [p.scale(Fraction(1, 2), p.div(L, R)), R]
    assert made.resolve([half], keep={T}) == [p.scale(Fraction(1, 2), T)]
    begun = next(port.initial for n in made.graph.nodes if n.path == "M" for port in n.ports)
    assert begun is not None and made.resolve([begun]) == [p.div(L, R)]
    assert set(made.parameters([half, made.option("bandwidth")])) == {L, R}


def test_statements_stand_behind_what_they_rest_on(made: Builder) -> None:
    """w = bandwidth time_unit, T = L/R and both in a third; run with numbers."""
    p, T, R = made.pool, _symbol(made, "T"), _symbol(made, "R")
    made.coef(p.mul(T, made.pace), "both", "")
    made.coef(p.add((1, T), (1, R)), "sum", "")
    made.coef(p.power(made.pace, 2), "square", "")
    statements = made.configure()
    assert isinstance(statements[0], Assign) and statements[0].target == Ref("local", "pace")
    machine = Interpreter(SimpleNamespace(tables=(), roots=()))  # type: ignore[arg-type]
    given = {"L": 2.0, "R": 3.0}
    machine.values |= {Ref("param", name): x for name, x in given.items()}
    machine.values |= {Ref("option", "bandwidth"): 10.0, Ref("option", "time_unit"): 0.5}
    machine.run(statements)
    found = {ref.name: x for ref, x in machine.values.items() if ref.space == "coef"}
    assert found == pytest.approx({"both": 10.0 / 3.0, "sum": 2.0 / 3.0 + 3.0, "square": 25.0})


def test_parameters_in_the_order_of_the_model_with_what_it_gives_them(made: Builder) -> None:
    p, free = made.pool, _symbol(made, "free")
    start = p.symbol("M.p0", Kind.INITIAL)
    roots = [p.mul(free, _symbol(made, "half")), start, made.zero_start, made.option("bandwidth")]
    fields = made.param_fields(roots)
    assert [(f.name, f.default) for f in fields if f.name in ("L", "R", "free")] == [
        ("L", 2.0), ("R", 3.0), ("free", None),
    ]  # fmt: skip
    assert {f.name: f.unit for f in fields}["L"] == "H"
    assert all(f.name not in ("T", "half", "bandwidth") for f in fields)
    other = made.param_fields([p.symbol("x.q0", Kind.INITIAL)])
    assert [(f.name, f.path, f.doc) for f in other] == [
        ("x__q0", "x.q0", "initial value, to be given")
    ]


def test_known_signals_with_the_orders_that_are_needed(made: Builder) -> None:
    U, v, a, on = (_symbol(made, n) for n in ("U", "v", "a", "on"))
    assert made.need(v, 1) == Ref("known", "v", 1)
    made.need(v, -2), made.need(v, 0), made.need(U, 2)
    made.starts["v"] = None
    made.sampled["U"] = None
    found = {k.name: k for k in made.known_fields([v, a, made.pool.mul(U, on)])}
    assert list(found) == ["on", "U", "a", "v"]  # inputs come first
    told: Any = {
        name: (k.kind, k.highest, k.integral, k.lowest, k.start, k.sampled, k.counts)
        for name, k in found.items()
    }
    assert told == {
        "U": ("input", 2, False, 0, False, True, None),
        "on": ("mode", 0, False, 0, False, True, None),
        "a": ("sensor", 0, False, 0, False, False, 100.0),
        "v": ("sensor", 1, True, -2, True, False, None),
    }
    assert made.mode(on) == Choice(Mode("on"), Const(1.0), Const(0.0))


def test_a_past_value_is_one_of_the_signal_that_is_sampled() -> None:
    program = Compilation(Source("m.bg", _TEXT)).program
    (delayed,) = program.delayed
    assert (delayed.of, delayed.seconds, delayed.known.name) == ("i", 0.5, "i_0__5_s_ago")
    assert [k.sampled for k in program.knowns if k.name == "i"] == [True]


def test_an_encoder_has_a_scale_and_where_it_began(made: Builder) -> None:
    signal = made.signals[_symbol(made, "a")]
    assert signal.scale is not None and signal.offset is not None
    turn = made.nominal.value(made.resolve([signal.scale])[0])
    assert turn == pytest.approx(2.0 * math.pi / 100.0)
    assert made.signals[_symbol(made, "v")].scale is None
