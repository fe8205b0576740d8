"""Which derivative of a signal may jump when a switch is turned: from the equations alone.

A state (charge, momentum, what an `int` adds up) goes on where it is, unless a mode ties states to
each other or to a source: two capacitors joined, a coil cut off. What the equations that stay the
same in both positions of the switch give as a function of states and inputs goes on with them;
everything else may jump. The derivative of a state is its rate, and so on (hybrid bond graphs:
Mosterman and Biswas, 1995).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import product
from math import inf

from bondgraph.algebra.in_mode import in_mode
from bondgraph.field.prime import P
from bondgraph.field.random_point import RandomPoint
from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import VARIABLES, Expr, Kind, Op, topological
from bondgraph.ir.nodes import has
from bondgraph.ir.normal import Term

_MOST = 6  # switches; each doubles the modes that are looked at
_WORK = 20_000  # equations in all modes together

_STATES = frozenset({Kind.STATE, Kind.INTEGRAL})
_FREE = VARIABLES - _STATES - {Kind.UNKNOWN} | {Kind.SENSOR}  # what may change from now to now
_MOVING = VARIABLES | {Kind.SENSOR}

#: The derivative of an equation by each variable, at a random point.
Row = dict[Expr, int]


class Jumps:
    """The lowest derivative of each known signal that may jump when a boolean input changes.

    0 is the signal itself, infinity says that no derivative does. Inputs are what the user makes
    them: they do not jump because of a mode.
    """

    def __init__(self, system: EquationSystem) -> None:
        self.modes = [i.symbol for i in system.graph.inputs if i.mode]
        self._sensors = [s.symbol for s in system.graph.sensors if s.same_as is None]
        self._levels = {mode: _levels(system, mode) for mode in self.modes}

    def goes_on(self, mode: Expr, term: Term) -> bool:
        """Whether a filter may go on with a term as the mode changes: what jumps is input to it.

        Of p**k g it is if g has k derivatives and only the k-th jumps, which filters see at the
        moment at which it does. Of g itself it is if g has its jump from the mode that it reads,
        not from readings: what it makes to turn one sample later then is as much as it can be off.
        Of a law of derivatives it is if the law is linear in the derivatives that jump.
        """
        levels, order = self._inside(mode, term.atom, 0), max(term.order, 0)
        if levels[term.atom] > order:
            return True
        if order:
            return term.static and levels[term.atom] == order
        if term.static:
            return self.level(mode, term.atom, inf) > 0
        return _linear(term.atom, levels)

    def level(self, mode: Expr, expr: Expr, own: float = 0) -> float:
        """That of an expression of known signals, the mode's `own`; below 0 if it is an impulse."""
        return self._inside(mode, expr, own)[expr]

    def _inside(self, mode: Expr, expr: Expr, own: float) -> dict[Expr, float]:
        """The levels of all that is in an expression."""
        found: dict[Expr, float] = {}
        for node in topological([expr]):
            known = own if node is mode else None
            found[node] = self._level(mode, node, [found[a] for a in node.args], known)
        return found

    def _level(self, mode: Expr, node: Expr, args: list[float], known: float | None) -> float:
        if known is not None:
            return known
        if node.op is Op.SYM:
            levels = self._levels[mode]
            jumps = node.symbol.kind is Kind.SENSOR
            return (0 if levels is None else levels.get(node, 0)) if jumps else inf
        if node.order:
            return args[0] - node.order
        return min(args, default=inf)


def _linear(atom: Expr, levels: Mapping[Expr, float]) -> bool:
    """Whether all that jumps in a law is derivatives, none an impulse, and the law linear in them.

    With factors that go on a filtered derivative is the filtered product, as far as it ever is.
    """
    stack = [atom]
    while stack:
        node = stack.pop()
        if levels[node] > 0:
            continue
        if levels[node] < 0:
            return False
        if node.op is Op.ADD:
            stack += node.args
        elif node.op is Op.MUL:
            jumps = [(factor, power) for factor, power in node.factors if levels[factor] <= 0]
            if len(jumps) != 1 or jumps[0][1] != 1:
                return False
            stack.append(jumps[0][0])
        elif node.op is not Op.DER:
            return False
    return True


def _levels(system: EquationSystem, mode: Expr) -> dict[Expr, float] | None:
    """The levels of all variables for one mode; None where they cannot be told."""
    nodes = topological([e.zero for e in system.equations])
    inside = [i.symbol for i in system.graph.inputs if i.symbol in set(nodes) and i.mode]
    if mode not in inside:
        return {s.symbol: inf for s in system.graph.sensors}
    others = [m for m in inside if m is not mode]
    still = [e.zero for e in system.equations if e.state is None]
    if len(inside) > _MOST or len(system.equations) << len(inside) > _WORK:
        return None
    if has(still, Op.DER, Op.INT):
        return None  # a law with a derivative of its own
    lowest: dict[Expr, float] = {}
    point = _Gradients()
    for values in product((True, False), repeat=len(others)):
        try:
            change = _Change(system, mode, dict(zip(others, values, strict=True)), point)
        except ZeroDivisionError:
            return None
        for variable, level in change.levels().items():
            lowest[variable] = min(level, lowest.get(variable, inf))
    return lowest


