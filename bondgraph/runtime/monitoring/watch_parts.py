"""What a monitor is made of, and what it asks of its parts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from threading import Event
from typing import TYPE_CHECKING, Any, Protocol

from bondgraph.runtime.log import Array, Log
from bondgraph.runtime.monitoring.clock import Clock
from bondgraph.runtime.monitoring.engine import Batch, Engine
from bondgraph.runtime.monitoring.journal import Journal
from bondgraph.runtime.monitoring.mqtt_client import Publisher
from bondgraph.runtime.monitoring.residual_states import Told
from bondgraph.runtime.monitoring.snapshot import Snapshot
from bondgraph.runtime.monitoring.sources.sample_source import Source
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.text.tuples import NamedTuple

if TYPE_CHECKING:
    from bondgraph.runtime.monitoring.operating import Operating

#: s without a sample after which a live source is silent.
SILENCE = 2.0


class Stop(Event):
    """A wish to stop, with what wished so."""

    reason = ""

    def ask(self, reason: str) -> None:
        """Wish so."""
        self.reason = reason
        self.set()


class Decision(Protocol):
    """What says verdicts; a monitor owns one."""

    def update(self, time: Array, batch: Batch, samples: Array) -> list[Verdict]:
        """What there is to say after further samples, in order. Times in s."""

    def look(self, time: Array, batch: Batch, samples: Array) -> None:
        """Samples that were decided on before a restart, to warm up by."""

    def decided(self) -> Batch:
        """By what the samples of the last `update` were decided on.

        Values may be others than those that came in, where it knows better, and so may be which of
        them are valid. The bound is the whole threshold: adaptive, for what nobody knows of the
        machine, and for noise; NaN while that is learned. Further out for long enough is an alarm.
        """

    def restart(self) -> None:
        """The residuals begin anew, after a gap; what was said is still said."""

    def waits(self) -> dict[str, str]:
        """The residuals that are not watched though they could have a value, by name, and why."""

    def state(self) -> dict[str, Any]:
        """All that `resume` needs, as plain JSON."""

    def resume(self, state: dict[str, Any]) -> None:
        """Go on from a state; raises KeyError, TypeError or ValueError for one of another kind."""


class Listener(Protocol):
    """What gets every sample with what it was decided on."""

    def add(self, time: Array, decided: Batch, told: Told) -> None:
        """Further samples, see `Decision.decided`, and what they are."""


class Parts(NamedTuple):
    """What a monitor is made of.

    `columns` picks the signals of the engine out of a log, (n, signals); raises LogError where
    some are missing. `sinks` hear every verdict with its number, `listeners` get every sample with
    what it was decided on. Only while the machine is `operating` its samples count. `note` is told
    which column was taken for the time. The rate may be one that was `asked` for. A live source is
    silent after `silence` s without a sample. Each `heartbeat` s the state is told, if there is
    such a number, and `observe` gets it whenever something may have changed.
    """

    source: Source
    columns: Callable[[Log], Array]
    clock: Clock
    engine: Engine
    decision: Decision
    sinks: Sequence[Callable[[int, Verdict], None]] = ()
    publisher: Publisher | None = None
    journal: Journal | None = None
    operating: Operating | None = None
    note: Callable[[str], None] = lambda text: None
    asked: bool = False
    listeners: Sequence[Listener] = ()
    heartbeat: float | None = None
    silence: float = SILENCE
    observe: Callable[[Snapshot], None] | None = None
