"""Parameters of a machine from logs of it while it was healthy, with how sure they are.

The residuals are the model: with the right parameters nothing is left of them but what the noise
of the sensors makes. That noise enters together with the parameters (R times a noisy current), so
that plain least squares would take them too small, or all of them for zero where each term has
one. Each residual is therefore divided by what the noise makes of it at the same parameters: the
sum of r(theta)^2 / var r(theta), without a logarithm, is least at the truth (errors in variables,
Fuller 1987; structured total least squares, De Moor 1993). The variance is measured: the program
runs over the log and over the log with as much noise once more.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from difflib import get_close_matches
from functools import partial

import numpy as np
from scipy.optimize import least_squares

from bondgraph.runtime.diagnosis.told_combinations import Combination, combinations, untold
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.clock import Piece
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.text.tuples import NamedTuple

_APART = 0.5  # time constants of the filter between two rows
_LAGS = 8  # rows that a row of noise is predicted from, so that what is left has no memory
_ROUNDS = 4  # of weights from what is left, and parameters from weights
_STEP = 1e-3  # relative, of central differences
_WIDE = 10.0  # deviation of a parameter that no log tells, relative to its value
_TOLD = 0.3  # relative deviation below which a parameter is told
_LATE = 1.0  # samples by which what jumps may be late: deviation
_JUMP = 10.0  # deviations of its steps that a signal changes by where it jumps
_PINNED = 1e-3  # how far what is not told may be from its nominal value
_SMALLEST = 1e-6  # of its nominal value: a parameter keeps its sign
_SURE = 1.96  # deviations within which 95 % are
_FAR = 4.0  # deviations beyond which a row is not of this machine
_MOST = 0.5  # share of what is known of a parameter that may be left out with such rows
_CHUNK = 5000  # samples at a time
_WRONG = 2.0  # of its noise: with more left of it a residual says that the model is wrong
_LEAST = 50  # rows below which nothing is told
_SILENT = 1e-6  # of the size of a signal: the least noise that is reckoned with
_SPANS = 20  # of the log, each of which is asked whether it fits


class Fitting(NamedTuple):
    """One parameter: `value` in SI, and its standard `error`, None where the logs cannot tell it.

    `bound` says that it would have had to change its sign to fit better.
    """

    name: str
    nominal: float
    value: float
    error: float | None
    unit: str
    bound: bool

    @property
    def interval(self) -> float | None:
        """Half of the interval that has the truth in 95 of 100 cases."""
        return None if self.error is None else _SURE * self.error


class Span(NamedTuple):
    """A time of a log, in s, in which a residual is `times` what is usual."""

    log: str
    start: float
    end: float
    times: float


class Left(NamedTuple):
    """What is left of one residual.

    `before` and `after` are the root mean square of the filtered residual, at the nominal and at
    the fitted parameters; `noise` what the sensors make of it. `memory` is the correlation of one
    row of it with the next once that of the noise is taken off: 0 where nothing else is in it.
    """

    residual: str
    before: float
    after: float
    noise: float
    memory: float
    spans: tuple[Span, ...]

    @property
    def explained(self) -> float:
        """The share of its mean square that the fitted parameters take off."""
        return 1.0 - (self.after / self.before) ** 2 if self.before else 0.0


class Delay(NamedTuple):
    """How late a signal that jumps is in the log, in s, with its standard error.

    A step between two samples is in the log of the command at once and in that of a sensor a
    sample later: without this, parameters would have to make up for it.
    """

    signal: str
    value: float
    error: float


class Fitted(NamedTuple):
    """Parameters from logs; `noise` by signal, as it was seen or given, `seconds` of use."""

    parameters: tuple[Fitting, ...]
    combinations: tuple[Combination, ...]
    left: tuple[Left, ...]
    delays: tuple[Delay, ...]
    noise: dict[str, float]
    seconds: float
    correlation: Array  # (p, p), of the errors

    @property
    def values(self) -> dict[str, float]:
        """The fitted values in SI units, by name."""
        return {p.name: p.value for p in self.parameters}


def fit(
    engine: Engine,
    pieces: Sequence[tuple[str, Piece]],
    free: Sequence[str],
    tolerances: Mapping[str, float],
    units: Mapping[str, str],
    noise: Mapping[str, float],
    progress: Callable[[float], None] = lambda _: None,
) -> Fitted:
    """Fit the `free` parameters of an engine to pieces of healthy logs, by the names of these.

    Tolerances (relative) say where parameters are looked for that no log tells, and bound nothing.
    `noise` are standard deviations of signals that are known, in their unit; of other sensors it is
    estimated, inputs are exact. Raises ValueError where the logs are too short.
    """
    seen = {**estimated_noise(engine, [p.samples for _, p in pieces]), **noise}
    runs = _Runs(engine, pieces, [seen[k.path] for k in engine.signals])
    problem = _Problem(runs, free, tolerances)
    at = np.zeros(problem.size)
    problem.weigh(at, first=True)
    for k in range(_ROUNDS):
        if k:
            problem.weigh(at)
        at = problem.solve(at)
        progress((k + 1) / (_ROUNDS + 1))
    whole, bound = problem.covariance(at)
    count = len(free)
    covariance = whole[:count, :count]
    null = untold(covariance, _TOLD**2)
    if len(null):  # what nothing tells stays as it is declared
        problem.pin(null)
        at = problem.solve(at)
    late = at[count:]
    fitted = problem.value(at)
    own = [
        Fitting(n, float(old), fitted[n], None, units.get(n, ""), bool(on))
        for n, old, on in zip(free, problem.nominal, bound, strict=False)
    ]
    deviation = np.sqrt(np.maximum(np.diag(covariance), 0.0))  # rounding
    left = problem.left(at)
    told = (deviation < _TOLD) & ~bound[:count] & ~null.any(axis=0)
    told &= problem.told_by_wrong(at)[:count] <= _MOST
    parameters = tuple(
        p._replace(error=float(problem.scale[k] * deviation[k])) if told[k] else p
        for k, p in enumerate(own)
    )
    values = [p.value for p in own]
    found = combinations(free, values, problem.scale, null, partial(problem.cost, late))
    progress(1.0)
    apart = np.where(deviation > 0, deviation, 1.0)
    correlation = covariance / np.outer(apart, apart)
    time = engine.sample_time
    delays = tuple(
        Delay(engine.signals[k].path, float(d) * time, math.sqrt(max(v, 0.0)) * time)
        for k, d, v in zip(runs.late, late, np.diag(whole)[count:], strict=True)
    )
    return Fitted(parameters, found, left, delays, seen, runs.seconds, correlation)


def fittable(
    engine: Engine,
    faults: Mapping[str, float | None],
    tolerances: Mapping[str, float],
    wanted: Sequence[str] | None = None,
) -> list[str]:
    """The parameters to fit: those `wanted`, else those with a tolerance, else all.

    Of those that some residual sees: `faults` with their nominal values. Raises ValueError for
    another name, and where there is none.
    """
    names = [n for n, v in faults.items() if v is not None and n in engine.parameters]
    for name in wanted or ():
        if name not in names:
            close = get_close_matches(name, names, 3, 0.5)
            hint = f"perhaps {' or '.join(close)}" if close else f"there is {', '.join(names)}"
            raise ValueError(f"no residual sees a parameter `{name}` with a number; {hint}")
    free = list(dict.fromkeys(wanted or [n for n in names if n in tolerances] or names))
    if not free:
        raise ValueError(
            "no residual sees a parameter with a number: give one to a parameter of a law that"
            " sensors see (`bondgraph compile` prints the residuals)"
        )
    return free


def estimated_noise(engine: Engine, pieces: Sequence[Array]) -> dict[str, float]:
    """The standard deviation of white noise in each signal, by path; 0 for inputs and modes.

    From differences of high order, in which what a machine does is small beside noise: the median
    of their absolute values, the least of several orders. Encoders have at least that of a count,
    in counts.

    >>> from bondgraph import compile
    >>> engine = compile("models/dc_motor.bg").engine(native=False)
    >>> draw, t = np.random.default_rng(1), np.arange(20_000) / 1000
    >>> samples = np.zeros((20_000, 4))
    >>> samples[:, 2] = np.sin(6 * t) + 0.05 * draw.standard_normal(20_000)
    >>> round(estimated_noise(engine, [samples])["current"], 3)
    0.05
    """
    found = {}
    for at, known in enumerate(engine.signals):
        found[known.path] = 0.0
        if known.kind == "sensor":
            size = math.sqrt(np.mean([np.nanmean(p[:, at] ** 2) for p in pieces]))
            orders = [_rough([np.diff(p[:, at], k) for p in pieces], k) for k in range(2, 8)]
            least = math.sqrt(1 / 12) if known.counts is not None else _SILENT * size
            found[known.path] = max(min(orders), least)
    return found


def _rough(differences: Sequence[Array], order: int) -> float:
    whole = np.concatenate(differences)
    whole = np.abs(whole[np.isfinite(whole)])
    middle = float(np.median(whole)) if len(whole) else 0.0
    return middle / 0.6745 / math.sqrt(math.comb(2 * order, order))


class _Runs:
    """The filtered residuals of logs at rows some way apart, for any parameters.

    Beside them, what as much noise as the sensors have adds to them: always the same noise.
    """

    def __init__(
        self, engine: Engine, pieces: Sequence[tuple[str, Piece]], noise: Sequence[float]
    ) -> None:
        self.engine = engine
        time = engine.sample_time
        self.every = max(1, round(_APART / engine.bandwidth / time))
        self.skip = math.ceil(engine.warm_up / time / self.every) + 1
        long = (self.skip + 2 * _LAGS) * self.every
        self.begins = [(n, float(p.time[0])) for n, p in pieces if len(p.time) > long]
        self.pieces = [p.samples for _, p in pieces if len(p.time) > long]
        rows = sum(len(p) // self.every - self.skip for p in self.pieces)
        if rows < _LEAST:
            need = (_LEAST + self.skip) * self.every * time
            raise ValueError(
                f"the logs are too short to fit parameters: give one of {need:.3g} s or more"
            )
        self.seconds = rows * self.every * time
        self.late = [
            at for at, known in enumerate(engine.signals)
            if known.kind in ("input", "sensor") and known.counts is None
            and any(_jumps(p[self.skip * self.every :, at]) for p in self.pieces)
        ]  # fmt: skip
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

    def rows(
        self, parameters: Sequence[Mapping[str, float]], delays: Array | None = None
    ) -> tuple[Array, Array]:
        """Residuals and what noise adds to them, both (sets of parameters, rows, residuals).

        `delays` (sets, signals in `late`) in samples. NaN where a residual is not valid, and in one
        row behind every log.
        """
        late = np.zeros((len(parameters), len(self.late))) if delays is None else delays
        found: list[tuple[Array, Array]] = [(np.empty(0), np.empty(0))] * len(parameters)
        for group in {tuple(row): None for row in late.tolist()}:
            members = np.flatnonzero((late == group).all(axis=1)).tolist()
            own = [parameters[k] for k in members]
            both = zip(*self._together(own, dict(zip(self.late, group, strict=True))), strict=True)
            for k, one in zip(members, both, strict=True):
                found[k] = one
        return np.stack([f[0] for f in found]), np.stack([f[1] for f in found])

    def _together(
        self, parameters: Sequence[Mapping[str, float]], late: Mapping[int, float]
    ) -> tuple[Array, Array]:
        clean, added = [], []
        for samples, shaken in zip(self.pieces, self._shaken, strict=True):
            one = self._through(parameters, _delayed(samples, late), samples)
            clean.append(one)
            added.append(self._through(parameters, _delayed(shaken, late), samples) - one)
        return np.concatenate(clean, axis=1), np.concatenate(added, axis=1)

    def _through(
        self, parameters: Sequence[Mapping[str, float]], samples: Array, received: Array
    ) -> Array:
        engines = [self.engine.configured(p, bounds=False) for p in parameters]
        readings = list(self.engine.readings)
        parts = []
        step = self.every * max(1, _CHUNK // self.every)
        for k in range(0, len(samples), step):
            part = samples[k : k + step]
            if readings:  # laws acted on what they received, noise and all
                got = received[k : k + step, readings]
                batches = [e.run(part, got) for e in engines]
                value = np.stack([b.value for b in batches])
                valid = np.stack([b.valid for b in batches])
            else:
                value, valid, _ = engines[0].run_with(engines[1:], part)
            value = np.where(valid, value, np.nan)
            parts.append(value[:, self.every - 1 :: self.every])
        found = np.concatenate([*parts, np.full_like(parts[0][:, :1], np.nan)], axis=1)
        found[:, : self.skip] = np.nan
        return found


def _jumps(values: Array) -> bool:
    """Whether a signal has steps that are no part of how it changes else."""
    steps = np.abs(np.diff(values))
    steps = steps[np.isfinite(steps)]
    return bool(len(steps)) and float(steps.max()) > _JUMP * float(np.median(steps)) / 0.6745


def _delayed(samples: Array, late: Mapping[int, float]) -> Array:
    """The samples with some columns so many samples late, about one at most."""
    if not any(late.values()):
        return samples
    found = samples.copy()
    for at, delay in late.items():
        found[1:, at] -= delay * np.diff(samples[:, at])
    return found


class _Slopes(NamedTuple):
    """At some parameters: normalised residuals and added noise, (rows, residuals), with their
    slopes (p, rows, residuals), and the slopes of the logarithm of the variance (p, residuals)."""

    value: Array
    added: Array
    by: Array
    added_by: Array
    log_by: Array


class _Problem:
    """Normalised residuals as a function of parameters, relative to their nominal values."""

    def __init__(self, runs: _Runs, free: Sequence[str], tolerances: Mapping[str, float]) -> None:
        self._runs, self._free = runs, tuple(free)
        self.nominal = np.array([runs.engine.parameters[n] for n in free])
        self.scale = np.abs(self.nominal)
        self.size = len(free) + len(runs.late)
        self._low = np.full(self.size, -np.inf)
        self._high = np.full(self.size, np.inf)
        for k, value in enumerate(self.nominal):
            if value > 0:
                self._low[k] = _SMALLEST - 1.0
            elif value < 0:
                self._high[k] = 1.0 - _SMALLEST
        most = max((tolerances.get(n, 0.0) for n in free), default=0.0) or 1.0
        own = np.array([tolerances.get(n, 0.0) / most for n in free])
        wide = _WIDE * np.where(own > 0, np.maximum(own, 0.1), 1.0)
        self._spread = np.append(wide, np.full(len(runs.late), _LATE))
        self._pins = np.zeros((0, self.size))
        self._filters = np.zeros((_LAGS + 1, len(runs.engine.residuals)))
        self._extra = np.zeros(len(runs.engine.residuals))
        self._weight = np.ones(len(runs.engine.residuals))
        self._start()

    def _start(self) -> None:
        """What is known before the first fit: the noise's own filter, scales of zeros, rows."""
        zeros = np.flatnonzero(self.scale == 0)
        self.scale[zeros] = 1.0
        nothing = np.zeros(self.size)
        values = [self.value(nothing), *[{self._free[k]: 1.0} for k in zeros]]
        small = {n: v * _STEP for n, v in values[0].items()}
        clean, added = self._runs.rows([*values, small])
        rough = np.sqrt(np.nanmean(added[0] ** 2, axis=0))
        for row, k in enumerate(zeros, 1):
            effect = float(np.nanmax(_size(clean[row] - clean[0]) / np.maximum(rough, 1e-300)))
            self.scale[k] = 1.0 / effect if effect > 0 else 1.0
        self._filters[0] = 1.0  # far from the truth what a filter makes larger may be anything
        self._noise_filters = np.stack([whitening(x) for x in added[0].T], axis=1)
        self._mask: Mask = np.isfinite(_filtered(clean[0] + added[0], self._noise_filters))
        self._all = self._mask
        if not self._mask.any():
            raise ValueError("no residual is valid in the logs: nothing can be fitted")
        # each term of it has a free parameter: all of them zero would leave nothing
        self._homogeneous = _size(clean[-1]) < 0.05 * np.maximum(_size(clean[0]), rough)

    def value(self, at: Array) -> dict[str, float]:
        """The parameters at a point, in SI."""
        own = self.nominal + self.scale * at[: len(self._free)]
        return dict(zip(self._free, own.tolist(), strict=True))

    def _rows(self, points: Sequence[Array]) -> tuple[Array, Array]:
        delays = np.array([p[len(self._free) :] for p in points])
        return self._runs.rows([self.value(p) for p in points], delays)

    def _normal(self, points: Sequence[Array]) -> tuple[Array, Array, Array, Array]:
        """Normalised residuals and added noise at points, their variances, the noise's own."""
        clean, added = self._rows(points)
        mask = self._mask
        count = np.maximum(mask.sum(axis=0), 1)
        filtered = [np.where(mask, _filtered(x, self._filters), 0.0) for x in (clean, added)]
        value, extra = (np.where(np.isfinite(x), x, 0.0) for x in filtered)
        noise = (extra**2).sum(axis=-2) / count
        whole = noise + self._extra
        root = np.sqrt(np.maximum(whole, 1e-300))[:, None, :]
        return value / root / self._weight, extra / root, whole, noise

    def _slopes(self, at: Array) -> _Slopes:
        size = len(at)
        around = [at + s * _STEP * np.eye(size)[k] for k in range(size) for s in (1, -1)]
        value, added, whole, _ = self._normal([at, *around])
        apart = 2 * _STEP
        logs = np.log(np.maximum(whole, 1e-300))
        return _Slopes(
            value[0],
            added[0],
            (value[1::2] - value[2::2]) / apart,
            (added[1::2] - added[2::2]) / apart,
            (logs[1::2] - logs[2::2]) / apart,
        )

    def cost(self, delays: Array, value: Sequence[float]) -> float:
        """The sum of squares at values in SI units, inputs so many samples late."""
        at = np.append((np.asarray(value) - self.nominal) / self.scale, delays)
        return float(np.sum(self._normal([at])[0] ** 2))

    def solve(self, at: Array) -> Array:
        """The parameters that leave least, with the weights as they are."""

        def left(x: Array) -> Array:
            return np.concatenate([self._normal([x])[0].ravel(), x / self._spread, self._pins @ x])

        def slopes(x: Array) -> Array:
            by = self._slopes(x).by.reshape(len(x), -1).T
            return np.vstack([by, np.diag(1.0 / self._spread), self._pins])

        found = least_squares(
            left, at, slopes, bounds=(self._low, self._high), x_scale="jac", max_nfev=50
        )
        return np.asarray(found.x)

    def pin(self, directions: Array) -> None:
        """Keep to the nominal values along directions (n, p) of the parameters."""
        late = np.zeros((len(directions), self.size - directions.shape[1]))
        self._pins = np.hstack([directions, late]) / _PINNED

    def weigh(self, at: Array, first: bool = False) -> None:
        """Rows and variances from what is left at a point; at `first` all rows, as they are.

        What is left beyond the noise of the sensors is the model's error, which no parameter
        changes; where that would make zeros of all parameters, it is a weight alone.
        """
        if not first:
            clean = self._rows([at])[0][0]
            self._mask = self._usual(at, clean)
            self._filters = self._noise_filters
        self._extra[:], self._weight[:] = 0.0, 1.0
        if first:
            return
        value, _, _, noise = self._normal([at])
        times = (value[0] ** 2).sum(axis=0) / np.maximum(self._mask.sum(axis=0), 1)
        more = np.maximum(times - 1.0, 0.0)
        self._extra = np.where(self._homogeneous, 0.0, more * noise[0])
        self._weight = np.where(self._homogeneous, np.sqrt(1.0 + more), 1.0)

    def _usual(self, at: Array, clean: Array) -> Mask:
        """The rows without those that are far from what is usual: there it was another machine.

        Unless half of what is known of some parameter is in them: then the model is wrong.
        """
        white = np.abs(np.where(self._all, _filtered(clean, self._noise_filters), np.nan))
        usual = [np.nanmedian(w) / 0.6745 if np.isfinite(w).any() else 0.0 for w in white.T]
        far = np.zeros_like(self._all)
        for lag in range(_LAGS + 1):  # and what the filters remember of them
            far[lag:] |= white[: len(white) - lag] > _FAR * np.array(usual)
        self._mask = self._all
        energy = self._slopes(at).by[: len(self._free)] ** 2
        whole, part = energy.sum(axis=(1, 2)), (energy * far).sum(axis=(1, 2))
        return self._all if (part > _MOST * whole).any() else self._all & ~far

    def told_by_wrong(self, at: Array) -> Array:
        """The share of what is known of each parameter that residuals tell of a wrong model.

        Of such a residual more than so many times its noise is left in the rows that count.
        """
        _, _, whole, noise = self._normal([at])
        times = np.sqrt(whole[0] / np.maximum(noise[0], 1e-300)) * self._weight
        energy = (self._slopes(at).by ** 2).sum(axis=1)
        known = np.maximum(energy.sum(axis=1), 1e-300)
        return np.asarray(energy[:, times > _WRONG].sum(axis=1) / known)

    def covariance(self, at: Array) -> tuple[Array, Mask]:
        """Of the parameters, relative; and which of them are where their sign would change.

        A sandwich: what the curvature says, and how much the slope of the sum of squares scatters
        with what is left as it is, correlated or not (Newey and West 1987). The noise in the
        slopes themselves tells nothing of the parameters and is taken off the curvature.
        """
        s = self._slopes(at)
        bound = (at <= self._low * (1 - 1e-3)) | (at >= self._high * (1 - 1e-3))
        _, _, whole, noise = self._normal([at])
        rows = self._mask.sum(axis=0)
        error = rows * (1.0 - noise[0] / np.maximum(whole[0], 1e-300)) / 4.0
        curved = np.einsum("atr,btr->ab", s.by, s.by)
        curved -= np.einsum("atr,btr->ab", s.added_by, s.added_by)
        curved -= np.einsum("ar,br,r->ab", s.log_by, s.log_by, error)
        own = np.einsum("tr,atr->ta", s.value, s.by)
        mine = np.einsum("tr,atr->ta", s.added, s.added_by)
        scatter = newey_west(own) + newey_west(mine)
        prior = np.diag(self._spread**-2.0)
        free = ~bound
        curved, scatter, prior = (m[np.ix_(free, free)] for m in (curved, scatter, prior))
        values, vectors = np.linalg.eigh(curved)
        whole = (vectors * np.maximum(values, 0.0)) @ vectors.T + prior
        inverse = np.linalg.inv(whole)
        found = np.zeros((len(at), len(at)))
        found[np.ix_(free, free)] = inverse @ (scatter + prior) @ inverse
        return found, bound

    def left(self, at: Array) -> tuple[Left, ...]:
        """What is left of every residual at a point, beside what there was."""
        clean, added = self._rows([np.zeros(len(at)), at])
        before, after, noise = _size(clean[0]), _size(clean[1]), _size(added[1])
        white = _filtered(clean[1], self._noise_filters)
        found = []
        for k, name in enumerate(self._runs.engine.residuals):
            own = white[:, k]
            good = np.isfinite(own[1:]) & np.isfinite(own[:-1])
            square = float(np.sum(own[1:][good] ** 2))
            memory = float(np.sum((own[1:] * own[:-1])[good])) / square if square else 0.0
            spans = self._spans(own)
            found.append(
                Left(name, float(before[k]), float(after[k]), float(noise[k]), memory, spans)
            )
        return tuple(found)

    def _spans(self, white: Array) -> tuple[Span, ...]:
        """Where more than twice as much is left as usual, by spans of the logs."""
        runs, found, begin = self._runs, [], 0
        apart = runs.every * runs.engine.sample_time
        most = max(map(len, runs.pieces)) // runs.every
        size = max(_LAGS, math.ceil(most / _SPANS))
        for (name, first), samples in zip(runs.begins, runs.pieces, strict=True):
            rows = len(range(runs.every - 1, len(samples), runs.every))
            for start in range(0, rows, size):
                part = white[begin + start : begin + min(start + size, rows)]
                part = part[np.isfinite(part)]
                if len(part) >= _LAGS:
                    end = first + min(start + size, rows) * apart
                    mean = math.sqrt(float(np.mean(part**2)))
                    found.append(Span(name, first + start * apart, end, mean))
            begin += rows + 1
        usual = float(np.median([s.times for s in found])) if found else 0.0
        if not usual:
            return ()
        return tuple(s._replace(times=s.times / usual) for s in found if s.times > 2.0 * usual)


