"""Where a healthy log begins that nobody knows: the start with which least is left of it."""

from __future__ import annotations

import numpy as np

from bondgraph.runtime.diagnosis.healthy import DiagnosisModel
from bondgraph.runtime.diagnosis.parameter_fit import Wanted, fit
from bondgraph.runtime.diagnosis.remembered import from_the_start
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.clock import Piece
from bondgraph.runtime.monitoring.engine import Engine


def started(
    engine: Engine, model: DiagnosisModel, samples: Array, later: bool
) -> tuple[Engine, Array]:
    """The engine as this log begins, and for how many samples each residual counts, (residuals,).

    From where its start is declared or found in the log, see `from_the_start`. Where the log does
    not tell it, residuals that remember it do not count.
    """
    lasts = from_the_start(engine, model.memories, samples, later)
    unknown = [memory for memory in model.memories if memory.unknown]
    if not unknown or later:
        return engine, lasts
    time = engine.sample_time * np.arange(float(len(samples)))
    try:
        found = fit(engine, [("log", Piece(time, samples))], Wanted(()), model.tolerances,
                    model.units, {}, memories=model.memories)  # fmt: skip
        told = {s.name: s.value for s in found.starts if s.error is not None}
    except ValueError:  # too short
        told = {}
    for memory in unknown:
        if not told.keys() >= set(memory.unknown):
            lasts[[engine.residuals.index(r) for r in memory.residuals]] = 0
    return engine.configured(told), lasts
