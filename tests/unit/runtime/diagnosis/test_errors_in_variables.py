"""Slopes of parameters that move different residuals are taken at once."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

import bondgraph
from bondgraph import Course, Log, Scenario
from bondgraph.runtime.diagnosis.errors_in_variables import ErrorsInVariables, Wanted, _sandwich
from bondgraph.runtime.diagnosis.residual_rows import ResidualRows
from bondgraph.runtime.monitoring.whole_logs import stretches

ROOT = Path(__file__).parents[4]
MODELS = [
    *(f"models/{name}" for name in ("dc_motor", "two_tanks", "oven", "hydraulic_actuator",
      "quarter_car", "khepera", "cable", "drive", "slider_crank", "rigid_gear")),
    *(f"tests/adversary/models/{name}" for name in ("battery", "boiler", "clutch", "cylinder",
      "gas_tank", "gear_train", "buck_duty", "h_bridge", "three_tanks")),
]  # fmt: skip


@pytest.mark.parametrize("model", MODELS)
def test_no_parameter_moves_a_residual_that_is_said_not_to_read_it(model: str) -> None:
    """Bit by bit, whatever the samples are: what is not read has no part in what is computed."""
    c = bondgraph.compile(ROOT / f"{model}.bg", rate=100.0)
    engine = c.engine(native=False)
    draw = np.random.default_rng(len(model))
    samples = draw.uniform(0.1, 1.0, (40, len(engine.signals)))
    for at, known in enumerate(engine.signals):
        if known.kind == "mode" or known.counts is not None:
            samples[:, at] = np.round(samples[:, at] * 3.0)
    reads = c.diagnosis_model.reads
    assert set(reads) <= set(engine.residuals)
    for name, value in engine.parameters.items():
        moved = engine.configured({name: 1.3 * value or 0.3}, bounds=False)
        one, other = (e.run(samples).value for e in (engine.configured(bounds=False), moved))
        for k, residual in enumerate(engine.residuals):
            if name not in reads.get(residual, (name,)):
                assert np.array_equal(one[:, k], other[:, k], equal_nan=True), (name, residual)


def _tanks(reads: bool) -> tuple[ErrorsInVariables, Sequence[str]]:
    c = bondgraph.compile(ROOT / "models" / "two_tanks.bg", rate=10.0)
    time = np.arange(4002) / 10.0
    inflow = 8e-5 + 3e-5 * np.sin(0.05 * time) + 3e-5 * np.sin(0.21 * time)
    course = Course(None, tuple(zip(time.tolist(), inflow.tolist(), strict=True)))
    log: Log = c.simulate(Scenario("healthy", duration=400.0, inputs={"Q": course})).log
    engine, model = c.engine(), c.diagnosis_model
    pieces = stretches(engine, [("log", log)], None, None)
    noise = [0.01 * float(np.std(log.columns[k.path])) for k in engine.signals]
    names = tuple(n for n, v in model.faults.items() if v is not None and n in engine.parameters)
    runs = ResidualRows(engine, pieces, noise, model.natures, model.memories)
    free = Wanted(names, ("Q",))
    return ErrorsInVariables(runs, free, {}, model.reads if reads else {}), (*names, "Q")


def test_slopes_that_are_taken_at_once_are_those_that_are_taken_one_by_one() -> None:
    together, names = _tanks(reads=True)
    apart, _ = _tanks(reads=False)
    assert len(set(together._colours)) < len(set(apart._colours)) == together.size
    at = np.linspace(-0.1, 0.2, together.size)
    one, other = together._slopes(at), apart._slopes(at)
    for a, b in zip(one, other, strict=True):
        assert np.abs(a - b).max() <= 1e-9 * np.abs(b).max()
    assert one.by.any(axis=(1, 2)).all(), names


def test_what_logs_tell_well_is_as_sure_beside_what_they_do_not_tell() -> None:
    """Of three parameters logs tell ratios, far better than they were known before.

    Along what they do not tell is what was known, across it the scatter over the square of the
    curvature: summed first, rounding made 2800 times as much of it, below zero.
    """
    along = np.full(3, 3**-0.5)
    told = np.eye(3) - np.outer(along, along)
    found = _sandwich(1e9 * told, 1e11 * told, np.full(3, 5.0))
    assert along @ found @ along == pytest.approx(25.0, rel=0.01)
    assert np.linalg.eigvalsh(found)[:2] == pytest.approx([1e11 / 1e18] * 2, rel=0.01)


def test_where_each_term_has_a_parameter_no_common_factor_leaves_less() -> None:
    """m dq/dt + R q |q| = a w with all three smaller: so are the residual and all that noise makes.

    What noise of q moves q |q| by to one side, taken off as a number, made nothing of them.
    """
    text = """bg 1
model P { input w : rad/s; param a = 1e3; param m = 40; param R = 3
  Se:pump = a*w; pump -> 1:s; s -> I:m; s -> R:pipe { e = R*ssq(f) }; s -> Df:q }"""
    c = bondgraph.compile(text=text, rate=20.0)
    time = np.arange(4000) / 20.0
    flow = 4.0 + 2.0 * np.sin(0.5 * time) + 0.5 * np.sin(1.3 * time)
    slope = np.cos(0.5 * time) + 0.65 * np.cos(1.3 * time)
    draw = np.random.default_rng(1)
    columns = {
        "w": (40.0 * slope + 3.0 * flow**2 + 20.0 * np.sin(0.2 * time)) / 1e3,
        "q": flow + 0.5 * draw.standard_normal(len(time)),
    }
    engine, model = c.engine(), c.diagnosis_model
    pieces = stretches(engine, [("log", Log(time, columns, {}, {}))], None, None)
    noise = [0.5 if k.path == "q" else 0.0 for k in engine.signals]
    runs = ResidualRows(engine, pieces, noise, model.natures, model.memories)
    problem = ErrorsInVariables(runs, Wanted(("a", "m", "R")), {}, model.reads)
    problem.weigh(np.zeros(problem.size))
    late = np.zeros(len(runs.late))
    one = problem.cost(late, problem.nominal.tolist())
    for factor in (0.5, 0.1, 1e-3):
        cost = problem.cost(late, (factor * problem.nominal).tolist())
        assert cost == pytest.approx(one, rel=1e-6)
