"""One elimination: forward from what is known, every variable once, cheapest way first.

An ideal sensor makes a value known while it takes no power; with both facts the equations chain
forward from sensors and sources, and each equation that is left when its variables are computed
is an analytical redundancy relation. Cheapest means: no integration of a storage, then no
division by a signal, then the lowest derivative, then the shortest path (Knuth's generalisation
of Dijkstra's algorithm, 1977); ties go by the surroundings and never by names. What stalls is a
loop (`tearing`) or a storage whose only access is through its integral.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Mapping
from contextlib import suppress

from bondgraph.algebra.conjugates import two_valued
from bondgraph.algebra.nominal import Nominal
from bondgraph.algebra.solve import ITERATED, Solution, solve
from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import CONSTANTS, VARIABLES, Expr, Kind, Op, symbols, variables
from bondgraph.ir.nodes import has, occurs
from bondgraph.ir.residuals import Closing, How, Missing, ReducedSystem, Step
from bondgraph.passes.elimination.colour import colours
from bondgraph.passes.elimination.cost import FREE_START, ITERATION, LOOP, Cost, after
from bondgraph.passes.elimination.initial import without_free_integrals
from bondgraph.passes.elimination.linear_block import (
    LARGEST,
    linear_equation,
    linear_equations,
    products,
    solve_block,
)
from bondgraph.passes.elimination.shortfall import (
    initial_value_needed,
    loop_unsolvable,
    unaccounted,
)
from bondgraph.passes.elimination.tearing import Loops
from bondgraph.passes.elimination.turned import angular, turned_pair
from bondgraph.structural.matching import components, decompose
from bondgraph.text.tuples import NamedTuple

#: Relations are tangled that rest on every step so many times, few steps not counted.
_TANGLED, _FEW = 4, 1000

#: A block of so many variables is solved by sparse elimination, a smaller one by tearing.
_LARGE = 30


class _Offer(NamedTuple):
    """An equation that could give a variable: the entries of the heap.

    Of those that cost the same, the one that `rests` on fewest parameters and signals is best: a
    sensor of the variable tells it without the errors of all that another one takes to compute it.
    """

    cost: Cost
    rests: int
    equation_colour: int
    variable_colour: int
    equation: int
    variable: int
    solution: Solution
    how: How


class _Known:
    """What is asked of the equations of a system, whatever the order of their elimination."""

    def __init__(self, system: EquationSystem) -> None:
        self.system = system
        self.nominal = Nominal(system.graph)
        self.colour, self.variable_colour = colours(system)
        self.position = {v: i for i, v in enumerate(system.unknowns)}
        self.holders: dict[Expr, list[int]] = {v: [] for v in system.unknowns}
        for row, equation in enumerate(system.equations):
            for variable in equation.variables:
                self.holders[variable].append(row)
        #: equations between two unknowns that may hold the sine of an angle
        self.angular = [
            row for row, e in enumerate(system.equations) if e.state is None and angular(e.zero)
        ]
        self._solutions: dict[tuple[int, Expr], Solution | None] = {}

    def solution(self, row: int, variable: Expr) -> Solution | None:
        """The variable from an equation, None where it cannot be had."""
        key = row, variable
        if key not in self._solutions:
            zero, nominal = self.system.equations[row].zero, self.nominal
            self._solutions[key] = solve(
                self.system.graph.pool, zero, variable, nominal.vanishes, nominal.value
            )
        return self._solutions[key]


#: Equations up to which the rank of those that no sensor reaches is taken as well.
_CHECKED = 2000


class Strategy(NamedTuple):
    """How to eliminate.

    Derivatives up to the order `free` are not avoided: shorter paths count more. Without `starts`
    no integral is used whose initial value is not declared; what is less late than `eager` is taken
    before a loop is looked for.
    """

    free: int = 0
    starts: bool = True
    eager: int = 0


class Chain:
    """The state of one elimination; one by another strategy has in common what is `known`."""

    def __init__(
        self,
        system: EquationSystem,
        strategy: Strategy | None = None,
        known: _Known | None = None,
    ) -> None:
        chosen = strategy or Strategy()
        self.known = known or _Known(system)
        self.system = system
        self.free = chosen.free
        self.starts = chosen.starts
        self.eager = chosen.eager
        self.pool = system.graph.pool
        self.waiting = [len(e.variables) for e in system.equations]
        self.used = [False] * len(system.equations)
        self.holders = self.known.holders
        self.closed: dict[Expr, Expr] = {}
        self.cost: dict[Expr, Cost] = {}
        self.steps: dict[Expr, Step] = {}
        self.sequence: dict[Expr, int] = {}
        self.turn = itertools.count()  # a variable may be computed anew: no two have the same
        self.heap: list[_Offer] = []
        self.later: list[_Offer] = []
        self.nominal = self.known.nominal
        self.delayed = {s.name for s in system.graph.sensors if s.delay}
        self.loops = Loops(self.pool, self.nominal, patient=not chosen.starts)
        self.oversized: list[list[Equation]] = []  # linear loops too large to be written out

    # ---------------------------------------------------------------- chaining

    def start(self) -> None:
        """Look at every equation once: sources, sensors and empty ones begin the chain."""
        for row, count in enumerate(self.waiting):
            self.look(row, count)

    def look(self, row: int, count: int) -> None:
        """An equation has lost an unknown: it may now give its last one, or be a relation."""
        if count == 0:
            self.used[row] = True
            row = self.at_junction(row)
            with suppress(ZeroDivisionError):  # by what is always zero: the count will miss it
                self.loops.row(row, self.substituted(self.system.equations[row].zero))
        elif count == 1:
            self.offer(row)

    def at_junction(self, row: int) -> int:
        """Let a relation stand at a junction, where a person looks for it, not at an element.

        If a junction's balance gave a variable only for this element to contradict it, the element
        can give it as well, and the balance is the relation.
        """
        equation = self.system.equations[row]
        if equation.kind not in ("law", "state"):
            return row
        for variable in equation.variables:
            step = self.steps[variable]
            if step.how == "loop":  # torn: the balance has yet to give another variable
                continue
            if step.equation.kind != "balance" or len(self.holders[variable]) != 2:
                continue
            found = solve(self.pool, equation.zero, variable, self.nominal.vanishes)
            if found is None or found.hard:
                continue
            balance = next(r for r in self.holders[variable] if r != row)
            try:
                closed = self.substituted(found.value)
            except ZeroDivisionError:  # by what is always zero: the element cannot give it
                continue
            how: How = "solved" if equation.state is None else "differentiated"
            self.closed[variable] = closed
            self.steps[variable] = Step(variable, found.value, closed, equation, how)
            self.sequence[variable] = next(self.turn)
            return balance
        return row

    def offer(self, row: int) -> None:
        """An equation with one unknown left offers it, if it can be solved for it."""
        equation = self.system.equations[row]
        variable = next(v for v in equation.variables if v not in self.closed)
        how: How
        if variable is equation.state:
            assert equation.rate is not None
            free = equation.initial is None
            if free and not self.starts:
                return
            start = equation.initial or self.pool.symbol(f"{variable.symbol.name}.0", Kind.FREE)
            solution = Solution(self.pool.integral(equation.rate, start), False, False)
            how = "integrated"
        else:
            free = False
            found = self.known.solution(row, variable)
            if found is None:
                return
            solution = found
            how = "inverted" if found.inverted else "solved"
            if equation.state is not None:
                how = "differentiated"
        others = [self.cost[v] for v in equation.variables if v is not variable]
        late = 0
        if equation.kind == "state" and how == "integrated":
            late = FREE_START if free else int(not self.commanded(variable, equation))
        elif solution.hard == ITERATED or (solution.hard and not self.starts):
            late = ITERATION
        derived = equation.kind != "balance" and has([solution.value], Op.DER)
        cost = after(others, late, solution.hard, derived, self.free)
        if equation.kind == "sensor" and equation.name in self.delayed:
            cost = cost._replace(depth=cost.depth + 1)  # what is known at once is taken before
        rests = sum(s.symbol.kind not in VARIABLES for s in symbols(solution.value))
        offer = _Offer(
            cost, rests, self.known.colour[row], self.known.variable_colour[variable], row,
            self.known.position[variable], solution, how,
        )  # fmt: skip
        heapq.heappush(self.later if late else self.heap, offer)

    def commanded(self, variable: Expr, equation: Equation) -> bool:
        """Whether an `int(...)` of the model adds up inputs alone, which no sensor says better."""
        assert equation.rate is not None
        if variable.kind is not Kind.INTEGRAL:
            return False
        told = (Kind.INPUT, Kind.MODE, *CONSTANTS)
        with suppress(ZeroDivisionError):  # by what is always zero: it is never taken
            return all(s.kind in told for s in symbols(self.substituted(equation.rate)))
        return False

    def run(self) -> None:
        """Take the cheapest offers until nothing is offered any more."""
        while self.heap:
            offer = heapq.heappop(self.heap)
            variable = self.system.unknowns[offer.variable]
            if not self.used[offer.equation] and variable not in self.closed:
                self.take(offer, variable)

    def take(self, offer: _Offer, variable: Expr) -> None:
        """Accept an offer."""
        equation = self.system.equations[offer.equation]
        try:
            closed = self.substituted(offer.solution.value)
        except ZeroDivisionError:
            self.without(offer.equation, variable)
            return
        self.used[offer.equation] = True
        step = Step(variable, offer.solution.value, closed, equation, offer.how)
        self.settle(variable, step, offer.cost)

    def without(self, row: int, variable: Expr) -> None:
        """An equation loses its last unknown where what stands before it is zero: a relation."""
        with suppress(ZeroDivisionError):  # by what is always zero: the count will miss it
            expr = self.substituted(self.system.equations[row].zero)
            if not occurs(variable, expr):
                self.used[row] = True
                self.loops.row(row, expr)

    def settle(self, variable: Expr, step: Step, cost: Cost) -> None:
        """A variable is computed: its equations have an unknown less."""
        self.closed[variable] = step.closed
        self.cost[variable] = cost
        self.steps[variable] = step
        self.sequence[variable] = next(self.turn)
        for row in self.holders[variable]:
            self.waiting[row] -= 1
            if not self.used[row]:
                self.look(row, self.waiting[row])

    def substituted(self, expr: Expr) -> Expr:
        """An expression of variables in known signals."""
        return self.pool.substitute([expr], self.closed)[0]

    # ------------------------------------------------------------------ stalls

    def stalled(self) -> bool:
        """Make progress where chaining has stopped; False when there is none to be made."""
        self.loops.solve_algebraic()
        if self.postponed(self.eager) or self.turned() or self.tear(states=False):
            return True
        if self.postponed() or self.tear_two_valued():
            return True
        return self.tear(states=True) or self.tear(states=True, stubborn=True)

    def postponed(self, most: float = math.inf) -> bool:
        """Take the cheapest integral or iteration that is possible, if it is less late."""
        while self.later and self.later[0].cost.late < most:
            offer = heapq.heappop(self.later)
            variable = self.system.unknowns[offer.variable]
            if self.used[offer.equation] or variable in self.closed:
                continue
            with suppress(ZeroDivisionError):  # by what is always zero: `take` knows what to do
                if self.loops.open_in(self.substituted(offer.solution.value)):
                    continue
            self.take(offer, variable)
            return True
        return False

    def turned(self) -> bool:
        """Solve for two unknowns that are those of a frame turned by a known angle."""
        heads = [r for r in self.known.angular if not self.used[r] and self.waiting[r] == 2]
        if not heads:
            return False
        lines = []
        for row in self.around(heads):
            zero = self.system.equations[row].zero
            line = linear_equation(
                self.pool, row, zero, self.free_in(row), self.substituted,
                fits=lambda slope: not variables(slope),
            )  # fmt: skip
            if line is not None:
                lines.append(line)
        found = turned_pair(self.pool, lines, self.nominal.vanishes)
        if found is None:
            return False
        for row in found.equations:
            self.used[row] = True
        for variable, value in found.values.items():
            self.loops.give(variable, found.equations, value)
            self.torn(variable, self.holders[variable][0])
        return True

    def around(self, heads: list[int]) -> list[int]:
        """Unused equations that hold an unknown which those of two unknowns tie to some of them."""
        near = dict.fromkeys(heads)
        ties = [*heads]
        for row in ties:  # grows on the way
            for other in [r for v in self.free_in(row) for r in self.holders[v]]:
                if other in near or self.used[other] or self.system.equations[other].state:
                    continue
                near[other] = None
                if self.waiting[other] == 2:
                    ties.append(other)
        return sorted(near)

    def free_in(self, row: int) -> list[Expr]:
        """The variables of an equation that have not been computed."""
        return [v for v in self.system.equations[row].variables if v not in self.closed]

    def tear(self, states: bool, stubborn: bool = False) -> bool:
        """Take one variable of each remaining solvable block as if it were known.

        `stubborn` counts equations that cannot be solved for their last unknown as well: where
        they make a part overdetermined, a relation exists that only iteration could give.
        """
        rows = [
            r
            for r, equation in enumerate(self.system.equations)
            if not self.used[r]
            and (stubborn or self.waiting[r] > 1)
            and (states or equation.state is None)
        ]
        columns: dict[Expr, int] = {}
        graph = []
        for r in rows:
            graph.append([columns.setdefault(v, len(columns)) for v in self.free_in(r)])
        parts = decompose(graph, len(columns))
        solvable = {*parts.over_columns, *(() if stubborn else parts.square_columns)}
        names = list(columns)
        chosen = []
        done = False
        for block in components(graph, [*parts.over_rows, *parts.square_rows], solvable):
            if len(block) >= _LARGE and not stubborn:
                inside = set(block)
                near = (*parts.over_rows, *parts.square_rows)
                if self.block([rows[r] for r in near if any(c in inside for c in graph[r])]):
                    done = True
                    continue
            degree = {c: 0 for c in block}
            for r in (*parts.over_rows, *parts.square_rows):
                for c in graph[r]:
                    if c in degree:
                        degree[c] += 1
            best = min(
                block, key=lambda c: (-degree[c], self.known.variable_colour[names[c]], names[c].id)
            )
            chosen.append(names[best])
        for variable in chosen:
            column = columns[variable]
            row = next(r for r, members in zip(rows, graph, strict=True) if column in members)
            self.torn(variable, row)
        return done or bool(chosen)

    def tear_two_valued(self) -> bool:
        """Take a variable as known of which an equation leaves two values."""
        for row, count in enumerate(self.waiting):
            equation = self.system.equations[row]
            if count == 1 and not self.used[row] and equation.state is None:
                variable = next(v for v in equation.variables if v not in self.closed)
                if two_valued(self.pool, equation.zero, variable) is not None:
                    self.torn(variable, row)
                    return True
        return False

    def torn(self, variable: Expr, row: int) -> None:
        """A variable is taken as known; an equation that holds it is where a person finds it."""
        tear = self.loops.tear(variable)
        holder = self.system.equations[row]
        self.settle(variable, Step(variable, tear, tear, holder, "loop"), LOOP)

    def block(self, rows: list[int]) -> bool:
        """Solve a large linear block as a whole; False if it is none."""
        equations = {row: self.system.equations[row] for row in rows}
        lines = linear_equations(self.pool, equations, self.closed, self.substituted)
        if lines is None:
            return False
        if products(lines, LARGEST) > LARGEST:
            self.oversized.append([*equations.values()])
            for row in rows:
                self.used[row] = True
            return True
        found = solve_block(self.pool, lines, self.nominal.size, self.balanced(equations))
        if found is None:
            return False
        for row in rows:
            self.used[row] = True
        for item in found.solved:
            equation = self.system.equations[item.equation]
            step = Step(item.variable, item.value, item.value, equation, "solved")
            self.settle(item.variable, step, LOOP)
        for row, expr in found.left:
            self.loops.row(row, expr)
        return True

    def balanced(self, equations: Mapping[int, Equation]) -> dict[int, Expr]:
        """By the number of each balance the variable that the bonds of its junction share."""
        nodes, shared = self.system.graph.nodes, self.system.shared
        found = {}
        for row, equation in equations.items():
            common = nodes[equation.node].common if equation.kind == "balance" else None
            if common is not None:
                found[row] = shared.get(common, common)
        return found

    # ------------------------------------------------------------------ result

    def resting_on(self, rows: tuple[int, ...]) -> list[Expr]:
        """What the variables of some equations rest on, in the order it was computed."""
        seen: set[Expr] = set()
        stack = [v for r in rows for v in self.system.equations[r].variables]
        while stack:
            variable = stack.pop()
            if variable in seen or variable not in self.steps:
                continue
            seen.add(variable)
            step = self.steps[variable]
            if step.how != "loop":
                stack.extend(v for v in step.equation.variables if v is not variable)
            else:
                rows_of = self.loops.rows_for(variable)
                stack.extend(v for r in rows_of for v in self.system.equations[r].variables)
        return sorted(seen, key=self.sequence.__getitem__)

    def finished(self, variable: Expr, final: dict[Expr, Expr], done: dict[Expr, Step]) -> Step:
        """A step in known signals alone, as far as the loops that it rests on have a value."""
        if variable not in done:
            step = done[variable] = self.steps[variable]
            with suppress(ZeroDivisionError):
                closed = self.pool.substitute([step.closed], final)[0]
                done[variable] = step._replace(closed=closed)
        return done[variable]

    def tangled(self) -> bool:
        """Whether the relations rest on the same steps again and again.

        As where the voltage of every branch of a tree is had through the root.
        """
        budget = _TANGLED * len(self.steps) + _FEW
        for item in self.loops.plain:
            budget -= len(self.resting_on(item.rows))
            if budget < 0:
                return True
        return False

    def result(self) -> ReducedSystem:
        """The relations that were found, those that are missing, and what no sensor reaches."""
        relations = self.loops.relations()
        final = self.loops.solutions()
        closings = []
        missing = []
        done: dict[Expr, Step] = {}
        for rows, expr in sorted(relations, key=lambda r: r[0][-1]):
            steps = tuple(self.finished(v, final, done) for v in self.resting_on(rows))
            found = without_free_integrals(self.pool, expr)
            equation = self.system.equations[rows[-1]]
            if found is None:
                missing.append(initial_value_needed(equation, expr, steps))
            elif found.expr is not self.pool.zero:
                loop = tuple([self.system.equations[r] for r in rows[:-1]])
                own = equation, found.expr, steps, found.order, found.raw
                closings.append(Closing(*own, loop=loop))
        unsolved = tuple(v for v in self.system.unknowns if v not in self.closed)
        unmonitored = tuple(e for r, e in enumerate(self.system.equations) if not self.used[r])
        for rows, about in self.loops.lost:
            below = [self.steps[v] for v in self.resting_on(rows)]
            inside = [s for s in below if self.loops.open_in(s.closed)]
            costs, closing = ([self.system.equations[r] for r in own] for own in (about, rows))
            missing += loop_unsolvable(self.pool, costs, inside, closing, below)
        missing += self.unaccounted([*[c.equation for c in closings], *[m.about for m in missing]])
        steps = tuple(self.steps[v] for v in sorted(self.steps, key=self.sequence.__getitem__))
        return ReducedSystem(
            self.system, steps, tuple(closings), unsolved, unmonitored, tuple(missing)
        )

    def unaccounted(self, told: list[Equation]) -> list[Missing]:
        """Hold the number of relations to theory: what is neither found nor told to be missing."""
        stuck = any(n == 1 and not u for n, u in zip(self.waiting, self.used, strict=True))
        hidden = len(self.used) <= _CHECKED and not all(self.used)  # what cancels out of sight
        certain = not stuck and not self.loops.pending and not hidden  # misleads the matching
        found = self.loops.identities + len(told)
        steps = self.steps.values()
        return unaccounted(self.system, steps, told, found, certain, self.oversized)
