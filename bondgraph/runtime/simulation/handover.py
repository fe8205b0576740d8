"""What storages hold where something jumps: states go on, and impulses are shared out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation.machine import Machine

_ROUNDING = 1e-9  # of what a storage holds
_STEPS = 4  # in which an impulse comes, where it changes how storages move together


def handed_over(machine: Machine, t: float, u: Sequence[float], held: Mapping[str, float]) -> Array:
    """The states of a machine whose storages hold `held` (by the name of their q or p).

    States go on with what they hold. A storage that depends on them (derivative causality) may
    have to change at once: a clutch that closes, a source that jumps across two capacitors in
    series. Its balance then has an impulse in it, and so have those of all that it moves with:
    what it loses is given to the machine from outside within no time, which keeps momentum and
    charge (Karnopp, Margolis and Rosenberg, System Dynamics, on inelastic impacts).
    """
    x = np.array([held.get(name, 0.0) for name in machine.states])
    impulses = machine.equations.dependent
    if not impulses or not len(x):
        return x
    now = machine.content(t, x.tolist(), u)
    kept = np.array([held.get(i.name, np.nan) for i in impulses])
    size = np.fmax(np.abs(kept), np.abs(now))
    jumps = np.isfinite(kept) & np.isfinite(now) & (np.abs(kept - now) > _ROUNDING * size)
    if not jumps.any():
        return x
    push = np.where(jumps, kept - now, 0.0)

    def moved(y: Array) -> Array:
        return _response(machine, t, y, u, push)

    for _ in range(_STEPS):  # the classical Runge-Kutta method, along the impulse
        k1 = moved(x)
        k2 = moved(x + k1 / (2 * _STEPS))
        k3 = moved(x + k2 / (2 * _STEPS))
        k4 = moved(x + k3 / _STEPS)
        x = x + (k1 + 2 * k2 + 2 * k3 + k4) / (6 * _STEPS)
    return x


def _response(machine: Machine, t: float, x: Array, u: Sequence[float], push: Array) -> Array:
    """How the states move with an impulse; rates are linear in it."""
    none = np.array(machine.rates(t, x.tolist(), u))
    scale = max(1.0, float(np.abs(none).max()) / float(np.abs(push).max()))
    pushed = list(u)
    for place, value in zip(machine.impulses, push.tolist(), strict=True):
        if place is not None:
            pushed[place] = scale * value
    return np.asarray((np.array(machine.rates(t, x.tolist(), pushed)) - none) / scale)
