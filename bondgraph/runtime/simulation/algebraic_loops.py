"""Algebraic loops: several unknowns at once, of linear equations or by Newton's method."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from bondgraph.runtime.log import Array

Places = Sequence[tuple[int, int]]  # row and column of each entry of a matrix
Look = Callable[..., tuple[list[float], list[list[float]]]]  # unknowns -> zeros, slopes

#: Unknowns of a loop from which on its matrix is kept sparse.
DENSE = 60
_STEPS = 60  # of Newton's method
#: Condition of a matrix that leaves something open: flows around a ring.
SINGULAR = 1e13
_EXACT = 1e-12  # relative accuracy of a loop
_GOOD = 1e-9  # of the terms of an equation: what may be left where no step brings it nearer
_TINY = 1e-300  # is zero: where a law jumps at zero, halving comes as near as this
_HALVINGS = 5000  # at most, 1000 of which lead from one to there
_DOUBLINGS = 120  # of the range in which a single unknown is looked for


class NoSolution(Exception):
    """The equations of a loop have no solution where the machine is now, or none was found."""


def factorised(size: int, places: Places, numbers: Array) -> Callable[[list[float]], list[float]]:
    """The solution for a right side, of a matrix that does not change.

    Where the matrix is singular it is the least one: flows around a ring of the junction structure
    are open, and change nothing outside of it.

    >>> solve = factorised(2, [(0, 0), (0, 1), (1, 1)], np.array([1.0, 1.0, 2.0]))
    >>> solve([3.0, 4.0])
    [1.0, 2.0]
    """
    if size > DENSE:
        from scipy.sparse import csc_array
        from scipy.sparse.linalg import splu

        rows, columns = zip(*places, strict=True)
        try:
            factors = splu(csc_array((numbers, (rows, columns)), shape=(size, size)))
            pivots = np.abs(factors.U.diagonal())
            if pivots.min() * SINGULAR > pivots.max():
                return lambda b: [float(x) for x in factors.solve(np.array(b))]
        except RuntimeError:
            pass  # exactly singular
    inverse = inverted(size, places, numbers)
    if size <= 4:
        lines = inverse.tolist()
        return lambda b: [sum(c * v for c, v in zip(line, b, strict=True)) for line in lines]
    return lambda b: [float(x) for x in inverse @ b]


def inverted(size: int, places: Places, numbers: Array) -> Array:
    """The inverse of a matrix, shape (size, size); where it is singular the pseudoinverse."""
    matrix = np.zeros((size, size))
    for (i, j), n in zip(places, numbers, strict=True):
        matrix[i, j] = n
    singular = not np.linalg.cond(matrix) < SINGULAR
    return np.asarray(np.linalg.pinv(matrix) if singular else np.linalg.inv(matrix))


def solver(size: int, places: Places) -> Callable[[list[float], list[float]], list[float]]:
    """The solution for the entries of a matrix and a right side.

    Raises `NoSolution` where the matrix is singular and the equations contradict each other.
    """
    if size == 1:
        return lambda a, b: [b[0] / a[0]]
    rows = [i for i, _ in places]
    columns = [j for _, j in places]

    def dense(entries: list[float], right: list[float]) -> list[float]:
        matrix = np.zeros((size, size))
        matrix[rows, columns] = entries
        try:
            found = np.linalg.solve(matrix, right)
            if np.abs(found).max() * np.abs(matrix).max() <= SINGULAR * np.abs(right).max():
                return [float(x) for x in found]
        except np.linalg.LinAlgError:
            pass
        return _least(matrix, np.array(right))

    def sparse(entries: list[float], right: list[float]) -> list[float]:
        from scipy.sparse import csc_array
        from scipy.sparse.linalg import splu

        matrix = csc_array((entries, (rows, columns)), shape=(size, size))
        try:
            return [float(x) for x in splu(matrix).solve(np.array(right))]
        except RuntimeError:
            return _least(matrix.toarray(), np.array(right))

    return dense if size <= DENSE else sparse


def _least(matrix: Array, right: Array) -> list[float]:
    """The least solution of equations that leave something open."""
    if not np.isfinite(matrix).all() or not np.isfinite(right).all():
        raise NoSolution
    found = np.linalg.lstsq(matrix, right, rcond=1 / SINGULAR)[0]
    left = np.abs(matrix @ found - right)
    if (left > _GOOD * (np.abs(matrix) @ np.abs(found) + np.abs(right))).any():
        raise NoSolution
    return [float(x) for x in found]


def iteration(size: int) -> Callable[[Look], list[float]]:
    """Newton's method for `size` unknowns, which starts from where it found a solution before.

    So a machine stays on its branch where there are several. Raises `NoSolution`.

    >>> solve = iteration(1)
    >>> solve(lambda x: ([x**2 - 4.0], [[2 * x]]))
    [2.0]
    """
    before: list[float] | None = None

    def newton(look: Look) -> list[float]:
        nonlocal before
        starts = [before, [0.0] * size, [1.0] * size, [-1.0] * size]
        for start in starts:
            found = None if start is None else _root(look, start)
            if found is not None:
                before = found
                return found
        found = _searched(look, before or [0.0] * size)
        if found is None:
            raise NoSolution
        before = found
        return found

    return newton


def _root(look: Look, start: list[float]) -> list[float] | None:
    """Newton's method with steps halved until the zeros shrink; None where it does not arrive."""
    x = list(start)
    try:
        zeros, slopes = look(*x)
    except (ArithmeticError, ValueError):
        return None
    for _ in range(_STEPS):
        if not any(zeros):
            return x
        step = _step(zeros, slopes)
        if step is None:
            return None
        if all(abs(s) <= _EXACT * (abs(v) + 1e-300) for s, v in zip(step, x, strict=True)):
            return [v - s for v, s in zip(x, step, strict=True)]
        size = sum(z * z for z in zeros)
        share = 1.0
        while True:
            trial = [v - share * s for v, s in zip(x, step, strict=True)]
            try:
                after, slopes_after = look(*trial)
                if sum(a * a for a in after) < size:
                    break
            except (ArithmeticError, ValueError):
                pass
            share /= 2
            if trial == x or share < 1e-12:
                return x if _good(x, zeros, slopes) else None
        x, zeros, slopes = trial, after, slopes_after
    return None


