"""What residuals are in the position at which a switch is held, next to what they are as told.

With an open brake the relation of a lift is a balance of torques, with a shut one it is a speed.
"""

from __future__ import annotations

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.healthy import tolerated
from bondgraph.runtime.diagnosis.held_positions import Instead, Loudness
from bondgraph.runtime.diagnosis.hypotheses import Bank, hypotheses
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.engine import Engine
from tests.unit.runtime.diagnosis.test_stuck_switch import compiled

_COUNT = 4000


def _samples(engine: Engine, **told: float) -> Array:
    """The same at each sample."""
    return np.array([[told[k.path] for k in engine.signals]]).repeat(_COUNT, axis=0)


def _answer(engine: Engine, run: float) -> float:
    """The root of the sum of squares of what one sample of the speed that is off does to r1."""
    still = _samples(engine, run=run, i=8.0, w=0.5)
    shaken = still.copy()
    shaken[_COUNT // 2, [k.path for k in engine.signals].index("w")] += 1.0
    alone, both = (engine.configured().run(x).value for x in (still, shaken))
    return float(np.sqrt(np.square(both - alone).sum()))


def test_how_loud_the_noise_of_a_sensor_makes_a_residual_in_the_other_position() -> None:
    """By a sample of the speed that is off; of the ratio a factor of three is not used."""
    c = compiled("lift")
    engine, model = c.engine(), c.diagnosis_model
    known = hypotheses(engine, model.faults, model.units, {})
    loud = Loudness(engine, known, model.nominal, _samples(engine, run=1.0, i=8.0, w=0.5))
    ratio = _answer(engine, 1.0) / _answer(engine, 0.0)
    assert ratio > 300.0, "of torques over a speed"
    (on,), (off,) = (loud.beside(model.switches[f"run stuck {x}"]) for x in ("on", "off"))
    assert on == pytest.approx(ratio / 3.0, rel=0.02)
    assert off == pytest.approx(3.0 / ratio, rel=0.02)


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("circuit", {"on": 1.0, "U": 12.0, "i": 0.1, "v": 9.0}),  # volts or amperes, at 2 ohm
        ("buck", {"on": 1.0, "E": 24.0, "i": 2.0, "v": 9.0}),
        ("gears", {"low": 1.0, "T": 2.0, "w1": 1.0, "w2": 1.0}),
    ],
)
def test_where_residuals_are_about_as_loud_in_both_positions_nothing_is_scaled(
    name: str, told: dict[str, float]
) -> None:
    c = compiled(name)
    engine, model = c.engine(), c.diagnosis_model
    known = hypotheses(engine, model.faults, model.units, {})
    loud = Loudness(engine, known, model.nominal, _samples(engine, **told))
    assert len(model.switches) == 2
    for held in model.switches.values():
        assert loud.beside(held).tolist() == [1.0, 1.0]


def test_what_parameters_do_to_a_speed_is_nothing_of_what_they_do_to_a_torque() -> None:
    """The slopes of torque by km, J, b and the load are those of the open brake alone."""
    c = compiled("lift")
    engine, model = c.engine(), c.diagnosis_model
    known = hypotheses(engine, model.faults, model.units, {})
    own, _ = tolerated(known, model)
    assert {h.fault for h in own} == {"km", "J", "b", "G"}
    held = model.switches["run stuck off"]
    samples = _samples(engine, run=1.0, i=8.0, w=0.5)
    loud = Loudness(engine, known, model.nominal, samples).beside(held)
    banks = [Bank(engine.configured(), own, model.nominal) for _ in range(2)]
    last, means, valid, louder = Instead(*banks, held, loud).rows(samples, [1999, 3999], [2000] * 2)
    assert (louder == loud).all() and valid.all()
    # 60*8 - 40*0.5 - 500 as it is told, and 0.5 rad/s as it would be: signs as r1 has them
    torque = Bank(engine.configured(), (), model.nominal).engine.run(samples).value[-1, 0]
    assert abs(torque) == pytest.approx(40.0)
    assert abs(last[-1, 0, 0] + torque) == pytest.approx(0.5)
    np.testing.assert_allclose(last[:, 1:], 0.0, atol=1e-9)
    np.testing.assert_allclose(means[:, 1:], 0.0, atol=1e-9)
    # told the position at which it is held, nothing is scaled and nothing differs
    at_rest = _samples(engine, run=0.0, i=0.0, w=0.0)
    banks = [Bank(engine.configured(), own, model.nominal) for _ in range(2)]
    last, means, _, louder = Instead(*banks, held, loud).rows(at_rest, [1999, 3999], [2000] * 2)
    assert (louder == 1.0).all() and not last.any() and not means.any()
