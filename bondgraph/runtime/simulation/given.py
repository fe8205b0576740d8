"""What acts on a machine over time: commands, controllers, and what is wrong with them."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from bisect import bisect_right
from collections.abc import Callable, Iterable, Mapping

import numpy as np

from bondgraph.ir.graph import BondGraph
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation import courses
from bondgraph.runtime.simulation.faults import Wrong, edges
from bondgraph.runtime.simulation.machine import Machine
from bondgraph.runtime.simulation.native_machine import Followed
from bondgraph.runtime.simulation.parameters import Values
from bondgraph.runtime.simulation.scenario import Controller, Course, Scenario

Inputs = Callable[[float], list[float]]

_EDGE = 2e-12  # of the time: what lies nearer together than half of it is one moment
_BIAS = "bias of "
_LOOKS = 2000  # times at which a condition is looked at, at least


class Acting(ABC):
    """All that acts on a machine from outside, by name: commands, and what is wrong.

    Within a segment, from one jump of anything to the next, it is smooth: `inside` keeps times
    clear of the jumps at both ends, so that each of them belongs to one side.
    """

    def __init__(self, graph: BondGraph, values: Values) -> None:
        self.graph, self.values = graph, values
        self.wrong: dict[str, Wrong] = {}
        self.modes = tuple(i.name for i in graph.inputs if i.mode)
        self._sensors = {s.name for s in graph.sensors if s.same_as is None}
        self._numbers = {v.name: v.symbol for v in graph.values}

    @abstractmethod
    def told(self, name: str, t: float) -> float:
        """A command as it is given, not as a faulty amplifier carries it out."""

    @abstractmethod
    def command(self, name: str, order: int) -> Callable[[float], float] | None:
        """A command, or its derivative of some order, over time; None for what is no input."""

    @property
    def disturbed(self) -> tuple[str, ...]:
        """What is changed by faults, samples that are missing and switches aside."""
        changed = (n for n, w in self.wrong.items() if any(f.op != "missing" for f in w.faults))
        return tuple(n for n in changed if n not in self.modes)

    def setting(self, t: float) -> tuple[bool, ...]:
        """The true position of the switches at time t, in s."""
        return tuple(self._position(name, t) for name in self.modes)

    def _position(self, name: str, t: float) -> bool:
        gain, bias = self.wrong[name].at(t) if name in self.wrong else (1.0, 0.0)
        return gain * self.told(name, t) + bias != 0

    def inputs(self, machine: Machine) -> Inputs:
        """What `machine.signals` are, as a function of time."""
        made = [self._signal(*signal) for signal in machine.signals]
        return lambda t: [f(t) for f in made]

    def _signal(self, name: str, order: int) -> Callable[[float], float]:
        found = self.command(name, order)
        if found is not None:
            return found
        what, _, target = name.partition(" of ")
        if what not in ("gain", "bias") or order > 1:
            return nothing
        which = ("gain", "bias").index(what)
        if order:
            return lambda t: self.wrong[target].slope(t)[which]
        return lambda t: self.wrong[target].at(t)[which]

    def before(self, machine: Machine) -> list[float]:
        """What `machine.signals` were before the start: nothing told, nothing wrong."""
        return [float(s.name.startswith("gain of ") and s.order == 0) for s in machine.signals]

    def moving(self, machine: Machine, t: float) -> tuple[int, ...]:
        """The places of inputs that may move in the segment around t, and are not `followed`."""
        return tuple(k for k, signal in enumerate(machine.signals) if self._moves(*signal, t))

    def followed(self, machine: Machine) -> list[Followed]:
        """The inputs of a machine that are courses of time, and arrive at once."""
        return []

    def _moves(self, name: str, order: int, t: float) -> bool:
        return True

    def hold(self, t: float, look: Callable[[], Mapping[str, float]]) -> None:
        """Let faults that stick take hold; `look` tells all that can be seen at this moment."""
        sticking = [n for n, w in self.wrong.items() if any(f.op == "stuck" for f in w.faults)]
        now = look() if sticking else {}
        for name in sticking:
            self.wrong[name].hold(t, self._healthy(name, now, t))

    def _healthy(self, name: str, now: Mapping[str, float], t: float) -> float:
        """What a value, input or sensor would be now if nothing were wrong with it."""
        if name in self._sensors:
            gain, bias = self.wrong[name].at(t)
            return (now[name] - bias) / gain if gain else 0.0
        if name in self._numbers:
            return self.values.number(self._numbers[name])
        return self.told(name, t)


class Given(Acting):
    """The commands, controllers and faults of a scenario."""

    def __init__(self, graph: BondGraph, scenario: Scenario, values: Values, times: Array) -> None:
        super().__init__(graph, values)
        self.scenario, self.times = scenario, times
        faults = scenario.faults
        counting = {s.name for s in graph.sensors if s.counts is not None}
        self.wrong = {
            name: Wrong([f for f in faults if f.target == name], name in counting)
            for name in dict.fromkeys(f.target for f in faults)
        }
        self.pids = [Pid(c, self._function(c.setpoint)) for c in scenario.controllers]
        self._driven = {p.controller.input: p for p in self.pids}
        self._late = {i.name: float(i.delay) for i in graph.inputs if i.delay and not i.of}
        #: what laws received of sensors some time ago: of which, and how long ago it was so
        told = {s.name: float(s.delay) for s in graph.sensors}
        self._received = {i.name: (i.of, float(i.delay) + told[i.of]) for i in graph.inputs if i.of}
        self.recall: Callable[[str, float], float] = lambda name, t: 0.0
        zero = Course.constant(0.0)
        written = {**scenario.inputs, **scenario.modes}
        self.courses = {
            i.name: written.get(i.name, zero)
            for i in graph.inputs
            if i.name not in self._driven and not i.of
        }
        for name in self.modes:
            self.courses[name] = self.courses[name]._replace(hold=True)
        self._told = {name: self._function(course) for name, course in self.courses.items()}
        #: what instruments add to the sensors that laws read
        self.errors: dict[str, Course] = {}
        self._erring: dict[str, list[Callable[[float], float]]] = {}

    @property
    def smooth(self) -> bool:
        """Whether something told may change at any time within a segment."""
        return any(courses.smooth(c) for c in (*self.courses.values(), *self.errors.values()))

    def obey(self, errors: Mapping[str, Course]) -> None:
        """Let laws get sensors with what their instruments add, which is a course of each."""
        self.errors = dict(errors)
        self.wrong = {name: Wrong([]) for name in errors} | self.wrong
        self._erring = {
            name: [self._function(course, order) for order in (0, 1)]
            for name, course in self.errors.items()
        }

    def error(self, name: str, t: float, order: int = 0) -> float:
        """What the instrument adds to a sensor as laws get it; nothing more once it is stuck."""
        if name not in self._erring or self.wrong[name].stuck(t):
            return 0.0
        return self._erring[name][order](t)

    @property
    def disturbed(self) -> tuple[str, ...]:
        """See `Acting`."""
        return tuple(dict.fromkeys((*super().disturbed, *self.errors)))

    def _signal(self, name: str, order: int) -> Callable[[float], float]:
        plain, target = super()._signal(name, order), _biased(name)
        if target not in self.errors or order > 1:
            return plain
        return lambda t: plain(t) + self.error(target, t, order)

    def before(self, machine: Machine) -> list[float]:
        """See `Acting`; an instrument errs before the start as at the start."""
        told = zip(super().before(machine), machine.signals, strict=True)
        return [x + (0.0 if s.order else self.error(_biased(s.name), 0.0)) for x, s in told]

    def _function(self, course: Course, order: int = 0) -> Callable[[float], float]:
        return courses.function(course, self.graph.pool, self.values, order)

    def told(self, name: str, t: float) -> float:
        """See `Acting`."""
        pid = self._driven.get(name)
        return self._told[name](t) if pid is None else pid.output

    def command(self, name: str, order: int) -> Callable[[float], float] | None:
        """See `Acting`."""
        if name in self._received:
            of, age = self._received[name]
            return nothing if order else lambda t: self.recall(of, t - age)
        late = self._late.get(name, 0.0)
        if name in self.courses:
            told = self._function(self.courses[name], order)
            if not late:
                return told
            return lambda t: told(max(t - late, 0.0)) if t > late or not order else 0.0
        pid = self._driven.get(name)
        if pid is None:
            return None
        return nothing if order else lambda t: pid.told(t - late) if late else pid.output

    def still(self, name: str) -> bool:
        """Whether a command is as told throughout each segment."""
        if name in self.modes or name in self._driven:
            return True
        return not courses.moves(self.courses[name], 0)

    def followed(self, machine: Machine) -> list[Followed]:
        """See `Acting`."""
        prompt = {n: c for n, c in self.courses.items() if n not in self._late}
        right = {n: c for n, c in self.errors.items() if n not in super(Given, self).disturbed}
        prompt |= {f"{_BIAS}{name}": course for name, course in right.items()}
        return [
            Followed(k, prompt[name], order)
            for k, (name, order) in enumerate(machine.signals)
            if name in prompt and courses.moves(prompt[name], order)
        ]

    def _moves(self, name: str, order: int, t: float) -> bool:
        if name in self._received:
            return order == 0
        if name in self._late:
            return True
        what, _, target = name.partition(" of ")
        if what not in ("gain", "bias"):
            return False
        if target in self.wrong and self.wrong[target].sets_in(t):
            return True
        own = self.errors.get(_biased(name))
        return own is not None and target in super().disturbed and courses.moves(own, order)

    def control(
        self,
        t: float,
        look: Callable[[], Mapping[str, float]],
        read: Callable[[str, float], float],
    ) -> None:
        """Let the controllers decide whose period ends at time t.

        `look` tells all that can be seen then, `read` what a sensor makes of its true value.
        """
        due = [p for p in self.pids if _multiple(t, p.controller.period)]
        now = look() if due else {}
        for pid in due:
            name = pid.controller.measures
            gone = name in self.wrong and self.wrong[name].missing(t)
            pid.update(t, math.nan if gone else read(name, now[name]))

    def stops(self, end: float) -> list[float]:
        """The moments between start and end at which something jumps or bends."""
        found = set(edges(self.scenario.faults, end))
        times = self.times
        if len(times) < _LOOKS:
            times = np.linspace(0.0, end, _LOOKS)
        told: dict[str, list[float]] = {
            name: [
                *courses.bends(course, end),
                *courses.jumps(course, self.graph.pool, self.values, times),
            ]
            for name, course in self.courses.items()
        }
        told |= {f"{_BIAS}{n}": courses.bends(c, end) for n, c in self.errors.items()}
        for controller in self.scenario.controllers:
            ticks = np.arange(1, math.ceil(end / controller.period)) * controller.period
            told[controller.input] = ticks.tolist()
        for name, moments in told.items():
            found.update(moments)
            if name in self._late:  # they reach the machine later; its input begins to move then
                found.update(t + self._late[name] for t in (0.0, *moments))
        for _, age in self._received.values():  # from moment to moment all that is needed is past
            found.update((np.arange(1, math.ceil(end / age)) * age).tolist())
        return _apart((t for t in found if 0 < t < end), self.times)


def inside(a: float, b: float) -> Callable[[float], float]:
    """Times of a segment, kept clear of what jumps at its ends; a moment is what comes after."""
    if a == b:
        return lambda _: a * (1 + _EDGE)
    margin = min(_EDGE * b, (b - a) / 2)
    low, high = (a + margin if a else a), b - margin
    return lambda t: min(max(t, low), high)


def _apart(found: Iterable[float], times: Array) -> list[float]:
    """Moments in order, each once, and exactly at a sample where one is meant."""
    kept: list[float] = []
    step = float(times[-1]) / len(times)
    for t in sorted(found):
        k = int(np.searchsorted(times, t))
        near = min(times[max(k - 1, 0) : k + 1].tolist(), key=lambda s: abs(s - t))
        moment = near if abs(near - t) < _EDGE / 2 * t else t
        if moment - (kept[-1] if kept else 0.0) > _EDGE * max(t, step):
            kept.append(moment)
    return [t for t in kept if t < times[-1]]


def _multiple(t: float, period: float) -> bool:
    return abs(t / period - round(t / period)) < 1e-6


def _biased(signal: str) -> str:
    """The sensor, value or input that a signal of the machine is the bias of; empty for others."""
    return signal.removeprefix(_BIAS) if signal.startswith(_BIAS) else ""


def nothing(_: float) -> float:
    """Zero at all times."""
    return 0.0


class Pid:
    """One loop; `setpoint` is its course. Called once a period.

    The integral is kept by the trapezoidal rule and stands still while the output is at a limit
    and the error would drive it further (clamping).
    """

    def __init__(self, controller: Controller, setpoint: Callable[[float], float]) -> None:
        self.controller = controller
        self.setpoint = setpoint
        self.output = min(max(0.0, controller.limits[0]), controller.limits[1])
        self._history = [(0.0, self.output)]  # what it has said, from when on
        self._integral = 0.0
        self._error: float | None = None
        self._seen: float | None = None

    def update(self, t: float, seen: float) -> None:
        """Decide on a reading, in the unit of the sensor; NaN is none, and changes nothing."""
        c, measured = self.controller, seen
        if math.isnan(seen):
            return
        if c.speed:
            before, self._seen = self._seen, seen
            measured = 0.0 if before is None else (seen - before) / c.period
        error = self.setpoint(t) - measured
        before_error = error if self._error is None else self._error
        grown = self._integral + c.ki * c.period * (error + before_error) / 2
        wanted = c.kp * error + grown + c.kd * (error - before_error) / c.period
        low, high = c.limits
        if (wanted <= high or error < 0) and (wanted >= low or error > 0):
            self._integral = grown
        self._error = error
        self.output = min(max(wanted, low), high)
        self._history.append((t, self.output))

    def told(self, t: float) -> float:
        """What it said at an earlier time; before the start what it says then."""
        at = bisect_right(self._history, t * (1 + _EDGE), key=lambda entry: entry[0])
        return self._history[max(at - 1, 0)][1]
