"""Machines of other domains, integrated by hand, watched without a tuning."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import bondgraph
from bondgraph.runtime.monitoring.verdict import Verdict

_SAMPLES, _ONSET = 9600, 7500
_NOISE = 1e-3  # of what a reading is like

Numbers = Mapping[str, float]


class Plant(NamedTuple):
    """A model, and its physics by hand: rates and readings of a state, commands over time.

    Of `fault` the value is multiplied by 1.5 at the onset; `others` are in other balances, which no
    such fault touches. `turns` are the times between which a command is smooth.
    """

    model: str
    rate: float
    values: Numbers
    start: list[float]
    inputs: Callable[[float], Numbers]
    rates: Callable[[float, list[float], Numbers, Numbers], list[float]]
    readings: Callable[[list[float]], Numbers]
    fault: str
    others: set[str]
    turns: Callable[[float], list[float]] = lambda end: []


def _ssqrt(x: float) -> float:
    return math.copysign(math.sqrt(abs(x)), x)


def _turns(speed: float, level: float) -> Callable[[float], list[float]]:
    """When sin(speed t) goes through a level."""
    first = math.asin(level)
    return lambda end: [
        t
        for k in range(int(speed * end / math.pi) + 2)
        if 0 < (t := (first * (-1) ** k + math.pi * k) / speed) < end
    ]


_TANKS = Plant(  # minutes, square roots
    """
    input Q : m^3/s
    param C1 = 4e-6 m^3/Pa
    param C2 = 3e-6 m^3/Pa
    param k = 6e-6 m^3/s.Pa^-0.5 +- 4%
    param ko = 5e-6 m^3/s.Pa^-0.5 +- 4%
    0:a { <- Sf:Q; -> C:C1; -> De:pa; -> 1:valve -> b }
    valve -> R:r { f = k*ssqrt(e) }
    0:b { -> C:C2; -> De:pb; -> R:out { f = ko*ssqrt(e) } }
    """,
    20.0,
    {"C1": 4e-6, "C2": 3e-6, "k": 6.1e-6, "ko": 4.9e-6},
    [0.0, 0.0],
    lambda t: {"Q": 2e-4 * (1 + 0.5 * math.sin(0.05 * t))},
    lambda t, x, u, p: [
        (u["Q"] - p["k"] * _ssqrt(x[0] - x[1])) / p["C1"],
        (p["k"] * _ssqrt(x[0] - x[1]) - p["ko"] * _ssqrt(x[1])) / p["C2"],
    ],
    lambda x: {"pa": x[0], "pb": x[1]},
    "ko",
    {"C1", "Q", "k", "pa"},
)

_CHOPPER = Plant(  # a switch that turns between samples, and rests long in each position
    """
    input on : bool
    param L = 0.6
    param C = 0.4
    param R = 1.2
    1:up when on { <- Se:E; -> 0:x }
    x -> 1:coil
    1:free when not on { -> x; <- Se:zero = 0 }
    coil { -> I:L; -> Df:i; -> 0:o }
    o { -> C:C; -> R:R; -> De:u }
    """,
    100.0,
    {"L": 0.6, "C": 0.4, "R": 1.2},
    [0.0, 0.0],
    lambda t: {"E": 2 + 0.5 * math.sin(1.1 * t), "on": float(math.sin(0.23 * t) > -0.2)},
    lambda t, x, u, p: [
        (u["E"] * u["on"] - x[1]) / p["L"],
        (x[0] - x[1] / p["R"]) / p["C"],
    ],
    lambda x: {"i": x[0], "u": x[1]},
    "L",
    {"C", "R", "i", "u"},
    _turns(0.23, -0.2),
)

_BOOST = Plant(  # products of derivatives: the code of the residual is an approximation
    """
    param L = 1; param C = 0.8; param R = 1.3
    input U; input a
    Se:U -> 1:coil -> MTF:sw { e1 = (1-a)*e2 } -> 0:out
    coil -> I:L
    out { -> C:C; -> R:R; -> De:u }
    """,
    100.0,
    {"L": 1.0, "C": 0.8, "R": 1.3},
    [0.0, 0.0],
    lambda t: {
        "U": 1 + 0.4 * math.sin(0.3 * t) + 0.2 * math.sin(0.86 * t),
        "a": 0.4 + 0.2 * math.sin(0.38 * t) + 0.1 * math.sin(t + 1),
    },
    lambda t, x, u, p: [
        (u["U"] - (1 - u["a"]) * x[1]) / p["L"],
        ((1 - u["a"]) * x[0] - x[1] / p["R"]) / p["C"],
    ],
    lambda x: {"u": x[1]},
    "R",
    set(),
)

_SPRING = Plant(  # the speed is added up for ever, and its noise with it
    """
    param m = 1.5; param k = 1.2; param d = 0.8
    1:body { <- Se:F; -> I:m; -> R:d; -> Df:v
        -> C:s(q0 = 0) { e = k*q + q^3 } }
    """,
    200.0,
    {"m": 1.5, "k": 1.2, "d": 0.8},
    [0.0, 0.0],
    lambda t: {"F": 1 + 0.8 * math.sin(0.7 * t) + 0.5 * math.sin(1.9 * t)},
    lambda t, x, u, p: [
        (u["F"] - p["d"] * x[0] - p["k"] * x[1] - x[1] ** 3) / p["m"],
        x[0],
    ],
    lambda x: {"v": x[0]},
    "k",
    set(),
)

_GATED = Plant(  # a derivative behind a switch: of both its positions until the filter has settled
    """
    input on : bool
    param C = 0.7; param R = 1.4; param R2 = 2
    1:charge when on { <- Se:U; -> R:R; -> 0:cap }
    cap { -> C:C; -> R:R2; -> De:u }
    """,
    200.0,
    {"C": 0.7, "R": 1.4, "R2": 2.0},
    [0.0],
    lambda t: {"U": 2 + 0.5 * math.sin(0.9 * t), "on": float(math.sin(0.15 * t) < 0.2)},
    lambda t, x, u, p: [((u["U"] - x[0]) / p["R"] * u["on"] - x[0] / p["R2"]) / p["C"]],
    lambda x: {"u": x[0]},
    "R2",
    set(),
    _turns(0.15, 0.2),
)

PLANTS = {
    "tanks": _TANKS, "chopper": _CHOPPER, "boost": _BOOST, "spring": _SPRING, "gated": _GATED,
}  # fmt: skip


def _run(plant: Plant, times: np.ndarray, onset: float) -> dict[str, np.ndarray]:
    """Commands and readings with their noise; the fault sets in at the onset."""
    end = float(times[-1])
    edges = [0.0, *sorted([onset, *plant.turns(end)]), end]
    state, rows = list(plant.start), []
    for a, b in pairwise(edges):
        values = dict(plant.values)
        if a >= onset:
            values[plant.fault] *= 1.5
        middle = plant.inputs((a + b) / 2)
        held = {n: v for n, v in middle.items() if n == "on"}  # whatever it is at the very edge

        def rates(
            t: float, x: list[float], own: Numbers = values, on: Numbers = held
        ) -> list[float]:
            return plant.rates(t, x, {**plant.inputs(t), **on}, own)

        inside = times[(times >= a) & (times < b)] if b < end else times[times >= a]
        at = np.unique([*inside, b])
        found = solve_ivp(rates, (a, b), state, "LSODA", at, rtol=1e-7, max_step=20 / plant.rate)
        rows.append(found.y[:, np.searchsorted(at, inside)])
        state = found.y[:, -1].tolist()
    states = np.concatenate(rows, axis=1)
    read = [plant.readings(x) for x in states.T.tolist()]
    told = [plant.inputs(t) for t in times.tolist()]
    draw = np.random.default_rng(7)
    columns = {name: np.array([r[name] for r in told]) for name in told[0]}
    for name in read[0]:
        column = np.array([r[name] for r in read])
        columns[name] = column + _NOISE * np.std(column) * draw.normal(size=len(column))
    return columns


@pytest.mark.parametrize("name", PLANTS)
def test_machines_of_other_domains(name: str, tmp_path_factory: pytest.TempPathFactory) -> None:
    plant = PLANTS[name]
    path = tmp_path_factory.mktemp(name) / "m.bg"
    path.write_text(f"bg 1\nmodel M {{{plant.model}}}\n")
    model = bondgraph.compile(str(path), rate=plant.rate)
    times = np.arange(_SAMPLES) / plant.rate
    onset = _ONSET / plant.rate
    columns = _run(plant, times, onset)
    engine = model.engine()
    decision = model.diagnosis(engine)
    rows = np.column_stack([columns[k.path] for k in engine.signals])
    said: list[Verdict] = []
    for k in range(0, _SAMPLES, 1000):
        part = rows[k : k + 1000]
        said += decision.update(times[k : k + 1000], engine.run(part), part)
    faults = [v.time for v in said if v.event == "fault"]
    assert faults and min(faults) >= onset, said
    watched = [v.time for v in said if v.event == "warm-up" and "watched" in v.message]
    assert watched and min(watched) < onset / 2
    last = [v for v in said if v.event == "update"][-1]
    assert plant.fault in {*last.group, *(c.fault for c in last.candidates)}
    named = [v.group for v in said if v.group]
    assert all(plant.fault in group and not plant.others & set(group) for group in named)
