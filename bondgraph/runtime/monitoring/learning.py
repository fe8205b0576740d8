"""The noise of residuals where nobody has tuned, from the first samples of a healthy machine."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.runtime.monitoring.healthy import Facts
from bondgraph.runtime.monitoring.hypotheses import COUNT, Bank, Hypothesis, rows_apart
from bondgraph.runtime.monitoring.rows import Row
from bondgraph.runtime.monitoring.tuning import height, kappa

STEPS = 10  # differences of neighbouring rows that the noise of a residual is taken from
_CAREFUL = 2.0  # times the deviation that they show: there are few of them
_NORMAL = 1.4826  # deviation of normal numbers, over the median of their sizes
_ACCURACY = 1e-4  # of the terms of a residual: no sensor and no sampled law is better
_ALARMS = 1.0  # false ones wanted per hour


class Learning:
    """Learns residual by residual: one that is valid late, or still at rest, is learned later.

    Noise is what neighbouring rows differ by. It is not taken for less than a ten-thousandth of
    what signals do to the residual: samples without noise, as of a simulation, are no reason to
    trust their last digits. Of one that drifts or is an approximation, it is also where it has
    come to: no sample can tell that from a machine that is well.
    """

    def __init__(
        self,
        engine: Engine,
        known: Sequence[Hypothesis],
        used: npt.NDArray[np.bool_],
        facts: Facts,
    ) -> None:
        counted = {h.fault for h in known if h.unit == COUNT}  # exact, however far they have come
        self._gains = tuple(h for h in known if h.kind == "gain" and h.fault not in counted)
        self._engine = engine
        self._steps: list[list[float]] = [[] for _ in used]
        self._scale = np.zeros(len(used))
        self._away = np.zeros(len(used))  # above the threshold, so far
        natures = [facts.natures[n] for n in engine.residuals]
        self._stays = np.array([n.drifts or n.approximate for n in natures], dtype=bool)
        self._wanted = used.copy()
        alarms = _ALARMS / 3600.0 / (2 * max(1, int(used.sum())))
        crossings = engine.bandwidth / 4.0
        rows = 1.0 / (rows_apart(engine) * engine.sample_time)
        limit = kappa(crossings, alarms), height(rows, alarms)
        self.limits = np.tile([math.inf, crossings, *limit], (len(used), 1))
        self.restart()

    def restart(self) -> None:
        """The residuals begin anew."""
        self._bank = Bank(self._engine.configured(bounds=False), self._gains, {})
        self._last = np.full(len(self._wanted), math.nan)

    @property
    def over(self) -> bool:
        """Whether nothing is left to be learned."""
        return not self._wanted.any()

    def known(self, limits: Array) -> None:
        """Take over limits that were learned before."""
        self.limits = limits
        self._wanted &= ~np.isfinite(limits[:, 0])

    def row(self, row: Row, healthy: bool) -> npt.NDArray[np.bool_]:
        """One row more, which counts if the machine is `healthy`.

        Returns the residuals whose noise is known with it.
        """
        valid = row.valid & healthy
        fresh = np.zeros_like(valid)
        away = np.where(valid & self._stays, np.abs(row.value) - row.bound, 0.0)
        self._away = np.maximum(self._away, away)
        sizes = np.abs(self._bank.run(row.samples)[-1]).max(axis=0, initial=0.0)
        value = np.where(valid, row.value, math.nan)
        step, self._last = np.abs(value - self._last) / math.sqrt(2.0), value
        for k in np.flatnonzero(self._wanted & np.isfinite(step)):
            self._scale[k] = max(self._scale[k], sizes[k])
            self._steps[k] = [*self._steps[k], float(step[k])][-STEPS:]
            spread = _CAREFUL * _NORMAL * float(np.median(self._steps[k]))
            sigma = max(spread, _ACCURACY * float(self._scale[k]), float(self._away[k]))
            if len(self._steps[k]) == STEPS and 0.0 < sigma < math.inf:
                self.limits[k, 0] = sigma
                self._wanted[k], fresh[k] = False, True
        return fresh
