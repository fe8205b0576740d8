"""Parameters of a machine from logs of it while it was healthy, with how sure they are.

The residuals are the model: with the right parameters nothing is left of them but what the noise
of the sensors makes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from difflib import get_close_matches
from functools import partial

import numpy as np

from bondgraph.ir.groups import Groups
from bondgraph.runtime.diagnosis.errors_in_variables import (
    LATEST,
    WIDE,
    ErrorsInVariables,
    Wanted,
)
from bondgraph.runtime.diagnosis.fitted import SURE, Delay, Fitted, Fitting, Start
from bondgraph.runtime.diagnosis.healthy import DiagnosisModel
from bondgraph.runtime.diagnosis.residual_rows import ResidualRows
from bondgraph.runtime.diagnosis.told_combinations import combinations, untold
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.clock import Piece
from bondgraph.runtime.monitoring.engine import Engine

_FIRST = 2  # rounds with all rows: by what the declared parameters leave, no delay is known yet
_ROUNDS = 5  # of weights from what is left, and parameters from weights
_STEPS = 15  # of a round: what is left to go, along what nothing tells, the next one goes
_ASKED = 3  # times that it is asked what nothing tells
_TOLD = 0.3  # deviation below which a parameter is told, relative to its value
_LEAST = 3.0  # times what no log tells over what the logs do: with less they tell next to nothing
_FLOOR = 1e-9  # of the variance before any log: no covariance is taken for less
_AT_BOUND = 0.99  # of that: no more is fitted, and it may be more
_SILENT = 1e-6  # of the size of a signal: the least noise that is reckoned with


def fit(
    engine: Engine,
    pieces: Sequence[tuple[str, Piece]],
    free: Wanted,
    model: DiagnosisModel,
    noise: Mapping[str, float],
    progress: Callable[[float], None] = lambda _: None,
) -> Fitted:
    """Fit what is `free` of an engine to pieces of healthy logs, by the names of these.

    The tolerances of the `model` say where parameters are looked for that no log tells, and bound
    nothing. `noise` are standard deviations of signals that are known, in their unit; of other
    sensors it is estimated, inputs are exact. A residual that keeps something of its first sample
    counts up to the first gap of a log. Raises ValueError where the logs are too short.
    """
    tolerances, units = model.tolerances, model.units
    seen = {**estimated_noise(engine, [p.samples for _, p in pieces]), **noise}
    deviations = [seen[k.path] for k in engine.signals]
    runs = ResidualRows(engine, pieces, deviations, model.natures, model.memories)
    problem = ErrorsInVariables(runs, free, tolerances, model.reads, model.signs)
    at = _solved(problem, np.zeros(problem.size), progress)
    if delayed := problem.delayed(at):
        fitted = len(problem.names)
        late = dict(zip(runs.late, at[fitted:].tolist(), strict=True))
        runs.late = sorted({*runs.late, *delayed})
        problem = ErrorsInVariables(runs, free, tolerances, model.reads, model.signs)
        at = np.append(at[:fitted], [late.get(k, 0.0) for k in runs.late])
        at = _solved(problem, at, lambda _: None)  # what is told goes on, not back
    names = problem.names
    count = len(names)
    at, whole, null, small, more = _declared(problem, at)
    covariance = whole[:count, :count]
    bound = problem.bound(at)
    left = problem.left(at)
    spread = _spread(covariance)
    if any(x.much for x in left):
        may, has = problem.disturbed(at, [x.much for x in left])
        spread = _spread(covariance + has)
        covariance = covariance + may
    deviation = np.sqrt(np.maximum(np.diag(covariance), 0.0))  # rounding
    told = (deviation < _TOLD * problem.sizes(at)) & ~bound[:count] & ~null.any(axis=0) & ~small
    sound = problem.sound(at, [x.wrong for x in left])
    values = problem.values(at).tolist()
    further = problem.scale * np.hypot(problem.apart(at), SURE * deviation)
    own = tuple(
        Fitting(
            name, float(problem.nominal[k]), values[k],
            float(problem.scale[k] * deviation[k]) if told[k] and sound[k] else None,
            units.get(name, ""), bool(bound[k]), bool(told[k] and not sound[k]),
            float(further[k] / abs(values[k])) if told[k] and values[k]
            and further[k] < abs(values[k]) * tolerances.get(name, 0.0) else None,
        )
        for k, name in enumerate(names)
    )  # fmt: skip
    called = [*names[: count - len(free.offsets)], *(f"offset of {n}" for n in free.offsets)]
    zeros = np.where(problem.zeros, problem.scale, 0.0)
    null = np.vstack([null, np.eye(count)[small & ~bound[:count]]])
    found = combinations(
        called, values, problem.scale, zeros, null, partial(problem.cost, at[count:]), more
    )  # fmt: skip
    found = tuple(
        c if c.more is not None else c._replace(still=_still(runs, model, c.parameters))
        for c in found
    )
    suspects = problem.suspects(at, units)
    progress(1.0)
    apart = np.where(deviation > 0, deviation, 1.0)
    split, rest = len(free.parameters), len(free.parameters) + len(runs.starts)
    starts = tuple(
        Start(
            name, *runs.begins[piece], runs.later[piece], one.value, one.error, units.get(name, "")
        )
        for (name, piece), one in zip(runs.starts.values(), own[split:rest], strict=True)
    )
    return Fitted(
        own[:split], starts, own[rest:], suspects, found, left,
        _delays(runs, model, at[count:], whole[count:, count:]), seen, runs.seconds,
        covariance / np.outer(apart, apart), problem.terms(at), engine.bandwidth,
        spread, len({name for name, _ in pieces}),
    )  # fmt: skip


def _solved(problem: ErrorsInVariables, at: Array, progress: Callable[[float], None]) -> Array:
    """Weights from what is left, and parameters from weights, some times.

    The first rounds weigh by what is left where parameters may be far from the truth, which may
    lead to where some are nearly nothing, and from there no round leads back. So the first one that
    weighs by the noise begins as declared as well.
    """
    for k in range(_ROUNDS):
        problem.weigh(at, first=k < _FIRST)
        declared = np.append(np.zeros(len(problem.names)), at[len(problem.names) :])
        starts = [at, declared] if k == _FIRST else [at]
        at = problem.best([problem.solve(start, _STEPS) for start in starts])
        progress((k + 1) / (_ROUNDS + 1))
    return at


def _declared(
    problem: ErrorsInVariables, at: Array
) -> tuple[Array, Array, Array, Mask, Callable[[Sequence[int]], float | None]]:
    """Where what nothing tells stays as it is declared, the covariance there, what that is, which
    are too small to be told, and how much more motion would tell any of them.

    A fit goes anywhere along what nothing tells: there a valve may be open all the time, and one
    that the logs do tell of seems not to be told. So it is asked again where that is as declared.
    One that is told there, and only there, stays as declared: the logs tell that it is elsewhere,
    and there they do not tell where. What is smaller than declared may be less sure than it is
    large, but how far it is from there is told: it stays where it is.
    """
    count = len(problem.names)
    null = np.zeros((0, count))
    for _ in range(_ASKED):
        whole = problem.covariance(at)
        asked, sizes = whole[:count, :count], problem.sizes(at)
        large = np.maximum(sizes, 1.0)
        own = untold(asked / np.outer(large, large), _TOLD**2) * large
        if own.shape == null.shape and ((own != 0) == (null != 0)).all():
            break
        null = own
        problem.pin(null)
        at = problem.solve(at)
        problem.weigh(at)
        at = problem.solve(at)
    else:
        whole = problem.covariance(at)
    sizes = np.where(null.any(axis=0), large, sizes)
    small = (np.diag(asked) >= (_TOLD * sizes) ** 2) & ~null.any(axis=0)
    more = partial(_more, asked / np.outer(sizes, sizes), problem.before / sizes)
    return at, whole, null, small, more


def _delays(
    runs: ResidualRows, model: DiagnosisModel, late: Array, covariance: Array
) -> tuple[Delay, ...]:
    """The delays that were fitted, in s, of signals that were `late` by so many samples (n,).

    Where all that moves in some residuals is late, only differences are known: with all signals
    later by the same the residuals are the same later.
    """
    names, still = runs.names(runs.late), runs.still()
    moving = [k.path for k in runs.engine.signals if k.path not in still]
    joined = Groups[str]()
    for residual in runs.engine.residuals:
        read = {*model.sees.get(residual, moving), *model.natures[residual].modes}
        own = [name for name in moving if name in read]
        for name in own[1:]:
            joined.join(own[0], name)
    groups = [
        [names.index(n) for n in group]
        for group in joined.among(moving) if len(group) > 1 and set(group) <= set(names)
    ]  # fmt: skip
    value, error = _beside(late, covariance, groups)
    bound, time = np.abs(late) > _AT_BOUND * LATEST, runs.engine.sample_time
    return tuple(
        Delay(name, float(value[k]) * time, float(error[k]) * time, bool(bound[k] and error[k] > 0))
        for k, name in enumerate(names)
    )


def _beside(late: Array, covariance: Array, groups: Sequence[Sequence[int]]) -> tuple[Array, Array]:
    """Delays (n,) and their deviations, in each of some `groups` beside one of its signals.

    Beside that by which they are least in all: signals that need none. Of two such, beside the one
    that the fit moved less.

    >>> value, error = _beside(np.array([1.3, 0.3, 0.35, 0.5]), np.eye(4) / 100, [[0, 1, 2]])
    >>> value.round(2).tolist(), error.round(2).tolist()
    ([0.95, -0.05, 0.0, 0.5], [0.14, 0.14, 0.0, 0.1])
    """
    beside = np.eye(len(late))
    for group in groups:
        own = late[group]
        total = np.abs(own[:, None] - own).sum(axis=0).round(6)
        best = group[int(np.lexsort((np.abs(own), total))[0])]
        beside[group, best] -= 1.0
    variance = np.diag(beside @ covariance @ beside.T)
    return beside @ late, np.sqrt(np.maximum(variance, 0.0))


def _spread(covariance: Array) -> float:
    """The logarithm of the deviations by a covariance (p, p), in the mean of its axes.

    An axis of which only rounding is left, beside one that nothing tells, tells no more than that.
    """
    values = np.linalg.eigvalsh(covariance)
    least = len(values) * np.finfo(float).eps * values[-1]
    return float(np.log(np.maximum(values, least)).mean() / 2.0)


def _more(covariance: Array, before: Array, own: Sequence[int]) -> float | None:
    """How many times the motion would tell these parameters; None if nothing tells of them now.

    The logs tell what the `covariance` (p, p) says beyond the deviations `before` them (p,), which
    are those of tolerances. What they tell grows with the square of the motion.
    """
    known = before[own] ** -2.0
    after = covariance[np.ix_(own, own)]
    least = np.sqrt(known + (_LEAST / WIDE) ** 2)  # one over deviations that next to nothing leaves
    if np.linalg.eigvalsh(after * np.outer(least, least))[-1] > 1.0:
        return None  # asked before anything is inverted: what nothing tells has no inverse
    after += _FLOOR * np.diag(before[own] ** 2)
    values, vectors = np.linalg.eigh(np.linalg.inv(after) - np.diag(known))
    alike = vectors / np.sqrt(values)  # in which the logs tell as much of each
    wanted = np.eye(len(own)) / _TOLD**2 - np.diag(known)
    return math.sqrt(float(np.linalg.eigvalsh(alike.T @ wanted @ alike)[-1]))


def _still(
    runs: ResidualRows, model: DiagnosisModel, parameters: Sequence[str]
) -> tuple[str, ...]:
    """The inputs and switches that never move in the logs, beside which parameters are read."""
    beside: set[str] = set()
    for name in runs.engine.residuals:
        if not model.reads.get(name, frozenset()).isdisjoint(parameters):
            beside |= {*model.sees.get(name, ()), *model.natures[name].modes}
    return tuple(name for name in runs.still() if name in beside)


def fittable(
    engine: Engine,
    faults: Mapping[str, float | None],
    tolerances: Mapping[str, float],
    wanted: Sequence[str] | None = None,
) -> Wanted:
    """What to fit: what is `wanted`, else the parameters with a tolerance, else all parameters.

    Of those that some residual sees: `faults` with their nominal values. The name of a sensor or an
    input stands for its offset. Raises ValueError for another name, and where there is none.
    """
    names = [n for n, v in faults.items() if v is not None and n in engine.parameters]
    signals = {k.path: k for k in engine.signals if k.kind in ("input", "sensor")}
    for name in wanted or ():
        if name not in names and name in signals:
            if signals[name].counts is not None:
                raise ValueError(
                    f"{name} counts from where it stood at the start: it has no offset to be fitted"
                )
        elif name not in names and name in engine.parameters and name not in faults:
            do = "leave it out" if tolerances.get(name) else "say what it is in these logs (--set)"
            raise ValueError(
                f"{name} is used by no law, but for where something begins or for other numbers:"
                f" {do}; a start that has a tolerance in the model is found for each log by itself"
            )
        elif name not in names:
            close = get_close_matches(name, [*names, *signals], 3, 0.5)
            there = f"there is {', '.join(names)}" if names else "there is none"
            hint = f"perhaps {' or '.join(close)}" if close else there
            raise ValueError(f"no residual sees a parameter `{name}` with a number; {hint}")
    free = list(dict.fromkeys(wanted or [n for n in names if n in tolerances] or names))
    if not free:
        raise ValueError(
            "no residual sees a parameter with a number: give one to a parameter of a law that"
            " sensors see (`bondgraph compile` prints the residuals)"
        )
    return Wanted(
        tuple(n for n in free if n in names), tuple(n for n in free if n not in names)
    )


def estimated_noise(engine: Engine, pieces: Sequence[Array]) -> dict[str, float]:
    """The standard deviation of white noise in each signal, by path; 0 for inputs and modes.

    From differences of high order, in which what a machine does is small beside noise: the median
    of their absolute values, the least of several orders. Encoders have at least that of a count,
    in counts.

    >>> from bondgraph import compile
    >>> engine = compile("models/dc_motor.bg").engine(native=False)
    >>> draw, t = np.random.default_rng(1), np.arange(20_000) / 1000
    >>> samples = np.zeros((20_000, 4))
    >>> samples[:, 2] = np.sin(6 * t) + 0.05 * draw.standard_normal(20_000)
    >>> round(estimated_noise(engine, [samples])["current"], 3)
    0.05
    """
    found = {}
    for at, known in enumerate(engine.signals):
        found[known.path] = 0.0
        if known.kind == "sensor":
            squares = [np.nanmean(p[:, at] ** 2) for p in pieces if len(p)]
            size = math.sqrt(np.mean(squares)) if squares else 0.0
            orders = [_rough([np.diff(p[:, at], k) for p in pieces], k) for k in range(2, 8)]
            least = math.sqrt(1 / 12) if known.counts is not None else _SILENT * size
            found[known.path] = max(min(orders), least)
    return found


def _rough(differences: Sequence[Array], order: int) -> float:
    whole = np.concatenate([np.empty(0), *differences])
    whole = np.abs(whole[np.isfinite(whole)])
    middle = float(np.median(whole)) if len(whole) else 0.0
    return middle / 0.6745 / math.sqrt(math.comb(2 * order, order))
