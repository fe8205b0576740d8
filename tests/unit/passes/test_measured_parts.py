"""Sensors in place of what they measure: of functions, of choices and of rates."""

from __future__ import annotations

from fractions import Fraction

import pytest

from bondgraph.algebra.zero import is_zero
from bondgraph.compilation import Compilation
from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import Expr, Kind, Op, Pool, below, variables
from bondgraph.passes.elimination.measured_parts import _measured, with_rates, with_sensors
from bondgraph.text.source import Source

p = Pool()
x, y = p.symbol("x", Kind.FLOW), p.symbol("y", Kind.EFFORT)
a, b = p.symbol("a", Kind.PARAM), p.symbol("b", Kind.PARAM)
s, on = p.symbol("s", Kind.SENSOR), p.symbol("on", Kind.MODE)
law = p.fn("tanh", p.mul(a, x))


def plus(*terms: Expr) -> Expr:
    return p.add(*[(1, term) for term in terms])


@pytest.mark.parametrize(
    ("reads", "part", "told"),
    [
        (law, law, s),
        # 3 a tanh(a x) + b = s
        (p.add((3, p.mul(a, law)), (1, b)), law, p.div(p.sub(s, b), p.scale(3, a))),
        (p.sub(b, law), law, p.sub(b, s)),
        (p.choose(on, x, y), p.choose(on, x, y), s),
        # nothing that is whole, more than one such part, or beside something unknown
        (x, None, s),
        (plus(law, p.fn("sin", y)), None, s),
        (plus(law, x), None, s),
        (p.mul(x, law), None, s),
        (p.mul(on, law), None, s),  # a mode may take it away
        (plus(p.fn("sin", a), x), None, s),  # of constants alone
        (p.power(law, 2), None, s),
        (p.mul(p.sub(plus(a, b), plus(b, a)), law), None, s),
    ],
)
def test_what_a_sensor_tells_of_the_one_part_that_it_reads(
    reads: Expr, part: Expr | None, told: Expr
) -> None:
    found = _measured(p, reads, s)
    if part is None:
        assert found == {}
        return
    assert found[reads] is s and is_zero(p.sub(found[part], told))
    assert set(found) == {part, reads}


def test_rates_are_parts_where_they_are_asked_for() -> None:
    rate = p.der(x)
    assert _measured(p, p.scale(2, rate), s) == {}
    found = _measured(p, p.scale(2, rate), s, (Op.DER,))
    assert found[rate] is p.scale(Fraction(1, 2), s)
    assert _measured(p, law, s, (Op.DER,)) == {}


def _system(text: str) -> EquationSystem:
    return Compilation(Source("m.bg", f"bg 1\nmodel M {{\n{text}\n}}\n")).equations


def _named(system: EquationSystem, kind: str, name: str) -> Equation:
    (found,) = [e for e in system.equations if (e.kind, e.name) == (kind, name)]
    return found


_VALVE = """param k = 2; param C = 3
0:t { <- Sf:Q; -> C:C; -> R:v { f = k*ssqrt(e) }; -> De:h }
"""


def test_a_measured_law_is_known_in_every_other_equation() -> None:
    before = _system(_VALVE + "sensor m = 4*k*ssqrt(t.e) + 1")
    after = with_sensors(before)
    pool = before.graph.pool
    sensor = next(x.symbol for x in before.graph.sensors if x.name == "m")
    was, own = _named(before, "law", "v"), _named(after, "law", "v")
    assert not any(n.kind is Kind.SENSOR for n in below([was.zero]))
    # f = k ssqrt(e) and m = 4 k ssqrt(e) + 1 give f = (m - 1)/4
    flow = before.graph.nodes[was.node].ports[0].flow
    assert own.variables == (flow,) == tuple(variables(own.zero))
    by_hand = pool.sub(flow, pool.scale(Fraction(1, 4), pool.sub(sensor, pool.one)))
    assert is_zero(pool.sub(own.zero, by_hand)) or is_zero(pool.add((1, own.zero), (1, by_hand)))
    for old, new in zip(before.equations, after.equations, strict=True):
        if old.name != "v":
            assert old is new  # also that of the sensor itself
    plain = _system(_VALVE)
    assert with_sensors(plain) is plain


def test_of_a_storage_the_rate_is_told_and_its_state_stays_first() -> None:
    before = _system("""param k = 2
1:a { <- Se:F; -> I:m = 3; -> R:r { e = k*tanh(f) }; -> Df:w }
let power = k*tanh(a.f)
let work = int(k*tanh(a.f) + a.f)
sensor p = k*tanh(a.f)
sensor q = work""")
    after = with_sensors(before)
    (own,) = [e for e in after.equations if e.kind == "integral"]
    (old,) = [e for e in before.equations if e.kind == "integral"]
    sensor = next(x.symbol for x in before.graph.sensors if x.name == "p")
    assert own.rate is not None and sensor in below([own.rate]) and own.state is old.state
    assert own.variables[0] is own.state and len(own.variables) == len(set(own.variables)) == 2
    assert old.rate is not None and sensor not in below([old.rate])


_MASS = "param m = 3\n1:a {{ <- Se:F; -> I:m; -> R:r = 2; -> Df:w }}\nsensor acc = {}"


@pytest.mark.parametrize(
    ("reads", "scale"), [("der(a.f)", 1), ("2*der(a.f)", 2), ("-der(a.f)", -1)]
)
def test_an_accelerometer_tells_what_a_mass_takes(reads: str, scale: int) -> None:
    """p = m v and p' = e: with s = c v' the effort is m s/c."""
    before = _system(_MASS.format(reads))
    after = with_rates(before)
    pool = before.graph.pool
    (own,) = [e for e in after.equations if e.name == "m" and e.kind == "state"]
    old = _named(before, "state", "m")
    sensor = next(x.symbol for x in before.graph.sensors if x.name == "acc")
    inertia = next(v.symbol for v in before.graph.values if v.name == "m")
    assert old.rate is not None and own.state is own.rate is own.initial is None
    by_hand = pool.sub(pool.scale(Fraction(1, scale), pool.mul(inertia, sensor)), old.rate)
    assert is_zero(pool.sub(own.zero, by_hand)) or is_zero(pool.add((1, own.zero), (1, by_hand)))
    assert own.variables == tuple(variables(own.zero))
    for one, other in zip(before.equations, after.equations, strict=True):
        assert one is other or one is old


@pytest.mark.parametrize("reads", ["der(der(a.f))", "der(a.f) + a.f", "a.f", "a.f*der(a.f)"])
def test_what_is_no_rate_of_a_variable_tells_no_balance(reads: str) -> None:
    before = _system(_MASS.format(reads))
    assert with_rates(before) is before


def test_a_law_that_is_not_linear_keeps_its_state() -> None:
    before = _system("""param m = 3
1:a { <- Se:F; -> I:m { f = p/m + p^3 }; -> R:r = 2; -> Df:w }
sensor acc = der(a.f)""")
    assert with_rates(before) is before
