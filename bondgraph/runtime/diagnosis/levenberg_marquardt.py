"""The least of a sum of squares between bounds (Levenberg 1944, Marquardt 1963).

What is summed is a run over whole logs, and slopes are many runs: so of each slope several steps
are tried, all at once. Long ones count as much as damped ones: where most of a slope is noise, a
step of Gauss and Newton is too short by the share of it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.optimize import lsq_linear

from bondgraph.runtime.log import Array

_LONGER = (1.0, 2.0, 4.0, 8.0)  # times the step of Gauss and Newton
_DAMPING = (1e-3, 0.03, 1.0, 30.0)  # of its curvature
_SINGULAR = 1e-12  # of the largest curvature: less is reckoned as so much
_NEARER = 0.9  # of the way to a bound, in a step: behind one far away there may be no way back
STEPS = 50  #: at most


def least(
    at: Array,
    low: Array,
    high: Array,
    slope: Callable[[Array], tuple[Array, Array]],
    costs: Callable[[Sequence[Array]], Array],
    enough: float,
    most: int = STEPS,
) -> Array:
    """The point (p,) between `low` and `high` with the least cost, half a sum of squares.

    `slope` gives its gradient (p,) and its curvature (p, p) as Gauss and Newton take it, `costs`
    those of points of which the first is the one that there is, NaN where there is none. It ends
    where a step gains less than `enough`, or promises less, after so many steps at `most`.

    >>> def slope(x):
    ...     by = np.array([[-20 * x[0], 10.0], [-1.0, 0.0]])
    ...     return by.T @ [10 * (x[1] - x[0] ** 2), 1 - x[0]], by.T @ by
    >>> def costs(points):
    ...     return np.array([50 * (y - x**2) ** 2 + (1 - x) ** 2 / 2 for x, y in points])
    >>> start, wide = np.array([-1.2, 1.0]), np.full(2, np.inf)
    >>> least(start, -wide, wide, slope, costs, 1e-12).round(3).tolist()
    [1.0, 1.0]
    >>> least(start, -wide, np.array([0.5, 4.0]), slope, costs, 1e-12).round(3).tolist()
    [0.5, 0.25]
    """
    here = np.clip(at, low, high)
    for _ in range(most):
        gradient, curvature = slope(here)
        steps = _steps(gradient, curvature, _NEARER * (low - here), _NEARER * (high - here))
        if -float(gradient @ steps[0]) < enough:
            break
        points = [here, *(here + step for step in steps)]
        cost = costs(points)
        best = int(np.nanargmin(cost))
        gain = float(cost[0] - cost[best])
        here = points[best]
        if not gain >= enough:
            break
    return here


def _steps(gradient: Array, curvature: Array, low: Array, high: Array) -> list[Array]:
    """What is tried: the step of Gauss and Newton between the bounds, longer ones, damped ones."""
    size = np.sqrt(np.diag(curvature))
    values, vectors = np.linalg.eigh(curvature / np.outer(size, size))
    values = np.maximum(values, _SINGULAR * values[-1])
    down = -vectors.T @ (gradient / size)
    found = []
    for damping in (0.0, *_DAMPING):
        root = np.sqrt(values + damping)
        bounds = low * size, high * size
        step = lsq_linear(root[:, None] * vectors.T, down / root, bounds, method="bvls").x
        found.append(step / size)
    return [*(np.clip(times * found[0], low, high) for times in _LONGER), *found[1:]]
