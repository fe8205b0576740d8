"""Elimination against relations derived by hand: chains, loops, integrals, and refusals."""

from __future__ import annotations

import pytest
import sympy as sp

from bondgraph.algebra.zero import is_zero
from bondgraph.text.diagnostic import CompileError
from tests.unit.passes.relations import compiled, is_multiple, t

Q = sp.Rational


def D(x, n=1):
    return sp.diff(x, t, n)


def test_parallel_branches_make_a_differential_loop() -> None:
    """i = i1 + i2, L1 i1' + R1 i1 = L2 i2' + R2 i2 = v: multiply by both operators."""
    c = compiled(
        """model M {
        param R1 = 2; param L1 = 3; param R2 = 5; param L2 = 7; param R0 = 11
        Se:U -> 1:s
        s { -> R:R0; -> Df:i; -> n }
        0:n { -> a; -> b }
        1:a { -> I:L1; -> R:R1 }
        1:b { -> I:L2; -> R:R2 }
        }"""
    )

    def by_hand(R1, L1, R2, L2, R0, U, i):
        v = U - R0 * i
        one = L2 * D(i) + R2 * i
        return L1 * D(one) + R1 * one - (L1 + L2) * D(v) - (R1 + R2) * v

    params = {"R1": Q(2), "L1": Q(3), "R2": Q(5), "L2": Q(7), "R0": Q(11)}
    assert len(c.residuals) == 1
    assert is_multiple(c.residuals[0], by_hand, params, ("U", "i"))


def test_equal_branches_need_no_factor_twice() -> None:
    """With equal branches i1 = i2 = i/2: the relation has the order of one branch, not of two."""
    c = compiled(
        """model M {
        param R = 2; param L = 3; param R0 = 11
        Se:U -> 1:s
        s { -> R:R0; -> Df:i; -> n }
        0:n { -> a; -> b }
        1:a { -> I:L1 = L; -> R:R1 = R }
        1:b { -> I:L2 = L; -> R:R2 = R }
        }"""
    )

    def by_hand(R, L, R0, U, i):
        return U - R0 * i - (L * D(i) + R * i) / 2

    assert is_multiple(c.residuals[0], by_hand, {"R": Q(2), "L": Q(3), "R0": Q(11)}, ("U", "i"))


@pytest.mark.parametrize("balanced", [False, True])
def test_bridge_is_solved_as_a_network(balanced: bool) -> None:
    """Conductance of a bridge between its ends by Kirchhoff's laws, in balance and out of it."""
    numbers = {f"R{k}": Q(k) for k in (1, 2, 3, 4, 5)} | {"R0": Q(1)}
    if balanced:
        numbers["R4"] = Q(6)
    text = "; ".join(f"param {n} = {v}" for n, v in numbers.items())
    c = compiled(
        f"""model W {{
        {text}
        Se:U -> 1:s
        s {{ -> R:R0; -> Df:i; -> 0:top }}
        top -> 1:a -> 0:l
        a -> R:R1
        top -> 1:b -> 0:r
        b -> R:R2
        l -> R:R3
        r -> R:R4
        l -> 1:br -> r
        br -> R:R5
        }}"""
    )

    def by_hand(R1, R2, R3, R4, R5, R0, U, i):
        v, left, right = sp.symbols("v left right")
        nodes = sp.solve(
            [
                (v - left) / R1 - left / R3 - (left - right) / R5,
                (v - right) / R2 - right / R4 + (left - right) / R5,
            ],
            [left, right],
        )
        current = (v - nodes[left]) / R1 + (v - nodes[right]) / R2
        return i - current.subs(v, U - R0 * i)

    assert len(c.residuals) == 1
    assert is_multiple(c.residuals[0], by_hand, numbers, ("U", "i"))


