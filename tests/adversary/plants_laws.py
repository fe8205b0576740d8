"""Laws, switches, redundancy and language, with the physics by hand."""

from __future__ import annotations

from tests.adversary.plant import Plant, model

PLANTS = [
    Plant(
        "diode_series_r",
        model("diode_series_r"),
        equations=("i - Is*(exp((U-Rs*i)/vt) - 1)"),
        sensors={"i": "i"},
        n_arr=1,
        params="Is vt Rs",
        inputs="U",
    ),
    Plant(
        "diode_loop",
        model("diode_loop"),
        equations=(
            "i - Is*(exp((U-Rs*i - u)/vt) - 1); i - D(q) - u/R - j; j - (u-z)/R; j - D(q2); "
            "q2 - C*z; q - C*u"
        ),
        sensors={"y": "z"},
        n_arr=1,
        params="Is vt Rs C R",
        inputs="U",
    ),
    Plant(
        "stribeck",
        model("stribeck"),
        equations=("F - D(p) - (Fc + (Fs-Fc)*exp(-(v/vs)**2))*sign(v) - b*v; p - m*v"),
        sensors={"y": "v"},
        n_arr=1,
        params="m Fc Fs vs b",
        inputs="F",
        values={"v": 1.5, "p": 1.5, "m": 1.0, "vs": 1.5},
    ),
    Plant(
        "saturation",
        model("saturation"),
        equations=("max(-um, min(um, k*u)) - D(p) - R*i; p - L*i"),
        sensors={"y": "i"},
        n_arr=1,
        params="L R k",
        inputs="u",
        values={"u": 0.3},
        consts={"um": 1.1},
    ),
    Plant(
        "table_law",
        model("table_law"),
        equations=("U - D(p) - R*i - where(i < 1, i, 2*i - 1); p - L*i"),
        sensors={"y": "i"},
        n_arr=1,
        params="L R",
        inputs="U",
        values={"i": 1.4},
    ),
    Plant(
        "cubic_law",
        model("cubic_law"),
        equations=("U - y - a*i - b*i**3; i - D(q); q - C*y"),
        sensors={"y": "y"},
        n_arr=1,
        params="C a b",
        inputs="U",
        values={"U": 2.5, "i": 1.2},
    ),
    Plant(
        "cubic_parallel",
        model("cubic_parallel"),
        equations=(
            "U - n - a*i - b*i**3; i - n/R - j; n - m - a*j - b*j**3; j - D(q) - m/R - m/2; q - C*m"
        ),
        sensors={"y": "i"},
        n_arr=1,
        params="C a b R",
        inputs="U",
    ),
    Plant(
        "redundant_df",
        model("redundant_df"),
        equations=("U - D(p) - R*i; p - L*i"),
        sensors={"y": "i", "y1": "i"},
        n_arr=2,
        params="L R",
        inputs="U",
    ),
    Plant(
        "de_on_se",
        model("de_on_se"),
        equations=("n - U"),
        sensors={"y": "n"},
        n_arr=1,
        params="R",
        inputs="U",
        undetectable="R",
    ),
    Plant(
        "three_df",
        model("three_df"),
        equations=("U - R1*a - n; n - R2*b; n - R3*c; a - b - c"),
        sensors={"ya": "a", "yb": "b", "yc": "c"},
        n_arr=3,
        params="R1 R2 R3",
        inputs="U",
    ),
    Plant(
        "rigid_both",
        model("rigid_both"),
        equations=("a - N*b; N*T - D(p) - f*b; p - J*b"),
        sensors={"ya": "a", "yb": "b"},
        n_arr=1,
        params="N J f",
        unknown="T",
        undetectable="J f",
    ),
    Plant(
        "sensors_odd",
        model("sensors_odd"),
        equations=("U - D(p) - R*i - u; p - L*i; i - D(q); q - C*u; D(w) - i*i*R"),
        sensors={"u": "u", "P": "i*u", "E": "w", "Q": "q"},
        n_arr=4,
        params="C R L",
        inputs="U",
        starts={"q": "0.2", "w": "0"},
    ),
    Plant(
        "backlash_tanh",
        model("backlash_tanh"),
        equations=(
            "T - D(p1) - tm; p1 - J1*a; tm - K*(q - t0*tanh(q/t0)); D(q) - a + b; "
            "tm - D(p2) - f*b; p2 - J2*b"
        ),
        sensors={"w1": "a", "w2": "b"},
        n_arr=2,
        params="J1 J2 K t0 f",
        inputs="T",
        starts={"q": "0"},
    ),
    Plant(
        "slider_theta",
        model("slider_theta"),
        equations=(
            "T - D(p) - fr; p - J*w; D(th) - w; v + r*sin(th)*w; D(pp) + c*v - e2; pp - m*v; "
            "fr + r*sin(th)*e2; D(x) - v"
        ),
        sensors={"pos": "th", "x": "x"},
        n_arr=2,
        params="J m r c",
        inputs="T",
        starts={"th": "0.7", "x": "r*0.7648421872844885"},
    ),
    Plant(
        "double_mtf",
        model("double_mtf"),
        equations=(
            "D(a) - w1; D(b) - w2; x1 - l1*cos(a)*w1; z1 - l1*sin(a)*w1; "
            "x2 - x1 - l2*cos(b)*w2; z2 - z1 - l2*sin(b)*w2; p1 - m1*x1; p2 - m1*z1; "
            "p3 - m2*x2; p4 - m2*z2; ex - D(p3); ez - D(p4) - m2*g; fx - D(p1) - ex; "
            "fz - D(p2) - m1*g - ez; T1 - l1*cos(a)*fx - l1*sin(a)*fz; "
            "T2 - l2*cos(b)*ex - l2*sin(b)*ez"
        ),
        sensors={"y1": "w1", "y2": "w2"},
        n_arr=2,
        params="m1 m2 l1 l2",
        inputs="T1 T2",
        starts={"a": "0.3", "b": "0.5"},
        consts={"g": 9.81},
    ),
    Plant(
        "alias",
        model("alias"),
        equations=(
            "U - D(p) - n; p - L*i; i - a - b; n - Q*a - s1__Z*a + 2*h; n - Q/2*b - 3*b + h*i"
        ),
        sensors={"y": "i"},
        n_arr=1,
        params="Q L s1__Z",
        inputs="U h",
    ),
    Plant(
        "alias_sensor",
        model("alias_sensor"),
        equations=("U - D(p) - i + c__kp*(goal - c__y) + c__d; p - L*i"),
        sensors={"c__y": "i", "e": "goal - c__y"},
        n_arr=2,
        params="c__kp L c__d",
        readings="c__y",
        inputs="U goal",
    ),
    Plant(
        "arrays",
        model("arrays"),
        equations=(
            "U - n1 - Rs__1*i1; i1 - D(q1) - i2; q1 - c__1__C*n1; n1 - n2 - Rs__2*i2; "
            "i2 - D(q2) - i3; q2 - c__2__C*n2; n2 - n3 - Rs__3*i3; i3 - D(q3) - n3/Rl; "
            "q3 - (c__3__C + 0.3)*n3"
        ),
        sensors={"y": "n3"},
        n_arr=1,
        params="Rs__1 Rs__2 Rs__3 c__1__C c__2__C c__3__C Rl",
        inputs="U",
    ),
    Plant(
        "symbolic",
        model("symbolic"),
        equations=("U - D(p) - R*i - q/C; p - L*i; D(q) - i"),
        sensors={"y": "i"},
        n_arr=1,
        params="L R C",
        inputs="U",
    ),
    Plant(
        "two_unknown",
        model("two_unknown"),
        equations=(
            "d1 - D(q1) - (a-b)/R1 - (a+U)/1; q1 - C1*a; d2 + (a-b)/R1 - D(q2) - (b-c)/R2; "
            "q2 - C2*b; (b-c)/R2 - c/R3"
        ),
        sensors={"ya": "a", "yb": "b", "yc": "c"},
        n_arr=1,
        params="R1 R2 C1 C2 R3",
        inputs="U",
        unknown="d1 d2",
        undetectable="R1 C1 C2 U ya",
    ),
    Plant(
        "unknown_same_place",
        model("unknown_same_place"),
        equations=("d1 + d2 - D(q) - a/R; q - C*a"),
        sensors={"ya": "a", "yb": "a"},
        n_arr=1,
        params="R C",
        unknown="d1 d2",
        undetectable="R C",
    ),
    Plant(
        "c_se_dependent",
        model("c_se_dependent"),
        equations=(
            "i - D(q1) - j - 0.4*Ud; q1 - C1*U; U - R*j - b; j - D(q2); q2 - C2*b; "
            "D(u2) - Ud; u2 - U"
        ),
        sensors={"i": "i"},
        n_arr=1,
        params="C1 C2 R",
        inputs="U",
    ),
    Plant(
        "inverse_and_spring",
        model("inverse_and_spring"),
        equations=("F - D(p) - q/c; y - p/i - p**3; D(q) - y"),
        sensors={"y": "y"},
        n_arr=1,
        params="i c",
        inputs="F",
        starts={"p": "0.5", "q": "0.2"},
    ),
]