def _size(values: Array) -> Array:
    """The root mean square of each column, 0 where there is nothing."""
    there = np.isfinite(values)
    total = np.where(there, values, 0.0) ** 2
    return np.asarray(np.sqrt(total.sum(axis=-2) / np.maximum(there.sum(axis=-2), 1)))


def whitening(values: Array) -> Array:
    """The filter (1, -a1, -a2, ...) that leaves of a series (n,) what its past does not predict.

    An autoregression by least squares; NaN may be anywhere.

    >>> draw, x = np.random.default_rng(1).standard_normal(5000), np.zeros(5000)
    >>> for k in range(1, 5000):
    ...     x[k] = 0.8 * x[k - 1] + draw[k]
    >>> [bool(abs(a - b) < 0.05) for a, b in zip(whitening(x)[:3], (1.0, -0.8, 0.0))]
    [True, True, True]
    """
    lags = np.stack([values[_LAGS - k : len(values) - k] for k in range(_LAGS + 1)])
    lags = lags[:, np.isfinite(lags).all(axis=0)]
    found = np.zeros(_LAGS + 1)
    found[0] = 1.0
    if lags.shape[1] > 4 * _LAGS and lags.any():
        found[1:] = -np.linalg.lstsq(lags[1:].T, lags[0], rcond=1e-7)[0]
    return found


def _filtered(values: Array, filters: Array) -> Array:
    """Series (..., rows, residuals) through a filter (lags, residuals) each; NaN at the start."""
    found = np.full_like(values, np.nan)
    rows = values.shape[-2]
    found[..., _LAGS:, :] = sum(
        filters[k] * values[..., _LAGS - k : rows - k, :] for k in range(_LAGS + 1)
    )
    return found


def newey_west(scores: Array) -> Array:
    """The covariance (p, p) of the sum of correlated rows (n, p) (Newey and West 1987)."""
    own = scores - scores.mean(axis=0)
    found = own.T @ own
    most = math.ceil(math.sqrt(len(own)) / 2) + 1
    for lag in range(1, min(most, len(own))):
        part = own[lag:].T @ own[:-lag]
        found += (1.0 - lag / most) * (part + part.T)
    return np.asarray(found)
