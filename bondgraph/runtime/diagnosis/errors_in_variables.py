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
from collections.abc import Collection, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtri, stdtrit

from bondgraph.runtime.diagnosis.fitted import MUCH, Left, Span, Suspect, Terms
from bondgraph.runtime.diagnosis.instrumented import leaned
from bondgraph.runtime.diagnosis.left_over import follows, instruments
from bondgraph.runtime.diagnosis.levenberg_marquardt import STEPS, least
from bondgraph.runtime.diagnosis.remembered import up_to_gaps
from bondgraph.runtime.diagnosis.residual_rows import ResidualRows
from bondgraph.runtime.diagnosis.whitening import (
    LAGS,
    few_rows,
    filtered,
    newey_west,
    rms,
    whitening,
)
from bondgraph.runtime.log import Array, Mask
from bondgraph.text.tuples import NamedTuple

WIDE = 10.0  #: deviation of a parameter that no log tells, relative to its value
_STEP = 1e-3  # relative, of central differences
_LATE = 1.0  # samples by which what jumps may be late: deviation
LATEST = 1.5  #: samples: straight lines take half a one, a sensor that reads at the next takes one
_PINNED = 1e-3  # how far what is not told may be from its nominal value
_SMALLEST = 1e-6  # of its nominal value: a parameter keeps its sign
_BLIND = 1e-6  # share of an effect that nothing fitted has too: with less it is not told apart
_RARE = 1e-3  # probability that some offset is suspected where there is none
_MATTERS = 0.01  # share of what is left: an offset that explains less is not told
_FAR = 4.0  # deviations beyond which a row is not of this machine
_MOST = 0.5  # share of what is known of a parameter that may be left out with such rows
_NEARLY = 0.05  # share of a residual, or of its noise, that is nearly nothing of it
_NOTHING = 1e-4  # share of a residual that is no sum of its terms: noise makes more
_ENOUGH = 1e-3  # half a sum of squares of deviations: less is none
_SPANS = 20  # of the log, each of which is asked whether it fits


class Wanted(NamedTuple):
    """What is to be fitted: parameters, and signals whose offsets are."""

    parameters: tuple[str, ...]
    offsets: tuple[str, ...] = ()


def _axes(curved: Array, spread: Array) -> tuple[Array, Array]:
    """A curvature (p, p) and what is known before, which is `spread` (p,), by its axes.

    That is the inverse of their sum as `vectors` (p, p) with `shares` (p,) of what was known that
    are left. In units of the spread what is known is one, and so no sum is singular, however well
    the logs tell.
    """
    values, vectors = np.linalg.eigh(curved * np.outer(spread, spread))
    return spread[:, None] * vectors, 1.0 / (1.0 + np.maximum(values, 0.0))


def _sandwich(curved: Array, scatter: Array, spread: Array) -> Array:
    """The covariance (p, p) of what is fitted, of a curvature and the scatter of its slope (p, p).

    It is made axis by axis: where all axes are summed first, what rounding makes of those that
    logs tell well is more than all that is known of one that they do not tell.
    """
    axes, shares = _axes(curved, spread)
    inner = axes.T @ (scatter + np.diag(spread**-2.0)) @ axes
    return np.asarray(axes @ (np.outer(shares, shares) * inner) @ axes.T)


def _coloured(moves: Mask) -> NDArray[np.int_]:
    """A colour for each row, so that of one colour no two move the same residual (rows, residuals).

    What moves apart is moved at once (Curtis, Powell and Reid 1974).

    >>> _coloured(np.array([[1, 0, 0], [1, 1, 0], [0, 0, 1], [0, 1, 1]], dtype=bool)).tolist()
    [0, 1, 0, 2]
    """
    found = np.zeros(len(moves), dtype=np.int_)
    taken: list[Mask] = []  # by colour, the residuals that it moves
    for k, own in enumerate(moves):
        free = [c for c, others in enumerate(taken) if not (own & others).any()]
        found[k] = free[0] if free else len(taken)
        if free:
            taken[free[0]] = taken[free[0]] | own
        else:
            taken.append(own)
    return found


class _Slopes(NamedTuple):
    """At some parameters: normalised residuals and added noise, (rows, residuals), with their
    slopes (p, rows, residuals), and the slopes of the logarithm of the variance (p, residuals)."""

    value: Array
    added: Array
    by: Array
    added_by: Array
    log_by: Array


