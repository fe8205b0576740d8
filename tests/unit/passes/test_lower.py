"""The residual program: what exact computes, what step leaves out, what it costs."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
import sympy

from bondgraph.ir.expr import ZERO_START, Kind
from bondgraph.ir.program import (
    Assign,
    Const,
    Dot,
    Function,
    PolynomialTape,
    Product,
    Program,
    Ref,
    Sum,
)
from bondgraph.passes.lowering.filter import settle
from bondgraph.passes.lowering.lower import LowerOptions
from tests.sampled import Sampled
from tests.unit.passes.lowering_models import Bench, cable, drive, operations

T = sympy.Symbol("t")


def exact_cost(program: Program, residual: str) -> int:
    (found,) = [s for s in program.exact if s.target.name == residual]
    assert isinstance(found, Assign)
    return operations(found.value)


def test_operations_of_the_robot() -> None:
    bench = Bench()
    program = bench.program(*drive(bench))
    assert exact_cost(program, "r1") == 16
    bench = Bench()
    assert exact_cost(bench.program(cable(bench, 1)), "r1") == 9


def test_exact_drive_against_sympy() -> None:
    bench = Bench()
    program = bench.program(*drive(bench))
    v = {f.name: sympy.Rational(str(f.default)) for f in program.params}
    we, ws = 40 + 30 * sympy.sin(7 * T), sympy.Rational(3, 2) + sympy.sin(7 * T + 1)
    fx, u0 = sympy.Rational(6, 100) * sympy.cos(T), 3 + sympy.sin(6 * T)
    load = v["Js"] * ws.diff(T) + v["fs"] * ws + v["R"] * fx
    torque = v["Je"] * we.diff(T) + v["fe"] * we + load / v["N"]
    r1 = v["k"] * we - u0 + v["Re"] / v["k"] * torque + v["L"] / v["k"] * torque.diff(T)
    twist = sympy.Rational(1, 100) + sympy.integrate(we - v["N"] * ws, (T, 0, T))
    play = v["A"] * v["K"] * v["tau0"] * sympy.tanh(twist / (4 * v["tau0"]))
    r2 = load - v["N"] * (play + v["K"] * twist)
    at = {T: sympy.Rational(1, 3)}
    known: dict[str, dict[int, float]] = {}
    for name, signal in {"We": we, "Ws": ws, "Fx": fx, "U0": u0}.items():
        orders = {k: float(signal.diff(T, k).subs(at)) for k in range(3)}
        known[name] = {-1: float(sympy.integrate(signal, (T, 0, T)).subs(at)), **orders}
    found = Sampled(program).exact(known)
    assert found["r1"] == pytest.approx(float(r1.subs(at)), rel=1e-11)
    assert found["r2"] == pytest.approx(float(r2.subs(at)), rel=1e-11)
    extent = {k.name: (k.lowest, k.highest) for k in program.knowns}
    assert extent == {"U0": (0, 0), "Fx": (0, 1), "We": (-1, 2), "Ws": (-1, 2)}
    assert [(r.order, r.stages, r.approximate) for r in program.residuals] == [
        (2, 3, ""),
        (1, 2, ""),
    ]


def test_what_is_added_is_written_before_what_is_subtracted() -> None:
    bench = Bench()
    x, y = bench.sensor("x"), bench.sensor("y")
    difference = bench.pool.add((-2, x), (1, y))
    (r1, r2) = bench.program(difference, bench.pool.fn("sin", difference)).exact
    x_term = Product((Const(2.0), Ref("known", "x")))
    expected = Sum(((True, Ref("known", "y")), (False, x_term)))
    assert isinstance(r1, Assign) and r1.value == expected
    assert isinstance(r2, Assign) and r2.value == Function("sin", (expected,))


def test_exact_nonlinear_derivatives_against_sympy() -> None:
    bench = Bench()
    p = bench.pool
    x, y, u = bench.sensor("x"), bench.sensor("y"), bench.input("u")
    a = bench.param("a", "1.7")
    choice = p.choose(p.compare("<", x, y), p.fn("tanh", p.mul(a, x)), p.fn("exp", y))
    expr = p.add(
        (1, p.der(p.der(p.mul(x, p.fn("atan2", y, u))))),
        (3, p.der(p.fn("ssqrt", p.sub(x, p.scale(5, y))))),
        (1, p.der(choice)),
        (2, p.mul(p.fn("pow", y, a), p.der(u), p.der(p.fn("log", y)))),
    )
    program = bench.program(expr)
    signals = {"x": sympy.sin(T) / 2, "y": 2 + sympy.cos(3 * T), "u": 1 + T**2}
    sx, sy, su = signals.values()
    aa = sympy.Rational("1.7")
    reference = (
        (sx * sympy.atan2(sy, su)).diff(T, 2)
        - 3 * sympy.sqrt(5 * sy - sx).diff(T)
        + sympy.tanh(aa * sx).diff(T)
        + 2 * sy**aa * su.diff(T) * sympy.log(sy).diff(T)
    )
    at = {T: 0.4}
    known = {n: {k: float(s.diff(T, k).subs(at)) for k in range(4)} for n, s in signals.items()}
    found = Sampled(program).exact(known)["r1"]
    assert found == pytest.approx(float(reference.subs(at)), rel=1e-11)
    assert program.residuals[0].approximate.startswith("a nonlinear term holds a derivative")


def test_exact_rational_arithmetic() -> None:
    bench = Bench()
    program = bench.program(cable(bench, 1))
    params = {"R": Fraction(16, 5), "L": Fraction(1, 4), "C": Fraction(3, 7)}
    run = Sampled(
        program,
        params,
        real=Fraction,
        functions={"exp": lambda x: Fraction(1)},
        sample_time=Fraction(1, 10),
        bandwidth=Fraction(1),
    )
    known = {"Uin": {0: Fraction(5)}, "Us": {k: Fraction(1, k + 2) for k in range(5)}}
    r, ind, c = params.values()
    us = [Fraction(1, k + 2) for k in range(5)]
    expected = (
        5
        - us[0]
        - Fraction(3, 2) * r * c * us[1]
        - (Fraction(3, 2) * ind * c + r * r * c * c / 4) * us[2]
        - r * ind * c * c / 2 * us[3]
        - ind * ind * c * c / 4 * us[4]
    )
    assert run.exact(known)["r1"] == expected


def test_long_cable_in_exact_arithmetic() -> None:
    cells = 40
    bench = Bench()
    program = bench.program(cable(bench, cells))
    (tape,) = [s for s in program.configure if isinstance(s, PolynomialTape)]
    (dot,) = program.exact
    assert isinstance(dot, Dot)
    assert tape.rows <= 8
    assert program.residuals[0].order == 2 * cells + 2
    params = {"R": Fraction(2), "L": Fraction(1, 3), "C": Fraction(1, 5)}
    run = Sampled(
        program,
        params,
        real=Fraction,
        functions={"exp": lambda x: Fraction(1)},
        sample_time=Fraction(1, 10),
        bandwidth=Fraction(1),
        time_unit=Fraction(1, 7),
    )
    # Us = exp(x t), Uin = 0: each cell is a chain matrix [[1 + zy, z(2 + zy)], [y, 1 + zy]]
    x = Fraction(3, 2)
    z, y = (params["R"] + params["L"] * x) / 2, params["C"] * x
    voltage, current = Fraction(1), y
    for _ in range(cells):
        voltage += z * current
        current += y * voltage
        voltage += z * current
    known = {
        "Uin": {0: Fraction(0)},
        "Us": {k: (x / 7) ** k for k in range(2 * cells + 3)},
    }
    assert run.exact(known)["r1"] == -voltage


def test_long_cable_in_double_precision() -> None:
    bench = Bench()
    program = bench.program(cable(bench, 300))
    run = Sampled(program)
    row = [v for ref, v in run.values.items() if ref[:2] == ("coef", "r1_Us")]
    assert len(row) == 603
    assert row[0] == -1.0
    assert max(map(abs, row)) <= 4.0  # the time unit keeps them near the first one
    assert all(c <= 0 for c in row)
    info = program.residuals[0]
    assert info.stages == 1
    assert info.invisible == ("R", "L", "C")
    assert len(program.dropped) == 602


def test_what_is_visible_depends_on_the_rate() -> None:
    kept = {}
    for rate in (1e3, 1e7, 1e9):
        bench = Bench()
        program = bench.program(cable(bench, 1), options=LowerOptions(rate=rate))
        info = program.residuals[0]
        kept[rate] = info.stages, info.invisible
    assert kept[1e3] == (1, ("R", "L", "C"))
    assert kept[1e7] == (3, ())
    assert kept[1e9] == (5, ())


@pytest.mark.parametrize("rate", [1e3, 1e6, 4e6, 1e7, 1e9])
def test_tape_and_written_form_agree(rate: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is visible, what a fault does and what comes out: the same by both ways."""
    programs = []
    for limit in (10**6, 10):
        monkeypatch.setattr("bondgraph.passes.lowering.lower.LIMIT", limit)
        bench = Bench()
        programs.append(bench.program(cable(bench, 2), options=LowerOptions(rate=rate)))
    written, taped = programs
    assert not any(isinstance(s, PolynomialTape) for s in written.configure)
    assert any(isinstance(s, PolynomialTape) for s in taped.configure)
    one, other = written.residuals[0], taped.residuals[0]
    assert (one.stages, one.invisible) == (other.stages, other.invisible)
    assert {d.order for d in written.dropped} == {d.order for d in taped.dropped}
    runs = [Sampled(p) for p in programs]
    for i in range(30):
        samples = {"Uin": math.sin(0.3 * i), "Us": math.cos(0.2 * i)}
        a, b = (run.step(samples).residuals["r1"] for run in runs)
        assert a == pytest.approx(b, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("limit", [10**6, 10])
def test_time_itself_is_given_in_the_time_unit(limit: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("bondgraph.passes.lowering.lower.LIMIT", limit)
    bench = Bench()
    pool = bench.pool
    seconds = pool.integral(pool.one, pool.symbol(ZERO_START, Kind.INITIAL))
    r1 = pool.add((1, cable(bench, 2)), (1, pool.fn("sin", seconds)))
    program = bench.program(r1)
    assert (program.time_unit == 1.0) == (limit > 10)
    known = {k.name: {n: 0.0 for n in range(-2, 9)} for k in program.knowns}
    found = Sampled(program).exact(known, time=0.5 / program.time_unit)
    assert found["r1"] == pytest.approx(math.sin(0.5))


@pytest.mark.parametrize("number", [Fraction(-1, 3), Fraction(2, 3), Fraction(-5), Fraction(1)])
def test_a_number_that_no_double_is_stays_a_quotient(number: Fraction) -> None:
    bench = Bench()
    x = bench.sensor("x")
    program = bench.program(bench.pool.fn("max", x, bench.pool.num(number)))
    found = Sampled(program).exact({"x": {0: Fraction(-9)}})
    assert found["r1"] == pytest.approx(float(number), rel=1e-15)


def test_a_small_term_is_kept_where_it_is_all_there_is() -> None:
    # friction 1e-6 beside inertia 1: nothing at 100 Hz, everything at constant speed
    bench = Bench()
    p = bench.pool
    w, torque = bench.sensor("w"), bench.input("T")
    f, j = bench.param("f", "1e-6"), bench.param("J", "1")
    program = bench.program(p.add((1, p.mul(j, p.der(w))), (1, p.mul(f, w)), (-1, torque)))
    assert program.dropped == ()
    assert program.residuals[0].invisible == ()


def test_a_leak_that_is_nominally_zero_is_kept() -> None:
    # a tank whose other terms could do without p: without its leak the filter takes p' alone
    bench = Bench()
    pool = bench.pool
    p, flow = bench.sensor("p"), bench.input("Q")
    area, leak = bench.param("A", "1"), bench.param("leak", "0")
    balance = pool.add((1, flow), (-1, pool.mul(leak, p)), (-1, pool.mul(area, pool.der(p))))
    program = bench.program(balance)
    assert program.dropped == ()
    assert program.residuals[0].invisible == ()
    # of what is too small beside it, neither the leak nor a constant that is zero makes more
    pool = (bench := Bench()).pool
    p, flow = bench.sensor("p"), bench.input("Q")
    area, leak = bench.param("A", "1"), bench.param("leak", "0")
    inertia, none = bench.param("I", "1e-20"), bench.param("z", "0", fault=False)
    small = pool.mul(pool.mul(inertia, leak), pool.der(pool.der(p)))
    nothing = pool.mul(none, pool.der(pool.der(pool.der(p))))
    balance = pool.add((1, flow), (-1, pool.mul(area, pool.der(p))), (-1, small), (-1, nothing))
    program = bench.program(balance)
    assert [d.order for d in program.dropped] == [2, 3]
    assert program.residuals[0].invisible == ("leak", "I")


@pytest.mark.parametrize("limit", [10**6, 10])
def test_a_leak_in_a_long_line_is_kept(limit: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A ladder of capacitors that leak, nominally nothing, written out and by its table."""
    monkeypatch.setattr("bondgraph.passes.lowering.lower.LIMIT", limit)
    bench = Bench()
    pool = bench.pool
    r, c, g = bench.param("R", "1"), bench.param("C", "0.1"), bench.param("G", "0")
    u, y = bench.input("u"), bench.sensor("y")
    voltage, current = y, pool.zero
    for _ in range(3):
        leaks = (1, pool.mul(c, pool.der(voltage))), (1, pool.mul(g, voltage))
        current = pool.add((1, current), *leaks)
        voltage = pool.add((1, voltage), (1, pool.mul(r, current)))
    program = bench.program(pool.add((1, u), (-1, current)))
    assert any(isinstance(s, PolynomialTape) for s in program.configure) == (limit == 10)
    assert program.dropped == ()  # the sum of the leaks is all there is at rest
    assert program.residuals[0].invisible == ()


def test_symbolic_models_drop_nothing() -> None:
    bench = Bench()
    p = bench.pool
    y, c = bench.sensor("y"), bench.param("c", None)
    program = bench.program(p.add((1, y), (1, p.mul(c, p.der(y)))))
    assert program.params[0].default is None
    assert program.dropped == ()
    with pytest.raises(KeyError):
        Sampled(program)
    assert Sampled(program, {"c": 2.0}).exact({"y": {0: 1.0, 1: 5.0}}) == {"r1": 11.0}


def test_orders_that_cannot_be_realised_are_refused_by_name() -> None:
    bench = Bench()
    p = bench.pool
    y, c = bench.sensor("y"), bench.param("c", None)
    high = y
    for _ in range(20):
        high = p.der(high)
    program = bench.program(p.add((1, y), (1, p.mul(c, high))))
    assert program.residuals[0].unavailable == "its order 20 is above 12"
    run = Sampled(program, {"c": 1.0})
    assert run.step({"y": 1.0}) == ({"r1": 0.0}, {"r1": False})


def test_derived_constants_and_initial_values_are_computed_by_configure() -> None:
    bench = Bench()
    p = bench.pool
    d = bench.param("d", "2")
    area = bench.param("area", p.scale(3, p.power(d, 2)), fault=False)
    start = bench.initial("h0", p.mul(area, d))
    y = bench.sensor("y")
    program = bench.program(p.add((1, p.mul(area, y)), (1, p.integral(y, start))))
    assert [f.name for f in program.params] == ["d"]
    found = Sampled(program, {"d": 3.0}).exact({"y": {0: 1.0, -1: 10.0}})
    assert found["r1"] == pytest.approx(27.0 + 10.0 + 81.0)


def test_integrals_that_must_be_given() -> None:
    bench = Bench()
    p = bench.pool
    y, zero = bench.sensor("y"), bench.initial("x0", bench.pool.num(0))
    program = bench.program(p.sub(y, p.integral(p.fn("tanh", y), zero)))
    (given,) = program.integrals
    assert given.path == "Int(tanh(y))"
    found = Sampled(program).exact({"y": {0: 3.0}}, integrals={given.name: 1.0})
    assert found["r1"] == 2.0


def test_what_is_integrated_twice() -> None:
    """y = 2 int int u + 3 int u with u = t is t^3/3 + 3/2 t^2."""
    bench = Bench()
    p = bench.pool
    y, u, zero = bench.sensor("y"), bench.input("u"), bench.initial("x0", bench.pool.num(0))
    once = p.integral(u, zero)
    program = bench.program(p.add((1, y), (-2, p.integral(once, zero)), (-3, once)))
    run, stuck = (Sampled(program, sample_time=1e-3) for _ in range(2))
    for k in range(2001):
        t = k * 1e-3
        calm = run.step({"u": t, "y": t**3 / 3 + 1.5 * t**2}).residuals["r1"]
        short = stuck.step({"u": t, "y": 0.0}).residuals["r1"]
    assert abs(calm) < 1e-5
    assert -26 / 3 < short < -0.9 * 26 / 3  # what y should be, some filter late


def test_change_since_the_start() -> None:
    bench = Bench()
    p = bench.pool
    y, q0 = bench.sensor("y"), bench.initial("q0", bench.pool.num(4))
    program = bench.program(p.add((1, p.integral(p.der(y), q0)), (1, p.integral(p.one, q0))))
    (known,) = program.knowns
    assert known.start
    found = Sampled(program).exact({"y": {0: 3.0}}, start={"y": 1.0}, time=10.0)
    assert found["r1"] == 3.0 - 1.0 + 4.0 + 10.0 + 4.0
    run = Sampled(program, sample_time=0.5)
    values = [run.step({"y": y}).residuals["r1"] for y in (1.0, 1.0, 1.0)]
    assert values[0] == pytest.approx(8.0)  # q0 twice, nothing moved, no time passed
    for _ in range(200):
        last = run.step({"y": 2.0}).residuals["r1"]
    # the filter is as fast as the samples here, their mean over two: half a sample late
    assert last == pytest.approx(8.0 + 1.0 + 202 * 0.5 - 0.5 / 2, rel=1e-6)


def test_modes_choose() -> None:
    bench = Bench()
    p = bench.pool
    u, on = bench.input("u"), bench.input("on", mode=True)
    y = bench.sensor("y")
    program = bench.program(p.sub(p.der(y), p.choose(on, u, p.zero)))
    run = Sampled(program)
    known = {"y": {0: 1.0, 1: 2.0}, "u": {0: 2.0}}
    assert run.exact(known, modes={"on": True})["r1"] == 0.0
    assert run.exact(known, modes={"on": False})["r1"] == 2.0
    assert [k.kind for k in program.knowns] == ["input", "mode", "sensor"]
    assert program.residuals[0].approximate == ""


def test_a_product_keeps_the_sign_of_a_sum_of_negative_parameters() -> None:
    """-(a + b) x dy/dt with x = 3 and y = 2 t is -(2 + 3) * 3 * 2 in exact and in step."""
    bench = Bench()
    p = bench.pool
    a, b = bench.param("a", "2"), bench.param("b", "3")
    x, y = bench.sensor("x"), bench.sensor("y")
    program = bench.program(p.mul(p.add((-1, a), (-1, b)), x, p.der(y)))
    assert program.residuals[0].approximate
    run = Sampled(program, sample_time=1e-3)
    assert run.exact({"x": {0: 3.0}, "y": {1: 2.0}})["r1"] == -30.0
    for k in range(2000):
        last = run.step({"x": 3.0, "y": 2.0 * k * 1e-3}).residuals["r1"]
    assert last == pytest.approx(-30.0)


def test_tables_and_their_slopes() -> None:
    bench = Bench()
    p = bench.pool
    p.tables["hill"] = tuple((Fraction(x), Fraction(y)) for x, y in ((0, 0), (1, 2), (3, 3)))
    x = bench.sensor("x")
    program = bench.program(p.der(p.fn("table:hill", x)), p.fn("table:hill", x))
    run = Sampled(program)
    for at, value, slope in ((-1.0, 0.0, 0.0), (0.5, 1.0, 2.0), (2.0, 2.5, 0.5), (9.0, 3.0, 0.0)):
        found = run.exact({"x": {0: at, 1: 1.0}})
        assert found == {"r1": slope, "r2": value}


def test_every_statement_says_what_it_is_and_where_from() -> None:
    bench = Bench()
    program = bench.program(*drive(bench))
    for statement in (*program.exact, *program.first, *program.step):
        assert statement.comment
        assert statement.origin is not None
    assert all(s.comment for s in program.configure)
    names = [f.name for f in (*program.coefs, *program.states)]
    assert len(names) == len(set(names))


def test_locals_are_assigned_before_they_are_read_and_once() -> None:
    from bondgraph.ir.program import Choice, Compare, Function, Logic, Product, Ref, Sum

    def refs(value: object) -> list[Ref]:
        match value:
            case Ref():
                return [value]
            case Sum():
                return [r for _, t in value.terms for r in refs(t)]
            case Product():
                return [r for f in (*value.factors, *value.divisors) for r in refs(f)]
            case Function() | Logic():
                return [r for a in value.args for r in refs(a)]
            case Choice():
                return refs(value.condition) + refs(value.yes) + refs(value.no)
            case Compare():
                return refs(value.left) + refs(value.right)
            case _:
                return []

    bench = Bench()
    program = bench.program(*drive(bench))
    for part in (program.configure, program.exact, program.first, program.step):
        seen: set[str] = set()
        for statement in part:
            assert isinstance(statement, Assign)
            for ref in refs(statement.value):
                assert ref.space != "local" or ref.name in seen
            if statement.target.space == "local":
                assert statement.target.name not in seen
                seen.add(statement.target.name)


def test_digest_follows_numbers_and_options_but_no_path() -> None:
    def make(value: str, rate: float = 1000.0) -> str:
        bench = Bench()
        p = bench.pool
        expr = p.mul(bench.param("a", value), p.der(bench.sensor("y")))
        return bench.program(expr, options=LowerOptions(rate=rate)).digest

    assert make("1") == make("1")
    assert len({make("1"), make("2"), make("1", 500.0)}) == 3


def test_settling_times() -> None:
    assert settle(1) == pytest.approx(6.907755, rel=1e-6)  # ln 1000
    assert settle(3) == pytest.approx(11.2289, rel=1e-4)  # chi-squared quantile / 2


def test_a_term_is_seen_down_to_twelve_bits_unless_asked_otherwise() -> None:
    assert LowerOptions().resolution == 1 / 4096


@pytest.mark.parametrize(("kind", "written"), [("one", 0), ("filtered", 0), ("sum", 1)])
def test_what_is_beside_laws_of_derivatives_has_one_name(kind: str, written: int) -> None:
    """It passes the filter of the laws: as it is where it has a name, else under one of its own."""
    bench = Bench()
    p, y, u = bench.pool, bench.sensor("y"), bench.input("u")
    law = p.mul(y, p.fn("exp", p.der(y)))
    beside = {
        "one": [(3, u)],
        "filtered": [(1, p.der(u, 2)), (2, u)],
        "sum": [(3, u), (1, p.mul(bench.param("a", "0.5"), p.der(u)))],
    }[kind]
    program = bench.program(p.add((1, law), *beside))
    for statements in (program.first, program.step):
        own = [s.value for s in statements if s.target.name == "r1_others"]  # type: ignore[union-attr]
        assert len(own) == written and all(isinstance(value, Sum) for value in own)
