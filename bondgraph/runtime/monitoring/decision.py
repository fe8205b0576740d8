"""What a monitor wants of whoever decides."""

from __future__ import annotations

from typing import Any, Protocol

from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.engine import Batch
from bondgraph.runtime.monitoring.verdict import Verdict


class Decision(Protocol):
    """What says verdicts; a monitor owns one."""

    def update(self, time: Array, batch: Batch, samples: Array) -> list[Verdict]:
        """What there is to say after further samples, in order. Times in s."""
        ...

    def look(self, time: Array, batch: Batch, samples: Array) -> None:
        """Samples that were decided on before a restart, to warm up by."""
        ...

    def decided(self) -> Batch:
        """By what the samples of the last `update` were decided on.

        Values may be others than those that came in, where it knows better, and so may be which of
        them are valid. The bound is the whole threshold: adaptive, for what nobody knows of the
        machine, and for noise; NaN while that is learned. Further out for long enough is an alarm.
        """
        ...

    def restart(self) -> None:
        """The residuals begin anew, after a gap; what was said is still said."""
        ...

    def state(self) -> dict[str, Any]:
        """All that `resume` needs, as plain JSON."""
        ...

    def resume(self, state: dict[str, Any]) -> None:
        """Go on from a state; raises KeyError, TypeError or ValueError for one of another kind."""
        ...
