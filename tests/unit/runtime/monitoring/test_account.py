"""What became of samples, counted by hand: none is lost, and idle residuals are named."""

from __future__ import annotations

import numpy as np
import pytest

import bondgraph
from bondgraph.runtime.monitoring.account import Account
from bondgraph.runtime.monitoring.clock import Gap, Piece
from bondgraph.runtime.monitoring.residual_states import BLIND, STATES, WARMING, ResidualStates

_TWO = """bg 1
model M { param R = 2; param S = 3
1:a { <- Se:u; -> R:ra = R; -> Df:i }
1:b { <- Se:w; -> R:rb = S; -> Df:j } }
"""


@pytest.fixture
def account() -> Account:
    """Of two residuals, with a step of 10 ms, that have seen nothing yet."""
    engine = bondgraph.compile(text=_TWO).engine(native=False)
    return Account(ResidualStates(engine), 0.01)


def _piece(gap: Gap | None) -> Piece:
    return Piece(np.zeros(1), np.zeros((1, 4)), "a gap", gap)


def test_nothing_is_said_while_all_were_watched(account: Account) -> None:
    account._states.samples[:, 0] = 500
    assert account.unwatched() == {"r1": 0.0, "r2": 0.0}
    assert account.words() == ""


def test_residuals_that_were_idle_for_as_long_are_named_together(account: Account) -> None:
    found = account._states.samples
    found[0, STATES.index(WARMING)], found[0, STATES.index(BLIND)] = 30, 20
    assert account.unwatched() == {"r1": pytest.approx(0.5), "r2": 0.0}
    assert account.words() == "blind or warming up: r1 for 0.500 s"
    found[1, STATES.index(BLIND)] = 50
    assert account.words() == "blind or warming up: r1 and r2 for 0.500 s"
    found[1, STATES.index(BLIND)] = 100
    assert account.words() == "blind or warming up: r1 for 0.500 s and r2 for 1.000 s"


def test_in_a_gap_no_residual_is_watched(account: Account) -> None:
    account.gap(_piece(Gap(10.0, 12.5, 249)))
    account.gap(_piece(Gap(20.0, 5.0, 0)))  # the clock went back: nobody knows for how long
    account.gap(_piece(None))
    assert (account.lines["gaps"], account.lines["lost"], account.away) == (3, 249, 2.5)
    assert account.unwatched() == {"r1": 2.5, "r2": 2.5}


def test_samples_that_are_read_are_used_or_thrown_away_or_of_a_machine_that_is_off(
    account: Account,
) -> None:
    account.samples |= {"read": 1000, "used": 900, "off": 70}
    assert account.thrown == 30
