"""Functions near those of the library, to a stated bound: what `step` calls unless told not to.

tanh costs more than all the rest of a residual where it is exact to the last digit, and a sample
has no more than 24 bits. Its quotient of polynomials in x squared is one of least largest error,
found by weighted least squares (Lawson, 1961; Sanathanan and Koerner, 1963).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

#: Where the square of x is beyond this the value is 1 or -1.
FAR = 92.16
#: How far `near_tanh` is from tanh at most, in double.
BOUND = 1e-8

#: By power of x squared, from the lowest.
ABOVE = (
    359943924.938,
    50661031.066,
    1581360.68088,
    14915.8926299,
    38.3188174726,
    0.0121918445997,
)
BELOW = (359943925.083, 170642338.756, 10469617.8247, 178021.202073, 909.519092296, 1.0)


def _choose(holds: bool, yes: Callable[[], Any], no: Callable[[], Any]) -> Any:
    return yes() if holds else no()


def near_tanh(
    x: Any,
    real: Callable[[float], Any] = float,
    choose: Callable[[Any, Callable[[], Any], Callable[[], Any]], Any] = _choose,
) -> Any:
    """tanh to 1e-8, on any kind of number that has + * / and comparisons.

    >>> import math
    >>> abs(near_tanh(0.5) - math.tanh(0.5)) < BOUND, near_tanh(-30.0)
    (True, -1.0)
    """
    square = x * x

    def polynomial(factors: Sequence[float]) -> Any:
        *lower, last = factors
        value = real(last)
        for factor in reversed(lower):
            value = value * square + real(factor)
        return value

    return choose(
        real(FAR) < square,
        lambda: choose(x < real(0.0), lambda: real(-1.0), lambda: real(1.0)),
        lambda: x * polynomial(ABOVE) / polynomial(BELOW),
    )
