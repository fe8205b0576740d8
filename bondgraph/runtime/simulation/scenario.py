"""What is to happen to a virtual machine: inputs, controllers, instruments, faults, in numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Literal

from bondgraph.ir.expr import Expr
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple


class Course(NamedTuple):
    """A signal over time: an expression of `t`, or points (t, value) in s and SI units.

    Between points it is a straight line, or with `hold` the value of the point before.

    >>> ramp = Course(None, ((0.0, 0.0), (2.0, 12.0)))
    >>> Course.constant(12.0)
    Course(expr=None, points=((0.0, 12.0),), hold=False)
    """

    expr: Expr | None
    points: tuple[tuple[float, float], ...] = ()
    hold: bool = False

    @classmethod
    def constant(cls, value: float) -> Course:
        """Always the same value."""
        return cls(None, ((0.0, value),))


class Controller(NamedTuple):
    """A sampled PID loop on one sensor: `input` = kp e + ki integral(e) + kd e', within `limits`.

    e = setpoint - measured; with `speed` the measured value is the difference of the sensor over
    one period, as a drive does that counts encoder pulses. The integral stops at the limits
    (anti-windup by clamping). `period` in s, a whole number of samples.
    """

    input: str
    measures: str
    setpoint: Course
    kp: float
    ki: float
    kd: float
    period: float
    limits: tuple[float, float]
    speed: bool


class Instrument(NamedTuple):
    """What a sensor makes of the true value: white noise, steps, samples of its own rate, a bias.

    `noise` is the standard deviation and `step` the resolution, in the unit of the signal;
    `rate` in samples a second, None for that of the log.
    """

    noise: float = 0.0
    step: float = 0.0
    rate: float | None = None
    bias: float = 0.0


class Sampling(NamedTuple):
    """How samples are taken: `rate` a second, `jitter` as a share of the interval (the time stamps
    tell it), `lost` the share of samples that never arrive."""

    rate: float = 1000.0
    jitter: float = 0.0
    lost: float = 0.0


Change = Literal["+=", "*=", "=", "stuck", "missing"]


class Fault(NamedTuple):
    """Something goes wrong: the value of `target` changes by `op` `value`, from `at` on (s).

    `stuck` keeps the value of the moment, `missing` gives no sample. A switch is 1 or 0. It sets
    in over `ramp` seconds, ends at `until`, and with a `period` it is there for the share `duty` of
    each. `label` is what to call it.

    >>> Fault("R", "*=", 1.3, at=3.0, label="worn brush").until
    inf
    """

    target: str
    op: Change
    value: float
    at: float
    until: float = math.inf
    ramp: float = 0.0
    period: float = 0.0
    duty: float = 1.0
    label: str = ""
    origin: Span | None = None


class Plane(NamedTuple):
    """The names of the `let`s that are the place of a vehicle in the plane (m, m, rad)."""

    x: str
    y: str
    heading: str | None


class Scenario(NamedTuple):
    """One run of a virtual machine.

    `parameters`, `initial` and `inputs` by name; it may `start` in the steady state for the inputs
    of the first moment, which is looked for from the initial one. `spread` draws parameters inside
    their tolerances, `tolerance` is that of a step of integration, relative to each state. `static`
    are storages taken as being at rest. `desired` says what sensors should show, for the desired
    path, where no controller says it. `record` are signals to keep beside those known.
    """

    name: str
    doc: str = ""
    duration: float = 10.0
    seed: int = 1
    start: Literal["initial", "steady"] = "initial"
    spread: Literal["none", "uniform"] = "none"
    method: str = "auto"
    tolerance: float = 1e-7
    static: tuple[str, ...] = ()
    parameters: Mapping[str, float] = {}
    initial: Mapping[str, float] = {}
    inputs: Mapping[str, Course] = {}
    modes: Mapping[str, Course] = {}
    controllers: tuple[Controller, ...] = ()
    instruments: Mapping[str, Instrument] = {}
    sampling: Sampling = Sampling()
    faults: tuple[Fault, ...] = ()
    plane: Plane | None = None
    desired: Mapping[str, Course] = {}
    record: tuple[str, ...] = ()
