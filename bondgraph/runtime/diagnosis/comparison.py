"""Every fault beside what was seen since it began, each with what it would have done since then."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from bondgraph.runtime.diagnosis.hypotheses import Bank, Hypothesis, Instead
from bondgraph.runtime.diagnosis.isolation import (
    Explained,
    ExplainedPair,
    History,
    Rows,
    explain,
    explain_pairs,
    inverse,
)
from bondgraph.runtime.diagnosis.rows import Row, weight
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Engine, copied

#: Time constants of the filter, beside delays, that a residual may show late what has happened.
_SHIFTS = (0.0, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0)
_MOST = 600  # rows that are compared: by then it is known as well as it will be
_BENT = 60  # rows with whose samples onsets and sizes are looked for, while there are no more
_ROUNDS = 8  # of looking for them
_SMALL = 0.02  # of the usual change: for less a tangent does
_CLEAR = 2.0  # standard deviations of a change that it is worth a secant
_LEFT, _LARGEST = 0.05, 20.0  # of a parameter: values between which a secant is taken
_SAME = 0.01  # share by which changes of two rounds may differ
_STEEP = 0.8  # of how one change makes the next: steeper, a step is not made longer
_ERROR = 0.1  # of the residual, in the first row: a filter shows late when the fault began
_FADES = 0.4  # what is left of that in every row after
_SHOWS = 0.3  # of what a fault usually does: where it does less it may be there unseen
_GROWS = 3  # rows within which a residual has become as large as the fault makes it


class Comparison:
    """Begins at the onset: `engine` stands before samples that look healthy.

    The last `own` of these are of the first row that is compared. A filter shows late what happens,
    and what looks like one fault now looks like another that began a little earlier: once there is
    something to go by, each fault gets the onset that suits it best. And laws may be bent: where a
    fault is as large as the samples say, its slope is not that of a small one. So each is tried
    again then with its own size. A switch that is stuck has no size: beside the rows as they were
    told stand those that it would have made of the same samples. What is `tolerated` is so in both.
    """

    def __init__(
        self,
        engine: Engine,
        healthy: Array,
        own: int,
        hypotheses: Sequence[Hypothesis],
        nominal: Mapping[str, float],
        tolerated: Sequence[Hypothesis] = (),
    ) -> None:
        self._engine = copied(engine)
        self._healthy, self._own = healthy, own
        self._all, self._nominal = tuple(hypotheses), nominal
        self._sized = [k for k, h in enumerate(self._all) if h.held is None]
        self._tolerated = tuple(tolerated)
        self._changes: dict[int, float] = {}
        self._earlier = [0] * len(self._all)  # healthy samples that come behind the onset
        self._banks, self._instead = self._started({})
        self._past: list[tuple[Row, Array]] = []  # with the noise of each residual
        self._rows: list[Rows] = []
        self._others: list[dict[int, Rows]] = []  # by the number of what is held
        self._unsaid = np.zeros((_GROWS, len(engine.residuals)), dtype=bool)
        self._slopes = np.zeros((len(self._all), len(engine.residuals)))  # of the last row
        self._told = np.zeros((0, len(engine.signals)))  # samples of the last row
        self._place = {k.path: at for at, k in enumerate(engine.signals)}
        self._again = 0  # rows with which secants are looked for again

    def __len__(self) -> int:
        return len(self._rows)

    def has(self, row: Row) -> bool:
        """Whether this row was the last one."""
        return bool(self._rows) and self._rows[-1].value is row.value

    def step(self, row: Row, sigma: Array) -> None:
        """One more row, and the noise (standard deviations) of its residuals."""
        if not self._rows:
            row = row._replace(samples=row.samples[self._own :])
        if len(self._past) < _BENT:
            self._past.append((row, sigma.copy()))
        one, others = self._seen(row, sigma, len(self._rows))
        self._slopes, self._told = one.slopes, row.samples
        if len(self._rows) < _MOST:
            self._rows.append(one)
            self._others.append(others)

    def shows(self, fault: Explained) -> Mask:
        """Which residuals the fault moves in the last row as it usually does.

        Where something is held at a position that it is told to be in, nothing shows it.
        """
        held = fault.hypothesis.held
        if held is not None:
            told = self._told[:, self._place[held.signal]]
            return np.full(self._slopes.shape[1], bool((told != held.position).any()))
        k = self._all.index(fault.hypothesis)
        usual = np.sqrt(np.mean([np.square(row.slopes[k]) for row in self._rows], axis=0))
        return np.asarray(np.abs(self._slopes[k]) >= _SHOWS * usual)

    def explained(self, history: History) -> list[Explained]:
        """How well each fault explains the rows; raises LinAlgError as `explain` does."""
        if not len(self._past) == len(self._rows) >= self._again:
            return self._found(history)
        if not self._again:
            self._dated(history)
        found = self._found(history)
        self._again = 2 * len(self._rows)
        before: dict[int, tuple[float, float]] = {}
        for _ in range(_ROUNDS):
            wanted = self._bent(found)
            if _alike(wanted, self._changes):
                break
            tried = {k: (self._changes.get(k, 0.0), change) for k, change in wanted.items()}
            self._try({k: self._next(k, before.get(k), tried[k]) for k in wanted})
            found, before = self._found(history), tried
        return found

    def pairs(self, history: History, singles: Sequence[Explained]) -> list[ExplainedPair]:
        """How well two of the `singles` at once explain the rows, with the onsets of these."""
        return explain_pairs(self._tables()[0], self._all, history, singles)

    def _found(self, history: History) -> list[Explained]:
        """How well each fault explains the rows as they are known now."""
        rows, others = self._tables()
        return explain(rows, self._all, history, others)

    def _tables(self) -> tuple[Rows, dict[int, Rows]]:
        """The rows as they were told, and as they should have been told, by hypothesis."""
        rows = _stacked(self._rows)
        others = {k: _stacked([own[k] for own in self._others]) for k in self._instead}
        for other in others.values():
            self._unsaid |= np.isnan(other.weight[:_GROWS])
        early = _early(rows.value)
        for one in (rows, *others.values()):  # all are compared by the same rows, at any onset
            one.weight[:_GROWS][self._unsaid] = 0.0
            one.weight[:] = 1.0 / (inverse(one.weight) + early)
        return rows, others

    def _dated(self, history: History) -> None:
        """Let each fault begin when it makes what was seen most probable."""
        best: dict[str, tuple[float, int]] = {}
        constant = 1.0 / (self._engine.bandwidth * self._engine.sample_time)
        lags = [round(lag / self._engine.sample_time) for lag in self._engine.lags]
        for earlier in dict.fromkeys(round(constant * x) + lag for lag in lags for x in _SHIFTS):
            if earlier <= len(self._healthy):
                self._earlier = [earlier] * len(self._all)
                self._try({})
                for one in self._found(history):
                    known = best.get(one.fault)
                    if known is None or one.evidence > known[0]:
                        best[one.fault] = one.evidence, earlier
        self._earlier = [best[h.fault][1] for h in self._all]
        self._try({})

    def _started(
        self, changes: Mapping[int, float]
    ) -> tuple[list[tuple[list[int], Bank]], dict[int, Instead]]:
        """Banks at the first row, one for each onset, with the numbers of their hypotheses.

        And what has no slopes, by its number.
        """
        banks: list[tuple[list[int], Bank]] = []
        instead = {}
        for earlier in dict.fromkeys(self._earlier):
            own = [k for k in self._sized if self._earlier[k] == earlier]
            engine = copied(self._engine)
            count = len(self._healthy) - earlier
            engine.run(self._healthy[:count])
            begin = self._healthy[count - 1] if count else None
            known = [self._all[k] for k in own]
            bent = {at: changes[k] for at, k in enumerate(own) if k in changes}
            for k, one in enumerate(self._all):
                if one.held is not None and self._earlier[k] == earlier:
                    other = Bank(copied(engine), self._tolerated, self._nominal, begin)
                    instead[k] = Instead(other, one.held)
                    instead[k].run(self._healthy[count:])
            bank = Bank(engine, known, self._nominal, begin, bent)
            bank.run(self._healthy[count:])
            banks.append((own, bank))
        return banks, instead

    def _seen(self, row: Row, sigma: Array, number: int) -> tuple[Rows, dict[int, Rows]]:
        """A row with what each hypothesis does to it, and what it is instead where one holds.

        Residuals that have no value instead yet, in the first rows, have no weight (NaN) in any.
        """
        slopes = np.zeros((len(self._all), len(self._engine.residuals)))
        for own, bank in self._banks:
            slopes[own] = bank.run(row.samples)[-1]
        told = Rows(row.value, weight(row, sigma), row.slopes, slopes)
        others = {}
        for k, instead in self._instead.items():
            value, valid, rest, moved = instead.run(row.samples)
            other = weight(row._replace(value=value, valid=valid), sigma)
            other[told.weight == 0] = 0.0
            other[~valid & (told.weight > 0)] = np.nan
            new = moved if number < _GROWS else moved & valid
            others[k] = Rows(
                np.where(new, value, told.value),
                np.where(new, other, told.weight),
                np.where(new, rest, told.rest),
                slopes[:0],
            )
        return told, others

    def _bent(self, found: Sequence[Explained]) -> dict[int, float]:
        """Changes that are large and clear enough for a secant, by number of the hypothesis."""
        changes = {}
        for one in found:
            size = abs(one.change)
            least = max(_SMALL * one.hypothesis.usual, _CLEAR * one.deviation)
            if least <= size < np.inf and one.hypothesis.held is None:
                k = self._all.index(one.hypothesis)
                changes[k] = self._within(k, one.change)
        return changes

    def _next(self, k: int, before: tuple[float, float] | None, now: tuple[float, float]) -> float:
        """The change to try next, from what was tried and what came of it (Steffensen)."""
        change, wanted = now
        if before is not None and before[0] != change:
            slope = (wanted - before[1]) / (change - before[0])
            found = (wanted - slope * change) / (1.0 - slope) if abs(slope) <= _STEEP else wanted
            if abs(found) >= _SMALL * self._all[k].usual:
                wanted = found
        return self._within(k, wanted)

    def _within(self, k: int, change: float) -> float:
        """The change, of a parameter only as far as it keeps its sign and size."""
        hypothesis = self._all[k]
        nominal = self._nominal[hypothesis.fault] if hypothesis.kind == "value" else 0.0
        if not nominal:
            return change
        return float((1.0 - np.clip(1.0 - change / nominal, _LEFT, _LARGEST)) * nominal)

    def _try(self, changes: dict[int, float]) -> None:
        """The rows again, with slopes as far as the changes go."""
        try:
            started = self._started(changes)
        except ValueError:  # the model cannot take one of them
            started, changes = self._started({}), {}
        (self._banks, self._instead), self._changes = started, changes
        for k, (row, sigma) in enumerate(self._past):
            self._rows[k], self._others[k] = self._seen(row, sigma, k)


def _stacked(rows: Sequence[Rows]) -> Rows:
    return Rows(*[np.array(x) for x in zip(*rows, strict=True)])


def _alike(left: Mapping[int, float], right: Mapping[int, float]) -> bool:
    return left.keys() == right.keys() and all(
        abs(left[k] - right[k]) <= _SAME * abs(left[k]) for k in left
    )


def _early(values: Array) -> Array:
    """Variances for not knowing the onset to the sample, of residuals (rows, residuals) since."""
    size = np.abs(values[:_GROWS]).max(axis=0, initial=0.0)
    return np.asarray((np.outer(_ERROR * _FADES ** np.arange(len(values)), size)) ** 2)
