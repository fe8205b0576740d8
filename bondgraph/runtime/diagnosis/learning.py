"""The noise of residuals where nobody has tuned, from the first samples of a healthy machine."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from bondgraph.runtime.diagnosis.healthy import DiagnosisModel
from bondgraph.runtime.diagnosis.hypotheses import COUNT, Bank, Hypothesis, rows_apart
from bondgraph.runtime.diagnosis.rows import Part, Row
from bondgraph.runtime.diagnosis.tuning import height, kappa
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Engine

STEPS = 10  # differences of neighbouring rows that the noise of a residual is taken from
_CAREFUL = 2.0  # times the deviation that they show: there are few of them
_NORMAL = 1.4826  # deviation of normal numbers, over the median of their sizes
_ACCURACY = 1e-4  # of the terms of a residual: no sensor and no sampled law is better
_ABOVE = 1.2  # times the largest excess of what is healthy that a limit stays above
_BIASED = 2.0  # the same, where it is no noise and may become more
_HOPELESS = 1.2  # times what noise may do: an approximation that is that far off tells nothing
_MANY = 4 * STEPS  # differences after which switches that are turned all the time are known
_QUARTER = 1.1503  # size that a quarter of normal numbers exceed, over their deviation
_ALARMS = 1.0  # false ones wanted per hour

_Settings: TypeAlias = frozenset[tuple[float, ...]]  # positions of the switches of a residual


class Learning:
    """Learns residual by residual: one that is valid late, or still at rest, is learned later.

    Noise is what neighbouring rows differ by. It is not taken for less than a ten-thousandth of
    what signals do to the residual: samples without noise, as of a simulation, are no reason to
    trust their last digits. Of one that drifts or is an approximation, it is also where it has
    come to: no sample can tell that from a machine that is well, and no sum of it tells anything.
    Where an approximation is far off it is `hopeless`. A single sample that was far off is noise.

    Noise is learned for each position of the switches that a residual reads: it comes from other
    readings then. Where they never rest for long, it is learned for all of them together.
    """

    def __init__(
        self,
        engine: Engine,
        known: Sequence[Hypothesis],
        used: Mask,
        model: DiagnosisModel,
    ) -> None:
        counted = {h.fault for h in known if h.unit == COUNT}  # exact, however far they have come
        self._gains = tuple(h for h in known if h.kind == "gain" and h.fault not in counted)
        self._engine = engine
        self._steps: list[dict[_Settings, list[float]]] = [{} for _ in used]
        self._all: list[list[tuple[float, _Settings]]] = [[] for _ in used]
        self._scale = np.zeros(len(used))
        natures = [model.natures[n] for n in engine.residuals]
        place = {k.path: at for at, k in enumerate(engine.signals)}
        self._modes = [[place[m] for m in n.modes] for n in natures]
        self._learned: list[_Settings] = [frozenset() for _ in used]
        self._met: list[_Settings] = [frozenset() for _ in used]  # that were told to be new
        self._sigma = np.zeros(len(used))  # in all settings that were learned
        self._peak = np.full(len(used), -math.inf)  # of this row, and of all that counted
        self._highest = np.zeros(len(used))
        self._approximate = np.array([n.approximate for n in natures], dtype=bool)
        self._stays = self._approximate | np.array([n.drifts for n in natures], dtype=bool)
        self.hopeless = np.zeros(len(used), dtype=bool)  # approximations that are too far off
        self._wanted = used.copy()
        alarms = _ALARMS / 3600.0 / (2 * max(1, int(used.sum())))
        crossings = engine.bandwidth / 4.0
        rows = 1.0 / (rows_apart(engine) * engine.sample_time)
        limit = kappa(crossings, alarms), height(rows, alarms)
        self.limits = np.tile([math.inf, crossings, *limit], (len(used), 1))
        self.limits[self._stays, 3] = math.inf
        self.restart()

    def restart(self) -> None:
        """The residuals begin anew."""
        self._bank = Bank(self._engine.configured(bounds=False), self._gains, {})
        self._last = np.full(len(self._wanted), math.nan)
        self._now: list[_Settings] = [frozenset() for _ in self._wanted]  # in this row
        self._before: list[_Settings] = [frozenset() for _ in self._wanted]
        self._peak[:] = -math.inf

    @property
    def over(self) -> bool:
        """Whether nothing is left to be learned, however the switches are turned."""
        return not self._wanted.any() and not any(self._modes)

    def known(self, limits: Array) -> None:
        """Take over limits that were learned before, in whatever positions of the switches."""
        self.limits = limits
        own = np.isfinite(limits[:, 0])
        self._wanted &= ~own
        self._modes = [[] if o else m for m, o in zip(self._modes, own, strict=True)]

    def part(self, part: Part, healthy: bool) -> Mask:
        """Samples of a row that is not full yet.

        Returns the residuals whose noise has to be learned again, for switches as never before.
        """
        excess = np.where(part.valid, np.abs(part.value) - part.bound, -math.inf)
        self._peak = np.maximum(self._peak, excess.max(axis=0, initial=-math.inf))
        fresh = np.zeros(len(self._wanted), dtype=bool)
        for k in [k for k, m in enumerate(self._modes) if m]:
            now = _settings(part.samples[:, self._modes[k]])
            self._now[k] |= now
            if self._wanted[k] or not healthy or now <= self._learned[k]:
                continue
            self._wanted[k], self.limits[k, 0] = True, math.inf
            fresh[k] = not now <= self._met[k]
            self._met[k] |= now
        return fresh

    def row(self, row: Row, healthy: bool) -> Mask:
        """One row more, which counts if the machine is `healthy`.

        Returns the residuals whose noise is known with it.
        """
        valid = row.valid & healthy
        fresh = np.zeros_like(valid)
        sizes = np.abs(self._bank.run(row.samples)[-1]).max(axis=0, initial=0.0)
        value = np.where(valid, row.value, math.nan)
        step, self._last = np.abs(value - self._last) / math.sqrt(2.0), value
        self._highest = np.maximum(self._highest, np.where(valid, self._peak, 0.0))
        for k in np.flatnonzero(self._wanted).tolist():
            both = self._now[k] | self._before[k]
            if self._learned[k] and both <= self._learned[k]:  # back to what is known
                self._wanted[k], self.limits[k, 0] = False, self._sigma[k]
            elif np.isfinite(step[k]) and self._stepped(k, both, float(step[k]), sizes[k]):
                fresh[k] = True
        self._peak[:] = -math.inf
        self._now, self._before = [frozenset() for _ in self._now], self._now
        return fresh

    def _stepped(self, k: int, setting: _Settings, step: float, size: float) -> bool:
        """One step more of a residual; whether its noise is known by that."""
        self._scale[k] = max(self._scale[k], size)
        steps = [*self._steps[k].get(setting, []), step][-STEPS:]
        self._steps[k][setting] = steps
        self._all[k] = [*self._all[k], (step, setting)][-_MANY:]
        spread = _NORMAL * float(np.median(steps))
        if len(steps) < STEPS:
            if len(self._all[k]) < _MANY:
                return False
            spread = float(np.quantile([s for s, _ in self._all[k]], 0.75)) / _QUARTER
            setting = frozenset().union(*[own for _, own in self._all[k]])
        above = _BIASED if self._stays[k] else _ABOVE
        noise = max(_CAREFUL * spread, _ACCURACY * float(self._scale[k]))
        highest = float(self._highest[k] / self.limits[k, 2])
        if self._approximate[k] and highest > _HOPELESS * noise:
            self.hopeless[k], self._wanted[k] = True, False
            return False
        sigma = max(noise, above * highest, float(self._sigma[k]))
        if not 0.0 < sigma < math.inf:
            return False
        self.limits[k, 0] = self._sigma[k] = sigma
        self._wanted[k], self._learned[k] = False, self._learned[k] | setting
        return True


def _settings(modes: Array) -> _Settings:
    return frozenset(map(tuple, np.unique(modes, axis=0).tolist()))
