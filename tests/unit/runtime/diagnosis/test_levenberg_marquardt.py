"""The least of a sum of squares, beside another solver and beside what is known of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pytest
from scipy.optimize import least_squares

from bondgraph.runtime.diagnosis.levenberg_marquardt import least
from bondgraph.runtime.log import Array

ENOUGH = 1e-10


class Problem:
    """Half a sum of squares of `left`, whose slopes `by` (rows, p) are counted."""

    def __init__(self, left: Callable[[Array], Array], by: Callable[[Array], Array]) -> None:
        self.left, self.by, self.slopes = left, by, 0

    def slope(self, x: Array) -> tuple[Array, Array]:
        self.slopes += 1
        own = self.by(x)
        return own.T @ self.left(x), own.T @ own

    def costs(self, points: Sequence[Array]) -> Array:
        return np.array([np.sum(self.left(x) ** 2) / 2.0 for x in points])

    def least(self, at: Array, low: Array, high: Array) -> Array:
        return least(at, low, high, self.slope, self.costs, ENOUGH)


@pytest.mark.parametrize("seed", range(20))
def test_between_bounds_it_is_where_another_solver_is(seed: int) -> None:
    draw = np.random.default_rng(seed)
    rows, goal = draw.standard_normal((30, 4)), draw.standard_normal(30)
    sizes = 10.0 ** draw.integers(-4, 5, 4)  # what is fitted is of any size

    def left(x: Array) -> Array:
        z = x / sizes
        return np.asarray(rows @ (z + 0.1 * z**2) - goal)

    def by(x: Array) -> Array:
        return np.asarray(rows * (1.0 + 0.2 * x / sizes) / sizes)

    low, high = -sizes * draw.uniform(0.05, 2.0, 4), sizes * draw.uniform(0.05, 2.0, 4)
    problem = Problem(left, by)
    found = problem.least(np.zeros(4), low, high)
    assert ((low <= found) & (found <= high)).all()
    other = least_squares(left, np.zeros(4), by, bounds=(low, high), x_scale=sizes, ftol=1e-14)
    assert problem.costs([found])[0] <= other.cost + 1e-6


def test_where_most_of_a_slope_is_noise_steps_are_longer() -> None:
    """The noise only turns, and is as large anywhere: nine parts of ten of each slope are of it."""
    size = np.sqrt(1.8)

    def left(x: Array) -> Array:
        return np.array([1.0 + x[0] ** 2 / 10.0, size * np.sin(x[0]), size * np.cos(x[0])])

    def by(x: Array) -> Array:
        return np.array([[x[0] / 5.0], [size * np.cos(x[0])], [-size * np.sin(x[0])]])

    problem = Problem(left, by)
    wide = np.full(1, np.inf)
    found = problem.least(np.ones(1), -wide, wide)
    assert abs(found[0]) < 1e-3
    assert problem.slopes < 15  # Gauss and Newton go a tenth of the way: 0.9^66 is 1e-3


@pytest.mark.parametrize("start", (2.0, 5.0, 10.0, 30.0, 100.0))
def test_it_does_not_step_to_a_bound_from_which_there_is_no_way_back(start: float) -> None:
    """At the bound less is left than where it begins, and no slope leads away from there."""
    problem = Problem(lambda x: x**4 - 1.0, lambda x: np.array([4.0 * x**3]))
    found = problem.least(np.array([start]), np.array([1e-6]), np.array([np.inf]))
    assert found[0] == pytest.approx(1.0)


def test_a_point_without_a_cost_is_no_step() -> None:
    def left(x: Array) -> Array:
        with np.errstate(invalid="ignore"):
            return np.array([np.sqrt(2.0 - x[0]) - 1.0, 0.0])

    def by(x: Array) -> Array:
        return np.array([[-0.5 / np.sqrt(2.0 - x[0])], [0.0]])

    problem = Problem(left, by)
    wide = np.full(1, np.inf)
    assert problem.least(np.array([-7.0]), -wide, wide)[0] == pytest.approx(1.0)
