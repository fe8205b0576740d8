"""Why a fault cannot be detected, and why a model has no residual, in words of the model."""

from __future__ import annotations

from bondgraph.compilation import Compilation
from bondgraph.ir.equation_system import Equation
from bondgraph.ir.expr import Expr
from bondgraph.ir.nodes import occurs
from bondgraph.ir.residuals import ResidualSet
from bondgraph.notation.dump_stages import equation_name
from bondgraph.structural.matching import decompose
from bondgraph.text.numerals import joined, plural


def message(compilation: Compilation) -> str:
    """One line on what the residuals can tell, or why there is none.

    >>> import bondgraph
    >>> message(bondgraph.compile("models/dc_motor.bg"))
    '2 residuals detect 9 of 9 faults, in 3 groups'
    """
    matrix = compilation.signatures
    number = len(compilation.residuals.missing)
    if not matrix.residuals:
        if number:
            return f"no residual: {plural(number, 'relation')} could not be derived"
        return f"no residual: {_nothing(compilation)}"
    found = len(matrix.faults) - len(matrix.undetectable)
    verb = "detects" if len(matrix.residuals) == 1 else "detect"
    return (
        f"{plural(len(matrix.residuals), 'residual')} {verb} {found} of"
        f" {plural(len(matrix.faults), 'fault')}, in {plural(len(matrix.groups), 'group')}"
        + (f"; {plural(number, 'relation')} could not be had" if number else "")
    )


#: Bonds of a model for which it is always found out what could be told apart at best.
_SMALL = 200


def at_best(compilation: Compilation) -> tuple[tuple[str, ...], ...] | None:
    """The groups that no residuals could divide any further, where the answer costs little.

    None of a large model that was not compiled with `--isolate`, and where it is not known: what a
    relation that could not be had would tell apart, nobody says.
    """
    if compilation.residuals.missing:
        return None
    if len(compilation.graph.bonds) > _SMALL and not compilation.options.isolate:
        return None
    return compilation.maximum_isolability


def told_apart_at_best(compilation: Compilation, how: str) -> str:
    """What further residuals would tell apart, and how one gets these; empty if that is nothing."""
    best, groups = at_best(compilation), compilation.signatures.groups
    if best is None or len(best) <= len(groups):
        return ""
    line = f"{plural(len(best), 'group')} at best, whatever residuals are used"
    return line if compilation.options.isolate else f"{line}: {how}"


def _nothing(compilation: Compilation) -> str:
    """Why a model has no redundancy."""
    graph = compilation.graph
    sensors = [s.name for s in graph.sensors if s.same_as is None]
    if not sensors:
        return "the model has no sensor, so no fault can be detected"
    found = compilation.residuals.residual_set
    hidden = _unknowns(found)
    if _needed(found, hidden):
        names = joined(_few([f"`{s}`" for s in sensors]))
        verb = "is" if len(sensors) == 1 else "are all"
        unknown = joined(_few([f"`{u.symbol.name}`" for u in hidden]))
        return f"{names} {verb} needed to tell the unknown {unknown}, so no fault can be detected"
    return "nothing is measured twice over, so no fault can be detected"


def missing(compilation: Compilation) -> list[tuple[str, str]]:
    """The relations that could not be had, each with the reason; those of one equation once."""
    source = compilation.source
    found = compilation.residuals.missing
    told = ((equation_name(m.about, source), m.finding.message) for m in found)
    return list(dict.fromkeys(told))


def reasons(compilation: Compilation) -> dict[str, list[str]]:
    """Why each undetectable fault is undetectable, with the faults of equal reason together."""
    found: dict[str, list[str]] = {}
    for fault in compilation.signatures.undetectable:
        found.setdefault(reason(compilation, fault), []).append(fault)
    return found


def reason(compilation: Compilation, fault: str) -> str:
    """Why no residual sees a fault, in words of the model."""
    symbol = compilation.graph.fault_symbol(fault)
    found = compilation.residuals.residual_set
    holding = [e for e in found.system.equations if occurs(symbol, e.zero)]
    if not holding:
        return "no law uses it"
    used = {
        id(equation)
        for residual in found.residuals
        for equation in (residual.closing, *(step.equation for step in residual.steps))
    }
    apart = [values for (_, f), values in compilation.signatures.apart.items() if f == fault]
    if apart:
        values = apart[0]
        which = f"another value of {' or '.join(_few(list(values)))}" if values else "other values"
        return f"the declared numbers hide it: with {which} it would be seen"
    own = {id(e) for e in holding}
    lost = [m for m in found.missing if any(id(e) in own for e in m.equations)]
    if lost:
        names = joined(_few([f"`{name}`" for name in dict.fromkeys(m.about.name for m in lost)]))
        noun = "the relation" if len(lost) == 1 else "the relations"
        return f"{noun} at {names} might see it, and could not be had"
    if any(id(e) in used for e in holding):
        return "it cancels out of every residual"
    rest = [e for e in found.system.equations if id(e) not in used]
    part = _connected(holding, rest)
    junctions = [e.name for e in part if e.kind == "balance"]
    where = f" around {', '.join(_few(junctions))}" if junctions else ""
    inside = {v for e in part for v in e.variables}
    unknown = [u for u in _unknowns(found) if u in inside]
    needed = _needed(found, unknown)
    if any(id(e) in needed for e in holding):
        names = ", ".join(u.symbol.name for u in unknown)
        return f"what is measured{where} is needed to tell the unknown {names}"
    if any(e.kind == "sensor" for e in found.system.equations if _touches(e, part)):
        return f"the sensors{where} show nothing that depends on it"
    return f"no sensor{where} could contradict the model there"


def _unknowns(found: ResidualSet) -> list[Expr]:
    """The unknown inputs."""
    return [i.symbol for i in found.system.graph.inputs if not i.known]


def _needed(found: ResidualSet, unknown: list[Expr]) -> set[int]:
    """The equations that would have redundancy if these unknown inputs were known."""
    if not unknown:
        return set()
    equations = found.system.equations
    gone = set(unknown)
    columns: dict[Expr, int] = {}
    rows = [
        [columns.setdefault(v, len(columns)) for v in e.variables if v not in gone]
        for e in equations
    ]
    return {id(equations[r]) for r in decompose(rows, len(columns)).over_rows}


def _touches(equation: Equation, part: list[Equation]) -> bool:
    """Whether an equation has a variable in common with a part."""
    inside = {v for e in part for v in e.variables}
    return any(v in inside for v in equation.variables)


def _connected(seeds: list[Equation], among: list[Equation]) -> list[Equation]:
    """The equations that hang together with some of them by their unknowns."""
    holders: dict[Expr, list[Equation]] = {}
    for equation in among:
        for variable in equation.variables:
            holders.setdefault(variable, []).append(equation)
    reached = {id(e) for e in seeds}
    stack = list(seeds)
    while stack:
        for variable in stack.pop().variables:
            for equation in holders.pop(variable, []):
                if id(equation) not in reached:
                    reached.add(id(equation))
                    stack.append(equation)
    return [e for e in among if id(e) in reached]


def _few(items: list[str]) -> list[str]:
    return items if len(items) <= 3 else [*items[:3], "others"]
