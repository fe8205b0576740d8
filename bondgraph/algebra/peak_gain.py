"""Peak gains of a linear recursion: how far bounded inputs can drive a value, to the last sample.

The largest value of a sum over all past inputs is the L1 norm of the impulse response times the
bound of the inputs. What is left of an infinite sum after its last computed term is bounded by the
inverse of 1 - |A|, which is a sum of powers too (Jackson, 1970; Lopez, Hilaire and Didier, 2014).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray

    Matrix: TypeAlias = NDArray[float64]

_LEFT = 2.0**-40  # of an impulse response, where it is as good as over
_MOST = 20_000  # samples of it that are computed
_SLACK = 1.0 + 1e-9  # for rounding of this computation


class Unstable(Exception):
    """What a value remembers does not fade: no bound of the inputs bounds it."""


def peak_gains(recursion: Matrix, into: Matrix, out: Matrix, through: Matrix, first: Matrix) -> Any:
    """By value (row) and input (column) the largest |value| while that input is within -1 to 1.

    x' = recursion x + into u, value = out x + through u; after the very first sample x is
    `first` u. Raises `Unstable` where powers of |recursion| do not fade.

    >>> import numpy as np
    >>> one = np.ones((1, 1))
    >>> float(peak_gains(0.5 * one, one, one, 0 * one, 0 * one).round(6)[0, 0])
    2.0
    """
    import numpy as np

    size = len(recursion)
    sum_of_powers = np.linalg.inv(np.eye(size) - np.abs(recursion)) if size else recursion
    least = -1e-12 * np.abs(sum_of_powers).max(initial=0.0)
    if not (np.isfinite(sum_of_powers).all() and (sum_of_powers >= least).all()):
        raise Unstable
    sum_of_powers = np.maximum(sum_of_powers, 0.0)
    impulse, start, so_far = into.copy(), first.copy(), np.abs(through)
    largest = so_far + np.abs(out @ start)
    least = _LEFT * max(1e-300, np.abs(into).max(initial=0.0), np.abs(first).max(initial=0.0))
    for _ in range(_MOST):
        if max(np.abs(impulse).max(initial=0.0), np.abs(start).max(initial=0.0)) <= least:
            break
        so_far = so_far + np.abs(out @ impulse)
        impulse, start = recursion @ impulse, recursion @ start
        largest = np.maximum(largest, so_far + np.abs(out @ start))
    rest = np.abs(out) @ sum_of_powers @ (np.abs(impulse) + np.abs(start))
    return np.maximum(largest, so_far + rest) * _SLACK
