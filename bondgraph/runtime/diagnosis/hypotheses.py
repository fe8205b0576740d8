"""What each fault would do to the residuals: the same program run beside itself, a little wrong."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from types import MappingProxyType
from typing import Literal

import numpy as np
import numpy.typing as npt

from bondgraph.ir.residual_limit import ROW
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Batch, Engine, copied
from bondgraph.text.tuples import NamedTuple

_STEP = 1e-5  # relative change that a sensitivity is taken from
_USUAL = 0.3  # share of what a fault usually changes: of a value, of the size of a signal
_COUNTS = 0.02  # share of an encoder's counts: smaller ones would drown in rounding
_SLOWLY = 40.0  # time constants of the filter in which a sensor drifts as far as it is usually off
_SLIP = 1 / 8  # of a turn, by which an encoder usually slips
ALL = math.inf  #: of the derivatives in front of a parameter
_GONE = 12.0  # time constants, beside one a stage, after which a filter has forgotten all
_AT_ONCE = 2**18  # numbers that the engines of a bank take and give in one call

COUNT = "count"  # the unit of an encoder's offset
Kind = Literal["value", "offset", "gain", "drift", "start", "stuck"]


class Stuck(NamedTuple):
    """A switch that is in one `position` whatever its `signal` tells, or a command that is lost.

    Or one that is not followed any more: then that is where it was at the onset, NaN before it is
    known which one that is.

    `moves` has the residuals that this moves, by what the `modes` are told to be; where they are
    told what is not among it, it may move any.
    """

    signal: str
    position: float
    modes: tuple[str, ...] = ()
    moves: Mapping[tuple[bool, ...], frozenset[str]] = MappingProxyType({})

    @property
    def stays(self) -> bool:
        """Whether what acts stays where it was."""
        return math.isnan(self.position)

    def at(self, position: float) -> Stuck:
        """The same where it stays at a position, if it stays."""
        return self._replace(position=position) if self.stays else self

    def ever(self, residuals: Sequence[str]) -> frozenset[str]:
        """Those of some residuals that it moves in any mode."""
        own = frozenset(residuals)
        return own & frozenset().union(*self.moves.values()) if self.moves else own

    def moved(self, told: Array, residuals: Sequence[str]) -> Mask:
        """Which residuals it moves at samples that tell (n, modes); shape (n, residuals).

        >>> moves = {(True,): frozenset({"r1"}), (False,): frozenset()}
        >>> switch = Stuck("on", False, ("on",), moves)
        >>> switch.moved(np.array([[0.0], [1.0]]), ["r1", "r2"]).tolist()
        [[False, False], [True, False]]
        """
        told = told != 0
        fresh = np.ones(len(told), dtype=np.bool_)
        fresh[1:] = (told[1:] != told[:-1]).any(axis=1)
        sets = [self.moves.get(tuple(row), residuals) for row in told[fresh].tolist()]
        found = np.array([[r in own for r in residuals] for own in sets], dtype=np.bool_)
        return np.asarray(found.reshape(len(sets), len(residuals))[np.cumsum(fresh) - 1])


class Hypothesis(NamedTuple):
    """One way in which one thing may be wrong.

    `value`: a parameter has another value; `offset`: a signal is wrong by a constant (an encoder
    has slipped); `gain`: a signal is wrong by a share of itself (an encoder misses counts);
    `drift`: an encoder misses so many counts a second, another sensor goes away at such a rate;
    `start`: only the first sample of a signal is, so that what is remembered of it is wrong, or the
    parameter that says where something begins;
    `stuck`: what acts is `held` at a position, whatever is told, which has no size but 1. `unit` is
    that of the change, `usual` the size that is expected of it before anything is seen.
    A wrong sensor is so for who measures with it: a law that uses its reading acted on just this
    number, so that only the measurement is changed.
    `turned` says that a change of the machine moves residuals like the opposite change of what the
    program is told: so it is with parameters and commands, not with readings.
    A gain is told in percent, that of a temperature in its `unit` at its usual `level`: a share of
    what is counted from absolute zero says nothing to anybody. Where encoders stand says nothing
    of how far a share takes them: they have no level. A parameter that is declared to be `zero` has
    no size of its own, and either sign, whatever it is now.
    """

    fault: str
    kind: Kind
    unit: str
    usual: float
    turned: bool
    held: Stuck | None = None
    level: float = 0.0
    zero: bool = False

    def told(self, size: float) -> tuple[float, str]:
        """A size as people are told it, and its unit.

        >>> Hypothesis("I", "gain", "", 0.3, False).told(0.02)
        (2.0, '%')
        >>> Hypothesis("T", "gain", "K", 0.3, False, level=300.0).told(0.01)
        (3.0, 'K')
        """
        if self.kind != "gain":
            return size, self.unit
        return (size * self.level, self.unit) if self.unit else (100.0 * size, "%")


class _Lane:
    """One hypothesis of a bank: engines at both ends of its slope, and since when it holds."""

    def __init__(
        self, hypothesis: Hypothesis, ends: tuple[float, float], value: float | None
    ) -> None:
        self.hypothesis, self.ends = hypothesis, ends
        self.value = value  # of the parameter that is another, None where it is what is told
        self.engines: list[Engine | None] = []  # None for an end at the machine as it is
        self.begin: Array | None = None  # the sample before the first: where encoders count from
        self.age = 0  # samples so far
        self.left: Array | None = None  # what stays in the filter of the time before the onset
        self.impulse = np.zeros(0)  # what comes into it with the onset, beside that


class _Plan(NamedTuple):
    """How the engines of a bank are run in one call: by which table each, the first as it is told.

    Behind it is one for each of `told`, a hypothesis with a change. Those with the same table stand
    behind each other. `ends` are the numbers of the engines (hypotheses, 2), -1 for the machine as
    it is, `apart` how far these are from each other, (hypotheses, 1, 1).
    """

    engines: list[Engine]
    which: list[int]
    told: list[tuple[_Lane, float]]
    ends: npt.NDArray[np.intp]
    apart: Array


def _plan(lanes: Sequence[_Lane]) -> _Plan:
    apart = np.array([lane.ends[0] - lane.ends[1] for lane in lanes])[:, None, None]
    plan = _Plan([], [], [], np.full((len(lanes), 2), -1, dtype=np.intp), apart)
    order = sorted(range(len(lanes)), key=lambda k: lanes[k].value is None)
    for k in order:
        lane = lanes[k]
        for side, (end, engine) in enumerate(zip(lane.ends, lane.engines, strict=True)):
            if engine is None:
                continue
            if lane.value is None:
                plan.told.append((lane, end))
            plan.ends[k, side] = len(plan.engines)
            plan.engines.append(engine)
            plan.which.append(len(plan.told))
    return plan


class Bank:
    """Engines side by side on the same samples, one or two for each hypothesis.

    The slope of a residual is the difference between the machine as it is and one with a parameter
    a little larger, or with a signal that is a little wrong; between both sides with an encoder,
    whose counts are whole, so that a little is much. With one of the `changes` (by the number of
    the hypothesis) it is the secant up to there: times the change it is what such a fault does,
    however bent the laws are. Hypotheses hold from the moment at which the bank begins, with all
    that `engine` remembers of the time before. Raises ValueError for a change that the model cannot
    take.
    """

    def __init__(
        self,
        engine: Engine,
        hypotheses: Sequence[Hypothesis],
        nominal: Mapping[str, float],
        begin: Array | None = None,
        changes: Mapping[int, float] | None = None,
    ) -> None:
        self.engine = engine
        self.hypotheses = tuple(hypotheses)
        self._place = {k.path: at for at, k in enumerate(engine.signals)}
        self._nominal = nominal
        self.batch: Batch | None = None  # what came out of `engine` last
        bent = changes or {}
        self._lanes = [self._lane(h, bent.get(k), begin) for k, h in enumerate(self.hypotheses)]
        self._plan = _plan(self._lanes)

    def _lane(self, hypothesis: Hypothesis, change: float | None, begin: Array | None) -> _Lane:
        step, fault, value = self._step(hypothesis), hypothesis.fault, None
        if hypothesis.kind == "value":
            value = self._nominal[fault]
        elif fault not in self._place:
            value = self.engine.parameters[fault]
        start = hypothesis.kind == "start"
        little = value is not None or not (start or self._counts(hypothesis))
        tangent = (step, 0.0) if little else (step, -step)
        lane = _Lane(hypothesis, tangent if change is None else (0.0, -change), value)
        lane.begin = begin
        for end in lane.ends:
            one = None
            if end:
                own = {fault: value + end} if value is not None else None
                one = self.engine.configured(own, bounds=False)
                one.follow(self.engine)
            lane.engines.append(one)
        return lane

    def _step(self, hypothesis: Hypothesis) -> float:
        if hypothesis.kind == "value":
            return _STEP * max(abs(self._nominal[hypothesis.fault]), hypothesis.usual)
        counts = self._counts(hypothesis)
        if hypothesis.kind == "start":
            return max(1.0, round(hypothesis.usual)) if counts else hypothesis.usual
        if hypothesis.kind == "gain":
            return _COUNTS if counts else _STEP
        if hypothesis.kind == "drift":
            return max(1.0, _COUNTS * hypothesis.usual) if counts else hypothesis.usual
        return max(1.0, round(hypothesis.usual)) if counts else _STEP * hypothesis.usual

    def _counts(self, hypothesis: Hypothesis) -> bool:
        at = self._place.get(hypothesis.fault)
        return at is not None and self.engine.signals[at].counts is not None

    def reset(self) -> None:
        """Forget all samples."""
        for engine in (self.engine, *[e for lane in self._lanes for e in lane.engines if e]):
            engine.reset()
        for lane in self._lanes:
            lane.begin, lane.age = None, 0

    def take(self, other: Bank, numbers: Sequence[int]) -> None:
        """Let hypotheses of these numbers be as they are in another bank, at the same sample."""
        for k, lane in zip(numbers, other._lanes, strict=True):
            self._lanes[k] = lane
        self._plan = _plan(self._lanes)

    def copied(self) -> Bank:
        """Another one that stands where this one does."""
        other = Bank(copied(self.engine), self.hypotheses, self._nominal)
        for own, lane in zip(other._lanes, self._lanes, strict=True):
            own.ends, own.begin, own.age = lane.ends, lane.begin, lane.age
            own.left, own.impulse = lane.left, lane.impulse
            own.engines = [None if e is None else copied(e) for e in lane.engines]
        other._plan = _plan(other._lanes)
        return other

    def part(self, numbers: Sequence[int]) -> Bank:
        """Only the hypotheses of these numbers, at the same sample; the others are given up."""
        other = Bank(self.engine, (), self._nominal)
        other.hypotheses = tuple(self.hypotheses[k] for k in numbers)
        other._lanes = [self._lanes[k] for k in numbers]
        other._plan = _plan(other._lanes)
        return other

    def onset(self, slopes: Array, jumps: Bank | None = None) -> None:
        """What has held so far begins now; `slopes` are those of the last sample.

        A filter shows for a while what came before. Of that nothing is to be seen. With `jumps`, a
        bank of the same that begins now, one of the derivatives in it stands in front of what
        becomes another one, and makes an impulse of how far that jumps. Both are beside each other
        until they have forgotten the time before, with signals that stay: what is between them has
        the area of that impulse, as what more derivatives make of a jump has none. These go on.
        """
        for lane, left in zip(self._lanes, slopes, strict=True):
            lane.left, lane.impulse, lane.age = left.copy(), np.zeros_like(left), 0
        begin = jumps._lanes[0].begin if jumps and jumps._lanes else None
        if jumps is not None and begin is not None:
            stays = np.repeat(begin[None], _rest(self.engine), axis=0)
            beyond = jumps.run(stays) - self.copied().run(stays)
            for lane, area in zip(self._lanes, beyond.sum(axis=0), strict=True):
                lane.impulse = area

    def run(self, samples: Array, at: Sequence[int] | None = None) -> Array:
        """The slopes after further (n, signals) samples; shape (n, hypotheses, residuals).

        Or only after those that are numbered `at`, in order. In units of the residual over those of
        the hypothesis. The first engine goes on too.
        """
        wanted = np.arange(len(samples)) if at is None else np.asarray(at, dtype=np.intp)
        return self._run(samples, wanted)[0]

    def rows(
        self, samples: Array, ends: Sequence[int], lengths: Sequence[int]
    ) -> tuple[Array, Array]:
        """The slopes after further samples at the ends of rows, and their averages over each row.

        Both (rows, hypotheses, residuals). The first row may have more samples than are given, by
        its length: the hypotheses have not held before.
        """
        last, sums = self._run(samples, np.asarray(ends, dtype=np.intp), whole=True)
        return last, sums / np.asarray(lengths)[:, None, None]

    def _run(
        self, samples: Array, ends: npt.NDArray[np.intp], whole: bool = False
    ) -> tuple[Array, Array]:
        """The slopes at the ends, and if wanted the sums of all since the end before."""
        self.batch = self.engine.run(samples)
        count, residuals = len(self._lanes), len(self.engine.residuals)
        slopes = np.zeros((len(ends), count, residuals))
        sums = np.zeros_like(slopes if whole else slopes[:0])
        wide = 1 + 2 * count * (samples.shape[1] + 2 * residuals)
        block = max(1, _AT_ONCE // wide)
        for start in range(0, len(samples) if count else 0, block):
            own = slice(start, min(start + block, len(samples)))
            first, last = np.searchsorted(ends, (own.start, own.stop))
            at = ends[first:last] - start
            every = self._outputs(samples[own], self.batch.value[own], self.batch.valid[own])
            before = self._before(own.stop - own.start)
            slopes[first:last] = self._slopes(every, before, partial(np.take, indices=at, axis=1))
            if whole:
                adds = self._slopes(every, before, partial(summed, ends=at))
                some = sums[first : first + len(adds)]
                some += adds[: len(some)]
        return slopes, sums

    def _outputs(self, samples: Array, value: Array, valid: Mask) -> list[tuple[Array, Mask]]:
        """What comes out of the engines of the plan, (engines, n, residuals), and of the first."""
        tables, received = self._told(samples)
        found, engines = [(value[None], valid[None])], self._plan.engines
        if engines:
            batch = engines[0].run_with(engines[1:], tables, received, self._plan.which)
            found.insert(0, (batch.value, batch.valid))
        return found

    def _before(self, count: int) -> list[Array | None]:
        """What the filters show, in each of the last samples, of the time before the onset.

        Less the impulses of the onset. (n, residuals) for each hypothesis, None where it is no more
        than the rounding of a number.
        """
        found: list[Array | None] = []
        shares: dict[int, Array] = {}  # by age, as most have the same
        falls: dict[int, Array] = {}  # of these within a sample: how an impulse shows
        for lane in self._lanes:
            if lane.left is not None and lane.age not in shares:
                ages = lane.age - count + 1 + np.arange(count)
                shares[lane.age] = _forgotten(self.engine, ages)
                falls[lane.age] = _forgotten(self.engine, ages - 1) - shares[lane.age]
            if lane.left is None:
                found.append(None)
                continue
            found.append(lane.left * shares[lane.age] - lane.impulse * falls[lane.age])
            if np.max(shares[lane.age][-1]) < np.finfo(float).eps / 2.0:
                lane.left = None
        return found

    def _slopes(
        self,
        outputs: Sequence[tuple[Array, Mask]],
        before: Sequence[Array | None],
        chosen: Callable[[Array], Array],
    ) -> Array:
        """The slopes of outputs at moments that are `chosen` along the second axis of a table."""
        value, valid = (
            np.concatenate([chosen(x) for x in own]) for own in zip(*outputs, strict=True)
        )
        up, down = self._plan.ends.T
        slopes = np.take(value, up, axis=0)
        slopes -= np.take(value, down, axis=0)
        slopes /= self._plan.apart
        for own, gone in zip(slopes, before, strict=True):
            if gone is not None:
                own -= chosen(gone[None])[0]
        if not valid.all():
            slopes *= valid[up] & valid[down]
        return np.asarray(slopes.transpose(1, 0, 2))

    def _told(self, samples: Array) -> tuple[Array, Array | None]:
        """The tables of the plan, (tables, n, signals), and what laws received in each, if any."""
        fresh = [lane for lane in self._lanes if lane.begin is None]
        for lane in fresh:
            lane.begin = samples[0].copy()
        tables = np.repeat(samples[None], 1 + len(self._plan.told), axis=0)
        for told, (lane, end) in zip(tables[1:], self._plan.told, strict=True):
            at = self._place[lane.hypothesis.fault]
            told[:, at] = self._shifted(samples[:, at], lane, end, bool(fresh) and lane in fresh)
        for lane in self._lanes:
            lane.age += len(samples)
        if not self.engine.readings:
            return tables, None
        # laws acted on what they received, wrong or not; where a log begins is no fault
        received = np.repeat(samples[None][:, :, self.engine.readings], len(tables), axis=0)
        for k, (lane, _) in enumerate(self._plan.told, 1):
            if lane.hypothesis.kind == "start":
                received[k] = tables[k][:, self.engine.readings]
        return tables, received

    def _shifted(self, column: Array, lane: _Lane, step: float, fresh: bool) -> Array:
        """Samples of a signal as they are told when the hypothesis holds with a change of `step`.

        A `fresh` encoder counts from its first sample, which is therefore as it is told.
        """
        hypothesis = lane.hypothesis
        if hypothesis.kind == "offset":
            told = column + step
            if fresh and self._counts(hypothesis):
                told[:1] = column[:1]
            return told
        if hypothesis.kind == "start":
            told = column.copy()
            told[:1] += step * fresh
            return told
        if hypothesis.kind == "drift":
            since = (lane.age + 1 + np.arange(len(column))) * self.engine.sample_time
            told = column + step * since
            return np.asarray(np.round(told) if self._counts(hypothesis) else told)
        if self._counts(hypothesis):
            assert lane.begin is not None
            begin = lane.begin[self._place[hypothesis.fault]]
            return np.asarray(np.round(column + step * (column - begin)))
        return column + step * column


def _rest(engine: Engine) -> int:
    """The samples after which a filter shows next to nothing of what came before."""
    constants = _GONE + max(engine.stages, default=0)
    lag = max(engine.lags, default=0.0)
    return math.ceil((constants / engine.bandwidth + lag) / engine.sample_time)


def _forgotten(engine: Engine, samples: npt.NDArray[np.intp]) -> Array:
    """What filters still show after so many samples of what was constant before, (n, residuals).

    What the step response of equal stages is short of.
    """
    from scipy.special import gammaincc

    constants = engine.bandwidth * engine.sample_time * samples
    return np.asarray(gammaincc(engine.stages, constants[:, None]))


def summed(table: Array, ends: npt.NDArray[np.intp]) -> Array:
    """Sums along the second axis up to each end and behind the last; or whether all are true.

    >>> summed(np.arange(5.0)[None], np.array([1, 3])).tolist()
    [[1.0, 5.0, 4.0]]
    """
    begins = np.append(0, ends + 1)
    add = np.logical_and if table.dtype == np.bool_ else np.add
    return np.asarray(add.reduceat(table, begins[begins < table.shape[1]], axis=1))


def hypotheses(
    engine: Engine,
    faults: Mapping[str, float | None],
    units: Mapping[str, str],
    sizes: Mapping[str, float],
    switches: Mapping[str, Stuck] = MappingProxyType({}),
    in_time: bool = False,
    zeros: Collection[str] = (),
) -> tuple[Hypothesis, ...]:
    """All that may be wrong: a value for each parameter, offset and gain for each signal.

    `faults` are the paths that some residual sees, with the nominal value of a parameter and None
    for a signal, `zeros` those that are declared to be zero; `sizes` is the usual size of a signal,
    of an encoder its speed in rad/s. Modes are wrong as `switches`, by the name of the fault. Where
    there are any, commands may be lost: that is as certain in what it does, and would have to lose
    against them otherwise. With `in_time` a sensor whose reading is differentiated may go away
    steadily: its rate is in the relation as well, which no offset has. And an actuator may stay
    where it was, whatever it is told.
    """
    signals = {k.path: k for k in engine.signals}
    found = []
    for path, nominal in faults.items():
        unit = units.get(path, "")
        unit = "" if unit == "1" else unit  # a number is written without one
        if nominal is not None:
            if path in engine.parameters:
                usual = _USUAL * (abs(nominal) or 1.0)
                found.append(Hypothesis(path, "value", unit, usual, True, zero=path in zeros))
        elif path in signals and signals[path].kind != "mode":
            counts = signals[path].counts
            size = sizes.get(path, 1.0)
            usual = _USUAL * size if counts is None else _SLIP * counts
            turned = signals[path].kind != "sensor"
            unit = unit if counts is None else COUNT
            found.append(Hypothesis(path, "offset", unit, usual or _USUAL, turned))
            level = size if counts is None else 0.0
            own = unit if unit == "K" else ""
            found.append(Hypothesis(path, "gain", own, _USUAL, turned, None, level))
            if switches and turned:
                found.append(Hypothesis(path, "stuck", "", 1.0, True, Stuck(path, 0.0)))
            if in_time and turned and counts is None:
                found.append(Hypothesis(path, "stuck", unit, 1.0, True, Stuck(path, math.nan)))
            if counts is not None:
                rate = _USUAL * size * counts / (2 * math.pi)
                found.append(Hypothesis(path, "drift", "count/s", rate, turned))
            elif in_time and not turned and signals[path].highest > 0:
                rate = usual * engine.bandwidth / _SLOWLY
                found.append(Hypothesis(path, "drift", f"{unit or 1}/s", rate, False))
    found += [Hypothesis(f, "stuck", "", 1.0, True, s) for f, s in switches.items()]
    return tuple(found)


def sized(
    engine: Engine,
    known: tuple[Hypothesis, ...],
    nominal: Mapping[str, float],
    samples: Array,
) -> tuple[Hypothesis, ...]:
    """The same with usual sizes of parameters that are declared to be nothing.

    These are a leak that is not there yet, and what a controller delivers wrongly. By how much no
    number tells: in SI units a hole may be 1e-9. But some signal of the same balance is as large:
    usual is the share `_USUAL` of what moves a residual as that signal does, over (n, signals)
    samples from where the engine is. A law may be bent, so that a step of the unit it is in is too
    large for a slope: it is taken once more at what is usual then.
    """
    own = [k for k, h in enumerate(known) if h.kind == "value" and (h.zero or not nominal[h.fault])]
    gains = [k for k, h in enumerate(known) if h.kind == "gain"]
    if not own or not gains or not len(samples):
        return known
    found = list(known)
    largest = np.abs(Bank(copied(engine), [known[k] for k in gains], nominal).run(samples))
    largest = largest.max(axis=(0, 1))
    for _ in range(2):
        bank = Bank(copied(engine), [found[k] for k in own], nominal)
        for k, slopes in zip(own, np.abs(bank.run(samples)).max(axis=0), strict=True):
            seen = (slopes > 0) & (largest > 0)
            if seen.any():
                usual = _USUAL * float(np.min(largest[seen] / slopes[seen]))
                found[k] = known[k]._replace(usual=usual)
    return tuple(found)


class Sizes:
    """What signals are usually like: the root of their mean square, of an encoder its speed."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._sums = np.zeros(len(engine.signals))
        self._counts = np.zeros(len(engine.signals))
        counted = [(at, k.counts) for at, k in enumerate(engine.signals) if k.counts is not None]
        self._counted = [at for at, _ in counted]
        self._turns = [2 * math.pi / counts / engine.sample_time for _, counts in counted]

    def add(self, samples: Array) -> None:
        """Further (n, signals) samples, one after the other."""
        table = samples.copy()
        table[:1, self._counted] = math.nan
        table[1:, self._counted] = np.diff(samples[:, self._counted], axis=0) * self._turns
        known = np.isfinite(table)
        self._sums += np.square(np.where(known, table, 0.0)).sum(axis=0)
        self._counts += known.sum(axis=0)

    def found(self) -> dict[str, float]:
        """By path; 1 for a signal that has always been zero, of which nothing is known."""
        means = np.sqrt(self._sums / np.maximum(self._counts, 1))
        paths = [k.path for k in self._engine.signals]
        return {p: float(m) or 1.0 for p, m in zip(paths, means, strict=True)}


def rows_apart(engine: Engine) -> int:
    """How many samples lie between two rows that noise makes nearly independent.

    The residual filter forgets with its bandwidth; after three time constants of a filter of third
    order the correlation is 0.35 (Matern).
    """
    return max(1, math.ceil(ROW / engine.bandwidth / engine.sample_time))
