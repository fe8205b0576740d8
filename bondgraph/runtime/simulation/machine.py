"""State equations with numbers: rates and outputs as functions of time, state and inputs.

What can be seen of a virtual machine, by name: states, sensors, `let`s, efforts and flows.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.expr import CONSTANTS, Expr, Kind, Op, Pool, topological
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.state import Block, StateEquations
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation.algebraic_loops import NoSolution, factorised, iteration, solver
from bondgraph.runtime.simulation.code import Code
from bondgraph.runtime.simulation.parameters import Values
from bondgraph.text.tuples import NamedTuple

_LEAST = 1e-15  # of a state that nothing else says the size of
_FAILS = (ArithmeticError, ValueError, NoSolution)
_GIVEN = CONSTANTS | {Kind.INPUT, Kind.UNKNOWN, Kind.MODE}


class Signal(NamedTuple):
    """An input of the machine, or a derivative of it."""

    name: str
    order: int


class Machine:
    """A virtual machine with numbers.

    `values` gives parameters and initial values, `outputs` the expressions to observe, in the
    variables of the state equations. `signals` tells what `rates` wants as its third argument: a
    value for each, in that order; `impulses` are the places of those that hit the dependent
    storages (None: it has no effect). Raises KeyError with the name of a parameter without a value.
    """

    def __init__(
        self, equations: StateEquations, values: Values, outputs: Sequence[Expr] = ()
    ) -> None:
        self.equations = equations
        self.values = values
        self.outputs = tuple(outputs)
        self.states = tuple(s.name for s in equations.states)
        self.signals = self._signals()
        place = {s.name: k for k, s in enumerate(self.signals) if s.order == 0}
        self.impulses = tuple(place.get(i.signal.symbol.name) for i in equations.dependent)
        self._newton: dict[int, Callable[..., list[float]]] = {}
        wanted = [s.rate for s in equations.states]
        self._rates = self._compiled("rates", wanted)
        self._observed: Callable[..., Any] | None = None
        self._single: dict[Expr, Callable[..., float]] = {}

    def rates(self, t: float, x: Sequence[float], u: Sequence[float]) -> Sequence[float]:
        """The derivative of each state at time t (s); NaN where a law or loop has no solution."""
        try:
            found: Sequence[float] = self._rates(t, x, u)
            return found
        except _FAILS:
            return [math.nan] * len(self.states)

    def observe(self, t: float, x: Sequence[float], u: Sequence[float]) -> Sequence[float]:
        """The value of each output; NaN for those that rest on a law or loop without solution."""
        if self._observed is None:
            self._observed = self._compiled("observe", self.outputs)
        try:
            found: Sequence[float] = self._observed(t, x, u)
            return found
        except _FAILS:
            return [self._alone(e)(t, x, u) for e in self.outputs]

    def content(self, t: float, x: Sequence[float], u: Sequence[float]) -> Array:
        """What each dependent storage holds; NaN where a law has no value."""
        return np.array([self._alone(i.state)(t, x, u) for i in self.equations.dependent])

    def _alone(self, output: Expr) -> Callable[..., float]:
        """A function of one output that gives NaN where it has no value."""
        if output not in self._single:
            compiled = self._compiled("observe", [output])

            def single(t: float, x: Sequence[float], u: Sequence[float]) -> float:
                try:
                    return float(compiled(t, x, u)[0])
                except _FAILS:
                    return math.nan

            self._single[output] = single
        return self._single[output]

    def trouble(self, t: float, x: Sequence[float], u: Sequence[float]) -> str:
        """Which law or loop has no value here, in words; empty where all have one."""
        for signal, value in zip(self.signals, u, strict=True):
            if not math.isfinite(value):
                return f"the input `{signal.name}` has no value there"
        for block in self.equations.blocks:
            if all(math.isfinite(self._alone(unknown)(t, x, u)) for unknown in block.unknowns):
                continue
            names = ", ".join(f"`{n}`" for n in block.names[:4])
            if block.value is not None:
                return f"the law of {names} has no value there"
            return f"the loop through {names} has no solution there that iteration could find"
        return ""

    def start(self) -> dict[str, float]:
        """What the model declares that states and dependent storages hold at the start."""
        found = {s.name: s.initial for s in self.equations.states}
        found |= {i.name: i.initial for i in self.equations.dependent}
        return {n: self.values.number(e) for n, e in found.items() if e is not None}

    def undeclared(self) -> tuple[str, ...]:
        """The states whose initial value the model does not declare."""
        return tuple(s.name for s in self.equations.states if s.initial is None)

    def scale(self, t: float, x: Sequence[float], u: Sequence[float]) -> Array:
        """How much of each state matters: what goes with one unit of an effort or flow here.

        Where nothing tells, it is the state itself, or 1.
        """
        found = []
        for state, own in zip(self.equations.states, x, strict=True):
            sizes = [abs(self._alone(c)(t, x, u)) for c in state.capacities]
            sizes = [s for s in sizes if 0 < s < math.inf]
            found.append(min(sizes, default=max(abs(own), _LEAST) if own else 1.0))
        return np.array(found)

    def jacobian(self, t: float, x: Array, u: Sequence[float]) -> Array:
        """d rates / d states, shape (states, states), by central differences."""
        step = 1e-6 * np.maximum(np.abs(x), self.scale(t, x.tolist(), u))
        columns = []
        for k, h in enumerate(step):
            up, down = x.copy(), x.copy()
            up[k] += h
            down[k] -= h
            change = np.subtract(self.rates(t, up.tolist(), u), self.rates(t, down.tolist(), u))
            columns.append(change / (2 * h))
        return np.asarray(np.nan_to_num(np.array(columns).T.reshape(len(x), len(x))))

    def pattern(self) -> Any:
        """Which rate depends on which state, as a sparse matrix of ones."""
        from scipy.sparse import csc_array

        masks = {s.symbol: 1 << k for k, s in enumerate(self.equations.states)}

        def mask(expr: Expr) -> int:
            for node in topological([expr], stop=masks.__contains__):
                if node not in masks:
                    masks[node] = 0
                    for arg in node.args:
                        masks[node] |= masks[arg]
            return masks[expr]

        for block in self.equations.blocks:
            roots = [*block.zeros, *(slope for row in block.slopes for slope in row)]
            own = [mask(e) for e in (roots if block.value is None else [block.value])]
            whole = 0
            for one in own:
                whole |= one
            masks.update(dict.fromkeys(block.unknowns, whole))
        size = len(self.states)
        rows, columns = [], []
        for i, state in enumerate(self.equations.states):
            found = mask(state.rate)
            held = [k for k in range(size) if found >> k & 1] if found else []
            rows += [i] * len(held)
            columns += held
        return csc_array((np.ones(len(rows)), (rows, columns)), shape=(size, size))

    # ------------------------------------------------------------- compilation

    def _signals(self) -> tuple[Signal, ...]:
        blocks = self.equations.blocks
        roots = [e for b in blocks for e in (b.zeros if b.value is None else (b.value,))]
        found: dict[Signal, None] = {}
        roots += [c for s in self.equations.states for c in s.capacities]
        for node in topological([*roots, *self.outputs]):
            order = 0
            while node.op is Op.DER:
                order, node = order + 1, node.args[0]
            if node.kind in (Kind.INPUT, Kind.UNKNOWN):
                found[Signal(node.symbol.name, order)] = None
        return tuple(found)

    def _compiled(self, name: str, wanted: Sequence[Expr]) -> Callable[..., Any]:
        more: dict[str, object] = {}

        def solved(code: Code, number: int, block: Block) -> None:
            solve = self._linear if block.rests else self._iterated
            solve(code, number, block, more)

        code = Code(self.equations.graph.pool, self.leaves(), self.values.constant)
        result = f"[{', '.join(self.texts(code, wanted, solved))}]"
        return code.function(name, "t, x, u", result, **more)

    def leaves(self) -> dict[Expr, str]:
        """What states and signals are called in a source: `x[k]`, `u[k]`."""
        found = {s.symbol: f"x[{k}]" for k, s in enumerate(self.equations.states)}
        return found | {self._leaf(s): f"u[{k}]" for k, s in enumerate(self.signals)}

    def texts(
        self,
        code: Code,
        wanted: Sequence[Expr],
        solved: Callable[[Code, int, Block], None],
    ) -> list[str]:
        """The texts of expressions, with lines before them for the blocks that they rest on.

        `solved` writes those of a block that is a loop, and makes its unknowns known.
        """
        needed = self.needed(wanted)
        for number, block in enumerate(self.equations.blocks):
            if number not in needed:
                continue
            if block.value is not None:
                code.define(block.unknowns[0], block.value)
            else:
                solved(code, number, block)
        return code.text(wanted)

    def _leaf(self, signal: Signal) -> Expr:
        pool = self.equations.graph.pool
        kinds = {i.name: i.symbol for i in self.equations.graph.inputs}
        leaf = kinds.get(signal.name) or pool.symbol(signal.name, Kind.INPUT)
        return pool.der(leaf, signal.order)

    def needed(self, wanted: Sequence[Expr]) -> set[int]:
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
        rests, entries = equations_of(code.pool, block)
        size = len(rests)
        numbers = [self.values.constant(slope) for _, _, slope in entries]
        solve = f"solve{number}"
        if all(n is not None for n in numbers):
            places = [(i, j) for i, j, _ in entries]
            more[solve] = factorised(size, places, np.array(numbers, float))
            given = f"[{', '.join(code.text(rests))}]"
        else:
            more[solve] = solver(size, [(i, j) for i, j, _ in entries])
            texts = code.text([*rests, *(slope for _, _, slope in entries)])
            given = f"[{', '.join(texts[size:])}], [{', '.join(texts[:size])}]"
        _solved(code, block, f"{solve}({given})")

    def _iterated(self, code: Code, number: int, block: Block, more: dict[str, object]) -> None:
        """A function of the unknowns gives zeros and slopes, and Newton's method its root."""
        size = len(block.unknowns)
        names = [code.free.new("v") for _ in block.unknowns]
        leaves = dict(zip(block.unknowns, names, strict=True))
        inner = Code(code.pool, leaves, self.values.constant, code)
        texts = inner.text([*block.zeros, *(s for row in block.slopes for s in row)])
        slopes = [f"[{', '.join(texts[k : k + size])}]" for k in range(size, len(texts), size)]
        look, root = f"look{number}", f"newton{number}"
        code.line(f"def {look}({', '.join(names)}):")
        code.lines += inner.lines
        code.line(f"    return [{', '.join(texts[:size])}], [{', '.join(slopes)}]")
        more[root] = self._newton.setdefault(number, iteration(size))
        _solved(code, block, f"{root}({look})")


