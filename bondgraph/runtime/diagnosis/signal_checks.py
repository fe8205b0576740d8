"""What a signal shows by itself: spikes, bursts of noise, a value that stands still.

No parameter of a machine changes for one sample, and no machine makes the noise of an instrument.
So these are told of the signal, by what it was like while all was well, without a model.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from bondgraph.runtime.log import Array
from bondgraph.text.tuples import NamedTuple

_ENOUGH = 200  # samples of a signal to know it by
_MOST = 5000  # after which nothing more is learned of it
_OUT = 2.0  # times as far out as any sample, or row, was while all was well
_FLOOR = 0.02  # of the range of a signal: what is smaller matters to nothing
_NOISY = 0.003  # rough beside its own motion, in any healthy row: noise that would be missed
_MANY = 100  # rows that tell how rough a signal may become: with fewer, half as much again
_ALONE = 3.0  # times as far out as all around it: a spike is alone
_ROUGHER = 2.0  # times as rough, beside its own motion, as any row was
_WHITE = 0.7  # so rough beside its own motion is white noise at least: 0.8 or more
_CHANGES = 0.3  # share of the samples that differ from the last, in any row of a noisy signal
_STILL = 5.0  # times as long as it ever stood still
_LEAST = 20  # samples that it has to stand still for
_QUIET = 3  # rows after which it is as it was
_PAUSE = 32  # rows: what comes back within them has to be away for twice as long the next time
_AFTER = 10  # rows until which residuals may be out by it
_SIDE = 2  # samples to either side that a sample is compared with


class Unusual(NamedTuple):
    """Something that a signal shows: which, what (`spike`, `burst` or `stuck`), and since when (s).

    `size` is how far out it is, in times the largest that is healthy.
    """

    signal: str
    kind: str
    since: float
    size: float

    @property
    def text(self) -> str:
        """In words."""
        if self.kind == "spike":
            return f"a spike of {self.signal}, {self.size:.2g} times the largest of healthy ones"
        if self.kind == "burst":
            return f"a burst of noise of {self.signal}, {self.size:.2g} times what it was"
        return f"{self.signal} stands still, {self.size:.2g} times as long as ever"


class SignalChecks:
    """Looks at the samples row by row; `names` are the signals, by the column `at` of the samples.

    Each sample is compared with what its neighbours on both sides let expect, by weights that fit
    the healthy signal best, and with their median: a step is far from the first, the peak of an
    oscillation from the second, a spike from both.
    """

    def __init__(self, names: Sequence[str], at: Sequence[int], sample_time: float) -> None:
        self._names, self._at, self._step = tuple(names), list(at), sample_time
        count = len(self._names)
        self._seen: list[Array] = []  # healthy samples until the weights are known
        self._weights: Array | None = None  # (signals, 2): of the nearest and the next ones
        self._samples = 0  # that were learned from
        self._far = np.zeros(count)  # largest spike of a healthy sample
        self._rough = np.zeros((2, count))  # of a healthy row: roughness, and beside its motion
        self._calm = np.full(count, math.inf)  # roughness of the smoothest row, beside its motion
        self._rows = 0  # that were learned from
        self._range = np.array([np.full(count, math.inf), np.full(count, -math.inf)])
        self._still = np.zeros(count)  # longest run of equal values that has ended
        self._least = np.ones(count)  # share of the samples of a row that differ from the last
        self.active: dict[str, Unusual] = {}
        self._away: dict[str, int] = {}  # rows since it was unusual last
        self._needed: dict[str, int] = {}  # rows that it has to be away for
        self.restart()

    def restart(self) -> None:
        """The samples begin anew."""
        self._last = np.empty((0, len(self._names)))
        self._run = np.zeros(len(self._names))

    def row(self, time: float, samples: Array, healthy: bool) -> list[Unusual]:
        """What begins to be unusual in a row, (n, all signals), that ends at a time (s)."""
        own = samples[:, self._at]
        if not np.isfinite(own).all():
            self.restart()
            return []
        with_last = np.concatenate([self._last, own])
        runs, ended, changes = self._runs(own)
        self._last = with_last[-2 * _SIDE :]
        if len(with_last) < 4 * _SIDE + 1:
            return []
        if self._weights is None:
            self._first(own, healthy)
            return []
        far, rough, moved, where = self._looked_at(with_last)
        found = {}
        if self._samples >= _ENOUGH:
            low = np.minimum(self._range[0], own.min(axis=0))
            span = np.maximum(self._range[1], own.max(axis=0)) - low
            for kind, size in self._unusual(far, rough, moved, runs, span).items():
                for k in np.flatnonzero(size > 1.0).tolist():
                    late = len(with_last) - 1 - where[k] if kind == "spike" else len(own) - 1
                    late = runs[k] - 1 if kind == "stuck" else late
                    since = time - float(late) * self._step
                    scale = {"spike": _OUT, "burst": _OUT, "stuck": _STILL}[kind]
                    found[self._names[k]] = Unusual(
                        self._names[k], kind, since, float(size[k]) * scale
                    )
        if healthy and not found and self._samples < _MOST:
            self._learn(own, far, rough, moved, ended, changes)
        return self._begun(found)

    def _begun(self, found: Mapping[str, Unusual]) -> list[Unusual]:
        """What is new; what has been away for some rows is over."""
        fresh = [one for name, one in found.items() if name not in self.active]
        for one in fresh:
            gone = self._away.get(one.signal, _PAUSE + 1)
            self._needed[one.signal] = min(2 * gone, _PAUSE) if gone <= _PAUSE else _QUIET
            self.active[one.signal] = one
        for name in self._names:
            self._away[name] = 0 if name in found else self._away.get(name, _PAUSE) + 1
            if name in self.active and self._away[name] >= self._needed.get(name, _QUIET):
                del self.active[name]
        return fresh

    def lately(self, name: str) -> bool:
        """Whether a signal is unusual or was so a few rows ago."""
        return name in self.active or self._away.get(name, _PAUSE) < _AFTER

    def _unusual(
        self, far: Array, rough: Array, moved: Array, runs: Array, span: Array
    ) -> dict[str, Array]:
        """How far out each signal is, above 1 for what is unusual."""
        with np.errstate(divide="ignore", invalid="ignore"):
            floor = _FLOOR * np.maximum(span, 1e-300)
            spike = far[0] / (_OUT * np.maximum(self._far, floor))
            spike = np.where(far[0] > _ALONE * far[1], spike, 0.0)
            out = _OUT if self._rows >= _MANY else 1.5 * _OUT
            burst = rough / (out * np.maximum(self._rough[0], floor))
            beside = np.where(moved > 0, rough / np.maximum(moved, 1e-300), 0.0)
            most = np.minimum(_ROUGHER * self._rough[1], _WHITE)
            burst = np.where(beside > most, burst, 0.0)
            longest = np.maximum(_STILL * self._still, _LEAST)
            known = (self._still > 0.0) & (self._least >= _CHANGES)
            noisy = known & np.isfinite(self._calm) & (self._calm > _NOISY)
            stuck = np.where(noisy, runs / longest, 0.0)
        return {"spike": spike, "burst": burst, "stuck": stuck}

    def _runs(self, own: Array) -> tuple[Array, Array, Array]:
        """How long each signal has had its present value, and the longest one that ended in this
        row; how often it changed."""
        before = self._last[-1:] if len(self._last) else own[:1]
        same = np.diff(np.concatenate([before, own]), axis=0) == 0.0
        ended = np.zeros(own.shape[1])
        for k in np.flatnonzero(~same.all(axis=0)).tolist():
            turns = np.flatnonzero(~same[:, k])
            ended[k] = max(self._run[k] + turns[0], *np.diff(turns), 0.0)
        held = same[::-1].argmin(axis=0)  # samples that are equal at the end of the row
        self._run = np.where(same.all(axis=0), self._run + len(own), held + 1.0)
        return self._run.copy(), ended, 1.0 - same.mean(axis=0)

    def _first(self, own: Array, healthy: bool) -> None:
        """Gather samples until there are enough for the weights; then look at all of them."""
        if not healthy:
            self._seen = []
            return
        self._seen.append(own)
        if sum(map(len, self._seen)) < _ENOUGH:
            return
        whole = np.concatenate(self._seen)
        near, next_, middle = _around(whole)
        weights = []
        for k in range(whole.shape[1]):
            table = np.column_stack([near[:, k], next_[:, k]])
            weights.append(np.linalg.lstsq(table, middle[:, k], rcond=None)[0])
        self._weights = np.array(weights)
        rows, self._seen = self._seen, []
        last = np.empty((0, whole.shape[1]))
        self._run[:] = 0.0
        for row in rows:
            with_last = np.concatenate([last, row])
            self._last = last
            _, ended, changes = self._runs(row)
            last = with_last[-2 * _SIDE :]
            if len(with_last) >= 4 * _SIDE + 1:
                far, rough, moved, _ = self._looked_at(with_last)
                self._learn(row, far, rough, moved, ended, changes)
        self._last = last

    def _learn(
        self, own: Array, far: Array, rough: Array, moved: Array, ended: Array, changes: Array
    ) -> None:
        self._samples += len(own)
        self._range[0] = np.minimum(self._range[0], own.min(axis=0))
        self._range[1] = np.maximum(self._range[1], own.max(axis=0))
        self._far = np.maximum(self._far, far[0])
        beside = np.where(moved > 0, rough / np.maximum(moved, 1e-300), 0.0)
        self._rough = np.maximum(self._rough, [rough, beside])
        self._still = np.maximum(self._still, ended)
        usual = self._run <= np.maximum(self._still, 1.0) * 2.0  # else it may have begun to stand
        self._least = np.where(usual, np.minimum(self._least, changes), self._least)
        self._calm = np.where(usual & (moved > 0), np.minimum(self._calm, beside), self._calm)
        self._rows += 1

    def _looked_at(self, samples: Array) -> tuple[Array, Array, Array, Array]:
        """Of samples (n, signals): the largest spike and the next one that is not beside it, the
        roughness, what the signals move, and where the spike is."""
        assert self._weights is not None
        near, next_, middle = _around(samples)
        off = np.abs(middle - near * self._weights[:, 0] - next_ * self._weights[:, 1])
        neighbours = np.sort(np.stack([samples[1:-3], middle, samples[3:-1]]), axis=0)[1]
        spike = np.minimum(off, np.abs(middle - neighbours))
        where = spike.argmax(axis=0)
        apart = np.abs(np.arange(len(spike))[:, None] - where) > _SIDE
        second = np.where(apart, spike, 0.0).max(axis=0)
        moved = np.median(np.abs(np.diff(samples, axis=0)), axis=0)
        return np.stack([spike.max(axis=0), second]), np.median(off, axis=0), moved, where + _SIDE

    def state(self) -> list[Any]:
        """What is unusual now, as plain JSON."""
        return [list(one) for one in self.active.values()]

    def resume(self, state: Sequence[Any]) -> None:
        """Go on with what was unusual; raises TypeError or ValueError for another kind of state."""
        for signal, kind, since, size in state:
            if not math.isfinite(float(since)):
                raise ValueError("a time is no number")
            self.active[str(signal)] = Unusual(str(signal), str(kind), float(since), float(size))


def _around(samples: Array) -> tuple[Array, Array, Array]:
    """For each sample that has two on either side: sums of the nearest and the next, and itself."""
    return samples[1:-3] + samples[3:-1], samples[:-4] + samples[4:], samples[2:-2]
