"""The relations of a model for its report: formulas, the causal path, what each sees."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from bondgraph.algebra.present import parts
from bondgraph.backends.report.content import DerivedStep, PathLine, RelationPart
from bondgraph.backends.report.formulas import Typesetter, operations
from bondgraph.compilation import Compilation
from bondgraph.ir.program import Program
from bondgraph.notation.derivation_words import ending, headline, lines, remark, title
from bondgraph.notation.dump_stages import place, residual_origin
from bondgraph.notation.line import show
from bondgraph.passes.relation.path import path
from bondgraph.text.moment import often
from bondgraph.text.numerals import plural
from bondgraph.views import Relation

LONGEST = 300  # operations of a formula that is worth its ink
_STEPS = 80  # of a causal path
_ROOM = 800_000  # characters of a page: with hundreds of relations the first are enough


def relations(
    compilation: Compilation, typesetter: Typesetter, program: Program | None, derive: bool = False
) -> tuple[RelationPart, ...]:
    """All relations, in order; `program` knows what `step` cannot see (None: there is none).

    With `derive` each has its derivation.
    """
    left = _ROOM
    found = []
    for relation in compilation.residuals:
        part = _relation(compilation, typesetter, relation, program, left > 0)
        left -= sum(map(len, part.html)) + sum(len(line.html) for line in part.path)
        if derive and left > 0:
            part = part._replace(derivation=derived_steps(compilation, typesetter, relation.name))
            steps = [step for _, own, _ in part.derivation for step in own]
            left -= sum(len(line) for step in steps for line in step.html)
        found.append(part)
    return tuple(found)


def _relation(
    compilation: Compilation,
    typesetter: Typesetter,
    relation: Relation,
    program: Program | None,
    room: bool,
) -> RelationPart:
    residual, source = relation.residual, compilation.source
    size = operations(residual.expr)
    html: tuple[str, ...] = ()
    too_long = ""
    if size <= LONGEST and room:
        form = parts(compilation.graph, residual)
        html = tuple(typesetter.equations(typesetter.name(relation.name).text, form))
    else:
        too_long = (
            f"{plural(size, 'operation')}, not written out here;"
            f" bondgraph explain {source.path.rpartition('/')[2]} {relation.name} prints them."
        )
    listed, longer = _path(compilation, typesetter, relation) if room else ((), 0)
    weak = compilation.detectability.weak(relation.name) or ()
    closing = residual.closing.zero
    modes = {i.name for i in compilation.graph.inputs if i.mode}
    orders = {s: n for s, n in relation.orders.items() if s not in modes}
    return RelationPart(
        relation.name,
        residual_origin(residual, source),
        html,
        too_long,
        listed,
        typesetter.vanishing(closing) if operations(closing) <= LONGEST else "",
        longer,
        tuple(f for f in relation.faults if f not in weak),
        weak,
        tuple(_orders(typesetter, orders)),
        tuple(_notes(compilation, relation, program)),
    )


def _orders(
    typesetter: Typesetter, orders: Mapping[str, int]
) -> Iterator[tuple[str, tuple[str, ...]]]:
    """The signals by their highest derivative, the highest first."""
    words = {-1: "only integrated", 0: "none of", 1: "first of", 2: "second of", 3: "third of"}
    for order in sorted(set(orders.values()), reverse=True):
        signals = tuple(typesetter.inline(s) for s, n in orders.items() if n == order)
        yield words.get(order, f"{_ordinal(order)} of"), signals


def _ordinal(number: int) -> str:
    """`4th`, `22nd`."""
    late = number % 100 in (11, 12, 13)
    return f"{number}{'th' if late else {1: 'st', 2: 'nd', 3: 'rd'}.get(number % 10, 'th')}"


def _path(
    compilation: Compilation, typesetter: Typesetter, relation: Relation
) -> tuple[tuple[PathLine, ...], int]:
    taken = path(relation.residual, compilation.equations, compilation.derivative)
    nodes = compilation.graph.nodes
    steps = list(zip(taken, relation.residual.steps, strict=True))
    shown = steps if len(steps) <= _STEPS else steps[: _STEPS // 2] + steps[-_STEPS // 2 :]
    listed = []
    for step, found in shown:
        if operations(step.expr) <= LONGEST // 2:
            html = typesetter.assigned(step.variable, step.expr)
        else:
            html = typesetter.inline(step.variable)
        where = place(step.origin, compilation.source)
        at = found.equation.node
        node = nodes[at].path if at >= 0 else ""
        listed.append(PathLine(html, step.why, where, step.leaves, node))
    return tuple(listed), len(steps) - len(shown)


def derived_steps(
    compilation: Compilation, typesetter: Typesetter, name: str
) -> tuple[tuple[str, tuple[DerivedStep, ...], str], ...]:
    """Title, steps and ending; of a relation with one in each position of a switch, of each."""
    found = []
    nodes = compilation.graph.nodes
    for own in compilation.derivation(name):
        zero, steps = own.pool.zero, []
        for step in own.steps:
            html = []
            for left, right, note in lines(step, zero):
                if operations(right) > LONGEST:
                    continue
                if left is None:
                    line = typesetter.continued(right)
                elif left is zero:
                    line = typesetter.vanishing(right)
                else:
                    line = typesetter.assigned(left.symbol.name, right)
                html.append(f'{line}<span class="why">{note}</span>' if note else line)
            words = headline(own, step, compilation.source, show)
            at = -1 if step.equation is None else step.equation.node
            node = nodes[at].path if at >= 0 else ""
            steps.append(DerivedStep(words, tuple(html), remark(step, show), node))
        found.append((title(own, compilation.graph.name), tuple(steps), ending(own)))
    return tuple(found)


def _notes(compilation: Compilation, relation: Relation, program: Program | None) -> list[str]:
    """Sentences on what limits a relation, and its code."""
    residual = relation.residual
    notes = []
    if residual.free_of is not None:
        notes.append(f"It does not react to {residual.free_of}, which was taken as unknown for it.")
    if residual.differentiated > 0:
        notes.append("Differentiated, because an initial value is not declared.")
    if residual.differentiated < 0:
        notes.append("It rests on declared initial values: what is left over are rates alone.")
    if compilation.detectability.weak(relation.name) is None and relation.faults:
        notes.append(
            "Whether a fault shows as long as it lasts is not known: the machine has no steady"
            " operation to tell by."
        )
    if program is None:
        return notes
    info = next(r for r in program.residuals if r.path == relation.name)
    if info.invisible:
        names = ", ".join(info.invisible)
        notes.append(f"At {often(program.rate)} its code cannot see {names}.")
    if info.follows:
        notes.append(f"Its code is an observer that follows {info.follows}.")
    if info.approximate:
        notes.append(f"Its code is an approximation: {info.approximate}.")
    if info.unavailable:
        notes.append(f"Its code never has a value: {info.unavailable}.")
    if info.unwritten:
        notes.append(f"It has no exact form in the code: {info.unwritten}.")
    bounds = compilation.thresholds
    others = () if bounds is None else bounds.residuals
    why = next((b.unavailable for b in others if b.path == info.path), "")
    if why and why != info.unavailable:
        notes.append(f"It has no adaptive threshold: {why}.")
    return notes
