"""Fluids, heat, laws, switches, redundancy and language, with the physics by hand."""

from __future__ import annotations

from tests.adversary.plant import Plant, model

PLANTS = [
    Plant(
        "three_tanks",
        model("three_tanks"),
        equations=(
            "Q - D(q1) - l1*ssqrt(p1) - f12; f12 - k12*ssqrt(p1-p2); f12 - D(q2) - f23; "
            "f23 - D(q3) - ko*ssqrt(p3) - l3*ssqrt(p3); q1 - A1*p1; q2 - A2*p2; q3 - A3*p3; "
            "f23 - k23*ssqrt(p2-p3)"
        ),
        sensors={"p1": "p1", "p3": "p3"},
        n_arr=2,
        params="A1 A2 A3 k12 k23 ko l1 l3",
        inputs="Q",
        values={"p1": 4.0, "p2": 2.5, "p3": 1.2, "l1": 0, "l3": 0},
    ),
    Plant(
        "three_tanks_e",
        model("three_tanks_e"),
        equations=(
            "Q - D(q1) - l1*ssqrt(p1) - f12; f12 - k12*ssqrt(p1-p2); f12 - D(q2) - f23; "
            "f23 - D(q3) - ko*ssqrt(p3) - l3*ssqrt(p3); q1 - A1*p1; q2 - A2*p2; q3 - A3*p3; "
            "p2 - p3 - k23*f23*abs(f23)"
        ),
        sensors={"p1": "p1", "p3": "p3"},
        n_arr=2,
        params="A1 A2 A3 k12 k23 ko l1 l3",
        inputs="Q",
        values={"p1": 4.0, "p2": 2.5, "p3": 1.2, "l1": 0, "l3": 0},
    ),
    Plant(
        "three_tanks_implicit",
        model("three_tanks_implicit"),
        equations=(
            "Q - D(q1) - l1*ssqrt(p1) - f12; f12 - k12*ssqrt(p1-p2); f12 - D(q2) - f23; "
            "f23 - D(q3) - ko*ssqrt(p3) - l3*ssqrt(p3); q1 - A1*p1; q2 - A2*p2; q3 - A3*p3; "
            "p2 - p3 - k23*f23*abs(f23)"
        ),
        sensors={"p1": "p1", "p3": "p3"},
        n_arr=2,
        params="A1 A2 A3 k12 k23 ko l1 l3",
        inputs="Q",
        values={"p1": 4.0, "p2": 2.5, "p3": 1.2, "l1": 0, "l3": 0},
    ),
    Plant(
        "three_tanks_all",
        model("three_tanks_all"),
        equations=(
            "Q - D(q1) - l1*ssqrt(p1) - f12; f12 - k12*ssqrt(p1-p2); f12 - D(q2) - f23; "
            "f23 - D(q3) - ko*ssqrt(p3) - l3*ssqrt(p3); q1 - A1*p1; q2 - A2*p2; q3 - A3*p3; "
            "p2 - p3 - k23*f23*abs(f23)"
        ),
        sensors={"p1": "p1", "p3": "p3", "p2": "p2"},
        n_arr=3,
        params="A1 A2 A3 k12 k23 ko l1 l3",
        inputs="Q",
        values={"p1": 4.0, "p2": 2.5, "p3": 1.2, "l1": 0, "l3": 0},
    ),
    Plant(
        "three_tanks_level3",
        model("three_tanks_level3"),
        equations=(
            "Q - D(q1) - l1*ssqrt(p1) - f12; f12 - k12*ssqrt(p1-p2); f12 - D(q2) - f23; "
            "f23 - D(q3) - ko*ssqrt(p3) - l3*p3; q1 - A1*p1; q2 - A2*p2; q3 - A3*p3; "
            "f23 - k23*ssqrt(p2-p3)"
        ),
        sensors={"p3": "p3"},
        n_arr=1,
        params="A1 A2 A3 k12 k23 ko l1 l3",
        inputs="Q",
        values={"p1": 4.0, "p2": 2.5, "p3": 1.2, "l1": 0, "l3": 0},
    ),
    Plant(
        "three_tanks_Qunknown",
        model("three_tanks_Qunknown"),
        equations=(
            "Q - D(q1) - l1*ssqrt(p1) - f12; f12 - k12*ssqrt(p1-p2); f12 - D(q2) - f23; "
            "f23 - D(q3) - ko*ssqrt(p3) - l3*ssqrt(p3); q1 - A1*p1; q2 - A2*p2; q3 - A3*p3; "
            "f23 - k23*ssqrt(p2-p3)"
        ),
        sensors={"p1": "p1", "p3": "p3"},
        n_arr=1,
        params="A1 A2 A3 k12 k23 ko l1 l3",
        unknown="Q",
        values={"p1": 4.0, "p2": 2.5, "p3": 1.2, "l1": 0, "l3": 0},
        undetectable="A1 l1",
    ),
    Plant(
        "cylinder",
        model("cylinder"),
        equations=(
            "fin - kv*x*ssqrt(ps - p1); fin - D(q1) - A1*v - kl*(p1-p2); q1 - V1*p1; "
            "A2*v + kl*(p1-p2) - D(q2) - kr*ssqrt(p2); q2 - V2*p2; "
            "A1*p1 - A2*p2 - D(p) - b*v - load; p - m*v"
        ),
        sensors={"p1": "p1", "p2": "p2", "v": "v"},
        n_arr=2,
        params="A1 A2 m b V1 V2 kl kv kr",
        inputs="x ps",
        unknown="load",
        values={"ps": 5, "p1": 3, "p2": 1, "x": 1},
        undetectable="m b",
    ),
    Plant(
        "heat_exchanger",
        model("heat_exchanger"),
        equations=(
            "mh*cp*(Thi - h) - D(qh) - UA*(h-c); mc*cp*(Tci-c) + UA*(h-c) - D(qc); "
            "qh - Ch*h; qc - Cc*c"
        ),
        sensors={"Th": "h", "Tc": "c"},
        n_arr=2,
        params="UA Ch Cc cp",
        inputs="mh mc Thi Tci",
    ),
    Plant(
        "thermofluid",
        model("thermofluid"),
        equations=(
            "Q - D(V) - kv*ssqrt(h); V - A*h; "
            "c*Q*Ti + P - D(E) - c*kv*ssqrt(h)*T - ka*(T-Ta); E - c*V*T"
        ),
        sensors={"h": "h", "T": "T"},
        n_arr=2,
        params="A kv c ka",
        inputs="Q Ti P",
        consts={"Ta": 0.3},
    ),
    Plant(
        "chemical",
        model("chemical"),
        equations=("D(qa) - feed + v; D(qb) - v; v - r*(k1*qa - k2*qb)"),
        sensors={"ca": "qa"},
        n_arr=1,
        params="k1 k2 r",
        inputs="feed",
        starts={"qa": "1.2", "qb": "0.7"},
        consts={"RT": 2.4},
    ),
    Plant(
        "chemical_free",
        model("chemical_free"),
        equations=("D(qa) - feed + v; D(qb) - v; v - r*(k1*qa - k2*qb)"),
        sensors={"ca": "qa"},
        n_arr=1,
        params="k1 k2 r",
        inputs="feed",
        consts={"RT": 2.4},
    ),
    Plant(
        "michaelis",
        model("michaelis"),
        equations=("feed - D(s) - vm*s/(km + s)"),
        sensors={"y": "s"},
        n_arr=1,
        params="km vm",
        inputs="feed",
    ),
    Plant(
        "buck_duty",
        model("buck_duty"),
        equations=("a*U - D(p) - RL*i - u; p - L*i; i - D(q) - u/R; q - C*u"),
        sensors={"u": "u", "i": "i"},
        n_arr=2,
        params="L C R RL",
        inputs="U a",
    ),
    Plant(
        "boost_duty",
        model("boost_duty"),
        equations=("U - D(p) - (1-a)*u; p - L*i; (1-a)*i - D(q) - u/R; q - C*u"),
        sensors={"u": "u"},
        n_arr=1,
        params="L C R",
        inputs="U a",
    ),
    Plant(
        "boost_duty_i",
        model("boost_duty_i"),
        equations=("U - D(p) - (1-a)*u; p - L*i; (1-a)*i - D(q) - u/R; q - C*u"),
        sensors={"i": "i"},
        n_arr=1,
        params="L C R",
        inputs="U a",
    ),
    Plant(
        "buck_bool",
        model("buck_bool"),
        equations=("where(on, 1, 0)*U - D(p) - u; p - L*i; i - D(q) - u/R; q - C*u"),
        sensors={"u": "u", "i": "i"},
        n_arr=2,
        params="L C R",
        inputs="U",
        modes="on",
    ),
    Plant(
        "switch_r",
        model("switch_r"),
        equations=("where(on, U - R*i - u, i); i - D(q) - u/R2; q - C*u"),
        sensors={"u": "u"},
        n_arr=1,
        params="C R R2",
        inputs="U",
        modes="on",
    ),
    Plant(
        "switched_junction",
        model("switched_junction"),
        equations=("where(on, U - R*i - u, i); i - D(q) - u/R2; q - C*u"),
        sensors={"u": "u"},
        n_arr=1,
        params="C R R2",
        inputs="U",
        modes="on",
    ),
    Plant(
        "switched_zero",
        model("switched_zero"),
        equations=("where(on, Q - u/R2 - i, u); u - R*i - D(p); p - L*i"),
        sensors={"i": "i"},
        n_arr=1,
        params="L R R2",
        inputs="Q",
        modes="on",
    ),
    Plant(
        "clutch",
        model("clutch"),
        equations=(
            "T - D(p1) - d*a - tm; p1 - J1*a; tm - D(p2) - c*b; p2 - J2*b; a - b - s; "
            "where(on, tm - kc*s, s)"
        ),
        sensors={"w1": "a", "w2": "b"},
        n_arr=2,
        params="J1 J2 c d kc",
        inputs="T",
        modes="on",
    ),
    Plant(
        "diode",
        model("diode"),
        equations=("i - Is*(exp((U-u)/vt) - 1); i - D(q) - u/R; q - C*u"),
        sensors={"u": "u"},
        n_arr=1,
        params="Is vt C R",
        inputs="U",
    ),
    Plant(
        "diode_i",
        model("diode_i"),
        equations=("i - Is*(exp((U-u)/vt) - 1); i - D(q) - u/R; q - C*u"),
        sensors={"i": "i"},
        n_arr=1,
        params="Is vt C R",
        inputs="U",
        values={"Is": 0.5},
    ),
]
