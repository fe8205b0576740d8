"""Equations solved by iteration, or in each mode of a switch; the physics by hand."""

from __future__ import annotations

from tests.adversary.plant import Plant, model

PLANTS = [
    Plant(
        "two_tanh",
        model("two_tanh"),
        equations="Q - D(q) - f - h; q - C*e; e - tanh(a*f) - f; e - tanh(b*h) - h",
        sensors={"y": "e"},
        n_arr=1,
        params="C a b",
        inputs="Q",
    ),
    Plant(
        "hard_momentum",
        model("hard_momentum"),
        equations="F - D(p) - q/c; v - p/i - p**3; D(q) - v",
        sensors={"y": "v"},
        n_arr=1,
        params="i c",
        inputs="F",
    ),
    Plant(
        "relativistic",
        model("relativistic"),
        equations="F - D(p) - R*v; v - p/m/sqrt(1 + (p/(m*c))**2)",
        sensors={"y": "v"},
        n_arr=1,
        params="m c R",
        inputs="F",
    ),
    Plant(
        "node_of_diodes",
        model("node_of_diodes"),
        equations=(
            "U - R*j - u; j - Is*(exp(u/vt) - 1) - 0.5*u - Is*sinh(u) - k; u - Rb*k - q/C; D(q) - k"
        ),
        sensors={"i": "k"},
        n_arr=1,
        params="Is vt R Rb C",
        inputs="U",
    ),
    Plant(
        "bridge_rectifier",
        model("bridge_rectifier"),
        equations=(
            "U - R*i - D(h) - va + vb; h - L*i; "
            "i + s*(exp(-va/t) - 1) - s*(exp((va - v)/t) - 1); "
            "s*(exp(-vb/t) - 1) - s*(exp((vb - v)/t) - 1) - i; "
            "s*(exp((va - v)/t) - 1) + s*(exp((vb - v)/t) - 1) - G*v - D(q); q - C*v"
        ),
        sensors={"i": "i", "u": "v"},
        n_arr=2,
        params="L R C G s",
        inputs="U",
        consts={"t": 0.9},
    ),
    Plant(
        "nested_roots",
        model("nested_roots"),
        equations="U - tanh(a*f) - f - u; f - g*u - tanh(u) - k; u - R*k - q/C; D(q) - k",
        sensors={"i": "k"},
        n_arr=1,
        params="a g R C",
        inputs="U",
    ),
    Plant(
        "parallel_switches",
        model("parallel_switches"),
        equations=(
            "where(a, f - (U - z)/R1, f); where(b, g - (U - z)/R2, g); f + g - D(q); q - C*z"
        ),
        sensors={"v": "z"},
        n_arr=1,
        params="R1 R2 C",
        inputs="U",
        modes="a b",
    ),
]
