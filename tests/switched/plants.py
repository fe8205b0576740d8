"""Switched plants with exact samples: linear in each mode, joined by conservation laws at a switch.

Nothing here knows the compiler: the equations are written by hand, the motion of a mode is a matrix
exponential, and the input is a constant with a sine on it, so that every fault is excited.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.linalg import expm

Array = npt.NDArray[np.float64]
Mode = tuple[bool, ...]
Values = Mapping[str, float]

#: rad/s, of the sine on the input.
SWING = 7.0


class Plant(NamedTuple):
    """A plant in hand-written equations.

    In `law`(mode, values) is x' = A x + b u. What `lands`(mode, x, values) gives is the state right
    after the switches have come to `mode`, `reads`(mode, x, x', u, values) the sensors, and
    `terms`(mode, x, x', u, values) the terms of each residual, as a person writes it.
    """

    text: str
    modes: tuple[str, ...]
    source: str
    supply: tuple[float, float]  # the constant part of the input, and its swing
    values: Values
    plan: Sequence[Mode]
    start: Sequence[float]
    law: Callable[[Mode, Values], tuple[list[list[float]], list[float]]]
    lands: Callable[[Mode, Array, Values], Sequence[float]]
    reads: Callable[[Mode, Array, Array, float, Values], dict[str, float]]
    terms: Callable[[Mode, Array, Array, float, Values], dict[str, list[float]]]


class Log(NamedTuple):
    """Samples by signal, the mode of each, and the sum of the amounts of the terms by residual."""

    signals: dict[str, Array]
    modes: list[Mode]
    sizes: dict[str, Array]


def log(plant: Plant, lasts: float, rate: float, values: Values | None = None) -> Log:
    """Exact samples; every mode of the plan lasts so many seconds.

    A sample at the very moment of a switch is of the new mode.
    """
    p = {**plant.values, **(values or {})}
    constant, swing = plant.supply
    x = np.array(plant.start, dtype=float)
    n = len(x)
    rows: list[tuple[Mode, Array, Array, float]] = []
    begin, k = 0.0, 0
    for mode in plant.plan:
        x = np.array(plant.lands(mode, x, p), dtype=float)
        a, b = (np.array(part, dtype=float) for part in plant.law(mode, p))
        whole = np.zeros((n + 3, n + 3))  # the state, then 1, sine and cosine
        whole[:n, :n] = a
        whole[:n, n], whole[:n, n + 1] = b * constant, b * swing
        whole[n + 1, n + 2], whole[n + 2, n + 1] = SWING, -SWING
        now = np.concatenate([x, [1.0, np.sin(SWING * begin), np.cos(SWING * begin)]])
        while k / rate < begin + lasts - 1e-12:
            there = expm(whole * (k / rate - begin)) @ now
            slope = (whole @ there)[:n]
            rows.append((mode, there[:n], slope, constant + swing * there[n + 1]))
            k += 1
        x = (expm(whole * lasts) @ now)[:n]
        begin += lasts
    told = [plant.reads(m, y, d, u, p) for m, y, d, u in rows]
    signals = {name: np.array([t[name] for t in told]) for name in told[0]}
    signals[plant.source] = np.array([u for *_, u in rows])
    for at, name in enumerate(plant.modes):
        signals[name] = np.array([float(m[at]) for m, *_ in rows])
    terms = [plant.terms(m, y, d, u, p) for m, y, d, u in rows]
    sizes = {name: np.array([np.abs(t[name]).sum() for t in terms]) for name in terms[0]}
    return Log(signals, [m for m, *_ in rows], sizes)


# ------------------------------------------------------------------------------ boost converter

_BOOST = """bg 1
model Boost {
    input on : bool
    input diode : bool
    input E : V
    param L = 0.5 H
    param R = 1 Ohm
    param C = 0.05 F
    param G = 0.1 S
    Se:E -> 1:coil
    coil { -> I:L; -> R:R; -> Df:i; -> 0:node }
    node -> 1:transistor when on { -> Se:ground = 0 }
    node -> 1:rectifier when diode { -> 0:out }
    out { -> C:C; -> R:load = 1/G; -> De:v }
}
"""


def _boost_law(mode: Mode, p: Values) -> tuple[list[list[float]], list[float]]:
    on, diode = mode
    coil, link = (0.0, 0.0) if not (on or diode) else (-p["R"] / p["L"], 0.0)
    if diode and not on:
        link = 1.0
    supply = 1 / p["L"] if on or diode else 0.0
    a = [[coil, -link / p["L"]], [link / p["C"], -p["G"] / p["C"]]]
    return a, [supply, 0.0]


def _boost_terms(m: Mode, x: Array, d: Array, u: float, p: Values) -> dict[str, list[float]]:
    on, diode = m
    coil = [u, p["R"] * x[0], p["L"] * d[0]]
    out = [p["G"] * x[1], p["C"] * d[1]]
    return {
        "r1": coil if on else [x[0], *out],  # no voltage at the node, or its currents
        "r2": [*coil, x[1]] if diode else out,  # the diode has no voltage, or no current
    }


BOOST = Plant(
    _BOOST,
    ("on", "diode"),
    "E",
    (24.0, 4.0),
    {"L": 0.5, "R": 1.0, "C": 0.05, "G": 0.1},
    ((True, False), (False, True), (False, False)) * 3 + ((True, False), (False, True)) * 2,
    (0.0, 20.0),
    _boost_law,
    lambda m, x, p: x if any(m) else (0.0, x[1]),  # nothing leads the current of the coil on
    lambda m, x, d, u, p: {"i": x[0], "v": x[1]},
    _boost_terms,
)

# ------------------------------------------------------------------------- two capacitors joined

_CAPACITORS = """bg 1
model Capacitors {
    input joined : bool
    input I : A
    param C1 = 0.05 F
    param C2 = 0.03 F
    param R1 = 10 Ohm
    param R2 = 20 Ohm
    Sf:I -> 0:left { -> C:C1; -> R:R1; -> De:v1 }
    left -> 1:switch when joined { -> 0:right }
    right { -> C:C2; -> R:R2; -> De:v2 }
}
"""


def _capacitors_law(mode: Mode, p: Values) -> tuple[list[list[float]], list[float]]:
    if mode[0]:
        both = p["C1"] + p["C2"]
        fall = -(1 / p["R1"] + 1 / p["R2"]) / both
        return [[fall, 0.0], [0.0, fall]], [1 / both, 1 / both]
    one, two = -1 / (p["R1"] * p["C1"]), -1 / (p["R2"] * p["C2"])
    return [[one, 0.0], [0.0, two]], [1 / p["C1"], 0.0]


def _capacitors_land(mode: Mode, x: Array, p: Values) -> Sequence[float]:
    if not mode[0]:
        return [*x]
    charge = p["C1"] * x[0] + p["C2"] * x[1]
    return [charge / (p["C1"] + p["C2"])] * 2


def _capacitors_terms(m: Mode, x: Array, d: Array, u: float, p: Values) -> dict[str, list[float]]:
    left = [u, x[0] / p["R1"], p["C1"] * d[0]]
    right = [x[1] / p["R2"], p["C2"] * d[1]]
    return {"r1": [*left, *right], "r2": [x[0], x[1]] if m[0] else right}


CAPACITORS = Plant(
    _CAPACITORS,
    ("joined",),
    "I",
    (1.0, 0.3),
    {"C1": 0.05, "C2": 0.03, "R1": 10.0, "R2": 20.0},
    ((False,), (True,)) * 5,
    (1.0, 5.0),
    _capacitors_law,
    _capacitors_land,
    lambda m, x, d, u, p: {"v1": x[0], "v2": x[1]},
    _capacitors_terms,
)

# ------------------------------------------------------------------------------- a coil cut off

_COIL = """bg 1
model Coil {
    input closed : bool
    input U : V
    param R = 2 Ohm
    param L = 0.3 H
    param Rs = 5 Ohm
    param C = 0.02 F
    Se:U -> 1:feed { -> R:Rs }
    feed -> 0:bus { -> C:C; -> De:v }
    bus -> 1:coil when closed { -> I:L; -> R:R; -> Df:i }
}
"""


def _coil_law(mode: Mode, p: Values) -> tuple[list[list[float]], list[float]]:
    feed = 1 / (p["Rs"] * p["C"])
    if mode[0]:
        return [[-p["R"] / p["L"], 1 / p["L"]], [-1 / p["C"], -feed]], [0.0, feed]
    return [[0.0, 0.0], [0.0, -feed]], [0.0, feed]


def _coil_terms(m: Mode, x: Array, d: Array, u: float, p: Values) -> dict[str, list[float]]:
    bus = [x[0], p["C"] * d[1], u / p["Rs"], x[1] / p["Rs"]]
    return {"r1": bus, "r2": [x[1], p["R"] * x[0], p["L"] * d[0]] if m[0] else [x[0]]}


COIL = Plant(
    _COIL,
    ("closed",),
    "U",
    (12.0, 3.0),
    {"R": 2.0, "L": 0.3, "Rs": 5.0, "C": 0.02},
    ((True,), (False,)) * 5,
    (0.0, 3.0),
    _coil_law,
    lambda m, x, p: x if m[0] else (0.0, x[1]),  # its momentum goes into the switch
    lambda m, x, d, u, p: {"i": x[0], "v": x[1]},
    _coil_terms,
)

# ------------------------------------------------- of second order: a mass on a spring, a damper

_CARRIAGE = """bg 1
model Carriage {
    input braked : bool
    input F : N
    param m = 2 kg
    param k = 60 N/m
    param b = 3 N.s/m
    param d = 9 N.s/m
    Se:F -> 1:carriage { -> I:m; -> R:b }
    carriage -> 0:spring { -> C:k = 1/k; -> De:s }
    carriage -> 0:clutch when braked { -> R:d }
}
"""


def _carriage_law(mode: Mode, p: Values) -> tuple[list[list[float]], list[float]]:
    damping = p["b"] + (p["d"] if mode[0] else 0.0)
    return [[0.0, 1.0], [-p["k"] / p["m"], -damping / p["m"]]], [0.0, 1 / p["m"]]


def _carriage_terms(m: Mode, x: Array, d: Array, u: float, p: Values) -> dict[str, list[float]]:
    free = [u, p["m"] * d[1], p["k"] * x[0], p["b"] * x[1]]  # the force of the damper, or none
    return {"r1": [x[1], *[force / p["d"] for force in free]] if m[0] else free}


CARRIAGE = Plant(
    _CARRIAGE,
    ("braked",),
    "F",
    (5.0, 12.0),
    {"m": 2.0, "k": 60.0, "b": 3.0, "d": 9.0},
    ((False,), (True,)) * 5,
    (0.0, 0.0),
    _carriage_law,
    lambda m, x, p: [*x],
    lambda m, x, d, u, p: {"s": p["k"] * x[0]},
    _carriage_terms,
)

# --------------------------------------------- a buck converter: behind the coil nothing may jump

_BUCK = """bg 1
model Buck {
    input on : bool
    input E : V
    param L = 0.5 H
    param R = 1 Ohm
    param C = 0.05 F
    param G = 0.1 S
    Se:E -> transistor
    1:transistor when on { -> 0:node }
    Se:ground = 0 V -> diode
    1:diode when not on { -> node }
    node -> 1:coil
    coil { -> I:L; -> R:R; -> Df:i; -> 0:out }
    out { -> C:C; -> R:load = 1/G; -> De:v }
}
"""


def _buck_law(mode: Mode, p: Values) -> tuple[list[list[float]], list[float]]:
    a = [[-p["R"] / p["L"], -1 / p["L"]], [1 / p["C"], -p["G"] / p["C"]]]
    return a, [1 / p["L"] if mode[0] else 0.0, 0.0]


def _buck_terms(m: Mode, x: Array, d: Array, u: float, p: Values) -> dict[str, list[float]]:
    coil = [u if m[0] else 0.0, p["R"] * x[0], p["L"] * d[0], x[1]]
    return {"coil": coil, "out": [x[0], p["G"] * x[1], p["C"] * d[1]]}


BUCK = Plant(
    _BUCK,
    ("on",),
    "E",
    (24.0, 4.0),
    {"L": 0.5, "R": 1.0, "C": 0.05, "G": 0.1},
    ((True,), (False,)) * 5,
    (10.0, 9.0),
    _buck_law,
    lambda m, x, p: [*x],
    lambda m, x, d, u, p: {"i": x[0], "v": x[1]},
    _buck_terms,
)
