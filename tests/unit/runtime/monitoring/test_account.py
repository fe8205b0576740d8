"""What became of samples, counted by hand: none is lost, and idle residuals are named."""

from __future__ import annotations

import numpy as np
import pytest

import bondgraph
from bondgraph.runtime.monitoring.account import Account, numbers
from bondgraph.runtime.monitoring.clock import Clock, Gap, Piece
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
    return Account(ResidualStates(engine), 0.01, [k.path for k in engine.signals])


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
    found[1, STATES.index(BLIND)] = 1_000_000
    assert account.words() == "blind or warming up: r1 for 0.500 s and r2 for 2.78 h"


def test_cells_without_a_number_are_counted_by_signal(account: Account) -> None:
    """Two of a hundred of `i`, by hand; one of `j`, too few to be told; a row of none counts once
    as `empty`, for no signal."""
    clock = Clock(bondgraph.compile(text=_TWO).engine(native=False).signals, 0.01, 0.05)
    rows = np.ones((101, 4))
    at = list(account.missing).index
    rows[[3, 90], at("i")], rows[50, at("j")], rows[70] = np.nan, np.inf, np.nan
    for part in (slice(0, 40), slice(40, 101)):
        before, missing = numbers(clock), clock.missing.copy()
        clock.feed(np.arange(101)[part] * 0.01, rows[part])
        account.take(clock, before, missing)
    assert account.missing == {"u": 0, "w": 0, "i": 2, "j": 1}
    assert (account.samples["used"], account.samples["empty"]) == (100, 1)
    assert account.words() == "i had no number in 2 % of them"
    found = account._states.samples
    found[0, STATES.index(BLIND)] = 50
    assert account.words() == "i had no number in 2 % of them; blind or warming up: r1 for 0.500 s"
    other = Account(account._states, 0.01, account.missing)
    other.resume(account.to_record())
    assert other.missing == account.missing


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
