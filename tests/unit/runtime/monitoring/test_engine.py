"""Residuals over arrays: C and Python alike, in any pieces, with other parameters, after gaps."""

from __future__ import annotations

import math
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bondgraph.backends.runnable import runnable
from bondgraph.compilation import Compilation
from bondgraph.ir.program import Program
from bondgraph.runtime.monitoring.engine import Engine, PythonEngine, setting
from bondgraph.runtime.monitoring.native import Library, NativeEngine, start
from bondgraph.text.source import Source
from tests.unit.backends import programs

_MOTOR = """bg 1
model Motor {
    param R = 2 Ohm +- 5%
    param L = 1 mH
    param k = 0.05 N.m/A
    param J = 1e-4 kg.m^2
    param f = 1e-3 N.m.s/rad
    input U : V
    input on : bool
    1:coil { <- Se:U = if(on, 1, 0)*U; -> I:L; -> R:R; -> Df:i }
    coil -> GY:k -> 1:rotor
    rotor { -> I:J; -> R:f }
    sensor angle : rad = int(rotor.f) counts 1000/turn
}
"""


@cache
def _motor() -> Compilation:
    return Compilation(Source("motor.bg", _MOTOR))


@cache
def _made(native: bool) -> Engine:
    return _motor().engine(native=native)


def _engines() -> list[Engine]:
    return [_made(True).configured(), _made(False).configured()]


def _samples(rows: int, seed: int = 1) -> np.ndarray:
    """U, on, i, angle in counts beyond 32 bits, for the engine of the motor."""
    random = np.random.default_rng(seed)
    by_path = {
        "U": random.normal(6.0, 1.0, rows),
        "on": np.ones(rows),
        "i": random.normal(1.0, 0.1, rows),
        "angle": 2.0**31 - 500 + np.cumsum(random.integers(-3, 40, rows)),
    }
    return np.column_stack([by_path[k.path] for k in _made(False).signals])


def _column(path: str) -> int:
    return [k.path for k in _made(False).signals].index(path)


def _with_defaults(program: Program) -> Program:
    fields = tuple(f._replace(default=f.default or 1.5) for f in program.params)
    return program._replace(params=fields)


@pytest.mark.parametrize("make", programs.ALL, ids=lambda m: m.__name__)
def test_c_and_python_give_the_same_for_every_kind_of_program(make: programs.Maker) -> None:
    made = setting(runnable(_with_defaults(make())))
    random = np.random.default_rng(3)
    samples = random.normal(1.0, 0.4, (400, len(made.signals)))
    for at, known in enumerate(made.signals):
        if known.kind == "mode":
            samples[:, at] = samples[:, at] > 1.0
        elif known.counts is not None:
            samples[:, at] = np.cumsum(random.integers(-5, 9, 400)) - 2.0**31
    for row in (90, 250, 251, 380):
        samples[row, row % max(1, len(made.signals)) :] = (math.nan, math.inf)[row % 2]
    fast = NativeEngine(made, Library(made.programs)).run(samples)
    slow = PythonEngine(made).run(samples)
    np.testing.assert_array_equal(fast.valid, slow.valid)
    np.testing.assert_allclose(fast.value, slow.value, rtol=1e-9, atol=1e-12)
    assert np.all(fast.value[~fast.valid] == 0.0)


def test_bounds_and_values_agree_across_a_counter_that_runs_over() -> None:
    fast, slow = [engine.run(_samples(1500)) for engine in _engines()]
    for ours, other in zip(fast, slow, strict=True):
        np.testing.assert_allclose(ours, other, rtol=1e-9, atol=1e-12)
    assert fast.valid[-1].all() and (fast.bound[-1] > 0).any()


def test_c_and_python_start_anew_alike_where_a_mode_changes() -> None:
    """The momentum of the coil goes on where its core goes, so that its current jumps."""
    text = _MOTOR.replace("-> I:L;", "-> I:L { f = if(on, 1, 2)*p/L };")
    c = Compilation(Source("motor.bg", text))
    engines = [c.engine(native=native) for native in (True, False)]
    assert engines[0].signals == engines[1].signals
    assert [k.path for k in engines[0].signals] == [k.path for k in _made(False).signals]
    samples = _samples(1500)
    samples[1300:, _column("on")] = 0.0
    fast, slow = [engine.run(samples) for engine in engines]
    for ours, other in zip(fast, slow, strict=True):
        np.testing.assert_allclose(ours, other, rtol=1e-9, atol=1e-12)
    assert fast.valid[1299].all() and not fast.valid[1300].all()