def test_what_is_left_over_of_a_loop_is_not_the_equation_that_opened_it() -> None:
    """With all steps inserted the closing equation is the relation; the other one says 0 = 0."""
    c = compiled(
        """model W {
        param R0 = 1; param R1 = 1; param R2 = 2; param R3 = 3; param R4 = 4; param R5 = 5
        Se:U -> 1:s
        s { -> R:R0; -> Df:i; -> 0:top }
        top -> 1:a -> 0:l
        top -> 1:b -> 0:r
        l -> 1:br -> r
        a -> R:R1; b -> R:R2; l -> R:R3; r -> R:R4; br -> R:R5
        }"""
    )
    (closing,) = c.reduced.closings
    assert "loop" in [s.how for s in closing.steps]
    values = {s.variable: s.closed for s in closing.steps}
    (inserted,) = c.graph.pool.substitute([closing.equation.zero], values)
    assert not is_zero(inserted)
    assert is_zero(c.graph.pool.sub(inserted, closing.expr))


SPRING = """model M {{
    param m = 2; param K = 10; param b = 3
    Se:F -> 1:v
    v {{ -> I:m; -> C:spring{start} = 1/K; -> R:b; -> Df:y }}
    }}"""


@pytest.mark.parametrize("start", ["", "(q0 = 5)"])
def test_what_something_else_computes_is_not_integrated(start: str) -> None:
    """The spring's force follows from the balance, with or without a declared start."""
    c = compiled(SPRING.format(start=start))

    def by_hand(m, K, b, F, y):
        return D(F) - m * D(y, 2) - b * D(y) - K * y

    params = {"m": Q(2), "K": Q(10), "b": Q(3)}
    assert is_multiple(c.residuals[0], by_hand, params, ("F", "y"))
    assert c.residuals[0].orders == {"F": 1, "y": 2}


TWO_SPRINGS = """model M {{
    param m = 2; param K1 = 10; param K2 = 3
    Se:F -> 1:v
    v {{ -> I:m; -> C:s1{start} = 1/K1; -> C:s2{start} = 1/K2; -> Df:y }}
    }}"""


@pytest.mark.parametrize("start", ["", "(q0 = 5)"])
def test_a_storage_is_integrated_where_nothing_else_computes_it(start: str) -> None:
    """One of two springs on one mass has only its speed: without a start, differentiate all."""
    c = compiled(TWO_SPRINGS.format(start=start))

    def by_hand(m, K1, K2, F, y):
        return D(F) - m * D(y, 2) - (K1 + K2) * y

    params = {"m": Q(2), "K1": Q(10), "K2": Q(3)}
    assert is_multiple(c.residuals[0], by_hand, params, ("F", "y"))


def test_what_is_nominally_zero_is_not_divided_by() -> None:
    """A leak of nothing stays a fault, and the relation has a value without it."""
    c = compiled(
        """model Tank {
        param leak = 0; param C = 2; param Rv = 3
        Sf:Q -> 0:t
        t { -> C:C; -> R:leak { f = leak*e }; -> out; -> De:p }
        1:out { -> R:Rv; -> Df:q }
        }"""
    )
    relations = {
        "mass": lambda leak, C, Rv, Q, p, q: Q - C * D(p) - leak * p - q,
        "valve": lambda leak, C, Rv, Q, p, q: p - Rv * q,
        "mass by pressure": lambda leak, C, Rv, Q, p, q: Q - C * D(p) - leak * p - p / Rv,
    }
    params = {"leak": Q(0), "C": Q(2), "Rv": Q(3)}
    found = [
        name
        for relation in c.residuals
        for name, by_hand in relations.items()
        if is_multiple(relation, by_hand, params, ("Q", "p", "q"))
    ]
    assert len(c.residuals) == len(found) == 2
    assert any(c.signatures.row("leak"))


def test_unknown_inputs_cost_a_relation_each() -> None:
    c = compiled(
        """model M {
        input d unknown
        param m = 2; param b = 3
        Se:F -> 1:v
        v { <- Se:d; -> I:m; -> R:b; -> Df:y1; -> Df:y2 }
        }"""
    )
    assert len(c.residuals) == 1
    assert is_multiple(c.residuals[0], lambda y1, y2, **_: y1 - y2, {}, ("y1", "y2"))
    assert set(c.signatures.undetectable) == {"m", "b", "F"}


