"""The smallest change of each fault that a residual shows, for stated signals and noise."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import solve_discrete_lyapunov

from bondgraph.ir.program import Known, Program
from bondgraph.runtime.batch import Lanes
from bondgraph.runtime.log import Array
from bondgraph.text.moment import often
from bondgraph.text.numerals import joined

_STEP = 1e-4  # relative size of the change that a sensitivity is taken from
_ROUNDING = 1e-13  # of the largest number in a filter: a smaller change of its output is none
_MOST = 20_000  # samples of one period of the signals
_STILL = 1e-15  # of a number in a filter: it has not moved from one sample to the next


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
    best, `threshold` a(t) there. `delay` is how long after its onset a lasting change of twice
    that size is sure to be seen, in s; None where it was not asked for, or that is never sure.
    """

    fault: str
    residual: str
    change: float | None
    relative: float | None
    sensitivity: float
    threshold: float
    reason: str
    delay: float | None = None


class Detection(NamedTuple):
    """The noise of each filtered residual (None where it grows for ever), and every fault.

    `undefined` are the residuals that have no value at these signals; their noise is None too.
    """

    sigma: dict[str, float | None]
    smallest: tuple[Smallest, ...]
    undefined: tuple[str, ...] = ()


class Order(NamedTuple):
    """Which residuals answer a fault that grows by `size`, in their order where it is certain.

    Those of one set come in no certain order. The sign is 1 for a residual that rises, -1 for one
    that falls, 0 where that depends on the moment.
    """

    fault: str
    size: float
    answers: tuple[tuple[tuple[str, int], ...], ...]

    def told(self) -> str:
        """The answers in words.

        >>> Order("R", 1.0, ((("r1", -1),), (("r2", 1), ("r3", 0)))).told()
        'r1 falls, then r2 rises and r3 moves'
        """
        words = {1: "rises", -1: "falls", 0: "moves"}
        parts = [joined([f"{r} {words[sign]}" for r, sign in part], "and") for part in self.answers]
        return ", then ".join(parts)


class Fault(NamedTuple):
    """Something that may be wrong, as the program has it; `step` is what it is moved by."""

    path: str
    name: str
    nominal: float | None  # None for a signal
    step: float
    tolerance: float
    turned: bool  # a change of the machine is the opposite change of what the program is told


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
    return Answers(program, thresholds, tolerances, situation).detection


