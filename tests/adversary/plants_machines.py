"""Converters, drives, vehicles and plants as textbooks have them, with the physics by hand."""

from __future__ import annotations

from tests.adversary.plant import Plant, model

PLANTS = [
    Plant(
        "cuk",
        model("cuk"),
        equations=(
            "U - L1*D(j) - (1-d)*m; (1-d)*j - C1*D(m) - d*k; d*m - L2*D(k) - v; k - C2*D(v) - v/R"
        ),
        sensors={"i1": "j", "u": "v"},
        n_arr=2,
        params="L1 L2 C1 C2 R",
        inputs="U d",
        values={"d": 0.4},
    ),
    Plant(
        "h_bridge",
        model("h_bridge"),
        equations=("where(fwd, E, -E) - L*D(j) - R*j - k*v; k*j - J*D(v) - f*v"),
        sensors={"i": "j", "w": "v"},
        n_arr=2,
        params="L R k J f",
        inputs="E",
        modes="fwd",
    ),
    Plant(
        "accumulator",
        model("accumulator"),
        equations=(
            "Q - Cl*D(a) - kc*max(a - b, 0); kc*max(a - b, 0) - D(x) - ko*ssqrt(b); "
            "b*(V0 - x) - p0*V0"
        ),
        sensors={"pl": "a", "pg": "b"},
        n_arr=2,
        params="p0 V0 kc ko Cl",
        inputs="Q",
        values={"V0": 2.1, "a": 2.6},
        starts={"x": "0.7"},
    ),
    Plant(
        "crane",
        model("crane"),
        equations=(
            "D(th) - s; vx - x - l*cos(th)*s; vz - l*sin(th)*s; px - m*vx; pz - m*vz; "
            "F - M*D(x) - b*x - D(px); l*cos(th)*D(px) + l*sin(th)*(D(pz) + m*g) + c*s"
        ),
        sensors={"v": "x", "angle": "th"},
        n_arr=2,
        params="M m l b c",
        inputs="F",
        starts={"th": "0.4"},
        consts={"g": 9.81},
    ),
    Plant(
        "planetary",
        model("planetary"),
        equations=(
            "Ts - Js*D(a) - rs*t; -Jr*D(b) - f*b - rr*t; (rs + rr)*t - Jc*D(c) - Tc; "
            "rs*a + rr*b - (rs + rr)*c"
        ),
        sensors={"ws": "a", "wc": "c"},
        n_arr=2,
        params="rs rr Js Jr Jc f",
        inputs="Ts Tc",
    ),
    Plant(
        "battery",
        model("battery"),
        equations=("D(x) + load; v - R0*(-load) - a*x - b*log(x) - h; -load - C1*D(h) - h/R1"),
        sensors={"u": "v"},
        n_arr=1,
        params="a b R0 R1 C1",
        inputs="load",
        starts={"x": "0.8"},
    ),
    Plant(
        "solar_cell",
        model("solar_cell"),
        equations=("light - Is*(exp(n/vt) - 1) - n/Rp - j; n - Rs*j - h; j - C*D(h) - G*h"),
        sensors={"i": "j", "v": "h"},
        n_arr=1,
        params="Is vt Rs Rp C G",
        unknown="light",
        undetectable="Is vt Rs Rp",
    ),
    Plant(
        "bicycle",
        model("bicycle"),
        equations=(
            "sf + Cf*((v + a*w)/u - delta); sr + Cr*(v - b*w)/u; m*D(v) + m*u*w - sf - sr; "
            "Jz*D(w) - a*sf + b*sr; q - D(v) - u*w"
        ),
        sensors={"r": "w", "ay": "q"},
        n_arr=2,
        params="m Jz a b Cf Cr",
        inputs="delta u",
    ),
    Plant(
        "bicycle_neutral",
        model("bicycle_neutral"),
        equations=(
            "sf + Cf*((v + a*w)/u - delta); sr + Cr*(v - b*w)/u; m*D(v) + m*u*w - sf - sr; "
            "Jz*D(w) - a*sf + b*sr; q - D(v) - u*w"
        ),
        sensors={"r": "w", "ay": "q"},
        n_arr=2,
        params="m Jz a b Cf Cr",
        inputs="delta u",
        values={"m": 1.2, "Jz": 0.9, "a": 0.8, "b": 0.8, "Cf": 2.3, "Cr": 2.3},
    ),
    Plant(
        "induction",
        model("induction"),
        equations=(
            "ua - Rs*sa - D(xa); ub - Rs*sb - D(xb); xa - Ls*sa - M*ra; xb - Ls*sb - M*rb; "
            "ya - M*sa - Lr*ra; yb - M*sb - Lr*rb; Rr*ra + D(ya) + yb*v; Rr*rb + D(yb) - ya*v; "
            "yb*ra - ya*rb - J*D(v) - f*v - load"
        ),
        sensors={"ia": "sa", "ib": "sb", "w": "v"},
        n_arr=3,
        params="Rs Rr Ls Lr M J f",
        inputs="ua ub load",
    ),
    Plant(
        "wind_turbine",
        model("wind_turbine"),
        equations=(
            "wind**2*(c1*Rw*a/wind - c2*(Rw*a/wind)**3) - J*D(a) - t; t - K*x - d*s; D(x) - s; "
            "s - a + b/N; t/N - Jg*D(b) - Tg"
        ),
        sensors={"w": "a", "wg": "b"},
        n_arr=1,
        params="J Rw c1 c2 K d Jg N",
        inputs="Tg",
        unknown="wind",
        undetectable="J Rw c1 c2",
    ),
    Plant(
        "motor_reversed",
        model("motor_reversed"),
        equations="-U - R*i - D(pL) + k*w; pL - L*i; T - k*i - D(pJ) - f*w; pJ - J*w",
        sensors={"yi": "i", "yw": "w"},
        n_arr=2,
        params="L R k J f",
        inputs="U T",
    ),
    Plant(
        "pmsm",
        model("pmsm"),
        equations=(
            "ud - R*a - L*D(a) + L*v*b; uq - R*b - L*D(b) - L*v*a - psi*v; "
            "psi*b - J*D(v) - f*v - load"
        ),
        sensors={"id": "a", "iq": "b", "w": "v"},
        n_arr=3,
        params="R L psi J f",
        inputs="ud uq load",
    ),
    Plant(
        "pmsm_park",
        model("pmsm_park"),
        equations=(
            "ua*cos(p*h) + ub*sin(p*h) - R*x - Ld*D(x) + p*v*Lq*y; "
            "ub*cos(p*h) - ua*sin(p*h) - R*y - Lq*D(y) - p*v*(Ld*x + psi); "
            "p*(psi + (Ld - Lq)*x)*y - J*D(v) - b*v - load; D(h) - v"
        ),
        sensors={
            "ia": "x*cos(p*h) - y*sin(p*h)",
            "ib": "x*sin(p*h) + y*cos(p*h)",
            "angle": "h",
        },
        n_arr=3,
        params="R Ld Lq psi p J b",
        inputs="ua ub load",
        starts={"h": "0.2"},
        undetectable="",
    ),
    Plant(
        "boiler",
        model("boiler"),
        equations=(
            "Q - D(x) - kv*ssqrt(y); x - A*y; c*Q*Tin + G*(b - a) - c*kv*ssqrt(y)*a - D(q); "
            "q - c*x*a; P - Cw*D(b) - G*(b - a)"
        ),
        sensors={"h": "y", "T": "a", "Tw": "b"},
        n_arr=2,
        params="A kv c G Cw",
        inputs="Q Tin",
        unknown="P",
        undetectable="Cw",
    ),
]
