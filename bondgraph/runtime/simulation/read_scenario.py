"""Read a scenario file (TOML) for a model: every name checked, every number in SI units."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Mapping
from difflib import get_close_matches

from bondgraph.ir.graph import BondGraph, Input, Node, Port, Sensor
from bondgraph.ir.unit import Dimension, over, times
from bondgraph.library.elements import STORAGES
from bondgraph.library.units import DOMAINS
from bondgraph.passes.elaboration.outside import Outside
from bondgraph.runtime.simulation.machine import named
from bondgraph.runtime.simulation.parameters import Values
from bondgraph.runtime.simulation.scenario import (
    Change,
    Controller,
    Course,
    Fault,
    Instrument,
    Plane,
    Sampling,
    Scenario,
)
from bondgraph.runtime.simulation.toml_table import HERTZ, PURE, SECOND, Document, Table, places
from bondgraph.text.diagnostic import Label, Report
from bondgraph.text.foreign_data import WrongData, toml_data
from bondgraph.text.limits import (
    FAULT_TIMES,
    RATE,
    SCENARIO_BYTES,
    SCENARIO_CONTROLLERS,
    SCENARIO_FAULTS,
)
from bondgraph.text.source import Source, Span
from bondgraph.text.tuples import NamedTuple

STARTS = ("initial", "steady")
METHODS = ("auto", "LSODA", "Radau", "BDF", "DOP853", "RK45", "RK23")


def read_scenario(source: Source, graph: BondGraph, report: Report) -> Scenario | None:
    """The scenario in a TOML text; None, and errors in the report, if something in it is wrong.

    `docs/simulation.md` describes the file.
    """
    content = _content(source, report)
    found = None if content is None else _Reader(source, graph, report).read(content)
    return None if report.failed else found


class Numbers(NamedTuple):
    """What takes the place of the numbers in a model, by name: as in `Options`."""

    parameters: dict[str, float]
    offsets: dict[str, float]
    tolerances: dict[str, float]
    bandwidth: float | None = None  # of the filter (rad/s) that told these best, if not the usual


def read_numbers(source: Source, graph: BondGraph, report: Report) -> Numbers:
    """[parameters], [offsets], [tolerances] and [filter] of a TOML text, in SI, errors reported.

    Also for none of them.

    What else is in the text is not looked at: it may be what `bondgraph fit` writes, or a scenario.
    """
    content = _content(source, report)
    found = Numbers({}, {}, {})
    if content is not None:
        found = _Reader(source, graph, report).numbers(content)
    if not any(found) and not report.failed:
        report.error("scenario-key", "There are no parameters.", Label(Span(source, 0, 0)),
                     help="Write them below a line [parameters]: R = 12.5, or R ="
                     ' "12.5 Ohm".')  # fmt: skip
    return found


def _content(source: Source, report: Report) -> dict[str, object] | None:
    """The tables of a TOML text; None, and an error in the report, where it is none."""
    if len(source.text) > SCENARIO_BYTES:
        report.error("scenario-syntax", f"The scenario has {len(source.text):,} characters;"
                     f" {SCENARIO_BYTES:,} is the most.", Label(Span(source, 0, 0)),
                     help="Put courses of many points into a log: `U = { file = \"run.csv\" }`."
                     )  # fmt: skip
        return None
    try:
        return toml_data(source.text)
    except WrongData as error:
        report.error("scenario-syntax", f"This is no TOML: {error}.",
                     Label(_where(source, error)),
                     help="A scenario is made of lines `name = value` and of [tables]; a text"
                     " stands in quotes.")  # fmt: skip
        return None


def _where(source: Source, error: WrongData) -> Span:
    if error.line is None:
        return Span(source, len(source.text), len(source.text))
    lines = source.text.split("\n")
    start = sum(len(line) + 1 for line in lines[: error.line - 1]) + error.column - 1
    start = min(start, len(source.text))
    return Span(source, start, min(start + 1, len(source.text)))


def _state_unit(storage: Node, port: Port) -> Dimension | None:
    """The dimension of a charge or an impulse; None where the domain leaves it open."""
    domain = DOMAINS.get(storage.domain or "")
    rate = domain and (domain.flow if port.stores == "q" else domain.effort)
    return times(rate, SECOND) if rate else None


class _Reader:
    def __init__(self, source: Source, graph: BondGraph, report: Report) -> None:
        self.graph = graph
        terms = Outside(graph.pool, graph.values, report)
        self.document = Document(source, places(source.text), terms, Values(graph))
        self.sensors = {s.name: s for s in graph.sensors if s.same_as is None}
        self.inputs = {i.name: i for i in graph.inputs if not i.of}
        self.values = {v.name: v for v in graph.values}
        self.lets = {x.name: x for x in graph.lets}

    def numbers(self, content: Mapping[str, object]) -> Numbers:
        top = Table(self.document, (), content)
        tolerances, bandwidth = top.table("tolerances"), top.table("filter")
        return Numbers(
            self._parameters(top.table("parameters")),
            self._offsets(top.table("offsets")),
            {
                key: tolerances.number(key, PURE, 0.0, 0.0, 1.0)
                for key in tolerances.keys
                if self._known(tolerances, key, key, "parameter", self.values)
            },
            bandwidth.number("bandwidth", PURE, 0.0, 1.0 / RATE, RATE) or None,
        )

    def read(self, content: Mapping[str, object]) -> Scenario:
        top = Table(self.document, (), content)
        path = self.document.source.path
        name = top.text("name", os.path.splitext(os.path.basename(path))[0])
        doc = top.text("doc")
        top.text("model")
        parameters = self._parameters(top.table("parameters"))
        self.document.values = Values(self.graph, parameters)
        sampling = self._sampling(top.table("sampling"))
        duration = top.number("duration", SECOND, 10.0, 0.0, 1e7, above=True)
        inputs, modes = self._inputs(top.table("inputs"))
        tables = top.tables("controller", SCENARIO_CONTROLLERS)
        controllers = tuple(self._controller(t, sampling) for t in tables)
        tables = top.tables("fault", SCENARIO_FAULTS)
        faults = tuple(f for t in tables for f in self._fault(t, duration))
        scenario = Scenario(
            name=name,
            doc=doc,
            duration=duration,
            seed=top.whole("seed", 1),
            start="steady" if top.text("start", "initial", STARTS) == "steady" else "initial",
            spread="uniform" if top.text("spread", "none", ("none", "uniform")) == "uniform"
            else "none",
            method=top.text("method", "auto", METHODS),
            tolerance=top.number("tolerance", PURE, 1e-7, 1e-12, 1e-2),
            static=self._static(top),
            parameters=parameters,
            initial=self._initial(top.table("initial")),
            inputs=inputs,
            modes=modes,
            controllers=controllers,
            instruments=self._instruments(top.table("sensors")),
            sampling=sampling,
            faults=faults,
            plane=self._plane(top.table("plane")),
            desired=self._desired(top.table("desired")),
            record=self._record(top),
        )  # fmt: skip
        top.finish()
        driven = [c.input for c in controllers]
        for k, one in enumerate(driven):
            if one in driven[:k] or one in inputs:
                self.document.wrong(("controller", k, "input"), f"`{one}` is given twice.",
                                    "A controller drives it: leave it out of"
                                    " [inputs].")  # fmt: skip
        return scenario

    # ---------------------------------------------------------------------- parts

    def _known(
        self, table: Table, key: str | tuple[str, int], name: str, what: str, known: Iterable[str]
    ) -> bool:
        names = list(known)
        if name in names:
            return True
        close = get_close_matches(name, names, 3, 0.5)
        shown = close or names[:6]
        more = "" if close or len(names) <= 6 else f" and {len(names) - 6} more"
        help = f"It has {', '.join(f'`{n}`' for n in shown)}{more}." if shown else "It has none."
        if close:
            help = f"Did you mean {' or '.join(f'`{n}`' for n in close)}?"
        inside = (key,) if isinstance(key, str) else key
        self.document.no_name((*table.path, *inside), f"The model has no {what} `{name}`.", help)
        return False

    def _parameters(self, table: Table) -> dict[str, float]:
        found = {}
        for key in table.keys:
            if self._known(table, key, key, "parameter", self.values):
                found[key] = table.number(key, self.values[key].dimension, 0.0)
        return found

    def _offsets(self, table: Table) -> dict[str, float]:
        """By how much samples of a signal are too large; encoders count from their start."""
        signals: dict[str, Input | Sensor] = {
            n: s for n, s in self.sensors.items() if s.counts is None
        }
        signals |= {n: i for n, i in self.inputs.items() if i.known and not i.mode}
        return {
            key: table.number(key, signals[key].dimension, 0.0)
            for key in table.keys
            if self._known(table, key, key, "sensor or input with an offset", signals)
        }

    def _initial(self, table: Table) -> dict[str, float]:
        states = {
            port.state.symbol.name: _state_unit(node, port)
            for node in self.graph.nodes
            for port in node.ports
            if port.state is not None
        }
        found = {}
        for key in table.keys:
            if self._known(table, key, key, "state", states):
                found[key] = table.number(key, states[key], 0.0)
        return found

    def _inputs(self, table: Table) -> tuple[dict[str, Course], dict[str, Course]]:
        inputs: dict[str, Course] = {}
        modes: dict[str, Course] = {}
        for key in table.keys:
            if self._known(table, key, key, "input", self.inputs):
                item = self.inputs[key]
                course = table.course(key, PURE if item.mode else item.dimension, item.mode)
                if course is not None:
                    (modes if item.mode else inputs)[key] = course
        return inputs, modes

    def _controller(self, table: Table, sampling: Sampling) -> Controller:
        driven, measures = table.text("input"), table.text("measures")
        speed = table.flag("speed")
        dimension: Dimension | None = None
        effort: Dimension | None = None
        if self._known(table, "input", driven, "input", self.inputs):
            effort = self.inputs[driven].dimension
        if self._known(table, "measures", measures, "sensor", self.sensors):
            dimension = self.sensors[measures].dimension
            if speed and dimension is not None:
                dimension = over(dimension, SECOND)
        setpoint = table.course("setpoint", dimension)
        if setpoint is None:
            setpoint = Course.constant(0.0)
            if "setpoint" not in table:
                self.document.no_key(
                    table.path,
                    "The controller has no `setpoint`.",
                    'Write for instance setpoint = "20 rad/s".',
                )
        step = 1.0 / sampling.rate
        period = table.number("period", SECOND, step, 0.0, above=True)
        if period < step / 2 or abs(period / step - round(period / step)) > 1e-6:
            table.wrong("period", f"`period` is no multiple of the sample time, {step:g} s.",
                        "A controller reads samples: let it run at some of them.")  # fmt: skip
        gain = None if effort is None or dimension is None else over(effort, dimension)
        kp = table.number("kp", gain, 0.0)
        ki = table.number("ki", None if gain is None else over(gain, SECOND), 0.0)
        kd = table.number("kd", None, 0.0)
        limits = table.limits("limits", effort)
        table.finish()
        return Controller(driven, measures, setpoint, kp, ki, kd, period, limits, speed)

    def _instruments(self, table: Table) -> dict[str, Instrument]:
        found = {}
        every = None
        for key in table.keys:
            own = table.table(key)
            if key != "all" and not self._known(table, key, key, "sensor", self.sensors):
                continue
            dimension = None if key == "all" else self.sensors[key].dimension
            instrument = Instrument(
                own.number("noise", dimension, 0.0, 0.0),
                own.number("step", dimension, 0.0, 0.0),
                own.number("rate", HERTZ, 0.0, 0.0) or None,
                own.number("bias", dimension, 0.0),
            )
            own.finish()
            if key == "all":
                every = instrument
            else:
                found[key] = instrument
        if every is not None:
            found = {name: found.get(name, every) for name in self.sensors}
        return found

    def _sampling(self, table: Table) -> Sampling:
        sampling = Sampling(
            table.number("rate", HERTZ, 1000.0, 1.0 / RATE, RATE),
            table.number("jitter", PURE, 0.0, 0.0, 0.9),
            table.number("lost", PURE, 0.0, 0.0, 0.9),
        )
        table.finish()
        return sampling

    def _fault(self, table: Table, duration: float) -> list[Fault]:
        event, of = table.text("event"), table.text("of")
        label = table.text("label")
        at = table.number("at", SECOND, 0.0, 0.0)
        until = table.number("until", SECOND, math.inf, at, above=True)
        ramp = table.number("ramp", SECOND, 0.0, 0.0)
        period = table.number("period", SECOND, 0.0, 0.0)
        if period and (min(until, duration) - at) / period > FAULT_TIMES:
            table.wrong("period", f"The fault comes and goes more than {FAULT_TIMES} times.",
                        "What changes that fast is seen as its mean: take that.")  # fmt: skip
        duty = table.number("duty", PURE, 0.5, 0.0, 1.0)
        op: Change = "+="
        value, target = 0.0, of
        if event:
            events = {e.name: e for e in self.graph.events}
            if not self._known(table, "event", event, "fault", events):
                return []
            found = events[event]
            number = self.document.values.constant(found.value)
            if number is None:
                table.wrong("event", f"The fault `{event}` has no number.",
                            "Give its parameters a value under [parameters].")  # fmt: skip
                return []
            op = "+=" if found.op == "+=" else "*=" if found.op == "*=" else "="
            value, target = number, found.target
        else:
            targets = [*self.values, *self.inputs, *self.sensors]
            if not self._known(table, "of", of, "parameter, input or sensor", targets):
                return []
            switch = of in self.inputs and self.inputs[of].mode
            changed = self._position(table, of) if switch else self._change(table, of)
            if changed is None:
                return []
            op, value = changed
        if ramp and target in self.inputs and self.inputs[target].mode:
            table.wrong("ramp", f"`{target}` is a switch: it is in one position or the other.",
                        "Leave out `ramp`, or write `period` and `duty`.")  # fmt: skip
        said = label or event or f"{target} {table.text('change')}"
        table.finish()
        span = self.document.span(table.path)
        return [Fault(target, op, value, at, until, ramp, period, duty, said, span)]

    def _position(self, table: Table, of: str) -> tuple[Change, float] | None:
        """What a switch does instead of what it is told: `stuck`, `= true`, `= false`."""
        text = table.text("change")
        known: dict[str, tuple[Change, float]] = {
            "stuck": ("stuck", 0.0), "= true": ("=", 1.0), "= false": ("=", 0.0)
        }  # fmt: skip
        if text not in known:
            what = f"`{text}` is nothing that a switch does." if text else "There is no `change`."
            table.wrong("change", what,
                        f'`{of}` is told to be on or off. Write "stuck", "= true" or'
                        ' "= false".')  # fmt: skip
        return known.get(text)

    def _change(self, table: Table, of: str) -> tuple[Change, float] | None:
        """The operator and value of a change: `+= 100 Ohm`, `*= 0.5`, `= 3 V`, stuck, missing."""
        text = table.text("change")
        if text == "stuck":
            return "stuck", 0.0
        if text == "missing":
            if of not in self.sensors:
                table.wrong("change", f"`{of}` is no sensor: it cannot be missing.",
                            'Write change = "*= 0" for a source that gives nothing.')  # fmt: skip
                return None
            return "missing", 0.0
        match = re.match(r"(\+=|\*=|-=|=)\s*(.+)", text)
        if match is None:
            what = f"`{text}` is no change." if text else "The fault has no `change`."
            table.wrong("change", what,
                        'Write "+= 100 Ohm", "*= 0.5", "= 3 V", "stuck", or, for a sensor,'
                        ' "missing".')  # fmt: skip
            return None
        item = self.values.get(of) or self.inputs.get(of) or self.sensors[of]
        dimension = PURE if match[1] == "*=" else item.dimension
        path = (*table.path, "change")
        where = self.document.span(path)
        at = where.start + match.start(2)
        place = Span(where.source, at, at + len(match[2]))
        if place.text != match[2]:
            place = Span(Source(where.source.path, match[2]), 0, len(match[2]))
        expr = self.document.terms.read(place, dimension, "the change", timely=False)
        number = None if expr is None else self.document.values.constant(expr)
        if number is None:
            return None
        if match[1] == "-=":
            return "+=", -number
        op: Change = "+=" if match[1] == "+=" else "*=" if match[1] == "*=" else "="
        return op, number

    def _plane(self, table: Table) -> Plane | None:
        if not table.keys:
            return None
        names = {key: table.text(key) for key in ("x", "y", "heading")}
        for key, name in names.items():
            if (name or key != "heading") and not self._known(table, key, name, "let", self.lets):
                return None
        table.finish()
        return Plane(names["x"], names["y"], names["heading"] or None)

    def _desired(self, table: Table) -> dict[str, Course]:
        found = {}
        for key in table.keys:
            if self._known(table, key, key, "sensor", self.sensors):
                course = table.course(key, self.sensors[key].dimension)
                if course is not None:
                    found[key] = course
        return found

    def _record(self, top: Table) -> tuple[str, ...]:
        return self._listed(top, "record", "effort or flow", named(self.graph))

    def _static(self, top: Table) -> tuple[str, ...]:
        paths = [n.path for n in self.graph.nodes if n.kind in STORAGES]
        inside = {p[:k] for p in paths for k, c in enumerate(p) if c in ".["} | set(paths)
        return self._listed(top, "quasi_static", "storage", sorted(inside))

    def _listed(self, top: Table, key: str, what: str, known: Iterable[str]) -> tuple[str, ...]:
        """The names in a list that are known; the others are told."""
        names = enumerate(top.names(key))
        return tuple(n for k, n in names if self._known(top, (key, k), n, what, known))
