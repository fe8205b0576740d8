"""The smallest change of each fault that would have shown in samples that were taken."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from bondgraph.ir.program import Program
from bondgraph.runtime.diagnosis.hypotheses import Bank, Hypothesis
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.engine import Batch, Engine
from bondgraph.runtime.smallest import Detection, Fault, Situation, faults, noise, told

_BLOCK = 4000  # samples of which all slopes are in memory
_ROUNDING = 1e-10  # of the largest that any fault does: a smaller effect is none


def shown(
    program: Program,
    engine: Engine,
    tolerances: Mapping[str, float],
    situation: Situation,
    logs: Sequence[Array],
) -> Detection:
    """What each residual can show of each fault at the best moment of some samples.

    As `smallest`, but for signals: these are `logs`, of the shape (n, signals of the engine), each
    without a break at the rate of the program. `situation` has what they are like at about, and the
    noise. Raises ValueError if a parameter has no number.
    """
    known = faults(program, tolerances, situation)
    sigma = noise(program, situation)
    own = [f for f in known if f.path in engine.parameters or (f.nominal is None and f.name)]
    hypotheses = [_hypothesis(f, engine, situation) for f in own]
    usual = np.array([h.usual for h in hypotheses])
    slopes = {(f.path, r): [np.zeros(0)] for f in known for r in engine.residuals}
    bounds = {r: [np.zeros(0)] for r in engine.residuals}
    for batch, moved in _runs(engine, hypotheses, known, logs):
        largest = np.abs(moved * usual[:, None]).max(axis=1, initial=0.0)
        for at, name in enumerate(engine.residuals):
            bounds[name].append(batch.bound[:, at])
            for fault in known:
                slopes[fault.path, name].append(np.zeros(len(moved)))
            for k, (fault, one) in enumerate(zip(own, hypotheses, strict=True)):
                slope = np.abs(moved[:, k, at])
                felt = slope * one.usual > _ROUNDING * largest[:, at].max(initial=0.0)
                slopes[fault.path, name][-1] = np.where(felt, slope, 0.0) * _unit(fault, engine)
    return told(
        program,
        known,
        {f.path: {r: np.concatenate(slopes[f.path, r]) for r in bounds} for f in known},
        {r: np.concatenate(found) for r, found in bounds.items()},
        sigma,
        situation.kappa,
    )


def _runs(
    engine: Engine, hypotheses: Sequence[Hypothesis], known: Sequence[Fault], logs: Sequence[Array]
) -> Iterator[tuple[Batch, Array]]:
    """Residuals with thresholds, and the slopes of hypotheses, a block of samples at a time."""
    nominal = {f.path: f.nominal for f in known if f.nominal is not None}
    for log in logs:
        own = engine.configured()
        # Wrong from the first sample on: an encoder counts from there, and shows nothing.
        bank = Bank(engine.configured(bounds=False), hypotheses, nominal, log[0])
        for start in range(0, len(log), _BLOCK):
            part = log[start : start + _BLOCK]
            batch, slopes = own.run(part), bank.run(part)
            yield batch, np.where(batch.valid[:, None, :], np.nan_to_num(slopes), 0.0)


def _hypothesis(fault: Fault, engine: Engine, situation: Situation) -> Hypothesis:
    if fault.nominal is not None:
        return Hypothesis(fault.path, "value", "", abs(fault.nominal) or 1.0, True)
    size = abs(situation.at.get(fault.path, 0.0)) or 1.0
    counted = _unit(fault, engine) != 1.0
    return Hypothesis(fault.path, "offset", "", 1.0 if counted else size, False)


def _unit(fault: Fault, engine: Engine) -> float:
    """Counts in a radian, for what an encoder is wrong by; 1 for everything else."""
    counts = next((k.counts for k in engine.signals if k.path == fault.path), None)
    return 1.0 if counts is None else counts / (2 * math.pi)
