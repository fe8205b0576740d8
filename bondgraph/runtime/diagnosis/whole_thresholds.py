"""Residuals of a log with the whole of their thresholds, as a monitor that watches it has them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from bondgraph.runtime.diagnosis.doubt import Doubt
from bondgraph.runtime.diagnosis.healthy import DiagnosisModel, slack
from bondgraph.runtime.diagnosis.hypotheses import Bank, Hypothesis
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.engine import Batch, Engine


class WholeThresholds:
    """Beside the residuals, the slopes of what is `known` to be tolerated, and the doubt.

    `walk` is how far residuals that add up readings go in a row, `held` what half a sample of the
    commands makes that is in their noise, (residuals,) each (see `Doubt`). `lasts` is for how many
    samples each residual counts from a start that is known: it is not valid behind them.
    """

    def __init__(
        self,
        engine: Engine,
        model: DiagnosisModel,
        known: Sequence[Hypothesis],
        walk: Array,
        held: Array,
        lasts: Array | None = None,
    ) -> None:
        self.engine, self._known = engine.configured(), known
        self._bank = Bank(engine.configured(bounds=False), known, model.nominal)
        self._doubt = Doubt(engine, model)
        self._walk, self._held, self._age = walk, held, 0
        self._lasts = np.full(len(engine.residuals), np.inf) if lasts is None else lasts

    def run(self, samples: Array) -> tuple[Batch, Array, Array]:
        """Go on with further samples: residuals, slopes (n, known, residuals), doubt."""
        batch, slopes = self.engine.run(samples), self._bank.run(samples)
        doubt, valid = self._doubt.run(samples, batch, self._age, self._walk, self._held)
        valid = valid & (self._age + np.arange(len(samples))[:, None] < self._lasts)
        self.acted = self._doubt.acted.max(axis=0, initial=0.0)
        bound = batch.bound + slack(self._known, slopes) + doubt
        self._age += len(samples)
        return Batch(batch.value, valid, np.where(valid, bound, 0.0)), slopes, doubt
