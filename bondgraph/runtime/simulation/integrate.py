"""Integration of state equations over one segment in which nothing jumps, by scipy's methods."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from bondgraph.runtime.simulation.machine import Machine

Array = npt.NDArray[np.float64]
Inputs = Callable[[float], Sequence[float]]

RELATIVE = 1e-7  # tolerance of one step, of each state
_ABSOLUTE = 1e-8  # tolerance in the unit of the effort or flow that a state goes with
_MANY = 300  # states from which on eigenvalues cost more than they tell
_RINGING = 1e5  # periods of one mode in a run: too many to follow


class SimulationError(Exception):
    """The machine cannot go on: no solution, or a law without a value; the message says when."""


class Integrator:
    """Chooses a method at the start of a run and keeps to it.

    `auto` is LSODA (Petzold, 1983), which finds out itself whether the machine is stiff; its
    multistep formulas are of no use where something rings far faster than the run is long, so that
    is left to Radau (Hairer and Wanner, 1996), which damps it.
    """

    def __init__(self, method: str, duration: float) -> None:
        self.method = method
        self.duration = duration

    def run(
        self, machine: Machine, inputs: Inputs, a: float, b: float, x: Array, wanted: Array
    ) -> Array:
        """The states at the `wanted` times in [a, b], and at b in the last row."""
        if not len(x) or b <= a:
            return np.tile(x, (len(wanted) + 1, 1))
        from scipy.integrate import solve_ivp

        if self.method == "auto":
            self.method = self._chosen(machine, inputs, a, x)
        at = np.unique(np.clip([*wanted, b], a, b))

        def rates(t: float, y: Array) -> Sequence[float]:
            return machine.rates(t, y.tolist(), inputs(t))

        options: dict[str, Any] = {"rtol": RELATIVE, "atol": _ABSOLUTE * machine.scale()}
        for method in dict.fromkeys((self.method, "Radau")):
            with np.errstate(all="ignore"):
                found = solve_ivp(rates, (a, b), x, method=method, t_eval=at, **options)
            if found.status == 0 and np.isfinite(found.y).all():
                rows = found.y.T
                return rows if len(wanted) < len(rows) else np.vstack([rows, rows[-1]])
        reached = float(found.t[-1]) if len(found.t) else a
        raise SimulationError(
            f"integration ended at {reached:g} s: a law has no value there, or the solution grows"
            " without bound"
        )

    def _chosen(self, machine: Machine, inputs: Inputs, t: float, x: Array) -> str:
        if len(x) >= _MANY:
            return "Radau"
        modes = np.linalg.eigvals(machine.jacobian(t, x, inputs(t)))
        ringing = float(np.max(np.abs(modes.imag))) * self.duration / (2 * np.pi)
        return "Radau" if ringing > _RINGING else "LSODA"
