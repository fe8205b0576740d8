"""The robot's five residuals as one chain of operations, in any kind of number: what other
generators of C are given (generators.py).

As written by hand in hand/step.c and with the same coefficients, but without what makes a sample
the first one and a residual valid: these tools write expressions, not programs with branches.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

Numbers = Mapping[str, Any]

_STATES = "r1_1 r1_2 r1_3 r2_1 r2_2 r2_3 q rate1 rate2".split()
_SAMPLES = "U0 We Ws Fx".split()

#: The states of both drives, then the cable's; the samples likewise; the residuals.
STATES = (*(f"{name}_{j}" for j in (1, 2) for name in _STATES), "r3_1")
SAMPLES = (*(f"{name}_{j}" for j in (1, 2) for name in _SAMPLES), "Uin", "Us")

_ABOVE = 0.0121918445997, 38.3188174726, 14915.8926299, 1581360.68088, 50661031.066, 359943924.938
_BELOW = 1.0, 909.519092296, 178021.202073, 10469617.8247, 170642338.756, 359943925.083


def coefficients(sample_time: float, bandwidth: float) -> dict[str, float]:
    """What hand_configure computes of the parameters of the paper's table 1."""
    L, Re, k, Je, fe, K = 300e-6, 17.6, 3.51e-3, 1.4e-8, 1.19e-5, 0.1
    N, Js, fs, R, tau0, A = 25.0, 0.1, 3e-4, 0.005, 0.01, -4.0
    T, w = sample_time, bandwidth
    a = (2.0 - w * T) / (2.0 + w * T)
    return {
        "a": a, "b": 0.5 * (1.0 - a), "bend1": (w * T) ** 2 / 12.0, "bend2": (w * T) ** 2 / 6.0,
        "e0": k + Re / k * fe, "s0": Re / k * fs / N, "x0": Re / k * R / N,
        "e1": w * (Re / k * Je + L / k * fe), "s1": w * (Re / k * Js + L / k * fs) / N,
        "x1": w * L / k * R / N, "e2": w * w * L / k * Je, "s2": w * w * L / k * Js / N,
        "n": N, "p2": w * w * Js / (N * K), "px": w * R / (N * K), "pw": w * A * tau0,
        "ge": T / 24.0 / (4.0 * tau0), "gs": T / 24.0 * N / (4.0 * tau0),
    }  # fmt: skip


#: Those of the filter are there once, those of a drive twice.
_SHARED = "a b bend1 bend2".split()
NAMES = (*_SHARED, *(f"{n}_{j}" for j in (1, 2) for n in coefficients(1, 1) if n not in _SHARED))


def own(c: Mapping[str, Any], drive: int) -> dict[str, Any]:
    """What belongs to a drive, and to both, by its name without a number."""
    end = f"_{drive}"
    return {k.removesuffix(end): v for k, v in c.items() if k.endswith(end) or k in _SHARED}


def step(
    c: Numbers, x: Numbers, s: Numbers, bounded: Callable[[Any, float], Any]
) -> tuple[list[Any], dict[str, Any]]:
    """The residuals r1 to r5 and the next states; `bounded` keeps a number within +-limit."""
    found, after = list[Any](), dict[str, Any]()
    for j in (1, 2):
        r1, r2, states = _drive(own(c, j), own(x, j), own(s, j), bounded)
        found += [r1, r2]
        after |= {f"{name}_{j}": value for name, value in states.items()}
    r5, after["r3_1"] = _stage(c, x["r3_1"], s["Uin"] - s["Us"])
    return [*found, r5], after


def _drive(
    c: Numbers, x: Numbers, s: Numbers, bounded: Callable[[Any, float], Any]
) -> tuple[Any, Any, dict[str, Any]]:
    We, Ws, Fx = s["We"], s["Ws"], s["Fx"]
    rate = c["ge"] * We - c["gs"] * Ws
    angle = x["q"] + 9.0 * rate + 4.0 * x["rate1"] - x["rate2"]
    g = (
        s["U0"] - c["e0"] * We - c["s0"] * Ws - c["x0"] * Fx,
        -c["e1"] * We - c["s1"] * Ws - c["x1"] * Fx,
        c["e2"] * We + c["s2"] * Ws,
    )
    r1, first = _chain(c, [x[f"r1_{k}"] for k in (1, 2, 3)], *g)
    load = c["pw"] * _tanh(bounded(angle, 9.6)) - c["px"] * Fx
    memory = [x[f"r2_{k}"] for k in (1, 2, 3)]
    r2, second = _chain(c, memory, We - c["n"] * Ws, load, c["p2"] * Ws)
    states = {"q": x["q"] + 24.0 * rate, "rate1": rate, "rate2": x["rate1"]}
    states |= {f"r1_{k}": first[k - 1] for k in (1, 2, 3)}
    states |= {f"r2_{k}": second[k - 1] for k in (1, 2, 3)}
    return r1, r2, states


def _chain(c: Numbers, s: list[Any], g0: Any, g1: Any, g2: Any) -> tuple[Any, list[Any]]:
    """g0 + p g1 - p^2 g2 over (1 + p/w)^3, and the memories of the stages after it."""
    off, d = c["bend1"] * g1, g2 + c["bend2"] * g0
    low = off - d
    more, high = low + off, g1 - low
    y3, s3 = _stage(c, s[2], g0 - high)
    y2, s2 = _stage(c, s[1], y3 + high - more)
    y1, s1 = _stage(c, s[0], y2 + more + off)
    return y1 - off, [s1, s2, s3]


def _stage(c: Numbers, s: Any, u: Any) -> tuple[Any, Any]:
    w = c["b"] * u
    y = s + w
    return y, c["a"] * y + w


def _tanh(x: Any) -> Any:
    z = x * x
    above, below = _ABOVE[0], z + _BELOW[1]
    for k in range(1, 6):
        above = above * z + _ABOVE[k]
    for k in range(2, 6):
        below = below * z + _BELOW[k]
    return x * above / below


def last(steps: int) -> list[float]:
    """The residuals after so many of the samples of hand/signals.h, in floats."""
    c = named(coefficients(0.001, 20.0))
    x = dict.fromkeys(STATES, 0.0)
    found, after = step(c, x, _sample(0), _bounded)
    for j in (1, 2):  # the backlash starts at rest on the first sample
        rate = after[f"rate1_{j}"]
        x |= {f"q_{j}": -12.0 * rate, f"rate1_{j}": rate, f"rate2_{j}": rate}
    for n in range(steps):
        found, x = step(c, x, _sample(n), _bounded)
    return found


def named(values: Mapping[str, float]) -> dict[str, float]:
    """The coefficients of both drives, which are alike."""
    return {name: values[name if name in values else name[:-2]] for name in NAMES}


def _bounded(value: float, limit: float) -> float:
    return max(min(value, limit), -limit)


def _sample(n: int) -> dict[str, float]:
    t = 0.001 * (n % 64)
    found = {"Uin": 5.0, "Us": 5.0 - 0.01 * math.sin(9.0 * t)}
    for j in (0, 1):
        We = 40.0 + 5.0 * math.sin(5.0 * t + j)
        Ws = We / 25.0 + 1e-3 * math.sin(3.0 * t)
        values = (3.0 + math.sin(6.28 * t + j), We, Ws, 0.06)
        found |= {f"{name}_{j + 1}": v for name, v in zip(_SAMPLES, values, strict=True)}
    return found
