"""An errand of the motor of models/dc_motor.bg, for tests of what decides about it."""

from __future__ import annotations

import numpy as np

from bondgraph import Course, Fault, Instrument, Scenario


def errand(seconds: float, seed: int, *faults: Fault) -> Scenario:
    """So many seconds (40 at most) of a voltage that swings, with noise on both sensors."""
    time = np.arange(0.0, 40.05, 0.05)
    volts = 6.0 + 2.5 * np.sin(4.4 * time) + 1.2 * np.sin(0.8 * time)
    course = Course(None, tuple(zip(time.tolist(), volts.tolist(), strict=True)))
    return Scenario(
        "errand",
        duration=seconds,
        seed=seed,
        inputs={"U": course, "load": Course.constant(2e-4)},
        instruments={"speed": Instrument(noise=0.5), "current": Instrument(noise=1e-3)},
        faults=faults,
    )
