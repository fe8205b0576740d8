"""Machines of textbooks whose structure the other plants lack, with the physics by hand."""

from __future__ import annotations

from tests.adversary.plant import Plant, model

PLANTS = [
    Plant(
        "buck_ideal",
        model("buck_ideal"),
        equations="where(on, E, 0) - L*D(j) - v; j - C*D(v) - v/R",
        sensors={"i": "j", "u": "v"},
        n_arr=2,
        params="L C R",
        inputs="E",
        modes="on",
        undetectable="",
        groups=3,
    ),
    Plant(
        "buck_switches",
        model("buck_switches"),
        equations="where(on, E, 0) - L*D(j) - v; j - C*D(v) - v/R",
        sensors={"i": "j", "u": "v"},
        n_arr=2,
        params="L C R",
        inputs="E",
        modes="on",
        undetectable="",
        groups=3,
    ),
    Plant(
        "buck_boost",
        model("buck_boost"),
        equations="where(on, E, v) - L*D(j) - rL*j; where(on, 0, -j) - C*D(v) - v/R",
        sensors={"i": "j", "u": "v"},
        n_arr=2,
        params="L rL C R",
        inputs="E",
        modes="on",
        undetectable="",
    ),
    Plant(
        "h_bridge_legs",
        model("h_bridge_legs"),
        equations=(
            "where(a, E, 0) - where(b, E, 0) - L*D(j) - R*j - k*w; k*j - J*D(w) - f*w; "
            "d - where(a, j, 0) + where(b, j, 0)"
        ),
        sensors={"i": "j", "w": "w", "idc": "d"},
        n_arr=3,
        params="L R k J f",
        inputs="E",
        modes="a b",
        undetectable="",
    ),
    Plant(
        "inverter",
        model("inverter"),
        equations=(
            "where(s__1, E, 0) - R__1*a - L*D(a) - n; where(s__2, E, 0) - R__2*b - L*D(b) - n; "
            "where(s__3, E, 0) - R__3*c - L*D(c) - n; a + b + c"
        ),
        sensors={"ia": "a", "ib": "b"},
        n_arr=2,
        params="L R__1 R__2 R__3",
        inputs="E",
        modes="s__1 s__2 s__3",
        undetectable="",
    ),
    Plant(
        "two_links",
        model("two_links"),
        equations="I - C1*D(h) - h/R1; I - C2*D(g) - g/R2",
        sensors={"u": "h+g", "P": "h*h/R1+g*g/R2"},
        n_arr=2,
        params="R1 C1 R2 C2",
        inputs="I",
    ),
    Plant(
        "modal_beam",
        model("modal_beam"),
        equations=(
            "1*F + noise - m__1*D(a1) - k__1*x1 - z*1*a1; D(x1) - a1; "
            "(-0.5)*F + noise - m__2*D(a2) - k__2*x2 - z*2*a2; D(x2) - a2; "
            "0.25*F + noise - m__3*D(a3) - k__3*x3 - z*3*a3; D(x3) - a3; "
            "v - a1 + 0.5*a2 - 0.25*a3; h - a1 - a2 - a3"
        ),
        sensors={"v": "v", "h": "h"},
        n_arr=1,
        params="k__1 k__2 k__3 m__1 m__2 m__3 z",
        inputs="F",
        unknown="noise",
        starts={"x1": "0", "x2": "0", "x3": "0"},
    ),
    Plant(
        "pneumatic",
        model("pneumatic"),
        equations=(
            "w - kn*where(h < 0.5*ps, ps, 2*ssqrt(h*(ps - h))); w - D(n); h*(V0 + x) - rT*n; "
            "D(x) - A*v; A*h - m*D(v) - b*v - A*pa"
        ),
        sensors={"p": "h", "v": "v"},
        n_arr=2,
        params="kn rT V0 A m b pa",
        inputs="ps",
        starts={"x": "0"},
        values={"ps": 3, "h": 2.2, "n": 2},
    ),
    Plant(
        "transformer_mixed",
        model("transformer_mixed"),
        equations="U - R1*a - L1*D(a) - Mu*D(b); u + Mu*D(a) + L2*D(b); b - load",
        sensors={"i1": "a", "u2": "-u"},
        n_arr=2,
        params="L1 L2 Mu R1 R2",
        inputs="U load",
        undetectable="R2",
    ),
    Plant(
        "gyroscope",
        model("gyroscope"),
        equations="T - Jg*D(s) - cg*s - h*cos(al)*w; h*cos(al)*s - Jb*D(w) - cb*w; D(al) - s",
        sensors={"w": "w", "alpha": "al"},
        n_arr=2,
        params="h Jg Jb cg cb",
        inputs="T",
        starts={"al": "0.2"},
    ),
    Plant(
        "ward_leonard",
        model("ward_leonard"),
        equations="Uf - Lf*D(h) - Rf*h; kg*h*wg - La*D(i) - Ra*i - km*w; km*i - J*D(w) - b*w - TL",
        sensors={"ia": "i", "w": "w"},
        n_arr=2,
        params="Lf Rf kg La Ra km J b",
        inputs="Uf wg TL",
    ),
    Plant(
        "undualisable",
        model("undualisable"),
        equations="U - R1*a - k; a - b - c; k - R2*b; d - n*c; k - n*J*D(d); q - Q; s - U",
        sensors={"us": "s", "ia": "a", "ib": "b", "ic": "c", "id": "d", "qm": "q"},
        n_arr=6,
        params="n R1 R2 J",
        inputs="U Q",
    ),
    Plant(
        "split_pump",
        model("split_pump"),
        equations="s*pump - A1*D(a) - k1*ssqrt(a); (1-s)*pump - A2*D(b) - k2*ssqrt(b)",
        sensors={"h1": "a", "h2": "b", "F": "pump"},
        n_arr=2,
        params="s A1 A2 k1 k2",
        unknown="pump",
        undetectable="",
    ),
    Plant(
        "boost_esr",
        model("boost_esr"),
        equations="E - L*D(i) - rl*i - (1-d)*u; (1-d)*i - j - u/R; u - x - rc*j; C*D(x) - j",
        sensors={"u": "u"},
        n_arr=1,
        params="L rl C rc R",
        inputs="E d",
        values={"d": 0.4},
        undetectable="",
    ),
    Plant(
        "exchanger_wall",
        model("exchanger_wall"),
        equations=(
            "cp*mh*(Th - x) - Ch*D(x) - G*(x - w); G*(x - w) - Cw*D(w) - Gw*mc*(w - c); "
            "Gw*mc*(w - c) + cp*mc*(Tc - c) - Cc*D(c)"
        ),
        sensors={"Tco": "c"},
        n_arr=1,
        params="Ch Cw Cc G Gw cp",
        inputs="mh mc Th Tc",
        undetectable="",
    ),
    Plant(
        "lossy_trafo",
        model("lossy_trafo"),
        equations=(
            "U - R1*i - L1*D(i) - n*cos(al)*v; n*cos(al)*i - v/Rl - j; v - Rs*j - x; Cs*D(x) - j"
        ),
        sensors={"i": "i"},
        n_arr=1,
        params="R1 L1 n Cs Rs Rl",
        inputs="U al",
        undetectable="",
    ),
]
