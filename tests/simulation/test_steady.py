"""A run that starts in the steady state, against balances by hand."""

from __future__ import annotations

import numpy as np
import pytest

from bondgraph.runtime.simulation.integrate import SimulationError
from tests.simulation.machines import example, near, run

BRIEF = 'duration = 1\nsampling.rate = 20\nstart = "steady"\n'


def test_a_motor_runs_at_the_speed_where_its_torques_balance() -> None:
    machine = example("dc_motor")
    found = run(machine, BRIEF + "inputs.U = 12\ninputs.load = 0.001")
    p = found.parameters
    # U = R i + k w ; k i = f w + load
    i = (12 * p["f"] + p["k"] * 0.001) / (p["R"] * p["f"] + p["k"] ** 2)
    w = (p["k"] * i - 0.001) / p["f"]
    assert near(found.truth.columns["speed"], np.full(21, w), 1e-8)
    assert near(found.truth.columns["current"], np.full(21, i), 1e-8)
    assert found.undeclared == ()


def test_tanks_stand_where_torricelli_lets_out_what_comes_in() -> None:
    machine = example("two_tanks")
    found = run(machine, BRIEF + "inputs.Q = 1e-4\n[initial]\n'C1.q' = 1e-3\n'C2.q' = 1e-3")
    p = found.parameters
    p2 = (1e-4 / p["kout"]) ** 2
    p1 = p2 + (1e-4 / p["k12"]) ** 2
    assert near(found.truth.columns["p2"], np.full(21, p2), 1e-6)
    assert near(found.truth.columns["p1"], np.full(21, p1), 1e-6)


def test_what_only_adds_up_goes_on() -> None:
    found = run(
        "Se:T -> 1:w\nw -> I:J = 0.5\nw -> R:f = 0.2\nsensor th : rad = int(w.f)",
        BRIEF + "inputs.T = 1",
    ).truth
    assert near(found.columns["th"], 5 * found.time, 1e-8)


def test_dependent_storages_and_loops_are_in_it() -> None:
    found = run(
        "Se:U -> 1:i\ni -> I:La = 1\ni -> I:Lb = 2\ni -> R:d { e = f + f^3 }\ni -> Df:y",
        BRIEF + "inputs.U = 10",
    ).truth
    assert near(found.columns["y"], np.full(21, 2.0), 1e-8)
    assert near(found.columns["La.p"] + found.columns["Lb.p"], np.full(21, 6.0), 1e-8)


def test_where_there_is_none_it_says_what_goes_on_changing() -> None:
    with pytest.raises(SimulationError, match=r"no steady state.*`a\.q`"):
        run(
            "Sf:Q -> 0:n\nn -> C:a = 1\nn -> R:leak { f = tanh(e) }",
            BRIEF + "inputs.Q = 2",
        )
