"""Trajectories against equations of motion written down by hand."""

import pytest
from flint import arb, nmod

from bondgraph.exact.assembly import Assembly
from bondgraph.exact.evaluate import evaluate
from bondgraph.exact.outline import highest_order
from bondgraph.exact.plant import _LOOSE, _STILL, Plant
from bondgraph.exact.plant_draws import ATTEMPTS, Draws
from bondgraph.exact.trajectory import ExactUnavailable
from bondgraph.field.prime import PrimeField, inverse
from bondgraph.field.series import Series
from bondgraph.field.sparse import Contradiction
from bondgraph.ir.expr import Expr
from tests.unit.exact.models import FLEXIBLE, GEAR, MOTOR, TANKS, graph, symbols

N = 7


def rate(a: Series) -> Series:
    return [k * x for k, x in enumerate(a)][1:]


def vanish(values: Series) -> bool:
    """Whether all numbers are zero, over the field or within real balls."""
    return all(not x if isinstance(x, (int, nmod)) else x.contains(0) for x in values)


@pytest.mark.parametrize("seed", range(5))
def test_motor_follows_its_differential_equations(seed: int) -> None:
    # L i' = U - Re i - k w,  J w' = k i - b w: the Taylor recursion of the linear system
    model = graph(MOTOR)
    t = Plant(model).trajectory(seed, N)
    s = symbols(model)
    L, Re, k, J, b = (t.value(s[n])[0] for n in ("L", "Re", "k", "J", "b"))
    U = t.value(s["U"])
    w = t.value(s["w"])
    i = [(J * w[1] + b * w[0]) * inverse(k)]
    again = [w[0]]
    for n in range(N):
        di = (U[n] - Re * i[n] - k * again[n]) * inverse(L)
        dw = (k * i[n] - b * again[n]) * inverse(J)
        i.append(di * inverse(n + 1))
        again.append(dw * inverse(n + 1))
    assert again == w[: N + 1]


def test_a_gear_makes_one_inertia_of_two() -> None:
    # (N^2 J1 + J2) w' + b w = N T: the second inertia is dependent
    model = graph(GEAR)
    t = Plant(model).trajectory(4, N)
    s = symbols(model)
    J1, J2, ratio, b = (t.value(s[n])[0] for n in ("J1", "J2", "N", "b"))
    w, T = t.value(s["w"]), t.value(s["T"])
    for n, dw in enumerate(rate(w)[:N]):
        assert (ratio**2 * J1 + J2) * dw + b * w[n] - ratio * T[n] == 0


def test_tanks_follow_torricelli() -> None:
    # C1 h1' + f = Q, and over the reals f^2 = k1^2 |h1 - h2| with the sign of the fall
    model = graph(TANKS)
    t = Plant(model).trajectory(1, N)
    s = symbols(model)
    C1, k1 = (t.value(s[n])[0] for n in ("C1", "k1"))
    assert (C1, k1) == (1, 1)  # as declared
    h1, h2, Q = (t.value(s[n]) for n in ("h1", "h2", "Q"))
    flow = [Q[n] - C1 * dh for n, dh in enumerate(rate(h1)[:N])]
    fall = [x - y for x, y in zip(h1, h2, strict=True)]
    side = 1 if fall[0] > 0 else -1
    assert (flow[0] > 0) == (side > 0)
    square = [sum(flow[j] * flow[n - j] for j in range(n + 1)) for n in range(N)]
    assert vanish([a - side * k1**2 * x for a, x in zip(square, fall[:N], strict=True)])
    assert all(x.rad() < arb(2) ** -256 for x in square)


def test_a_declared_initial_value_is_told() -> None:
    model = graph(FLEXIBLE)
    t = Plant(model).trajectory(2, N)
    s = symbols(model)
    port = next(n for n in model.nodes if n.path == "spring").ports[0]
    assert port.initial is not None and port.state is not None
    start = t.start(port.initial.symbol)
    assert t.value(port.initial) == [start] == t.truth(port.state)[:1]
    # K q = J w' ... with the sign of the arrow: T - J w1' is the torque of the spring
    torque = [
        (t.value(s["T"])[n] - t.value(s["J"])[0] * dw)
        for n, dw in enumerate(rate(t.value(s["w1"]))[:N])
    ]
    twist = [
        start,
        *[
            (x - y) * inverse(k)
            for k, (x, y) in enumerate(zip(t.value(s["w1"]), t.value(s["w2"]), strict=True), 1)
        ],
    ]
    assert torque == [t.value(s["K"])[0] * q for q in twist[:N]]


