"""From residuals to verdicts: thresholds with hysteresis, latching, and the signature matrix."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from bondgraph.runtime.monitoring.verdict import Candidate, Verdict, described, listed
from bondgraph.text.tuples import NamedTuple

if TYPE_CHECKING:
    from bondgraph.runtime.log import Array
    from bondgraph.runtime.monitoring.engine import Batch

#: Excess over the adaptive threshold, in floors, at which a residual fires, and from which down it
#: counts as back; only below the latter does it clear the faults that it sees.
FIRES, BACK = 1.0, 0.5

_IN_A_ROW = 5  # samples that must be above before a residual fires


class Decision(Protocol):
    """What says verdicts; a monitor owns one."""

    def update(self, time: Array, batch: Batch, samples: Array) -> list[Verdict]:
        """What there is to say after further samples, in order. Times in s."""
        ...

    def restart(self) -> None:
        """The residuals begin anew, after a gap; what was said is still said."""
        ...

    def state(self) -> dict[str, Any]:
        """All that `resume` needs, as plain JSON."""
        ...

    def resume(self, state: dict[str, Any]) -> None:
        """Go on from a state."""
        ...


class Facts(NamedTuple):
    """What a decision knows of the machine.

    `sees`: for each residual that can be computed the faults that it sees; `residuals`: the
    columns of a batch; `units` of the faults; `floor`: what noise alone does to each residual, in
    its unit; of a residual without one it is learned, from `learning` samples. `patience`: s to
    wait after the first residual fired until the others had time to.
    """

    residuals: tuple[str, ...]
    sees: Mapping[str, Sequence[str]]
    units: Mapping[str, str]
    floor: Mapping[str, float]
    patience: float
    learning: int


class Learned(NamedTuple):
    """What is known of the samples from which floors are learned: their number, of each residual
    the sum, that of the squares, and how far it was beyond its adaptive threshold."""

    samples: int
    total: Array
    squares: Array
    over: Array


class Threshold:
    """Each residual against its threshold: the adaptive one and a floor for the noise.

    A residual fires when max(0, |r| - bound)/floor has been above 1 for some samples, and is back
    when that has been below 1/2 for a while. The faults named are those that all fired residuals
    see, without those that a residual sees that stayed clearly below its threshold. A fault stays
    latched: it is said when its residuals are back, but not taken back.
    """

    def __init__(self, facts: Facts) -> None:
        self._facts = facts
        self._watched = [k for k, r in enumerate(facts.residuals) if r in facts.sees]
        count = len(facts.residuals)
        self._hair = (
            1e-6 * facts.patience
        )  # a grid that begins elsewhere rounds its times elsewhere
        self._floor = np.array([facts.floor.get(r, math.nan) for r in facts.residuals])
        self._fired = np.zeros(count, dtype=bool)
        self._ever = np.zeros(count, dtype=bool)  # since the fault began
        self._said = np.zeros(count, dtype=bool)
        self._ratio = np.zeros(count)  # most of |r|/threshold since then
        self._peak = np.zeros(count)  # most of the excess since then
        self._learned = _nothing(count)
        self._onset: float | None = None
        self._due = math.inf  # s, when a change is to be said
        self._away = False  # the residuals of the fault are back
        self.restart()

    def restart(self) -> None:
        """The residuals begin anew, after a gap; those that had fired have, until they are back."""
        count = len(self._facts.residuals)
        self._valid = np.zeros(count, dtype=bool)
        self._warm = False
        self._row = np.zeros(count, dtype=int)  # samples above, one after the other
        self._above = np.full(count, math.nan)  # s, since when above BACK
        self._below = np.full(count, math.nan)  # s, since when below

    def state(self) -> dict[str, Any]:
        """All that `resume` needs, as plain JSON."""
        return {
            "floor": _plain(self._floor),
            "row": self._row.tolist(),
            "above": _plain(self._above),
            "below": _plain(self._below),
            "fired": self._fired.tolist(),
            "ever": self._ever.tolist(),
            "said": self._said.tolist(),
            "ratio": np.minimum(self._ratio, 1e300).tolist(),
            "peak": np.minimum(self._peak, 1e300).tolist(),
            "onset": self._onset,
            "due": None if math.isinf(self._due) else self._due,
            "away": self._away,
            "warm": self._warm,
            "valid": self._valid.tolist(),
            "learned": [self._learned.samples, *(x.tolist() for x in self._learned[1:])],
        }

    def resume(self, state: dict[str, Any]) -> None:
        """Go on from a state; a floor that was learned is not learned again."""
        self.restart()
        learned = _numbers(state["floor"])
        self._floor = np.where(np.isnan(self._floor), learned, self._floor)
        self._row = np.array(state["row"], dtype=int)
        self._above, self._below = _numbers(state["above"]), _numbers(state["below"])
        self._fired = np.array(state["fired"], dtype=bool)
        self._ever = np.array(state["ever"], dtype=bool)
        self._said = np.array(state["said"], dtype=bool)
        self._ratio = np.array(state["ratio"], dtype=float)
        self._peak = np.array(state["peak"], dtype=float)
        self._onset = state["onset"]
        self._due = math.inf if state["due"] is None else state["due"]
        self._away, self._warm = state["away"], state["warm"]
        self._valid = np.array(state["valid"], dtype=bool)
        number, *sums = state["learned"]
        self._learned = Learned(number, *(np.array(x, dtype=float) for x in sums))

    def update(self, time: Array, batch: Batch, samples: Array) -> list[Verdict]:
        """What there is to say after further samples, in order."""
        out: list[Verdict] = []
        begin = self._learn(batch)
        time, value, bound = time[begin:], batch.value[begin:], batch.bound[begin:]
        valid: npt.NDArray[np.bool_] = batch.valid[begin:]
        if not len(time):
            return out
        over = np.maximum(0.0, np.abs(value) - bound)
        excess = np.where(valid, over / self._floor, math.nan)
        ratio = np.abs(value) / (bound + self._floor)
        watched = valid[:, self._watched]
        steady = bool((watched == self._valid[self._watched]).all())
        quiet = self._onset is None and not self._row.any() and not self._fired.any()
        if steady and quiet and not (excess > BACK).any():
            return out
        for k in range(len(time)):
            self._validity(float(time[k]), valid[k], out)
            self._sample(float(time[k]), excess[k], ratio[k], out)
        return out

    # ------------------------------------------------------------------- before a fault

    def _learn(self, batch: Batch) -> int:
        """Floors that nobody gave, from the first samples: the machine is taken to be well then.

        How many of the samples went into that.
        """
        unknown = [k for k in self._watched if math.isnan(self._floor[k])]
        if not unknown:
            return 0
        valid: npt.NDArray[np.bool_] = np.all(batch.valid[:, unknown], axis=1)
        counts = self._learned.samples + np.cumsum(valid)
        enough = counts >= self._facts.learning
        end = int(enough.argmax()) + 1 if enough.any() else len(valid)
        value, bound = batch.value[:end][valid[:end]], batch.bound[:end][valid[:end]]
        if len(value):
            over = np.maximum(0.0, np.abs(value) - bound).max(axis=0)
            self._learned = Learned(
                self._learned.samples + len(value),
                self._learned.total + value.sum(axis=0),
                self._learned.squares + (value**2).sum(axis=0),
                np.maximum(self._learned.over, over),
            )
        if not enough.any():
            return end
        found, self._learned = self._learned, _nothing(len(self._floor))
        mean = found.total / found.samples
        deviation = np.sqrt(np.maximum(0.0, found.squares / found.samples - mean**2))
        floor = 3.0 * found.over + 3.0 * deviation
        for k in unknown:  # nothing but zeros, as of a machine that is off: learn on
            if floor[k] > 0.0:
                self._floor[k] = floor[k]
        return end

    def _validity(self, time: float, valid: npt.NDArray[np.bool_], out: list[Verdict]) -> None:
        """Say when the residuals begin to be watched, and when one cannot be computed."""
        now = valid & ~np.isnan(self._floor)
        if not self._warm:
            if now[self._watched].all():
                self._warm = True
                text = listed([self._facts.residuals[k] for k in self._watched], "and")
                floors = ", ".join(f"{self._floor[k]:.3g}" for k in self._watched)
                message = f"watched from now on: {text}, with floors of {floors}"
                out.append(Verdict("warm-up", time, message=message))
        else:
            for k in self._watched:
                if now[k] != self._valid[k]:
                    name = self._facts.residuals[k]
                    event, what = "warm-up", "is watched again"
                    if not now[k]:
                        event, what = "invalid", "cannot be computed: a signal has no value"
                    out.append(Verdict(event, time, message=f"{name} {what}"))
        self._valid = now

    # ---------------------------------------------------------------------------- faults

    def _sample(self, time: float, excess: Array, ratio: Array, out: list[Verdict]) -> None:
        for k in self._watched:
            self._one(time, k, float(excess[k]))
        if self._onset is None and self._fired.any():
            first = self._above[self._fired]
            self._onset, self._due = float(first.min()), time + self._facts.patience
        if self._onset is None:
            return
        if self._due < math.inf:  # not for ever, where the clock was put back in between
            self._due = min(self._due, time + self._facts.patience)
        self._ratio = np.fmax(self._ratio, np.where(np.isnan(excess), 0.0, ratio))
        self._peak = np.fmax(self._peak, excess)
        if (self._fired & ~self._ever).any() and self._said.any():
            self._due = min(self._due, time + self._facts.patience)
        self._ever |= self._fired
        if time >= self._due - self._hair:
            event = "update" if self._said.any() else "fault"
            self._said, self._due = self._ever.copy(), math.inf
            self._away = False
            out.append(self._verdict(event, time, ""))
        if self._due == math.inf and self._away != (not self._fired.any()):
            self._away = not self._away
            what = "are back inside their thresholds; the fault stays latched"
            if not self._away:
                what = "are out of their thresholds again"
            out.append(self._verdict("update", time, f"; the residuals {what}"))

    def _one(self, time: float, k: int, excess: float) -> None:
        """Whether one residual has fired; NaN leaves it as it is."""
        if math.isnan(excess):
            return
        self._row[k] = self._row[k] + 1 if excess > FIRES else 0
        if excess > BACK:
            self._below[k] = math.nan
            if not self._above[k] <= time:
                self._above[k] = time
            if self._row[k] >= _IN_A_ROW:
                self._fired[k] = True
            return
        self._above[k] = math.nan
        if not self._below[k] <= time:  # NaN, or the clock was put back
            self._below[k] = time
        if self._fired[k] and time - self._below[k] >= self._facts.patience - self._hair:
            self._fired[k] = False

    def _verdict(self, event: str, time: float, more: str) -> Verdict:
        facts = self._facts
        fired = [facts.residuals[k] for k in self._watched if self._said[k]]
        silent = [
            facts.residuals[k]
            for k in self._watched
            if not self._said[k] and self._valid[k] and self._peak[k] < BACK
        ]
        faults = list(dict.fromkeys(f for r in facts.sees for f in facts.sees[r]))
        common = [f for f in faults if all(f in facts.sees[r] for r in fired)]
        group = [f for f in common if not any(f in facts.sees[r] for r in silent)]
        if not group and common:
            group, more = common, f"; although {listed(silent, 'and')} did not fire{more}"
        candidates = tuple(
            Candidate(f, None, facts.units.get(f, ""), 1 / len(group)) for f in group
        )
        ratios = {
            facts.residuals[k]: round(float(self._ratio[k]), 3)
            for k in self._watched
            if self._said[k]
        }
        found = Verdict(event, time, self._onset, ratios, tuple(group), candidates)
        text = described(found)
        if not group:
            text = text.replace("an unknown fault", "more than one fault, or one not in the model")
        return found._replace(message=text + more)


def _nothing(residuals: int) -> Learned:
    return Learned(0, np.zeros(residuals), np.zeros(residuals), np.zeros(residuals))


def _plain(values: Array) -> list[float | None]:
    """Numbers as JSON has them, None for NaN."""
    return [None if math.isnan(x) else x for x in values.tolist()]


def _numbers(values: Sequence[float | None]) -> Array:
    return np.array([math.nan if x is None else x for x in values], dtype=np.float64)
