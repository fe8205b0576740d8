"""A DC motor by hand, with a friction fault: the samples that the tests of the monitor watch."""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.integrate import solve_ivp

from bondgraph.runtime.log import Array, Log

#: When the friction triples, in s.
ONSET = 3.0
#: By how much, in N.m.s/rad.
FAULT = 2 * 1.19e-5
_L, _R, _K, _J, _F = 300e-6, 17.6, 3.51e-3, 1.4e-8, 1.19e-5
_RATE = 1000


def _voltage(t: Array | float) -> Array:
    return np.asarray(6.0 + 2.0 * np.sin(4.0 * np.asarray(t)))


def _rates(t: float, x: Array, f: float) -> list[float]:
    """Voltage balance of the armature, torque balance of the rotor."""
    current, speed = x
    return [
        (float(_voltage(t)) - _R * current - _K * speed) / _L,
        (_K * current - f * speed) / _J,
    ]


@cache
def log(seconds: float = 6.0, times: float = 3.0) -> Log:
    """What its sensors say, with noise; the friction is `times` f from `ONSET` on."""
    t = np.arange(round(seconds * _RATE)) / _RATE
    state = np.linalg.solve([[_R, _K], [_K, -_F]], [float(_voltage(0.0)), 0.0])
    parts = []
    for f, part in ((_F, t[t < ONSET]), (times * _F, t[t >= ONSET])):
        end = ONSET if part[:1].sum() == 0.0 else t[-1] + 1e-3
        if not len(part):
            continue
        found = solve_ivp(
            _rates, (part[0], end), state, "LSODA", np.append(part, end), args=(f,), rtol=1e-8,
            atol=1e-9,
        )  # fmt: skip
        parts.append(found.y[:, :-1])
        state = found.y[:, -1]
    current, speed = np.concatenate(parts, axis=1)
    rng = np.random.default_rng(4)
    columns = {
        "U": _voltage(t),
        "load": np.zeros(len(t)),
        "current": current + rng.normal(size=len(t)) * 1e-4,
        "speed": speed + rng.normal(size=len(t)) * 0.1,
    }
    return Log(t, columns, {}, {"model": "Motor"})
