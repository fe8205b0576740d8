"""What a co-simulation is made of, and what a page is told of it at first.

Its watch has people who look on: samples are heard, with what they are decided by.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal

import numpy as np

from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.program import Known
from bondgraph.runtime.log import Array, Log
from bondgraph.runtime.monitoring.clock import Clock
from bondgraph.runtime.monitoring.engine import Batch, Engine
from bondgraph.runtime.monitoring.operating import Operating
from bondgraph.runtime.monitoring.sources.sample_source import Source
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.runtime.monitoring.watch_parts import Decision
from bondgraph.runtime.simulation.scenario import Fault, Scenario
from bondgraph.text.tuples import NamedTuple

_SIZE = 1e9  # of a fault that a page asks for, as a factor or in the unit of the target

Hear = Callable[[Array, Batch, Array], None]


class Setup(NamedTuple):
    """All that a session needs.

    `engine` has as many signals as `columns` gives; `decision` makes one for the engine it gets,
    `clock` and `columns` are made for each watch, `source` too if it `renews`. With a `speed` the
    samples wait for their time. Samples count while the machine is `operating`.
    """

    system: EquationSystem
    integral: CausalGraph
    scenario: Scenario
    engine: Engine
    own: int  # of the signals of the engine, those that residuals read
    decision: Callable[[Engine], Decision]
    clock: Callable[[], Clock]
    columns: Callable[[], Callable[[Log], Array]]
    source: Callable[[], Source]
    renews: bool
    speed: float | None
    what: str
    operating: Callable[[], Operating | None] = lambda: None


class Target(NamedTuple):
    """Something that can be made faulty: `factor` SI units are one of `unit`."""

    name: str
    kind: str  # param, input or sensor
    unit: str
    factor: float
    value: float | None


class Machine(NamedTuple):
    """What a page is told of the machine.

    `residuals` are (name, unit, faults); `sensors` (name, unit); `links` the faults of each
    element, by its path.
    """

    name: str
    doc: str
    residuals: tuple[tuple[str, str, tuple[str, ...]], ...]
    sensors: tuple[tuple[str, str], ...]
    targets: tuple[Target, ...]
    links: Mapping[str, tuple[str, ...]]
    monitored: str  # what the monitored machine is called
    simulated: bool


def wish(
    message: Mapping[str, object], faults: Sequence[Fault], targets: Mapping[str, Target]
) -> Fault | str:
    """The fault that a page asks for, or why it is none.

    Either `{"fault": k}`, one of `faults` of the scenario, from now on instead of from its time, or
    `{"target": name, "change": op, "value": number}` with the value in the unit of the target.
    """
    number = message.get("fault")
    if number is not None:
        if not isinstance(number, int) or not 0 <= number < len(faults):
            return "the scenario has no such fault"
        fault = faults[number]
        return fault._replace(at=0.0, until=fault.until - fault.at)
    target = targets.get(str(message.get("target")))
    if target is None:
        return "the model has no such parameter, input or sensor"
    change, value = message.get("change"), message.get("value", 0.0)
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= _SIZE:
        return f"{target.name}: the size is no number up to {_SIZE:g}"
    if change == "stuck" and target.kind != "param":
        return Fault(target.name, "stuck", 0.0, 0.0, label=f"{target.name} stuck")
    if change == "missing" and target.kind == "sensor":
        return Fault(target.name, "missing", 0.0, 0.0, label=f"{target.name} missing")
    shown = f"{value:g}"
    if change == "*=":
        label = f"{target.name} × {shown}"
        return Fault(target.name, "*=", float(value), 0.0, label=label)
    if change == "+=":
        unit = "" if target.unit in ("", "1") else f" {target.unit}"
        label = f"{target.name} {'−' if value < 0 else '+'} {abs(value):g}{unit}"
        return Fault(target.name, "+=", value * target.factor, 0.0, label=label)
    return f"{target.name}: there is no such change"


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
        self.stages, self.lags = engine.stages, engine.lags
        self.reads = np.pad(engine.reads, ((0, 0), (0, len(more))))  # of the others none

    def run(self, samples: Array, received: Array | None = None) -> Batch:
        """See `Engine`."""
        return self._engine.run(samples[:, : self._own], received)

    def run_with(
        self,
        others: Sequence[Engine],
        samples: Array,
        received: Array | None = None,
        which: Sequence[int] | None = None,
    ) -> Batch:
        """See `Engine`."""
        return self._engine.run_with(others, samples[..., : self._own], received, which)

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

    def waits(self) -> dict[str, str]:
        """See `Decision`."""
        return self._inner.waits()

    def restart(self) -> None:
        """See `Decision`."""
        self._inner.restart()

    def state(self) -> dict[str, Any]:
        """See `Decision`."""
        return self._inner.state()

    def resume(self, state: dict[str, Any]) -> None:
        """See `Decision`."""
        self._inner.resume(state)
