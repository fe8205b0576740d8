"""Dependence: sensitivities, orders, what is dead, and what only the past matters for."""

from fractions import Fraction

import pytest

from bondgraph.exact.dependence import sensitivities
from bondgraph.exact.evaluate import evaluate
from bondgraph.exact.outline import highest_order, integral_depth
from bondgraph.exact.plant import Plant
from bondgraph.ir.expr import Expr, Kind
from tests.unit.exact.models import FLEXIBLE, MOTOR, graph, symbols
from tests.unit.exact.random_signals import D, Signals, a, add, b, mul, pool, x, x0, y


def test_orders_and_dependence() -> None:
    r = add((1, mul(a, D(D(x)))), (1, mul(b, D(y))), (1, x))
    s = sensitivities(r, Signals())
    assert s.depends == {x: True, y: True, a: True, b: True}
    assert s.orders == {x: 2, y: 1}
    assert s.dead == frozenset()


def test_what_cancels_is_dead() -> None:
    # (a + b)^2 y - a^2 y - 2 a b y - b^2 y + x: y and both parameters cancel
    square = pool.power(add((1, a), (1, b)), 2)
    other = add((1, pool.power(a, 2)), (2, mul(a, b)), (1, pool.power(b, 2)))
    r = add((1, mul(square, y)), (-1, mul(other, y)), (1, x))
    s = sensitivities(r, Signals())
    assert s.depends == {x: True, y: False, a: False, b: False}
    assert s.orders == {x: 0}
    assert y in s.dead and x not in s.dead


def test_a_parameter_is_a_function_of_time() -> None:
    # D(a x) - a D(x) = a' x: seen by a varying parameter only
    r = add((1, D(mul(a, x))), (-1, mul(a, D(x))))
    assert sensitivities(r, Signals()).depends[a]


def test_the_highest_order_may_cancel() -> None:
    r = add((1, D(mul(x, D(x)))), (-1, mul(x, D(D(x)))))  # = x'^2
    assert sensitivities(r, Signals()).orders == {x: 1}


def test_an_integral_brings_in_the_past() -> None:
    r = add((1, pool.integral(mul(a, x), x0)), (1, D(y)))
    s = sensitivities(r, Signals())
    assert s.orders == {x: -1, y: 1}
    assert s.depends[a] and s.starts == (x0.symbol,)
    assert integral_depth([r]) == 1


def test_integrals_that_cancel_leave_no_past() -> None:
    # Int(a x) - a Int(x) forgets x while a is constant, not a itself
    r = add((1, pool.integral(mul(a, x), x0)), (-1, mul(a, pool.integral(x, x0))), (1, y))
    s = sensitivities(r, Signals())
    assert s.depends == {x: False, y: True, a: True}
    assert s.orders == {y: 0}


def test_nested_integrals_reach_further_back() -> None:
    r = pool.integral(mul(x, pool.integral(y, x0)), x0)
    s = sensitivities(r, Signals())
    assert s.orders == {x: -1, y: -1}
    assert integral_depth([r]) == 2


def test_a_derivative_undoes_an_integral() -> None:
    r = D(mul(y, pool.integral(x, x0)))
    s = sensitivities(r, Signals())
    assert s.orders == {x: 0, y: 1}


def test_an_exponent_that_may_change_is_seen() -> None:
    n = pool.symbol("n", Kind.PARAM)
    r = add((1, pool.fn("pow", pool.power(x, 2), n)), (1, y))
    assert sensitivities(r, Signals()).depends == {x: True, n: True, y: True}


def test_a_number_as_exponent_has_its_own_slope() -> None:
    # (x^2)^(2/5) to the fifth is x^4, so that x cancels
    power = pool.fn("pow", pool.power(x, 2), pool.num(Fraction(2, 5)))
    r = add((1, pool.power(power, 5)), (-1, pool.power(x, 4)), (1, y))
    assert sensitivities(r, Signals()).depends == {x: False, y: True}


