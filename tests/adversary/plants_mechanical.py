"""Machines with their physics by hand."""

from __future__ import annotations

from tests.adversary.plant import Plant, model

PLANTS = [
    Plant(
        "rl_parallel_current",
        model("rl_parallel_current"),
        equations=("Q - ia - ib; un - R1*ia - D(pa); un - R2*ib - D(pb); pa - L1*ia; pb - L2*ib"),
        sensors={"yb": "ib"},
        n_arr=1,
        params="L1 L2 R1 R2",
        inputs="Q",
    ),
    Plant(
        "mutual",
        model("mutual"),
        equations=("U - R1*i1 - D(p1); -R2*i2 - D(p2); p1 - L1*i1 - M*i2; p2 - M*i1 - L2*i2"),
        sensors={"y1": "i1", "y2": "i2"},
        n_arr=2,
        params="L1 L2 M R1 R2",
        inputs="U",
    ),
    Plant(
        "mutual1",
        model("mutual1"),
        equations=("U - R1*i1 - D(p1); -R2*i2 - D(p2); p1 - L1*i1 - M*i2; p2 - M*i1 - L2*i2"),
        sensors={"y1": "i1"},
        n_arr=1,
        params="L1 L2 M R1 R2",
        inputs="U",
    ),
    Plant(
        "springs_matrix",
        model("springs_matrix"),
        equations=(
            "F - D(p1) - a*x - b*y; p1 - m1*v1; -D(p2) - b*x - c*y - d*v2; p2 - m2*v2; "
            "D(x) - v1; D(y) - v2"
        ),
        sensors={"s2": "v2"},
        n_arr=1,
        params="a b c m1 m2 d",
        inputs="F",
        starts={"x": "0", "y": "0"},
    ),
    Plant(
        "springs_matrix_free",
        model("springs_matrix_free"),
        equations=(
            "F - D(p1) - a*x - b*y; p1 - m1*v1; -D(p2) - b*x - c*y - d*v2; p2 - m2*v2; "
            "D(x) - v1; D(y) - v2"
        ),
        sensors={"s2": "v2"},
        n_arr=1,
        params="a b c m1 m2 d",
        inputs="F",
    ),
    Plant(
        "r_field",
        model("r_field"),
        equations=("U - D(p) - ex; p - L*i; ex - a*i - b*u; D(q) + fy; q - C*u; fy - c*u + b*i"),
        sensors={"u": "u"},
        n_arr=1,
        params="a b c L C",
        inputs="U",
    ),
    Plant(
        "mic",
        model("mic"),
        equations=(
            "U - R*i - u; D(q) - i; u - q*x/A; D(x) - v; F - q**2/(2*A) - D(p) - b*v - k*z; "
            "p - m*v; D(z) - v"
        ),
        sensors={"u": "u", "v": "v"},
        n_arr=2,
        params="A R m b k",
        inputs="U F",
        starts={"x": "x0", "z": "0"},
        consts={"x0": 1.4},
    ),
    Plant(
        "solenoid",
        model("solenoid"),
        equations=(
            "U - R*i - D(flux); flux - 2*K*i/g; D(g) - v; weight - flux**2/(4*K) - D(p); p - m*v; "
            "weight - w"
        ),
        sensors={"i": "i", "v": "v"},
        n_arr=2,
        params="R K m w",
        inputs="U",
        starts={"flux": "0.5", "g": "gap0"},
        consts={"gap0": 1.3},
    ),
    Plant(
        "reluctance",
        model("reluctance"),
        equations=(
            "U - R*i - D(flux); flux - i*(L0 + L1*cos(a)); D(a) - w; "
            "-D(h) - b*w - load - i**2*L1*sin(a)/2; h - J*w"
        ),
        sensors={"i": "i", "w": "w"},
        n_arr=2,
        params="R L0 L1 J b",
        inputs="U load",
        starts={"a": "0.3"},
    ),
    Plant(
        "rigid_body",
        model("rigid_body"),
        equations=(
            "Tx - c*x - D(px) - Jz*z*y + Jy*y*z; Jz*z*x - D(py) - Jx*x*z; "
            "Jx*x*y - D(pz) - Jy*y*x; px - Jx*x; py - Jy*y; pz - Jz*z"
        ),
        sensors={"wx": "x", "wy": "y", "wz": "z"},
        n_arr=3,
        params="Jx Jy Jz c",
        inputs="Tx",
    ),
    Plant(
        "rigid_body1",
        model("rigid_body1"),
        equations=(
            "Tx - c*x - D(px) - Jz*z*y + Jy*y*z; Jz*z*x - D(py) - Jx*x*z; "
            "Jx*x*y - D(pz) - Jy*y*x; px - Jx*x; py - Jy*y; pz - Jz*z"
        ),
        sensors={"wx": "x", "wy": "y"},
        n_arr=2,
        params="Jx Jy Jz c",
        inputs="Tx",
    ),
    Plant(
        "gyrator_cycle3",
        model("gyrator_cycle3"),
        equations=(
            "U - R*a - g1*b + g3*c; g1*a - g2*c - D(p); p - L*b; g2*b - g3*a - q/C; D(q) - c"
        ),
        sensors={"y": "b"},
        n_arr=1,
        params="g1 g2 g3 R C L",
        inputs="U",
    ),
    Plant(
        "gyrator_cycle3_res",
        model("gyrator_cycle3_res"),
        equations=("U - R1*a - g1*b + g3*c; g1*a - g2*c - R2*b; g2*b - g3*a - R3*c"),
        sensors={"y": "b", "z": "c"},
        n_arr=2,
        params="g1 g2 g3 R1 R2 R3",
        inputs="U",
    ),
    Plant(
        "gear_train",
        model("gear_train"),
        equations=(
            "a - n1*b; b - n2*c; T - D(p1) - ta; ta*n1 - D(p2) - tb; "
            "tb*n2 - D(p3) - f*c - load; p1 - J1*a; p2 - J2*b; p3 - J3*c"
        ),
        sensors={"ya": "a", "yc": "c"},
        n_arr=2,
        params="n1 n2 J1 J2 J3 f",
        inputs="T load",
    ),
    Plant(
        "gear_backwards",
        model("gear_backwards"),
        equations=("b - n*a; T + ea - D(p1); p1 - J1*a; -eb - D(p2) - f*b; p2 - J2*b; ea - n*eb"),
        sensors={"ya": "a"},
        n_arr=1,
        params="n J1 J2 f",
        inputs="T",
    ),
    Plant(
        "tf_both_in",
        model("tf_both_in"),
        equations=("a + n*b; T - ea - D(p1); p1 - J1*a; -eb - D(p2) - f*b; p2 - J2*b; eb - n*ea"),
        sensors={"ya": "a"},
        n_arr=1,
        params="n J1 J2 f",
        inputs="T",
    ),
    Plant(
        "gy_both_out",
        model("gy_both_out"),
        equations=(
            "U + e1 - D(pl) - R*a; pl - L*a; e1 - r*b; e2 + r*a; e2 - D(pj) - f*b; pj - J*b"
        ),
        sensors={"y": "b"},
        n_arr=1,
        params="r L J f R",
        inputs="U",
    ),
    Plant(
        "half_car",
        model("half_car"),
        equations=(
            "xf - v - a*th; xr - v + b*th; zf - sf - xf; zr - sr - xr; ef - qf*k - c*sf; "
            "D(qf) - sf; er - qr*k - c*sr; D(qr) - sr; ef + er - m*g - D(pm); pm - m*v; "
            "a*ef - b*er - D(pj); pj - J*th"
        ),
        sensors={"yv": "v", "yt": "th"},
        n_arr=1,
        params="m J a b k c",
        inputs="zr",
        unknown="zf",
        consts={"g": 9.81},
    ),
    Plant(
        "spring_q0",
        model("spring_q0"),
        equations=("F - D(p) - c*v - k*x; p - m*v; D(x) - v"),
        sensors={"y": "v"},
        n_arr=1,
        params="k m c",
        inputs="F",
        starts={"x": "x0"},
        consts={"x0": 0.3},
    ),
    Plant(
        "spring_free",
        model("spring_free"),
        equations=("F - D(p) - c*v - k*x; p - m*v; D(x) - v"),
        sensors={"y": "v"},
        n_arr=1,
        params="k m c",
        inputs="F",
    ),
    Plant(
        "spring_hard_q0",
        model("spring_hard_q0"),
        equations=("F - D(p) - k*x - x**3; p - m*v; D(x) - v"),
        sensors={"y": "v"},
        n_arr=1,
        params="k m",
        inputs="F",
        starts={"x": "0.5"},
    ),
    Plant(
        "pendulum",
        model("pendulum"),
        equations=("T - D(p) - c*w - m*g*l*sin(th); p - m*l**2*w; D(th) - w"),
        sensors={"pos": "th", "alpha": "D(w)"},
        n_arr=2,
        params="m l c",
        inputs="T",
        starts={"th": "0.4"},
        consts={"g": 9.81},
    ),
]
