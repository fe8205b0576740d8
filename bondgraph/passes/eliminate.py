"""Eliminate the unknowns, in another order where the first leaves something to be wished for.

Most models take one elimination (`chain`). What costs more is tried only where it is needed.
"""

from __future__ import annotations

from bondgraph.exact.evaluate import highest_order
from bondgraph.ir.equations import EquationSystem
from bondgraph.ir.residuals import ReducedSystem
from bondgraph.passes.chain import Chain
from bondgraph.passes.cost import FREE_START, ITERATION
from bondgraph.passes.each_mode import each_mode
from bondgraph.passes.regroup import regroup
from bondgraph.text.diagnostic import Report


def eliminate(system: EquationSystem, report: Report) -> ReducedSystem | None:
    """Compute every variable that sensors and sources reach, and keep what is left over.

    Near-linear in the number of bonds. Derivatives are avoided as far as possible; where that makes
    long detours, relations of the same order with shorter paths are taken, and where it misses an
    initial value, no integral without one is used; where a loop cannot be solved, integrals come
    before loops. A loop that no one order of elimination solves in all modes is solved in each.
    Reports `loop-unsolvable` for a nonlinear loop without a closed solution, `loop-too-large` for a
    linear one of ten thousand bonds, `initial-value-needed` where a relation needs an undeclared
    initial value.
    """
    said = Report()
    result = _eliminated(system, said)
    if result is None:
        result = each_mode(system, _eliminated)
        if result is not None:
            return regroup(result)
    for diagnostic in said.diagnostics:
        report.add(diagnostic)
    return None if result is None else regroup(result)


def _eliminated(system: EquationSystem, report: Report) -> ReducedSystem | None:
    said = Report()
    chain = _run(Chain(system, said))
    if chain.tangled():
        order = highest_order([row.expr for row in chain.loops.plain])
        near = _run(Chain(system, said, free=order))
        if len(near.loops.plain) >= len(chain.loops.plain):
            chain = near
    result = chain.result()
    codes = {d.code for d in said.diagnostics}
    others = []
    if "initial-value-needed" in codes:
        others.append(Chain(system, Report(), starts=False))
    if "loop-unsolvable" in codes:
        others += [Chain(system, Report(), eager=late) for late in (ITERATION, 2 * FREE_START)]
    for other in others:
        another = _run(other).result()
        if not other.report.failed and (
            len(another.closings) >= len(result.closings) + result.missing
        ):
            result, said = another, other.report
            break
    for diagnostic in said.diagnostics:
        report.add(diagnostic)
    return None if said.failed else result


def _run(chain: Chain) -> Chain:
    chain.start()
    chain.run()
    while chain.stalled():
        chain.run()
    return chain
