"""With which filter logs tell the parameters best: one that is as fast as the machine moves.

By rate and length of a log alone the filter may be far slower than all motion. An oscillator whose
motion is at 400 rad/s leaves next to nothing behind a filter of 20 rad/s, and no parameter is told.
And a law that bends gets filtered signals: what friction does while an axis turns round within a
time constant of the filter is no function of its filtered speed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from scipy.special import pdtrc

from bondgraph.runtime.diagnosis.diagnosis import Diagnosis
from bondgraph.runtime.diagnosis.errors_in_variables import Wanted
from bondgraph.runtime.diagnosis.fitted import Fitted
from bondgraph.runtime.diagnosis.healthy import DiagnosisModel
from bondgraph.runtime.diagnosis.healthy_tolerances import less_offsets
from bondgraph.runtime.diagnosis.parameter_fit import fit
from bondgraph.runtime.diagnosis.tuning import FASTEST
from bondgraph.runtime.monitoring.clock import Piece
from bondgraph.runtime.monitoring.engine import Engine

_FASTER = 4.0  # times the filter before
_LESS = 2.0  # times less that parameters have to be off by with it, in the geometric mean
_HARDLY = 1.1  # the same where noise is not what they are off by
_RARE = 0.05  # probability of so many alarms of one an hour
_AT_ONCE = 4096  # samples that are watched at a time


def fit_by_filter(
    engine: Engine,
    pieces: Sequence[tuple[str, Piece]],
    free: Wanted,
    model: DiagnosisModel,
    noise: Mapping[str, float],
    usual: float,
    progress: Callable[[float], None] = lambda _: None,
) -> Fitted:
    """`fit` with a filter of the `usual` bandwidth (rad/s), or with a faster one that tells more.

    Errors are compared by the determinant of their covariance (D-optimal: Wald 1943). A faster
    filter lets more noise through, and is off by more where samples are few in a period of the
    motion: it is taken only for errors of half the size or less. Or of nine tenths, where much more
    than noise is left: that may be what laws make of filtered signals, which noise does not hide.
    None is taken with which a watch would alarm on the very logs: it takes over the filter, and
    what a model leaves out may be less than the noise of these errors, and more than its limits.
    """
    own = engine.configured(bandwidth=usual)
    best = fit(own, pieces, free, model, noise, progress)
    while (faster := _FASTER * best.bandwidth) * engine.sample_time <= FASTEST:
        own = engine.configured(bandwidth=faster)
        found = fit(own, pieces, free, model, noise, progress)
        less = _HARDLY if any(x.much for x in best.left) else _LESS
        if not found.spread < best.spread - math.log(less):
            break
        if _alarms(engine, found, pieces, model):
            break
        best = found._replace(faster=True)
    return best


def _alarms(
    engine: Engine, found: Fitted, pieces: Sequence[tuple[str, Piece]], model: DiagnosisModel
) -> bool:
    """Whether a watch with what was found alarms on the very logs, more than once an hour.

    So many that once an hour would be so many with a probability of 5 % at most (Poisson).
    """
    seconds, alarms, values = 0.0, 0, found.values
    model = model._replace(faults={n: values.get(n, known) for n, known in model.faults.items()})
    for _, piece in less_offsets(found, engine, pieces):
        own = engine.configured(values, bandwidth=found.bandwidth)
        watch, run = Diagnosis(own, model), own.configured()
        for start in range(0, len(piece.samples), _AT_ONCE):
            part = slice(start, start + _AT_ONCE)
            samples = piece.samples[part]
            said = watch.update(piece.time[part], run.run(samples), samples)
            alarms += sum(verdict.event == "fault" for verdict in said)
        seconds += len(piece.samples) * engine.sample_time
    return alarms > 0 and float(pdtrc(alarms - 1, seconds / 3600.0)) < _RARE