class _Gradients:
    """The rows of equations, each made once."""

    def __init__(self) -> None:
        self._point = RandomPoint(7)
        self._rows: dict[Expr, Row] = {}

    def of(self, expr: Expr) -> Row:
        if expr not in self._rows:
            self._rows[expr] = self._point.gradient(expr, lambda n: n.kind in _MOVING)
        return self._rows[expr]


class _Change:
    """One mode that changes while the others stay as they are.

    Raises ZeroDivisionError where an equation has no value in a mode.
    """

    def __init__(
        self, system: EquationSystem, mode: Expr, held: Mapping[Expr, bool], point: _Gradients
    ) -> None:
        pool = system.graph.pool
        self.point = point
        self.states = [e for e in system.equations if e.state is not None]
        laws = [e for e in system.equations if e.state is None]

        def at(equations: Iterable[Equation], rate: bool) -> list[tuple[Expr, Expr]]:
            exprs = [(e.rate or pool.zero) if rate else e.zero for e in equations]
            both = [in_mode(pool, exprs, {**held, mode: on}) for on in (True, False)]
            return list(zip(*both, strict=True))

        self.laws = at(laws, rate=False)
        self.rates = {
            e.state: pair for e, pair in zip(self.states, at(self.states, rate=True), strict=True)
            if e.state is not None
        }  # fmt: skip

    def levels(self) -> dict[Expr, float]:
        """The level of every variable, by going round until nothing falls any more."""
        same = _reduced(self.point.of(on) for on, off in self.laws if on is off)
        known = {v: row for v, row in same.items() if _free(row) == [v]}
        levels: dict[Expr, float] = {v: inf for v in [*known, *self.rates]}
        levels |= dict.fromkeys(self.tied(same), 0)
        for on, off in (*self.laws, *self.rates.values()):
            for variable in (*self.point.of(on), *self.point.of(off)):
                if variable.symbol.kind in _FREE and variable not in known:
                    levels[variable] = 0
        falls = True
        while falls:
            falls = False
            for variable, level in self.steps(levels, known):
                if level < levels[variable] and level <= _LAST:
                    levels[variable] = level
                    falls = True
        return levels

    def steps(
        self, levels: dict[Expr, float], known: dict[Expr, Row]
    ) -> Iterator[tuple[Expr, float]]:
        """What follows from the levels so far."""
        for variable, row in known.items():
            yield variable, min([levels.get(v, inf) for v in row if v is not variable], default=inf)
        for state, (on, off) in self.rates.items():
            inside = [levels.get(v, inf) for v in self.point.of(on)]
            yield state, 1 + (min(inside, default=inf) if on is off else 0)

    def tied(self, same: dict[Expr, Row]) -> set[Expr]:
        """The states that a mode ties, and those that always move with them."""
        always = [row for v, row in same.items() if v.symbol.kind not in _FREE]
        found: set[Expr] = set()
        for position in (0, 1):
            rows = _reduced(self.point.of(law[position]) for law in self.laws)
            ties = [row for v, row in rows.items() if v.symbol.kind not in _FREE]
            own = _reduced([*always, *ties])
            if len(own) > len(always):
                old = {v for v in same if v.symbol.kind not in _FREE}
                for pivot, row in own.items():
                    if pivot not in old or row != same[pivot]:
                        found |= {v for v in row if v.symbol.kind in _STATES}
        grows = True
        while grows:
            more = {
                v for row in always if found & row.keys() for v in row if v.symbol.kind in _STATES
            }
            grows = not more <= found
            found |= more
        return found


_LAST = 20  # no relation has a derivative of that order


def _free(row: Row) -> list[Expr]:
    return [v for v in row if v.symbol.kind in _FREE]


def _reduced(rows: Iterable[Row]) -> dict[Expr, Row]:
    """The rows in echelon form by pivot, no pivot in another row; free variables go first."""
    found: dict[Expr, Row] = {}
    holders: dict[Expr, set[Expr]] = {}
    for given in rows:
        row = dict(given)
        for pivot in [v for v in row if v in found]:
            _subtract(row, found[pivot], row[pivot])
        row = {v: c for v, c in row.items() if v.symbol.kind is not Kind.UNKNOWN}
        if not row:
            continue
        pivot = min(_free(row) or row, key=lambda v: v.id)
        inverse = pow(row[pivot], -1, P)
        row = {v: c * inverse % P for v, c in row.items()}
        for other in holders.pop(pivot, set()):
            before = set(found[other])
            _subtract(found[other], row, found[other][pivot])
            for v in before ^ set(found[other]):
                (holders.setdefault(v, set()).add if v in found[other]
                 else holders.get(v, set()).discard)(other)  # fmt: skip
        found[pivot] = row
        for v in row:
            if v is not pivot:
                holders.setdefault(v, set()).add(pivot)
    return found


def _subtract(row: Row, other: Row, factor: int) -> None:
    """row -= factor * other."""
    for v, c in other.items():
        left = (row.get(v, 0) - factor * c) % P
        if left:
            row[v] = left
        else:
            row.pop(v, None)