@pytest.mark.parametrize("seed", range(3))
def test_what_a_decision_rests_on_stays_alive_in_every_branch(seed: int) -> None:
    for r in (
        pool.fn("min", mul(a, x), mul(b, y)),
        pool.choose(pool.compare("<", x, y), mul(a, x), mul(b, y)),
        mul(a, pool.fn("sign", mul(b, add((1, x), (1, y))))),
    ):
        assert sensitivities(r, Signals(seed=seed), jumps=True).dead == frozenset()


def motor_residual(g: object = None) -> tuple[Plant, Expr]:
    model = graph(MOTOR)
    p, s = model.pool, symbols(model)
    torque = p.add((1, p.mul(s["b"], s["w"])), (1, p.der(p.mul(s["J"], s["w"]))))
    i = p.div(torque, s["k"])
    coil = p.add((1, p.mul(s["Re"], i)), (1, p.der(p.mul(s["L"], i))))
    return Plant(model), p.add((1, s["U"]), (-1, coil), (-1, p.mul(s["k"], s["w"])))


def test_series_and_exponentials_say_the_same() -> None:
    plant, r = motor_residual()
    one = sensitivities(r, plant.trajectory(1, highest_order([r])))
    two = sensitivities(r, plant.exponential(1))
    assert one == two
    assert {k.symbol.name: v for k, v in two.orders.items()} == {"w": 2, "U": 0}


def test_exponentials_find_orders_below_long_cancellations() -> None:
    plant, _ = motor_residual()
    p, s = plant.graph.pool, symbols(plant.graph)
    w, U, k = s["w"], s["U"], s["k"]
    high = w
    for _ in range(12):
        high = p.add((1, p.der(high)), (1, p.mul(k, high)))
    same = w  # (D + k)^12 w again, written (D + k)^11 (D w) + k (D + k)^11 w
    for _ in range(11):
        same = p.add((1, p.der(same)), (1, p.mul(k, same)))
    r = p.add((1, high), (-1, p.der(same)), (-1, p.mul(k, same)), (1, p.der(U)), (1, w))
    assert sensitivities(r, plant.exponential(2)).orders == {w: 0, U: 1}


def test_an_integral_on_a_trajectory_begins_at_the_declared_value() -> None:
    model = graph(FLEXIBLE)
    p, s = model.pool, symbols(model)
    start = next(n for n in model.nodes if n.path == "spring").ports[0].initial
    assert start is not None
    twist = p.integral(p.sub(s["w1"], s["w2"]), start)
    torque = p.sub(s["T"], p.der(p.mul(s["J"], s["w1"])))
    r = p.sub(torque, p.mul(s["K"], twist))
    plant = Plant(model)
    assert evaluate([r], plant.trajectory(1, highest_order([r], 4)), 4)[0] == [0] * 4
    t = plant.trajectory(1, highest_order([r], 2), "w2")
    assert evaluate([r], t, 2)[0][1] != 0
    seen = sensitivities(r, t)
    assert {k.symbol.name: v for k, v in seen.orders.items()} == {"w1": 1, "w2": -1, "T": 0}


def test_what_holds_at_once_depends_alike_on_a_course_and_on_exponentials() -> None:
    """U + Re w - 3 w is a sum of products: the resistance counts, and no derivative does."""
    model = graph(MOTOR)
    p, s = model.pool, symbols(model)
    r = p.add((1, s["U"]), (1, p.mul(s["Re"], s["w"])), (-3, s["w"]))
    plant = Plant(model)
    for sample in (plant.trajectory(1, 4), plant.exponential(2)):
        found = sensitivities(r, sample)
        assert {v.symbol.name for v, hit in found.depends.items() if hit} == {"U", "Re", "w"}
        assert {v.symbol.name: k for v, k in found.orders.items()} == {"U": 0, "w": 0}
        assert found.starts == () and {v.symbol.name for v in found.lasting} >= {"U", "Re", "w"}
