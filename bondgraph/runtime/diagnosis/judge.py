"""What is wrong: faults compared since the onset, and what is told of them when that is news."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from bondgraph.runtime.diagnosis.comparison import Comparison
from bondgraph.runtime.diagnosis.healthy import DiagnosisModel, as_it_is
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis, Sizes, hypotheses, sized
from bondgraph.runtime.diagnosis.isolation import Explained
from bondgraph.runtime.diagnosis.naming import (
    LONGEST,
    Judgement,
    Latched,
    classes,
    named,
    news,
    update,
)
from bondgraph.runtime.diagnosis.onset import Onset, onset_again
from bondgraph.runtime.diagnosis.possible import candidates, explains, fits, possible, suspects
from bondgraph.runtime.diagnosis.row_sums import Moves
from bondgraph.runtime.diagnosis.rows import Row
from bondgraph.runtime.diagnosis.two_at_once import OneOrTwo, one_or_two, pairs_that_can
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.runtime.monitoring.verdict import Verdict

_JUDGE = 5  # rows after an alarm before a fault is named
_OFTEN = 10  # rows after it until when each row is judged
_AGAIN = 5  # rows between later judgements, at least
_MORE = 8  # of what is known: so many a part has to be new for a further judgement
_UNEXPLAINED = 20  # rows of an alarm that no single fault explains: the first are not sure


class Judge:
    """Compares faults while an alarm is `latched`; between alarms it learns how large signals are.

    `limits` are those of each residual, by whose noise rows are weighed, `tolerated` what their
    slopes are about.
    """

    def __init__(self, engine: Engine, model: DiagnosisModel) -> None:
        self._engine, self._model = engine, model
        self._all = tuple(dict.fromkeys((*model.faults, *model.switches)))
        self._sizes = Sizes(engine)
        #: Columns of signals; where encoders stand says nothing of how far a share takes them.
        self._places = {k.path: at for at, k in enumerate(engine.signals) if k.counts is None}
        self._values: dict[str, float] = {}  # of signals, in the last row
        self.latched: Latched | None = None
        self.restart()

    def restart(self) -> None:
        """The residuals begin anew; the alarm stays."""
        self._compared: Comparison | None = None
        self._after = self._told = 0  # rows since the alarm, and until the last update
        self._two = OneOrTwo()  # whether one fault is enough to explain what was seen, or two do
        self._due = 0  # rows since the alarm when that is asked again
        self._fitted = False  # whether one fault did fit when it was asked
        self._next = _JUDGE  # and when faults are judged again
        self._fired: frozenset[str] = frozenset()  # that the last judgement was of
        self._best: Explained | None = None  # the fault that explains all, if any
        self._leads: tuple[str, ...] = ()  # the class that the last judgement found best
        self._wanted: Judgement | None = None  # what the last judgement would have said
        self._verdict: Verdict | None = None  # what was said last of this alarm

    @property
    def waits(self) -> bool:
        """Whether a fault may be named that has not been yet, with a few rows more."""
        return not self.said and self._after < _JUDGE + 2

    @property
    def said(self) -> bool:
        """Whether it was told what the fault can be."""
        return self.latched is not None and self.latched.said is not None

    @property
    def silent(self) -> bool:
        """Whether nothing was told of what the alarm is about."""
        return self.latched is not None and not (self.said or self.latched.itself)

    @property
    def best(self) -> str | None:
        """The fault that explains all, if there is one."""
        return None if self._best is None else self._best.fault

    def moves(self) -> Moves | None:
        """By how much what explains all, one fault or two, moves each residual now, if known.

        The last sample of the row, and its average with those of LAGS rows before.
        """
        if self._compared is None:
            return None
        if self._two.pairs:
            two = self._two.pairs[0]
            return self._compared.moves(zip(two.hypotheses, two.changes, strict=True))
        best = self._best
        return None if best is None else self._compared.moves([(best.hypothesis, best.change)])

    def wrong(self, history: History) -> Explained | None:
        """The fault that explains all, as it is known by now."""
        if self._best is None or self._compared is None:
            return None
        try:
            found = self._compared.explained(history, (self._best.fault,))
        except np.linalg.LinAlgError:
            return None
        return next((one for one in found if one.fault == self._best.fault), None)

    def succeed(self, other: Judge) -> None:
        """Take over what another one has learned of signals."""
        self._sizes = other._sizes

    def leave_out(self, since: float, which: Mask) -> None:
        """Nothing is to be told by some residuals since a time."""
        if self._compared is not None:
            self._compared.leave_out(since, which)

    def beside(self, other: Verdict) -> Verdict:
        """Another verdict of the same alarm, that leaves standing what it was told the fault is."""
        assert self.latched is not None and self.latched.said is not None
        message = f"{other.message}; what was said of the alarm stays said"
        last = self._verdict or other._replace(group=self.latched.said.group, candidates=())
        return last._replace(time=other.time, residuals=other.residuals, message=message)

    def learn(self, samples: Array) -> None:
        """Further (n, signals) samples, one after the other."""
        self._sizes.add(samples)

    def latch(self, since: float) -> None:
        """There is an alarm, for something that began at this time."""
        self.latched, self._wanted, self._verdict = Latched(since), None, None

    def by_itself(self) -> None:
        """It was told that a signal is unusual by itself."""
        if self.latched is not None:
            self.latched = self.latched._replace(itself=True)

    def renew(self) -> None:
        """There is more to go by than before: compare anew, and do not wait to tell it."""
        self._compared = None
        if self.latched is not None:
            self.latched = self.latched._replace(times=0)

    def clear(self) -> None:
        """What was wrong is over."""
        self._compared, self.latched = None, None

    def compare(
        self, began: Onset, limits: Array, tolerated: Sequence[Hypothesis], history: History
    ) -> None:
        """Begin to compare faults behind their onset."""
        model = self._model
        self._after = self._told = self._due = 0
        self._next = _JUDGE
        self._best, self._two = None, OneOrTwo()
        sizes = self._sizes.found()
        found = hypotheses(
            self._engine, model.faults, model.units, sizes, model.switches, True, model.signs
        )
        samples = np.concatenate([began.healthy, *[row.samples for row in began.rows]])
        found = sized(began.engine, found, model.nominal, samples)
        machine = as_it_is(tolerated, model.nominal, history)
        self._compared = Comparison(
            began.engine, began.healthy, began.own, found, model.nominal, tolerated, machine,
            model.dynamic, began.before,
        )  # fmt: skip
        for row in began.rows:
            self._compared.step(row, limits)

    def step(
        self,
        row: Row,
        past: Sequence[Row],
        limits: Array,
        tolerated: Sequence[Hypothesis],
        history: History,
    ) -> bool:
        """One more row, the last of the `past`; False while there is none to begin with."""
        if self._compared is None:  # after a restart
            assert self.latched is not None
            began = onset_again(row.time, self.latched.since, limits, past)
            if began is None:
                return False
            self.compare(began, limits, tolerated, history)
        assert self._compared is not None
        if not self._compared.has(row):
            self._compared.step(row, limits)
        if len(row.samples):
            self._values = {path: float(row.samples[-1, at]) for path, at in self._places.items()}
        self._after += 1
        return True

    def verdict(
        self, time: float, levels: Mapping[str, float], noise: Mapping[str, float], history: History
    ) -> Verdict | None:
        """The fault by name when there is enough to go by, and again when that changes.

        `levels` are those of the residuals that have fired, `noise` is infinite where nobody knows
        it.
        """
        if self.latched is None or not self._compared or not self._judges(frozenset(levels)):
            return None
        model = self._model
        try:
            found = self._explained(history, levels, suspects(self._all, model.sees, levels))
            if all(e.evidence == -math.inf for e in found):
                found = self._explained(history, levels, self._all)
        except np.linalg.LinAlgError:
            return None
        group, leads = named(found, classes(model.groups, model.sees, noise))
        sure, self._leads = group if leads == self._leads else (), leads
        if group and not sure and self.latched.said is None and self._after == _JUDGE:
            return None  # the next row may confirm it
        most = max(found, key=lambda e: e.evidence, default=None)
        if most is not None and explains(found):
            self._best = most
            self._compared.follow(most)
        elif self._after < _UNEXPLAINED:
            return None
        else:
            self._best = None  # what explained fewer rows does not explain these
        if most is not None and self._after >= _UNEXPLAINED:
            self._ask_for_two(history, levels, fits(most))
            sure = sure if self._two.alone else ()
        doubles = model.doubles() if self._two.pairs or sure else None
        verdict = update(time, self.latched.since, levels, sure, found, self._two, doubles)
        best = verdict.candidates[0] if verdict.candidates and not verdict.pairs else None
        two = verdict.pairs[0].faults if verdict.pairs else ()
        wanted = Judgement(sure, None, two)
        if best is not None:
            (one,) = [e for e in found if e.fault == best.fault]
            wanted = Judgement(sure, best.fault, two, best.size, best.unit, 0.0, best.probability,
                               one.hypothesis.kind)  # fmt: skip
        # what was said before of a signal, as it would be off by that now
        now = self._values.get(wanted.fault or "", 0.0), time - self.latched.since
        wanted = wanted.at(*now)
        before, told = (None if one is None else one.at(*now)
                        for one in (self._wanted, self.latched.said))  # fmt: skip
        latched = self.latched._replace(said=told)
        again = before is not None and before.says(wanted)
        if before is not None and told is not None:
            again &= before.grown(told) or not wanted.grown(told)
            again &= before.surer(told) or not wanted.surer(told)
        self._wanted = wanted
        if not news(latched, wanted, again, self._after - self._told):
            if news(latched, wanted, True, LONGEST):  # to be told, once that is confirmed
                self._next = min(self._next, self._after + _AGAIN)
            return None
        self.latched = self.latched._replace(said=wanted, times=self.latched.times + 1)
        self._told, self._verdict = self._after, verdict
        return verdict

    def _judges(self, fired: frozenset[str]) -> bool:
        """Whether this row is judged: there is enough more to go by, or another residual fired."""
        due = self._after >= self._next
        due |= self._after > _JUDGE and fired != self._fired and self._after % _AGAIN == 0
        if due:
            step = 1 if self._after < _OFTEN else max(_AGAIN, self._after // _MORE)
            self._next, self._fired = self._after + step, fired
        return due

    def _explained(
        self, history: History, fired: Mapping[str, float], faults: Sequence[str]
    ) -> list[Explained]:
        """How well these faults and perhaps others explain the rows; see `candidates`."""
        assert self._compared is not None
        found = self._compared.explained(history, faults)
        model = self._model
        return candidates(found, model.faults, model.sees, fired, model.signs)

    def _ask_for_two(self, history: History, fired: Mapping[str, float], one: bool) -> None:
        """See whether two at once explain more than one fault, that fits or not; ever less often.

        Two of those that move what has fired. A fault that fits is enough, unless two are more
        probable that look like no single fault.
        """
        if self._compared is None or (self._after < self._due and one == self._fitted):
            return
        self._due, self._fitted, model = 2 * self._after, one, self._model
        moving = {fault for name in fired for fault in model.sees.get(name, ())}
        if one and not model.doubles().like_none(moving):
            self._two = OneOrTwo()
            return
        try:
            found = self._compared.explained(history, [f for f in self._all if f in moving])
            alone, pairs = self._compared.pairs(history, found)
        except np.linalg.LinAlgError:
            return
        whole = candidates(found, model.faults, model.sees, fired, model.signs)
        can = {e.fault for e in whole if e.evidence > -math.inf}
        alone = [possible(e, model.faults.get(e.fault), model.signs.get(e.fault))
                 for e in alone if e.fault in can]  # fmt: skip
        pairs = pairs_that_can(pairs, model.faults, model.sees, fired, model.signs)
        self._two = one_or_two(alone, pairs, one, model.doubles)