class Answers:
    """How the residuals of a program answer the onset of each fault in a machine that runs.

    Arguments are those of `smallest`; raises ValueError as it does.
    """

    def __init__(
        self,
        program: Program,
        thresholds: Program | None,
        tolerances: Mapping[str, float],
        situation: Situation,
    ) -> None:
        need_numbers(program)
        self._program, self._situation = program, situation
        self._faults = {f.path: f for f in faults(program, tolerances, situation)}
        own = list(self._faults.values()) if program.residuals else []
        self._lasting = sensitivities(program, own, situation)
        self._course = sensitivities(program, own, situation, onset=True)
        self._sigma = noise(program, situation) if program.residuals else {}
        self._bound: dict[str, Array] = {}
        if thresholds is not None and own:
            found = _simulated(thresholds, {}, {}, 1, situation, onset=True)[0]
            self._bound = {name: r[:, 0] for name, r in found.items()}

    @cached_property
    def detection(self) -> Detection:
        """The smallest changes, each at the best moment of a period when all has settled."""
        own = list(self._faults.values())
        samples = _period(self._program, self._situation)
        bound = {name: r[:samples] for name, r in self._bound.items()}
        found = told(self._program, own, self._lasting, bound, self._sigma, self._situation.kappa)
        rows = [s if s.change is None else
                s._replace(delay=self.delay(s.fault, s.residual, 2.0 * s.change))
                for s in found.smallest]  # fmt: skip
        return found._replace(smallest=tuple(rows))

    def delay(self, fault: str, residual: str, size: float) -> float | None:
        """Seconds from the onset of a lasting change until it is sure to be seen, None for never.

        Fault and residual by path, `size` in the unit of the fault; 0 is any size, where nothing
        hides it.
        """
        moved = self._moved(fault, residual, size or 1.0)
        if moved is None:
            return None
        seen = np.flatnonzero(np.abs(moved) >= 1.0)
        return float(seen[0]) / self._program.rate if seen.size else None

    def order(self, fault: str) -> Order | None:
        """In what order residuals answer the onset of a fault, and how; None where none does.

        The fault grows by twice what it takes to be seen in each of the residuals that can show
        it. One comes before another if the other is not halfway when the one is sure to be seen.
        """
        rows = [s for s in self.detection.smallest if s.fault == fault and s.change is not None]
        size = max((2.0 * (s.change or 0.0) for s in rows), default=0.0)
        course = {s.residual: moved for s in rows
                  if (moved := self._moved(fault, s.residual, size)) is not None}  # fmt: skip
        sure = {name: int(np.argmax(np.abs(moved) >= 1.0)) for name, moved in course.items()}
        half = {name: int(np.argmax(np.abs(moved) >= 0.5)) for name, moved in course.items()}
        found: list[list[tuple[str, int]]] = []
        for name in sorted(course, key=lambda r: sure[r]):
            signs = set(np.sign(course[name][np.abs(course[name]) >= 0.5]).astype(int).tolist())
            if not found or any(half[name] <= sure[other] for other, _ in found[-1]):
                found = found or [[]]
            else:
                found.append([])
            found[-1].append((name, signs.pop() if len(signs) == 1 else 0))
        return Order(fault, size, tuple(map(tuple, found))) if found else None

    def _moved(self, fault: str, residual: str, size: float) -> Array | None:
        """What a fault that grows by `size` does from its onset on, 1 where it is sure to be seen.

        By paths; None where the residual tells nothing.
        """
        info = next(i for i in self._program.residuals if i.path == residual)
        sigma = self._sigma.get(info.name)
        if sigma is None or info.unavailable or not size:
            return None
        own = self._faults[fault]
        slope = self._course[fault][info.name]
        bound, kappa = self._bound.get(info.name), self._situation.kappa
        need = _needed(own, np.abs(slope), bound, sigma, kappa)
        with np.errstate(divide="ignore", invalid="ignore"):
            moved = np.where(slope != 0.0, slope * size / need, 0.0)
        return -moved if own.turned else moved


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
                why = info.unavailable or f"not visible at {often(program.rate)}"
                rows.append(Smallest(*base, None, None, 0.0, 0.0, why))
                continue
            if info in undefined:
                rows.append(Smallest(*base, None, None, 0.0, 0.0, "no value at these signals"))
                continue
            slope = np.abs(moved[fault.path][info.name])
            rows.append(_row(base, fault, slope, bound.get(info.name), sigma[info.name], kappa))
    own = {i.path: sigma.get(i.name) for i in program.residuals}
    return Detection(own, tuple(rows), tuple(i.path for i in undefined))


def _row(
    base: tuple[str, str],
    fault: Fault,
    slope: Array,
    bound: Array | None,
    sigma: float | None,
    kappa: float,
) -> Smallest:
    visible = slope > 0
    a = np.zeros(len(slope)) if bound is None else bound
    if not visible.any():
        return Smallest(*base, None, None, 0.0, float(a[-1]), "not moved by these signals")
    if sigma is None:
        at = int(np.argmax(slope))
        why = "the residual integrates the noise"
        return Smallest(*base, None, None, float(slope[at]), float(a[at]), why)
    with np.errstate(divide="ignore"):
        change = np.where(visible, _needed(fault, slope, bound, sigma, kappa) / slope, np.inf)
    at = int(np.argmin(change))
    least = float(change[at])
    relative = least / abs(fault.nominal) if fault.nominal else None
    return Smallest(*base, least, relative, float(slope[at]), float(a[at]), "")


def _needed(
    fault: Fault, slope: Array, bound: Array | None, sigma: float, kappa: float
) -> Array | float:
    """What a change has to do to a residual to be sure to be seen, see `smallest`."""
    if bound is None:
        return kappa * sigma
    own = np.minimum(fault.tolerance * abs(fault.nominal or 0.0) * slope, bound)
    return np.asarray(2 * bound - own + kappa * sigma)


def faults(program: Program, tolerances: Mapping[str, float], situation: Situation) -> list[Fault]:
    """The faults of all residuals that the code knows, in the order of the residuals."""
    params = {f.path: f for f in program.params}
    knowns = {k.path: k for k in program.knowns if k.kind != "reading"}
    found = []
    for path in dict.fromkeys(f for r in program.residuals for f in r.faults):
        if path in params:
            value = float(params[path].default or 0.0)
            step = _STEP * (abs(value) or 1.0)
            own = tolerances.get(path, 0.0)
            found.append(Fault(path, params[path].name, value, step, own, True))
        elif path in knowns:
            size = abs(situation.at.get(path, 0.0)) + abs(situation.swing.get(path, 0.0))
            known = knowns[path]
            step, turned = _STEP * (size or 1.0), known.kind != "sensor"
            found.append(Fault(path, known.name, None, step, 0.0, turned))
        else:  # only in what step leaves out
            found.append(Fault(path, "", None, _STEP, 0.0, True))
    return found


