"""Relations that a chosen fault does not move, whatever its course.

A fault is a signal that nobody knows. What holds without it is what remains when the equations that
it is in are eliminated with the fault as one more unknown variable, as for any unknown input
(Staroswiecki and Comtet-Varga, 2001; Frisk and Nyberg, 2001).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping

from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import Expr, Kind, Pool, symbols, topological, variables
from bondgraph.ir.nodes import holding, occurs
from bondgraph.ir.residuals import Closing, Residual, ResidualSet
from bondgraph.ir.signature_matrix import SignatureMatrix
from bondgraph.notation.line import show
from bondgraph.passes.elimination.eliminate import eliminate
from bondgraph.text.diagnostic import Report


def decouple(
    residuals: ResidualSet, matrix: SignatureMatrix, faults: tuple[str, ...], report: Report
) -> list[Closing]:
    """New relations that do not react to the faults, one fault each.

    Of n relations that see a fault n - 1 combinations are free of it. Reports `not-decoupled`
    where there is none or none could be found in closed form. KeyError for a name that is no
    fault candidate.
    """
    found: list[Closing] = []
    for fault in faults:
        residuals.system.graph.fault_symbol(fault)
        seen = [r for r in residuals.residuals if fault in matrix.signature(r.name)]
        own = free_of(fault, seen, residuals) if len(seen) > 1 else []
        found += own
        if not own:
            _say(report, residuals, fault, seen)
    return found


def free_of(fault: str, seen: list[Residual], residuals: ResidualSet) -> list[Closing]:
    """Relations that follow from what some residuals rest on, but not from a fault.

    Those that there are already, about the same parameters and signals, are left out.
    """
    new: list[Closing] = []
    for system in _without(fault, _below(seen, residuals.system)):
        known = [r.expr for r in residuals.residuals] + [c.expr for c in new]
        there = Counter(map(_support, known))
        for closing in eliminate(system, Report()).closings:
            support = _support(closing.expr)
            if there[support]:
                there[support] -= 1
            else:
                new.append(closing._replace(free_of=fault))
        if len(new) >= len(seen) - 1:
            break
    return sorted(new, key=lambda c: len(topological([c.expr])))


def _support(expr: Expr) -> frozenset[Expr]:
    return frozenset(symbols(expr))


def _below(residuals: list[Residual], system: EquationSystem) -> EquationSystem:
    """The equations in the variables that some residuals rest on.

    Where these do not have the redundancy of the residuals (steps that a switch chooses may name
    what they rest on in one mode only), all equations.
    """
    known = {step.variable for residual in residuals for step in residual.steps}
    part = _of(system, [e for e in system.equations if known.issuperset(e.variables)])
    enough = len(part.equations) - len(part.unknowns) >= len(residuals)
    return part if enough else system


def _of(system: EquationSystem, equations: list[Equation]) -> EquationSystem:
    unknowns = variables(*[e.zero for e in equations])
    return system._replace(equations=tuple(equations), unknowns=tuple(unknowns))


def _without(fault: str, system: EquationSystem) -> Iterator[EquationSystem]:
    """Systems that do not say what a parameter, an input or the error of a sensor is.

    In the first it is a variable. What several equations hold of it in common may be one as well:
    a limited command, from which the gain before the limit cannot be had. So in the second every
    such part is; an equation that alone holds what is left says nothing more.
    """
    pool = system.graph.pool
    unknown = pool.symbol(f"{fault}(t)", Kind.UNKNOWN)
    moving = {system.graph.fault_symbol(fault): unknown}
    first = rows = [_substituted(e, moving, pool) for e in system.equations]
    parts = 0
    while (shared := _shared([r.zero for r in rows], unknown)) not in (None, unknown):
        parts += 1
        part = pool.symbol(f"{fault}(t) in {show(shared)}", Kind.UNKNOWN)
        rows = [_substituted(r, {shared: part}, pool) for r in rows]
    alone = [] if shared else [r for r in rows if occurs(unknown, r.zero)]
    if parts + bool(shared or alone) > 1:
        yield _of(system, first)
    yield _of(system, [r for r in rows if r not in alone])


def _shared(zeros: list[Expr], unknown: Expr) -> Expr | None:
    """The largest part with the unknown that two equations have."""
    count: Counter[Expr] = Counter()
    for zero in zeros:
        count.update(n for n in holding([zero], lambda n: n is unknown) if n is not zero)
    found = [n for n, times in count.items() if times > 1]
    return max(found, key=lambda n: n.id, default=None)


def _substituted(equation: Equation, new: Mapping[Expr, Expr], pool: Pool) -> Equation:
    """An equation with other values for some parts."""
    zero, rate = pool.substitute([equation.zero, equation.rate or equation.zero], new)
    held = variables(zero)
    if equation.state is not None:
        held = [equation.state, *[v for v in held if v is not equation.state]]
    return equation._replace(zero=zero, variables=tuple(held), rate=equation.rate and rate)


def _say(report: Report, residuals: ResidualSet, fault: str, seen: list[Residual]) -> None:
    if not seen:
        why = "no relation sees it, so all are free of it"
    elif len(seen) == 1:
        why = f"only {seen[0].name} sees it, and a combination needs two relations that do"
    else:
        names = ", ".join(r.name for r in seen)
        why = f"{names} hold it in a way that has no solution in closed form"
    report.info(
        "not-decoupled",
        f"No combination of the relations was made to be free of `{fault}`: {why}.",
        residuals.system.graph.fault_origin(fault),
        help="One sensor more gives one relation more to combine." if seen else "",
    )
