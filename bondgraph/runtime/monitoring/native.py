"""The generated C as an engine: residuals of arrays of samples, by one call through ctypes."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from bondgraph.ir.runnable_code import Runnable
from bondgraph.runtime import c_library
from bondgraph.runtime.c_library import NativeError
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.engine import (
    Batch,
    Engine,
    OfSetting,
    PythonEngine,
    Setting,
    one_by_one,
    setting,
)

_STATUS = (
    "no finite number for a parameter",
    "a sample time that it was not made for",
    "a bandwidth that does not go with the sample time",
    "a unit of time that is not positive",
    "parameters that make a coefficient which is not finite",
)


def start(
    residuals: Runnable,
    thresholds: Runnable | None = None,
    *,
    native: bool | None = None,
    tell: Callable[[str], None] | None = None,
) -> Engine:
    """An engine with nominal parameters: C where it can be compiled, else Python.

    `native` True insists on C and raises NativeError, False takes Python. What goes wrong
    otherwise is told, in one line, to `tell` (a RuntimeWarning if there is none). Raises
    ValueError for a model whose parameters have no values.
    """
    made = setting(residuals, thresholds)
    if native is False:
        return PythonEngine(made)
    say = tell or c_library.warn
    try:
        return NativeEngine(made, Library(made.programs, say))
    except NativeError as error:
        if native:
            raise
        say(f"{error}; the residuals are run in Python, some hundred times slower")
        return PythonEngine(made)


class Library:
    """The compiled code of programs, loaded; raises NativeError where that cannot be done.

    `tell` is told, in one line, of a cache that cannot be trusted.
    """

    def __init__(
        self, programs: Sequence[Runnable], tell: Callable[[str], None] = c_library.warn
    ) -> None:
        library = c_library.library(
            [artifact for runnable in programs for artifact in runnable.c],
            [runnable.main for runnable in programs],
            "the residuals",
            lambda found: _is_of(found, programs),
            tell,
        )
        self.functions = {runnable.stem: Functions(library, runnable) for runnable in programs}


class Functions:
    """The functions of one program in a library."""

    def __init__(self, library: ctypes.CDLL, runnable: Runnable) -> None:
        def function(name: str, result: Any, *arguments: Any) -> ctypes._NamedFuncPointer:
            found: ctypes._NamedFuncPointer = getattr(library, f"{runnable.stem}_batch{name}")
            found.restype, found.argtypes = result, arguments
            return found

        pointer, size, real = ctypes.c_void_p, ctypes.c_size_t, ctypes.c_double
        results = [pointer] * (3 if runnable.program.bounds else 2)
        self.size = int(function("_size", size)())
        self.configure = function("_configure", ctypes.c_int, pointer, pointer, real, real)
        self.reset = function("_reset", None, pointer)
        self.follow = function("_follow", None, pointer, pointer)
        self.run = function("", None, pointer, size, pointer, size, size, pointer, *results)


class NativeEngine(OfSetting):
    """An `Engine` of compiled code.

    Raises ValueError for values of parameters that the model cannot take.
    """

    def __init__(self, setting: Setting, library: Library) -> None:
        super().__init__(setting)
        self._library = library
        self._monitors = [
            _Monitor(runnable, library.functions[runnable.stem], setting)
            for runnable in setting.programs
        ]

    def reset(self) -> None:
        """Forget all samples: the next one is the first."""
        for monitor in self._monitors:
            monitor.functions.reset(monitor.address)

    def follow(self, other: Engine) -> None:
        """See `Engine`; raises ValueError for an engine of another library."""
        if not isinstance(other, NativeEngine) or other._library is not self._library:
            raise ValueError("an engine of another model remembers other things")
        for own, one in zip(self._monitors, other._monitors, strict=False):
            own.functions.follow(own.address, one.address)

    def configured(
        self,
        parameters: Mapping[str, float] | None = None,
        *,
        bandwidth: float | None = None,
        bounds: bool = True,
    ) -> NativeEngine:
        """See `Engine`; it costs little, as the library is shared."""
        return NativeEngine(self._setting.changed(parameters, bandwidth, bounds), self._library)

    def run(self, samples: Array, received: Array | None = None) -> Batch:
        """See `Engine`."""
        return Batch(*[array[0] for array in _run([self], samples, received)])

    def run_with(
        self,
        others: Sequence[Engine],
        samples: Array,
        received: Array | None = None,
        which: Sequence[int] | None = None,
    ) -> Batch:
        """See `Engine`; one call where all are of the same library, with thresholds or without."""
        engines = [self]
        for other in others:
            if not isinstance(other, NativeEngine) or not self._is_like(other):
                return one_by_one([self, *others], samples, received, which)
            engines.append(other)
        return _run(engines, samples, received, which)

    def _is_like(self, other: NativeEngine) -> bool:
        return self._library is other._library and len(self._monitors) == len(other._monitors)


class _Monitor:
    """The memory of one program."""

    def __init__(self, runnable: Runnable, functions: Functions, setting: Setting) -> None:
        self.functions = functions
        self.memory = np.zeros(functions.size, dtype=np.uint8)
        self.address = self.memory.ctypes.data
        self.columns: npt.NDArray[np.int32] = np.array(setting.columns(runnable), dtype=np.int32)
        self.columns_address = self.columns.ctypes.data
        values = np.array(setting.values(runnable), dtype=np.float64)
        sample_time = 1.0 / runnable.program.rate
        status = functions.configure(
            self.address, values.ctypes.data, sample_time, setting.bandwidth
        )
        if status:
            raise ValueError(f"{runnable.stem} refuses {_STATUS[status - 1]}")


def _run(
    engines: list[NativeEngine],
    samples: Array,
    received: Array | None = None,
    which: Sequence[int] | None = None,
) -> Batch:
    """All engines over the same samples or each over its own, in one call for each program."""
    first = engines[0]
    numbers = np.zeros(len(engines), dtype=np.intp)
    if which is None:
        taken = first._setting.table(samples, received)
        rows, width = taken.shape
    else:
        numbers[:] = which
        (count, rows, _), (low, high) = samples.shape, (numbers.min(), numbers.max())
        if low < 0 or high >= count:
            raise ValueError(f"tables {low} to {high} of {count}")
        got = None if received is None else received.reshape(count * rows, -1)
        taken = first._setting.table(samples.reshape(count * rows, -1), got)
        width = taken.shape[1]
    shape = (len(engines), rows, len(first.residuals))
    value, bound = results = np.empty((2, *shape))
    valid = np.empty(shape, dtype=np.bool_)
    if len(first._monitors) == 1:
        bound[:] = 0.0
    found = results.ctypes.data  # to ask for an address takes as long as some samples
    pointers = [found, valid.ctypes.data, found + value.nbytes]
    places = np.empty((1 + len(first._monitors), len(engines)), dtype=np.uintp)
    places[0] = taken.ctypes.data + numbers * (rows * width * taken.itemsize)
    places[1:] = [[e._monitors[k].address for e in engines] for k in range(len(first._monitors))]
    at = places.ctypes.data
    for k, monitor in enumerate(first._monitors):
        monitor.functions.run(
            at + (1 + k) * places.strides[0],
            len(engines),
            at,
            rows,
            width,
            monitor.columns_address,
            *pointers[: 2 + k],
        )
    return Batch(value, valid, bound)


def _is_of(library: ctypes.CDLL, programs: Sequence[Runnable]) -> bool:
    """Whether a library was made of these programs."""
    for runnable in programs:
        abi = getattr(library, f"{runnable.stem}_batch_abi")
        digest = getattr(library, f"{runnable.stem}_batch_digest")
        abi.restype, digest.restype = ctypes.c_uint32, ctypes.c_char_p
        if abi() != runnable.abi or digest().decode() != runnable.program.digest:
            return False
    return True
