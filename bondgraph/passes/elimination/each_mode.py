"""Eliminate in every mode of a switched plant by itself, and join the relations by the mode.

Ideal switches take turns: the node between the transistor and the diode of a converter has the
voltage of whichever conducts, and in every mode another equation gives it. So no one order of
elimination serves all modes, though each mode by itself has one (hybrid bond graphs: Low, Wang,
Arogeti and Luo, 2010).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from itertools import product

from bondgraph.algebra.in_mode import in_mode
from bondgraph.algebra.summands import summands
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological, variables
from bondgraph.ir.residuals import Closing, InPosition, ReducedSystem, Step
from bondgraph.structural.rank import relations

_MOST = 6  # modes; each doubles the work and the relations

_Setting = dict[Expr, bool]
_Leaves = Sequence[Expr | None]
_Eliminate = Callable[[EquationSystem], ReducedSystem]


def each_mode(system: EquationSystem, eliminate: _Eliminate) -> ReducedSystem | None:
    """The relations of a switched plant, each chosen by the mode among those of the modes.

    A mode that the sources forbid is left out. Where a mode has fewer relations than another, the
    rest of them are zero in it. None where some mode has a relation that cannot be had, where
    there are too many modes, or where a relation holds an integral that is not the same in every
    mode: what it has taken up in one mode would be lost in the next.
    """
    modes = _modes(system)
    if not 0 < len(modes) <= _MOST:
        return None
    held = []
    for values in product((True, False), repeat=len(modes)):
        setting = dict(zip(modes, values, strict=True))
        try:
            held.append(_held(system, setting))
        except ZeroDivisionError:
            return None
    surplus = [_surplus(own) for own in held]
    answers: list[ReducedSystem | None] = []
    for own, more in zip(held, surplus, strict=True):
        if more > min(surplus) and _contradictory(own, eliminate):
            answers.append(None)
            continue
        found = eliminate(own)
        if found.missing:
            return None
        answers.append(found)
    return _Join(system, modes, held, answers).joined()


def _modes(system: EquationSystem) -> list[Expr]:
    """The boolean inputs that the equations hold, in the order of the model."""
    nodes = topological([e.zero for e in system.equations])
    used = {n for n in nodes if n.kind is Kind.MODE}
    return [i.symbol for i in system.graph.inputs if i.symbol in used]


def _held(system: EquationSystem, setting: Mapping[Expr, bool]) -> EquationSystem:
    """The equations while the machine stays in one mode."""
    pool = system.graph.pool
    zeros = in_mode(pool, [e.zero for e in system.equations], setting)
    rates = in_mode(pool, [e.rate or pool.zero for e in system.equations], setting)
    own = []
    for equation, zero, rate in zip(system.equations, zeros, rates, strict=True):
        inside = variables(zero)
        if equation.state is not None:
            inside = [equation.state, *[v for v in inside if v is not equation.state]]
            own.append(equation._replace(zero=zero, variables=tuple(inside), rate=rate))
        else:
            own.append(equation._replace(zero=zero, variables=tuple(inside)))
    unknowns = tuple(variables(*[e.zero for e in own]))
    return system._replace(equations=tuple(own), unknowns=unknowns)


def _surplus(system: EquationSystem) -> int:
    """How many relations the equations have without any sensor, identities included."""
    return relations(_blind(system))


def _blind(system: EquationSystem) -> EquationSystem:
    blind = tuple(e for e in system.equations if e.kind != "sensor")
    return system._replace(equations=blind)


def _contradictory(system: EquationSystem, eliminate: _Eliminate) -> bool:
    """Whether the equations without sensors say more than one thing of their sources.

    They may say the same thing twice, as of the flow of a junction that is off and has no other
    bond than to a junction with nothing on it.
    """
    return bool(eliminate(_blind(system)).closings)


class _Join:
    """The answers of all modes (None: a mode that cannot be), put together."""

    def __init__(
        self,
        system: EquationSystem,
        modes: list[Expr],
        held: list[EquationSystem],
        answers: list[ReducedSystem | None],
    ) -> None:
        self.system = system
        self.pool: Pool = system.graph.pool
        self.modes = modes
        self.answers = answers
        self.settings = list(product((True, False), repeat=len(modes)))
        self.number = {id(e): r for own in held for r, e in enumerate(own.equations)}

    def joined(self) -> ReducedSystem | None:
        """One reduced system; None where the modes do not go together."""
        found = [a for a in self.answers if a is not None]
        integrals = [_integrals(a) for a in found]
        if any(own != integrals[0] for own in integrals):
            return None
        closings = self.columns()
        unsolved = set(self.system.unknowns).intersection(
            *[{*a.unsolved, *_absent(self.system, a)} for a in found]
        )
        dark = [{self.number[id(e)] for e in a.unmonitored} for a in found]
        return ReducedSystem(
            self.system,
            self.steps(self.answers),
            tuple(self.closing(row, column) for row, column in closings),
            tuple(v for v in self.system.unknowns if v in unsolved),
            tuple(self.system.equations[r] for r in sorted(set.intersection(*dark))),
            (),
        )

    def columns(self) -> list[tuple[int, list[Closing | None]]]:
        """The relations that become one: those of the same equation first, then in order."""
        rows: list[dict[int, Closing]] = [
            {} if a is None else {self.number[id(c.equation)]: c for c in a.closings}
            for a in self.answers
        ]
        most = max(len(own) for own in rows)
        slots = sorted(next(own for own in rows if len(own) == most))
        columns: dict[int, list[Closing | None]] = {row: [] for row in slots}
        for own in rows:
            others = iter([own[row] for row in sorted(own) if row not in columns])
            for row, column in columns.items():
                column.append(own[row] if row in own else next(others, None))
        return list(columns.items())

    def closing(self, row: int, column: list[Closing | None]) -> Closing:
        """One relation, chosen by the mode; zero where a mode has none."""
        exprs: list[Expr | None] = []
        raws: list[Expr | None] = []
        like = summands(next(c.expr for c in column if c))
        for answer, closing in zip(self.answers, column, strict=True):
            missing = None if answer is None else self.pool.zero
            turned = closing is not None and opposed(summands(closing.expr), like)
            for told, own in ((exprs, closing and closing.expr), (raws, closing and closing.raw)):
                told.append(missing if own is None else self.pool.neg(own) if turned else own)
        return Closing(
            self.system.equations[row],
            self._chosen(exprs),
            self.steps(column),
            max(c.differentiated for c in column if c),
            self._chosen(raws),
            each=tuple(
                InPosition(tuple(zip(self.modes, setting, strict=True)), closing)
                for setting, closing in zip(self.settings, column, strict=True)
                if closing is not None
            ),
        )

    def steps(self, column: Sequence[Closing | ReducedSystem | None]) -> tuple[Step, ...]:
        """The steps of all modes; what a variable is in a mode that has no use for it is open."""
        told = [{s.variable: s for s in c.steps} if c else {} for c in column]
        order = dict.fromkeys(v for own in told for v in own)
        joined = []
        for variable in order:
            each = [own.get(variable) for own in told]
            first = next(s for s in each if s is not None)
            joined.append(
                first._replace(
                    value=self._chosen([s and s.value for s in each]),
                    closed=self._chosen([s and s.closed for s in each]),
                    equation=self.system.equations[self.number[id(first.equation)]],
                )
            )
        return tuple(joined)

    def _chosen(self, leaves: _Leaves) -> Expr:
        return chosen(self.pool, self.modes, leaves)


def chosen(pool: Pool, modes: Sequence[Expr], leaves: _Leaves) -> Expr:
    """The expression that is each of the leaves in its combination of modes; some leaf is given.

    What all of them add stays outside the choice, so that it can be filtered as it is.
    """
    sums = [None if leaf is None else summands(leaf) for leaf in leaves]
    told = [own for own in sums if own is not None]
    common = {t: c for t, c in told[0].items() if all(own.get(t) == c for own in told)}
    if len(told) == 1 or not common:
        return _tree(pool, modes, leaves) or pool.zero
    rest = [
        None if own is None else pool.add(*[(c, t) for t, c in own.items() if t not in common])
        for own in sums
    ]
    choice = _tree(pool, modes, rest) or pool.zero
    return pool.add(*[(c, t) for t, c in common.items()], (1, choice))


def _tree(pool: Pool, modes: Sequence[Expr], leaves: _Leaves) -> Expr | None:
    """The choice by one mode after the other; modes that cannot be are like the others."""
    if len(leaves) == 1:
        return leaves[0]
    half = len(leaves) // 2
    yes, no = _tree(pool, modes[1:], leaves[:half]), _tree(pool, modes[1:], leaves[half:])
    if yes is None or no is None:
        return yes or no
    return pool.choose(modes[0], yes, no)


def opposed(one: dict[Expr, Fraction], other: dict[Expr, Fraction]) -> bool:
    """Whether two sums, each of which vanishes, share more when one of them is negated."""
    shared = [other[t] == c for t, c in one.items() if abs(other.get(t, 0)) == abs(c)]
    return 2 * sum(shared) < len(shared)


def _integrals(answer: ReducedSystem) -> set[Expr]:
    """The integrals from a declared start that the relations hold."""
    nodes = topological([c.expr for c in answer.closings])
    return {n for n in nodes if n.op is Op.INT and n.symbol.kind is not Kind.FREE}


def _absent(system: EquationSystem, answer: ReducedSystem) -> set[Expr]:
    """Variables that nothing holds in a mode."""
    return set(system.unknowns).difference(answer.system.unknowns)
