"""Faults beside what was seen since an onset, each with what it would have done since then."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from itertools import accumulate
from types import MappingProxyType

import numpy as np

from bondgraph.runtime.diagnosis.healthy import drifting
from bondgraph.runtime.diagnosis.held_positions import Instead, Loudness, staying
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.hypotheses import ALL, Bank, Hypothesis, Stuck
from bondgraph.runtime.diagnosis.isolation import (
    BEHIND,
    FLAT,
    Case,
    Evidence,
    Explained,
    ExplainedPair,
    Rows,
    inverse,
)
from bondgraph.runtime.diagnosis.row_averages import LAGS
from bondgraph.runtime.diagnosis.row_sums import Moves, Told, told
from bondgraph.runtime.diagnosis.rows import Row
from bondgraph.runtime.diagnosis.shared_noise import Shared
from bondgraph.runtime.diagnosis.two_at_once import pairs
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Engine, copied
from bondgraph.text.tuples import NamedTuple

#: Time constants of the filter, beside delays, that a residual may show late what has happened.
_SHIFTS = (0.0, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0, 4.0)
MOST = 600  # rows that are compared: by then it is known as well as it will be
_WAIT = 8  # rows that are run at once, unless somebody asks before
BENT = 80  # rows with whose samples onsets and sizes are looked for, while there are no more
_ROUNDS = 12  # of looking for a size
_SMALL = 1e-5  # of the usual change: for less a tangent does
_CLEAR = 2.0  # standard deviations of a change that it is worth a secant
_LEFT, _LARGEST = 0.05, 20.0  # of a parameter: values between which a secant is taken
_AGAIN = 1.5  # times the rows with which onsets and sizes were looked for, until they are again
_STEP, _FINE = 2.0, 1.03  # factors between sizes that are compared, at first and at last
_HUGE = 1e100  # a slope beyond it is that of a law that has run over
_ERROR = 0.1  # of the residual, in the first row: a filter shows late when the fault began
_FADES = 0.4  # what is left of that in every row after
_AT_ONCE = 2**19  # slopes that onsets take side by side
_GROWS = 3  # rows within which a residual has become as large as the fault makes it


class _Onset(NamedTuple):
    """When a fault began, so many healthy samples before the first row, and how.

    A storage that becomes another one keeps its charge or momentum, so that what is measured jumps,
    or what is measured goes on, as where it is filled up or something comes off. What tells one
    from the other is how many derivatives stand in `front` of what has become another one.
    """

    earlier: int
    front: float = ALL


class _Begun(NamedTuple):
    """Hypotheses, by their numbers, that have begun at an onset.

    `moves` are what they do to the rows, none where something is held. Those with a size go on in
    the `bank`, `bent` where their slopes are secants; of what is held there is what runs beside,
    and what that changes.
    """

    onset: _Onset
    numbers: Sequence[int]
    moves: Moves
    bank: Bank
    bent: Mapping[int, float]
    held: Mapping[int, _Held]


class _Held(NamedTuple):
    """What is held at a position: what runs beside, what it moves residuals by, the first of its
    `moves`, and their slopes; which are valid, and how much louder, both (rows, residuals)."""

    beside: Instead
    moves: Moves
    sound: Mask
    louder: Array


class _Sized(NamedTuple):
    """The most probable change of a hypothesis so far, None for a tangent, and its slopes.

    `apart` is how far it is from the one that is found with them (see `_apart`).
    """

    apart: float
    evidence: float
    change: float | None
    begun: _Begun | None = None  # None as long as these are the slopes of the rows

    @property
    def told(self) -> float:
        """The evidence, of which there is none where its slopes are not those of the change."""
        return -math.inf if self.apart else self.evidence

    def less_than(self, other: _Sized) -> bool:
        """Whether another change is nearer to the one that is found with it, or explains more."""
        if other.apart != self.apart:
            return other.apart < self.apart
        return other.evidence > self.evidence + FLAT


class SinceOnset:
    """Begins at the onset: `engine` stands before samples that look healthy.

    Those of the first row come behind them. A filter shows late what happens, and what looks like
    one fault now looks like another that began a little earlier: once there is something to go by,
    each fault gets the onset that suits it best. And laws may be bent: where a fault is as large as
    the samples say, its slope is not that of a small one. So each is tried again then with its own
    size. What it does depends on the parameters that this `machine` has, as far as it is known. A
    switch that is stuck has no size: beside the rows as they were told stand those that it would
    have made of the same samples. What is `tolerated` is so in both.
    """

    def __init__(
        self,
        engine: Engine,
        healthy: Array,
        hypotheses: Sequence[Hypothesis],
        nominal: Mapping[str, float],
        tolerated: Sequence[Hypothesis],
        machine: Mapping[str, float],
        dynamic: Mapping[str, Sequence[float]] = MappingProxyType({}),
        before: Sequence[Row] = (),
        own: int = 0,
    ) -> None:
        self._engine = copied(engine)
        self._healthy, self._before, self._own = healthy, tuple(before), own
        self._all, self._nominal = tuple(hypotheses), nominal
        self._sized = [k for k, h in enumerate(self._all) if h.held is None]
        self._tolerated = tuple(tolerated)
        self._machine = machine
        self._ways = [dynamic.get(h.fault, (ALL,)) for h in self._all]
        shape = len(self._all), len(engine.residuals)
        self._waiting: list[tuple[Row, Array]] = []  # with the limits of each residual
        self._past: list[tuple[Row, Array]] = []
        self._rows: list[tuple[Row, Array]] = []  # without their samples
        self._moves = Moves(np.zeros((0, *shape)), np.zeros((LAGS, *shape)))
        self._held: dict[int, _Held] = {}  # by the number of what is held
        self._unsaid = np.zeros((_GROWS, shape[1]), dtype=bool)
        self._slopes = np.zeros(shape)  # of the last row
        self._means = np.zeros((LAGS + 1, *shape))  # averages of that and of the rows before
        self._loud = Loudness(self._engine, self._all, nominal, healthy)
        self._others: dict[int, Array] = {}  # what residuals would be above that, if held
        self._told = np.zeros((0, len(engine.signals)))  # samples of the last row
        self._place = {k.path: at for at, k in enumerate(engine.signals)}
        self._again = 0  # rows with which secants are looked for again
        self._known: list[Explained] | None = None  # with all rows that are compared
        #: Healthy samples that come behind the onset, and the change that slopes are secants up to.
        self._tried: dict[int, tuple[_Onset, float | None]] = dict.fromkeys(
            self._sized, (_Onset(0), None)
        )
        first, begin = self._onset(0)
        self._bank = self._banked(first, [self._all[k] for k in self._sized], begin, {})
        held = [k for k, h in enumerate(self._all) if h.held is not None]
        self._take(self._begun(held, _Onset(0), {}), held)

    def step(self, row: Row, limits: Array) -> None:
        """One more row, and the limits of its residuals, (residuals, columns of `Limit`)."""
        self._waiting.append((row, limits))
        if len(self._waiting) >= _WAIT:
            self._catch_up()

    def moves(self, faults: Iterable[tuple[Hypothesis, float]]) -> Moves | None:
        """By how much faults of so much move each residual in the last row, NaN if not known.

        And the averages of that row and of LAGS before, which are not known of what is held. None
        where one of them is not followed any more. Where something is held at a position that it is
        told to be in, nothing shows it.
        """
        self._catch_up()
        moved, means = np.zeros(self._slopes.shape[1]), np.zeros(self._means[:, 0].shape)
        for hypothesis, change in faults:
            k, held = self._all.index(hypothesis), hypothesis.held
            if held is not None and held.stays:
                if k not in self._held:
                    return None
                moved -= self._others[k]
                means += math.nan
            elif held is not None:
                told = self._told[:, self._place[held.signal]]
                moved += math.nan if (told != held.position).any() else 0.0
                means += math.nan
            elif k in self._sized:
                moved += self._slopes[k] * change
                means += self._means[:, k] * change
            else:
                return None
        return Moves(moved, means)

    def follow(self, fault: Explained | None) -> None:
        """Once all rows that are compared are known, only what this fault shows is still wanted."""
        if self._known is None:
            return
        self._catch_up()
        k = None if fault is None else self._all.index(fault.hypothesis)
        self._bank = self._bank.part([at for at, own in enumerate(self._sized) if own == k])
        self._sized = [own for own in self._sized if own == k]
        self._held = {j: own for j, own in self._held.items() if j == k}

    def explained(self, history: History) -> list[Explained]:
        """How well each fault explains the rows; raises LinAlgError as `explain` does."""
        self._catch_up()
        if self._known is not None:
            return self._known
        if not len(self._past) == len(self._rows) >= self._again:
            found = self._found(history)
            self._known = found if len(self._rows) == MOST else None
            return found
        self._dated(history, self._found(history) if self._again else ())
        self._again = math.floor(_AGAIN * len(self._rows))
        self._bend(history)
        return self._found(history)

    def pairs(
        self, history: History, singles: Sequence[Explained]
    ) -> tuple[list[Explained], list[ExplainedPair]]:
        """How well each fault explains the rows and how well two do: see `two_at_once.pairs`.

        Two of the `singles`, each with its onset and size.
        """
        seen = self._told_by()
        rows, (others,) = self._weighed(history, seen, [self._held])
        case, drifts = Case(self._all, rows.slopes, others), drifting(self._tolerated)
        known, early = (history, history.drifted(drifts)), _early(rows.value, 1.0)
        return pairs(seen, rows, case, singles, known, early, partial(self._bent, seen))

    def _bent(self, seen: Told, changes: Mapping[int, float]) -> Array | None:
        """Slopes of hypotheses, by their numbers, up to such changes, if they are known.

        Without the samples behind the rows there are none.
        """
        if len(self._past) != len(self._rows):
            return None
        secants = self._secants(changes)
        anew = [self._begun([k], self._tried[k][0], secants).moves for k in changes]
        slopes = np.concatenate([seen.forms.of(moves) for moves in anew], axis=1)
        return slopes if (np.abs(slopes) < _HUGE).all() else None

    def _found(self, history: History) -> list[Explained]:
        """How well each fault explains the rows as they are known now."""
        rows, (others,) = self._weighed(history, self._told_by(), [self._held])
        found = Evidence(rows, history).explained([Case(self._all, rows.slopes, others)])[0]
        return [self._placed(one) for one in found]

    def _placed(self, one: Explained) -> Explained:
        """Of what stays where it was its place is told, as there is no change."""
        held = one.hypothesis.held
        if held is None or not held.stays:
            return one
        return one._replace(change=self._held[self._all.index(one.hypothesis)].beside.held.position)

    def _told_by(self) -> Told:
        """What the rows tell, as it is known by now."""
        rows, limits = zip(*self._rows, strict=True)
        return told(self._before, rows, limits)

    def _weighed(
        self, history: History, seen: Told, cases: Sequence[Mapping[int, _Held]]
    ) -> tuple[Rows, list[dict[int, Rows]]]:
        """The rows as they were told, and as they should have been told in each of some cases.

        All are compared by the same rows, at any onset.
        """
        slopes = seen.forms.of(self._moves)
        weight, sums, kin = seen.weights(seen.value), seen.forms.sums, history.shared
        shared = None if kin is None else Shared(seen.variance, sums, kin.correlations())
        rows = Rows(seen.value, weight, seen.rest, slopes, sums, shared)
        found = [{k: _instead(seen, rows, own) for k, own in held.items()} for held in cases]
        every = [(other[k], own.louder[: len(rows.value)])
                 for other, held in zip(found, cases, strict=True) for k, own in held.items()]
        for other, _ in every:
            self._unsaid |= np.isnan(other.weight[:_GROWS])
        early = _early(rows.value, _ERROR)
        for one, louder in ((rows, np.ones(1)), *every):
            one.weight[:_GROWS][self._unsaid[: len(one.weight)]] = 0.0
            one.weight[:] = 1.0 / (inverse(one.weight) + louder**2 * early)
        return rows, found

    def _dated(self, history: History, found: Sequence[Explained]) -> None:
        """Let each fault begin when it makes what was seen most probable.

        At first no onset and no size is known, and later rows tell one from the other. What was
        `found` by then leaves out the faults that no other onset makes probable.
        """
        top = max((one.evidence for one in found), default=0.0)
        behind = {one.fault for one in found if one.evidence < top - BEHIND}
        every = [k for k, one in enumerate(self._all) if one.fault not in behind]
        changes = self._changes()
        best: dict[str, tuple[float, _Begun]] = {}
        seen = self._told_by()
        onsets, numbers = self._onsets(), len(self._past) * len(every) * self._slopes.shape[1]
        at_once = max(1, _AT_ONCE // max(1, numbers))
        for start in range(0, len(onsets), at_once):
            begun = [self._begun([k for k in every if own.front in self._ways[k]], own, changes)
                     for own in onsets[start : start + at_once]]  # fmt: skip
            rows, others = self._weighed(history, seen, [
                {one.numbers.index(k): told for k, told in one.held.items()} for one in begun
            ])  # fmt: skip
            cases = [Case([self._all[k] for k in one.numbers], seen.forms.of(one.moves), told)
                     for one, told in zip(begun, others, strict=True)]  # fmt: skip
            explained = Evidence(rows, history).explained(cases)
            for trial, case in zip(begun, explained, strict=True):
                for one in case:
                    if one.fault not in best or one.evidence > best[one.fault][0]:
                        best[one.fault] = one.evidence, trial
        for trial in {own.onset: own for _, own in best.values()}.values():
            self._take(trial, [k for k in every if best[self._all[k].fault][1] is trial])

    def _onsets(self) -> list[_Onset]:
        """When and how a fault may have begun."""
        constant = 1.0 / (self._engine.bandwidth * self._engine.sample_time)
        lags = [round(lag / self._engine.sample_time) for lag in self._engine.lags]
        found = dict.fromkeys(round(constant * x) + lag for lag in lags for x in _SHIFTS)
        known = [earlier for earlier in found if earlier <= len(self._healthy)]
        ways = sorted({way for own in self._ways for way in own}, reverse=True)
        return [_Onset(n, way) for way in ways for n in known]

    def _banked(
        self,
        before: Engine,
        known: Sequence[Hypothesis],
        begin: Array | None,
        bent: Mapping[int, float],
    ) -> Bank:
        """A bank of some hypotheses about this machine, with the parameters that it has."""
        engine = before.configured(self._machine, bounds=False)
        engine.follow(before)
        return Bank(engine, known, {**self._nominal, **self._machine}, begin, bent)

    def _onset(self, earlier: int) -> tuple[Engine, Array | None]:
        """An engine so many healthy samples before the first row, and the sample before that."""
        count = len(self._healthy) - earlier
        engine = copied(self._engine)
        engine.run(self._healthy[:count])
        return engine, self._healthy[count - 1] if count else None

    def _changes(self) -> dict[int, float]:
        """What slopes are secants up to, where they are."""
        return {k: change for k, (_, change) in self._tried.items() if change is not None}

    def _begun(self, own: Sequence[int], onset: _Onset, changes: Mapping[int, float]) -> _Begun:
        """Let hypotheses, by their numbers, begin at an onset, and have the changes.

        Without all derivatives in front it is that of a machine that has always been so, but for
        what filters show of the time before; with one of them they get an impulse.
        """
        count = len(self._healthy) - onset.earlier
        always = onset.front < ALL
        before, begin = self._onset(len(self._healthy) if always else onset.earlier)
        past, healthy = self._healthy[:count], self._healthy[count:]
        samples, ends, lengths = self._since(count)
        held: dict[int, _Held] = {}
        for k in own:
            position = self._all[k].held
            if position is not None:
                place = self._place[position.signal]
                stays = staying(self._healthy[:count, place], samples[:, place])
                beside = self._told_else(before, begin, position.at(stays), position.stays)
                last, means, sound, louder = beside.rows(samples, ends, lengths)
                rows = len(self._past)
                moves, first = Moves.behind(last, means, rows), len(sound) - rows
                held[k] = _Held(beside, moves, sound[first:], louder[first:])
        sized = [k for k in own if k not in held]
        known = [self._all[k] for k in sized]
        bent = {at: changes[k] for at, k in enumerate(sized) if k in changes}
        try:
            bank = self._banked(before, known, begin, bent)
        except ValueError:  # the model cannot take one of them
            bent, bank = {}, self._banked(before, known, begin, {})
        shape = len(own), self._slopes.shape[1]
        moves = Moves(*[np.zeros((n + len(self._past), *shape)) for n in (0, LAGS)])
        if always and count:
            jumps = self._onset(onset.earlier) if onset.front else None
            bank.onset(bank.run(past, [count - 1])[0],
                       jumps and self._banked(jumps[0], known, past[-1], bent))  # fmt: skip
        if sized and self._past:
            which = [k not in held for k in own]
            found = Moves.behind(*bank.rows(samples, ends, lengths), len(self._past))
            moves.last[:, which], moves.means[:, which] = found
        elif sized:
            bank.run(healthy, ())
        bent = {sized[at]: x for at, x in bent.items()}
        return _Begun(onset, own, moves, bank, bent, held)

    def _told_else(
        self, before: Engine, begin: Array | None, held: Stuck, stays: bool
    ) -> Instead:
        """The programs told a position. Where what acts `stays`, that is near what they are told,
        and tolerances do the same in both."""
        known = () if stays else self._tolerated
        other, told = (Bank(copied(before), known, self._nominal, begin) for _ in range(2))
        return Instead(other, told, held, self._loud.beside(held))

    def _since(self, count: int) -> tuple[Array, list[int], list[int]]:
        """Samples behind so many of the healthy ones: where rows end, how many each has in all."""
        lengths = [len(row.samples) for row in self._before]
        ends = [end - 1 - count for end in accumulate(lengths)]
        first = next((k for k, end in enumerate(ends) if end >= 0), len(ends))
        start = len(self._healthy) - count - 1
        own = [len(row.samples) for row, _ in self._past]
        ends = ends[first:] + [start + end for end in accumulate(own)]
        samples = [self._healthy[count:], *[row.samples for row, _ in self._past]]
        return np.concatenate(samples), ends, lengths[first:] + self._whole(own)

    def _whole(self, lengths: Sequence[int], first: bool = True) -> list[int]:
        """How many samples rows have, the first with the healthy ones."""
        return [n + self._own * (first and k == 0) for k, n in enumerate(lengths)]

    def _take(self, begun: _Begun, numbers: Sequence[int]) -> None:
        """Go on with some of the hypotheses that have begun so."""
        sized = [k for k in begun.numbers if k not in begun.held]
        chosen = [k for k in numbers if k not in begun.held]
        self._bank.take(begun.bank.part([sized.index(k) for k in chosen]),
                        [self._sized.index(k) for k in chosen])  # fmt: skip
        for k in numbers:
            self._tried[k] = begun.onset, begun.bent.get(k)
            if k in begun.held:
                self._held[k] = begun.held[k]
        if self._past and chosen:
            which = [begun.numbers.index(k) for k in chosen]
            for mine, its in zip(self._moves, begun.moves, strict=True):
                mine[:, chosen] = its[:, which]
            self._slopes[chosen] = self._moves.last[-1, chosen]
            self._means[:, chosen] = self._moves.means[-LAGS - 1 :, chosen]

    def _catch_up(self) -> None:
        """Run the banks over the rows that wait."""
        if not self._waiting:
            return
        rows, self._waiting = self._waiting, []
        samples, ends = _joined(rows)
        lengths = self._whole([len(row.samples) for row, _ in rows], not self._rows)
        shape = self._slopes.shape
        last, means = (np.zeros((n + len(rows), *shape)) for n in (0, LAGS))
        last[:, self._sized], means[LAGS:, self._sized] = self._bank.rows(samples, ends, lengths)
        self._slopes, self._told = last[-1].copy(), rows[-1][0].samples
        self._means = np.concatenate([self._means, means[LAGS:]])[-LAGS - 1 :].copy()
        left = MOST - len(self._rows)
        for k, own in self._held.items():
            moved, total, sound, louder = own.beside.rows(samples, ends, lengths)
            total = np.concatenate([np.zeros((LAGS, *total.shape[1:])), total])
            more = Moves(moved[:left], total[: LAGS + left])
            sound = np.concatenate([own.sound, sound[:left]])
            louder = np.concatenate([own.louder, louder[:left]])
            self._held[k] = _Held(own.beside, own.moves.then(more), sound, louder)
            self._others[k] = moved[-1, 0]
        if left:
            self._moves = self._moves.then(Moves(last[:left], means[: LAGS + left]))
            self._rows += [(row._replace(samples=row.samples[:0]), x) for row, x in rows[:left]]
            self._past += rows[: max(0, BENT - len(self._past))]

    def _bend(self, history: History) -> None:
        """Let each hypothesis have the size with which it makes what was seen most probable.

        Where laws are bent what it does depends on its size. A size that is only the one that
        follows from what it does at that size may be one of several: a dead zone hides half of a
        fault. So the most probable one is looked for, in steps of its logarithm up and down, ever
        smaller ones (Hooke and Jeeves, 1961). What is far from the most probable fault when the
        first steps gain no more gets no smaller ones; not before, as far up a bent law what the
        tangent takes for the size may be nothing like it.
        """
        seen = self._told_by()
        rows, _ = self._weighed(history, seen, [])
        evidence = Evidence(rows, history)
        cases = [Case([self._all[k]], rows.slopes[:, [k]]) for k in self._sized]
        now = {k: one for k, (one,) in zip(self._sized, evidence.explained(cases), strict=True)}
        wanted = {k: one.change for k, one in now.items() if _is_clear(one)}
        best = {k: _sized(one, self._tried[k][1]) for k, one in now.items()}
        best |= {k: _Sized(math.inf, -math.inf, None) for k in wanted if best[k].change is None}
        self._larger(evidence, seen, best, wanted)
        steps = dict.fromkeys(wanted, _STEP)
        for _ in range(_ROUNDS):
            top = max(one.told for one in best.values()) - BEHIND if best else 0.0
            steps = {k: step for k, step in steps.items()
                     if step > _FINE and (step == _STEP or best[k].told >= top)}  # fmt: skip
            at = {k: best[k].change or wanted[k] for k in steps}
            before = {k: best[k] for k in steps}
            tried = [self._larger(evidence, seen, best, {k: at[k] * steps[k] ** way for k in steps})
                     for way in (1, -1)]  # fmt: skip
            for k, step in steps.items():
                if all(abs(own[k] - before[k].evidence) <= FLAT for own in tried):
                    steps[k] = 1.0  # the law is straight
                elif best[k] is before[k]:
                    steps[k] = math.sqrt(step)
        for begun in {id(one.begun): one.begun for one in best.values() if one.begun}.values():
            self._take(begun, [k for k, one in best.items() if one.begun is begun])

    def _larger(
        self,
        evidence: Evidence,
        seen: Told,
        best: dict[int, _Sized],
        changes: Mapping[int, float],
    ) -> dict[int, float]:
        """The evidence of hypotheses with other changes, and what is `best` where it is more.

        Where the laws have no value with a change, it has none.
        """
        found = dict.fromkeys(changes, -math.inf)
        changes = self._secants(changes)
        for onset in dict.fromkeys(self._tried[k][0] for k in changes):
            own = [k for k in changes if self._tried[k][0] == onset]
            begun = self._begun(own, onset, changes)
            slopes = seen.forms.of(begun.moves)
            sound = {k: at for at, k in enumerate(own)
                     if (np.abs(slopes[:, at]) < _HUGE).all()}  # fmt: skip
            cases = [Case([self._all[k]], slopes[:, [at]]) for k, at in sound.items()]
            for k, (one,) in zip(sound, evidence.explained(cases) if cases else (), strict=True):
                found[k] = one.evidence
                trial = _sized(one, begun.bent.get(k), begun)
                if best[k].less_than(trial):
                    best[k] = trial
        return found

    def _secants(self, changes: Mapping[int, float]) -> dict[int, float]:
        """The changes that are large enough for a secant, as far as a parameter may go."""
        return {
            k: self._within(k, change)
            for k, change in changes.items()
            if abs(change) >= _SMALL * self._all[k].usual
        }

    def _within(self, k: int, change: float) -> float:
        """The change, of a parameter that is not declared zero as far as it keeps sign and size."""
        hypothesis = self._all[k]
        nominal = self._nominal[hypothesis.fault] if hypothesis.kind == "value" else 0.0
        if not nominal or hypothesis.zero:
            return change
        return float((1.0 - np.clip(1.0 - change / nominal, _LEFT, _LARGEST)) * nominal)


def _instead(seen: Told, rows: Rows, held: _Held) -> Rows:
    """Rows as they would be if a position was told that is held.

    They have the noise that they have there, and where that is another they stand at zero, with
    slopes of their own. Those that have no value yet, in the first rows, have no weight (NaN).
    """
    moved = seen.forms.of(held.moves)
    louder = held.louder[: len(rows.value)]
    same = louder == 1.0  # its unit
    value = rows.value + moved[:, 0] + np.where(same, 0.0, seen.level)
    weight = seen._replace(noise=louder * seen.noise, bound=louder * seen.bound,
                           doubt=louder * seen.doubt).weights(value)  # fmt: skip
    weight[rows.weight == 0] = 0.0
    weight[:_GROWS][~held.sound[:_GROWS] & (rows.weight[:_GROWS] > 0)] = np.nan
    rest = np.where(same[:, None], rows.rest, 0.0)
    rest[:, : moved.shape[1] - 1] += moved[:, 1:]
    return Rows(value, weight, rest, rows.slopes[:, :0], rows.alone, rows.shared)


def _joined(rows: Sequence[tuple[Row, Array]]) -> tuple[Array, list[int]]:
    """The samples of rows, one after the other, and the number of the last one of each."""
    ends = accumulate(len(row.samples) for row, _ in rows)
    return np.concatenate([row.samples for row, _ in rows]), [end - 1 for end in ends]


def _sized(one: Explained, change: float | None, begun: _Begun | None = None) -> _Sized:
    return _Sized(_apart(change, one.change), one.evidence, change, begun)


def _apart(change: float | None, found: float) -> float:
    """How far a change is from the one that is found with the secant up to it: the logarithm of
    their ratio beyond that of sizes that are compared at first, 0 for a tangent.

    What a law does at a size tells of changes of about that size. Far up a law that flattens a
    secant is no more than a hint of a fault, and a small part of it explains what a fault of that
    part would not do.

    >>> _apart(2.0, 1.5), round(_apart(2.0, 8.0), 3), _apart(2.0, -1.0)
    (0.0, 0.693, inf)
    """
    if change is None:
        return 0.0
    ratio = found / change
    return max(0.0, abs(math.log(ratio)) - math.log(_STEP)) if ratio > 0.0 else math.inf


def _is_clear(one: Explained) -> bool:
    """Whether a change is large and clear enough for a secant."""
    least = max(_SMALL * one.hypothesis.usual, _CLEAR * one.deviation)
    return least <= abs(one.change) < math.inf


def _early(values: Array, error: float) -> Array:
    """Variances for not knowing the onset to the sample, of residuals (rows, residuals) since."""
    size = np.abs(values[:_GROWS]).max(axis=0, initial=0.0)
    return np.asarray((np.outer(error * _FADES ** np.arange(len(values)), size)) ** 2)
