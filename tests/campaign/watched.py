"""A machine of the campaign under watch, without a tuning."""

from __future__ import annotations

import numpy as np

from bondgraph.runtime.diagnosis.tuning import bandwidth_for
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.verdict import Verdict
from tests.campaign.machines import Machine, compiled

_BLOCK = 1000  # samples that the watch gets at a time


def watched(machine: Machine, samples: Array) -> tuple[list[Verdict], float]:
    """All that a watch without a tuning says of samples, and for how long (s) it watched."""
    c = compiled(machine)
    engine = c.engine().configured(bandwidth=bandwidth_for(machine.rate, len(samples)))
    watch, base = c.diagnosis(engine), engine.configured()
    time = np.arange(len(samples)) * engine.sample_time
    said: list[Verdict] = []
    seen = 0
    for k in range(0, len(samples), _BLOCK):
        part = samples[k : k + _BLOCK]
        said += watch.update(time[k : k + _BLOCK], base.run(part), part)
        decided = watch.decided()
        seen += int((decided.valid & np.isfinite(decided.bound)).any(axis=1).sum())
    return said, seen * engine.sample_time
