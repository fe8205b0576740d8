"""The rates and outputs of a machine as compiled C, once it has run long enough to pay for that.

The compiled code refuses what Python has to decide: a law or loop without a value, a rate that no
machine has, a loop that needs iteration. Who calls it then asks Python, so both give the same.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from bondgraph.ir.artifact import Artifact
from bondgraph.ir.expr import Expr
from bondgraph.ir.rate_source import RateSource, RateTable
from bondgraph.ir.state import Block
from bondgraph.notation.dialect import Language
from bondgraph.runtime import c_library
from bondgraph.runtime.c_library import NativeError
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation import courses
from bondgraph.runtime.simulation.algebraic_loops import DENSE, SINGULAR, inverted
from bondgraph.runtime.simulation.code import Code, Numbers, Shared
from bondgraph.runtime.simulation.machine import Machine, equations_of
from bondgraph.runtime.simulation.scenario import Course
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

#: A rate that no machine has.
BEYOND = 1e100

#: Rates in Python after which they are compiled: so many take as long as the compiler, as both grow
#: with the machine (2000 to 20 000 of the models tried). Compiling when Python has cost as much
#: costs no more than twice what it had to, however long the run will be.
WORTH = 10_000

_LINES = 3000  # from which on a compiler takes more than in proportion to them
_LOOK = 100  # rates after which it is asked how far it is

Flags: TypeAlias = npt.NDArray[np.bool_]
Rates: TypeAlias = Callable[[float, Array], Sequence[float] | Array]


class Coding(NamedTuple):
    """The language that is compiled, and the file of it with some lines."""

    language: Language
    file: Callable[[RateSource, float, float], Artifact]


class Followed(NamedTuple):
    """An input of the machine, by its place among the signals, and the course that it follows.

    `order` is that of the derivative.
    """

    place: int
    course: Course
    order: int


class Segment(NamedTuple):
    """The inputs of a machine from `low` to `high`, in s.

    `inputs` gives all of them at a time in s, kept inside; `moving` are the places of those that
    neither follow a course nor stand still.
    """

    low: float
    high: float
    inputs: Callable[[float], list[float]]
    moving: tuple[int, ...]


class Unsuitable(Exception):
    """What is left to Python, and why; `origins` are the laws that it is about."""

    def __init__(self, why: str, origins: Sequence[Span] = ()) -> None:
        super().__init__(why)
        self.origins = tuple(origins)


class NativeMachine:
    """A machine whose rates are compiled as soon as that pays: `count` is told what Python did.

    `followed` are the inputs that follow courses. `tell` is told, in one line and not while it is
    integrated, why a machine that should be compiled is not.
    """

    def __init__(
        self,
        machine: Machine,
        followed: Sequence[Followed],
        coding: Coding,
        tell: Callable[[str], None],
    ) -> None:
        self._machine = machine
        self._followed = tuple(followed)
        self._coding = coding
        self._tell = tell
        self._notes: list[str] = []
        self._left = WORTH
        self._segment: Segment | None = None
        self._code: _Compiled | None = None

    def begin(self, segment: Segment) -> None:
        """Go on with other inputs."""
        self._segment = segment
        if self._code is not None:
            self._code.enter(segment)

    def count(self, rates: int) -> bool:
        """So many more rates were computed in Python; whether it is compiled because of that."""
        if self._left <= 0:
            return False
        self._left -= rates
        if self._left <= 0:
            self.compile()
        return self._code is not None

    def rates(self, otherwise: Rates) -> Rates | None:
        """The rates on this segment, None where they are not compiled.

        What they refuse, and one in a hundred, is asked `otherwise`.
        """
        if self._code is None or self._segment is None:
            return None
        return self._code.rates(self._segment, otherwise)

    def compile(self) -> None:
        """Compile it now, where it can be."""
        self._left = 0
        try:
            self._code = _Compiled(
                self._machine, self._followed, self._coding, self._notes.append
            )
        except Unsuitable:
            return
        except NativeError as error:
            self._notes.append(f"{error}; the machine runs in Python, which takes twice as long")
            return
        if self._segment is not None:
            self._code.enter(self._segment)

    def go_on(self) -> int:
        """How many rates there were since this was asked last."""
        return 0 if self._code is None else self._code.go_on()

    @property
    def last(self) -> tuple[float, list[float]] | None:
        """Time and states of the last rates."""
        return None if self._code is None else self._code.last

    def outputs(self, times: Array, states: Array) -> tuple[Array, Flags] | None:
        """What `Machine.observe` gives at each time, shape (times, outputs), and which rows it has
        to be asked for; None where it is not compiled."""
        while self._notes:
            self._tell(self._notes.pop(0))
        if self._code is None or self._segment is None:
            return None
        return self._code.outputs(self._segment, times, states)


class _Record(ctypes.Structure):
    """The struct `machine` of codegen/c/rates.c.j2."""

    _fields_ = (
        ("p", ctypes.c_void_p),
        ("points", ctypes.c_void_p),
        ("rows", ctypes.c_void_p),
        ("low", ctypes.c_double),
        ("high", ctypes.c_double),
        ("t", ctypes.c_double),
        ("left", ctypes.c_int64),
        ("x", ctypes.c_void_p),
        ("u", ctypes.c_void_p),
        ("r", ctypes.c_void_p),
    )


class _Compiled:
    """The library of a machine, and the memory that it works in."""

    def __init__(
        self,
        machine: Machine,
        followed: Sequence[Followed],
        coding: Coding,
        tell: Callable[[str], None],
    ) -> None:
        written = Written(machine, followed, coding.language)
        file = coding.file(written.source, BEYOND, SINGULAR)
        found = c_library.library([file], [file.path], "the rates", _is_sound, tell)
        # no other thread has to run during a call that is so short
        library = ctypes.PyDLL(found._name, handle=found._handle)
        self._call, self._rows = library.machine_rates, library.machine_outputs
        pointer, size = ctypes.c_void_p, ctypes.c_int64
        self._call.restype, self._call.argtypes = ctypes.c_int, (pointer, ctypes.c_double)
        self._rows.restype, self._rows.argtypes = None, (pointer, size, *[pointer] * 5)
        self._results = written.source.results
        self._u = np.zeros(max(len(machine.signals), 1))
        self._x, self._r = np.zeros(len(machine.states)), np.zeros(len(machine.states))
        self._p = np.array(written.numbers.values, dtype=float)
        self._points = [np.array(c.points, dtype=float) for c in written.courses]
        addresses = np.array([c.ctypes.data for c in self._points], dtype=np.uintp)
        rows = np.array([len(c) for c in self._points], dtype=np.int64)
        self._arrays = addresses, rows
        own = (self._p, addresses, rows), (self._x, self._u, self._r)
        self._record = _Record(
            *[a.ctypes.data for a in own[0]], 0.0, 0.0, 0.0, _LOOK, *[a.ctypes.data for a in own[1]]
        )

    def enter(self, segment: Segment) -> None:
        """See `NativeMachine.begin`."""
        self._record.low, self._record.high = segment.low, segment.high
        given = segment.inputs((segment.low + segment.high) / 2)
        self._u[: len(given)] = given

    def rates(self, segment: Segment, otherwise: Rates) -> Rates:
        """See `NativeMachine`."""
        x, u, r = self._x, self._u, self._r
        call, address = self._call, ctypes.addressof(self._record)
        moving, inputs = segment.moving, segment.inputs

        def rates(t: float, state: Array) -> Sequence[float] | Array:
            x[:] = state
            return otherwise(t, state) if call(address, t) else r

        def moved(t: float, state: Array) -> Sequence[float] | Array:
            given = inputs(t)
            for k in moving:
                u[k] = given[k]
            return rates(t, state)

        return moved if moving else rates

    def go_on(self) -> int:
        """See `NativeMachine`."""
        done = _LOOK - int(self._record.left)
        self._record.left = _LOOK
        return done

    @property
    def last(self) -> tuple[float, list[float]]:
        """See `NativeMachine`."""
        return float(self._record.t), self._x.tolist()

    def outputs(self, segment: Segment, times: Array, states: Array) -> tuple[Array, Flags]:
        """See `NativeMachine`."""
        count = len(times)
        u = np.tile(self._u, (count, 1))
        if segment.moving:
            given = np.array([segment.inputs(t) for t in times.tolist()])
            u[:, segment.moving] = given.reshape(count, -1)[:, segment.moving]
        found = np.empty((count, self._results))
        odd = np.zeros(count, dtype=np.bool_)
        own = np.ascontiguousarray(times, dtype=float), np.ascontiguousarray(states, dtype=float)
        arrays = [a.ctypes.data for a in (*own, u, found, odd)]
        self._rows(ctypes.addressof(self._record), count, *arrays)
        return found, odd


def _is_sound(library: ctypes.CDLL) -> bool:
    library.machine_size.restype = ctypes.c_size_t
    return int(library.machine_size()) == ctypes.sizeof(_Record)


class Written:
    """The source of a machine, the constants and the courses of points that it reads.

    Constants go behind the `numbers` that are there. Raises `Unsuitable` for a machine that is
    left to Python.
    """

    def __init__(
        self,
        machine: Machine,
        followed: Sequence[Followed],
        language: Language,
        numbers: Numbers | None = None,
    ) -> None:
        self._machine = machine
        self._pool = machine.equations.graph.pool
        self.numbers = numbers or Numbers()
        self._shared = Shared(language, {}, self.numbers)
        self.courses: list[Course] = []
        inputs = tuple(line for one in followed for line in self._input(one))
        rates = self._results(machine.leaves(), [s.rate for s in machine.equations.states])
        outputs = self._results(machine.leaves(), machine.outputs)
        lines = len(inputs) + len(rates) + len(outputs)
        if lines > _LINES:
            raise Unsuitable(f"its state equations take {lines} lines, more than {_LINES}")
        tables = [RateTable(n, c, self._pool.rows(n)) for n, c in self._shared.tables.items()]
        sizes = len(machine.states), len(machine.signals), len(machine.outputs)
        self.source = RateSource(tuple(tables), inputs, rates, outputs, *sizes)

    def _code(self, leaves: Mapping[Expr, str]) -> Code:
        return Code(self._pool, leaves, self._machine.values.constant, shared=self._shared)

    def _results(self, leaves: Mapping[Expr, str], wanted: Sequence[Expr]) -> tuple[str, ...]:
        code = self._code(leaves)
        texts = self._machine.texts(code, wanted, self._loop)
        for k, text in enumerate(texts):
            code.line(f"r[{k}] = {text};")
        return tuple(code.lines)

    def _input(self, followed: Followed) -> list[str]:
        """The lines that set an input at the time `t`."""
        place, course, order = followed
        if course.expr is not None:
            time = courses.time_symbol(self._pool)
            code = self._code({time: "t"})
            (text,) = code.text([courses.derived(course.expr, self._pool, order)])
            code.line(f"u[{place}] = {text};")
            return ["    {", *code.lines, "    }"]
        number = len(self.courses)
        self.courses.append(course)
        name = ("through", "slope")[order]
        return [f"    u[{place}] = {name}(m->points[{number}], m->rows[{number}], t);"]

    def _loop(self, code: Code, number: int, block: Block) -> None:
        """Lines that solve the linear equations of a block."""
        names = ", ".join(f"`{n}`" for n in block.names[:4])
        if not block.rests:
            raise Unsuitable(f"the loop through {names} has to be iterated", block.origins)
        if len(block.unknowns) > DENSE:
            why = f"the loop through {names} has more than {DENSE} unknowns"
            raise Unsuitable(why, block.origins)
        rests, entries = equations_of(self._pool, block)
        size, found = len(rests), f"found{number}"
        constants = [self._machine.values.constant(slope) for _, _, slope in entries]
        known = [n for n in constants if n is not None]
        if len(known) == len(entries):
            inverse = inverted(size, [(i, j) for i, j, _ in entries], np.array(known, float))
            start = self.numbers.put(inverse.ravel().tolist())
            code.line(f"const real right{number}[] = {{{', '.join(code.text(rests))}}};")
            code.line(f"real {found}[{size}];")
            code.line(f"times({size}, p + {start}, right{number}, {found});")
        else:
            texts = code.text([*rests, *(slope for _, _, slope in entries)])
            code.line(f"real matrix{number}[{size * size}] = {{REAL(0.0)}};")
            code.line(f"real {found}[] = {{{', '.join(texts[:size])}}};")
            for (i, j, _), text in zip(entries, texts[size:], strict=True):
                code.line(f"matrix{number}[{i * size + j}] = {text};")
            code.line(f"if (!solve({size}, matrix{number}, {found})) {{")
            code.line("return false;", 1)
            code.line("}")
        for k, unknown in enumerate(block.unknowns):
            code.know(unknown, f"{found}[{k}]")
