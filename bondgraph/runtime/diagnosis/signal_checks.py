"""What a signal shows by itself: spikes, bursts of noise, a value that stands still.

No parameter of a machine changes for one sample, and no machine makes the noise of an instrument.
So these are told of the signal, by what it was like while all was well, without a model.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Collection, Container, Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np

from bondgraph.runtime.diagnosis.following import Following
from bondgraph.runtime.diagnosis.held_readings import HeldReadings
from bondgraph.runtime.diagnosis.input_moves import InputMoves
from bondgraph.runtime.diagnosis.rare_steps import answered, answers, rare_steps, sizes
from bondgraph.runtime.diagnosis.rows import PAUSE, away
from bondgraph.runtime.diagnosis.sensor_jumps import ENOUGH, OUT, far_out
from bondgraph.runtime.diagnosis.standing_encoders import StandingEncoders
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.plain import array, numbers
from bondgraph.text.tuples import NamedTuple

_MOST = 5000  # after which nothing more is learned of it
_FLOOR = 0.02  # of the range of a signal: what is smaller matters to nothing
_NOISY = 0.003  # rough beside its own motion, in any healthy row: noise that would be missed
_MANY = 100  # rows that tell how rough a signal may become: with fewer, half as much again
_ALONE = 3.0  # times as far out as all around it: a spike is alone
# Samples to either side that are around it. A machine that rings as far as its range has peaks that
# are less than `_FLOOR` of it above the next samples, from 22 samples a period on, two half-waves.
_AROUND = 11
_ROUGHER = 2.0  # times as rough, beside its own motion, as any row was
_WHITE = 0.7  # so rough beside its own motion is white noise at least: 0.8 or more
_CHANGES = 0.3  # share of the samples that differ from the last, at any time in a noisy signal
_SHARE = 50  # samples of which such a share is taken: of 15 one that is 0.5 falls to 0.2
_STILL = 5.0  # times as long as it ever stood still
_LEAST = 20  # samples that it has to stand still for
_QUIET = 3  # rows after which it is as it was; a spike with the one behind it
_WAIT = 3  # rows that have to be usual behind one whose noise is: a burst begins in the middle
_AFTER = 10  # rows until which residuals may be out by it
_SIDE = 2  # samples to either side that a sample is compared with
_SMOOTH = (2 / 3, -1 / 6)  # weights of these: what a cubic through them is between them


class Unusual(NamedTuple):
    """Something that a signal shows: which, what (`spike`, `burst` or `stuck`), and since when (s).

    `now` is how far out it is and `before` the most that it was while all was well: of a spike or
    a burst in shares of its range then, of a signal that stands still in samples. Of an encoder
    that does it is known which `other` goes on.
    """

    signal: str
    kind: str
    since: float
    now: float
    before: float
    other: str = ""

    @property
    def text(self) -> str:
        """In words.

        >>> print(Unusual("y", "spike", 3.0, 0.25, 0.004).text)
        a spike of y by 25 % of its range, 0.4 % at most while the machine was well
        """
        if self.other:
            return f"{self.signal} stands still while {self.other} goes on"
        if self.kind == "stuck":
            text = f"{self.signal} stands still for {self.now:.0f} samples, {self.before:.0f}"
        else:
            what = "a spike" if self.kind == "spike" else "a burst of noise"
            text = f"{what} of {self.signal} by {100 * self.now:.3g} % of its range,"
            text += f" {100 * self.before:.2g} %"
        return f"{text} at most while the machine was well"


class SignalChecks:
    """Looks at the samples row by row; `names` are the signals, by the column `at` of the samples.

    Each sample is compared with what its neighbours on both sides let expect, by weights that fit
    the healthy signal best, and with their median: a step is far from the first, the peak of an
    oscillation from the second, a spike from both. A step that overshoots for one sample, as the
    current that a command drives, is far from both too: what the neighbours let expect is off
    behind it and before it to opposite sides. A signal without a value (NaN) shows nothing, and
    does not keep others from being looked at.

    `inputs` drive the machine: they may jump and be rough as never before, and so may sensors
    then: noise of these is told some rows later only, and a spike if it is farther out than such a
    move makes it. What an input shows so is not told by itself; whether it is wrong residuals say.
    Nor does one stand still that is as large as ever, or as small: controllers are limited, and a
    sensor of a machine that was switched off by it reads the same. Where one of
    them, or one of the `modes` by their columns, makes a step that is rare, a sensor may answer
    with a peak of a sample or two, as the current into a capacitor that is switched on: no spike
    is looked for there, until enough such answers are known: then one twice as far out as any of
    them is a spike, and behind a step that is larger than ever one that is as much farther out than
    the signal ever was. Of `encoders`, by their columns, is told which stands still while others go
    on. `passed_on` says what relations make of a sample (see `input_moves.passed_on`).
    """

    def __init__(
        self, names: Sequence[str], at: Sequence[int], sample_time: float,
        inputs: Container[str] = (), encoders: Mapping[str, int] = MappingProxyType({}),
        modes: Sequence[int] = (), pause: int = PAUSE,
        passed_on: Callable[[Array, Array], Array] | None = None,
    ) -> None:  # fmt: skip
        self._pause = pause
        self._encoders = StandingEncoders(encoders)
        self._names, self._at, self._step = tuple(names), list(at), sample_time
        self._inputs, self._follows = inputs, Following(len(self._names), passed_on)
        self._drive = np.array([name in inputs for name in self._names], dtype=np.bool_)
        self._steer = [*np.array(self._at, dtype=int)[self._drive].tolist(), *modes]
        count = len(self._names)
        self._held = HeldReadings(count, len(modes), _SIDE)
        self._seen: list[tuple[Array, Array]] = []  # healthy samples until weights are known
        self._weights = np.empty((0, 2))  # (signals, 2): of the nearest and the next ones
        self._samples = np.zeros(count)  # that were learned from
        self._rows = np.zeros(count)  # the same in rows
        self._far = np.zeros(count)  # largest spike when healthy
        self._answer = np.zeros((2, count))  # largest to a rare step of a command; samples of such
        self._stepped = np.zeros(len(self._steer))  # largest step of each command that was answered
        self._rough = np.zeros((2, count))  # of a healthy row: roughness, and beside its motion
        self._calm = np.full(count, math.inf)  # roughness of the smoothest row, beside its motion
        self._range = np.array([np.full(count, math.inf), np.full(count, -math.inf)])
        self._moves = InputMoves(self._drive)
        self._still = np.zeros(count)  # longest run of equal values that has ended
        self._least = np.ones(count)  # share of the samples that differ from the last
        self._differ = np.zeros((2, count))  # of the healthy rows since the last share: such, all
        self.active: dict[str, Unusual] = {}
        self._away: dict[str, int] = {}  # rows since it was unusual last
        self._needed: dict[str, int] = {}  # rows that it has to be away for
        self._driven = PAUSE  # rows since an input was as never before
        self.restart()

    def restart(self) -> None:
        """The samples begin anew."""
        self._last = np.empty((0, len(self._names)))
        self._steered = np.empty((0, len(self._steer)))  # commands and modes of these samples
        self._run = np.zeros(len(self._names))
        self._tail = np.empty((0, len(self._names)))
        self._bends = np.zeros((1, len(self._names)))  # beside the middle of the nearest samples
        self._waiting: deque[Array] = deque()  # as `_rough`, of the last healthy rows
        self._path = np.full((_LEAST, len(self._names)), math.nan)  # before each stood still last
        self._before = np.zeros((_AROUND, len(self._names)))  # how far out the last samples were
        #: Of the last rows: whether a signal was louder than ever, and so much that it is unusual.
        self._loud = np.zeros((_AFTER, 2, len(self._names)), dtype=np.bool_)
        self._held.restart()
        self._encoders.restart()

    def row(
        self, time: float, samples: Array, healthy: bool, suspects: Collection[str] = ()
    ) -> list[Unusual]:
        """What begins to be unusual in a row, (n, all signals), that ends at a time (s).

        An encoder is told of if it is one of the `suspects`, as machines stand still as well. So is
        noise that is small beside the range of its signal, if no other signal is louder than ever.
        """
        found, driven = self._alone(time, samples, healthy, suspects)
        for name, one in self._encoders.row(samples, healthy, suspects).items():
            since = time - (one.samples - 1) * self._step
            found[name] = Unusual(name, "stuck", since, float(one.samples), 0.0, one.other)
        return self._begun(found, driven)

    def _alone(
        self, time: float, samples: Array, healthy: bool, suspects: Collection[str]
    ) -> tuple[dict[str, Unusual], Container[str]]:
        """What signals show each by itself, and inputs that move as never before."""
        own = np.where(np.isfinite(samples), samples, math.nan)[:, self._at]
        self._full = samples[0]
        with_last = np.concatenate([self._last, own])
        steered = np.concatenate([self._steered, samples[:, self._steer]])
        runs, ended, changes = self._runs(own, samples[:, self._steer])
        self._last, self._steered = with_last[-4 * _SIDE :], steered[-4 * _SIDE :]
        if not self._names or len(with_last) < 4 * _SIDE + 1:
            return {}, ()
        if not len(self._weights):
            self._first(own, steered[-len(own) :], healthy)
            return {}, ()
        far, rough, moved, where = self._looked_at(with_last, steered)
        found = {}
        top = np.fmax(self._range[1], own.max(axis=0))
        bottom = np.fmin(self._range[0], own.min(axis=0))
        span = top - bottom
        kinds = self._unusual(far, rough, moved, runs, span, self._matters(rough, suspects))
        kinds["stuck"][0][self._rests(own[-1], runs, top, bottom, suspects)] = False
        for kind, (out, now, before) in kinds.items():
            for k in np.flatnonzero(out & (self._samples >= ENOUGH)).tolist():
                late = len(with_last) - 1 - where[k] if kind == "spike" else len(own) - 1
                late = runs[k] - 1 if kind == "stuck" else late
                since = time - float(late) * self._step
                one = Unusual(self._names[k], kind, since, float(now[k]), float(before[k]))
                found[one.signal] = one
        driven = {n for n, one in found.items() if one.kind != "stuck" and n in self._inputs}
        sensors = {n for n in (*found, *self.active) if n not in self._inputs}
        causes = self._causes(driven, sensors & {*self._names})
        found = {n: one for n, one in found.items() if n not in driven}
        moved_anew = np.isin(self._names, list(driven))
        if causes:  # what inputs do is what a controller makes of it
            driven = set()
        with np.errstate(invalid="ignore"):  # of a signal of which nothing is known
            before = self._range[1] - self._range[0]
            beyond = (span > 2.0 * before) & (span > 0.0)  # as far as all that it did before
        beyond &= self._drive & (self._samples >= ENOUGH)
        self._range[:, beyond] = [bottom[beyond], top[beyond]]  # there it has been now
        self._driven = 0 if driven or beyond.any() else self._driven + 1
        if self._driven < _AFTER:
            known = self._noisy() | causes
            found = {n: one for n, one in found.items() if one.kind != "burst" or n in known}
        if not healthy or any(one.kind == "burst" for one in found.values()):
            self._waiting.clear()
        elif not found:
            self._learn(
                with_last, steered, len(own), far, rough, moved, ended, changes, ~moved_anew
            )
            self._grow_rougher(_WAIT)
        return found, driven

    def _rests(
        self, last: Array, runs: Array, top: Array, bottom: Array, suspects: Collection[str]
    ) -> Mask:
        """Which signals may stand still: commands at an end of what they do, and sensors at theirs
        that came to rest with such a command, or ran out behind it: a machine that is switched off
        has no noise. A sensor that dies while a command has stood at its end for long is none of
        these. On a ramp it looks like one that ran out: whether it is, residuals say. So may
        readings that are held in a position of a switch.
        """
        ends = ((last >= top) | (last <= bottom)) & (top > bottom)
        commands = ends & self._drive
        together = (np.abs(runs[:, None] - runs) <= _LEAST)[:, commands].any(axis=1)
        # or ran out: to its end and never away from it, as noise goes, and without a leap
        steps = np.sign(last - self._path[0]) * np.diff(self._path, axis=0, append=last[None])
        ran_out = (steps >= 0.0).all(axis=0) & (steps.max(axis=0) > 0.0) & commands.any()
        ran_out &= steps[-1] <= steps[:-1].max(axis=0)
        ran_out &= [name not in suspects for name in self._names]
        return np.asarray(commands | (ends & (together | ran_out)) | self._held.held)

    def _begun(self, found: Mapping[str, Unusual], driven: Container[str]) -> list[Unusual]:
        """What is new; what has been away for some rows is over."""
        fresh = [one for name, one in found.items() if name not in self.active]
        for one in fresh:
            gone = self._away.get(one.signal, PAUSE + 1)
            quiet = 1 if one.kind == "spike" else _QUIET
            needed = max(self._needed.get(one.signal, quiet), _QUIET)  # spikes come back later
            self._needed[one.signal] = away(gone, needed, quiet, self._pause)
            self.active[one.signal] = one
        for name in (*self._names, *self._encoders.names):
            shown = name in found or (name in driven and name in self.active)
            self._away[name] = 0 if shown else self._away.get(name, PAUSE) + 1
            if name in self.active and self._away[name] >= self._needed.get(name, _QUIET):
                del self.active[name]
        return fresh

    def _causes(self, driven: Collection[str], sensors: Collection[str]) -> set[str]:
        """The sensors that all inputs which move as never before follow, if each of these does."""
        place = self._names.index
        led = [{n for n in sensors if self._follows.leads(place(n), place(own))} for own in driven]
        return set.union(*led) if led and all(led) else set()

    def _noisy(self) -> set[str]:
        """The signals whose noise was told and goes on, whatever a controller makes of it."""
        return {name for name, one in self.active.items() if one.kind == "burst"}

    def lately(self, name: str) -> bool:
        """Whether a signal is unusual or was so a few rows ago, an encoder since it is suspect."""
        fresh = self._away.get(name, PAUSE) < _AFTER
        return name in self.active or fresh or name in self._encoders.stood

    def _matters(self, rough: Array, suspects: Collection[str]) -> Array:
        """The least roughness that is told, in shares of the range of each signal.

        What is told goes on until it is half as much. Where residuals are in alarm small noise is
        what they see, unless several signals have had it lately: then it is of the machine.
        """
        least = np.full(len(self._names), _FLOOR)
        for name in self._noisy():
            least[self._names.index(name)] = 0.0 if name in suspects else _FLOOR / 2.0
        louder = np.stack([rough > self._rough[0], rough > self._louder() * self._rough[0]])
        self._loud = np.concatenate([self._loud[1:], louder[None]])
        some, often = self._loud.sum(axis=0)
        if np.count_nonzero(some) == 1 and self._names[k := int(some.argmax())] in suspects:
            least[k] = 0.0 if often[k] >= _QUIET else least[k]
        return least

    def _beyond(self) -> Array:
        """How far out a spike is (`far_out`), of each signal.

        Where no sample has been alone yet, one may be as far out as the signal is rough.
        """
        return np.asarray(far_out(self._samples) * np.maximum(self._far, self._rough[0]))

    def _louder(self) -> Array:
        """Times the roughness of any healthy row, above which it is unusual."""
        return np.where(self._rows >= _MANY, OUT, 1.5 * OUT)

    def _driving(self, rough: Array, span: Array) -> Array:
        """How many times rougher than in any healthy row sensors may be by what drives them.

        By as much as the input that is it most, but for those that follow it: a machine passes that
        on, one with a parameter that has changed as any other. Of inputs nothing is expected so.
        """
        times = rough / np.maximum(self._rough[0], 1e-300)
        found = np.ones(len(times))
        for k in np.flatnonzero(self._drive & (rough > _FLOOR * span) & (times > 1.0)).tolist():
            follows = [self._follows.leads(j, k) for j in range(len(self._names))]
            found = np.where(follows, found, np.maximum(found, times[k]))
        return np.where(self._drive, 1.0, found)

    def _unusual(
        self, far: Array, rough: Array, moved: Array, runs: Array, span: Array, least: Array
    ) -> dict[str, tuple[Mask, Array, Array]]:
        """Of each kind: which signals are unusual, how far out each is now, and was at most."""
        with np.errstate(divide="ignore", invalid="ignore"):
            floor = _FLOOR * np.maximum(span, 1e-300)
            rougher = np.fmax(rough / self._rough[0], 1.0)  # noise has as much larger peaks
            spike = far[2] > np.maximum(rougher * self._beyond(), floor)
            told = np.isin(self._names, list(self._noisy()))
            share = np.where(told, 0.5, 1.0)  # it goes on until it is half as much
            driving = np.where(told, 1.0, self._driving(rough, span))  # that it may be itself
            louder = share * self._louder() * driving * self._rough[0]
            burst = rough > np.maximum(louder, least * span)
            beside = np.where(moved > 0, rough / np.maximum(moved, 1e-300), 0.0)
            burst &= beside > share * np.minimum(_ROUGHER * self._rough[1], _WHITE)
            longest = np.maximum(_STILL * self._still, _LEAST)
            # a spike is no part of the range that it is told in shares of, wherever in a row it is
            known = self._range[1] - self._range[0]
            whole = np.where(known > 0.0, known, span)
            changing = (self._still > 0.0) & (self._least >= _CHANGES)
            noisy = changing & np.isfinite(self._calm) & (self._calm > _NOISY)
            return {
                "spike": (spike, far[1] / whole, self._far / whole),
                "burst": (burst, rough / whole, self._rough[0] / whole),
                "stuck": (noisy & (runs > longest), runs, self._still),
            }

    def _runs(self, own: Array, steered: Array) -> tuple[Array, Array, Array]:
        """How long each signal has had its present value, and the longest one that ended in this
        row, but for what a switch held; how often it changed."""
        before = self._last[-1:] if len(self._last) else own[:1]
        same = np.diff(np.concatenate([before, own]), axis=0) == 0.0
        number = np.arange(len(own))[:, None]
        turns = np.maximum.accumulate(np.where(same, -self._run, number), axis=0)
        ran = number - np.concatenate([-self._run[None], turns[:-1]])
        ended = np.where(same | self._held.held, 0.0, ran).max(axis=0)
        self._run = len(own) - turns[-1]
        self._held.row(steered[:, int(self._drive.sum()) :], self._run)
        both = np.concatenate([self._tail, own])
        begins = np.where(self._run <= len(own), len(both) - self._run, 0.0).astype(int)
        fresh = begins >= _LEAST
        behind = np.maximum(begins + np.arange(-_LEAST, 0)[:, None], 0)
        self._path[:, fresh] = np.take_along_axis(both, behind, axis=0)[:, fresh]
        self._tail = both[-_LEAST:]
        return self._run.copy(), ended, 1.0 - same.mean(axis=0)

    def _first(self, own: Array, steered: Array, healthy: bool) -> None:
        """Gather samples until there are enough for the weights; then look at all of them."""
        if not healthy:
            self._seen = []
            return
        self._seen.append((own, steered))
        if sum(len(row) for row, _ in self._seen) < ENOUGH:
            return
        near, next_, middle = _around(np.concatenate([row for row, _ in self._seen]))
        weights = []
        for k in range(own.shape[1]):
            table = np.column_stack([near[:, k], next_[:, k], middle[:, k]])
            table = table[np.isfinite(table).all(axis=1)]
            if len(table) < ENOUGH // 2:
                weights.append(_SMOOTH)
                continue
            # of an average: what is expected moves with the signal, wherever its zero is
            nearer, rest = table[:, :1] - table[:, 1:2], table[:, 2] - table[:, 1] / 2.0
            nearest = float(np.linalg.lstsq(nearer, rest, rcond=None)[0][0])
            weights.append((nearest, 0.5 - nearest))
        self._weights = np.array(weights)
        rows, self._seen = self._seen, []
        last, before = np.empty((0, own.shape[1])), steered[:0]
        self._run[:] = 0.0
        self._held.restart()
        for row, commands in rows:
            with_last, steered = np.concatenate([last, row]), np.concatenate([before, commands])
            self._last = last
            _, ended, changes = self._runs(row, commands)
            last, before = with_last[-4 * _SIDE :], steered[-4 * _SIDE :]
            if len(with_last) >= 4 * _SIDE + 1:
                far, rough, moved, _ = self._looked_at(with_last, steered)
                every = np.ones(own.shape[1], dtype=np.bool_)
                self._learn(with_last, steered, len(row), far, rough, moved, ended, changes, every)
        self._grow_rougher(0)
        self._last = last

    def _grow_rougher(self, wait: int) -> None:
        """By healthy rows, but for so many of the last: noise may have set in within one."""
        while len(self._waiting) > wait:
            self._rough = np.fmax(self._rough, self._waiting.popleft())

    def _learn(
        self, samples: Array, steered: Array, count: int, far: Array, rough: Array, moved: Array,
        ended: Array, changes: Array, inputs: Mask,
    ) -> None:  # fmt: skip
        """A healthy row more, of the signals that have a value all through it.

        It has so many samples, and others before it. What the last of them are is known with the
        next row only: of a spike there the range is none.

        Spikes that are not alone are not told, and not what the signal does: it is as smooth as
        ever.
        """
        fresh = np.isfinite(far[0]) & (self._samples < _MOST)
        with np.errstate(invalid="ignore"):  # of a signal of which nothing is known
            floor = _FLOOR * (self._range[1] - self._range[0])
            out = far[0] > np.maximum(self._beyond(), floor)
        quiet = rough <= self._louder() * self._rough[0]
        spikes = out & quiet & (self._samples >= ENOUGH)
        beside = np.where(moved > 0, rough / np.maximum(moved, 1e-300), 0.0)
        seen = samples[2 * _SIDE : len(samples) - 2 * _SIDE]
        usual = self._run <= np.maximum(self._still, 1.0) * 2.0  # else it may have begun to stand
        for table, more, which in (
            (self._range[1], seen.max(axis=0), fresh),
            (self._far, far[0], fresh & ~spikes),
            (self._answer[0], far[3], np.isfinite(far[0])),  # few: there are never enough of them
            (self._still, ended, fresh),
        ):
            table[which] = np.maximum(table, more)[which]
        for table, more, which in (
            (self._range[0], seen.min(axis=0), fresh),
            (self._least, self._share(count, changes, usual), fresh & usual),
            (self._calm, beside, fresh & usual & (moved > 0)),
        ):
            table[which] = np.minimum(table, more)[which]
        self._waiting.append(np.where(fresh, [rough, beside], math.nan))
        self._samples += np.where(fresh, count, 0)
        self._moves.learn(self._bends, ~spikes, inputs)  # large moves are few as well
        self._answer[1] += np.where(np.isfinite(far[0]), far[4], 0.0)
        self._stepped = np.fmax(self._stepped, sizes(steered).max(axis=0))
        self._rows += fresh

    def _share(self, count: int, changes: Array, usual: Mask) -> Array:
        """How many of the samples changed since the last share, with a row of `count` more.

        One where there are not enough yet. Rows in which a signal may have begun to stand still
        begin anew.
        """
        more = [changes * count, np.full_like(changes, count)]
        self._differ = np.where(usual, self._differ + more, 0.0)
        enough = self._differ[1] >= _SHARE
        share = np.where(enough, self._differ[0] / np.maximum(self._differ[1], 1.0), 1.0)
        self._differ[:, enough] = 0.0
        return share

    def _looked_at(self, samples: Array, steered: Array) -> tuple[Array, Array, Array, Array]:
        """Of samples (n, signals): the largest spike, by how much the largest that is alone is off
        what its neighbours let expect, and how large that is, the largest answer to what is
        `steered` (n, commands), and how many samples are such; the roughness, what the signals
        move, and where that spike is."""
        near, next_, middle = _around(samples)
        error = middle - near * self._weights[:, 0] - next_ * self._weights[:, 1]
        self._follows.row(np.nan_to_num(error), self._full, self._range[1] - self._range[0])
        self._bends = np.abs(middle - near / 2.0)
        off, inside = np.abs(error), slice(_SIDE, len(error) - _SIDE)
        before, after = samples[1:-3], samples[3:-1]
        median = np.clip(middle, np.minimum(before, after), np.maximum(before, after))
        either = np.minimum(off, np.abs(middle - median))[inside]
        single = np.where(self._steps(error), 0.0, either)
        own = slice(2 * _SIDE, len(samples) - 2 * _SIDE)
        rare = rare_steps(steered, int(self._drive.sum()))
        beside = answers(rare)[own] & ~self._drive
        # than all that were answered: how far that goes nobody knows
        larger = answers(rare & (sizes(steered) > self._stepped))[own]
        known = beside & ~larger & (self._answer[1] >= ENOUGH)
        usual = known & (single <= OUT * self._answer[0])
        unknown = beside & ~known & (~larger | (single <= self._at_most(steered, rare)[own]))
        spike = np.where(usual | unknown, 0.0, single)
        answer = np.where(beside, single, 0.0).max(axis=0)
        explained = self._explained(spike)
        spike = np.where(explained, 0.0, spike)
        alone = self._lonely(spike, np.where(usual | explained, 0.0, np.nan_to_num(either)))
        apart = np.abs(np.arange(len(spike))[:, None] - alone.argmax(axis=0)) > _SIDE
        where = np.where(apart, 0.0, off[inside]).argmax(axis=0)  # its neighbours are out as well
        moved = np.median(np.abs(np.diff(samples, axis=0)), axis=0)
        size = off[inside][where, np.arange(len(where))]
        count = np.broadcast_to(beside.sum(axis=0), size.shape)
        far = np.stack([spike.max(axis=0), size, alone.max(axis=0), answer, count])
        return far, np.median(off, axis=0), moved, where + 2 * _SIDE

    def _at_most(self, steered: Array, rare: Mask) -> Array:
        """How far out signals may be beside steps that are larger than ever, (n, signals).

        In proportion to the largest that there were; anywhere, where there were none.
        """
        steps, known = np.where(rare, sizes(steered), 0.0), self._stepped > 0.0
        times = steps / np.where(known, self._stepped, 1.0)
        most = answered(times.max(axis=1, initial=0.0))[:, None]
        most = most * np.maximum(self._beyond(), OUT * self._answer[0])
        anywhere = answered(steps[:, ~known].max(axis=1, initial=0.0))[:, None] > 0.0
        return np.where(anywhere, math.inf, most)

    def _lonely(self, spike: Array, out: Array) -> Array:
        """The spikes beside which no sample is nearly as far `out`, but for those next to them."""
        around = np.concatenate([self._before, out, np.zeros((_AROUND, out.shape[1]))])
        self._before = around[len(out) : len(out) + _AROUND]
        if not (spike > self._beyond()).any():
            return spike
        near = np.lib.stride_tricks.sliding_window_view(around, _AROUND - _SIDE, axis=0).max(axis=2)
        largest = np.maximum(near[: len(out)], near[-len(out) :])
        return np.where(spike > _ALONE * largest, spike, 0.0)

    def _explained(self, spike: Array) -> Mask:
        """Which samples of a row, how much of a spike each is, inputs explain by their own moves.

        Looked at where one is larger than what is known. An input that does some samples later what
        a sensor has shown follows it, and explains nothing of it. One that does it in the very
        sample may be what a controller makes of it: it explains what relations say a machine does.
        """
        larger = (spike > self._beyond()) & (self._samples >= ENOUGH) & ~self._drive
        if not larger.any():
            return np.zeros(spike.shape, dtype=np.bool_)
        at = np.flatnonzero(self._drive)
        most = np.full((len(self._names), len(at)), math.inf)
        for k in np.flatnonzero(larger.any(axis=0)).tolist():
            later = np.array([self._follows.later(k, j) for j in at.tolist()])
            most[k, later > 0] = 0.0
            if (later == 0).any():
                most[k, later == 0] = self._follows.passes[k, at][later == 0]
        own = self._bends[_SIDE : len(self._bends) - _SIDE]
        return larger & (own <= OUT * self._moves.explain(self._bends, most))

    def _steps(self, error: Array) -> Mask:
        """Where a step to or from a sample explains more of the errors around it than a spike does.

        Of the errors (n, signals) of what neighbours let expect, n - 4 samples.
        """
        nearest, next_ = self._weights.T
        one, half, none = np.ones_like(next_), np.full_like(next_, 0.5), np.zeros_like(next_)
        shapes = np.array([
            [-next_, -nearest, one, -nearest, -next_],
            [-next_, -half, half, next_, none],
            [none, -next_, -half, half, next_],
        ])  # fmt: skip
        around = np.lib.stride_tricks.sliding_window_view(error, 2 * _SIDE + 1, axis=0)
        along = np.einsum("tsk,pks->pts", around, shapes) ** 2
        spike, *steps = along / np.square(shapes).sum(axis=1)[:, None]
        return np.asarray(np.max(steps, axis=0) > spike)

    def state(self) -> dict[str, Any]:
        """What signals were like and what is unusual now, as plain JSON."""
        learned = [numbers(table) for table in self._learned()] if len(self._weights) else []
        active = [[*one, self._needed.get(name, _QUIET)] for name, one in self.active.items()]
        return {
            "learned": learned, "active": active, "moves": self._moves.state(),
            "encoders": self._encoders.state(),
        }  # fmt: skip

    def resume(self, state: Mapping[str, Any]) -> None:
        """Go on from a state; raises KeyError, TypeError or ValueError for one of another kind."""
        if state["learned"]:
            self._weights = np.zeros((len(self._names), 2))
            for table, known in zip(self._learned(), state["learned"], strict=True):
                # with a second measure of spikes before 2026-11-30
                both = table is self._far and any(isinstance(row, list) for row in known)
                table[:] = array(known[0] if both else known, table.shape)
            self._range[1][self._samples == 0] = -math.inf  # of which nothing is known
        if "moves" in state:  # since 2026-11-30
            self._moves.resume(state["moves"])
        self._encoders.resume(state["encoders"])
        for signal, kind, since, now, before, other, needed in state["active"]:
            told = float(since), float(now), float(before)
            one = Unusual(str(signal), str(kind), *told, str(other))
            if not all(map(math.isfinite, told)):
                raise ValueError("a time or a size is no number")
            self.active[one.signal], self._needed[one.signal] = one, int(needed)
            self._away[one.signal] = 0

    def _learned(self) -> list[Array]:
        return [self._weights, self._samples, self._rows, self._far, self._rough, self._calm,
                self._range, self._still, self._least, self._answer, self._stepped]  # fmt: skip


def _around(samples: Array) -> tuple[Array, Array, Array]:
    """For each sample that has two on either side: sums of the nearest and the next, and itself."""
    return samples[1:-3] + samples[3:-1], samples[:-4] + samples[4:], samples[2:-2]
