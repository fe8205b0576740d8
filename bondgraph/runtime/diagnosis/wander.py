"""How a healthy residual wanders: a level that goes its own way slowly, beside noise from row to
row.

What a model leaves out changes while the machine is well: a supply, a temperature, air in a pipe. A
residual then stands a little elsewhere every few minutes. That is no fault, and no noise of which
sums of rows may reckon that it comes back.
"""

from __future__ import annotations

import math

import numpy as np

from bondgraph.runtime.log import Array
from bondgraph.text.tuples import NamedTuple

_MEMORIES = (-0.3, 0.0, 0.3, 0.6, 0.8)  # correlations of noise from row to row that are tried
_SHARES = tuple(10.0 ** (-0.5 * k) for k in range(11))  # of a step's variance, to that of noise
_STILL = 0.5  # probability before any row that it does not wander: the least share
_ENOUGH = 6  # rows, before which nothing tells noise and steps apart


class Wander(NamedTuple):
    """Of the level of one residual, in its unit.

    `step` is the deviation of what it moves in a row, `most` that of a residual which is known to
    wander. Behind the last row it stands at `level`, with this `variance`. Noise beside it adds up
    with the deviation `noise`: `less` times that of a residual which does not wander. A row alone
    is off by `alone`.
    """

    step: float
    most: float
    level: float
    variance: float
    noise: float
    less: float
    alone: float

    def lasting(self, deviation: float, white: float) -> float:
        """How noise adds up beside the level, that does with this deviation about a mean.

        About a mean a walk is noise with a memory as long as the rows. What adds up beside the
        level is no more than rows show there, nor less than `white` noise: a variance, of rows
        whose own is 1, behind the filter.
        """
        most = max(self.noise, math.sqrt(white) * self.alone) or math.inf
        return min(self.less * deviation, most)


NONE = Wander(0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)  #: of rows that tell nothing


def wander(values: Array) -> Wander:
    """How the level of a healthy residual wanders, from rows (n,), NaN where it had no value.

    A random walk beside noise of first order, for each of a grid of correlations and ratios of
    variances (local level: Harvey, 1989, ch. 2), by the filter of Kalman (1960). Each counts by how
    probable it makes the rows; before them it is as probable as not that there is no walk, and any
    ratio, scale of noise, and place to begin at is as probable as another. So few rows, which do
    not tell, leave room.

    >>> draw = np.random.default_rng(1)
    >>> white = draw.standard_normal(400)
    >>> walk = np.cumsum(0.1 * draw.standard_normal(400))
    >>> round(wander(white).step, 2), round(wander(white + walk).step, 2)
    (0.0, 0.11)
    """
    known = np.isfinite(values)
    if known.sum() < _ENOUGH or not np.ptp(values[known]) > 0.0:
        return NONE
    unit = float(values[known].std())
    own = values[int(np.argmax(known)) :] / unit
    kept, share = (x.reshape(-1) for x in np.meshgrid(_MEMORIES, _SHARES))
    adds = (1.0 + kept) / (1.0 - kept)  # variance of a sum of n rows of noise, over n
    step = share * adds  # variances are beside that of noise in a row
    level, variance, size, fit = _filtered(own, kept, step)
    count = int(known.sum()) - 1
    chance = -0.5 * (size + count * np.log(fit))
    flat = np.exp(chance - chance.max())
    still = share == min(_SHARES)
    prior = np.where(still, _STILL / still.sum(), (1.0 - _STILL) / (~still).sum())
    weight, flat = flat * prior / (flat @ prior), flat / flat.sum()
    scale = fit / max(count - 2, 1)
    noise = adds * scale
    alone = np.exp(chance[still] - chance[still].max())  # if there is no walk
    most = float(alone @ noise[still] / alone.sum())
    stands = float(weight @ level)
    return Wander(
        unit * math.sqrt(float(weight @ (step * scale))),
        unit * math.sqrt(float(flat @ (step * scale))),
        unit * stands,
        unit**2 * float(weight @ (variance * scale + (level - stands) ** 2)),
        unit * math.sqrt(float(weight @ noise)),
        math.sqrt(min(float(weight @ noise) / most, 1.0)),
        unit * math.sqrt(float(weight @ scale)),
    )


def _filtered(own: Array, kept: Array, step: Array) -> tuple[Array, Array, Array, Array]:
    """The level behind the last row with its variance, and twice the misfit of all rows.

    That is the sum of the logarithms of variances, and of squares over them. Each is of the shape
    of `kept`, the correlations of noise of variance 1, and of `step`, the variances of steps.
    """
    new = 1.0 - kept**2  # variance of noise that the row before does not tell
    level, left = np.full_like(kept, own[0]), np.zeros_like(kept)
    var, rest, both = np.ones_like(kept), np.ones_like(kept), -np.ones_like(kept)
    size = fit = np.zeros_like(kept)
    for value in own[1:].tolist():
        var, rest, both = var + step, kept**2 * rest + new, kept * both
        left = kept * left
        if not math.isfinite(value):
            continue
        whole = var + 2.0 * both + rest
        off = value - level - left
        up, side = (var + both) / whole, (rest + both) / whole
        level, left = level + up * off, left + side * off
        var, rest, both = (
            var - up * (var + both), rest - side * (rest + both), both - up * (rest + both)
        )  # fmt: skip
        size, fit = size + np.log(whole), fit + off**2 / whole
    return level, var, size, fit
