"""State equations with numbers: rates and outputs as functions of time, state and inputs."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from bondgraph.ir.expr import Expr, Kind, Op, topological
from bondgraph.ir.state import Block, StateEquations
from bondgraph.runtime.simulation.code import Code
from bondgraph.runtime.simulation.values import Values

Array = npt.NDArray[np.float64]

_DENSE = 60  # unknowns of a loop from which on its matrix is kept sparse
_STEPS = 60  # of Newton's method
_SINGULAR = 1e14  # condition of a matrix that leaves something open: flows around a ring
_EXACT = 1e-12  # relative accuracy of a loop


class NoSolution(Exception):
    """The equations of a loop have no solution where the machine is now, or none was found."""

    def __init__(self, names: tuple[str, ...]) -> None:
        self.names = names
        shown = ", ".join(f"`{n}`" for n in names[:4])
        super().__init__(f"the loop through {shown} has no solution that iteration could find")


class Signal(NamedTuple):
    """An input of the machine, or a derivative of it."""

    name: str
    order: int


class Machine:
    """A virtual machine with numbers.

    `values` gives parameters and initial values, `outputs` the expressions to observe, in the
    variables of the state equations. `signals` tells what `rates` wants as its third argument: a
    value for each, in that order. Raises KeyError with the name of a parameter without a value.
    """

    def __init__(
        self, equations: StateEquations, values: Values, outputs: Sequence[Expr] = ()
    ) -> None:
        self.equations = equations
        self.values = values
        self.outputs = tuple(outputs)
        self.states = tuple(s.name for s in equations.states)
        self.signals = self._signals()
        self._guess: dict[int, list[float]] = {}
        wanted = [s.rate for s in equations.states]
        self._rates = self._compiled("rates", wanted)
        self._observed: Callable[..., Any] | None = None

    def rates(self, t: float, x: Sequence[float], u: Sequence[float]) -> Sequence[float]:
        """The derivative of each state at time t (s); NaN where a law has no value.

        Raises `NoSolution` where a nonlinear loop cannot be solved.
        """
        try:
            return self._rates(t, x, u)  # type: ignore[no-any-return]
        except (ArithmeticError, ValueError):
            return [math.nan] * len(self.states)

    def observe(self, t: float, x: Sequence[float], u: Sequence[float]) -> Sequence[float]:
        """The value of each output; all NaN where a law has no value."""
        if self._observed is None:
            self._observed = self._compiled("observe", list(self.outputs))
        try:
            return self._observed(t, x, u)  # type: ignore[no-any-return]
        except (ArithmeticError, ValueError):
            return [math.nan] * len(self.outputs)

    def start(self) -> Array:
        """The state at the start: declared initial values, zero where there is none."""
        initial = [s.initial for s in self.equations.states]
        return np.array([0.0 if i is None else self.values.number(i) for i in initial])

    def undeclared(self) -> tuple[str, ...]:
        """The states whose initial value the model does not declare."""
        return tuple(s.name for s in self.equations.states if s.initial is None)

    def scale(self) -> Array:
        """How much of each state goes with one unit of effort or flow, 1 where that depends."""
        found = []
        for state in self.equations.states:
            size = None if state.capacity is None else self.values.constant(state.capacity)
            found.append(abs(size) if size else 1.0)
        return np.array(found)

    def jacobian(self, t: float, x: Array, u: Sequence[float]) -> Array:
        """d rates / d states, shape (states, states), by central differences."""
        step = 1e-6 * np.maximum(np.abs(x), self.scale())
        columns = []
        for k, h in enumerate(step):
            up, down = x.copy(), x.copy()
            up[k] += h
            down[k] -= h
            change = np.subtract(self.rates(t, up.tolist(), u), self.rates(t, down.tolist(), u))
            columns.append(change / (2 * h))
        return np.asarray(np.nan_to_num(np.array(columns).T.reshape(len(x), len(x))))

    # ------------------------------------------------------------- compilation

    def _signals(self) -> tuple[Signal, ...]:
        blocks = self.equations.blocks
        roots = [e for b in blocks for e in (b.zeros if b.value is None else (b.value,))]
        found: dict[Signal, None] = {}
        for node in topological([*roots, *self.outputs]):
            order = 0
            while node.op is Op.DER:
                order, node = order + 1, node.args[0]
            if node.op is Op.SYM and node.symbol.kind in (Kind.INPUT, Kind.UNKNOWN):
                found[Signal(node.symbol.name, order)] = None
        return tuple(found)

    def _compiled(self, name: str, wanted: list[Expr]) -> Callable[..., Any]:
        graph = self.equations.graph
        leaves: dict[Expr, str] = {s.symbol: f"x[{k}]" for k, s in enumerate(self.equations.states)}
        for k, signal in enumerate(self.signals):
            leaves[self._leaf(signal)] = f"u[{k}]"
        code = Code(graph.pool, leaves, self.values.constant)
        more: dict[str, object] = {}
        needed = self._needed(wanted)
        for number, block in enumerate(self.equations.blocks):
            if number not in needed:
                continue
            if block.value is not None:
                text = code.write(block.value)
                code.known[block.unknowns[0]] = text
            elif block.linear:
                self._linear(code, number, block, more)
            else:
                self._iterated(code, number, block, more)
        result = f"[{', '.join(code.write(e) for e in wanted)}]"
        return code.function(name, "t, x, u", result, **more)  # type: ignore[no-any-return]

    def _leaf(self, signal: Signal) -> Expr:
        pool = self.equations.graph.pool
        kinds = {i.name: i.symbol for i in self.equations.graph.inputs}
        leaf = kinds.get(signal.name) or pool.symbol(signal.name, Kind.INPUT)
        for _ in range(signal.order):
            leaf = pool.der(leaf)
        return leaf

    def _needed(self, wanted: list[Expr]) -> set[int]:
        """The blocks that the wanted expressions rest on."""
        giver = {u: k for k, b in enumerate(self.equations.blocks) for u in b.unknowns}
        needed: set[int] = set()
        stack = list(wanted)
        seen: set[Expr] = set()
        while stack:
            for node in topological([stack.pop()], stop=seen.__contains__):
                seen.add(node)
                k = giver.get(node)
                if k is not None and k not in needed:
                    needed.add(k)
                    block = self.equations.blocks[k]
                    stack += [block.value] if block.value is not None else list(block.zeros)
        return needed

    def _linear(self, code: Code, number: int, block: Block, more: dict[str, object]) -> None:
        """Matrix times unknowns = right side; factorised once where the matrix is constant."""
        pool = code.pool
        at_zero = pool.substitute(block.zeros, dict.fromkeys(block.unknowns, pool.zero))
        right = [code.write(pool.neg(z)) for z in at_zero]
        size = len(right)
        entries = [
            (i, j, slope)
            for i, row in enumerate(block.slopes)
            for j, slope in enumerate(row)
            if slope is not pool.zero
        ]
        numbers = [self.values.constant(slope) for _, _, slope in entries]
        solve = f"solve{number}"
        if all(n is not None for n in numbers):
            places = [(i, j) for i, j, _ in entries]
            more[solve] = _factorised(size, places, np.array(numbers, float), block.names)
            given = f"[{', '.join(right)}]"
        else:
            texts = [code.write(slope) for _, _, slope in entries]
            more[solve] = _solver(size, [(i, j) for i, j, _ in entries])
            given = f"[{', '.join(texts)}], [{', '.join(right)}]"
        names = [code.fresh() for _ in right]
        code.line(f"{', '.join(names)}, = {solve}({given})")
        code.known.update(zip(block.unknowns, names, strict=True))

    def _iterated(self, code: Code, number: int, block: Block, more: dict[str, object]) -> None:
        """A function of the unknowns gives zeros and slopes, and Newton's method its root."""
        names = [code.fresh() for _ in block.unknowns]
        inner = Code(code.pool, {**code.known, **dict(zip(block.unknowns, names, strict=True))},
                     self.values.constant)  # fmt: skip
        inner.names, inner.tables = code.names, code.tables
        inner._count, inner._depth = code._count, code._depth + 1
        zeros = ", ".join(inner.write(z) for z in block.zeros)
        slopes = ", ".join(f"[{', '.join(inner.write(s) for s in row)}]" for row in block.slopes)
        look, root = f"look{number}", f"newton{number}"
        code.line(f"def {look}({', '.join(names)}):")
        code.lines += inner.lines
        code.line(f"    return [{zeros}], [{slopes}]")
        code._count = inner._count
        more[root] = self._newton(number, block)
        code.line(f"{', '.join(names)}, = {root}({look})")
        code.known.update(zip(block.unknowns, names, strict=True))

    def _newton(self, number: int, block: Block) -> Callable[..., list[float]]:
        guesses = self._guess

        def newton(look: Callable[..., Any]) -> list[float]:
            size = len(block.unknowns)
            starts = [guesses.get(number), [0.0] * size, [1.0] * size, [-1.0] * size]
            for start in starts:
                found = None if start is None else _root(look, start)
                if found is not None:
                    guesses[number] = found
                    return found
            raise NoSolution(block.names)

        return newton


