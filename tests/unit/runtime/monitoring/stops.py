"""Machines with a law of position, by hand: an oil press with a bladder, an arm with a bumper."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from math import pi

import numpy as np
from scipy.integrate import solve_ivp

from bondgraph.runtime.log import Array

#: A motor turns a pump that presses oil into a bladder, which stiffens.
PRESS = """bg 1
model Press {
    input T : N.m
    param J = 2e-3 kg.m^2 +- 2%
    param b = 2e-2 N.m.s/rad +- 10%
    param D = 1.6e-6 m^3/rad +- 1%
    param B = 2e11 Pa/m^3 +- 5%
    param h = 3e19 Pa/m^9 +- 5%
    Se:T -> 1:shaft
    shaft {
        -> I:J
        -> R:b
        -> TF:D { f2 = D*f1 } -> 0:oil
    }
    oil {
        -> C:bladder(q0 = 0 m^3) { e = B*q + h*q^3 }
        -> De:p
    }
    sensor angle : rad = int(shaft.f) counts 8192/turn
}
"""

#: An arm that meets a bumper after half a radian, and feels nothing of it before.
BUMPER = """bg 1
model Bumper {
    input T : N.m
    param J = 1e-3 kg.m^2 +- 2%
    param b = 5e-3 N.m.s/rad +- 10%
    param k = 4 N.m/rad +- 5%
    const gap = 0.5 rad
    Se:T -> 1:arm
    arm {
        -> I:J
        -> R:b
        -> C:bumper(q0 = 0 rad) { e = k*max(0, q - gap) }
    }
    sensor angle : rad = int(arm.f) counts 20000/turn
}
"""

_RATE = 1000


def _run(rates: object, seconds: float, onset: float) -> tuple[Array, Array]:
    """The angle of a shaft that starts at rest; `rates` know whether the fault is there."""
    t = np.arange(round(seconds * _RATE)) / _RATE
    parts, state = [], [0.0, 0.0]
    for faulty, part in ((False, t[t < onset]), (True, t[t >= onset])):
        if len(part):
            grid = np.append(part, part[-1] + 1 / _RATE)
            found = solve_ivp(rates, (grid[0], grid[-1]), state, t_eval=grid, args=(faulty,),
                              rtol=1e-8, atol=1e-9, max_step=0.01)  # fmt: skip
            parts.append(found.y[0, :-1])
            state = found.y[:, -1]
    return t, np.concatenate(parts)


@cache
def press(seconds: float = 8.0, onset: float = 1e9, softer: float = 1.0) -> Mapping[str, Array]:
    """Its columns and the time; from the onset on the bladder is `softer` times as stiff."""
    J, b, D, B, h = 2e-3, 2e-2, 1.6e-6, 2e11, 3e19

    def torque(t: Array | float) -> Array:
        return np.asarray(8 + 6 * np.sin(1.9 * np.asarray(t)) + 4 * np.sin(3.1 * np.asarray(t) + 1))

    def pressure(angle: Array | float, faulty: Array | bool) -> Array:
        q = D * np.asarray(angle)
        return np.asarray((B * q + h * q**3) * np.where(faulty, softer, 1.0))

    def rates(t: float, x: list[float], faulty: bool) -> list[float]:
        return [x[1], (float(torque(t)) - b * x[1] - D * float(pressure(x[0], faulty))) / J]

    t, angle = _run(rates, seconds, onset)
    noise = np.random.default_rng(1).normal(size=len(t)) * 2e4
    return {
        "t": t,
        "T": torque(t),
        "p": pressure(angle, t >= onset) + noise,
        "angle": np.floor(angle * 8192 / (2 * pi)),
    }


@cache
def bumper(push: float, seconds: float = 8.0) -> Mapping[str, Array]:
    """Its columns and the time, with a `push` (N.m) at 5 s that drives the arm to the bumper."""

    def torque(t: Array | float) -> Array:
        t = np.asarray(t)
        return 4e-3 * np.sin(3 * t) + push * np.exp(-(((t - 5.5) / 0.3) ** 2))

    def rates(t: float, x: list[float], faulty: bool) -> list[float]:
        return [x[1], (float(torque(t)) - 5e-3 * x[1] - 4 * max(0.0, x[0] - 0.5)) / 1e-3]

    t, angle = _run(rates, seconds, 1e9)
    return {"t": t, "T": torque(t), "angle": np.floor(angle * 20000 / (2 * pi))}
