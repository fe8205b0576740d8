"""States that a machine never leaves once it starts from its declared initial values.

A crank that only its own angle could turn stands at its dead centre for good. What shows at other
angles does not show on this machine, however long it runs.
"""

from __future__ import annotations

from bondgraph.exact.evaluate import evaluate
from bondgraph.exact.plant import Plant
from bondgraph.exact.plant_equations import has_sides
from bondgraph.exact.trajectory import ExactUnavailable
from bondgraph.field.numbers import Undefined
from bondgraph.ir.expr import Expr, Op, symbols, topological

#: Random points at which what is held must have no rate; every second one turns faults' signs.
#: About half of the points lie on either side of a limit or a dead zone, behind which all may move.
_POINTS, _POINTS_WITH_BRANCHES = 4, 64
#: Rounds in which states may leave, the later driven by the earlier; no claim is made after them.
_ROUNDS = 12


def from_start(plant: Plant, seed: int = 1, differs: Expr | None = None) -> Plant:
    """The plant with the states that never leave their declared initial values held there.

    The greatest set of states such that, all of them held at their initial values, none has a
    rate, whatever the inputs, the other states and the faults are (an invariant set: Khalil,
    2002, section 4.2). The same plant where there is no such state, or none could be found. An
    initial value that `differs` from the declared one is none that a state keeps.

    >>> # from_start(plant).structure.held  # (the initial value of the angle,)
    """
    faulty = frozenset(plant.graph.fault_symbols().values())
    held = {
        state: value
        for initial, state, value in plant.structure.declared_starts()
        if initial is not differs and faulty.isdisjoint(symbols(value))
    }
    for _ in range(_ROUNDS):
        if not held:
            break
        try:
            at_start = plant.holding(held)
            leaving = _leaving(plant, at_start, list(held), seed)
        except (ExactUnavailable, ZeroDivisionError):  # a law has no value at the start
            break
        if not leaving:
            return at_start
        held = {state: start for state, start in held.items() if state not in leaving}
    return plant


def _leaving(plant: Plant, at_start: Plant, held: list[Expr], seed: int) -> set[Expr]:
    """The states that have a rate at one of some random points, or at one of its branches."""
    structure, whole = plant.structure, plant.structure.assembly
    rates = {rate.variable: rate.value for rate in whole.rates}
    values = [rates[whole.place[state][0]] for state in held]
    nodes = topological([*[law for _, law in whole.laws], *rates.values()])
    sided = any(n.op in (Op.IF, Op.ROOT) or has_sides(n) for n in nodes)
    branches = sided or bool(structure.modes)
    found: set[Expr] = set()
    for point in range(_POINTS_WITH_BRANCHES if branches else _POINTS):
        at = at_start.trajectory(
            1000 * seed + point,
            0,
            faults=plant.graph.faults,
            part=at_start.structure.part_for(values),
            roots=values,
            turned=point % 2 > 0,
        )
        try:
            all_rates = evaluate(values, at.truths)
        except Undefined:
            raise ExactUnavailable("a rate has no value at the start") from None
        moving = zip(held, all_rates, strict=True)
        found.update(state for state, rate in moving if at.still or at.algebra.moves(rate))
        if found:
            break
    return found