def _factorised(
    size: int, places: list[tuple[int, int]], numbers: Array, names: tuple[str, ...]
) -> Callable[[list[float]], Any]:
    """The solution for a right side, of a matrix that does not change."""
    if size > _DENSE:
        from scipy.sparse import csc_array
        from scipy.sparse.linalg import splu

        rows, columns = zip(*places, strict=True)
        try:
            factors = splu(csc_array((numbers, (rows, columns)), shape=(size, size)))
        except RuntimeError:
            raise NoSolution(names) from None
        return lambda b: factors.solve(np.array(b)).tolist()
    matrix = np.zeros((size, size))
    for (i, j), n in zip(places, numbers, strict=True):
        matrix[i, j] = n
    singular = np.linalg.cond(matrix) > _SINGULAR
    inverse = np.linalg.pinv(matrix) if singular else np.linalg.inv(matrix)
    if size <= 4:
        lines = inverse.tolist()
        return lambda b: [sum(c * v for c, v in zip(line, b, strict=True)) for line in lines]
    return lambda b: (inverse @ b).tolist()


def _solver(size: int, places: list[tuple[int, int]]) -> Callable[[list[float], list[float]], Any]:
    """The solution for a matrix and a right side."""
    if size == 1:
        return lambda a, b: [b[0] / a[0]]
    rows = [i for i, _ in places]
    columns = [j for _, j in places]

    def dense(entries: list[float], right: list[float]) -> Any:
        matrix = np.zeros((size, size))
        matrix[rows, columns] = entries
        try:
            return np.linalg.solve(matrix, right).tolist()
        except np.linalg.LinAlgError:
            return [math.nan] * size

    def sparse(entries: list[float], right: list[float]) -> Any:
        from scipy.sparse import csc_array
        from scipy.sparse.linalg import spsolve

        matrix = csc_array((entries, (rows, columns)), shape=(size, size))
        return spsolve(matrix, np.array(right)).tolist()

    return dense if size <= _DENSE else sparse


