"""Where a healthy log begins that nobody knows: the start with which least is left of it."""

from __future__ import annotations

import numpy as np

from bondgraph.runtime.diagnosis.errors_in_variables import Wanted
from bondgraph.runtime.diagnosis.healthy import DiagnosisModel
from bondgraph.runtime.diagnosis.parameter_fit import fit
from bondgraph.runtime.diagnosis.remembered import counted, unknown_starts
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.clock import Piece
from bondgraph.runtime.monitoring.engine import Engine


def started(
    engine: Engine, model: DiagnosisModel, samples: Array, later: bool
) -> tuple[Engine, Array]:
    """The engine as these samples begin, and for how many each residual counts, (residuals,).

    From a start that is declared or that they tell, of the first or `later` ones of a log: see
    `from_the_start`. Where they do not tell it, residuals that remember it do not count.
    """
    wanted = unknown_starts(model.memories, later)
    told: dict[str, float] = {}
    if wanted:
        time = engine.sample_time * np.arange(float(len(samples)))
        piece = Piece(time, samples, "later" if later else "")
        try:
            found = fit(engine, [("log", piece)], Wanted(()), model, {})
            told = found.begun("log", 0.0)
        except ValueError:  # too short
            told = {}
    return engine.configured(told), counted(engine, model.memories, samples, later, told)
