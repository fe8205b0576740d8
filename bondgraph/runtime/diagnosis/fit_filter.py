"""With which filter logs tell the parameters best: one that is as fast as the machine moves.

By rate and length of a log alone the filter may be far slower than all motion. An oscillator whose
motion is at 400 rad/s leaves next to nothing behind a filter of 20 rad/s, and no parameter is told.
And a law that bends gets filtered signals: what friction does while an axis turns round within a
time constant of the filter is no function of its filtered speed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from bondgraph.runtime.diagnosis.errors_in_variables import Wanted
from bondgraph.runtime.diagnosis.fitted import Fitted, Left
from bondgraph.runtime.diagnosis.healthy import DiagnosisModel
from bondgraph.runtime.diagnosis.parameter_fit import fit
from bondgraph.runtime.diagnosis.tuning import FASTEST
from bondgraph.runtime.monitoring.clock import Piece
from bondgraph.runtime.monitoring.engine import Engine

_FASTER = 4.0  # times the filter before
_LESS = 2.0  # times less that parameters have to be off by with it, in the geometric mean
_HARDLY = 1.1  # the same where noise is not what they are off by


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
    Nor is one taken with which a law is another and less of it is explained: it only hides behind
    noise what is left, and a watch with that filter would alarm.
    """
    own = engine.configured(bandwidth=usual)
    best = fit(own, pieces, free, model, noise, progress)
    while (faster := _FASTER * best.bandwidth) * engine.sample_time <= FASTEST:
        own = engine.configured(bandwidth=faster)
        found = fit(own, pieces, free, model, noise, progress)
        less = _HARDLY if any(x.much for x in best.left) else _LESS
        if _hides(found, best) or not found.spread < best.spread - math.log(less):
            break
        best = found._replace(faster=True)
    return best


def _hides(found: Fitted, before: Fitted) -> bool:
    """Whether a law is another, and a tenth more of it is not explained, noise apart."""
    return any(
        new.wrong and _unexplained(new) > _HARDLY * _unexplained(old)
        for new, old in zip(found.left, before.left, strict=True)
    )


def _unexplained(left: Left) -> float:
    """The share of a mean square at the nominal values that is left, both without noise."""
    before, after = (max(x**2 - left.noise**2, 0.0) for x in (left.before, left.after))
    return after / before if before else 1.0