def _root(look: Callable[..., Any], start: list[float]) -> list[float] | None:
    """Newton's method with steps halved until the zeros shrink; None where it does not arrive."""
    x = list(start)
    try:
        zeros, slopes = look(*x)
    except (ArithmeticError, ValueError):
        return None
    for _ in range(_STEPS):
        size = max(map(abs, zeros))
        if not math.isfinite(size):
            return None
        try:
            step = (
                [zeros[0] / slopes[0][0]]
                if len(x) == 1
                else np.linalg.solve(np.array(slopes), np.array(zeros)).tolist()
            )
        except (ZeroDivisionError, np.linalg.LinAlgError):
            return x if size == 0 else None
        if not all(map(math.isfinite, step)):
            return None
        if all(abs(s) <= _EXACT * (abs(v) + 1e-300) for s, v in zip(step, x, strict=True)):
            return [v - s for v, s in zip(x, step, strict=True)]
        share = 1.0
        while True:
            trial = [v - share * s for v, s in zip(x, step, strict=True)]
            if trial == x:
                return x  # as exact as numbers are
            try:
                after, slopes_after = look(*trial)
                if sum(a * a for a in after) < sum(z * z for z in zeros) or size == 0:
                    break
            except (ArithmeticError, ValueError):
                pass
            share /= 2
            if share < 1e-12:
                return x if size < 1e-9 else None
        x, zeros, slopes = trial, after, slopes_after
        if not any(zeros):
            return x
    return None