@given(st.lists(st.integers(0, 400), max_size=6), st.booleans())
def test_samples_may_come_in_any_pieces(cuts: list[int], bad: bool) -> None:
    samples = _samples(400)
    samples[200, _column("i")] = math.nan if bad else 1.0
    whole = _made(True).configured().run(samples)
    engine = _made(True).configured()
    bounds = [0, *sorted(cuts), 400]
    parts = [engine.run(samples[a:b]) for a, b in pairwise(bounds)]
    for at, array in enumerate(whole):
        np.testing.assert_array_equal(np.concatenate([p[at] for p in parts]), array)


@pytest.mark.parametrize("path", ["angle", "on"])
@pytest.mark.parametrize("native", [True, False])
def test_a_count_or_a_mode_without_value_restarts_what_reads_it(path: str, native: bool) -> None:
    """The rest goes on; what restarts does as if it had begun behind the gap."""
    make = lambda: _made(native).configured()  # noqa: E731
    samples = _samples(1600)
    clean = make().run(samples)
    samples[800, _column(path)] = math.nan
    gap, late = make().run(samples), make().run(samples[801:])
    assert not gap.valid[800].all()
    for at in range(len(make().residuals)):
        reads = not gap.valid[800, at]
        np.testing.assert_array_equal(gap.valid[:800, at], clean.valid[:800, at])
        after = late if reads else clean
        np.testing.assert_array_equal(gap.value[-799:, at], after.value[-799:, at])
        np.testing.assert_array_equal(gap.valid[-799:, at], after.valid[-799:, at])


@pytest.mark.parametrize("native", [True, False])
def test_a_changed_resistance_moves_the_residual_by_the_voltage_it_takes(native: bool) -> None:
    """At rest with current i: U - R i - L di/dt - k w, with R larger by 0.5 Ohm, is -0.5 i."""
    engine = _made(native).configured()
    row = {"U": 6.0, "on": 1.0, "i": 3.0, "angle": 77.0}
    still = np.tile([row[k.path] for k in engine.signals], (2000, 1))
    other = engine.configured({"R": 2.5})
    assert other.parameters["R"] == 2.5 and engine.parameters["R"] == 2.0
    own, moved = engine.run(still), other.run(still)
    size = np.abs(moved.value[-1] - own.value[-1])
    assert np.min(np.abs(size - 0.5 * 3.0)) < 1e-9  # the relation of the coil, in V
    assert np.min(np.abs(own.bound[-1] - 0.05 * 2.0 * 3.0)) < 1e-9  # 5 % of R at 3 A
    with pytest.raises(KeyError):
        engine.configured({"no": 1.0})
    with pytest.raises(ValueError):
        engine.configured({"R": math.nan})
    with pytest.raises(ValueError):
        engine.configured(bandwidth=1e9)


