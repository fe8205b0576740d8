"""Which residuals are watched and which wait, as people are told it."""

from __future__ import annotations

import math

import numpy as np

from bondgraph.runtime.diagnosis.hypotheses import rows_apart
from bondgraph.runtime.diagnosis.learning import FIRST, Learning
from bondgraph.runtime.diagnosis.origins import Origins
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.runtime.monitoring.recurrence import Recurrence
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.text.moment import moment
from bondgraph.text.numerals import listed

_PATIENCE = 5.0  # warm-ups in which a residual should have had a value


class WatchStatus:
    """Says once what has changed since it was last said."""

    def __init__(self, engine: Engine, used: Mask) -> None:
        self._engine, self._used = engine, used
        self._hopeless: Mask = np.zeros(len(used), dtype=np.bool_)  # that were said to be
        self._breaks: Recurrence | None = None  # until the first beginning was told
        self._untold = 0  # breaks since they were counted last
        self.restart()

    def restart(self) -> None:
        """The residuals begin anew."""
        self._untold += 1
        self._warm, self._quiet = False, False  # whether they began, and nothing was told of it
        self._first: float | None = None  # s, of the first sample
        self._seen: Mask = np.zeros(len(self._used), dtype=np.bool_)  # that have had a value
        self._waits: Mask = np.zeros(len(self._used), dtype=np.bool_)  # that were said to wait

    def names(self, of: Mask) -> str:
        """Residuals by name."""
        return listed([n for n, own in zip(self._engine.residuals, of, strict=True) if own], "and")

    def warm_up(
        self, time: Array, valid: Mask, noise: Array, origins: Origins, out: list[Verdict]
    ) -> None:
        """Say so once all have had a value that ever will: the slowest filter has settled.

        The `noise` of residuals is infinite while nobody knows it.
        """
        if self._warm or not len(time):
            return
        if self._first is None:
            self._first = float(time[0])
        waiting = origins.waiting & self._used
        watched = self._used & ~waiting
        seen = np.logical_or.accumulate(valid, axis=0) | self._seen
        self._seen = seen[-1]
        settled = seen[:, watched].all(axis=1)
        at = float(time[int(np.argmax(settled))]) if settled.any() else float(time[-1])
        patience = _PATIENCE * self._engine.warm_up + self._engine.sample_time
        if not settled.any() and at - self._first < patience:
            return
        self._warm, self._waits = True, waiting
        self._quiet = not self._news(at)
        if self._quiet:
            return
        silent = watched & ~self._seen
        if silent.any():
            message = f"{self.names(silent)} had no value so far: something that it reads is"
            message += " missing, a law or a table is left where it is not defined, an equation has"
            message += " no solution, or switches turn too often"
            out.append(Verdict("invalid", at, message=message))
        self._begin(at, watched & self._seen, waiting, np.isfinite(noise), origins, out)

    def _news(self, at: float) -> bool:
        """Whether to tell how the residuals begin at a time: first, and then as breaks are told."""
        breaks, self._untold = self._untold, 0
        if self._breaks is None:
            self._breaks = Recurrence(self._engine.warm_up)
            return True
        self._breaks.add(breaks, at)
        return self._breaks.due(at) > 0

    def _begin(
        self,
        at: float,
        watched: Mask,
        waiting: Mask,
        known: Mask,
        origins: Origins,
        out: list[Verdict],
    ) -> None:
        said = [self._watched(watched & known)] if (watched & known).any() else []
        if (watched & ~known).any():
            said.append(self._learning(at, watched & ~known))
        if waiting.any():
            said.append(self._waiting(waiting, origins))
        if said:
            out.append(Verdict("warm-up", at, message="; ".join(said)))

    def row(self, time: float, noise: Array, origins: Origins, out: list[Verdict]) -> None:
        """At the end of a row: what has begun to wait, and what waits no longer."""
        waiting = origins.waiting & self._used
        lost = waiting & origins.lost & ~self._waits
        over = self._waits & ~waiting
        if not self._warm or self._quiet:
            return
        if lost.any():
            out.append(Verdict("invalid", time, message=self._waiting(lost, origins)))
        known = np.isfinite(noise)
        if (over & known).any():
            message = f"{self._watched(over & known)}: where they began is known"
            out.append(Verdict("warm-up", time, message=message))
        if (over & ~known).any():
            message = self._learning(time, over & ~known)
            out.append(Verdict("warm-up", time, message=message))
        self._waits = (self._waits & waiting) | lost

    def waits(self, origins: Origins) -> dict[str, str]:
        """Why residuals are not watched, by name: what nobody knows of them yet, or never will."""
        found = {}
        for k, name in enumerate(self._engine.residuals):
            own = np.arange(len(self._used)) == k
            if (origins.waiting & self._used)[k]:
                found[name] = f"it {self._waiting(own, origins).removeprefix(name + ' ')}"
            elif self._hopeless[k]:
                found[name] = "it is an approximation that is far off"
        return found

    def learned(self, time: float, fresh: Mask, found: Learning, out: list[Verdict]) -> None:
        """At the end of a row: the noise of `fresh` residuals is known now, or is no noise."""
        if fresh.any():
            message = self._watched(fresh)
            off = fresh & found.off
            if off.any():
                verb = "does" if off.sum() == 1 else "do"
                message += f"; {self.names(off)} {verb} not stand at zero: parameters are others"
                message += " (bondgraph fit), or a fault was there from the start"
                if (off & found.declared).any():
                    message += ", or what is added up began elsewhere than the model declares"
                    message += " (where nobody knows it, give the parameter of it a tolerance)"
            out.append(Verdict("warm-up", time, message=message))
        hopeless = found.hopeless
        lost = hopeless & ~self._hopeless
        if lost.any():
            verb = "is" if lost.sum() == 1 else "are"
            message = f"{self.names(lost)} {verb} not watched: an approximation that is far off, as"
            message += " where a machine is faster than the filter (--rate, --bandwidth), or faulty"
            out.append(Verdict("invalid", time, message=message))
        self._hopeless = hopeless.copy()

    def relearning(self, time: float, switched: Mask, driven: Mask, out: list[Verdict]) -> None:
        """The noise of some residuals is not known: `switched` or `driven` as never before."""
        for fresh, how in ((switched, "switched"), (driven & ~switched, "driven")):
            if fresh.any():
                message = f"{how} as never before: {self._learning(time, fresh, anew=True)}"
                out.append(Verdict("warm-up", time, message=message))

    def _watched(self, of: Mask) -> str:
        return f"{self.names(of)} {'is' if of.sum() == 1 else 'are'} watched from now on"

    def _learning(self, at: float, of: Mask, anew: bool = False) -> str:
        """When enough rows will have been seen, if the machine moves and all is not as before."""
        every = rows_apart(self._engine)
        rows = math.ceil((round(at / self._engine.sample_time) + 1) / every) + FIRST - 1
        until = (rows * every - 1) * self._engine.sample_time
        noise = f"the noise of {self.names(of)} is learned until {moment(until)} at least"
        unless = ", unless it is seen to be as it was" if anew else ""
        return f"{noise}{unless}, and no alarm given before"

    def _waiting(self, of: Mask, origins: Origins) -> str:
        verb = "waits" if of.sum() == 1 else "wait"
        unknown = origins.unknown(of)
        return f"{self.names(of)} {verb} until the machine has shown by its motion {unknown}"
