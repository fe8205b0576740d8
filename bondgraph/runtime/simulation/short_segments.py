"""Integration in short segments that has to keep up with the time on the wall."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence

import numpy as np

from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation.integrate import Inputs, Integrator
from bondgraph.runtime.simulation.machine import Machine

_COARSE = 1e-6  # relative tolerance of a step: finer than instruments are
_STEPS = 20_000  # in one segment


class ShortSegments:
    """As `Integrator`, with less around it: LSODA (Petzold, 1983) straight from ODEPACK.

    A step is no finer than the tolerance 1e-6. What this cannot do, and all that a scenario names a
    method for, is left to `Integrator`, which also says what went wrong.
    """

    def __init__(self, method: str, tolerance: float, horizon: float) -> None:
        self._other = Integrator(method, tolerance, horizon)
        self._named = method != "auto"
        self._tolerance = max(tolerance, _COARSE)
        self._scales: dict[Machine, Array] = {}

    def run(
        self, machine: Machine, inputs: Inputs, a: float, b: float, x: Array, wanted: Array
    ) -> Array:
        """The states at the `wanted` times in [a, b], and at b in the last row.

        Raises `SimulationError` as `Integrator.run` does.
        """
        if len(x) and b > a and not self._named:
            found = self._quickly(machine, inputs, a, x, [*wanted.tolist(), b])
            if found is not None:
                return found
        return self._other.run(machine, inputs, a, b, x, wanted)

    def _quickly(
        self, machine: Machine, inputs: Inputs, a: float, x: Array, times: Sequence[float]
    ) -> Array | None:
        from scipy.integrate import ode

        if machine not in self._scales:
            self._scales[machine] = machine.scale(a, x.tolist(), inputs(a))
        slopes = machine.rates

        def rates(t: float, y: Array) -> Sequence[float]:
            return slopes(t, y.tolist(), inputs(t))

        solver = ode(rates).set_integrator(
            "lsoda",
            rtol=self._tolerance,
            atol=0.1 * self._tolerance * self._scales[machine],
            nsteps=_STEPS,
        )
        solver.set_initial_value(x, a)
        rows = np.empty((len(times), len(x)))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for k, t in enumerate(times):
                if t > solver.t:
                    solver.integrate(t)
                if not solver.successful() or not all(map(math.isfinite, solver.y)):
                    return None
                rows[k] = solver.y
        return rows
