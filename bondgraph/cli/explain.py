"""`bondgraph explain`: an error code, or something in a model: an element, a residual, a fault."""

from __future__ import annotations

import os
import re
import sys
import textwrap
from typing import TYPE_CHECKING

from bondgraph import Compilation, compile
from bondgraph.cli import console
from bondgraph.cli.options import isolating
from bondgraph.cli.stuck import by_modes, positions, seen
from bondgraph.cli.terminal_layout import formula, names, prose, width
from bondgraph.ir.signature_matrix import stuck
from bondgraph.notation.dump_stages import bond_name, equation_name, node_name, place, reason
from bondgraph.notation.line import show
from bondgraph.text.diagnostic import CompileError
from bondgraph.text.numerals import plural

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace
    from collections.abc import Sequence

    from bondgraph.ir.causal import CausalGraph
    from bondgraph.ir.graph import Bond, BondGraph
    from bondgraph.views import Relation

_SETS = 4  # sets of faults any two of which could look like a fault: more nobody reads


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `explain`."""
    parser.usage = (
        "bondgraph explain [-h] [--latex] [--isolate] [--derive [-o FILE]] (CODE | MODEL NAME)"
    )
    parser.add_argument(
        "subject", metavar="CODE or MODEL", help="the code of a diagnostic, or a model"
    )
    parser.add_argument(
        "name", metavar="NAME", nargs="?", help="a bond (number), element, residual or fault"
    )
    parser.add_argument(
        "--latex", action="store_true", help="of a residual: its closed form in LaTeX"
    )
    parser.add_argument(
        "--derive", action="store_true",
        help="of a residual: how it follows from the equations, each step done by SymPy",
    )  # fmt: skip
    parser.add_argument(
        "-o", "--output", metavar="FILE",
        help="with --derive: into a notebook (.ipynb), a script (.py), .md, .tex or .txt",
    )  # fmt: skip
    isolating(parser)


def run(args: Namespace) -> int:
    """Print the explanation; the exit status is 2 where there is nothing of that name."""
    if args.output is not None and not (args.derive and args.name):
        print("-o is for a derivation: explain MODEL RESIDUAL --derive -o FILE", file=sys.stderr)
        return 2
    if args.name is None:
        return _code(args.subject)
    compilation = compile(args.subject, isolate=args.isolate)
    if args.derive:
        return _derive(compilation, args.name, args.latex, args.output)
    if args.latex:
        return _latex(compilation, args.name)
    lines = about(compilation, args.name)
    if not lines:
        raise console.Unknown(args.name, "nothing in the model", _all_names(compilation))
    print("\n".join(lines))
    return 0


def _code(code: str) -> int:
    from bondgraph.errors import codes, page

    text = page(code)
    if text is None:
        if os.path.exists(code) or code.endswith(".bg"):
            print(f"say what of {code} to explain: explain MODEL NAME", file=sys.stderr)
            return 2
        raise console.Unknown(code, "no error code", codes())
    print(text.rstrip())
    return 0


def _all_names(compilation: Compilation) -> list[str]:
    graph = compilation.graph
    found = [n.path for n in graph.nodes] + list(graph.faults)
    found += [i.name for i in graph.inputs if i.mode]
    found += [b.label for b in graph.bonds if b.label]
    return list(dict.fromkeys([*found, *compilation.signatures.residuals]))


def _latex(compilation: Compilation, name: str) -> int:
    for relation in compilation.residuals:
        if relation.name == name:
            print(relation.latex)
            return 0
    raise console.Unknown(name, "no residual", compilation.signatures.residuals)


def _derive(compilation: Compilation, name: str, latex: bool, out: str | None) -> int:
    """Print or write the derivation of a residual."""
    try:
        found = compilation.derivation(name)
    except KeyError:
        names = compilation.signatures.residuals
        raise console.Unknown(name, "no residual", names) from None
    if out is not None:
        found.write(out)
        print(f"written to {out}")
        if not found.complete:
            print(f"note: {found.ending}", file=sys.stderr)
        return 0
    print(found.latex if latex else "\n".join(_folded(found.text)))
    return 0


def _folded(text: str) -> list[str]:
    """The lines of a derivation, as wide as the terminal."""
    columns = width()
    lines: list[str] = []
    for line in text.splitlines():
        left, equals, value = line.partition(" = ")
        if len(line) <= columns:
            lines.append(line)
        elif equals and line.startswith("      "):
            lines += formula(value, columns, f"{left} = ", " " * 13)
        else:
            lines += textwrap.wrap(line, columns, subsequent_indent="    ")
    return lines


def about(compilation: Compilation, name: str) -> list[str]:
    """Everything that the model has under a name: a residual, a bond, a node, a fault."""
    graph = compilation.graph
    parts: list[list[str]] = []
    for node_number, node in enumerate(graph.nodes):
        if node.path == name:
            parts.append(_node(compilation, node_number))
    parts += [_bond(compilation, bond) for bond in _bonds(graph, name)]
    if name in graph.faults:
        parts.append(_fault(compilation, name))
    if any(i.mode and i.name == name for i in graph.inputs):
        parts.append(_switch(compilation, name))
    parts += _missing(compilation, name)
    # A residual needs all of the analysis, so it is looked for last; `r1` may name a node as well.
    if not parts or re.fullmatch(r"r\d+", name):
        for relation in compilation.residuals:
            if relation.name == name:
                parts.append(_residual(compilation, relation))
    lines: list[str] = []
    for part in parts:
        lines += ["", *part] if lines else part
    return lines


def _missing(compilation: Compilation, name: str) -> list[list[str]]:
    """The relations that could not be had and are about a name, or fail because of it."""
    try:
        found = compilation.reduced.missing
    except CompileError:  # a model that is wrong, or of which no relation can be had, says so
        return []
    columns = width()
    parts = []
    for missing in found:
        if name == missing.about.name or name in missing.elements:
            head = f"missing  {equation_name(missing.about, compilation.source)}"
            parts.append(
                [
                    head,
                    *prose(missing.finding.message, columns, "  "),
                    *prose(missing.finding.help, columns, "  "),
                ]
            )
    return parts


def _bonds(graph: BondGraph, name: str) -> list[Bond]:
    """The bonds with a label; where no bond has it, the bond of that number in `dump`."""
    labelled = [b for b in graph.bonds if b.label == name]
    if labelled:
        return labelled
    return [b for b in graph.bonds if str(b.number) == name.removeprefix("bond ").strip()]


def _node(compilation: Compilation, number: int) -> list[str]:
    graph = compilation.graph
    node = graph.nodes[number]
    noun = {"0": "0-junction", "1": "1-junction"}.get(node.kind, f"{node.keyword} element")
    lines = [f"{node_name(node)}  {noun}, {place(node.origin, compilation.source)}"]
    if node.doc:
        lines.append(f"  {node.doc}")
    if node.domain:
        lines.append(f"  domain {node.domain}")
    if node.kind == "0":
        lines.append("  one effort, and the flows balance")
    if node.kind == "1":
        lines.append("  one flow, and the efforts balance")
    lines += [f"  law 0 = {show(law.zero)}" for law in node.laws]
    if node.sensor is not None:
        lines.append(f"  reads {show(node.sensor)}")
    for causal in (compilation.integral, compilation.derivative):
        lines.append(f"  bonds in preferred {causal.preference} causality")
        for bond in graph.bonds:
            if number in (bond.tail.node, bond.head.node):
                lines.append(f"    {_stroke(causal, bond)}")
    return lines


def _bond(compilation: Compilation, bond: Bond) -> list[str]:
    graph = compilation.graph
    lines = [f"{bond_name(graph, bond)}  bond, {place(bond.origin, compilation.source)}"]
    tail, head = graph.nodes[bond.tail.node].path, graph.nodes[bond.head.node].path
    lines.append(f"  power counts positive from {tail} to {head}")
    for causal in (compilation.integral, compilation.derivative):
        lines.append(f"  preferred {causal.preference} causality")
        lines.append(f"    {_stroke(causal, bond)}")
    return lines


def _stroke(causal: CausalGraph, bond: Bond) -> str:
    graph = causal.graph
    stroke = causal.strokes[bond.number]
    end = bond.tail if stroke.at == "tail" else bond.head
    return (
        f"{bond_name(graph, bond)}: stroke at {graph.nodes[end.node].path},"
        f" {reason(causal, stroke.reason)}"
    )


def _residual(compilation: Compilation, relation: Relation) -> list[str]:
    from bondgraph.cli.summary import closed_form
    from bondgraph.passes.relation.path import path

    columns = width()
    residual = relation.residual
    lines = closed_form(compilation, relation, columns, longest=None)
    lines += ["", "Computed from the known signals, in this order"]
    steps = path(residual, compilation.equations, compilation.derivative)
    for step in steps:
        mark = "  <" if step.leaves else ""
        lines += formula(step.value, columns, f"  {step.variable} = ", "    ")
        lines.append(f"      {step.why}, {place(step.origin, compilation.source)}{mark}")
    lines += formula(show(residual.closing.zero), columns, "  0 = ", "    ")
    if any(step.leaves for step in steps):
        lines += [
            "",
            "  < here the computation runs against the strokes of the drawing in derivative",
            "    causality: it needs both variables of a bond from one end (bicausal)",
        ]
    if residual.differentiated > 0:
        lines += ["", "  The relation is differentiated: an initial value is not declared."]
    if residual.differentiated < 0:
        lines += [
            "",
            "  What is left over are rates alone: what is stored adds up to what it does with the",
            "  declared initial values, and the relation says so without a derivative.",
        ]
    observer = compilation.observers[relation.name]
    if isinstance(observer, str):
        lines += ["", "As an observer", f"  none: {observer}"]
    else:
        lines += ["", f"As an observer, which follows {observer.sensor} (--form observer)"]
        for state, rate in zip(observer.states, observer.rates, strict=True):
            lines += formula(show(rate), columns, f"  D({show(state)}) = ", "    ")
        lines += formula(show(observer.output), columns, f"  {observer.sensor} = ", "    ")
    shown = [f"{s} {'only integrated' if n < 0 else n}" for s, n in relation.orders.items()]
    lines += ["", "Highest derivatives", *names(shown, columns)]
    weak = compilation.detectability.weak(relation.name)
    lasting = [f for f in relation.faults if f not in (weak or ())]
    lines += ["", "Faults that it sees", *names(lasting, columns)]
    if weak:
        lines += ["", "Faults that it sees only while signals change", *names(weak, columns)]
    return lines


def _fault(compilation: Compilation, name: str) -> list[str]:
    from bondgraph.cli.reasons import reason

    matrix = compilation.signatures
    lines = [f"{name}  fault candidate"]
    seen = [r for r, hit in zip(matrix.residuals, matrix.row(name), strict=True) if hit]
    if not seen:
        return [*lines, f"  undetectable: {reason(compilation, name)}"]
    lines.append(f"  moves {', '.join(seen)}")
    weak = [r for r in seen if name in (compilation.detectability.weak(r) or ())]
    if weak == seen:
        lines.append("  weakly: only while signals change, not in steady operation")
    elif weak:
        lines.append(f"  of these {', '.join(weak)} only while signals change")
    others = matrix.confused_with(name)
    if others:
        lines += ["  cannot be told apart from", *names(others, 100)]
        lines += _combined(compilation, name, others)
    else:
        lines.append("  is told apart from all other faults")
    lines += _by_mode(compilation, name)
    lines += _double(compilation, name)
    return lines + _events(compilation.graph, name)


def _events(graph: BondGraph, name: str) -> list[str]:
    found = [e for e in graph.events if e.target == name]
    return [f"  event {e.name}: {e.doc}".rstrip(": ") for e in found]


def _switch(compilation: Compilation, name: str) -> list[str]:
    """What shows where a switch is not in the position that it is told."""
    found = compilation.mode_signatures
    lines = [f"{name}  switch, a mode that is known while running"]
    if name not in found.names:
        return [*lines, "  nothing in the model depends on it"]
    for fault, there in positions(found):
        if fault in (stuck(name, False), stuck(name, True)):
            lines.append(f"  {fault}")
            for what in by_modes(there):
                lines += prose(what, width(), "    ")
    if len(found.modes) < found.total:
        lines.append(f"  and {found.total - len(found.modes)} modes more")
    return lines + _events(compilation.graph, name)


def _by_mode(compilation: Compilation, name: str) -> list[str]:
    """What a fault does in each mode of a switched machine, where that is not the same in all."""
    modes = compilation.mode_signatures.modes
    lines = [*by_modes([(mode, seen(mode, name)) for mode in modes])]
    return [f"  {line}" for line in lines] if len(lines) > 1 else []


def _combined(compilation: Compilation, name: str, others: Sequence[str]) -> list[str]:
    """What other residuals, made by combining these, could tell the fault from."""
    group = next((g for g in compilation.maximum_isolability or () if name in g), None)
    if group is None:
        return []
    apart = [f for f in others if f not in group]
    if not apart:
        return ["  and no combination of the residuals would help"]
    sharp = compilation.options.isolate
    what = "and no residual in closed form tells" if sharp else "but --isolate may tell"
    return [f"  {what} it from", *names(apart, 100)]


def _double(compilation: Compilation, name: str) -> list[str]:
    """Which two faults of other groups, at once, could look like the fault."""
    found = compilation.double_faults
    if len(found.groups) < 3:
        return []
    if found.reason:
        return [f"  whether two faults at once look like it is not known: {found.reason}"]
    if found.any_two:
        return ["  any two other faults that could be told apart, at once, could look like it"]
    sets = found.like(name)
    lines = []
    for several in sets[:_SETS]:
        listed = [g[0] + (f" or {len(g) - 1} more" if len(g) > 1 else "") for g in several]
        which = "any two, at once, of" if len(several) > 2 else "both, at once, of"
        lines += [f"  could be {which}", *names(listed, 100)]
    if len(sets) > _SETS:
        lines.append(f"  or two faults of {plural(len(sets) - _SETS, 'set')} more")
    return lines or ["  no two faults of other groups, at once, look like it"]
