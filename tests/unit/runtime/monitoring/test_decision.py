"""Thresholds, latching and signatures on residuals that are written down here."""

from __future__ import annotations

import json

import numpy as np
import pytest

from bondgraph.runtime.monitoring.decision import Facts, Threshold
from bondgraph.runtime.monitoring.engine import Batch
from bondgraph.runtime.monitoring.verdict import Verdict

_SEES = {"r1": ("a", "b"), "r2": ("b", "c"), "r3": ("d",)}
_UNITS = {"a": "Ohm"}


def facts(floor: dict[str, float] | None = None) -> Facts:
    given = dict.fromkeys(_SEES, 1.0) if floor is None else floor
    return Facts(tuple(_SEES), _SEES, _UNITS, given, 0.1, 100)


def run(
    decision: Threshold, *stretches: tuple[float, float, float], start: float = 0.0
) -> list[Verdict]:
    """Half a second of each triple of residuals, at 1 kHz, in pieces; the threshold is 2."""
    value = np.repeat(np.array(stretches), 500, axis=0)
    time = start + np.arange(len(value)) / 1000
    said = []
    for k in range(0, len(value), 77):
        part = slice(k, k + 77)
        batch = Batch(value[part], np.ones_like(value[part], bool), np.ones_like(value[part]))
        said += decision.update(time[part], batch, value[part])
    return said


def faults(said: list[Verdict]) -> list[tuple[str, tuple[str, ...]]]:
    return [(v.event, v.group) for v in said if v.event in ("fault", "update", "cleared")]


@pytest.mark.parametrize(
    ("fired", "group"),
    [
        ((3.0, 0.0, 0.0), ("a",)),  # r2 is silent and would have seen b
        ((3.0, 1.4, 0.0), ("a",)),  # 0.4 of a floor: still clearly inside
        ((3.0, 1.6, 0.0), ("a", "b")),  # between silent and fired: clears nobody
        ((3.0, 3.0, 0.0), ("b",)),
        ((0.0, 0.0, -3.0), ("d",)),
        ((3.0, 0.0, 3.0), ()),  # no single fault moves both
        ((1.9, 1.9, -1.9), None),
    ],
)
def test_what_fired_names_and_what_is_clearly_silent_clears(
    fired: tuple[float, float, float], group: tuple[str, ...] | None
) -> None:
    said = run(Threshold(facts()), (0.0, 0.0, 0.0), fired)
    assert faults(said) == ([] if group is None else [("fault", group)])
    if group:
        fault = said[-1]
        assert fault.since == pytest.approx(0.5) and fault.time == pytest.approx(0.604, abs=2e-3)
        assert sum(c.probability for c in fault.candidates) == pytest.approx(1.0)
        assert set(fault.residuals.values()) == {1.5}
    if group == ():
        assert "more than one fault" in said[-1].message


def test_a_fault_is_latched_and_a_second_residual_updates_it() -> None:
    decision = Threshold(facts())
    said = run(decision, (0, 0, 0), (3, 0, 0), (0, 0, 0), (3, 3, 0), (3, 3, 0))
    assert faults(said) == [("fault", ("a",)), ("update", ("a",)), ("update", ("b",))]
    assert "stays latched" in said[2].message
    said = run(decision, (0, 0, 0), (3, 0, 0), start=2.5)
    assert faults(said) == [("update", ("b",))] * 2
    assert "stays latched" in said[0].message and "again" in said[1].message


def test_a_short_peak_and_a_slow_approach_do_not_chatter() -> None:
    decision = Threshold(facts())
    value = np.zeros((1000, 3))
    value[::50, 0] = 9.0
    batch = Batch(value, np.ones_like(value, bool), np.ones_like(value))
    assert faults(decision.update(np.arange(1000) / 1000, batch, value)) == []
    # Around its threshold, within the hysteresis.
    value[:, 0] = 2.0 + 0.4 * np.sin(np.arange(1000) / 30)
    said = decision.update(1.0 + np.arange(1000) / 1000, batch, value)
    assert len(faults(said)) == 1


@pytest.mark.parametrize("step", [3, 77, 1000])
def test_pieces_and_restarts_from_a_state_change_nothing(step: int) -> None:
    rng = np.random.default_rng(2)
    levels = [(0, 0, 0), (0, 0, 0), (3, 0, 0), (3, 3, 0), (0, 0, 0), (0, 0, 3)]
    value = np.repeat(np.array(levels, dtype=float), 500, axis=0)
    value += rng.normal(size=value.shape) * 0.1
    time = np.arange(len(value)) / 1000
    valid, bound = np.ones_like(value, bool), np.full_like(value, 0.1)
    whole = Threshold(facts({})).update(time, Batch(value, valid, bound), value)
    state, said = Threshold(facts({})).state(), []
    for k in range(0, len(value), step):
        one = Threshold(facts({}))
        one.resume(json.loads(json.dumps(state)))
        part = slice(k, k + step)
        said += one.update(time[part], Batch(value[part], valid[part], bound[part]), value[part])
        state = one.state()
    assert [(v.event, v.time, v.group) for v in said] == [(v.event, v.time, v.group) for v in whole]
    assert len(faults(whole)) > 2


def test_a_clock_that_was_put_back_delays_nothing() -> None:
    decision = Threshold(facts())
    assert faults(run(decision, (0, 0, 0), start=1000.0)) == []
    value = np.tile([3.0, 0.0, 0.0], (50, 1))
    batch = Batch(value, np.ones_like(value, bool), np.ones_like(value))
    assert faults(decision.update(1000.5 + np.arange(50) / 1000, batch, value)) == []
    decision.restart()
    said = run(decision, (3, 0, 0), (0, 0, 0), start=7.0)
    assert faults(said) == [("fault", ("a",)), ("update", ("a",))]
    assert [v.time for v in said if v.event != "warm-up"] == pytest.approx([7.1, 7.6], abs=2e-3)


def test_floors_are_learned_from_movement_and_never_from_nothing() -> None:
    decision = Threshold(facts({"r1": 1.0}))
    said = run(decision, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    assert said == []  # what never moved has told nothing of its noise
    rng = np.random.default_rng(1)
    value = rng.normal(size=(1000, 3))
    batch = Batch(value, np.ones_like(value, bool), np.zeros_like(value))
    decision = Threshold(facts({}))
    said = decision.update(np.arange(1000) / 1000, batch, value)
    assert [v.event for v in said] == ["warm-up"] and said[0].time == pytest.approx(0.1)


def test_a_residual_that_is_not_valid_is_told_and_decides_nothing() -> None:
    decision = Threshold(facts())
    run(decision, (0.0, 0.0, 0.0))
    value = np.full((500, 3), 9.0)
    value[:, 2] = 0.0
    valid = np.ones_like(value, bool)
    valid[100:, :2] = False
    value[:100] = 0.0
    said = decision.update(0.5 + np.arange(500) / 1000, Batch(value, valid, value * 0), value)
    assert [(v.event, v.time) for v in said] == [("invalid", 0.6)] * 2