def test_a_spring_that_is_held_keeps_its_twist() -> None:
    """Without its rate nothing ties the speeds together; its torque 2 K stays, the rest goes on."""
    model = graph(FLEXIBLE.replace("q0 = 0", "q0 = 2"))
    plant = Plant(model)
    ((start, state, two),) = plant.structure.declared_starts()
    held = plant.holding({state: two})
    assert held.structure.held == (start,)
    whole, rest = plant.structure.assembly, held.structure.assembly
    gone = {r.variable for r in whole.rates} - {r.variable for r in rest.rates}
    assert gone == {whole.place[state][0]}
    t, s = held.trajectory(2, N), symbols(model)
    torque = [
        t.value(s["T"])[n] - t.value(s["J"])[0] * dw
        for n, dw in enumerate(rate(t.value(s["w1"]))[:N])
    ]
    assert torque == [2 * t.value(s["K"])[0]] + [0] * (N - 1)
    load = [t.value(s["m"])[0] * dw for dw in rate(t.value(s["w2"]))[:N]]
    assert load == torque
    assert any(x != y for x, y in zip(t.value(s["w1"]), t.value(s["w2"]), strict=True))


def residual_of_motor(model: str = MOTOR) -> tuple[Plant, Expr]:
    g = graph(model)
    p, s = g.pool, symbols(g)
    torque = p.add((1, p.mul(s["b"], s["w"])), (1, p.der(p.mul(s["J"], s["w"]))))
    i = p.div(torque, s["k"])
    voltage = p.add(
        (1, p.mul(s["Re"], i)), (1, p.der(p.mul(s["L"], i))), (1, p.mul(s["k"], s["w"]))
    )
    return Plant(g), p.sub(s["U"], voltage)


def test_every_fault_of_the_motor_moves_its_residual() -> None:
    plant, r = residual_of_motor()
    assert evaluate([r], plant.trajectory(9, highest_order([r], 3)), 3)[0] == [0, 0, 0]
    for fault in plant.graph.faults:
        value = evaluate([r], plant.trajectory(9, highest_order([r], 3), fault), 3)[0]
        assert all(value), fault


def test_a_residual_holds_while_parameters_vary_that_it_is_told_of() -> None:
    plant, r = residual_of_motor()
    t = plant.trajectory(3, highest_order([r]), faults=["L", "J", "k"])
    assert evaluate([r], t)[0] != [0]

    class Told:
        algebra = t.algebra
        value = staticmethod(t.truth)
        start = staticmethod(t.start)

    names = symbols(plant.graph)
    truth = {names[n]: t.truth(names[n]) for n in ("L", "J", "k", "Re", "b", "U")}
    Told.value = staticmethod(lambda v: truth.get(v) or t.value(v))
    assert evaluate([r], Told())[0] == [0]


def test_trajectories_repeat() -> None:
    plant, _ = residual_of_motor()
    one, two = plant.trajectory(5, 4), Plant(plant.graph).trajectory(5, 4)
    w = symbols(plant.graph)["w"]
    assert one.value(w) == two.value(w) != plant.trajectory(6, 4).value(w)


def test_an_unknown_fault_is_a_key_error() -> None:
    with pytest.raises(KeyError):
        Plant(graph(MOTOR)).trajectory(1, 2, "nothing")


def test_exponentials_agree_with_the_transfer_function() -> None:
    # w/U = k / ((L s + Re)(J s + b) + k^2)
    model = graph(MOTOR)
    exponential = Plant(model).exponential(3)
    v = symbols(model)
    L, Re, k, J, b = (exponential.value(v[n])[0] for n in ("L", "Re", "k", "J", "b"))
    s = exponential.algebra.s
    below = (L * s + Re) * (J * s + b) + k * k
    assert exponential.value(v["w"])[0] * below == k * exponential.value(v["U"])[0]


