"""Eliminate the unknowns, in another order where the first leaves something to be wished for.

Most models take one elimination (`chaining`). What costs more is tried only where it is needed.
"""

from __future__ import annotations

from bondgraph.exact.outline import highest_order, highest_orders
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.expr import Kind, symbols
from bondgraph.ir.residuals import Missing, ReducedSystem
from bondgraph.passes.elimination.chaining import Chain, Strategy
from bondgraph.passes.elimination.cost import FREE_START, ITERATION
from bondgraph.passes.elimination.each_mode import each_mode
from bondgraph.passes.elimination.measured_parts import with_rates, with_sensors
from bondgraph.passes.elimination.regroup import regroup
from bondgraph.passes.elimination.shortfall import tell
from bondgraph.passes.elimination.since_start import since_start
from bondgraph.text.diagnostic import Report

#: What is tried where the first elimination misses a relation for the reason given, in this order.
_OTHER_STRATEGIES = (
    ("initial-value-needed", Strategy(starts=False)),
    ("loop-unsolvable", Strategy(eager=ITERATION)),
    ("loop-unsolvable", Strategy(eager=2 * FREE_START)),
)


def eliminate(system: EquationSystem, report: Report) -> ReducedSystem:
    """Compute every variable that sensors and sources reach, and keep what is left over.

    Near-linear in the number of bonds. A sensor stands for the function that it measures, and one
    of a derivative for what a storage takes, where that needs fewer derivatives and no more
    parameters (no speed by way of a friction), and tells as many faults apart.
    Derivatives are avoided as far as possible; where that makes long detours, relations of the same
    order with shorter paths are taken, and where it misses an initial value, no integral without
    one is used; where a loop cannot be solved, or only with more derivatives, integrals come before
    loops. A loop that no one order of elimination solves in all modes is solved in each. A relation
    that cannot be had all the same is `missing` and costs no other: `loop-unsolvable` for a
    nonlinear loop without a closed solution, `loop-too-large` for a linear one of ten thousand
    bonds or with coefficients that move, `initial-value-needed` where a relation needs an
    undeclared initial value. Where nothing else can be had they are errors.
    """
    system = with_sensors(system)
    result = _eliminated(system)
    rates = with_rates(system)
    for free in (0, 1) if rates is not system else ():
        anew = _run(Chain(rates, Strategy(free=free))).result()
        (own, apart), (before, told) = _rests_on(anew), _rests_on(result)
        if own <= before and apart >= told:
            result = _better(anew, result)
    if _lacking(result):
        result = each_mode(system, _eliminated) or result
    tell(report, result)
    return regroup(since_start(result))


def _eliminated(system: EquationSystem) -> ReducedSystem:
    chain = _run(Chain(system))
    if chain.tangled():
        order = highest_order([row.expr for row in chain.loops.plain])
        near = _run(Chain(system, Strategy(free=order), chain.known))
        if len(near.loops.plain) >= len(chain.loops.plain):
            chain = near
    best = chain.result()
    if chain.loops.raised:  # an integral from a declared start may need fewer derivatives
        best = _better(_run(Chain(system, Strategy(eager=ITERATION), chain.known)).result(), best)
    lacking = _lacking(best)
    codes = {m.finding.code for m in lacking}
    most = len(best.closings) + len(lacking)
    for strategy in [s for code, s in _OTHER_STRATEGIES if code in codes]:
        anew = _run(Chain(system, strategy, chain.known)).result()
        if not _lacking(anew) and len(anew.closings) >= most:
            return anew
        if len(anew.closings) > len(best.closings):
            best = anew
    return best


def _better(anew: ReducedSystem, best: ReducedSystem) -> ReducedSystem:
    """Another answer, if it is whole and needs fewer derivatives."""
    whole = not _lacking(anew) and len(anew.closings) >= len(best.closings)
    return anew if whole and _order(anew) < _order(best) else best


def _order(result: ReducedSystem) -> int:
    """The highest derivatives of the relations, added up."""
    return sum(highest_orders(tuple([closing.expr for closing in result.closings])))


def _rests_on(result: ReducedSystem) -> tuple[int, int]:
    """How many parameters the relations hold, added up, and how many groups of symbols these tell
    apart by which of them each is in."""
    found = [symbols(closing.expr) for closing in result.closings]
    every = set().union(*found)
    groups = {tuple(s in own for own in found) for s in every}
    return sum(s.symbol.kind is Kind.PARAM for own in found for s in own), len(groups)


def _lacking(result: ReducedSystem) -> list[Missing]:
    """The relations of which it is known why they could not be had."""
    return [m for m in result.missing if m.explained]


def _run(chain: Chain) -> Chain:
    chain.start()
    chain.run()
    while chain.stalled():
        chain.run()
    return chain
