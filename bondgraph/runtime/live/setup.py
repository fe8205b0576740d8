"""What a co-simulation is made of, and what a page is told of it at first."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.runtime.log import Array, Log
from bondgraph.runtime.monitoring.clock import Clock
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.runtime.monitoring.sample_pipeline import Decision
from bondgraph.runtime.monitoring.sources.sample_source import Source
from bondgraph.runtime.simulation.scenario import Fault, Scenario
from bondgraph.text.tuples import NamedTuple


class Setup(NamedTuple):
    """All that a session needs.

    `engine` has as many signals as `columns` gives; `decision` makes one for the engine it gets,
    `clock` and `columns` are made for each watch, `source` too if it `renews`. With a `speed` the
    samples wait for their time.
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


def wish(message: Mapping[str, object], setup: Setup, targets: Mapping[str, Target]) -> Fault | str:
    """The fault that a page asks for, or why it is none.

    Either `{"fault": k}`, the scenario's own, from now on instead of from its time, or
    `{"target": name, "change": op, "value": number}` with the value in the unit of the target.
    """
    number = message.get("fault")
    if number is not None:
        faults = setup.scenario.faults
        if not isinstance(number, int) or not 0 <= number < len(faults):
            return "the scenario has no such fault"
        fault = faults[number]
        return fault._replace(at=0.0, until=fault.until - fault.at)
    target = targets.get(str(message.get("target")))
    if target is None:
        return "the model has no such parameter, input or sensor"
    change, value = message.get("change"), message.get("value", 0.0)
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < 1e300:
        return f"{target.name}: the size is no number"
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
