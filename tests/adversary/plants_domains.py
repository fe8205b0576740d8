"""Magnetic, acoustic, thermal and chemical models and plain machines, with the physics by hand."""

from __future__ import annotations

from tests.adversary.plant import Plant, model

PLANTS = [
    Plant(
        "friction_sign",
        model("friction_sign"),
        equations="F - D(p) - Fc*sign(v) - b*v; p - m*v",
        sensors={"y": "v"},
        n_arr=1,
        params="m Fc b",
        inputs="F",
        values={"v": 1.5, "p": 1.5, "m": 1.0},
    ),
    Plant(
        "drag_abs",
        model("drag_abs"),
        equations="F - m*g*slope - D(p) - c*v*abs(v); p - m*v",
        sensors={"y": "v"},
        n_arr=1,
        params="m c",
        inputs="F slope",
        values={"v": 1.5, "p": 1.5, "m": 1.0, "slope": 0.1},
        consts={"g": 9.81},
    ),
    Plant(
        "three_thermometers",
        model("three_thermometers"),
        equations="P - D(h) - G*(T - Ta); h - C*T",
        sensors={"T1": "T", "T2": "T", "T3": "T"},
        n_arr=3,
        params="C G",
        inputs="P Ta",
        groups=4,
    ),
    Plant(
        "tank_leak",
        model("tank_leak"),
        equations="Q - D(q) - k*ssqrt(x) - leak*x; q - A*x",
        sensors={"p": "x"},
        n_arr=1,
        params="A k leak",
        inputs="Q",
        values={"leak": 0},
    ),
    Plant(
        "magnetic_core",
        model("magnetic_core"),
        equations="U - R*j - n*s; n*j - iron*x - sat*x**3 - gap*x - eddy*s; D(x) - s",
        sensors={"i": "j", "search": "s"},
        n_arr=2,
        params="n R iron sat gap eddy",
        inputs="U",
        starts={"x": "0.5"},
    ),
    Plant(
        "magnetic_tee",
        model("magnetic_tee"),
        equations=(
            "U - R1*j - n1*s1; n1*j - a*x1 - h; D(x1) - s1; x1 - x2 - x3; h - c*x3; "
            "h - b*x2 - n2*k; D(x2) - s2; n2*s2 - R2*k"
        ),
        sensors={"i1": "j", "i2": "k"},
        n_arr=2,
        params="n1 n2 R1 R2 a b c",
        inputs="U",
    ),
    Plant(
        "loudspeaker",
        model("loudspeaker"),
        equations=(
            "U - R*j - L*D(j) - Bl*v; Bl*j - m*D(v) - b*v - k*x - S*h; D(x) - v; "
            "S*v - Ca*D(h) - w; h - Ma*D(w) - ra*w"
        ),
        sensors={"i": "j", "p": "h"},
        n_arr=2,
        params="R L Bl m b k S Ca Ma ra",
        inputs="U",
    ),
    Plant(
        "helmholtz",
        model("helmholtz"),
        equations="sound - Ma*D(w) - ra*w - h; w - Ca*D(h)",
        sensors={"p": "h"},
        n_arr=1,
        params="Ma ra Ca",
        inputs="sound",
    ),
    Plant(
        "heated_rod",
        model("heated_rod"),
        equations=(
            "P - C1*D(a) - G12*(a - b); G12*(a - b) - C2*D(b) - G23*(b - d); "
            "G23*(b - d) - C3*D(d) - Ga*(d - Ta)"
        ),
        sensors={"T1": "a", "T3": "d"},
        n_arr=1,
        params="C1 C2 C3 G12 G23 Ga",
        inputs="P",
        unknown="Ta",
        undetectable="C3 Ga",
    ),
    Plant(
        "stirred_reactor",
        model("stirred_reactor"),
        equations=(
            "q*(cin - x) - V*D(x) - rate; rate - V*k0*exp(-E/h)*x; "
            "q*c*(Tin - h) + dH*rate - H*D(h) - UA*(h - Tj)"
        ),
        sensors={"conc": "x", "T": "h"},
        n_arr=2,
        params="V k0 E dH H UA c",
        inputs="q cin Tin Tj",
    ),
    Plant(
        "gas_tank",
        model("gas_tank"),
        equations=(
            "w - D(n) - kv*a; w*(cv + r)*Tin - D(u) - kv*a*(cv + r)*b; a*V - n*r*b; u - n*cv*b"
        ),
        sensors={"p": "a", "T": "b"},
        n_arr=2,
        params="V r cv kv",
        inputs="w Tin",
    ),
    Plant(
        "variable_gear",
        model("variable_gear"),
        equations="T - D(p1) - n*t; p1 - J1*a; t - D(p2) - f*b; p2 - J2*b; b - n*a",
        sensors={"w": "a"},
        n_arr=1,
        params="J1 J2 f",
        inputs="T n",
    ),
    Plant(
        "two_motors",
        model("two_motors"),
        equations="U - R*j - D(p); p - L*j; T - D(h) - d*w; h - J*w",
        sensors={"i": "j"},
        n_arr=1,
        params="L R J d",
        inputs="U T",
        undetectable="J d T",
    ),
    Plant(
        "reaction_chain",
        model("reaction_chain"),
        equations="feed - D(a) - k1*a; k1*a - D(b) - k2*b; k2*b - D(c)",
        sensors={"ca": "a", "cc": "c"},
        n_arr=2,
        params="k1 k2",
        inputs="feed",
    ),
]
