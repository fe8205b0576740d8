"""The smallest change of each fault that a residual shows, for stated signals and noise."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import solve_discrete_lyapunov

from bondgraph.ir.program import Known, Program
from bondgraph.runtime.batch import Lanes
from bondgraph.runtime.log import Array

_STEP = 1e-4  # relative size of the change that a sensitivity is taken from
_ROUNDING = 1e-13  # of the largest number in a filter: a smaller change of its output is none
_MOST = 20_000  # samples of one period of the signals


class Situation(NamedTuple):
    """What the machine does and how well it is measured; all by path of the known signal.

    Each signal is `at` + `swing` sin(2 pi `frequency` t), in its unit; that of an encoder turns at
    `at` rad/s and swings by so many rad. `noise` is the standard deviation of a sample, white, in
    the unit of the signal. `kappa` standard deviations of the residual are kept free.
    """

    at: Mapping[str, float] = {}
    swing: Mapping[str, float] = {}
    noise: Mapping[str, float] = {}
    frequency: float = 1.0
    kappa: float = 5.0


class Smallest(NamedTuple):
    """The smallest sure change of a fault in a residual, None with the reason why there is none.

    `change` in the unit of the fault, `relative` to its nominal value (None for signals).
    `sensitivity` is the filtered change of the residual for a unit of the fault where it is shown
    best, `threshold` a(t) there.
    """

    fault: str
    residual: str
    change: float | None
    relative: float | None
    sensitivity: float
    threshold: float
    reason: str


class Detection(NamedTuple):
    """The noise of each filtered residual (None where it grows for ever), and every fault.

    `undefined` are the residuals that have no value at these signals; their noise is None too.
    """

    sigma: dict[str, float | None]
    smallest: tuple[Smallest, ...]
    undefined: tuple[str, ...] = ()


class Fault(NamedTuple):
    """Something that may be wrong, as the program has it; `step` is what it is moved by."""

    path: str
    name: str
    nominal: float | None  # None for a signal
    step: float
    tolerance: float


def smallest(
    program: Program,
    thresholds: Program | None,
    tolerances: Mapping[str, float],
    situation: Situation,
) -> Detection:
    """What each residual can show of each fault that it sees.

    `program` has what laws received as signals of their own
    (`Compilation.program_with_readings`): an error or the noise of a sensor is in what it
    measures, and a law acted on just what it received.

    A change d of a fault is sure to be seen where s d, with s = dr/dfault through the filter, is
    above the threshold a + kappa sigma even if all other parameters work against it with a minus
    the share of the fault itself: d = (2 a - own + kappa sigma)/|s|, at the best moment of the
    signals. `tolerances` are relative, by path. `sigma` is the standard deviation of the realised
    step, X = A X A' + B B' (discrete Lyapunov equation), linearised at the first sample.
    Raises ValueError if a parameter has no number.
    """
    need_numbers(program)
    if not program.residuals:
        return Detection({}, ())
    known = faults(program, tolerances, situation)
    moved = sensitivities(program, known, situation)
    bound: dict[str, Array] = {}
    if thresholds is not None:
        bound = {n: r[:, 0] for n, r in _simulated(thresholds, {}, {}, 1, situation)[0].items()}
    sigma = noise(program, situation)
    return told(program, known, moved, bound, sigma, situation.kappa)


def need_numbers(program: Program) -> None:
    """Raises ValueError if a parameter has no number."""
    missing = [f.path for f in program.params if f.default is None]
    if missing:
        raise ValueError(f"{missing[0]} has no value in the model")


def told(
    program: Program,
    known: list[Fault],
    moved: Mapping[str, Mapping[str, Array]],
    bound: Mapping[str, Array],
    sigma: Mapping[str, float | None],
    kappa: float,
) -> Detection:
    """From sensitivities and thresholds at some samples, by fault and residual; see `smallest`."""
    undefined = [i for i in program.residuals if i.name not in sigma]
    rows = []
    for fault in known:
        for info in program.residuals:
            if fault.path not in info.faults:
                continue
            base = (fault.path, info.path)
            if info.unavailable or fault.path in info.invisible:
                why = info.unavailable or f"not visible at {program.rate:g} samples a second"
                rows.append(Smallest(*base, None, None, 0.0, 0.0, why))
                continue
            if info in undefined:
                rows.append(Smallest(*base, None, None, 0.0, 0.0, "no value at these signals"))
                continue
            slope = np.abs(moved[fault.path][info.name])
            a = bound.get(info.name, np.zeros(len(slope)))
            rows.append(_row(base, fault, slope, a, sigma[info.name], kappa))
    own = {i.path: sigma.get(i.name) for i in program.residuals}
    return Detection(own, tuple(rows), tuple(i.path for i in undefined))


def _row(
    base: tuple[str, str],
    fault: Fault,
    slope: Array,
    a: Array,
    sigma: float | None,
    kappa: float,
) -> Smallest:
    visible = slope > 0
    if not visible.any():
        return Smallest(*base, None, None, 0.0, float(a[-1]), "not moved by these signals")
    if sigma is None:
        at = int(np.argmax(slope))
        why = "the residual integrates the noise"
        return Smallest(*base, None, None, float(slope[at]), float(a[at]), why)
    own = np.minimum(fault.tolerance * abs(fault.nominal or 0.0) * slope, a)
    with np.errstate(divide="ignore"):
        change = np.where(visible, (2 * a - own + kappa * sigma) / slope, np.inf)
    at = int(np.argmin(change))
    least = float(change[at])
    relative = least / abs(fault.nominal) if fault.nominal else None
    return Smallest(*base, least, relative, float(slope[at]), float(a[at]), "")


def faults(program: Program, tolerances: Mapping[str, float], situation: Situation) -> list[Fault]:
    """The faults of all residuals that the code knows, in the order of the residuals."""
    params = {f.path: f for f in program.params}
    knowns = {k.path: k for k in program.knowns if k.kind != "reading"}
    found = []
    for path in dict.fromkeys(f for r in program.residuals for f in r.faults):
        if path in params:
            value = float(params[path].default or 0.0)
            step = _STEP * (abs(value) or 1.0)
            found.append(Fault(path, params[path].name, value, step, tolerances.get(path, 0.0)))
        elif path in knowns:
            size = abs(situation.at.get(path, 0.0)) + abs(situation.swing.get(path, 0.0))
            found.append(Fault(path, knowns[path].name, None, _STEP * (size or 1.0), 0.0))
        else:  # only in what step leaves out
            found.append(Fault(path, "", None, _STEP, 0.0))
    return found


def sensitivities(
    program: Program, faults: list[Fault], situation: Situation
) -> dict[str, dict[str, Array]]:
    """Per fault and residual the sensitivity at each valid sample, 0 where it is rounding."""
    runs = 2 * len(faults)
    params: dict[str, Array] = {}
    signals: dict[str, Array] = {}
    known = {k.name for k in program.knowns}
    for k, fault in enumerate(faults):
        if not fault.name:
            continue
        shift = np.zeros(runs)
        shift[2 * k], shift[2 * k + 1] = fault.step, -fault.step
        into = signals if fault.nominal is None and fault.name in known else params
        into[fault.name] = shift if into is signals else shift + float(fault.nominal or 0.0)
    result, sizes = _simulated(program, params, signals, runs, situation)
    found: dict[str, dict[str, Array]] = {}
    for k, fault in enumerate(faults):
        own = found[fault.path] = {}
        for name, r in result.items():
            with np.errstate(invalid="ignore"):  # of a residual without a value
                change = r[:, 2 * k] - r[:, 2 * k + 1]
            felt = np.abs(change) > _ROUNDING * max(sizes[name][2 * k : 2 * k + 2])
            own[name] = np.where(felt, change / (2 * fault.step), 0.0)
    return found


def _simulated(
    program: Program,
    params: Mapping[str, Array],
    errors: Mapping[str, Array],
    runs: int,
    situation: Situation,
) -> tuple[dict[str, Array], dict[str, Array]]:
    """The residuals, samples by runs, from when they are valid over one period of the signals.

    Besides, by run, the largest number in the filter of each. An error of a signal is there from
    the start; that of a position too.
    """
    run = Lanes(program, dict(params))
    settled = math.ceil(program.warmup / program.bandwidth * program.rate) + 1
    moving = any(situation.swing.values())
    period = math.ceil(program.rate / situation.frequency) if moving else 1
    total = settled + min(period, _MOST)
    rows: dict[str, list[Array]] = {r.name: [] for r in program.residuals}
    sizes = {r.name: np.zeros(runs) for r in program.residuals}
    own = {r.name: [s.name for s in program.states if s.name.startswith(f"{r.name}_")]
           for r in program.residuals}  # fmt: skip
    states: dict[str, Any] | None = None
    before: dict[str, float] = {}
    for k in range(total):
        t = k / program.rate
        signals: dict[str, Any] = {}
        increments: dict[str, Any] = {}
        totals: dict[str, Any] = {}
        for known in program.knowns:
            if known.kind == "mode":
                continue
            value = _signal(known, t, situation)
            error = errors.get(known.name, 0.0)
            if known.counts is None:
                signals[known.name] = value + error
            else:
                turn = known.counts / (2 * math.pi)
                start = _signal(known, 0.0, situation)
                increments[known.name] = (value - before.get(known.name, value)) * turn
                totals[known.name] = (value - start + error) * turn
                before[known.name] = value
        modes = {m.name: situation.at.get(m.path, 1.0) != 0 for m in program.knowns
                 if m.kind == "mode"}  # fmt: skip
        residuals, states = run.sample(signals, increments, totals, modes, states)
        if k >= settled:
            for name, value in residuals.items():
                rows[name].append(np.broadcast_to(np.asarray(value, dtype=float), (runs,)))
                for state in own[name]:
                    sizes[name] = np.maximum(sizes[name], np.abs(states[state]))
    return {name: np.array(r) for name, r in rows.items()}, sizes


def _signal(known: Known, t: float, situation: Situation) -> float:
    at, swing = situation.at.get(known.path, 0.0), situation.swing.get(known.path, 0.0)
    base = at if known.counts is None else at * t
    return base + swing * math.sin(2 * math.pi * situation.frequency * t)


def noise(program: Program, situation: Situation) -> dict[str, float | None]:
    """The standard deviation of each filtered residual for white noise of the samples.

    Each sample of a signal has the noise of `situation`; an encoder besides that of its counts,
    evenly spread over one count. None where the residual integrates noise, and so never settles;
    left out where it has no value at these signals.
    """
    with np.errstate(all="ignore"):
        a, b, c, d = linear(program, situation)
    found: dict[str, float | None] = {}
    for k, info in enumerate(program.residuals):
        used = reached(c[k] != 0, a)
        used &= reached((b != 0).any(axis=1), a.T)
        own = a[np.ix_(used, used)]
        if info.unavailable:
            found[info.name] = None
        elif not all(np.isfinite(m).all() for m in (own, b[used], c[k], d[k])):
            continue
        elif not used.any():
            found[info.name] = float(np.sqrt(np.sum(d[k] ** 2)))
        elif np.max(np.abs(np.linalg.eigvals(own))) > 1 - 1e-12:
            found[info.name] = None
        else:
            x = solve_discrete_lyapunov(own, b[used] @ b[used].T)
            found[info.name] = float(np.sqrt(max(c[k][used] @ x @ c[k][used] + d[k] @ d[k], 0.0)))
    return found


def reached(start: Any, a: Array) -> Any:
    """The states that the given ones depend on, through as many samples as it takes."""
    used = start.copy()
    while True:
        more = used | (a[used] != 0).any(axis=0)
        if (more == used).all():
            return used
        used = more


def linear(program: Program, situation: Situation) -> tuple[Array, Array, Array, Array]:
    """A, B, C, D of the realised step, from noise of variance one; encoders remember a sample."""
    run = Lanes(program, {})
    plain = [k for k in program.knowns if k.counts is None and k.kind != "mode"]
    coders = [k for k in program.knowns if k.counts is not None]
    signals = {k.name: _signal(k, 0.0, situation) for k in plain}
    counts = {k.name: 0.0 for k in coders}
    modes = {k.name: situation.at.get(k.path, 1.0) != 0 for k in program.knowns if k.kind == "mode"}
    _, rest = run.sample(signals, counts, counts, modes)
    names = list(rest)
    # A state that is nearly zero where all is well is moved as far as the signals move it.
    tried = [{**signals, name: x + _STEP * (abs(x) or 1.0)} for name, x in signals.items()]
    near = [rest, *[run.sample(other, counts, counts, modes)[1] for other in tried]]
    scale = {name: max(abs(float(states[name])) for states in near) for name in names}
    size, inputs = len(names), len(plain) + 2 * len(coders)
    runs = 2 * (size + inputs)
    steps: list[float] = []

    def spread(value: float, scale: float) -> Array:
        """The value with one pair of runs of its own, a little above and below."""
        k, step = len(steps), _STEP * ((scale or 1.0) if math.isfinite(scale) else 1.0)
        steps.append(step)
        out = np.full(runs, value, dtype=float)
        out[2 * k] += step
        out[2 * k + 1] -= step
        return out

    states = {name: spread(float(rest[name]), scale[name]) for name in names}
    wide = {name: spread(value, abs(value)) for name, value in signals.items()}
    increments = {name: spread(0.0, 0.0) for name in counts}
    totals = {name: spread(0.0, 0.0) for name in counts}
    residuals, after = run.sample(wide, increments, totals, modes, states)

    def slopes(value: Any) -> Array:
        v = np.broadcast_to(np.asarray(value, dtype=float), (runs,))
        found = (v[0::2] - v[1::2]) / (2 * np.array(steps))
        found[np.abs(found) * np.array(steps) <= 1e-14 * np.max(np.abs(v), initial=0.0)] = 0.0
        return np.asarray(found)

    state = np.array([slopes(after[n]) for n in names]).reshape(size, size + inputs)
    out = np.array([slopes(residuals[r.name]) for r in program.residuals])
    return _with_noise(state, out, size, plain, coders, situation)


def _with_noise(
    state: Array,
    out: Array,
    size: int,
    plain: list[Known],
    coders: list[Known],
    situation: Situation,
) -> tuple[Array, Array, Array, Array]:
    """The inputs scaled to noise of variance one; n and n before make the counts of an encoder."""
    p, e = len(plain), len(coders)
    deviation = [situation.noise.get(k.path, 0.0) for k in plain]
    for k in coders:
        turn = (k.counts or 0.0) / (2 * math.pi)
        deviation.append(math.hypot(situation.noise.get(k.path, 0.0) * turn, math.sqrt(1 / 12)))
    # what a law received is a number in the log: noise is in what was measured
    noisy = [k.kind != "reading" for k in (*plain, *coders)]
    scale = np.where(noisy, deviation, 0.0)

    def split(rows: Array) -> tuple[Array, Array]:
        of_states, of_plain = rows[:, :size], rows[:, size : size + p]
        increment, total = rows[:, size + p : size + p + e], rows[:, size + p + e :]
        return (
            np.hstack([of_states, -increment]),
            np.hstack([of_plain, increment + total]) * scale,
        )

    a, b = split(state)
    c, d = split(out)
    before = np.hstack([np.zeros((e, p)), np.eye(e)]) * scale
    return np.vstack([a, np.zeros((e, size + e))]), np.vstack([b, before]), c, d