def test_a_quadratic_law_is_turned_around() -> None:
    """The drag's speed follows from its force: f = sign(e) sqrt(|e|/k)."""
    c = compiled(
        """model D {
        param k = 2; param m = 3; param m2 = 5
        Se:F -> 1:v1
        v1 { -> I:m; -> j }
        0:j { -> 1:vd; -> 1:v2 }
        vd -> R:drag { e = k*f*abs(f) }
        v2 { -> I:m2; -> Df:y }
        }"""
    )

    def by_hand(k, m, m2, F, y):
        force = m2 * D(y)
        return F - force - m * D(y + sp.sign(force) * sp.sqrt(sp.Abs(force) / k))

    params = {"k": Q(2), "m": Q(3), "m2": Q(5)}
    assert is_multiple(c.residuals[0], by_hand, params, ("F", "y"))


def test_a_nonlinear_loop_names_its_elements() -> None:
    c = compiled(
        """model L {
        param L1 = 1
        Se:U -> 1:i
        i { -> I:L1; -> Df:y; -> a }
        0:a { -> R:r1 { e = 0.1*f + sin(f) }; -> b }
        1:b { -> R:r2 { e = 0.1*f + sin(f) }; -> c }
        0:c { -> R:r3 { e = 0.1*f + sin(f) }; -> d }
        1:d { -> R:r4 { e = 0.1*f + sin(f) } }
        }"""
    )
    with pytest.raises(CompileError) as caught:
        _ = c.residuals
    [error] = [d for d in caught.value.diagnostics if d.severity == "error"]
    assert error.code == "loop-unsolvable"
    assert all(f"`r{k}`" in error.message for k in (1, 2, 3, 4))


def test_a_limited_command_that_is_logged_is_not_turned_round() -> None:
    """Two laws hold its value; at the limit it does not tell what was limited."""
    c = compiled(
        """model M { param R = 3; param L = 2; param k = 2; param ci = 5
        input r
        0:integ { -> C:ci(q0 = 0); <- Sf:into = r - k*u }
        let u = max(min(integ.e, 5), -5)
        1:a { <- Se:amp = u; -> R:R; -> I:L; -> Df:y }
        sensor logged = u
        sensor again = u }"""
    )
    texts = {relation.text for relation in c.residuals}
    limited = "logged - max(min(Int(r - k*logged)/ci, 5), -5)"
    assert texts in ({"logged - R*y - L*D(y)", limited, sign} for sign in
                     ("again - logged", "logged - again"))  # fmt: skip
    assert not c.residuals.missing


@pytest.mark.parametrize(
    ("gauge", "flow", "pressure"),
    [
        ("over", "kv*gauge", "pa + gauge"),
        ("2*over", "kv*((2*pa + gauge)/2 - pa)", "pa + gauge/2"),
    ],
)
def test_a_function_is_measured_by_a_multiple_of_it_beside_a_constant(
    gauge: str, flow: str, pressure: str
) -> None:
    """What boils off is told by the pressure, and not by the temperature that follows from it.

    The pressure gives that, T = 1/(1/T0 - log(p/p0)/L).
    """
    c = compiled(
        f"""model M {{ param p0 = 2; param pa = 1; param kv = 0.3; param C = 4; input q
        const T0 = 3; const L = 6
        let over = p0*exp(L*(1/T0 - 1/heat.e)) - pa
        0:heat {{ <- Sf:q; -> C:C; -> Sf:steam = kv*over }}
        sensor gauge = {gauge} }}"""
    )
    (relation,) = c.residuals
    assert relation.text == f"q - {flow} - C*D(1/(1/T0 - log(({pressure})/p0)/L))"


def test_a_sensor_tells_a_variable_before_a_law_of_many_parameters_does() -> None:
    """Either gives the temperature in one step; the law does with the errors of three parameters.

    So it is what is left to compare with the other sensor.
    """
    c = compiled(
        """model M { param E = 1.5; param k = 1e-3; param r = 2; param C = 4; param G = 5; input I
        0:heat { <- Sf:losses = I*(E - k*heat.e); -> C:C; -> R:R { f = G*e }; -> De:T }
        sensor V = E - k*heat.e + r*I }"""
    )
    texts = {relation.text for relation in c.residuals}
    assert texts == {"I*(E - k*T) - G*T - C*D(T)", "V + k*T - E - r*I"}


