"""Sampled PID loops, as a drive runs them."""

from __future__ import annotations

import math
from collections.abc import Callable

from bondgraph.runtime.simulation.scenario import Controller


class Pid:
    """One loop; `setpoint` is its course. Called once a period.

    The integral is kept by the trapezoidal rule and stands still while the output is at a limit
    and the error would drive it further (clamping).
    """

    def __init__(self, controller: Controller, setpoint: Callable[[float], float]) -> None:
        self.controller = controller
        self.setpoint = setpoint
        self.output = min(max(0.0, controller.limits[0]), controller.limits[1])
        self._integral = 0.0
        self._error: float | None = None
        self._seen: float | None = None

    def update(self, t: float, seen: float, unit: float = 1.0) -> float:
        """The output from now on; `seen` is the reading, `unit` of it in the sensor's unit.

        A reading that is not there (NaN) leaves the output as it is.
        """
        c = self.controller
        if math.isnan(seen):
            return self.output
        measured = seen * unit
        if c.speed:
            before, self._seen = self._seen, measured
            measured = 0.0 if before is None else (measured - before) / c.period
        error = self.setpoint(t) - measured
        before_error = error if self._error is None else self._error
        grown = self._integral + c.ki * c.period * (error + before_error) / 2
        wanted = c.kp * error + grown + c.kd * (error - before_error) / c.period
        low, high = c.limits
        if (wanted <= high or error < 0) and (wanted >= low or error > 0):
            self._integral = grown
        self._error = error
        self.output = min(max(wanted, low), high)
        return self.output
