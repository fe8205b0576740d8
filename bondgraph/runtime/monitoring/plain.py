"""Arrays as plain JSON and back: what is not finite is None there."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from bondgraph.runtime.log import Array


def numbers(values: Array) -> list[Any]:
    """An array as JSON can hold it: None for what is not finite."""
    return [
        numbers(v) if isinstance(v, np.ndarray) else (float(v) if math.isfinite(v) else None)
        for v in values
    ]


def array(values: Any, shape: tuple[int, ...]) -> Array:
    """The array again, infinite where there is None; raises ValueError for another shape."""
    found = np.array(values, dtype=float).reshape(shape)
    return np.where(np.isnan(found), math.inf, found)
