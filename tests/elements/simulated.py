"""Machines as ordinary differential equations by hand, solved by an implicit Runge-Kutta method.

Nothing of the compiler is used, nor of the power series: `scipy.integrate.solve_ivp` with Radau's
method follows each machine for seconds, through switches of a thermostat and counts of an encoder.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from tests.adversary.plant import NOTHING

Values = Mapping[str, float]
Row = NDArray[np.float64]


class Machine(NamedTuple):
    """A machine: x' = slope(x, p, u), what its sensors read, and how long it is watched.

    Times in s, bandwidth in rad/s. `inputs` are functions of time, `switches` the times at which
    one of them jumps; `read` makes the samples that the code takes. `shift` is added to a
    parameter that is nominally zero; any other fault is a fifth of its quantity.
    """

    params: Values
    inputs: Mapping[str, Callable[[float], float]]
    slope: Callable[[Row, Values, Values], list[float]]
    read: Mapping[str, Callable[[Row, Values, Values], float]]
    start: tuple[float, ...]
    seconds: float
    sample_time: float
    bandwidth: float
    switches: tuple[float, ...] = ()
    shift: float = 0.0
    counts: Values = NOTHING


def ssqrt(x: float) -> float:
    return math.copysign(math.sqrt(abs(x)), x)


def motor(x: Row, p: Values, u: Values) -> list[float]:
    i, w, _ = x
    return [
        (u["U"] - p["R"] * i - p["k"] * w) / p["L"],
        (p["k"] * i - p["f"] * w - u["T"]) / p["J"],
        w,
    ]


def pendulum(x: Row, p: Values, u: Values) -> list[float]:
    w, th = x
    torque = u["T"] - p["c"] * w - p["m"] * 9.81 * p["l"] * math.sin(th)
    return [torque / (p["m"] * p["l"] ** 2), w]


def tanks(x: Row, p: Values, u: Values) -> list[float]:
    p1, p2 = x
    weight = 998 * 9.81
    between = p["k12"] * ssqrt(p1 - p2)
    return [
        (u["Q"] - p["leak"] * ssqrt(p1) - between) * weight / p["A1"],
        (between - p["kout"] * ssqrt(p2)) * weight / p["A2"],
    ]


def reactor(x: Row, p: Values, u: Values) -> list[float]:
    conc, T = x
    rate = p["V"] * p["k0"] * math.exp(-p["E"] / T) * conc
    heat = u["q"] * p["c"] * (u["Tin"] - T) + p["dH"] * rate - p["UA"] * (T - u["Tj"])
    return [(u["q"] * (u["cin"] - conc) - rate) / p["V"], heat / p["H"]]


def oven(x: Row, p: Values, u: Values) -> list[float]:
    Th, To = x
    across = p["Gh"] * (Th - To)
    return [
        (u["on"] * u["P"] - across) / p["Ch"],
        (across - p["Go"] * (To - u["Ta"])) / p["Co"],
    ]


MACHINES = {
    "dc_encoder": Machine(
        {"L": 1.1, "R": 0.9, "k": 1.3, "J": 0.7, "f": 0.4},
        {"U": lambda t: 240 + 80 * math.sin(5 * t), "T": lambda t: 30 + 5 * math.cos(2 * t)},
        motor,
        {"yi": lambda x, p, u: x[0], "th": lambda x, p, u: x[2]},
        (40.0, 110.0, 0.0),
        5.0,
        2e-3,
        8.0,
        counts={"th": 24 / (2 * math.pi)},
    ),
    "pendulum": Machine(
        {"m": 0.7, "l": 1.2, "c": 0.2},
        {"T": lambda t: 30 + 10 * math.sin(3 * t)},
        pendulum,
        {
            "pos": lambda x, p, u: x[1],
            "alpha": lambda x, p, u: pendulum(x, p, u)[0],
        },
        (0.0, 0.4),
        5.0,
        2e-3,
        8.0,
        counts={"pos": 500 / (2 * math.pi)},
    ),
    "two_tanks": Machine(
        {"A1": 0.0154, "A2": 0.0154, "k12": 1.2e-6, "kout": 1.0e-6, "leak": 0.0},
        {"Q": lambda t: 6e-5 * (1 + 0.5 * math.sin(0.1 * t))},
        tanks,
        {"p1": lambda x, p, u: x[0], "p2": lambda x, p, u: x[1]},
        (5000.0, 2500.0),
        100.0,
        0.05,
        1.0,
        shift=2e-7,
    ),
    "stirred_reactor": Machine(
        {"V": 1.2, "k0": 2.1, "E": 0.8, "dH": 0.6, "H": 1.5, "UA": 0.7, "c": 1.3},
        {
            "q": lambda t: 1 + 0.3 * math.sin(2 * t),
            "cin": lambda t: 1.5 + 0.2 * math.cos(3 * t),
            "Tin": lambda t: 1.1,
            "Tj": lambda t: 0.8,
        },
        reactor,
        {"conc": lambda x, p, u: x[0], "T": lambda x, p, u: x[1]},
        (0.7, 1.3),
        5.0,
        2e-3,
        20.0,
    ),
    "oven": Machine(
        {"Ch": 120.0, "Co": 900.0, "Gh": 4.0, "Go": 0.8},
        {
            "P": lambda t: 900.0,
            "Ta": lambda t: 293.0,
            "on": lambda t: t < 60 or 130 <= t < 210,
        },
        oven,
        {"Th": lambda x, p, u: x[0], "To": lambda x, p, u: x[1]},
        (300.0, 295.0),
        300.0,
        0.05,
        0.5,
        switches=(60.0, 130.0, 210.0),
    ),
}


def watched(m: Machine, fault: str = "") -> dict[str, list[Any]]:
    """The samples of everything that the code is told, with one fault in the machine."""

    def wrong(name: str, value: float) -> float:
        if name != fault:
            return value
        return value * 1.2 if value else m.shift

    p = {name: wrong(name, value) for name, value in m.params.items()}
    x = np.array(m.start)
    edges = [0.0, *m.switches, m.seconds]
    told: dict[str, list[Any]] = {name: [] for name in [*m.inputs, *m.read]}
    for a, b in pairwise(edges):
        middle = (a + b) / 2

        def at(t: float, middle: float = middle) -> dict[str, float]:
            jumps = {"on"}  # constant between two switches, those at the ends included
            return {n: wrong(n, f(middle if n in jumps else t)) for n, f in m.inputs.items()}

        found = solve_ivp(
            lambda t, x, p=p, at=at: m.slope(x, p, at(t)),
            (a, b),
            x,
            method="Radau",
            rtol=1e-9,
            atol=1e-12,
            dense_output=True,
        )
        assert found.success
        for k in range(round(a / m.sample_time), round(b / m.sample_time)):
            t = k * m.sample_time
            state = found.sol(t)
            for name, f in m.inputs.items():
                told[name].append(f(t))
            for name, read in m.read.items():
                value = wrong(name, read(state, p, at(t)))
                told[name].append(math.floor(value * m.counts[name]) if name in m.counts else value)
        x = found.y[:, -1]
    return told