def equations_of(pool: Pool, block: Block) -> tuple[list[Expr], list[tuple[int, int, Expr]]]:
    """The right side of a linear block, and the entries of its matrix that are not zero."""
    entries = [
        (i, j, slope)
        for i, row in enumerate(block.slopes)
        for j, slope in enumerate(row)
        if slope is not pool.zero
    ]
    return [pool.neg(r) for r in block.rests], entries


def _solved(code: Code, block: Block, solution: str) -> None:
    """The unknowns of a block from a list of them."""
    names = [code.free.new("v") for _ in block.unknowns]
    code.line(f"{', '.join(names)}, = {solution}")
    for unknown, name in zip(block.unknowns, names, strict=True):
        code.know(unknown, name)


class Observed(NamedTuple):
    """Names with the expression of each, in the variables of the state equations."""

    names: tuple[str, ...]
    exprs: tuple[Expr, ...]


def observed(system: EquationSystem, equations: StateEquations, record: Sequence[str]) -> Observed:
    """All states, sensors and `let`s, and the signals to `record`.

    What the equations leave open is left out. Raises KeyError for a name to record that is none.
    """
    graph, pool = system.graph, system.graph.pool
    everything = named(graph)
    wanted: dict[str, Expr] = {}
    for equation in system.equations:
        if equation.state is not None:
            wanted[equation.state.symbol.name] = equation.state
    wanted |= {s.name: s.symbol for s in graph.sensors if s.same_as is None}
    wanted |= {let.name: let.value for let in graph.lets}
    wanted |= {name: everything[name] for name in record}
    found = {u for b in equations.blocks for u in b.unknowns}
    found |= {s.symbol for s in equations.states}
    own = pool.substitute(pool.logged(wanted.values()), system.shared)
    kept = {n: e for n, e in zip(wanted, own, strict=True) if _computable(e, found)}
    return Observed(tuple(kept), tuple(kept.values()))


def named(graph: BondGraph) -> Mapping[str, Expr]:
    """Every effort and flow by the name that a person knows it by (`m[1].el.i.f`)."""
    found: dict[str, Expr] = {}
    for node in graph.nodes:
        if node.common is not None:
            found[node.common.symbol.name] = node.common
        for port in node.ports:
            for variable in (port.effort, port.flow):
                found[variable.symbol.name] = variable
    return found


def _computable(expr: Expr, found: set[Expr]) -> bool:
    return all(
        node.op is not Op.DER
        and (node.op is not Op.SYM or node in found or node.symbol.kind in _GIVEN)
        for node in topological([expr])
    )
