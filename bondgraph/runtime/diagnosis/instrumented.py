"""What the inputs as instruments tell of a disturbance in a fit.

A disturbance is in the sensors too, and what is multiplied with them leans on it. The inputs know
nothing of it: with them as instruments (Wright 1928) the fit would be elsewhere, and the difference
is what it leaned by (Hausman 1978), give or take what that fit scatters by. Where inputs explain
next to nothing of the slopes it is all scatter (Staiger and Stock 1997): then it tells that
nobody knows how far the fit leaned, and not that it did.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from bondgraph.runtime.diagnosis.whitening import newey_west_variances
from bondgraph.runtime.log import Array, Mask

# Times what chance explains of a slope, from which instruments count (Staiger and Stock 1997): the
# fit through them then leans by a tenth of what the other one does.
_STRONG = 10.0


def leaned(
    value: Array, by: Array, known: Mapping[int, tuple[Mask, Array]], alike: Array
) -> tuple[Array, Array]:
    """How far a fit may have leaned on a disturbance, and has, as two covariances (p, p).

    `value` (rows, residuals) is what is left, `by` (p, rows, residuals) are its slopes. `known` has
    for disturbed residuals their rows and instruments (`instruments`), `alike` (p, p) in its
    columns axes of the parameters along which the curvature is one. Where what is left stands is
    taken off: a sensor has an offset as likely as a disturbance has a mean.

    The axes are turned to those of which instruments explain different shares, each by itself
    (canonical correlations: the least is the statistic of Cragg and Donald 1993). So it is the same
    in all units, and for a combination of parameters as for one. Along each the fit may be off by
    the difference to the other one, and by no less than this scatters by, correlated or not. It is
    for certain by what is more than scatter, where instruments are strong: what chance explains is
    told by what they leave of a slope (Montiel Olea and Pflueger 2013).

    >>> draw = np.random.default_rng(1)
    >>> u, d = draw.standard_normal((2, 5000))
    >>> z = {0: (np.ones(5000, dtype=bool), (u / np.linalg.norm(u))[:, None])}

    Of y = x + d with x = u + d half of x is d, and so least squares give 1.5:

    >>> x = u + d
    >>> alike = np.array([[1.0 / np.linalg.norm(x)]])
    >>> may, has = leaned((d - 0.5 * x)[:, None], x[None, :, None], z, alike)
    >>> round(float(may[0, 0] ** 0.5), 1), round(float(has[0, 0] ** 0.5), 1)
    (0.5, 0.5)

    With an input that x hardly follows they give 2, and nobody can tell: noise of y is reason
    enough for the fit through it to be anywhere.

    >>> x = 0.01 * u + d
    >>> alike = np.array([[1.0 / np.linalg.norm(x)]])
    >>> left = draw.standard_normal(5000)
    >>> may, has = leaned((left - x * (x @ left) / (x @ x))[:, None], x[None, :, None], z, alike)
    >>> bool(may[0, 0] ** 0.5 > 0.3), float(has[0, 0])
    (True, 0.0)
    """
    slopes = np.tensordot(alike.T, by, 1)
    lost, value = np.zeros_like(slopes), value.copy()
    for r, (mask, basis) in known.items():
        value[mask, r] -= value[mask, r].mean()
        own = slopes[:, mask, r]
        lost[:, mask, r] = own - (own @ basis) @ basis.T
    shares, turn = np.linalg.eigh(np.einsum("atr,btr->ab", lost, lost))
    slopes, lost = (np.tensordot(turn.T, x, 1) for x in (slopes, lost))
    kept = np.maximum(1.0 - shares, np.finfo(float).eps)
    chance = np.zeros(len(kept))
    for r, (mask, basis) in known.items():
        for k, rest in enumerate(lost[:, mask, r]):
            chance[k] += newey_west_variances(basis * rest[:, None]).sum()
    moves = (((slopes - lost) / kept[:, None, None] - slopes) * value).sum(axis=2).T
    away, scatter = moves.sum(axis=0) ** 2, newey_west_variances(moves)
    surely = np.where(kept > _STRONG * chance, np.maximum(away - scatter, 0.0), 0.0)
    axes = alike @ turn
    may, has = ((axes * x) @ axes.T for x in (np.maximum(away, scatter), surely))
    return may, has