@pytest.mark.parametrize(
    ("reads", "a"),
    [("der(body.f)", "a"), ("der(body.f)/2 + 3", "2*(a - 3)"), ("-der(body.f)", "-a")],
)
def test_accelerometers_tell_what_acts_on_masses(reads: str, a: str) -> None:
    """Two masses and a moved end: m a = k x + b x', and x'' = z'' - (m a + M c)''/K - a.

    Without them the end is four derivatives of the spring away.
    """
    c = compiled(
        f"""model M {{ param m = 3; param M = 2; param k = 5; param b = 2; param K = 7; input z
        0:tyre {{ <- Sf:end = der(z); -> C:tyre_spring = 1/K; -> wheel }}
        1:wheel {{ -> I:M; -> strut }}
        0:strut {{ -> tie; -> body }}
        1:tie {{ -> C:spring = 1/k; -> R:b }}
        1:body {{ -> I:m }}
        sensor x = spring.q
        sensor a = {reads}
        sensor c = der(wheel.f) }}"""
    )
    acceleration = {"a": lambda a: a, "2*(a - 3)": lambda a: 2 * (a - 3), "-a": lambda a: -a}[a]
    params = {"m": Q(3), "M": Q(2), "k": Q(5), "b": Q(2), "K": Q(7)}

    def body(m, M, k, b, K, z, x, a, c):
        return m * acceleration(a) - k * x - b * D(x)

    def wheel(m, M, k, b, K, z, x, a, c):
        return c - D(z, 2) + D(m * acceleration(a) + M * c, 2) / K

    def spring(m, M, k, b, K, z, x, a, c):
        return acceleration(a) + D(x, 2) - D(z, 2) + D(m * acceleration(a) + M * c, 2) / K

    found = list(c.residuals)
    assert len(found) == 3
    for one in (body, wheel, spring):
        assert any(is_multiple(r, one, params, ("z", "x", "a", "c")) for r in found), str(found)


@pytest.mark.parametrize("law", ["e = k*q + u", "e = k*(1 + u)*q", "e = k*q + q^3", "e = k*q + 4"])
def test_a_rate_is_none_of_what_a_storage_holds_by_a_law_that_moves(law: str) -> None:
    """Its relations hold all the same, whatever they are made of."""
    c = compiled(
        f"""model M {{ param k = 2; param m = 3; param G = 5; input u; input i
        0:node {{ <- Sf:i; -> C:store {{ {law} }}; -> R:leak {{ f = G*e }}; -> line }}
        1:line {{ -> I:m; -> R:b = 4; -> Df:flow }}
        sensor rate = der(node.e)
        sensor e = node.e
        sensor pull = der(line.f) }}"""
    )
    assert c.verification.method.startswith("exact") and len(c.residuals) == 4


@pytest.mark.parametrize("friction", ["", "; -> R:b"])
def test_an_accelerometer_costs_no_isolability(friction: str) -> None:
    """In the balance of the one mass it would be in both relations, as the position is.

    And with w = (T - J a)/c for the derivative of the angle both relations would have the friction.
    """
    c = compiled(
        f"""model M {{ param J = 3; param k = 2; param b = 1; input T
        1:shaft {{ <- Se:T; -> I:J; -> C:spring = 1/k{friction} }}
        sensor angle = spring.q
        sensor a = der(shaft.f) }}"""
    )
    assert "a - D(angle, 2)" in {relation.text for relation in c.residuals}
    sees = [c.signatures.signature(relation.name) for relation in c.residuals]
    assert [("angle" in own, "a" in own) for own in sorted(sees, key=len)] == [
        (True, True), (True, False)
    ]  # fmt: skip


