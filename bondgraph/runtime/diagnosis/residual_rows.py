"""The filtered residuals of logs, at rows some way apart, for any parameters of a machine.

Beside them is what the noise of the sensors adds to them: the program runs over a log, and over
the same log with as much noise once more. What the same noise adds with either sign is no noise: a
law that bends makes it, as of a square of a speed the square of its noise.
"""

from __future__ import annotations

import math
import os
from collections.abc import Collection, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from bondgraph.runtime.diagnosis.healthy import Nature
from bondgraph.runtime.diagnosis.remembered import Memory, from_the_start, unknown_starts
from bondgraph.runtime.diagnosis.whitening import LAGS, rms
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.clock import Piece
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.text.moment import moment

_APART = 0.5  # time constants of the filter between two rows
_JUMP = 10.0  # deviations of its steps that a signal changes by where it jumps
_SIDE = 5  # samples before a jump, and behind it, that are another level
_CHUNK = 5000  # samples at a time
_HOLDS = 2  # orders up to which nothing is missed of what is held between samples
_STILL = 1e-9  # of what it is: a signal that moves less stands still
_LEAST = 50  # rows below which nothing is told


class ResidualRows:
    """The filtered residuals of logs at rows some way apart, for any parameters.

    Beside them, what as much noise as the sensors have adds to them: always the same noise. What
    residuals have `memories` of is known from the start of a log to its first gap; `lost` are the
    seconds by residual in which it is not. By their `natures` residuals read switches, and start
    anew with some of these.
    """

    def __init__(
        self,
        engine: Engine,
        pieces: Sequence[tuple[str, Piece]],
        noise: Sequence[float],
        natures: Mapping[str, Nature],
        memories: Sequence[Memory] = (),
    ) -> None:
        self.engine = engine
        own = [natures[name] for name in engine.residuals]
        switches = {mode for one in own for mode in one.modes if mode not in one.anew}
        self._orders = np.array([one.order for one in own])
        time = engine.sample_time
        self.every = max(1, round(_APART / engine.bandwidth / time))
        self.skip = math.ceil(engine.warm_up / time / self.every) + 1
        long = (self.skip + 2 * LAGS) * self.every
        enough = [(name, piece) for name, piece in pieces if len(piece.samples) > long]
        self.begins = [(name, float(piece.time[0])) for name, piece in enough]
        self.pieces = [piece.samples for _, piece in enough]
        self.later = [bool(piece.anew) for _, piece in enough]
        #: Starts that nobody knows, each with its parameter and the number of the piece.
        self.starts = {
            f"{name} in {log}" + (f" from {moment(begin)}" if later else ""): (name, k)
            for k, ((log, begin), later) in enumerate(zip(self.begins, self.later, strict=True))
            for name in unknown_starts(memories, later)
        }
        self._lasts = [
            from_the_start(engine, memories, piece.samples, bool(piece.anew)) for _, piece in enough
        ]
        # of their first sample, and of it where no start is fitted: a constant of each piece
        of_first = {r for m in memories if not m.integral for r in m.residuals}
        fitted = [{r for m in memories if unknown_starts([m], k) for r in m.residuals}
                  for k in self.later]  # fmt: skip
        self._keep = np.array([r in of_first for r in engine.residuals])
        self._stand = [np.array([r in of_first - own for r in engine.residuals]) for own in fitted]
        self.lost = time * np.sum(
            [len(p) - own for p, own in zip(self.pieces, self._lasts, strict=True)], axis=0
        )
        rows = sum(len(p) // self.every - self.skip for p in self.pieces)
        if rows < _LEAST:
            need = (_LEAST + self.skip) * self.every * time
            raise ValueError(
                f"the logs are too short to fit parameters: give one of {need:.3g} s or more"
            )
        self.seconds = rows * self.every * time
        #: Inputs without noise, by their columns: nobody has measured them.
        self.commands = [
            at for at, (known, sigma) in enumerate(zip(engine.signals, noise, strict=True))
            if known.kind == "input" and known.counts is None and not sigma
        ]  # fmt: skip
        #: Switches that turn in the logs, by their columns.
        self.turned = [
            at for at, known in enumerate(engine.signals)
            if known.kind == "mode" and known.path in switches
            and any(np.diff(p[self.skip * self.every :, at]).any() for p in self.pieces)
        ]  # fmt: skip
        #: The signals whose delay is fitted: others may be added.
        self._jumping = self.turned + [
            at for at, known in enumerate(engine.signals)
            if known.kind in ("input", "sensor") and known.counts is None and any(
                _jumps(p[self.skip * self.every :, at], known.kind == "sensor") for p in self.pieces
            )
        ]  # fmt: skip
        self.late = self._jumping + [
            at for at in self.commands if at not in self._jumping
            and any(_held(p[self.skip * self.every :, at]) for p in self.pieces)
        ]  # fmt: skip
        self.biased = [
            at for at, known in enumerate(engine.signals)
            if known.kind in ("input", "sensor") and known.counts is None
        ]  # fmt: skip
        self.moved = [*self.biased, *self.turned]
        self._pool = ThreadPoolExecutor(os.cpu_count())  # compiled code runs beside all else
        draw = np.random.default_rng(1)
        self._shaken = [self._shake(p, noise, draw) for p in self.pieces]

    def _shake(self, samples: Array, noise: Sequence[float], draw: np.random.Generator) -> Array:
        """The samples with noise once more; that of encoders in whole counts."""
        shaken = samples.copy()
        for at, (known, sigma) in enumerate(zip(self.engine.signals, noise, strict=True)):
            if known.kind == "mode" or not sigma:
                continue
            if known.counts is None:
                shaken[:, at] += sigma * draw.standard_normal(len(samples))
            else:
                up, down = draw.poisson(sigma**2 / 2, (2, len(samples)))
                shaken[:, at] += up - down
        return shaken

    @property
    def held(self) -> list[int]:
        """The inputs and switches of which the delay is fitted that hold what they are given."""
        return [at for at in self.late if at in self.commands or at in self.turned]

    def names(self, columns: Sequence[int]) -> list[str]:
        """The paths of signals, by their columns."""
        return [self.engine.signals[at].path for at in columns]

    def sizes(self, columns: Sequence[int]) -> Array:
        """How far signals move, in their units: the deviation of their samples.

        Of one that stands still it is how large it is, and 1 if that is nothing.
        """
        found = []
        for at in columns:
            values = np.concatenate([p[:, at] for p in self.pieces])
            moves, stands = float(np.nanstd(values)), float(np.abs(np.nanmean(values)))
            found.append(moves if moves > _STILL * stands else stands or 1.0)
        return np.array(found)

    def still(self) -> list[str]:
        """The paths of inputs and switches that never move in any log."""
        own = [at for at, k in enumerate(self.engine.signals) if k.kind in ("input", "mode")]
        values = np.concatenate([p[:, own] for p in self.pieces])
        still = (np.nan_to_num(values) == np.nan_to_num(values[0])).all(axis=0)
        return self.names([at for at, stands in zip(own, still.tolist(), strict=True) if stands])

    def times(self) -> list[tuple[str, Array, slice]]:
        """For each piece the name of its log, the times of its rows in s, and where these are."""
        found, begin, step = [], 0, self.every * self.engine.sample_time
        for (name, first), samples in zip(self.begins, self.pieces, strict=True):
            rows = len(samples) // self.every
            time: Array = first + step * np.arange(1.0, rows + 1)
            found.append((name, time, slice(begin, begin + rows)))
            begin += rows + 1
        return found

    def inputs(self) -> Array:
        """The mean of each input and switch over the samples before a row, (rows, inputs)."""
        own = [at for at, k in enumerate(self.engine.signals) if k.kind in ("input", "mode")]
        parts = []
        for samples in self.pieces:
            rows = len(samples) // self.every
            cut = samples[: rows * self.every, own].reshape(rows, self.every, len(own))
            parts += [cut.mean(axis=1), np.full((1, len(own)), np.nan)]
        return np.concatenate(parts)

    def rows(
        self, parameters: Sequence[Mapping[str, float]], delays: Array, offsets: Array
    ) -> tuple[Array, Array]:
        """Residuals and what noise adds to them, both (sets of parameters, rows, residuals).

        Among the parameters of a set are the `starts`, by what they are called there.
        `delays` (sets, signals in `moved`) in samples and `offsets`, in the units of these, are
        what logs are cleared of; modes have no offset. NaN where a residual is not valid, and in
        one row behind every log.
        """
        return self._added(parameters, delays, offsets, self._shaken)

    def bent(self, parameters: Mapping[str, float], delays: Array, offsets: Array) -> Array:
        """What noise moves residuals by to one side, as laws bend, (rows, residuals); 0 if unknown.

        The mean of what noise of either sign adds, in units of the root mean square of what it
        adds. In the residuals there is as much of it as the samples have noise once: as in SIMEX
        (Cook and Stefanski 1994), to first order in their variance.
        """
        mirrored = [2.0 * p - q for p, q in zip(self.pieces, self._shaken, strict=True)]
        up, down = (self._added([parameters], delays[None], offsets[None], noisy)[1][0]
                    for noisy in (self._shaken, mirrored))  # fmt: skip
        return np.asarray(np.nan_to_num((up + down) / 2.0) / np.maximum(rms(up), 1e-300))

    def _added(
        self,
        parameters: Sequence[Mapping[str, float]],
        delays: Array,
        offsets: Array,
        noisy: Sequence[Array],
    ) -> tuple[Array, Array]:
        moved = np.hstack([delays, offsets])
        found: list[tuple[Array, Array]] = [(np.empty(0), np.empty(0))] * len(parameters)
        for group in {tuple(row): None for row in moved.tolist()}:
            members = np.flatnonzero((moved == group).all(axis=1)).tolist()
            own = [parameters[k] for k in members]
            late = dict(zip(self.moved, group, strict=False))
            off = dict(zip(self.moved, group[len(self.moved) :], strict=True))
            both = zip(*self._together(own, late, off, noisy), strict=True)
            for k, one in zip(members, both, strict=True):
                found[k] = one
        return np.stack([f[0] for f in found]), np.stack([f[1] for f in found])

    def _together(
        self,
        parameters: Sequence[Mapping[str, float]],
        late: Mapping[int, float],
        off: Mapping[int, float],
        noisy: Sequence[Array],
    ) -> tuple[Array, Array]:
        few, which = [], []
        for number in range(len(self.pieces)):
            own = [self._of(number, numbers) for numbers in parameters]
            each = {tuple(numbers.items()): None for numbers in own}  # what others begin with
            which.append([list(each).index(tuple(numbers.items())) for numbers in own])
            few.append([dict(numbers) for numbers in each])

        def through(number: int, samples: Array) -> Array:
            lasts, received = self._lasts[number], self.pieces[number]
            held = {at: late[at] for at in self.held}
            smooth = [at for at in held if at not in self._jumping]
            lines = {at: by for at, by in late.items() if at not in held}
            parts = [
                self._through(
                    few[number], _moved(_later(samples, own), lines, off), received, lasts, shares
                )
                for own, shares in _around_samples(held, smooth, self.turned, self._orders)
            ]
            return np.asarray(np.sum(parts, axis=0))

        every = range(len(self.pieces))
        found = self._pool.map(through, (*every, *every), (*self.pieces, *noisy))
        runs = [rows[own] for rows, own in zip(found, (*which, *which), strict=True)]
        clean, shaken = runs[: len(every)], runs[len(every) :]
        added = [more - one for more, one in zip(shaken, clean, strict=True)]
        for number in every:
            _level(added[number], self._keep)
            _level(clean[number], self._stand[number])
        return np.concatenate(clean, axis=1), np.concatenate(added, axis=1)

    def _of(self, piece: int, numbers: Mapping[str, float]) -> dict[str, float]:
        """The parameters of one piece, under their names in the model."""
        own = {}
        for name, value in numbers.items():
            called, where = self.starts.get(name, (name, piece))
            if where == piece:
                own[called] = value
        return own

    def declared(self, name: str) -> float:
        """The nominal value of a parameter, or of one of the `starts`."""
        return self.engine.parameters[self.starts.get(name, (name, 0))[0]]

    def _through(
        self,
        parameters: Sequence[Mapping[str, float]],
        samples: Array,
        received: Array,
        lasts: Array,
        shares: Array,
    ) -> Array:
        """The rows of one piece: sums of residuals by their `shares`, (samples ago, residuals)."""
        engines = [self.engine.configured(p, bounds=False) for p in parameters]
        readings = list(self.engine.readings)
        parts = []
        step = self.every * max(1, _CHUNK // self.every)
        ago = len(shares) - 1
        past = np.full((len(engines), ago, len(lasts)), np.nan)
        for k in range(0, len(samples), step):
            part = samples[k : k + step]
            # laws acted on what they received, noise and all
            got = received[k : k + step, readings] if readings else None
            value, valid, _ = engines[0].run_with(engines[1:], part, got)
            value = np.where(valid, value, np.nan)
            value = np.concatenate([past, value], axis=1)
            past = value[:, len(value[0]) - ago :]
            rows = np.arange(ago + self.every - 1, len(value[0]), self.every)
            parts.append(np.sum([s * value[:, rows - k] for k, s in enumerate(shares)], axis=0))
        found = np.concatenate([*parts, np.full_like(parts[0][:, :1], np.nan)], axis=1)
        found[:, : self.skip] = np.nan
        for k, until in enumerate((lasts // self.every).tolist()):
            found[:, until:, k] = np.nan
        return found


def _level(rows: Array, residuals: Mask) -> None:
    """Take the mean over the rows off some residuals of (sets, rows, residuals).

    >>> rows = np.array([[[1.0, np.nan], [3.0, np.nan]]])
    >>> _level(rows, np.array([True, True]))
    >>> rows.tolist()
    [[[-1.0, nan], [1.0, nan]]]
    """
    own = rows[:, :, residuals]
    count = np.isfinite(own).sum(axis=1, keepdims=True)  # none behind a gap
    rows[:, :, residuals] -= np.nansum(own, axis=1, keepdims=True) / np.maximum(count, 1)


def _jumps(values: Array, read: bool = False) -> bool:
    """Whether a signal has steps that are no part of how it changes else, and that last.

    A spike does not: medians of five samples on either side are apart by half of a step at least.
    What a converter makes of a reading is none either: most of its steps are one count, the errors
    of rounding of two samples are apart by the root of a sixth of that.

    >>> still, spike = np.tile([0.0, 0.1], 50), np.zeros(100)
    >>> spike[60] = 9.0
    >>> _jumps(still + spike), _jumps(still + 9.0 * (np.arange(100) > 60))
    (False, True)
    >>> coarse = np.repeat([1.0, 1.33, 1.0, 1.0, 1.33], 20)
    >>> _jumps(coarse), _jumps(coarse, read=True)
    (True, False)
    """
    if len(values) < 2 * _SIDE:
        return False
    middle = np.median(sliding_window_view(values, _SIDE), axis=1)
    lasting, steps = middle[_SIDE:] - middle[:-_SIDE], np.diff(values)
    known = np.abs(steps[np.isfinite(steps)])
    moves = known[known > 0.0]
    if not len(moves):
        return False
    usual = float(np.median(known)) / 0.6745
    rounding = float(np.median(moves)) / math.sqrt(6.0) if read else 0.0
    inside = steps[_SIDE - 1 : 1 - _SIDE]
    lasts = 2.0 * lasting * np.sign(inside) >= np.abs(inside)
    return bool((np.abs(inside[lasts]) > _JUMP * max(usual, rounding)).any())


def _held(values: Array) -> bool:
    """Whether a signal moves anew at each sample, as what a controller gives and holds.

    What it was tells more of the next sample than the line through the last two.

    >>> draw = np.random.default_rng(1).standard_normal(1000)
    >>> _held(draw), _held(np.cumsum(draw)), _held(np.sin(0.3 * np.arange(1000)))
    (True, True, False)
    """
    steps = np.diff(values)
    return bool(np.nansum(np.diff(steps) ** 2) > np.nansum(steps**2))


def _around_samples(
    late: Mapping[int, float],
    smooth: Collection[int],
    turned: Collection[int],
    orders: NDArray[np.int_],
) -> list[tuple[dict[int, float], Array]]:
    """By how many samples held signals, `late` by so many, are later in runs, and their shares.

    A share is that of what each residual was so many samples ago, (samples ago, residuals). The
    code takes the mean of two samples for what is between them. What is held there is the same at
    both: there are a run with what it is behind each sample and one with what it was before it,
    and of each two samples the residual is the mean of the first as of behind it and the second as
    of before it. What moves smoothly gets there what the trapezoid rule misses, (D T)**2/12 for
    each order; of what is held it misses nothing up to the second order. So that all of it, three
    samples long, is in one more filter, these shares are no halves
    (docs/decisions/errors-in-variables.md). A signal with no delay is a
    straight line between two samples, but one of `smooth` is what it is at both; with half a sample
    it is held, and beyond that held and late. A residual of order 0 has nothing between samples.

    A mode that is `turned` is never half on. What it does while it is on adds up: between two whole
    numbers of samples residuals are a straight line in the delay, as they are in a held number.

    >>> _around_samples({}, [], [], np.array([1]))[0][1].tolist()
    [[1.0]]
    >>> for late, shares in _around_samples({0: 0.5}, [], [], np.array([1])):
    ...     print(late, (24 * shares[:, 0]).round(9).tolist())
    {0: 0.0} [0.0, 4.0, 6.0, 2.0]
    {0: 1.0} [2.0, 6.0, 4.0, 0.0]
    >>> for late, shares in _around_samples({0: 0.0}, [0], [], np.array([1])):
    ...     print(late, (24 * shares[:, 0]).round(9).tolist())
    {0: 0.0} [2.0, 10.0, 10.0, 2.0]
    >>> for late, shares in _around_samples({0: 0.75}, [], [0], np.array([1])):
    ...     print(late, (24 * shares[:, 0]).round(9).tolist())
    {0: 0} [0.0, 3.0, 4.5, 1.5]
    {0: 1} [1.5, 5.5, 4.5, 0.5]
    {0: 2} [0.5, 1.5, 1.0, 0.0]
    """
    if not late:
        return [({}, np.ones((1, len(orders))))]
    more = np.minimum(orders, _HOLDS)
    shares = np.array([3 - more, 6 + 0 * more, 3 + more, 0 * more]) / 24.0 * (orders > 0)
    runs = [(dict(late), np.array([orders == 0, *np.zeros((3, len(orders)))], dtype=float))]
    part_held = {at: min(max(by, -0.5), 0.5) for at, by in late.items()}
    for side, of, own in ((-0.5, min, shares[::-1]), (0.5, max, shares)):
        moved = {
            at: by - part_held[at] + of(0.0, 2.0 * part_held[at]) if at in smooth else by + side
            for at, by in late.items()
        }
        runs.append((moved, own))
    found: dict[tuple[tuple[int, float], ...], Array] = {}
    for moved, own in runs:
        steps = {at: by for at, by in moved.items() if at in turned}
        lines = {at: by for at, by in moved.items() if at not in turned}
        for part, whole in _whole(steps) if own.any() else ():
            key = (*lines.items(), *whole.items())
            found[key] = found.get(key, 0.0) + part * own
    return [(dict(key), own) for key, own in found.items()]


def _whole(late: Mapping[int, float]) -> list[tuple[float, dict[int, int]]]:
    """Whole numbers of samples in place of others, and how much the residuals of each count.

    >>> _whole({0: 0.75}), _whole({0: -1.0}), _whole({})
    ([(0.25, {0: 0}), (0.75, {0: 1})], [(1.0, {0: -1})], [(1.0, {})])
    """
    whole = {at: math.floor(by) for at, by in late.items()}
    parts = {at: by - whole[at] for at, by in late.items() if by > whole[at]}
    found = [(1.0 - sum(parts.values()), whole)]
    return found + [(part, {**whole, at: whole[at] + 1}) for at, part in parts.items()]


def _later(samples: Array, late: Mapping[int, float]) -> Array:
    """The samples with some columns so many samples late; what was before or is behind is held.

    >>> ramp = np.array([[0.0], [1.0], [2.0]])
    >>> [_later(ramp, {0: by})[:, 0].tolist() for by in (1, -1, 0.25)]
    [[0.0, 0.0, 1.0], [1.0, 2.0, 2.0], [0.0, 0.75, 1.75]]
    """
    if not any(late.values()):
        return samples
    found, when, last = samples.copy(), np.arange(len(samples)), len(samples) - 1
    for at, by in late.items():
        whole = math.floor(by)
        one, before = (samples[np.clip(when - k, 0, last), at] for k in (whole, whole + 1))
        found[:, at] = one + (by - whole) * (before - one) if by > whole else one
    return found


def _moved(samples: Array, late: Mapping[int, float], off: Mapping[int, float]) -> Array:
    """The samples with some columns so many samples late, about one at most, and without offsets.

    >>> _moved(np.array([[1.0], [3.0]]), {0: 0.5}, {0: 1.0}).tolist()
    [[0.0], [1.0]]
    """
    if not any(late.values()) and not any(off.values()):
        return samples
    found = samples.copy()
    for at, delay in late.items():
        if not delay:
            continue
        found[1:, at] -= delay * np.diff(samples[:, at])
    for at, offset in off.items():
        found[:, at] -= offset
    return found
