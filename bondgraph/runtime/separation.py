"""The smallest change of each fault that no change of another explains, for stated noise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_discrete_lyapunov

from bondgraph.ir.program import Program
from bondgraph.runtime.log import Array
from bondgraph.runtime.smallest import (
    Situation,
    faults,
    linear,
    need_numbers,
    noise,
    reached,
    sensitivities,
)

_MOMENTS = 64  # of a period that are looked at together; more tell hardly more
_ROWS = 1000  # of residuals at moments, beyond which there are fewer moments
_PARALLEL = 1e-5  # share of an effect that another fault leaves: less is its rounding
_FLOOR = 1e-8  # noise of a residual without any, relative to what faults do to it


class Separation(NamedTuple):
    """The smallest `changes[a][b]` of fault a, in its unit, that no change of fault b explains.

    None where there is none, as of a from itself. Only `faults` that these signals bring out.
    """

    faults: tuple[str, ...]
    changes: tuple[tuple[float | None, ...], ...]

    @property
    def groups(self) -> tuple[tuple[int, ...], ...]:
        """The numbers of the faults, those together that no size tells apart.

        >>> changes = (None, None, 2.0), (None, None, 3.0), (1.0, 1.0, None)
        >>> Separation(("a", "b", "c"), changes).groups
        ((0, 1), (2,))
        """
        found: list[list[int]] = []
        for a, row in enumerate(self.changes):
            for group in found:
                if row[group[0]] is None:
                    group.append(a)
                    break
            else:
                found.append([a])
        return tuple(map(tuple, found))


def separation(
    program: Program, tolerances: Mapping[str, float], situation: Situation
) -> Separation:
    """How large a fault has to be to be told from each other one.

    A change d of a fault moves the residuals by d s_a, s_a its sensitivities through the filter at
    moments of one period of the signals (one moment, where nothing moves). With V the covariance
    of the residuals there, P_b the projection onto s_b in its metric, what no size of b explains
    stands |d| ||(1 - P_b) s_a|| standard deviations above the noise, which is kappa for

        d = kappa/||(1 - P_b) s_a||,    ||x||^2 = x' V^-1 x.

    V is that of the noise, between residuals and moments too (X = A X A' + B B', C A^k X C'), and
    of the other parameters, evenly spread within their tolerances. Residuals that integrate noise
    are left out; one without any counts as one with hardly any. Arguments are those of `smallest`;
    raises ValueError as it does.
    """
    need_numbers(program)
    names = [name for name, sigma in noise(program, situation).items() if sigma is not None]
    if not names:
        return Separation((), ())
    every = faults(program, tolerances, situation)
    moved = sensitivities(program, every, situation)
    known = [f for f in every if any(moved[f.path][name].any() for name in names)]
    if not known:
        return Separation((), ())
    length = len(moved[known[0].path][names[0]])
    stride = -(-length // max(1, min(_MOMENTS, _ROWS // len(names))))
    effects = [np.array([moved[f.path][n][::stride] for n in names]).T.ravel() for f in known]
    s = np.array(effects).T  # a column a fault
    size = (np.abs(s) * [f.step for f in known]).max(axis=1)
    rows = size > 0
    s = s[rows] / size[rows, None]
    own = _covariance(program, situation, names, len(rows) // len(names), stride)
    s = _white(own[np.ix_(rows, rows)] / np.outer(size[rows], size[rows]), s)
    spread = np.array([f.tolerance * abs(f.nominal or 0.0) for f in known]) / np.sqrt(3)
    changes = [_apart(a, s, np.delete(s * spread, a, axis=1)) for a in range(len(known))]
    return Separation(
        tuple(f.path for f in known),
        tuple(
            tuple(situation.kappa * float(x) if np.isfinite(x) else None for x in row)
            for row in changes
        ),
    )


def _white(v: Array, s: Array) -> Array:
    """V^-1/2 s. A covariance is known to its rounding only: no noise is less than that."""
    variances, axes = np.linalg.eigh(v)
    floor = max(_FLOOR**2, len(v) * np.finfo(float).eps * variances[-1])
    return np.asarray((axes.T @ s) / np.sqrt(np.maximum(variances, floor))[:, None])


def _apart(a: int, s: Array, others: Array) -> Array:
    """1/||(1 - P_b) s_a|| for each b, infinite where b leaves nothing.

    In noise of variance one and what the `others` add: (1 + O O')^-1/2 s, by the singular values
    of O.
    """
    axes, sizes, _ = np.linalg.svd(others, full_matrices=False)
    white = s - axes @ ((1.0 - 1.0 / np.sqrt(1.0 + sizes**2))[:, None] * (axes.T @ s))
    along = white.T @ white[:, a] / np.sum(white**2, axis=0)
    left = np.linalg.norm(white[:, [a]] - white * along, axis=0)
    told = left > _PARALLEL * np.linalg.norm(white[:, a])
    return np.where(told, 1.0 / np.where(told, left, 1.0), np.inf)


def _covariance(
    program: Program, situation: Situation, names: Sequence[str], moments: int, stride: int
) -> Array:
    """Of the noise of some residuals at moments so many samples apart: (moments x residuals)^2."""
    with np.errstate(all="ignore"):
        a, b, c, d = linear(program, situation)
    chosen = [k for k, info in enumerate(program.residuals) if info.name in names]
    c, d = c[chosen], d[chosen]
    used = reached((c != 0).any(axis=0), a) & reached((b != 0).any(axis=1), a.T)
    a, b, c = a[np.ix_(used, used)], b[used], c[:, used]
    x = solve_discrete_lyapunov(a, b @ b.T) if used.any() else np.zeros((0, 0))
    blocks = [c @ x @ c.T + d @ d.T]
    later = np.linalg.matrix_power(a, stride - 1) @ (a @ x @ c.T + b @ d.T)
    step = np.linalg.matrix_power(a, stride)
    for _ in range(moments - 1):
        blocks.append(c @ later)
        later = step @ later
    lag = np.subtract.outer(range(moments), range(moments))
    stacked = np.array(blocks)[np.abs(lag)]
    stacked = np.where((lag < 0)[:, :, None, None], stacked.swapaxes(2, 3), stacked)
    n = moments * len(chosen)
    return np.asarray(stacked.swapaxes(1, 2).reshape(n, n))