@pytest.mark.parametrize(("rear", "cancels"), [(Q(27, 10), True), (Q(1, 2), False)])
def test_no_difference_that_nearly_cancels_is_divided_by(rear: Q, cancels: bool) -> None:
    """A car on two wheels: by the yaw alone the side force in front is over a/b - Cr/Cf.

    By the accelerometer as well it is over the wheelbase, and the car may be neutral: of
    m ay = -F - G and J r' = b G - a F, G = (J r' - a m ay)/(a + b).
    """
    c = compiled(
        f"""model M {{
        param m = 1.2; param J = 0.9; param a = 0.8; param b = 1.1; param Cf = 2.3
        param Cr = {float(rear)}; input delta; input u
        1:side {{ -> I:m; <- Se:turn = -m*u*yaw.f; -> front; -> rear }}
        1:yaw {{ -> I:J; -> Df:r }}
        yaw -> TF:fa {{ f2 = a*f1 }} -> front
        yaw -> TF:ra {{ f2 = -b*f1 }} -> rear
        0:front {{ -> R:tf {{ e = Cf*(f/u - delta) }} }}
        0:rear {{ -> R:tr {{ e = Cr*f/u }} }}
        sensor ay = der(side.f) + u*yaw.f }}"""
    )
    params = {"m": Q(6, 5), "J": Q(9, 10), "a": Q(4, 5), "b": Q(11, 10), "Cf": Q(23, 10)}
    params["Cr"] = rear

    def force(m, J, a, b, Cf, Cr, delta, u, r, ay):
        behind = (J * D(r) - a * m * ay) / (a + b)
        ahead = -m * ay - behind
        return behind - Cr * (u * (ahead / Cf + delta) - a * r - b * r) / u

    signals = ("delta", "u", "r", "ay")
    relations = list(c.residuals)
    found = [is_multiple(relation, force, params, signals) for relation in relations]
    assert any(found) == cancels
    assert sorted(relation.orders["r"] for relation in relations) == ([1, 2] if cancels else [2, 2])


def test_a_measured_function_stays_unsolved_where_it_is_made_of_more() -> None:
    """Anti-windup by back-calculation: what was limited is used beside the limited value."""
    c = compiled(
        """model M { param R = 3; param L = 2; param kb = 1
        input r
        0:integ { -> C:ci(q0 = 0) = 1; <- Sf:into = r - y - kb*(u - us) }
        let u = 4*integ.e
        let us = max(min(u, 5), -5)
        1:a { <- Se:amp = us; -> R:R; -> I:L; -> Df:y }
        sensor logged = us }"""
    )
    assert [relation.text for relation in c.residuals] == ["logged - R*y - L*D(y)"]
    assert [m.finding.code for m in c.residuals.missing] == ["loop-unsolvable"]


@pytest.mark.parametrize(
    ("force", "known"),
    [
        ("int(T)", "Int(T)"),
        ("T*sin(int(T))", "T*sin(Int(T))"),
        ("int(int(T) + T)", "Int(T + Int(T))"),
    ],
)
def test_known_integrals_beside_a_differential_loop(force: str, known: str) -> None:
    """m a = F - c v |v|, and a = v': with v from the first one, whatever F is made of."""
    c = compiled(
        f"""model M {{ param m = 3; param c = 0.5; input T
        1:x {{ <- Se:F = {force}; -> I:mx = m; -> R:d {{ e = c*f*abs(f) }} }}
        sensor a = der(x.f) }}"""
    )
    assert [relation.text for relation in c.residuals] == [f"a - D(ssqrt(({known} - m*a)/c))"]