def _step(zeros: list[float], slopes: list[list[float]]) -> list[float] | None:
    try:
        step: list[float] = (
            [zeros[0] / slopes[0][0]]
            if len(zeros) == 1
            else np.linalg.solve(np.array(slopes), np.array(zeros)).tolist()
        )
    except (ZeroDivisionError, np.linalg.LinAlgError):
        return None
    return step if all(map(math.isfinite, step)) else None


def _good(x: list[float], zeros: list[float], slopes: list[list[float]]) -> bool:
    """Whether what is left of the equations is only rounding."""
    return all(
        abs(z) <= _GOOD * sum(abs(s * v) for s, v in zip(row, x, strict=True))
        for z, row in zip(zeros, slopes, strict=True)
    )


def _searched(look: Look, near: list[float]) -> list[float] | None:
    """Where Newton's method fails: a change of sign near a single unknown, else Levenberg's way."""
    from scipy.optimize import brentq, root

    def zeros(x: Any) -> Any:
        try:
            return look(*[float(v) for v in x])[0]
        except (ArithmeticError, ValueError):
            return [math.nan] * len(near)

    if len(near) > 1:
        found = root(zeros, near, method="lm")
        if not found.success or not np.isfinite(found.x).all():
            return None
        return _root(look, [float(v) for v in found.x])

    def zero(x: float) -> float:
        return float(zeros([x])[0])

    width = 1e-6 * (abs(near[0]) or 1.0)
    ends = [near[0], near[0]]
    signs = [zero(near[0])] * 2
    for _ in range(_DOUBLINGS):
        for side, way in ((0, -1), (1, 1)):
            x = near[0] + way * width
            value = zero(x)
            if value * signs[side] < 0:
                a, b = sorted((ends[side], x))
                eps = float(np.finfo(float).eps)
                x = float(brentq(zero, a, b, xtol=_TINY, rtol=4 * eps, maxiter=_HALVINGS))
                return [x if abs(x) > _TINY else 0.0]
            if math.isfinite(value):
                ends[side], signs[side] = x, value
        width *= 1.5
    return None
