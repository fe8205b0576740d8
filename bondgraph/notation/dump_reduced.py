"""The eliminated equations as text: what `dump --stage reduced` prints and what tests compare."""

from __future__ import annotations

from collections.abc import Iterable

from bondgraph.ir.expr import KNOWN_SIGNALS, Expr, Op, topological
from bondgraph.ir.residuals import Closing, Missing, ReducedSystem, Step
from bondgraph.notation.dump_stages import equation_name, order_line, step_row, table
from bondgraph.notation.line import show
from bondgraph.text.source import Source


def dump_reduced(reduced: ReducedSystem) -> str:
    """How each variable follows, in the order of the elimination, what was left over, and what not.

    Each step has the highest derivative of a known signal that it takes; where a loop gave a
    variable, the value that closes the loop stands below it.
    """
    source = reduced.system.graph.source
    resolved = {s.variable: s for closing in reduced.closings for s in closing.steps}
    steps = [resolved.get(s.variable, s) for s in reduced.steps]
    orders = derivative_orders(s.closed for s in steps)
    total, found = len(reduced.system.unknowns), len(reduced.closings)
    relations = f"{found} relation{'' if found == 1 else 's'}"
    lines = [f"{len(steps)} of {total} unknowns follow, {relations}", ""]
    lines += table(row for step in steps for row in _step_rows(step, orders, source))
    for closing in reduced.closings:
        lines += ["", *_closing_lines(closing, source)]
    for missing in reduced.missing:
        lines += ["", *_missing_lines(missing, source)]
    if reduced.unsolved:
        lines += ["", f"no sensor reaches: {', '.join(map(show, reduced.unsolved))}"]
    if reduced.unmonitored:
        names = dict.fromkeys(equation_name(e, source) for e in reduced.unmonitored)
        lines += ["", "not monitored", *[f"  {name}" for name in names]]
    return "\n".join(lines)


def derivative_orders(exprs: Iterable[Expr]) -> dict[Expr, int | None]:
    """The highest derivative of a known signal in each node of some expressions.

    -1 where it is only integrated, None where there is no known signal.

    >>> from bondgraph.ir.expr import Kind, Pool
    >>> p = Pool(); y, k = p.symbol("y", Kind.SENSOR), p.symbol("k", Kind.PARAM)
    >>> x = p.add((1, p.der(y, 2)), (1, p.der(k)), (1, y))
    >>> derivative_orders([x])[x]
    2
    """
    found: dict[Expr, int | None] = {}
    for node in topological(exprs):
        below = [order for a in node.args if (order := found[a]) is not None]
        own = max(below, default=0 if node.kind in KNOWN_SIGNALS else None)
        shift = (node.op is Op.DER) - (node.op is Op.INT)
        found[node] = None if own is None else own + shift
    return found


def _step_rows(
    step: Step, orders: dict[Expr, int | None], source: Source
) -> list[tuple[str, ...]]:
    left, value, why = step_row(step, source)
    order = orders[step.closed]
    takes = "" if order is None else f"D {order}"
    rows: list[tuple[str, ...]] = [(left, value, takes, why)]
    if step.how == "loop" and step.closed is not step.value:
        rows.append(("", f"= {show(step.closed)}"))
    return rows


def _closing_lines(closing: Closing, source: Source) -> list[str]:
    lines = [f"left over: {equation_name(closing.equation, source)}, {len(closing.steps)} steps"]
    if closing.raw is not closing.expr:
        lines.append(f"  raw  0 = {show(closing.raw)}")
    lines += order_line(closing.differentiated)
    return [*lines, f"  0 = {show(closing.expr)}"]


def _missing_lines(missing: Missing, source: Source) -> list[str]:
    finding = missing.finding
    lines = [f"missing: {equation_name(missing.about, source)}"]
    lines.append(f"  {finding.code}: {finding.message}")
    if missing.equations:
        names = dict.fromkeys(equation_name(e, source) for e in missing.equations)
        lines.append(f"  rests on: {'; '.join(names)}")
    return lines