class ErrorsInVariables:
    """Normalised residuals as a function of what is fitted, and of delays in samples.

    Parameters are relative to their nominal values, but for `zeros`, which are declared to be zero;
    offsets are relative to how far their signals move.
    """

    def __init__(
        self,
        runs: ResidualRows,
        free: Wanted,
        tolerances: Mapping[str, float],
        reads: Mapping[str, frozenset[str]],
        zeros: Collection[str] = (),
    ) -> None:
        self._runs, self._free = runs, (*free.parameters, *runs.starts)
        self._shared = len(free.parameters)  # those of all logs stand first
        self.names = (*self._free, *free.offsets)
        biased = runs.names(runs.biased)
        self._offset_at = [biased.index(n) for n in free.offsets]
        self._late_at = [runs.moved.index(k) for k in runs.late]
        self._sizes = runs.sizes(runs.moved)
        declared = [runs.declared(n) for n in self._free]
        known = [runs.engine.signals[runs.biased[k]].offset for k in self._offset_at]
        self.nominal = np.array(declared + known)
        nought = [v == 0 or n in zeros for n, v in zip(self._free, declared, strict=True)]
        self.zeros = np.array(nought + [True] * len(known), dtype=np.bool_)
        size = np.where(nought, 0.0, np.abs(declared))
        self.scale = np.append(size, self._sizes[self._offset_at])
        self.size = len(self.names) + len(runs.late)
        self._moves = np.array([
            [n not in free.parameters or n in reads.get(r, (n,)) for r in runs.engine.residuals]
            for n in (*self.names, *runs.names(runs.late))
        ])  # fmt: skip
        self._colours = _coloured(self._moves)
        self._low = np.full(self.size, -np.inf)
        self._high = np.full(self.size, np.inf)
        for k, value in enumerate(self.nominal):
            if self.zeros[k] or self.names[k] in runs.starts:
                continue  # on whichever side it is
            if value > 0:
                self._low[k] = _SMALLEST - 1.0
            elif value < 0:
                self._high[k] = 1.0 - _SMALLEST
        most = max((tolerances.get(n, 0.0) for n in self.names), default=0.0) or 1.0
        own = np.array([tolerances.get(n, 0.0) / most for n in self.names])
        wide = WIDE * np.where(own > 0, np.maximum(own, 0.1), 1.0)
        self._spread = np.append(wide, np.full(len(runs.late), _LATE))
        # a delay acts by its slope: a longer one would add a derivative, and its noise, at will
        self._low[len(self.names) :], self._high[len(self.names) :] = -LATEST, LATEST
        self._pins = np.zeros((0, self.size))
        self._bent: Array | float = 0.0
        self._filters = np.zeros((LAGS + 1, len(runs.engine.residuals)))
        self._extra = np.zeros(len(runs.engine.residuals))
        self._weight = np.ones(len(runs.engine.residuals))
        self._start()

    @property
    def before(self) -> Array:
        """The deviations of what is fitted before any log tells of it, relative, (p,)."""
        return self._spread[: len(self.names)]

    def _start(self) -> None:
        """What is known before the first fit: the noise's own filter, scales of zeros, rows."""
        zeros = np.flatnonzero(self.scale == 0)
        self.scale[zeros] = 1.0
        nothing = np.zeros(self.size)
        values = [self._numbers(nothing), *[{self._free[k]: self.nominal[k] + 1.0} for k in zeros]]
        small = {n: _STEP * values[0][n] for n in self._free[: self._shared]}
        still = np.zeros((len(values) + 1, len(self._runs.moved)))
        clean, added = self._runs.rows([*values, small], still, still)
        rough = np.sqrt(np.nanmean(added[0] ** 2, axis=0))
        # the least variance that is reckoned with: sensors that never move tell no noise
        self._least = (1e-12 * rms(clean[0]) + 1e-150) ** 2
        for row, k in enumerate(zeros, 1):
            effect = float(np.nanmax(rms(clean[row] - clean[0]) / np.maximum(rough, 1e-300)))
            self.scale[k] = 1.0 / effect if effect > 0 else 1.0
        self._filters[0] = 1.0  # far from the truth what a filter makes larger may be anything
        self._noise_filters = np.stack([whitening(x) for x in added[0].T], axis=1)
        self._mask: Mask = np.isfinite(filtered(clean[0] + added[0], self._noise_filters))
        self._all = self._mask
        if not self._mask.any():
            raise ValueError(
                "no residual is valid in the logs as parameters are declared: nothing can be fitted"
                + up_to_gaps(self._runs.engine.residuals, self._runs.lost)
            )
        nearly = rms(clean[-1]) < _NEARLY * np.maximum(rms(clean[0]), rough)
        self._homogeneous = nearly | self._vanishing()

    def _vanishing(self) -> Mask:
        """Which residuals some of the parameters can make nothing of, all terms together.

        Such a residual is a sum of its terms by parameters (theorem of Euler on homogeneous
        functions): where these follow that sum it shrinks as a whole. The sum is exact whatever the
        noise in it, and no accident where there is some. One with a small term beside them is no
        such sum, but nearly nothing where all parameters are small: that is asked as well.
        """
        value, terms = self._terms(np.zeros(self.size))
        found = np.zeros(value.shape[1], dtype=np.bool_)
        for r, good in enumerate((np.isfinite(value) & np.isfinite(terms).all(axis=0)).T):
            own, columns = value[good, r], terms[:, good, r].T
            columns = columns / np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
            rest = own - columns @ np.linalg.lstsq(columns, own, rcond=1e-9)[0]
            found[r] = np.linalg.norm(rest) < _NOTHING * np.linalg.norm(own)
        return found

    def values(self, at: Array) -> Array:
        """What is fitted at a point, in SI."""
        return np.asarray(self.nominal + self.scale * at[: len(self.names)])

    def sizes(self, at: Array) -> Array:
        """How large what is fitted is at a point, as a multiple of its scale (p,).

        What may be on either side of zero, as an offset or a start, is reckoned to be one scale.
        """
        found = np.abs(self.values(at)) / self.scale
        found[self.zeros] = 1.0
        found[self._shared :] = 1.0
        return np.asarray(found)

    def _numbers(self, at: Array) -> dict[str, float]:
        """The parameters at a point, in SI."""
        return dict(zip(self._free, self.values(at).tolist(), strict=False))

    def _offsets(self, at: Array) -> Array:
        """The offsets of all signals that can have one at a point, above those that are known."""
        found = np.zeros(len(self._runs.moved))
        found[self._offset_at] = (self.values(at) - self.nominal)[len(self._free) :]
        return found

    def _delays(self, at: Array) -> Array:
        """The delays of all signals that can have one at a point, in samples."""
        found = np.zeros(len(self._runs.moved))
        found[self._late_at] = at[len(self.names) :]
        return found

    def _rows(self, points: Sequence[Array], more: Array | float = 0.0) -> tuple[Array, Array]:
        """Rows at points, with further delays and offsets (2, points, signals)."""
        own = [[self._delays(p) for p in points], [self._offsets(p) for p in points]]
        delays, offsets = np.array(own) + more
        clean, added = self._runs.rows([self._numbers(p) for p in points], delays, offsets)
        return clean - self._bent * rms(added)[:, None, :], added

    def _white(
        self, points: Sequence[Array], more: Array | float = 0.0
    ) -> tuple[Array, Array, Array, Array]:
        """Normalised residuals and added noise at points, their variances, the noise's own.

        NaN in rows that are not valid at a point, zero in those that do not count.
        """
        clean, added = self._rows(points, more)
        mask = self._mask
        count = np.maximum(mask.sum(axis=0), 1)
        value, extra = (np.where(mask, filtered(x, self._filters), 0.0) for x in (clean, added))
        noise = np.nansum(extra**2, axis=-2) / count
        whole = noise + self._extra
        root = np.sqrt(np.maximum(whole, self._least))[:, None, :]
        return value / root / self._weight, extra / root, whole, noise

    def _normal(
        self, points: Sequence[Array], more: Array | float = 0.0
    ) -> tuple[Array, Array, Array, Array]:
        """See `_white`: zero in rows that are not valid at one of the points."""
        value, extra, whole, noise = self._white(points, more)
        valid = np.isfinite(value).all(axis=0) & np.isfinite(extra).all(axis=0)
        return np.where(valid, value, 0.0), np.where(valid, extra, 0.0), whole, noise

    def _slopes(self, at: Array) -> _Slopes:
        value, added, whole, _ = self._normal([at, *self._around(at)])
        logs = np.log(np.maximum(whole, self._least))
        by, added_by, log_by = (self._difference(x) for x in (value, added, logs))
        return _Slopes(value[0], added[0], by, added_by, log_by)

    def _around(self, at: Array) -> list[Array]:
        """For each colour two points, with all that is fitted and has it a little more and less."""
        steps = [_STEP * (self._colours == c) for c in range(self._colours.max(initial=-1) + 1)]
        return [at + sign * step for step in steps for sign in (1.0, -1.0)]

    def _difference(self, values: Array) -> Array:
        """Slopes (p, ..., residuals) of what was found at a point and `_around` it."""
        apart = (values[1::2] - values[2::2]) / (2 * _STEP)
        shape = len(self._moves), *[1] * (values.ndim - 2), -1
        return np.where(self._moves.reshape(shape), apart[self._colours], 0.0)

    def cost(self, delays: Array, value: Sequence[float]) -> float:
        """The sum of squares at values in SI units, inputs so many samples late."""
        at = np.append((np.asarray(value) - self.nominal) / self.scale, delays)
        return float(np.sum(self._normal([at])[0] ** 2))

    def solve(self, at: Array, most: int = STEPS) -> Array:
        """The parameters that leave least, with the weights as they are; after `most` steps."""
        return least(at, self._low, self._high, self._descent, self._costs, _ENOUGH, most)

    def best(self, points: Sequence[Array]) -> Array:
        """The one of some points that leaves least, with the weights as they are."""
        return points[int(np.nanargmin(self._costs(points)))]

    def _known(self) -> Array:
        """What is known before any log, as rows (n, p) of which the squares are added."""
        return np.vstack([np.diag(1.0 / self._spread), self._pins])

    def _descent(self, at: Array) -> tuple[Array, Array]:
        """The gradient and the curvature of half the sum of squares."""
        s, known = self._slopes(at), self._known()
        gradient = np.einsum("atr,tr->a", s.by, s.value) + known.T @ (known @ at)
        return gradient, np.einsum("atr,btr->ab", s.by, s.by) + known.T @ known

    def _costs(self, points: Sequence[Array]) -> Array:
        """Half the sums of squares; a row that is lost on the way counts as at the first point."""
        value = self._white(points)[0]
        value = np.where(np.isfinite(value), value, value[0])
        known = np.array(points) @ self._known().T
        return np.asarray((np.nansum(value**2, axis=(1, 2)) + (known**2).sum(axis=1)) / 2.0)

    def pin(self, directions: Array) -> None:
        """Keep to the nominal values along directions (n, p) of the parameters.

        To where they are nearest by their tolerances: what is known best moves least.
        """
        across = directions * self._spread[: directions.shape[1]] ** -2.0
        size = np.linalg.norm(across, axis=1, keepdims=True)
        across *= np.linalg.norm(directions, axis=1, keepdims=True) / size
        late = np.zeros((len(directions), self.size - directions.shape[1]))
        self._pins = np.hstack([across, late]) / _PINNED

    def weigh(self, at: Array, first: bool = False) -> None:
        """Rows and variances from what is left at a point; at `first` all rows, as they are.

        What is left beyond the noise of the sensors is the model's error, which no parameter
        changes; where that would make zeros of all parameters, it is a weight alone. It is there
        from the `first` point on: a parameter that divides what is noisy would else be made
        nothing of, so that noise drowns what the model is off by. What noise moves residuals by to
        one side is taken off as it is here, beside all that it adds: that shrinks with parameters.
        """
        self._bent = self._runs.bent(self._numbers(at), self._delays(at), self._offsets(at))
        if not first:
            clean, added = self._rows([at])
            self._noise_filters = np.stack([whitening(x) for x in added[0].T], axis=1)
            much = rms(clean[0]) > MUCH * rms(added[0])  # has no memory that noise would tell
            self._noise_filters[:, much] = np.eye(LAGS + 1)[:, :1]
            self._all = self._all | np.isfinite(filtered(clean[0] + added[0], self._noise_filters))
            self._mask = self._usual(at, clean[0])
            self._filters = self._noise_filters
        self._extra[:], self._weight[:] = 0.0, 1.0
        value, _, _, noise = self._normal([at])
        times = (value[0] ** 2).sum(axis=0) / np.maximum(self._mask.sum(axis=0), 1)
        more = np.maximum(times - 1.0, 0.0)
        self._extra = np.where(self._homogeneous, 0.0, more * noise[0])
        self._weight = np.where(self._homogeneous, np.sqrt(1.0 + more), 1.0)

    def _usual(self, at: Array, clean: Array) -> Mask:
        """The rows without those that are far from what is usual: there it was another machine.

        Unless half of what is known of some parameter is in them: then the model is wrong.
        """
        white = np.abs(np.where(self._all, filtered(clean, self._noise_filters), np.nan))
        usual = [np.nanmedian(w) / 0.6745 if np.isfinite(w).any() else 0.0 for w in white.T]
        far = np.zeros_like(self._all)
        for lag in range(LAGS + 1):  # and what the filters remember of them
            far[lag:] |= white[: len(white) - lag] > _FAR * np.array(usual)
        self._mask = self._all
        energy = self._slopes(at).by[: len(self.names)] ** 2
        whole, part = energy.sum(axis=(1, 2)), (energy * far).sum(axis=(1, 2))
        return self._all if (part > _MOST * whole).any() else self._all & ~far

    def sound(self, at: Array, wrong: Sequence[bool]) -> Mask:
        """What is fitted of which no more than half is known by residuals that are `wrong`."""
        energy = (self._slopes(at).by ** 2).sum(axis=1)
        known = np.maximum(energy.sum(axis=1), 1e-300)
        share = energy[:, list(wrong)].sum(axis=1) / known
        return np.asarray(share[: len(self.names)] <= _MOST)

    def _follows(self, at: Array) -> list[float | None]:
        """For each residual, the share of what is left that follows the inputs.

        As it is: whitened noise of differences would be all of it, and another law is slow.
        """
        left, inputs, same = self._rows([at])[0][0], self._runs.inputs(), np.eye(LAGS + 1)[0]
        return [
            follows(one, inputs, same, self._mask[:, r]) for r, one in enumerate(left.T)
        ]

    def disturbed(self, at: Array, residuals: Sequence[bool]) -> tuple[Array, Array]:
        """By how much the disturbance in some residuals may have moved what is fitted, and surely
        has, as covariances, as far as the inputs and a constant tell (`leaned`).
        """
        s, inputs, count = self._slopes(at), self._runs.inputs(), len(self.names)
        masks = {r: self._mask[:, r] for r in np.flatnonzero(residuals).tolist()}
        found = {r: instruments(inputs, self._filters[:, r], m) for r, m in masks.items()}
        known = {
            r: (masks[r], np.column_stack([basis, np.full(len(basis), len(basis) ** -0.5)]))
            for r, basis in found.items() if basis is not None
        }  # fmt: skip
        curved = np.einsum("atr,btr->ab", s.by, s.by) + self._pins.T @ self._pins
        axes, shares = _axes(curved, self._spread)
        may, has = leaned(s.value, s.by, known, axes * np.sqrt(shares))
        return may[:count, :count], has[:count, :count]

    def bound(self, at: Array) -> Mask:
        """Which parameters are where their sign would change."""
        return (at <= self._low * (1 - 1e-3)) | (at >= self._high * (1 - 1e-3))

    def covariance(self, at: Array) -> Array:
        """Of the parameters, relative, also of those at a bound: others make up for them.

        A sandwich: what the curvature says, and how much the slope of the sum of squares scatters
        with what is left as it is, correlated or not (Newey and West 1987). The noise in the
        slopes themselves tells nothing of the parameters and is taken off the curvature.
        """
        s = self._slopes(at)
        _, _, whole, noise = self._normal([at])
        rows = self._mask.sum(axis=0)
        error = rows * (1.0 - noise[0] / np.maximum(whole[0], 1e-300)) / 4.0
        curved = np.einsum("atr,btr->ab", s.by, s.by)
        curved -= np.einsum("atr,btr->ab", s.added_by, s.added_by)
        curved -= np.einsum("ar,br,r->ab", s.log_by, s.log_by, error)
        own = np.einsum("tr,atr->ta", s.value, s.by)
        mine = np.einsum("tr,atr->ta", s.added, s.added_by)
        scatter = newey_west(own) + newey_west(mine)
        scatter *= few_rows(len(own)) ** 2 * len(own) / max(len(own) - len(at), 1)
        return _sandwich(curved, scatter, self._spread)

    def apart(self, at: Array) -> Array:
        """How far parameters may stand from here in a further log, in 95 of 100, relative.

        Of each log how far each parameter would have to move, by itself, to explain what is left
        of it: one step of Gauss and Newton. A further one stands so far from their mean, beside how
        they scatter, as a t with one less than their number does (of a prediction interval).
        Infinite where fewer than two logs tell. All rows count: those that are far from what is
        usual may be a log that differs.
        """
        usual, self._mask = self._mask, self._all
        s, count = self._slopes(at), len(self.names)
        self._mask = usual
        logs: dict[str, Mask] = {}
        for name, _, rows in self._runs.times():
            logs.setdefault(name, np.zeros(len(s.value), dtype=np.bool_))[rows] = True
        by, added = s.by[:count], s.added_by[:count]
        score = np.array([np.einsum("atr,tr->a", by[:, k], s.value[k]) for k in logs.values()])
        energy = np.array([
            np.sum(by[:, k] ** 2 - added[:, k] ** 2, axis=(1, 2)) for k in logs.values()
        ])  # fmt: skip
        told = energy > _BLIND * energy.max(axis=0)
        weight = np.where(told, energy, 0.0)
        step = np.divide(score, energy, out=np.zeros_like(score), where=told)
        many, whole = told.sum(axis=0), np.maximum(weight.sum(axis=0), 1e-300)
        free = np.maximum(many - 1, 1)
        mean = (weight * step).sum(axis=0) / whole
        scatter = (weight * (step - mean) ** 2).sum(axis=0) / whole * many / free
        further = stdtrit(free, 0.975) * np.sqrt(scatter * (1.0 + 1.0 / np.maximum(many, 1)))
        return np.asarray(np.where(many > 1, np.abs(mean) + further, math.inf))

    def suspects(self, at: Array, units: Mapping[str, str]) -> tuple[Suspect, ...]:
        """The offsets that would explain what is left, each by itself, the likeliest one first."""
        wanted = [k for k in range(len(self._runs.biased)) if k not in self._offset_at]
        found = []
        for k, value, error, share in self._scored(at, wanted, np.diag(self._sizes), 1):
            if share > _MATTERS:
                name, size = self._runs.names([self._runs.moved[k]])[0], float(self._sizes[k])
                found.append(
                    Suspect(name, value * size, error * size, units.get(name, ""), share)
                )
        return tuple(sorted(found, key=lambda one: -one.share))

    def delayed(self, at: Array) -> list[int]:
        """The columns of commands that come early or late, as logs show, and are not fitted so."""
        signals = self._runs.moved
        wanted = [k for k, column in enumerate(signals)
                  if column in self._runs.commands and k not in self._late_at]  # fmt: skip
        return [signals[k] for k, *_ in self._scored(at, wanted, np.eye(len(signals)), 0)]

    def _scored(
        self, at: Array, wanted: Sequence[int], sizes: Array, which: int
    ) -> Iterator[tuple[int, float, float, float]]:
        """Of `wanted` signals those whose delay (`which` 0) or offset (1) would explain what is
        left: the number, its value, error and share.

        A test of scores: how much the sum of squares falls with it if all that is fitted follows,
        beside how much this scatters with what is left as it is, correlated or not. What noise that
        is in slopes and in what is left makes of it is taken off. One of each is a row of `sizes`,
        (signals, signals).
        """
        if not wanted:
            return
        s = self._slopes(at)
        more = np.zeros((2, 2 * len(wanted), len(sizes)))
        more[which] = np.vstack([_STEP * sizes[wanted], -_STEP * sizes[wanted]])
        moved = self._normal([at] * (2 * len(wanted)), more)[:2]
        apart = [(m[: len(wanted)] - m[len(wanted) :]) / (2 * _STEP) for m in moved]
        by, noisy = s.by.reshape(len(at), -1), s.added_by.reshape(len(at), -1)
        curved = by @ by.T - noisy @ noisy.T + self._pins.T @ self._pins
        axes, shares = _axes(curved, self._spread)
        inverse = (axes * shares) @ axes.T
        for k, slope, shaken in zip(wanted, *apart, strict=True):
            follow = inverse @ (by @ slope.ravel() - noisy @ shaken.ravel())
            alone = slope - np.tensordot(follow, s.by, 1)
            noise = shaken - np.tensordot(follow, s.added_by, 1)
            energy = float(np.sum(alone**2) - np.sum(noise**2))
            if energy <= _BLIND * float(np.sum(slope**2)):
                continue
            scores = (alone * s.value).sum(axis=1), (noise * s.added).sum(axis=1)
            score = float(np.sum(scores[0]) - np.sum(scores[1]))
            scatter = float(sum(newey_west(x[:, None])[0, 0] for x in scores))
            share = score**2 / energy / max(float(np.sum(s.value**2)), 1e-300)
            if score**2 > chdtri(1, _RARE / len(wanted)) * scatter:
                yield k, -score / energy, math.sqrt(scatter) / energy, share

    def left(self, at: Array) -> tuple[Left, ...]:
        """What is left of every residual at a point, beside what there was."""
        clean, added = self._rows([np.zeros(len(at)), at])
        before, after, noise = rms(clean[0]), rms(clean[1]), rms(added[1])
        louder = np.where(rms(added[0]) > 0, noise / np.maximum(rms(added[0]), 1e-300), 1.0)
        term = np.max([after * 0.0, *map(rms, self._terms(at)[1])], axis=0)
        white = filtered(clean[1], self._noise_filters)
        share = self._follows(at)
        found = []
        for k, name in enumerate(self._runs.engine.residuals):
            own = white[:, k]
            good = np.isfinite(own[1:]) & np.isfinite(own[:-1])
            square = float(np.sum(own[1:][good] ** 2))
            memory = float(np.sum((own[1:] * own[:-1])[good])) / square if square else 0.0
            spans = self._spans(own)
            found.append(
                Left(
                    name, int(np.isfinite(clean[1, :, k]).sum()), float(before[k]),
                    float(after[k]), float(noise[k]), memory, share[k], spans, float(term[k]),
                    float(self._runs.lost[k]), float(louder[k]),
                )
            )
        return tuple(found)

    def _terms(self, at: Array) -> tuple[Array, Array]:
        """The residuals, (rows, residuals), and of each parameter the term with it in them."""
        clean = self._rows([at, *self._around(at)])[0]
        share = (self.values(at) / self.scale)[: self._shared, None, None]
        return clean[0], share * self._difference(clean)[: self._shared]

    def terms(self, at: Array) -> tuple[Terms, ...]:
        """Each residual as the term with the parameter that makes most of it, and all others."""
        runs, count = self._runs, self._shared
        value, parts = self._terms(at)
        found, pieces = [], runs.times()
        for log in dict.fromkeys(name for name, _, _ in pieces):
            time = np.concatenate([t for name, t, _ in pieces if name == log])
            rows = np.concatenate([np.arange(s.start, s.stop) for n, _, s in pieces if n == log])
            for k, name in enumerate(runs.engine.residuals):
                if not count or not np.isfinite(value[rows, k]).any():
                    continue
                one = int(np.argmax(rms(parts[:, :, k].T)))
                term = parts[one, rows, k]
                others = term - value[rows, k]
                found.append(Terms(name, self._free[one], log, time, term, others))
        return tuple(found)

    def _spans(self, white: Array) -> tuple[Span, ...]:
        """Where more than twice as much is left as usual, by spans of the logs."""
        runs, found = self._runs, []
        apart = runs.every * runs.engine.sample_time
        most = max(map(len, runs.pieces)) // runs.every
        size = max(LAGS, math.ceil(most / _SPANS))
        for name, time, rows in runs.times():
            own = white[rows]
            for start in range(0, len(own), size):
                part = own[start : start + size]
                good = part[np.isfinite(part)]
                if len(good) >= LAGS:
                    begin = float(time[start]) - apart
                    mean = math.sqrt(float(np.mean(good**2)))
                    found.append(Span(name, begin, begin + len(part) * apart, mean))
        usual = float(np.median([s.times for s in found])) if found else 0.0
        if not usual:
            return ()
        return tuple(s._replace(times=s.times / usual) for s in found if s.times > 2.0 * usual)
