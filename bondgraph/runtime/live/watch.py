"""What a watch is made of when people look on: samples are heard, with what they are decided by."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal

from bondgraph.ir.graph import BondGraph
from bondgraph.ir.program import Known
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.engine import Batch, Engine
from bondgraph.runtime.monitoring.sample_pipeline import Decision
from bondgraph.runtime.monitoring.verdict import Verdict

Hear = Callable[[Array, Batch, Array], None]


class Wide:
    """An engine whose samples have more columns than it reads: all that is known of the machine."""

    def __init__(self, engine: Engine, more: Sequence[Known]) -> None:
        self._engine = engine
        self._own = len(engine.signals)
        self.residuals = engine.residuals
        self.signals: tuple[Known, ...] = (*engine.signals, *more)
        self.readings = engine.readings
        self.sample_time, self.bandwidth = engine.sample_time, engine.bandwidth
        self.warm_up, self.parameters = engine.warm_up, engine.parameters

    def run(self, samples: Array, received: Array | None = None) -> Batch:
        """See `Engine`."""
        return self._engine.run(samples[:, : self._own], received)

    def run_with(self, others: Sequence[Engine], samples: Array) -> Batch:
        """See `Engine`."""
        return self._engine.run_with(others, samples[:, : self._own])

    def reset(self) -> None:
        """See `Engine`."""
        self._engine.reset()

    def follow(self, other: Engine) -> None:
        """See `Engine`."""
        self._engine.follow(other._engine if isinstance(other, Wide) else other)

    def configured(
        self,
        parameters: Mapping[str, float] | None = None,
        *,
        bandwidth: float | None = None,
        bounds: bool = True,
    ) -> Engine:
        """See `Engine`; the new one has no more columns than it reads."""
        return self._engine.configured(parameters, bandwidth=bandwidth, bounds=bounds)


def further(graph: BondGraph, engine: Engine, numbers: Mapping[str, float]) -> tuple[Known, ...]:
    """The known signals of a model that its residuals do not read; they may be missing in a log.

    `numbers` are the counts a turn of encoders, by sensor.
    """
    read = {k.path for k in engine.signals}
    found: list[tuple[str, str | None, Literal["input", "mode", "sensor"], float | None]] = []
    for item in graph.inputs:
        if item.known and item.name not in read:
            found.append((item.name, item.unit, "mode" if item.mode else "input", None))
    for sensor in graph.sensors:
        if sensor.same_as is None and sensor.name not in read:
            found.append((sensor.name, sensor.unit, "sensor", numbers.get(sensor.name)))
    return tuple(
        Known(name, name, unit or "", "", kind, 0, False, counts, None, sampled=False)
        for name, unit, kind, counts in found
    )


class Heard:
    """A decision that is overheard: `hear` gets samples, and by what they were decided on."""

    def __init__(self, inner: Decision, signals: int, hear: Hear) -> None:
        self._inner, self._own, self._hear = inner, signals, hear

    def update(self, time: Array, batch: Batch, samples: Array) -> list[Verdict]:
        """See `Decision`."""
        found = self._inner.update(time, batch, samples[:, : self._own])
        self._hear(time, self._inner.decided(), samples)
        return found

    def look(self, time: Array, batch: Batch, samples: Array) -> None:
        """See `Decision`."""
        self._inner.look(time, batch, samples[:, : self._own])

    def decided(self) -> Batch:
        """See `Decision`."""
        return self._inner.decided()

    def restart(self) -> None:
        """See `Decision`."""
        self._inner.restart()

    def state(self) -> dict[str, Any]:
        """See `Decision`."""
        return self._inner.state()

    def resume(self, state: dict[str, Any]) -> None:
        """See `Decision`."""
        self._inner.resume(state)
