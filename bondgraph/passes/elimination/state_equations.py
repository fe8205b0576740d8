"""Turn the acausal equations into state equations: which variables are states, what gives which.

Storages that depend on each other and constraints on derivatives are no special case: equations
are differentiated as often as the structure asks for (Pryce, 2001), and of the variables that then
appear with their derivatives those that others determine are no states (Mattsson and Soderlind,
1993). Storages in integral causality are preferred as states, so that what is left over is what
the causality of the bond graph says. What stays in a loop is one block.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence, Set
from fractions import Fraction

from bondgraph.algebra.affine import rest
from bondgraph.algebra.derivative import Jets
from bondgraph.algebra.in_mode import in_mode
from bondgraph.algebra.nominal import Nominal
from bondgraph.algebra.sensitivity import sensitivity
from bondgraph.algebra.solve import solve
from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import VARIABLES, Expr, Kind, Op, Pool, topological
from bondgraph.ir.state import Block, Disturbance, Impulse, State, StateEquations
from bondgraph.passes.elimination.rings import rings
from bondgraph.structural.matching import decompose, match
from bondgraph.structural.reduce_index import Column, Reduced, reduce_index
from bondgraph.text.diagnostic import Report
from bondgraph.text.tuples import NamedTuple


class Wanted(NamedTuple):
    """What a simulation needs beyond the model.

    `modes` gives each boolean input its value; storages whose path is one of `static` or lies
    below one are taken as being at rest (quasi-static); values, inputs and sensors named in
    `disturbed` may be wrong; `numbers` are parameters that have another value than the model says.
    Where sensors are `measured` they are known signals, no parameter is taken to be nothing, and
    the equations hold no switch. Parameters that are `open` may still change: one that is zero is
    not taken to be nothing.
    """

    modes: Mapping[str, bool] = {}
    static: tuple[str, ...] = ()
    disturbed: tuple[str, ...] = ()
    numbers: Mapping[str, float] = {}
    measured: bool = False
    open: frozenset[str] = frozenset()


def state_equations(
    system: EquationSystem, integral: CausalGraph, wanted: Wanted, report: Report
) -> StateEquations | None:
    """The state equations of a bond graph in one mode; None with a diagnostic if there are none.

    Every variable, effort, flow and sensor that the equations determine is given by a block. What
    is left undetermined (a loop of flows in a junction structure without any element) is left out.
    Time is linear in the equations but for large loops.
    """
    return _Causaliser(system, integral, wanted, report).run()


def disturbance(pool: Pool, name: str) -> Disturbance:
    """The two signals by which something may be other than it is told."""
    gain = pool.symbol(f"gain of {name}", Kind.INPUT)
    return Disturbance(name, gain, pool.symbol(f"bias of {name}", Kind.INPUT))


class _Row(NamedTuple):
    equation: Equation
    zero: Expr  # with derivatives of variables as they stand, inside out
    orders: dict[Expr, int]  # highest derivative of each unknown


class _Causaliser:
    def __init__(
        self, system: EquationSystem, integral: CausalGraph, wanted: Wanted, report: Report
    ) -> None:
        self.system = system
        self.graph = system.graph
        self.pool = system.graph.pool
        self.wanted = wanted
        self.report = report
        self.jets = Jets(self.pool)
        self.static: list[str] = []
        self.disturbances = tuple(disturbance(self.pool, name) for name in wanted.disturbed)
        sensors = set() if wanted.measured else {Kind.SENSOR}
        self.unknown = (VARIABLES | sensors) - {Kind.UNKNOWN}
        self.rows = self._rows()
        self._open_rings()
        self.preferred = _preferred(system, integral)

    def run(self) -> StateEquations | None:
        if not self._without_surplus():
            return None
        reduced = reduce_index([r.orders for r in self.rows], self._wish)
        if not isinstance(reduced, Reduced):
            _tell_over(self.report, [self.rows[k].equation for k in reduced])
            return None
        order = {v: k for k, v in enumerate(self.system.unknowns)}
        states = sorted(reduced.states, key=lambda x: (order.get(x[0], len(order)), x[1]))
        impulses = self._impulses({variable for variable, _ in states})
        blocks = self._blocks(reduced, states)
        if blocks is None:
            return None
        initial = {e.state: e.initial for e in self.system.equations if e.state is not None}
        made = []
        for variable, n in states:
            own = self._symbol(variable, n)
            rate = self._symbol(variable, n + 1)
            start = initial.get(variable) if n == 0 else None
            made.append(State(own.symbol.name, own, rate, start, self._capacities(variable, n)))
        return StateEquations(
            self.graph,
            tuple(made),
            tuple(blocks),
            impulses,
            tuple(self.static),
            self.disturbances,
            tuple(sorted(self.wanted.modes.items())),
        )

    def _impulses(self, alive: Set[Expr]) -> tuple[Impulse, ...]:
        """Let every storage whose state follows from others take an impulse from outside."""
        pool = self.pool
        found = []
        for k, row in enumerate(() if self.wanted.measured else self.rows):
            equation = row.equation
            state = equation.state
            if equation.kind != "state" or state is None or state in alive:
                continue
            if not self._at_rest(equation.name):
                name = state.symbol.name
                signal = pool.symbol(f"impulse of {name}", Kind.INPUT)
                self.rows[k] = row._replace(zero=pool.sub(row.zero, signal))
                found.append(Impulse(equation.name, name, state, signal, equation.initial))
        return tuple(found)

    def _capacities(self, variable: Expr, order: int) -> tuple[Expr, ...]:
        """How much of a state goes with a unit of each effort or flow, by the laws it is in."""
        pool = self.pool
        found = []
        for node in self.graph.nodes if order == 0 else ():
            if all(port.state is not variable for port in node.ports):
                continue
            others = [port.output for port in node.ports]
            for law in node.laws:
                own, *pairs = sensitivity(pool, law.zero, [variable, *others]).values()
                found += [pool.div(pair, own) for pair in pairs if pair is not pool.zero is not own]
        replaced = {**self._disturbed(), **self.system.shared}
        return tuple(pool.substitute(pool.logged(found), replaced))

    # ---------------------------------------------------------------- equations

    def _rows(self) -> list[_Row]:
        """The equations of the mode, with what may be wrong and without what is nothing."""
        pool, system = self.pool, self.system
        replaced, absent = self._disturbed(), self._absent()
        modes = () if self.wanted.measured else [i for i in system.graph.inputs if i.mode]
        truth = {i.symbol: self.wanted.modes[i.name] for i in modes}
        errors = {d.name: d for d in self.disturbances}
        rows = []
        logged = pool.logged([e.zero for e in system.equations])  # a law gets what a sensor says
        for equation, zero in zip(system.equations, logged, strict=True):
            if equation.kind == "state" and self._at_rest(equation.name):
                assert equation.rate is not None
                zero = equation.rate
                self.static.append(equation.name)
            if equation.kind == "sensor" and equation.name in errors:
                own = equation._replace(zero=zero)
                zero, counted = self._misread(own, errors[equation.name])
                if counted is not None:
                    rows.append(counted)
            try:
                zero = pool.substitute([zero], replaced | absent)[0]
            except ZeroDivisionError:  # a law has no value: the run says so
                zero = pool.substitute([zero], replaced)[0]
            zero = in_mode(pool, [zero], truth)[0] if truth else zero
            zero = self.jets.of(zero)
            rows.append(_Row(equation, zero, _orders(zero, self.unknown)))
        return rows

    def _open_rings(self) -> None:
        """Where flows or efforts go around a ring, let there be none."""
        pool = self.pool
        nominal = Nominal(self.graph)
        numbers = self.wanted.numbers
        told = {
            v.symbol: pool.num(Fraction(numbers[v.name]))
            for v in self.graph.values
            if v.name in numbers
        }

        def number(expr: Expr) -> float | None:
            return nominal.value(pool.substitute([expr], told)[0])

        rows = [(r.equation, r.zero) for r in self.rows]
        for k, variable in rings(self.system, rows, number).items():
            self.rows[k] = _Row(self.rows[k].equation, variable, _orders(variable, self.unknown))

    def _misread(self, equation: Equation, own: Disturbance) -> tuple[Expr, _Row | None]:
        """The equation of a sensor that may be wrong; an encoder counts wrong from then on.

        What was counted before stays: a lost pulse is lost for ever, but does not come back when
        all are counted again.
        """
        pool = self.pool
        sensor = next(s for s in self.graph.sensors if s.name == equation.name)
        reads = pool.sub(sensor.symbol, equation.zero)
        if sensor.counts is None:
            terms = (1, sensor.symbol), (-1, pool.mul(own.gain, reads)), (-1, own.bias)
            return pool.add(*terms), None
        counted = pool.symbol(f"{sensor.name}.counted", Kind.INTEGRAL)
        rate = self.jets.of(pool.mul(own.gain, pool.der(reads)))
        zero = pool.sub(pool.der(counted), rate)
        integral = equation._replace(
            kind="integral", zero=zero, state=counted, rate=rate, variables=(counted,)
        )
        row = _Row(integral, zero, _orders(zero, self.unknown))
        return pool.add((1, sensor.symbol), (-1, counted), (-1, own.bias)), row

    def _at_rest(self, name: str) -> bool:
        return any(
            name == path or (name.startswith(path) and name[len(path)] in ".[")
            for path in self.wanted.static
        )

    def _disturbed(self) -> dict[Expr, Expr]:
        """Values and inputs that may be wrong, each replaced by what acts."""
        pool = self.pool
        symbols = {v.name: v.symbol for v in self.graph.values}
        symbols |= {i.name: i.symbol for i in self.graph.inputs}
        return {
            symbols[d.name]: pool.add((1, pool.mul(d.gain, symbols[d.name])), (1, d.bias))
            for d in self.disturbances
            if d.name in symbols
        }

    def _absent(self) -> dict[Expr, Expr]:
        """Parameters that are zero: an inertia of nothing stores nothing."""
        nominal = Nominal(self.graph)
        disturbed = {*self.wanted.disturbed, *self.wanted.open}
        numbers = self.wanted.numbers
        zero = {}
        for value in () if self.wanted.measured else self.graph.values:
            number = numbers[value.name] if value.name in numbers else nominal.value(value.symbol)
            if number == 0 and value.name not in disturbed:
                zero[value.symbol] = self.pool.zero
        return zero

    def _without_surplus(self) -> bool:
        """Drop what nothing determines, and refuse what contradicts itself."""
        self.rows = [r for r in self.rows if r.zero is not self.pool.zero]
        columns = self._columns()
        parts = decompose([[columns[v] for v in r.orders] for r in self.rows], len(columns))
        if parts.over_rows:
            rows = [self.rows[r] for r in parts.over_rows]
            _tell_over(self.report, [r.equation for r in rows])
            return False
        square = set(parts.square_rows)
        self.rows = [r for k, r in enumerate(self.rows) if k in square]
        return True

    def _columns(self) -> dict[Expr, int]:
        found: dict[Expr, int] = {}
        for row in self.rows:
            for variable in row.orders:
                found.setdefault(variable, len(found))
        return found

    # ------------------------------------------------------------------- blocks

    def _blocks(self, reduced: Reduced, states: Sequence[Column]) -> list[Block] | None:
        import networkx as nx

        pool = self.pool
        c, d = reduced.differentiated, reduced.orders
        integrated = set(states)
        unknown = [(v, m) for v, n in d.items() for m in range(n + 1) if (v, m) not in integrated]
        plain = {
            self.pool.der(v, m): self._symbol(v, m)
            for v, n in d.items()
            for m in range(1, n + 1)
        }
        place = {self._symbol(v, m): k for k, (v, m) in enumerate(unknown)}
        zeros: list[Expr] = []
        origin: list[Equation] = []
        for row, most in zip(self.rows, c, strict=True):
            for order in range(most + 1):
                zeros.append(self.jets.of(row.zero, order))
                origin.append(row.equation)
        zeros = pool.substitute(zeros, plain)
        rows = [[place[s] for s in topological([z]) if s in place] for z in zeros]
        row_of, column_of = match(rows, len(place))
        if -1 in column_of or -1 in row_of:
            _tell_over(self.report, [e for e, k in zip(origin, column_of, strict=True) if k < 0])
            return None
        graph = nx.DiGraph()
        graph.add_nodes_from(range(len(zeros)))
        for r, members in enumerate(rows):
            graph.add_edges_from((row_of[m], r) for m in members if row_of[m] != r)
        condensed = nx.condensation(graph)
        symbols = list(place)
        first = {n: min(condensed.nodes[n]["members"]) for n in condensed}
        blocks = []
        for n in nx.lexicographical_topological_sort(condensed, key=first.__getitem__):
            members = sorted(condensed.nodes[n]["members"])
            blocks.append(
                self._block(
                    [zeros[r] for r in members],
                    [symbols[column_of[r]] for r in members],
                    [origin[r] for r in members],
                )
            )
        return blocks

    def _block(self, zeros: list[Expr], unknowns: list[Expr], equations: list[Equation]) -> Block:
        pool = self.pool
        laws = [e for e in equations if e.kind in ("law", "sensor")] or equations
        names = tuple(dict.fromkeys(e.name for e in laws))
        origins = tuple(dict.fromkeys(e.origin for e in laws))
        if len(zeros) == 1:
            found = solve(pool, zeros[0], unknowns[0])
            if found is not None:
                return Block(tuple(unknowns), found.value, names, origins)
        slopes = tuple(tuple(sensitivity(pool, zero, unknowns).values()) for zero in zeros)
        rests = [rest(pool, zero, unknowns) for zero in zeros]
        linear = tuple(r for r in rests if r is not None)
        linear = linear if len(linear) == len(zeros) else ()
        return Block(tuple(unknowns), None, names, origins, tuple(zeros), slopes, linear)

    def _wish(self, variable: Expr) -> tuple[int, int]:
        """How much a variable is to be integrated rather than computed: the least first."""
        return self.preferred.get(variable, 0), variable.id

    def _symbol(self, variable: Expr, order: int) -> Expr:
        """The variable itself, or a symbol of its own for its derivative."""
        if not order:
            return variable
        return self.pool.symbol(variable.symbol.name + "'" * order, Kind.EFFORT)


def _orders(zero: Expr, unknown: Set[Kind]) -> dict[Expr, int]:
    """The highest derivative of each unknown in an equation."""
    found: dict[Expr, int] = {}
    seen = {zero}
    stack = [zero]
    while stack:
        node = stack.pop()
        order = 0
        while node.op is Op.DER:
            order, node = order + 1, node.args[0]
        if node.op is Op.SYM:
            if node.symbol.kind in unknown:
                found[node] = max(found.get(node, 0), order)
            continue
        for arg in node.args:
            if arg not in seen:
                seen.add(arg)
                stack.append(arg)
    return dict(sorted(found.items(), key=lambda item: item[0].id))


def _preferred(system: EquationSystem, integral: CausalGraph) -> dict[Expr, int]:
    """How much each variable is wanted as a state: not at all, dependent, storage, integral."""
    wish: dict[Expr, int] = {}
    for storage in integral.storages:
        state = system.graph.nodes[storage.node].ports[storage.port].state
        if state is not None:
            wish[state] = 2 if storage.integral else 1
    for equation in system.equations:
        if equation.kind == "integral" and equation.state is not None:
            wish[equation.state] = 3
    return wish


def _tell_over(report: Report, equations: Iterable[Equation]) -> None:
    """Say which equations contradict each other, by their elements."""
    found = list(equations)
    names = list(dict.fromkeys(f"`{e.name}`" for e in found))
    shown = ", ".join(names[:4]) + (f" and {len(names) - 4} more" if len(names) > 4 else "")
    report.error(
        "no-state-equations",
        f"The plant has no motion that satisfies {shown}: these equations leave no freedom.",
        *list(dict.fromkeys(e.origin for e in found))[:4],
        help="Look for two sources that fix the same effort or flow, or an element that is missing"
        " between them; a switch may do so in one mode only.",
    )
