"""tanh of whole numbers: a cubic for each eighth, from a table, to a stated bound."""

from __future__ import annotations

import math
from functools import cache

#: Beyond this tanh is 1 as far as the bound goes; the table has so many cubics a unit.
END, CUBICS = 8, 8
#: The scale of the result, and the least and the largest scale that an argument may have.
BITS, LEAST_BITS, MOST_BITS = 30, 3, 27
#: How far it is from tanh at most. Interpolation at Chebyshev's points: the largest fourth
#: derivative 4.0859 times (1/16)^4/192, 3.3e-7; roundings of the evaluation: 4 units of 2^-30.
#: Beyond 8 tanh is nearer than 2.3e-7 to 1.
BOUND = 3.4e-7


@cache
def cubics() -> tuple[tuple[int, int, int, int], ...]:
    """By eighth c0, 2 c1, 4 c2, 8 c3 times 2^30: its cubic c0 + c1 t + ... for t from 0 to 1."""
    return tuple(_cubic(k / CUBICS) for k in range(END * CUBICS))


def _cubic(start: float) -> tuple[int, int, int, int]:
    points = [0.5 + 0.5 * math.cos((2 * k + 1) * math.pi / 8.0) for k in range(4)]
    values = [math.tanh(start + t / CUBICS) for t in points]
    differences = list(values)  # divided differences, after Newton
    for order in range(1, 4):
        for k in range(3, order - 1, -1):
            over = points[k] - points[k - order]
            differences[k] = (differences[k] - differences[k - 1]) / over
    found = [0.0, 0.0, 0.0, 0.0]
    for k in range(3, -1, -1):  # times (t - point), plus the next difference
        shifted = [0.0, *found[:3]]
        found = [s - points[k] * c for s, c in zip(shifted, found, strict=True)]
        found[0] += differences[k]
    a, b, c, d = (round(x * 2.0**power * 2.0**BITS) for power, x in enumerate(found))
    return a, b, c, d


def cubic_tanh(value: int, bits: int) -> int:
    """tanh(value / 2**bits) * 2**30, in whole numbers as the generated code has them.

    >>> round(cubic_tanh(-(1 << 26), 26) / 2**30, 6), round(math.tanh(-1.0), 6)
    (-0.761594, -0.761594)
    """
    size = abs(value)
    if size >= END << bits:
        found = 1 << BITS
    else:
        low = bits - 3
        part = (size << (31 - low)) & 0x7FFFFFFF
        a, b, c, found = cubics()[size >> low]
        for factor in (c, b, a):
            found = factor + (found * part >> 32)
    return -found if value < 0 else found
