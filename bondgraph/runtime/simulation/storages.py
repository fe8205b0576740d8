"""What storages hold: before the start, at rest, and where something jumps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from bondgraph.ir.graph import BondGraph
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation.integrate import SimulationError
from bondgraph.runtime.simulation.machine import Machine
from bondgraph.runtime.simulation.scenario import Scenario
from bondgraph.text.numerals import listed

_GOOD = 1e-7  # of the terms of a rate: what may be left of it
_ROUNDING = 1e-9  # of what a storage holds
_STEPS = 4  # in which an impulse comes, where it changes how storages move together


def start(
    machine: Machine,
    graph: BondGraph,
    scenario: Scenario,
    first: Sequence[float],
    before: Sequence[float],
) -> dict[str, float]:
    """The content of each storage by the name of its q or p.

    One that nothing is said of is empty; a dependent one is as the states say that it is, while
    what acts on the machine is as `before` the start. In the steady state it is that for what acts
    `first`. Raises `SimulationError` where there is none.
    """
    stated = {**machine.start(), **scenario.initial}
    x = [stated.get(name, 0.0) for name in machine.states]
    names = [i.name for i in machine.equations.dependent]
    if scenario.start == "steady" and machine.states:
        found = steady(machine, first, np.array(x))
        held = [*found.tolist(), *machine.content(0.0, found.tolist(), first).tolist()]
        return dict(zip((*machine.states, *names), held, strict=True))
    rest = machine.content(0.0, x, before).tolist()
    ports = [p for node in graph.nodes for p in node.ports if p.state is not None]
    every = {p.state.symbol.name: 0.0 for p in ports if p.state is not None}
    following = {n: v for n, v in zip(names, rest, strict=True) if v == v}
    return {**every, **dict(zip(machine.states, x, strict=True)), **following, **stated}


def steady(machine: Machine, u: Sequence[float], x: Array) -> Array:
    """The steady state nearest to where a search from x comes; inputs u as at the start.

    What only adds up, and acts on nothing (the angle of a motor, the place of a vehicle), may go on
    changing: it stays as it is in x. Raises `SimulationError`.
    """
    from scipy.optimize import least_squares

    pattern = machine.pattern().toarray() != 0
    inner = np.ones(len(x), dtype=bool)
    while True:
        acting = inner & pattern[inner].any(axis=0)
        if (acting == inner).all():
            break
        inner = acting
    if not inner.any():
        return x
    scale = machine.scale(0.0, x.tolist(), u)

    def whole(part: Array) -> Array:
        full = x.copy()
        full[inner] = part * scale[inner]
        return full

    def rates(part: Array) -> Array:
        found = np.array(machine.rates(0.0, whole(part).tolist(), u))[inner]
        return np.asarray(np.nan_to_num(found / scale[inner], nan=1e30, posinf=1e30, neginf=-1e30))

    start = x[inner] / scale[inner]
    with np.errstate(all="ignore"):
        found = least_squares(rates, start, x_scale="jac", xtol=1e-15, ftol=1e-15, gtol=1e-15)
        for _ in range(3):  # to the last digits, which minimising a square does not give
            slopes = machine.jacobian(0.0, whole(found.x), u)[np.ix_(inner, inner)]
            slopes = slopes * scale[inner] / scale[inner][:, None]
            step = np.linalg.lstsq(slopes, rates(found.x), rcond=1e-12)[0]
            if np.abs(rates(found.x - step)).max() < np.abs(rates(found.x)).max():
                found.x = found.x - step
    terms = np.abs(slopes) @ np.maximum(np.abs(found.x), 1.0)
    left = np.abs(rates(found.x)) > _GOOD * terms
    if left.any():
        names = [n for n, own in zip(machine.states, inner.tolist(), strict=True) if own]
        moving = [f"`{n}`" for n, bad in zip(names, left.tolist(), strict=True) if bad]
        told = ", ".join(moving[:4])
        raise SimulationError(
            f"no steady state was found: {told} goes on changing; the search begins with the"
            " initial values, and with zero where there are none: give some near to it, [initial]"
        )
    return whole(found.x)


def handed_over(machine: Machine, t: float, u: Sequence[float], held: Mapping[str, float]) -> Array:
    """The states of a machine whose storages hold `held` (by the name of their q or p).

    States go on with what they hold. A storage that depends on them (derivative causality) may
    have to change at once: a clutch that closes, a source that jumps across two capacitors in
    series. Its balance then has an impulse in it, and so have those of all that it moves with:
    what it loses is given to the machine from outside within no time, which keeps momentum and
    charge (Karnopp, Margolis and Rosenberg, System Dynamics, on inelastic impacts). Raises
    `SimulationError` where a law has no value on the way.
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
    if not np.isfinite(x).all():
        names = listed([f"`{i.name}`" for i, own in zip(impulses, jumps, strict=True) if own])
        raise SimulationError(
            f"the run ends at {t:.6g} s: what {names} holds has to change at once there, to agree"
            " with the other storages, and on the way a law or loop has no value"
        )
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