def test_a_linear_loop_with_moving_coefficients_is_not_called_nonlinear() -> None:
    """A counterflow exchanger of five cells, with measured flows: T' = m (T1 - T) + k (t - T)."""
    cells = range(1, 6)
    lines = [f"0:h{k} {{ -> C:Ch{k} = 0.4 }}\n0:c{k} {{ -> C:Cc{k} = 0.5 }}" for k in cells]
    lines += [f"1:w{k} {{ <- h{k}; -> c{k}; -> R:r{k} = 1.7 }}" for k in cells]
    lines += [f"Sf:a{k} = m*({f'h{k - 1}.e' if k > 1 else 'Th'} - h{k}.e) -> h{k}" for k in cells]
    lines += [f"Sf:b{k} = n*({f'c{k + 1}.e' if k < 5 else 'Tc'} - c{k}.e) -> c{k}" for k in cells]
    inputs = "input m; input n; input Th; input Tc"
    text = "\n".join([f"model M {{ {inputs}", *lines, "De:y <- h5", "De:z <- c1", "}"])
    with pytest.raises(CompileError) as caught:
        _ = compiled(text).residuals
    [error] = {d.message: d for d in caught.value.diagnostics if d.severity == "error"}.values()
    assert error.code == "loop-too-large"
    assert "linear loop" in error.message and "nonlinear" not in error.message


def test_a_start_inside_a_nonlinear_law_must_be_declared() -> None:
    text = """model M {{
        param m = 2
        Se:F -> 1:v
        v {{ -> I:m; -> C:s{start} {{ e = q + 2*sin(q) }}; -> Df:y }}
        }}"""
    with pytest.raises(CompileError) as caught:
        _ = compiled(text.format(start="")).residuals
    assert [d.code for d in caught.value.diagnostics if d.severity == "error"] == [
        "initial-value-needed"
    ]
    assert len(compiled(text.format(start="(q0 = 1)")).residuals) == 1


def test_the_start_of_a_field_is_asked_for_at_its_port() -> None:
    """A plate on a spring, with a charge that its voltage does not tell, and its velocity known."""
    text = """model M {{
        param k = 2
        input drive unknown
        C:top({start}m.q0 = 0) {{ port el; port m; el.e = (el.q + 2*sin(el.q))*(3 - m.q);
            m.e = -el.q^2/2 + cos(el.q) + k*m.q }}
        Se:V -> 1:c -> top.el
        c {{ -> R:r = 2; -> Df:i }}
        1:mass {{ <- Se:drive; -> top.m; -> I:J = 1; -> Df:w }}
        }}"""
    with pytest.raises(CompileError) as caught:
        _ = compiled(text.format(start="")).residuals
    [error] = [d for d in caught.value.diagnostics if d.severity == "error"]
    assert error.code == "initial-value-needed" and "`(el.q0 = 0)`" in error.help
    assert compiled(text.format(start="el.q0 = 1, ")).residuals


def binary_tree(depth: int) -> str:
    """A supply that branches into 2**depth motors over wires, the speed of each measured."""
    lines = ["param R = 2; param L = 1e-3; param k = 0.05; param J = 1e-4; param Rw = 0.1",
             "Se:U -> 0:n1"]  # fmt: skip
    for i in range(2, 2 ** (depth + 1)):
        lines.append(f"0:n{i}; 1:w{i} {{ <- n{i // 2}; -> R:r{i} = Rw; -> n{i} }}")
        if i >= 2**depth:
            lines.append(f"1:a{i} {{ <- n{i}; -> R:R{i} = R; -> I:L{i} = L }}")
            lines.append(f"a{i} -> GY:k{i} = k -> 1:s{i} {{ -> I:J{i} = J; -> Df:y{i} }}")
    return "model Tree {\n" + "\n".join(lines) + "\n}"


def test_relations_of_a_tree_are_local() -> None:
    """Two motors on one node have the same voltage: half of the relations need no other motor.

    A quarter compares two nodes and so four motors, and so on. Each is of second order whichever
    way it is made, as the voltage of a motor holds J L w''/k.
    """
    depth = 7
    c = compiled(binary_tree(depth))
    assert len(c.residuals) == 2**depth
    sensors = sorted(sum(name.startswith("y") for name in r.orders) for r in c.residuals)
    inner = [2 ** (k + 1) for k in range(depth - 1) for _ in range(2 ** (depth - 1 - k))]
    assert sensors == [*inner, 2 ** (depth - 1), 2 ** (depth - 1)]  # the supply is known
    assert all(max(r.orders.values()) == 2 for r in c.residuals)
