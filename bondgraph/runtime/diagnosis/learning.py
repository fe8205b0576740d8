"""The noise of residuals where nobody has tuned, from the rows of a machine that is well."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping, Sequence
from itertools import islice
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from bondgraph.runtime.diagnosis.driving import SETTLES, Driving, Misread
from bondgraph.runtime.diagnosis.healthy import DiagnosisModel, centred, tolerated
from bondgraph.runtime.diagnosis.history import within_tolerance
from bondgraph.runtime.diagnosis.hypotheses import COUNT, Bank, Hypothesis, rows_apart
from bondgraph.runtime.diagnosis.noise import (
    CAREFUL,
    FILTERED,
    Noise,
    noise,
    stepped,
    uncovered,
    within,
)
from bondgraph.runtime.diagnosis.row_averages import WHITE, lasting
from bondgraph.runtime.diagnosis.rows import Part, Row, variances
from bondgraph.runtime.diagnosis.standing import Levels
from bondgraph.runtime.diagnosis.tuning import Limit, height, kappa
from bondgraph.runtime.diagnosis.wander import wander
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.runtime.monitoring.plain import array
from bondgraph.text.tuples import NamedTuple

FIRST = 10  # rows with which the noise of a residual counts as known
_MORE = 1.15  # times as many rows before it is estimated again
_MOST = 512  # rows, after which it stays as it is
LATE = 5  # rows before an alarm that may have been faulty already
_ACCURACY = 1e-4  # of what signals move a residual by: no sensor and no sampled law is better
_DIGITS = 1e-6  # of the terms themselves: with less, rows have no noise that could be measured
_ABOVE = 1.2  # times the largest excess of what is healthy that a limit stays above
_BIASED = 2.0  # the same, where it is no noise and may become more
_HOPELESS = 1.2  # times what noise may do: an approximation that is that far off tells nothing
_MANY = 4 * FIRST  # rows after which switches that are turned all the time are known
_OFF = 4.0  # deviations of a mean that is surely not zero
_WALKED = 3.0  # times the way of a walk of as many rows: five deviations of its middle
_TESTS = 4  # of each residual: samples, sums of rows and of averages, how loud rows are
_ALARMS = 0.4  # false ones wanted per hour: one is promised, and noise is not quite normal

_Settings: TypeAlias = frozenset[tuple[float, ...]]  # positions of the switches of a residual


class Learning:
    """Learns residual by residual: one that is valid late, or still at rest, is learned later.

    With the first rows a residual is watched, and its limits are as wide as few rows ask for; with
    every further row of a healthy machine more is known (see `Noise`). Noise is what is left of a
    residual once parameters within their tolerances are taken as they fit best. It is not taken for
    less than a ten-thousandth of what signals have moved the residual by (see `_least`), nor for
    less than what a single sample of the first rows has shown.

    A residual that drifts has no such noise. What neighbouring rows differ by is, and where it has
    come to: no sample can tell that from a machine that is well, and no sum of it tells anything.
    An approximation that is far off from the start is `hopeless`.

    Noise is learned for each position of the switches that a residual reads: it comes from other
    readings then. Where they never rest for long, it is learned for all of them together. And it is
    learned anew where the machine is driven as never before (see `Driving`): what is known then is
    the noise of a machine at rest. Where the way of a residual is that of an input which is read
    wrongly, what is known of it holds. Where tolerances were declared, the adaptive threshold grows
    with the motion, and tells what the model is wrong by: the residual is watched on, but `unsure`,
    so that it may be anywhere within its tolerances.
    """

    def __init__(
        self,
        engine: Engine,
        known: Sequence[Hypothesis],
        used: Mask,
        model: DiagnosisModel,
    ) -> None:
        self.levels = Levels(len(used))  #: where residuals stand, as they wander
        counted = {h.fault for h in known if h.unit == COUNT}  # exact, however far they have come
        self._gains = tuple(h for h in known if h.kind == "gain" and h.fault not in counted)
        self._engine = engine
        self._rows: deque[_Healthy] = deque(maxlen=_MOST)
        self._counts = np.zeros(len(used), dtype=int)  # of healthy rows
        self._added = _nothing((len(self._gains), len(used)))  # by signals, in healthy rows
        natures = [model.natures[n] for n in engine.residuals]
        place = {k.path: at for at, k in enumerate(engine.signals)}
        self._modes = [[place[m] for m in n.modes] for n in natures]
        self._learned: list[_Settings] = [frozenset() for _ in used]
        self._met: list[_Settings] = [frozenset() for _ in used]  # that were told to be new
        self._peak = np.full((2, len(used)), -math.inf)  # of this row, to either side
        self._highest = np.full((2, len(used)), -math.inf)  # of all that counted
        self._inputs = [j for j, h in enumerate(self._gains)
                        if engine.signals[place[h.fault]].kind == "input"]  # fmt: skip
        paths = [self._gains[j].fault for j in self._inputs]
        sees = [model.sees.get(r, ()) for r in engine.residuals]
        self._covered = np.array([any(model.tolerances.get(f) for f in own) for own in sees])
        self.unsure = np.zeros(len(used), dtype=bool)  # known from a machine that was hardly driven
        self._read = tuple(h for path in paths for h in known
                           if h.kind == "offset" and h.fault == path)  # fmt: skip
        self._forgotten: dict[int, _Known] = {}  # for a motion that may be none
        reads = [[path in own for own in sees] for path in paths]
        reading = np.array(reads, dtype=bool).reshape(len(paths), len(used))
        pace, apart = 1.0 / (engine.bandwidth * engine.sample_time), rows_apart(engine)
        self._driving = Driving([place[path] for path in paths], reading, pace, apart)
        self._approximate = np.array([n.approximate for n in natures], dtype=bool)
        self._drifts = np.array([n.drifts for n in natures], dtype=bool)
        self._centred = centred(model, engine.residuals)
        remembers = {r for m in model.memories for r in m.residuals}
        self._rests = [not (n.drifts or n.approximate) and r not in remembers
                       for r, n in zip(engine.residuals, natures, strict=True)]  # fmt: skip
        counted = {k.path for k in engine.signals if k.counts is not None}
        sums = {r for m in model.memories if m.integral and not counted & set(m.signals)
                for r in m.residuals}  # fmt: skip
        #: Of which the start is declared: where that is wrong, they stand elsewhere for ever.
        self.declared = np.array([r in sums for r in engine.residuals]) & ~self._approximate
        self.hopeless = np.zeros(len(used), dtype=bool)  # approximations that are too far off
        self.off = np.zeros(len(used), dtype=bool)  # residuals that are surely not zero in the mean
        self._used, self._wanted = used.copy(), used.copy()
        self._sigma: list[dict[_Settings, float]] = [{} for _ in used]
        self._due = np.full(len(used), FIRST)  # rows with which the noise is estimated again
        alarms = _ALARMS / 3600.0 / (_TESTS * max(1, int(used.sum())))
        crossings = engine.bandwidth / 4.0
        rows = 1.0 / (rows_apart(engine) * engine.sample_time)
        limit = Limit(math.inf, crossings, kappa(crossings, alarms), height(rows, alarms))
        self.limits = np.tile(np.array(limit, dtype=float), (len(used), 1))
        self.limits[self._drifts, 3] = math.inf
        self.limits[:, 13] = [0.0 if modes else math.inf for modes in self._modes]
        self._acted = np.zeros(len(used))  # what half a sample of the commands made at most
        values = [h for h in known if h.kind == "value"]
        self._prior = tolerated(values, model)[1]
        every, _ = tolerated(known, model)  # rows have the slopes of all of these
        self._values = [at for at, h in enumerate(every) if h.kind == "value"]
        self.restart()

    def restart(self) -> None:
        """The residuals begin anew."""
        self._bank: Bank | None = None
        self._driving.restart()
        self._now: list[_Settings] = [frozenset() for _ in self._wanted]  # in this row
        self._before: list[_Settings] = [frozenset() for _ in self._wanted]
        self._sound = np.ones(len(self._wanted), dtype=np.bool_)  # that have a value in all of it
        self._peak[:] = -math.inf

    @property
    def first(self) -> bool:
        """Whether some residual has a noise that nobody knows."""
        return bool(self._wanted.any())

    @property
    def over(self) -> bool:
        """Whether nothing is left to be learned, however the switches are turned."""
        known = (self._due > _MOST) | ~self._used | self.hopeless
        return bool(known.all()) and not any(self._modes) and not self._driving

    def state(self) -> dict[str, Any]:
        """How the machine was driven, as plain JSON."""
        return {**self._driving.state(), "unsure": self.unsure.tolist()}

    def resume(self, limits: Array, state: Mapping[str, Any] | None) -> None:
        """Take over limits that were learned before, in whatever positions of the switches.

        Raises KeyError, TypeError or ValueError for a `state` of another kind.
        """
        if state is not None:
            self._driving.resume(state)
        self.limits = limits
        own = np.isfinite(limits[:, 0])
        self._wanted &= ~own
        if state is not None:
            self.unsure = array(state["unsure"], self.unsure.shape) != 0.0
        self._due[own & ~self.unsure] = _MOST + 1
        self._modes = [[] if o else m for m, o in zip(self._modes, own, strict=True)]

    def part(self, part: Part, healthy: bool, acted: Array) -> tuple[Mask, Mask]:
        """Samples of a row that is not full yet, with what half a sample of the commands makes.

        Returns the residuals whose noise has to be learned again: as switches stand as never
        before, and as the machine is driven as never before.
        """
        mean = self.limits[:, 4]
        for side, value in enumerate((part.value + mean, -part.value - mean)):
            excess = np.where(part.valid, value - part.bound, -math.inf)
            self._peak[side] = np.maximum(self._peak[side], excess.max(axis=0, initial=-math.inf))
        if len(acted):
            self._acted = np.maximum(self._acted, acted.max(axis=0))
        switched, driven = np.zeros((2, len(self._wanted)), dtype=bool)
        for k in [k for k, m in enumerate(self._modes) if m]:
            now = _settings(part.samples[:, self._modes[k]])
            self._now[k] |= now
            if self._wanted[k] or not healthy or now <= self._learned[k]:
                continue
            self._wanted[k], self.limits[k, 0] = True, math.inf
            switched[k] = not now <= self._met[k]
            self._met[k] |= now
        self._sound &= part.valid.all(axis=0)
        if self._driving:
            limit = self.limits[:, 2] * self.limits[:, 0]
            sure = healthy & ~self._wanted & ~self.hopeless & self._sound
            anew = self._driving.anew(limit, sure)
            self._driving.show(part, limit)
            for k in np.flatnonzero(anew & sure).tolist():
                self._forget(k)
                driven[k] = not self._covered[k]
        return switched, driven

    def _forget(self, k: int) -> None:
        """What is known of the noise of a residual does not hold any longer."""
        self._forgotten[k] = _Known(
            self.limits[k].copy(), self._sigma[k], self._learned[k], self._highest[:, k].copy(),
            int(self._counts[k]), int(self._due[k]), bool(self.unsure[k]),
            self._driving.misread(k, float(self.limits[k, 4])),
        )  # fmt: skip
        self._lost(np.where(np.arange(len(self._wanted)) == k, _MOST, 0))
        self._counts[k], self._due[k] = 0, FIRST
        self._sigma[k], self._learned[k] = {}, frozenset()
        self._highest[:, k] = -math.inf
        if self._covered[k]:
            self.unsure[k] = True
        else:
            self._wanted[k], self.limits[k, 0] = True, math.inf

    @property
    def anew(self) -> bool:
        """Whether noise is learned anew: what was known before is of a machine at rest."""
        return bool(self._forgotten)

    @property
    def settling(self) -> Mask:
        """Which residuals are not judged, as they show an input that is faster than ever."""
        return self._driving.settling

    def room(self, samples: Array) -> Array:
        """See `Driving.room`."""
        return self._driving.room(samples) if self._driving else np.zeros((1, len(self._used)))

    def _misread(self, samples: Array, value: Array, unit: Array) -> Mask:
        """Which residuals are watched again, as what was forgotten of them holds.

        Most of the rows that noise is learned from have none of a motion. Here is a row more of
        `samples`; `value` has those that count, and `unit` what inputs add for one, (inputs,
        residuals).
        """
        found = np.zeros(len(value), dtype=bool)
        for k, old in self._forgotten.items():
            if np.isfinite(value[k]):
                old.misread.row(samples, unit[:, k], float(value[k]))
            found[k] = 2 * old.misread.rows > FIRST
        unwatched = ~np.isfinite(self.limits[:, 0])
        for k in np.flatnonzero(found).tolist():
            self._recall(k)
        return np.asarray(found & unwatched)

    def _recall(self, k: int) -> None:
        """What was forgotten of a residual holds."""
        old = self._forgotten.pop(k)
        self._lost(np.where(np.arange(len(self._wanted)) == k, _MOST, 0))
        self.limits[k], self._sigma[k], self._learned[k] = old.limits, old.sigma, old.learned
        self._highest[:, k], self._counts[k], self._due[k] = old.highest, old.rows, old.due
        self.unsure[k], self._wanted[k] = old.unsure, False

    def alarm(self, held: Array) -> None:
        """Something is wrong, and may have been for some rows, as many as are `held` or more."""
        self._lost(np.maximum(held, LATE))

    def _lost(self, last: npt.NDArray[np.intp]) -> None:
        """So many of the last rows count no longer, of each residual."""
        for ago, row in enumerate(islice(reversed(self._rows), int(last.max(initial=0)))):
            row.value[last > ago] = row.average[last > ago] = math.nan

    def row(self, row: Row, healthy: bool, held: Array) -> Mask:
        """One row more, which counts if the machine is `healthy`.

        Of each residual so many of the last rows are `held` back: they may be those of a fault that
        is small, and nothing that is known is changed by them. Returns the residuals whose noise is
        known with it.
        """
        valid, slopes = row.valid & healthy, row.slopes[self._values]
        added, unit = self._terms(row)
        limit = self.limits[:, 2] * self.limits[:, 0]
        stayed = self._driving.learned(row, valid, added[self._inputs], limit)
        held = np.maximum(held, self._driving.unsettled)
        self._lost(np.where(stayed, SETTLES - 1, 0))
        valid &= ~stayed
        self._added[0] = np.fmin(self._added[0], np.where(valid, added, math.nan))
        self._added[1] = np.fmax(self._added[1], np.where(valid, added, math.nan))
        first = np.where(valid & self._wanted, self._peak, -math.inf)
        self._highest = np.maximum(self._highest, first)
        settings = [now | before for now, before in zip(self._now, self._before, strict=True)]
        raw = np.where(valid, row.value + self.limits[:, 4], math.nan)
        average, tilt = np.full_like(raw, math.nan), np.zeros_like(slopes)
        if row.average is not None:
            sound = valid & row.average.valid
            average = np.where(sound, row.average.value + self.limits[:, 4], math.nan)
            tilt = row.average.slopes[self._values]
        self._rows.append(_Healthy(raw, row.bound, slopes, average, tilt, settings))
        self._counts += valid
        fresh = self._misread(row.samples, raw, unit)
        rest: tuple[Array, Array, Array, Array] | None = None
        for k in np.flatnonzero(valid & self._used & ~self.hopeless).tolist():
            if self._wanted[k] and self._sigma[k] and settings[k] <= self._learned[k]:
                self._wanted[k] = False  # back to what is known
                self.limits[k, 0] = max(self._sigma[k].values())
            if self._wanted[k] or self._due[k] <= min(self._counts[k] - held[k], _MOST):
                rest = rest or self._rest()
                fresh[k] = self._estimated(k, settings[k], *rest, int(held[k]))
        self._peak[:] = -math.inf
        self._sound[:] = True
        self._now, self._before = [frozenset() for _ in self._now], self._now
        return fresh

    def _terms(self, row: Row) -> tuple[Array, Array]:
        """What signals add to residuals, (signals, residuals), while few rows are known.

        And what inputs add for a unit, (inputs, residuals).
        """
        known = (*self._gains, *self._read)
        slopes = np.full((len(known), len(self._used)), math.nan)
        if not ((self._counts < _MANY) & self._used & ~self.hopeless).any():
            self._bank = None
        else:
            if self._bank is None:
                self._bank = Bank(self._engine.configured(bounds=False), known, {})
            found = self._bank.run(row.samples)[-1]
            batch = self._bank.batch
            slopes = np.where(batch is not None and batch.valid[-1], found, math.nan)
        return slopes[: len(self._gains)], slopes[len(self._gains) :]

    def _least(self, noise: Array | float) -> Array:
        """What is taken for the noise of residuals at least, where rows show so much.

        It is a share of what signals moved them by in these rows, wherever the zeros of signals
        are. Rows without noise, as of a simulation at rest, tell nothing: then of all of a signal.
        """
        moved = np.maximum(self._added[1] - self._added[0], 0.0).max(axis=0, initial=0.0)
        sizes = np.where(np.isfinite(self._added), np.abs(self._added), 0.0)
        whole = sizes.max(axis=(0, 1), initial=0.0)
        return np.asarray(_ACCURACY * np.where(noise < _DIGITS * whole, whole, moved))

    def _rest(self) -> tuple[Array, Array, Array, Array]:
        """What is left of the rows with parameters as they fit best, (rows, residuals).

        The same of their averages, the degrees of freedom that this has cost each residual, and
        what is left of the rows with parameters that stay within their tolerances.
        """
        value = np.array([one.value for one in self._rows])
        bound = np.array([one.bound for one in self._rows])
        average = np.array([one.average for one in self._rows])
        count = len(self._prior)
        if not count:
            left = uncovered(value, bound)
            return left, uncovered(average, bound), np.zeros(value.shape[1]), left
        tilts = np.array([one.tilt for one in self._rows]).transpose(0, 2, 1) * self._prior
        slopes = np.array([one.slopes for one in self._rows]).transpose(0, 2, 1) * self._prior
        weight = np.where(np.isfinite(value), self._weight(value, bound), 0.0)
        rest, owed = value, np.zeros(value.shape[1])
        for _ in range(2):  # the second time without rows that are far out
            wanted = np.where(weight > 0, value * weight, 0.0).reshape(-1)
            table = (slopes * weight[:, :, None]).reshape(-1, count)
            basis, root = np.linalg.qr(np.vstack([table, np.eye(count)]))
            found = np.linalg.solve(root, basis[:-count].T @ wanted)
            owed = np.square(basis[:-count]).sum(axis=1).reshape(value.shape).sum(axis=0)
            rest = value - slopes @ found
            weight = weight * within(rest)
        beyond = value - slopes @ within_tolerance(root, basis[:-count].T @ wanted)
        least, average = uncovered(rest, bound), uncovered(average - tilts @ found, bound)
        return least, average, owed, uncovered(beyond, bound)

    def _weight(self, value: Array, bound: Array) -> Array:
        """One over what residuals may be off by, noise from what neighbouring rows differ by."""
        sigma = np.array([stepped(column) for column in value.T])
        sigma = np.maximum(sigma, self._least(sigma))
        variance = variances(np.nan_to_num(value), bound, sigma)
        return np.where(variance > 0, 1.0 / np.sqrt(np.maximum(variance, 1e-300)), 0.0)

    def _estimated(
        self,
        k: int,
        setting: _Settings,
        rest: Array,
        average: Array,
        owed: Array,
        beyond: Array,
        held: int,
    ) -> bool:
        """Whether the noise of a residual, that was not known in this setting, is known now."""
        every = np.array([one.settings[k] == setting for one in self._rows])
        values = np.where(every, rest[:, k], math.nan)
        if not self._wanted[k]:
            values[len(values) - held :] = math.nan
        whole = setting
        if self._wanted[k] and self._counts[k] >= _MANY and np.isfinite(values).sum() < FIRST:
            values, whole = rest[:, k], frozenset().union(*[one.settings[k] for one in self._rows])
        if np.isfinite(values).sum() < FIRST:
            return False
        found = noise(values, float(owed[k]), self._centred[k])
        kappa = float(self.limits[k, 2])
        spread = CAREFUL * stepped(values) if self._drifts[k] else found.foreseen(kappa)
        least = max(spread, float(self._least(spread)[k]))
        top, bottom = self._highest[:, k].tolist()
        highest = max(top - found.mean, bottom + found.mean, 0.0) / kappa
        if self._wanted[k] and self._approximate[k] and highest > _HOPELESS * least:
            self.hopeless[k], self._wanted[k] = True, False
            return False
        sigma = max(least, (_BIASED if self._drifts[k] else _ABOVE) * highest)
        if not 0.0 < sigma < math.inf:
            return False
        self._sigma[k][whole] = sigma
        self._learned[k] |= whole
        unknown, self._wanted[k] = bool(self._wanted[k]), False
        self.unsure[k] = False
        self._forgotten.pop(k, None)
        self._due[k] = math.ceil(_MORE * (self._counts[k] - held))
        left = np.where(np.isfinite(values), beyond[:, k], math.nan)
        self.off[k] = self._rests[k] and _off(left, float(owed[k]))
        self.off[k] |= bool(self.declared[k]) and _elsewhere(left)
        self.limits[k, 0] = max(self._sigma[k].values())
        stood = float(self.limits[k, 4]) + self._further(k)
        self.limits[k, 4:6] = found.mean, found.memory
        if not math.isfinite(self.limits[k, 13]):  # the highest sample was above no such doubt
            self.limits[k, 13] = self._acted[k]
        if self._drifts[k]:
            self.limits[k, 12] = wander(values).most
        if not (self._drifts[k] or self._modes[k]):
            own = np.where(np.isfinite(values), average[:, k], math.nan)
            wider = self.limits[k, 0] / spread if spread > 0.0 else 1.0
            self.limits[k, 6:12] = self._averages(k, own, float(owed[k]), found.mean, wider)
            self._walk(k, values, own, found, stood, _ABOVE * highest, wider)
        return unknown

    def _walk(
        self, k: int, values: Array, averages: Array, found: Noise, stood: float, least: float,
        wider: float,
    ) -> None:
        """How the level of a residual wanders, and what noise there is beside that.

        By the averages of rows where these are known, else by rows. Sums reckon with no more noise,
        nor do samples: beside its level as many rows are independent as there are, where noise of a
        long memory has few. `stood` is where it was taken to stand before, `least` the noise that
        samples have shown: so much `wider` than rows show is what is taken for it.
        """
        lasts, further = bool(self.limits[k, 6] > 0.0), self._further(k)
        path = wander(averages if lasts else values)
        mean = self.levels.begin(k, path, stood, found.mean + further, found.rows)
        self.limits[k, 4] = mean - further
        rows = wander(values) if lasts else path
        sigma = rows.alone or found.sigma
        beside = Noise(0.0, sigma, 0.0, found.rows - 2.0, found.rows)
        if path.step > 0.0:
            most = beside.foreseen(float(self.limits[k, 2]))
            most = max(most, least, float(self._least(sigma)[k]))
            self.limits[k, 0] = min(self.limits[k, 0], most)
        adds = rows.lasting(found.sigma * math.sqrt(found.memory), FILTERED)
        memory = (adds / sigma) ** 2 if sigma else 0.0
        self.limits[k, 5] = max(memory, min(found.memory, 1.0))
        added = wider * (1.0 + self.limits[k, 8:12].sum())
        self.limits[k, 6] = added * path.lasting(self.limits[k, 6] / added, WHITE)

    def _further(self, k: int) -> float:
        """By how much averages of rows stand above the mean, where they tell the level."""
        return float(self.limits[k, 7]) if self.limits[k, 6] > 0.0 else 0.0

    def _averages(self, k: int, values: Array, owed: float, mean: float, wider: float) -> Array:
        """What the averages of rows tell, as `Limit` has it behind the numbers of rows.

        Noise is taken for so much `wider` than rows show, for what samples have shown.
        """
        found = lasting(values, owed, self._centred[k], float(self.limits[k, 2]))
        least = float(self._least(found.unit)[k]) * (1.0 + found.weights.sum())
        unit = max(wider * found.unit, least)
        stands = found.mean - mean if self._centred[k] else 0.0
        return np.array([unit if math.isfinite(unit) else 0.0, stands, *found.weights])


class _Healthy(NamedTuple):
    """A row: residuals, NaN where they do not count, thresholds, slopes by what is tolerated.

    With it the averages of its samples, of residuals and of slopes.
    """

    value: Array
    bound: Array
    slopes: Array
    average: Array
    tilt: Array
    settings: list[_Settings]


class _Known(NamedTuple):
    """What was known of the noise of a residual, as `Learning` keeps it."""

    limits: Array
    sigma: dict[_Settings, float]
    learned: _Settings
    highest: Array
    rows: int
    due: int
    unsure: bool
    misread: Misread


def _off(values: Array, owed: float) -> bool:
    """Whether rows surely do not stand at zero, whatever is taken for their noise."""
    found = noise(values, owed)
    deviation = found.sigma * math.sqrt(found.memory / max(found.rows, 1))
    return abs(found.mean) > max(_OFF * deviation, found.sigma)


def _elsewhere(values: Array) -> bool:
    """Whether rows of what adds up readings are surely further from zero than these can have gone.

    Noise that adds up goes as far as the root of their number, times how far it goes in a row.
    """
    known = values[np.isfinite(values)]
    return bool(abs(np.median(known)) > _WALKED * stepped(values) * math.sqrt(len(known)))


def _settings(modes: Array) -> _Settings:
    return frozenset(map(tuple, np.unique(modes, axis=0).tolist()))


def _nothing(shape: tuple[int, ...]) -> Array:
    return np.stack([np.full(shape, math.inf), np.full(shape, -math.inf)])