HARD = {
    "loop of nonlinear laws": """
model A { param R1 = 1; param k = 1; param g = 1; param C = 1
    0:n { -> C:C; -> De:y; -> 1:s }
    s { -> R:R1; -> R:d { e = k*sinh(f) }; -> 0:p }
    p { -> R:a { f = g*ssqrt(e) }; -> R:b { e = k*exp(f) - k } }
    Sf:Q -> n
}""",
    "rigid body": """
model A { param Ix = 1; param Iy = 1; param Iz = 1
    Se:Tx -> 1:x -> I:Ix
    Se:Ty -> 1:y -> I:Iy
    1:z -> I:Iz
    x -> MGY:a { e1 = Iz.p*f2 } -> y
    y -> MGY:b { e1 = Ix.p*f2 } -> z
    z -> MGY:g { e1 = Iy.p*f2 } -> x
    x -> Df:wx
}""",
    "capacitor at a source": """
model A { param C = 1; param R = 1
    Se:U -> 1:s -> 0:n
    n { -> C:C; -> R:R }
    s -> Df:i
}""",
    "parallel capacitors behind a gyrator": """
model A { param C1 = 1; param C2 = 1; param g = 1
    Se:U -> 1:x -> 0:a
    a { -> C:C1; -> GY:g -> 0:b }
    b { -> C:C2; -> R:r = 2 }
    x -> Df:y
}""",
    "derivative of a function": """
model A { param m = 1; param b = 1; param a = 1
    Se:F -> 1:v
    v { -> I:m; -> R:b { e = b*f + a*der(sin(f)) }; -> Df:y }
}""",
    "a law with one open quantity in two places": """
model A { param g = 1; param a = 1; param b = 1; param J = 1
    1:s { <- Se:W = g; -> R:x { e = a*f + b*tanh(f) }; -> TF:n { f1 = 2*f2 } -> 1:t }
    t -> Df:w
}""",
    "two laws on one effort": """
model A { param a = 1; param b = 1
    Se:F -> 0:n
    n { -> R:x { e = a*f^3 }; -> R:y { e = b*tanh(f) }; -> R:z { f = a*cbrt(e) } }
    De:e <- n
}""",
}


@pytest.mark.parametrize("name", HARD)
def test_hard_plants_satisfy_every_law_to_every_order(name: str) -> None:
    plant = Plant(graph(HARD[name]))
    whole, sample = plant.structure.assembly, plant.trajectory(2, N).truths
    for _, law in whole.laws:
        assert vanish(evaluate([law], sample, N - 2)[0])
    for node, terms, when, _ in whole.balances:
        assert when is None
        for n in range(N - 2):
            total = sum(sign * sample._variables[v][n] for v, sign in terms)
            assert vanish([total]), node
    for _, variable, value in whole.rates:
        state = sample._variables[variable]
        both = zip(rate(state)[: N - 2], sample.value(value)[: N - 2], strict=False)
        assert vanish([a - b for a, b in both])


def test_a_switched_junction_blocks_when_it_is_off() -> None:
    model = graph("""
model A { param R = 1; param C = 1
    input on : bool
    1:sw when on { <- Se:U; -> R:R; -> 0:o; -> Df:i }
    o { -> C:C; -> R:Rl = 2; -> De:y }
}""")
    s = symbols(model)
    plant = Plant(model)
    off, on = (plant.trajectory(1, 3, modes={s["on"]: k}) for k in (0, 1))
    assert not any(off.value(s["i"]))
    assert all(on.value(s["i"]))
    drop = [(u - y) for u, y in zip(on.value(s["U"]), on.value(s["y"]), strict=False)]
    assert drop[:3] == [on.value(s["R"])[0] * x for x in on.value(s["i"])[:3]]


