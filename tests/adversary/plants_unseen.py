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
]
