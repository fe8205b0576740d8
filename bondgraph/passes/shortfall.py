"""Say what an elimination could not give, by the elements of the model and with a remedy."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from bondgraph.ir.equations import Equation, EquationSystem
from bondgraph.ir.expr import Expr, Kind, Op, topological
from bondgraph.ir.residuals import Step
from bondgraph.passes.matching import match
from bondgraph.passes.rank import relations as independent
from bondgraph.text.diagnostic import Report


def initial_value_needed(
    report: Report, equation: Equation, expr: Expr, steps: Sequence[Step]
) -> None:
    """Say which storage needs an initial value for a relation to be had."""
    free = {
        n.symbol.name.removesuffix(".0")
        for n in topological([expr])
        if n.op is Op.INT and n.symbol.kind is Kind.FREE
    }
    for step in steps:
        if step.variable.symbol.name in free:
            name = "q0" if step.variable.symbol.name.endswith(".q") else "p0"
            report.error(
                "initial-value-needed",
                f"The relation at `{equation.name}` needs the initial value of"
                f" `{step.equation.name}`, which the model does not declare.",
                step.equation.origin,
                help="The storage enters it nonlinearly, so differentiating does not remove"
                f" the initial value: declare it, for example `({name} = 0)` after the"
                " element's name.",
            )
            return


def loop_unsolvable(report: Report, steps: Sequence[Step], closing: Sequence[Equation]) -> None:
    """Say which loop costs a relation, by the elements that it runs through."""
    equations = [*[s.equation for s in steps], *closing]
    laws = [e for e in equations if e.kind in ("law", "sensor")] or equations
    names = ", ".join(dict.fromkeys(f"`{e.name}`" for e in laws))
    report.error(
        "loop-unsolvable",
        f"The loop of nonlinear equations through {names} cannot be solved with certainty:"
        " it has no closed solution, and may have several.",
        *dict.fromkeys(e.origin for e in laws),
        help="Measure a variable inside the loop, give one of its laws in the other"
        " direction, or a law that rises everywhere, which iteration can invert.",
    )


def loop_too_large(report: Report, loop: Sequence[Equation]) -> None:
    """Say which linear loop has a solution that is too long to be written out."""
    laws = {e.name: e.origin for e in loop if e.kind == "law"}
    names = [f"`{name}`" for name in laws]
    report.error(
        "loop-too-large",
        f"The linear loop through {', '.join(names[:3])} and {len(names) - 3} more has a solution"
        " that takes more than a million products to write out.",
        *list(laws.values())[:3],
        help="Measure inside it: sensors along a line through the loop cut it into parts that are"
        " solved alone. Or describe what is far from every sensor by fewer elements.",
    )


def relations_missing(
    report: Report, system: EquationSystem, steps: Iterable[Step], found: int, certain: bool
) -> None:
    """Hold the number of relations to theory: equations less what they can determine.

    For a model whose unknown inputs all act this is sensors minus the rank of the unknown inputs
    (Staroswiecki and Comtet-Varga, 2001). The matching knows nothing of costs, loops or
    solvability; where it is not `certain` or disagrees, the rank of the equations decides.
    """
    position = {v: i for i, v in enumerate(system.unknowns)}
    row_of = {id(e): r for r, e in enumerate(system.equations)}
    pairs = [(row_of[id(s.equation)], position[s.variable]) for s in steps if s.how != "loop"]
    rows = [[position[v] for v in e.variables] for e in system.equations]
    _, column_of = match(rows, len(position), pairs)
    expected = sum(c < 0 for c in column_of)
    if found != expected or not certain:
        expected = independent(system)
    if found < expected:  # there may be more: of a product that is zero, where a factor rests
        report.warning(
            "relations-missing",
            f"The structure of the model has {expected} independent relations, of which"
            f" {found} could be derived.",
            system.graph.nodes[0].origin,
            help="Measure one more variable in the part that the relations found leave out;"
            " `bondgraph dump --stage residuals` shows it.",
        )
