"""What runs residuals and thresholds over arrays of samples; here in Python, elsewhere in C."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Mapping, Sequence
from copy import deepcopy
from itertools import count
from types import ModuleType
from typing import Any, Protocol

import numpy as np

from bondgraph.ir.program import Known, law_pace
from bondgraph.ir.runnable_code import Runnable, Together
from bondgraph.runtime.log import Array, Mask
from bondgraph.text.tuples import NamedTuple

_LARGEST = 2.0**53  # a double has all whole numbers up to here


class Batch(NamedTuple):
    """What came out for n samples, a row for each; of several engines, with a first axis of these.

    `value` are the filtered residuals, `valid` says which may be believed, `bound` are the
    adaptive thresholds, in units of the residual: |value| <= bound while every parameter is within
    its tolerance. Value and bound are 0 where invalid, the bound also where the model has none.
    """

    value: Array
    valid: Mask
    bound: Array


class Engine(Protocol):
    """Runs the residuals and thresholds of a model, sample by sample, in step with each other."""

    @property
    def residuals(self) -> tuple[str, ...]:
        """Their names, in the order of the columns of a `Batch`."""

    @property
    def signals(self) -> tuple[Known, ...]:
        """What the columns of the samples are: all that residuals and thresholds read."""

    @property
    def sample_time(self) -> float:
        """The time between two samples, in s."""

    @property
    def bandwidth(self) -> float:
        """Of the filter that all signals pass, in rad/s."""

    @property
    def warm_up(self) -> float:
        """Seconds from the first sample until all residuals are valid."""

    @property
    def stages(self) -> tuple[float, ...]:
        """How many stages the filter of each residual has; a faster one is that part of one."""

    @property
    def lags(self) -> tuple[float, ...]:
        """The delays with which residuals read signals, in s, none first."""

    @property
    def parameters(self) -> Mapping[str, float]:
        """The value of every parameter that the code reads, in SI units, by path."""

    @property
    def reads(self) -> Mask:
        """Which residuals have no value without which signals, (residuals, signals)."""

    @property
    def readings(self) -> tuple[int, ...]:
        """The columns of the sensors whose readings laws use, as controllers do."""

    def run(self, samples: Array, received: Array | None = None) -> Batch:
        """Go on with (n, signals) samples from where the last call ended.

        Encoders in whole counts, modes as 0 and 1. A sample that is not finite restarts the
        residuals that read it, and no other. `received` (n, readings) is what laws got of the
        sensors in `readings`, by default what `samples` say: who asks what a wrong sensor does
        changes its samples and not what was received.
        """

    def run_with(
        self,
        others: Sequence[Engine],
        samples: Array,
        received: Array | None = None,
        which: Sequence[int] | None = None,
    ) -> Batch:
        """This engine and others of the same model, each over the same samples.

        Or over samples of its own: `which` says for each of the engines, this one first, by which
        of the tables it is run, then (tables, n, signals) samples, and `received` accordingly.
        The results of all samples and engines are in memory at once: give long logs in blocks.
        """

    def reset(self) -> None:
        """Forget all samples: the next one is the first."""

    def follow(self, other: Engine) -> None:
        """Take over what another engine of the same model remembers of its samples.

        From the next sample on this engine is the other one with parameters of its own, as if they
        had changed at this moment.
        """

    def configured(
        self,
        parameters: Mapping[str, float] | None = None,
        *,
        bandwidth: float | None = None,
        bounds: bool = True,
    ) -> Engine:
        """A new engine at its first sample, with other values of some parameters or another filter.

        Without `bounds` it computes no thresholds, which costs less. Raises KeyError for a
        parameter that the code does not read, ValueError for values that it cannot take.
        """


class Setting(NamedTuple):
    """A model made ready to be run: its programs, and the values that they are run with."""

    residuals: Runnable
    thresholds: Runnable | None
    signals: tuple[Known, ...]  # all that the programs read
    readings: tuple[int, ...]  # those of them that laws received besides
    parameters: dict[str, float]  # by path, those without a value left out
    bandwidth: float

    @property
    def programs(self) -> tuple[Runnable, ...]:
        """The residuals, and the thresholds if there are any."""
        return (self.residuals,) if self.thresholds is None else (self.residuals, self.thresholds)

    @property
    def warm_up(self) -> float:
        """Seconds from the first sample until all residuals are valid and nothing of it is left."""
        program = self.residuals.program
        pace = self.bandwidth / program.rate
        settle = [r.wait(pace) for r in program.residuals if not r.unavailable]
        waits = [math.ceil(s / pace) for s in (*settle, program.wait(pace))]
        return max(waits) / program.rate + max([d.seconds for d in program.delayed], default=0.0)

    @property
    def has_bound(self) -> list[bool]:
        """For each residual, whether there is a threshold."""
        if self.thresholds is None:
            return [False] * len(self.residuals.program.residuals)
        return [not info.unavailable for info in self.thresholds.program.residuals]

    def columns(self, runnable: Runnable) -> list[int]:
        """Where the signals of one program are among all; behind them is what laws received."""
        place = {k.path: at for at, k in enumerate(self.signals)}
        behind = {at: len(place) + k for k, at in enumerate(self.readings)}
        columns = [(k.kind == "reading", place[k.path]) for k in runnable.program.knowns]
        return [behind[at] if reading else at for reading, at in columns]

    def reads(self) -> Mask:
        """See `Engine`."""
        found = np.zeros((len(self.residuals.program.residuals), len(self.signals)), dtype=np.bool_)
        for runnable in self.programs:
            columns = self.columns(runnable)
            for block in runnable.blocks:
                own = [columns[k] for k in block.reads if columns[k] < len(self.signals)]
                found[np.ix_(block.residuals, own)] = True
        return found

    def table(self, samples: Array, received: Array | None) -> Array:
        """Samples as the programs take them, with what laws received behind the signals.

        Raises ValueError for another number of columns.
        """
        taken = checked(samples, len(self.signals))
        if not self.readings:
            return taken
        got = taken[:, self.readings] if received is None else received
        off = [self.signals[at].offset for at in self.readings]  # laws got what the sensor said
        return np.hstack([taken, checked(got, len(self.readings)) + off])

    def values(self, runnable: Runnable) -> list[float]:
        """The parameters of one program, in its order."""
        unset = [f.path for f in runnable.program.params if f.path not in self.parameters]
        if unset:
            raise ValueError(f"the model has no value for {', '.join(unset)}: give one")
        return [self.parameters[f.path] for f in runnable.program.params]

    def changed(
        self, parameters: Mapping[str, float] | None, bandwidth: float | None, bounds: bool
    ) -> Setting:
        """The same with other values."""
        changes = dict(parameters or {})
        known = {f.path for runnable in self.programs for f in runnable.program.params}
        for path in changes:
            if path not in known:
                raise KeyError(path)
        return self._replace(
            thresholds=self.thresholds if bounds else None,
            parameters=self.parameters | changes,
            bandwidth=self.bandwidth if bandwidth is None else bandwidth,
        )


def setting(residuals: Runnable, thresholds: Runnable | None = None) -> Setting:
    """A model with the nominal values of its parameters, and the filter that it was made for."""
    programs = [residuals.program] + ([thresholds.program] if thresholds else [])
    nominal = {f.path: f.default for p in programs for f in p.params if f.default is not None}
    signals: dict[str, Known] = {}
    received: dict[str, None] = {}
    for known in (k for p in programs for k in p.knowns):
        if known.kind == "reading":
            received[known.path] = None
            known = known._replace(kind="sensor")
        old = signals.setdefault(known.path, known)
        signals[known.path] = old._replace(sampled=old.sampled or known.sampled)
    bandwidth = residuals.program.bandwidth
    readings = tuple(at for at, path in enumerate(signals) if path in received)
    return Setting(residuals, thresholds, tuple(signals.values()), readings, nominal, bandwidth)


def checked(samples: Array, signals: int) -> Array:
    """Samples as C has them; raises ValueError for another number of columns than of `signals`."""
    found = np.ascontiguousarray(samples, dtype=np.float64)
    if found.ndim != 2 or found.shape[1] != signals:
        raise ValueError(f"samples of shape {found.shape}, (n, {signals}) needed")
    return found


def copied(engine: Engine) -> Engine:
    """An engine that stands where this one does; it computes no thresholds."""
    copy = engine.configured(bounds=False)
    copy.follow(engine)
    return copy


def one_by_one(
    engines: Sequence[Engine],
    samples: Array,
    received: Array | None = None,
    which: Sequence[int] | None = None,
) -> Batch:
    """As `run_with` of the first of these engines, by running one after the other."""
    if which is None:
        found = [e.run(samples, received) for e in engines]
    else:
        own = [(e, samples[at], None if received is None else received[at])
               for e, at in zip(engines, which, strict=True)]  # fmt: skip
        found = [e.run(table, got) for e, table, got in own]
    return Batch(*map(np.stack, zip(*found, strict=True)))


class OfSetting:
    """What an engine says of itself, from the setting that it was made with."""

    def __init__(self, setting: Setting) -> None:
        self._setting = setting
        self.residuals = tuple(r.name for r in setting.residuals.program.residuals)
        self.signals, self.readings = setting.signals, setting.readings
        self.sample_time = 1.0 / setting.residuals.program.rate
        self.bandwidth, self.warm_up = setting.bandwidth, setting.warm_up
        pace = self.bandwidth * self.sample_time
        part = pace / law_pace(pace)  # of a stage, how late one in front of laws is
        residuals = setting.residuals.program.residuals
        self.stages = tuple(r.stages + part * r.laws for r in residuals)
        past = setting.residuals.program.delayed
        self.lags = tuple(sorted({0.0, *[d.seconds for d in past]}))
        self.parameters: Mapping[str, float] = setting.parameters

    @property
    def reads(self) -> Mask:
        """See `Engine`."""
        return self._setting.reads()


class PythonEngine(OfSetting):
    """An `Engine` that runs the generated Python: some hundred times slower than C, same numbers.

    Raises ValueError for values of parameters that the model cannot take.
    """

    def __init__(self, setting: Setting, modules: Sequence[ModuleType] = ()) -> None:
        super().__init__(setting)
        self._modules = tuple(modules) or tuple(map(_loaded, setting.programs))
        self._monitors = [
            _Monitor(runnable, module, setting)
            for runnable, module in zip(setting.programs, self._modules, strict=False)
        ]

    def reset(self) -> None:
        """Forget all samples: the next one is the first."""
        for monitor in self._monitors:
            monitor.reset()

    def follow(self, other: Engine) -> None:
        """See `Engine`."""
        assert isinstance(other, PythonEngine)
        for own, one in zip(self._monitors, other._monitors, strict=False):
            own.follow(one)

    def configured(
        self,
        parameters: Mapping[str, float] | None = None,
        *,
        bandwidth: float | None = None,
        bounds: bool = True,
    ) -> PythonEngine:
        """See `Engine`."""
        return PythonEngine(self._setting.changed(parameters, bandwidth, bounds), self._modules)

    def run_with(
        self,
        others: Sequence[Engine],
        samples: Array,
        received: Array | None = None,
        which: Sequence[int] | None = None,
    ) -> Batch:
        """See `Engine`."""
        return one_by_one([self, *others], samples, received, which)

    def run(self, samples: Array, received: Array | None = None) -> Batch:
        """See `Engine`."""
        rows = self._setting.table(samples, received).tolist()
        shape = (len(rows), len(self.residuals))
        value, valid = self._monitors[0].run(rows, shape)
        bound = np.zeros(shape)
        if len(self._monitors) > 1:
            bound, sound = self._monitors[1].run(rows, shape)
            has = np.array(self._setting.has_bound, dtype=np.bool_)
            valid &= sound | ~has
            bound[~(valid & has)] = 0.0
        value[~valid] = 0.0
        return Batch(value, valid, bound)


class _Monitor:
    """One program at its current sample."""

    def __init__(self, runnable: Runnable, module: ModuleType, setting: Setting) -> None:
        values = dict(zip(runnable.params, setting.values(runnable), strict=True))
        given = (module.Parameters(**values),) if values else ()
        of = module.Thresholds if runnable.program.bounds else module.Monitor
        self._monitor: Any = of(*given, bandwidth=setting.bandwidth)
        self._samples: Any = module.Samples
        self._results = runnable.residuals
        self._number = {r.name: at for at, r in enumerate(runnable.program.residuals)}
        self._signals = [
            (name, column, _taken(known))
            for name, column, known in zip(
                runnable.knowns, setting.columns(runnable), runnable.program.knowns, strict=True
            )
        ]
        columns = setting.columns(runnable)
        self._blocks: list[tuple[int, Together]] = [
            (at, block._replace(whole=tuple(columns[k] for k in block.whole)))
            for at, block in enumerate(runnable.blocks)
            if block.whole
        ]

    def reset(self) -> None:
        self._monitor.reset()

    def follow(self, other: _Monitor) -> None:
        for name in ("_x", "_e", "_age", "_lines"):  # all that the generated `step` changes
            if hasattr(other._monitor, name):
                setattr(self._monitor, name, deepcopy(getattr(other._monitor, name)))

    def run(
        self, rows: list[list[float]], shape: tuple[int, int]
    ) -> tuple[Array, Mask]:
        """Results and their validity; what is not valid may have any number."""
        value, valid = np.zeros(shape), np.zeros(shape, dtype=np.bool_)
        step, taken, number = self._monitor.step, self._samples, self._number
        for at, row in enumerate(rows):
            found = step(taken(**{name: make(row[k]) for name, k, make in self._signals}))
            value[at] = [getattr(found, name) for name in self._results]
            for name in found.valid:
                valid[at, number[name]] = True
            for block, members in self._blocks:
                if not all(_exists(row[k]) for k in members.whole):
                    self._monitor._age[block] = 0
                    valid[at, list(members.residuals)] = False
        return value, valid


def _exists(value: float) -> bool:
    return -_LARGEST < value < _LARGEST


def _taken(known: Known) -> Callable[[float], float]:
    """How a number in a row becomes a sample."""
    if known.kind == "mode":
        return bool
    if known.counts is None:
        return float
    return lambda value: int(value) if _exists(value) else 0


_numbers = count()


def _loaded(runnable: Runnable) -> ModuleType:
    """The generated module, run from its text; nothing is written to the disk."""
    module = ModuleType(f"_bondgraph_{runnable.stem}_{next(_numbers)}")
    sys.modules[module.__name__] = module  # dataclasses look there while they are made
    try:
        exec(compile(runnable.python, f"<{runnable.stem}>", "exec"), module.__dict__)
    finally:
        del sys.modules[module.__name__]
    if runnable.program.digest != module.DIGEST or runnable.abi // 256 != module.ABI:
        raise ValueError(f"the code of {runnable.stem} is not that of its program")
    return module
