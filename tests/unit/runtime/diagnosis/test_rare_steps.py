"""Steps that are rare, by hand."""

from __future__ import annotations

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.rare_steps import answered, answers, rare_steps, sizes
from bondgraph.runtime.log import Array


def test_a_step_is_what_a_command_changes_by_from_the_sample_before() -> None:
    steered = np.array([[3.0, 0.0], [1.0, np.nan], [np.nan, 2.0], [5.0, -2.0], [5.5, np.inf]])
    assert sizes(steered).tolist() == [[0.0, 0.0], [2.0, 0.0], [0.0, 0.0], [0.0, 4.0], [0.5, 0.0]]


def _stairs(*steps: tuple[int, float], rows: int = 40) -> Array:
    """A command that makes steps of some sizes at some samples."""
    found = np.zeros((rows, 1))
    for at, size in steps:
        found[at:] += size
    return found


def _rare(steered: Array, commands: int = 0) -> list[int]:
    found = rare_steps(steered, commands) if commands else rare_steps(steered)
    return np.flatnonzero(found[:, 0]).tolist()


@pytest.mark.parametrize("often", [3, 4])
def test_a_tenth_of_the_samples_may_make_steps_as_large(often: int) -> None:
    """Of 40 samples four: the fifth largest step is what is usual."""
    steps = [(5 + 6 * k, 1.0) for k in range(often)]
    assert _rare(_stairs(*steps)) == [at for at, _ in steps]
    more = [(5 + 6 * k, 1.0) for k in range(5)]
    assert _rare(_stairs(*more)) == []


def test_a_rare_step_is_more_than_three_times_a_usual_one() -> None:
    usual = [(5 + 3 * k, 1.0) for k in range(10)]
    assert _rare(_stairs(*usual, (37, 3.0))) == []
    assert _rare(_stairs(*usual, (37, -3.25))) == [37]


def test_a_pulse_of_a_command_is_no_rare_step_but_one_of_a_switch_is() -> None:
    pulse = _stairs((10, 4.0), (11, -4.0), (30, 4.0))
    assert _rare(pulse) == [10, 11, 30]
    assert _rare(pulse, commands=1) == [30]
    # what comes back to a fourth of it is taken back, what comes back to a third is not
    assert _rare(_stairs((10, 4.0), (11, -3.0)), commands=1) == []
    assert _rare(_stairs((10, 3.0), (11, -2.0)), commands=1) == [10, 11]
    # one sample later it is a step of its own
    assert _rare(_stairs((10, 4.0), (12, -4.0)), commands=1) == [10, 12]
    # a pulse at either end
    assert _rare(_stairs((1, 4.0), (2, -4.0)), commands=1) == []
    assert _rare(_stairs((39, 4.0)), commands=1) == [39]


def test_only_the_first_columns_are_commands() -> None:
    both = np.hstack([_stairs((10, 4.0), (11, -4.0))] * 2)
    found = rare_steps(both, 1)
    assert np.flatnonzero(found[:, 0]).tolist() == []
    assert np.flatnonzero(found[:, 1]).tolist() == [10, 11]


def test_sensors_answer_up_to_two_samples_behind_a_step() -> None:
    steps = np.array([0.0, 5.0, 1.0, 0.0, 0.0, 0.0, 2.0])
    assert answered(steps).tolist() == [0.0, 5.0, 5.0, 5.0, 1.0, 0.0, 2.0]
    rare = np.zeros((6, 2), dtype=bool)
    rare[1, 0] = rare[2, 1] = True
    assert answers(rare)[:, 0].tolist() == [False, True, True, True, True, False]
