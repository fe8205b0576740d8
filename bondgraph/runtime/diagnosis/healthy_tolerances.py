"""How narrow tolerances may be: healthy logs have to stay below the thresholds that they make.

A tolerance that is declared covers more than parameters: what a model leaves out is under its
thresholds too. Where a fit makes it narrower, as much of it stays as the logs need for that.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from bondgraph.runtime.diagnosis.fitted import Fitted
from bondgraph.runtime.diagnosis.healthy import DiagnosisModel
from bondgraph.runtime.diagnosis.remembered import Memory, counted
from bondgraph.runtime.diagnosis.tuning import kappa
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.clock import Piece
from bondgraph.runtime.monitoring.engine import Batch, Engine

_CHANCE = 0.05  # that noise alone is beyond what is taken off for it, once in all logs


def with_room(
    found: Fitted,
    engine: Engine,
    pieces: Sequence[tuple[str, Piece]],
    model: DiagnosisModel,
    bandwidths: Iterable[float],
) -> Fitted:
    """A fit whose tolerances leave room for all that its healthy logs have in the residuals.

    Those that the `model` declares are what thresholds of the `engine` are of. With each of the
    filters (rad/s) the residuals at what was fitted are compared with these thresholds: a tolerance
    is no smaller than the largest share of them that any residual with this parameter needed, less
    what the noise of sensors explains.
    """
    if not found.tolerances:
        return found
    share, logs = np.zeros(len(engine.residuals)), less_offsets(found, engine, pieces)
    for bandwidth in sorted(set(bandwidths)):
        own = engine.configured(found.values, bandwidth=bandwidth)
        share = np.maximum(share, _needed(own, found, logs, model.memories))
    needed: dict[str, float] = {}
    for k, name in enumerate(engine.residuals):
        for fault in model.sees.get(name, ()):
            needed[fault] = max(float(share[k]), needed.get(fault, 0.0))
    parameters = []
    for one in found.parameters:
        before = model.tolerances.get(one.name, 0.0)
        least = needed.get(one.name, 0.0) * before
        tolerance = None if one.tolerance is None else narrower(max(one.tolerance, least), before)
        parameters.append(one._replace(tolerance=tolerance))
    return found._replace(parameters=tuple(parameters))


def narrower(tolerance: float, declared: float) -> float | None:
    """A tolerance in two digits, rounded up, if it is less than what is declared.

    >>> narrower(0.01234, 0.2), narrower(0.3, 0.2)
    (0.013, None)
    """
    if not 0.0 < tolerance < min(declared, 1.0):
        return None
    digit = 10.0 ** (math.floor(math.log10(tolerance)) - 1)
    return float(f"{math.ceil(tolerance / digit * (1.0 - 1e-9)) * digit:.3g}")


def less_offsets(
    found: Fitted, engine: Engine, pieces: Sequence[tuple[str, Piece]]
) -> list[tuple[str, Piece]]:
    """The samples without the offsets that were fitted."""
    off = found.offset_values
    more = np.array([off.get(k.path, k.offset) - k.offset for k in engine.signals])
    return [(name, piece._replace(samples=piece.samples - more)) for name, piece in pieces]


def _needed(
    engine: Engine,
    found: Fitted,
    logs: Sequence[tuple[str, Piece]],
    memories: Sequence[Memory],
) -> Array:
    """The largest share of its threshold that each residual needed, infinite without any.

    What the noise of the sensors makes is measured: it comes on top once more.
    """
    draw = np.random.default_rng(1)
    deviation = np.array([found.noise.get(k.path, 0.0) for k in engine.signals])
    parts: list[tuple[Array, Array, Array]] = []
    for name, piece in logs:
        samples, told = piece.samples, found.begun(name, float(piece.time[0]))
        louder = samples + deviation * draw.standard_normal(samples.shape)
        fitted = engine.configured(told)
        twice = [_run(fitted, own) for own in (samples, louder)]
        known = counted(engine, memories, samples, bool(piece.anew), told)
        valid = twice[0].valid & twice[1].valid & (np.arange(len(samples))[:, None] < known)
        value, more = (np.where(valid, one.value, math.nan) for one in twice)
        parts.append((value, more - value, twice[0].bound))
    value, added, bound = (np.concatenate(own) for own in zip(*parts, strict=True))
    return np.array([
        _share(value[good, k], added[good, k], bound[good, k], engine)
        for k, good in enumerate(np.isfinite(value).T)
    ])  # fmt: skip


def _run(engine: Engine, samples: Array) -> Batch:
    engine.reset()
    return engine.run(samples)


def _share(value: Array, added: Array, bound: Array, engine: Engine) -> float:
    """The largest share of the threshold that one residual needed, less what noise explains."""
    if not len(value):
        return 0.0
    seconds = len(value) * engine.sample_time
    turns = max(int(np.count_nonzero(np.diff(np.signbit(added)))), 1)
    level = kappa(turns / 2.0 / seconds, _CHANCE / seconds)
    beyond = np.abs(value) - level * float(np.sqrt(np.mean(added**2)))
    out = beyond > 0.0
    with np.errstate(divide="ignore"):
        return float(np.max(beyond[out] / bound[out], initial=0.0))
