"""Which residuals are watched and which wait, as people are told it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.origins import Origins
from bondgraph.runtime.monitoring.verdict import Verdict, listed

_Mask = npt.NDArray[np.bool_]


class Telling:
    """Says once what has changed since it was last said."""

    def __init__(self, names: Sequence[str], used: _Mask) -> None:
        self._names, self._used = names, used
        self.restart()

    def restart(self) -> None:
        """The residuals begin anew."""
        self._warm = False
        self._waits: _Mask = np.zeros(len(self._used), dtype=np.bool_)  # that were said to wait

    def names(self, of: _Mask) -> str:
        """Residuals by name."""
        return listed([n for n, own in zip(self._names, of, strict=True) if own], "and")

    def warmth(self, time: Array, valid: _Mask, origins: Origins, out: list[Verdict]) -> None:
        """Say so once all are valid that ever will be: the slowest filter has settled."""
        waiting = origins.waiting & self._used
        watched = self._used & ~waiting
        settled = valid[:, watched].all(axis=1)
        if self._warm or not settled.any():
            return
        self._warm, self._waits = True, waiting
        said = [self._watched(watched)] if watched.any() else []
        if waiting.any():
            said.append(self._waiting(waiting, origins))
        at = float(time[int(np.argmax(settled))])
        out.append(Verdict("warm-up", at, message="; ".join(said)))

    def row(self, time: float, origins: Origins, out: list[Verdict]) -> None:
        """At the end of a row: what has begun to wait, and what waits no longer."""
        waiting = origins.waiting & self._used
        lost = waiting & origins.lost & ~self._waits
        over = self._waits & ~waiting
        if not self._warm:
            return
        if lost.any():
            out.append(Verdict("invalid", time, message=self._waiting(lost, origins)))
        if over.any():
            message = f"{self._watched(over)}: where their positions began is known"
            out.append(Verdict("warm-up", time, message=message))
        self._waits = (self._waits & waiting) | lost

    def _watched(self, of: _Mask) -> str:
        return f"{self.names(of)} {'is' if of.sum() == 1 else 'are'} watched from now on"

    def _waiting(self, of: _Mask, origins: Origins) -> str:
        verb = "waits" if of.sum() == 1 else "wait"
        where = f"where {listed(origins.unknown(of), 'and')} began"
        return f"{self.names(of)} {verb} until the machine has shown by its motion {where}"