@pytest.mark.parametrize("native", [True, False])
def test_many_engines_over_the_same_samples(native: bool) -> None:
    engine = _made(native).configured()
    values = [1.0 + 0.1 * k for k in range(4)]
    for bounds in (True, False):
        samples = _samples(300)
        fleet = [engine.configured({"R": v}, bounds=bounds) for v in values]
        alone = [engine.configured({"R": v}, bounds=bounds).run(samples) for v in values]
        first = fleet[0].run_with(fleet[1:], samples[:111])
        second = fleet[0].run_with(fleet[1:], samples[111:])
        for at in range(3):
            np.testing.assert_array_equal(
                np.concatenate([first[at], second[at]], axis=1), np.stack([a[at] for a in alone])
            )
        assert bounds or not second.bound.any()
    mixed = engine.configured().run_with([_made(not native).configured()], _samples(200))
    np.testing.assert_allclose(mixed.value[0], mixed.value[1], rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("native", [True, False])
def test_many_engines_each_over_samples_of_its_own(native: bool) -> None:
    engine = _made(native).configured()
    tables = np.stack([_samples(150), _samples(150)[::-1], 2.0 * _samples(150)])
    which = [2, 0, 0, 1]
    values = [1.0, 1.1, 1.2, 1.3]
    for bounds in (True, False):
        fleet = [engine.configured({"R": v}, bounds=bounds) for v in values]
        found = fleet[0].run_with(fleet[1:], tables, which=which)
        for k, (value, table) in enumerate(zip(values, which, strict=True)):
            alone = engine.configured({"R": value}, bounds=bounds).run(tables[table])
            for own, one in zip(found, alone, strict=True):
                np.testing.assert_array_equal(own[k], one)
    with pytest.raises((ValueError, IndexError)):
        engine.configured().run_with([engine.configured()], tables, which=[0, 3])


@pytest.mark.parametrize("native", [True, False])
def test_reset_and_bandwidth_and_warm_up(native: bool) -> None:
    engine = _made(native).configured()
    samples = _samples(1200)
    first = engine.run(samples)
    engine.reset()
    np.testing.assert_array_equal(engine.run(samples).value, first.value)
    quick = engine.configured(bandwidth=2 * engine.bandwidth)
    assert quick.warm_up == pytest.approx(engine.warm_up / 2, abs=engine.sample_time)
    for one in (engine.configured(), quick):
        settled = int(np.argmax(one.run(samples).valid.all(axis=1)))
        assert settled * one.sample_time == pytest.approx(one.warm_up)
    with pytest.raises(ValueError, match="samples of shape"):
        engine.run(samples[:, :2])


@pytest.mark.parametrize("bandwidth", [10.0, 100.0, 300.0])
def test_the_warm_up_is_that_of_what_starts_anew_where_a_switch_turns(bandwidth: float) -> None:
    """With a fast filter it opens in forty samples, whatever the filter needs."""
    text = """bg 1
model Switched {
    input on : bool
    1:coil when on { <- Se:U; -> R:R = 1 Ohm; -> GY:k -> shaft; -> Df:i }
    param k = 3 N.m/A
    1:shaft { -> R:b = 2 N.m.s/rad }
    sensor angle : rad = int(shaft.f)
}
"""
    made = Compilation(Source("switched.bg", text)).with_options(rate=1000.0, bandwidth=bandwidth)
    engine = made.engine()
    assert [o.modes for o in made.program.openings] == [("on",)]
    valid = engine.run(np.tile([[1.0] * len(engine.signals)], (3000, 1))).valid.all(axis=1)
    settled = int(np.argmax(valid))
    assert valid[settled:].all() and settled >= 40
    assert settled * engine.sample_time <= engine.warm_up + 1e-9
    # and what people are told is when all are valid indeed
    pace = bandwidth / 1000.0
    assert settled == math.ceil(max(made.program.waits(pace).values()) / pace - 1e-9)


def test_what_is_unavailable_is_not_waited_for() -> None:
    made, _ = _motor().runnable_programs
    first, second = made.program.residuals
    rows = (first._replace(settle=40.0), second._replace(settle=500.0, unavailable="too long"))
    program = made.program._replace(residuals=rows, rate=1000.0)
    found = setting(made._replace(program=program))._replace(bandwidth=30.0)
    assert found.warm_up == 1.334  # forty time constants of 1/30 s, in whole samples
    both = tuple(r._replace(unavailable="too long") for r in rows)
    nothing = setting(made._replace(program=program._replace(residuals=both, warmup=0.0)))
    assert nothing.warm_up == 0.0


def test_which_signals_a_residual_reads_and_whether_it_has_a_bound() -> None:
    """U - R i - L i' - k w of all signals, k i - J w' - f w of two: by hand, in any order."""
    made, bounds = _motor().runnable_programs
    alone = setting(made)
    names = [k.path for k in alone.signals]
    reads = [{n for n, own in zip(names, row, strict=True) if own} for row in alone.reads()]
    assert sorted(map(sorted, reads)) == [["U", "angle", "i", "on"], ["angle", "i"]]
    assert alone.has_bound == [False, False]
    assert bounds is not None and setting(made, bounds).has_bound == [True, True]


def test_what_laws_received_stands_behind_the_signals() -> None:
    """As the sensor said it, where nothing else is given: with what the sensor is off by."""
    made = setting(_motor().runnable_programs[0])
    signals = tuple(k._replace(offset=10.0 * at) for at, k in enumerate(made.signals))
    samples = np.arange(8.0).reshape(2, 4)
    assert len(signals) == 4 and not made.readings
    np.testing.assert_array_equal(made.table(samples, None), samples)
    reads = made._replace(signals=signals, readings=(3, 1))
    expected = [[0.0, 1.0, 2.0, 3.0, 3.0 + 30.0, 1.0 + 10.0],
                [4.0, 5.0, 6.0, 7.0, 7.0 + 30.0, 5.0 + 10.0]]  # fmt: skip
    np.testing.assert_array_equal(reads.table(samples, None), expected)
    given = reads.table(samples, np.array([[0.5, 0.25], [1.5, 1.25]]))
    np.testing.assert_array_equal(given[:, 4:], [[30.5, 10.25], [31.5, 11.25]])
    for bad in (np.zeros((2, 1)), np.zeros((2, 3))):
        with pytest.raises(ValueError, match="samples of shape"):
            reads.table(samples, bad)


def test_a_model_without_values_says_which_are_missing() -> None:
    program = programs.encoder()
    unset = [f.path for f in program.params if f.default is None]
    assert unset
    with pytest.raises(ValueError, match=unset[0]):
        start(runnable(program), native=False)