def sensitivities(
    program: Program, faults: list[Fault], situation: Situation, onset: bool = False
) -> dict[str, dict[str, Array]]:
    """Per fault and residual the sensitivity at each valid sample, 0 where it is rounding.

    Over one period of the signals, of a machine that was never well; with `onset` from the moment
    when the fault sets in, and over a period after all has settled.
    """
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
    result, sizes = _simulated(program, params, signals, runs, situation, onset)
    found: dict[str, dict[str, Array]] = {}
    for k, fault in enumerate(faults):
        own = found[fault.path] = {}
        for name, r in result.items():
            with np.errstate(invalid="ignore"):  # of a residual without a value
                change = r[:, 2 * k] - r[:, 2 * k + 1]
            felt = np.abs(change) > _ROUNDING * max(sizes[name][2 * k : 2 * k + 2])
            own[name] = np.where(felt, change / (2 * fault.step), 0.0)
    return found


def _settled(program: Program) -> int:
    """The samples after which a residual has forgotten how it began."""
    pace = program.bandwidth / program.rate
    return math.ceil(program.wait(pace) / pace) + 1


def _period(program: Program, situation: Situation) -> int:
    """The samples of one period of the signals."""
    moving = any(situation.swing.values())
    return min(math.ceil(program.rate / situation.frequency), _MOST) if moving else 1


def _simulated(
    program: Program,
    params: Mapping[str, Array],
    errors: Mapping[str, Array],
    runs: int,
    situation: Situation,
    onset: bool = False,
) -> tuple[dict[str, Array], dict[str, Array]]:
    """The residuals, samples by runs, from when they are valid over one period of the signals.

    Besides, by run, the largest number in the filter of each. Parameters are wrong, and signals
    have their errors, from the start; with `onset` not before the first of the samples that are
    returned: what the filters remember then is that of a machine that is well, and all settles
    once more before the period begins.
    """
    well, run = Lanes(program, {}), Lanes(program, dict(params))
    valid = _settled(program)
    begin, end = (valid, 2 * valid) if onset else (0, valid)
    rows: dict[str, list[Array]] = {r.name: [] for r in program.residuals}
    sizes = {r.name: np.zeros(runs) for r in program.residuals}
    own = {r.name: [s.name for s in program.states if s.name.startswith(f"{r.name}_")]
           for r in program.residuals}  # fmt: skip
    modes = {m.name: situation.at.get(m.path, 1.0) != 0 for m in program.knowns if m.kind == "mode"}
    states: dict[str, Any] | None = None
    before: dict[str, Any] = {}
    turning = any(situation.at.get(x.path) for x in program.knowns if x.counts is not None)
    constant, still = not (turning or any(situation.swing.values())), False
    for k in range(end + _period(program, situation)):
        signals: dict[str, Any] = {}
        increments: dict[str, Any] = {}
        totals: dict[str, Any] = {}
        for known in program.knowns:
            if known.kind == "mode":
                continue
            value = _signal(known, k / program.rate, situation)
            told = value + (errors.get(known.name, 0.0) if k >= begin else 0.0)
            if known.counts is None:
                signals[known.name] = told
            else:
                turn, start = known.counts / (2 * math.pi), _signal(known, 0.0, situation)
                increments[known.name] = (told - before.get(known.name, told)) * turn
                totals[known.name] = (told - start) * turn
                before[known.name] = told
        now = well if k < begin else run
        if k == begin or states is None or not still:
            residuals, after = now.sample(signals, increments, totals, modes, states)
            still = constant and states is not None and _unmoved(states, after)
            states = after
        if k >= valid:
            for name, value in residuals.items():
                rows[name].append(np.broadcast_to(np.asarray(value, dtype=float), (runs,)))
                for state in own[name]:
                    sizes[name] = np.maximum(sizes[name], np.abs(states[state]))
    return {name: np.array(r) for name, r in rows.items()}, sizes


def _unmoved(before: Mapping[str, Any], after: Mapping[str, Any]) -> bool:
    """Whether a memory is as it was, but for roundings: with the same signals it stays so."""
    return all(np.all(np.abs(after[name] - x) <= _STILL * np.abs(x)) for name, x in before.items())


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
