"""Say what an elimination could not give, by the elements of the model and with a remedy."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from bondgraph.algebra.affine import affine
from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols, topological
from bondgraph.ir.nodes import constant, has
from bondgraph.ir.residuals import Missing, ReducedSystem, ResidualSet, Step
from bondgraph.structural.matching import match
from bondgraph.structural.rank import relations as independent
from bondgraph.text.diagnostic import CompileError, Diagnostic, Label, Report
from bondgraph.text.source import Span


def initial_value_needed(equation: Equation, expr: Expr, steps: Sequence[Step]) -> Missing:
    """The relation that needs the initial value of a storage."""
    free = {
        n.symbol.name.removesuffix(".0")
        for n in topological([expr])
        if n.op is Op.INT and n.symbol.kind is Kind.FREE
    }
    step = next((s for s in steps if s.variable.symbol.name in free), None)
    storage, origin, name = equation.name, equation.origin, "q0"
    if step is not None:
        storage, origin = step.equation.name, step.equation.origin
        _, dot, state = step.variable.symbol.name.partition(f"{storage}.")
        name = f"{state}0" if dot else name  # of a field with the port: `el.q0`
    finding = Diagnostic(
        "initial-value-needed",
        f"The relation at `{equation.name}` needs the initial value of"
        f" `{storage}`, which the model does not declare.",
        _labels([origin]),
        help="The storage enters it nonlinearly, so differentiating does not remove"
        f" the initial value: declare it, for example `({name} = 0)` after the"
        " element's name.",
    )
    return Missing(equation, (storage,), (*[s.equation for s in steps], equation), finding)


def loop_unsolvable(
    pool: Pool,
    about: Sequence[Equation],
    inside: Sequence[Step],
    closing: Sequence[Equation],
    below: Sequence[Step],
) -> list[Missing]:
    """The relations that a loop costs: `inside` are its steps, `below` all that they rest on."""
    equations = [*[s.equation for s in inside], *closing]
    laws = [e for e in equations if e.kind in ("law", "sensor")] or equations
    names = tuple(dict.fromkeys(e.name for e in laws))
    rest = (*[s.equation for s in below], *closing)
    slopes = [_slopes(pool, e) for e in equations]
    moving = not all(constant(slope) for own in slopes for slope in own or ())
    if moving and None not in slopes:
        finding = _moving(laws)
        return [Missing(equation, names, rest, finding) for equation in about]
    finding = Diagnostic(
        "loop-unsolvable",
        f"The loop of nonlinear equations through {', '.join(f'`{n}`' for n in names)} cannot be"
        " solved with certainty: it has no closed solution, and may have several.",
        _labels(dict.fromkeys(e.origin for e in laws)),
        help="Measure a variable inside the loop, give one of its laws in the other"
        " direction, or a law that rises everywhere, which iteration can invert.",
    )
    return [Missing(equation, names, rest, finding) for equation in about]


def _slopes(pool: Pool, equation: Equation) -> list[Expr] | None:
    """What multiplies the variables of a linear equation; None of another, and where it jumps."""
    expr = equation.zero if equation.rate is None else equation.rate
    parts = [affine(pool, expr, v) for v in equation.variables]
    found = [part[0] for part in parts if part is not None]
    linear = len(found) == len(parts) and set(symbols(*found)).isdisjoint(equation.variables)
    return found if linear and not has([expr], Op.IF) else None


def _moving(laws: Sequence[Equation]) -> Diagnostic:
    """What is said of a linear loop with known signals as coefficients that could not be solved."""
    names = list(dict.fromkeys(f"`{e.name}`" for e in laws))
    others = f" and {len(names) - 3} more" if len(names) > 3 else ""
    return Diagnostic(
        "loop-too-large",
        f"The linear loop through {', '.join(names[:3])}{others} could not be taken apart: what"
        " multiplies its variables moves, and is differentiated with each that is left out.",
        _labels(list(dict.fromkeys(e.origin for e in laws))[:3]),
        help="Measure inside it: sensors cut it into parts that are solved alone. Or describe what"
        " is far from every sensor by fewer elements.",
    )


def _too_large(loop: Sequence[Equation]) -> tuple[tuple[str, ...], Diagnostic]:
    """What is said of a linear loop whose solution is too long to be written out."""
    laws = {e.name: e.origin for e in loop if e.kind == "law"}
    names = [f"`{name}`" for name in laws]
    return tuple(laws), Diagnostic(
        "loop-too-large",
        f"The linear loop through {', '.join(names[:3])} and {len(names) - 3} more has a solution"
        " that takes more than a million products to write out.",
        _labels([*laws.values()][:3]),
        help="Measure inside it: sensors along a line through the loop cut it into parts that are"
        " solved alone. Or describe what is far from every sensor by fewer elements.",
    )


def unaccounted(
    system: EquationSystem,
    steps: Iterable[Step],
    told: Sequence[Equation],
    found: int,
    certain: bool,
    oversized: Sequence[Sequence[Equation]] = (),
) -> list[Missing]:
    """The relations that theory says there are beside those `found`, of which `told` are some.

    Their number is that of the equations less what these can determine: for a model whose unknown
    inputs all act, sensors minus the rank of the unknown inputs (Staroswiecki and Comtet-Varga,
    2001). The matching knows nothing of costs, loops or solvability; where it is not `certain` or
    disagrees, the rank of the equations decides. Loops that are `oversized` are the reason, where
    there are some; the rank of these would take too long.
    """
    position = {v: i for i, v in enumerate(system.unknowns)}
    row_of = {id(e): r for r, e in enumerate(system.equations)}
    pairs = [(row_of[id(s.equation)], position[s.variable]) for s in steps if s.how != "loop"]
    rows = [[position[v] for v in e.variables] for e in system.equations]
    matched, column_of = match(rows, len(position), pairs)
    expected = sum(c < 0 for c in column_of)
    if not oversized and (found != expected or not certain):
        expected = independent(system)
    if found >= expected:  # there may be more: of a product that is zero, where a factor rests
        return []
    known = {row_of[id(e)] for e in told}
    left = [r for r, c in enumerate(column_of) if c < 0 and r not in known]
    left += sorted(set(range(len(rows))).difference(known, left), reverse=True)
    missing = []
    for row in left[: expected - found]:
        rest = tuple(system.equations[r] for r in _resting_on(row, rows, matched))
        inside = {id(e) for e in rest}
        loop = next((own for own in oversized if any(id(e) in inside for e in own)), None)
        if loop is None and oversized:
            loop = oversized[0]
        if loop is not None:
            names, finding = _too_large(loop)
        else:
            names, finding = (), _without_reason(system, expected, found)
        missing.append(Missing(system.equations[row], names, rest, finding))
    return missing


def _without_reason(system: EquationSystem, expected: int, found: int) -> Diagnostic:
    return Diagnostic(
        "relations-missing",
        f"The structure of the model has {expected} independent relations, of which"
        f" {found} could be derived.",
        _labels([system.graph.nodes[0].origin]),
        help="Measure one more variable in the part that the relations found leave out;"
        " `bondgraph dump --stage residuals` shows it.",
        severity="warning",
    )


def _resting_on(row: int, rows: list[list[int]], matched: list[int]) -> list[int]:
    """An equation and those that determine its variables, in the order of the model."""
    seen = {row}
    stack = [row]
    while stack:
        for column in rows[stack.pop()]:
            other = matched[column]
            if other >= 0 and other not in seen:
                seen.add(other)
                stack.append(other)
    return sorted(seen)


def tell(report: Report, reduced: ReducedSystem) -> None:
    """Report what is missing: as warnings where there is a relation, else as the reason why not."""
    for missing in reduced.missing:
        finding = missing.finding
        report.add(finding._replace(severity="warning") if reduced.closings else finding)


def stop_without_any(report: Report, found: ResidualSet) -> None:
    """Raise CompileError with what is missing, if that is why there is no residual at all.

    As where the only relation that was had turns out to hold whatever the machine does.
    """
    reasons = tuple(dict.fromkeys(m.finding for m in found.missing if m.explained))
    if reasons and not found.residuals:
        told = {(d.code, d.message) for d in reasons}
        others = [d for d in report.diagnostics if (d.code, d.message) not in told]
        raise CompileError((*others, *reasons))


def _labels(places: Iterable[Span]) -> tuple[Label, ...]:
    return tuple(Label(place) for place in places)