def test_exponentials_of_a_switched_plant_are_those_of_its_mode() -> None:
    """Off, nothing flows; on, U = (2 s + 3) i."""
    model = graph("""
model A { input on : bool
    1:sw when on { <- Se:U; -> R:R = 3; -> I:L = 2; -> Df:i }
}""")
    s = symbols(model)
    plant = Plant(model)
    for seed in range(4):
        off, on = (plant.exponential(seed, modes={s["on"]: k}) for k in (0, 1))
        assert off.value(s["i"])[0] == 0 != off.value(s["U"])[0]
        assert on.value(s["U"])[0] == (2 * on.algebra.s + 3) * on.value(s["i"])[0] != 0


def test_an_over_determined_plant_has_no_trajectory() -> None:
    from bondgraph.exact.assembly import Balance

    plant = Plant(graph(MOTOR))
    extra = Balance(0, ((0, 1), (1, 1)), None, 0)
    whole = plant.structure.assembly
    plant.structure.assembly = whole._replace(
        balances=(*whole.balances, *[extra._replace(node=n) for n in range(3)])
    )
    with pytest.raises(ExactUnavailable):
        plant.trajectory(1, 2)


@pytest.mark.parametrize("faults", [[], ["b"], ["c"], ["b", "c"], ["m", "d"], ["g"]])
def test_laws_hold_while_what_stands_before_derivatives_varies(faults: list[str]) -> None:
    model = graph("""
model Body { param m = 1; param b = 2; param c = 3; param d = 5; param g = 7
    1:v { <- Se:F; -> I:m; -> R:r { e = b*f + c*der(f) + d*der(der(f)) + der(b*f) + g }
        -> Df:y }
}""")
    plant, s = Plant(model), symbols(model)
    sample = plant.trajectory(5, N, faults=faults).truths
    for name in "mbcdg":
        assert any(sample.value(s[name])[1:]) == (name in faults)
    for _, law in plant.structure.assembly.laws:
        assert vanish(evaluate([law], sample, N - 2)[0])
    speed = model.nodes[[n.path for n in model.nodes].index("r")].ports[0].flow
    assert all(sample.value(speed)[: N - 2])  # it moves, in every order


def test_what_contradicts_is_drawn_again_then_at_rest_and_then_left_out_law_by_law(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A plant of real numbers that is never found: what is tried, and with which laws."""
    tried: list[tuple[bool, int]] = []

    def fails(self: object, seed: int, order: int, *rest: object, **more: object) -> None:
        plant = rest[3]
        assert isinstance(plant, Assembly)
        tried.append((bool(more["still"]), len({law[0] for law in plant.laws})))
        raise Contradiction(0, plant.laws[0][0] if plant.laws else -1)

    model = graph(TANKS)
    plant = Plant(model)
    laws = len({law[0] for law in plant.structure.assembly.laws})
    monkeypatch.setattr(Draws, "trajectory", fails)
    with pytest.raises(ExactUnavailable):
        plant.trajectory(1, 2)
    assert 1 < laws <= _LOOSE  # so that in the end none is left
    rests = [(True, laws - out) for out in range(laws + 1) for _ in range(_STILL)]
    assert tried == [(False, laws)] * ATTEMPTS + rests
    count = len(tried)
    for fault in (None, "k1"):  # it is hopeless, with a fault as well
        with pytest.raises(ExactUnavailable):
            plant.trajectory(2, 2, fault)
    assert len(tried) == count
    other = Plant(model)
    for fault in ("k1", "k1", None):  # that none is found with a fault says nothing of others
        with pytest.raises(ExactUnavailable):
            other.trajectory(2, 2, fault)
    assert len(tried) == 4 * count


def test_modes_are_off_or_on_unless_they_are_told() -> None:
    model = graph(MOTOR.replace("Se:U", "input on : bool\n    sensor z = if(on, U, 0)\n    Se:U"))
    draws, on = Draws(Plant(model).structure), symbols(model)["on"]
    drawn = [draws.constants(1, k, {}, PrimeField(1))[on] for k in range(30)]
    assert sorted({value for (value,) in drawn}) == [0, 1]
    assert all(draws.constants(1, k, {on: k}, PrimeField(1))[on] == [k] for k in (0, 1))
