"""Where something jumps: charge and momentum are kept, by closed forms and by hand."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import bondgraph
from bondgraph import Scenario, SimulationError
from tests.simulation.machines import near, run


def test_a_source_that_jumps_divides_its_charge_among_capacitors_in_series() -> None:
    """No current can flow through a resistor within no time: all get the same charge."""
    found = run(
        "Se:U -> 1:i\ni -> C:C1 = 1\ni -> C:C2 = 2\ni -> 0:n\nn -> R:R1 = 1\nn -> C:C3 = 1",
        'duration = 3\nsampling.rate = 50\ninputs.U = "if(t > 1, 5, 0)"\nrecord = ["n.e"]',
    ).truth
    after = found.time >= 1
    charge = 5 / (1 + 1 / 2 + 1)
    # then C3 discharges through R1 with C1 and C2 in series beside it: u' (C3 + 2/3) = -u/R1
    u = charge * np.exp(-(found.time - 1) / (1 + 2 / 3))
    assert near(found.columns["n.e"], np.where(after, u, 0))
    flown = charge + 2 / 3 * (charge - u)
    assert near(found.columns["C1.q"], np.where(after, flown, 0))
    assert near(found.columns["C2.q"], np.where(after, flown, 0))


CLUTCH = """
input closed : bool
Se:T -> 1:a
a -> I:J1 = 2
a -> R:f = 0.5
a -> 0:gap -> 1:b
b -> I:J2 = 3
1:slip when not closed { <- gap }
"""


def test_a_clutch_that_closes_keeps_the_momentum() -> None:
    found = run(
        CLUTCH,
        'duration = 2\nsampling.rate = 100\n[inputs]\nclosed = "t >= 1"\nT = 0\n'
        '[initial]\n"J1.p" = 8\n"J2.p" = 3',
    ).truth
    t = found.time
    before = np.where(t < 1, 4 * np.exp(-0.25 * t), 0)
    total = 8 * math.exp(-0.25) + 3
    both = np.where(t >= 1, total / 5 * np.exp(-0.1 * (t - 1)), 0)
    assert near(found.columns["J1.p"], 2 * (before + both))
    assert near(found.columns["J2.p"], np.where(t < 1, 3.0, 3 * both))


@pytest.mark.parametrize("closed", ["t > 0", "sin(t) > 0"])
def test_a_switch_may_turn_at_the_very_start(closed: str) -> None:
    found = run(
        CLUTCH,
        f'duration = 2\nsampling.rate = 100\n[inputs]\nclosed = "{closed}"\nT = 0\n'
        '[initial]\n"J1.p" = 8\n"J2.p" = 3',
    )
    t = found.log.time
    both = 11 / 5 * np.exp(-0.1 * t)
    assert near(found.truth.columns["J1.p"], 2 * both)
    assert near(found.truth.columns["J2.p"], 3 * both)
    assert found.log.columns["closed"].tolist() == [1.0] * len(t)


def test_an_inertia_behind_a_gear_that_gets_heavier_shares_its_momentum() -> None:
    """What is added stands still: the sum of momenta along the constraint stays."""
    found = run(
        "1:a -> I:J1 = 2\na -> TF:n { f1 = 3*f2 } -> 1:b\nparam J = 4\nb -> I:J2 = J\nb -> Df:w",
        'duration = 2\nsampling.rate = 10\n[initial]\n"J1.p" = 6\n"J2.p" = 4\n[[fault]]\nof = "J"\n'
        'change = "+= 5"\nat = 1',
    ).truth
    total = 3 * 6 + 4  # w1 = 3 w2: conjugate to w2
    w = np.where(found.time < 1, total / (9 * 2 + 4), total / (9 * 2 + 9))
    assert near(found.columns["w"], w)


def test_a_capacitor_that_changes_keeps_its_charge() -> None:
    found = run(
        "param Cx = 2\n0:n -> C:Cx\nn -> R:R = 1\nn -> De:u",
        'duration = 4\nsampling.rate = 20\n[initial]\n"Cx.q" = 4\n[[fault]]\nof = "Cx"\n'
        'change = "*= 2"\nat = 1\n[[fault]]\nof = "Cx"\nchange = "+= 3"\nat = 2\nramp = 1',
    ).truth
    t = found.time
    # q' = -q/C(t), with C = 2, then 4, then 4 + 3 (t - 2), then 7
    log = np.where(t < 1, t / 2, 0.5 + (np.clip(t, 1, 2) - 1) / 4)
    log = log + np.log((4 + 3 * np.clip(t - 2, 0, 1)) / 4) / 3 + np.clip(t - 3, 0, None) / 7
    q = 4 * np.exp(-log)
    C = np.where(t < 1, 2, 4 + 3 * np.clip(t - 2, 0, 1))
    assert near(found.columns["Cx.q"], q)
    assert near(found.columns["u"], q / C)


def test_inertias_start_with_what_is_said_and_meet_at_once() -> None:
    found = run(
        "1:a -> I:J1 = 1\na -> I:J2 = 2\na -> Df:w",
        'duration = 1\nsampling.rate = 2\n[initial]\n"J2.p" = 6',
    )
    assert found.dependent == ("J2",) or found.dependent == ("J1",)
    assert near(found.truth.columns["w"], np.full(3, 2.0))


@pytest.mark.parametrize("method", ["auto", "DOP853"])
@pytest.mark.parametrize(
    "pulse",
    [
        '"if(t > 6 and t < 6.001, 1000, 0)"',
        '"if(abs(t - 6.0005) < 0.0005, 1000, 0)"',
        '"500*(sign(t - 6) - sign(t - 6.001))"',
        '"1000*max(0, 1 - abs(t - 6.001)/0.001)"',
        '"1000/sqrt(pi)*exp(-((t - 6.0003)/0.001)^2)"',
        "{ table = [[0, 0], [6, 1000], [6.001, 0]], hold = 'previous' }",
        "{ table = [[0, 0], [6, 0], [6.001, 1000], [6.002, 0]] }",
    ],
)
def test_no_short_pulse_is_run_past(pulse: str, method: str) -> None:
    """Each holds one unit: the capacitor has it afterwards, less what has leaked."""
    found = run(
        "Sf:Q -> 0:n\nn -> C:Cx = 1\nn -> R:R = 1000\nn -> De:u",
        f'duration = 7\nsampling.rate = 500\nmethod = "{method}"\ninputs.Q = {pulse}',
    ).truth
    u = found.columns["u"]
    assert np.abs(u[found.time < 5.98]).max() < 1e-9
    assert abs(u[-1] - math.exp(-0.999 / 1000)) < 5e-6


@pytest.mark.parametrize("scale", [1e-9, 1e-3, 1e3])
def test_any_time_scale(scale: float) -> None:
    """A step on a resistor and a capacitor, at half of the run."""
    found = run(
        f"Se:U -> 1:i\ni -> R:R = 1000\ni -> C:Cx = {scale / 1000!r}",
        f"duration = {10 * scale}\nsampling.rate = {10 / scale}\n"
        f'inputs.U = "if(t < {5 * scale}, 0, 1)"\nrecord = ["Cx.e"]',
    ).truth
    late = np.clip(found.time / scale - 5, 0, None)
    assert found.rows == 101
    assert near(found.columns["Cx.e"], 1 - np.exp(-late))


def test_a_jump_at_a_sample_shows_there_and_not_before() -> None:
    found = run(
        "param R = 2\nSe:U -> 1:i\ni -> R:R\ni -> Df:y",
        'duration = 1\nsampling.rate = 10\ninputs.U = "if(t > 0.3, 1, 0)"\n[[fault]]\nof = "R"\n'
        'change = "*= 0.5"\nat = 0.1\nperiod = 0.6\nduty = 0.5',
    )
    told, read = found.log.columns["U"], found.log.columns["y"]
    assert told.tolist() == [0, 0, 0, *[1] * 8]
    # the fault is there from 0.1 to 0.4 and from 0.7 on
    assert np.allclose(read, [0, 0, 0, 1, 0.5, 0.5, 0.5, 1, 1, 1, 0.5])


def test_a_jump_on_whose_way_a_loop_has_no_solution(root: Path) -> None:
    """x12 is told to begin with 0.5 where the other storage on its junction is empty."""
    c = bondgraph.compile(root / "tests" / "random" / "once" / "root_of_what_cancels.bg")
    with pytest.raises(SimulationError, match=r"at 0 s: what `x12.p` holds has to change at once"):
        c.simulate(Scenario("jump", duration=0.1))
