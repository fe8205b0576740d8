"""`bondgraph isolate`: the testable subsets of a model, and what they could tell apart at best."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bondgraph.cli import console
from bondgraph.cli.options import count
from bondgraph.cli.reasons import at_best
from bondgraph.cli.structural import MODEL_HELP, named, open_structure
from bondgraph.cli.terminal_layout import names, width
from bondgraph.text.diagnostic import CompileError
from bondgraph.text.numerals import plural

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace

    from bondgraph.compilation import Compilation
    from bondgraph.ir.structural_model import StructuralModel
    from bondgraph.structural.analyse import Analysis, Chosen

LIMIT = 10_000


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `isolate`."""
    parser.add_argument("model", metavar="MODEL", help=MODEL_HELP)
    parser.add_argument("--json", action="store_true", help="print one JSON object (docs/json.md)")
    parser.add_argument(
        "--limit",
        metavar="N",
        type=count,
        default=LIMIT,
        help=f"stop after so many MSO sets (default: {LIMIT})",
    )
    parser.add_argument("--sets", action="store_true", help="list all MSO sets that were found")


def run(args: Namespace) -> int:
    """Search, choose, print."""
    model, diagnostics, compilation = open_structure(args.model)
    from bondgraph.structural.analyse import analyse

    with console.progress_bar() as progress:
        analysis = analyse(
            model, args.limit, lambda done, found: progress(min(done, 1), f"{found} sets")
        )
    laws = None if compilation is None else _by_laws(compilation)
    return console.told(
        args.json,
        diagnostics,
        message(analysis),
        lambda: {**_result(analysis, args.sets), "best": laws},
        lambda: _lines(analysis, args.sets, laws),
    )


def _by_laws(compilation: Compilation) -> tuple[tuple[str, ...], ...] | None:
    """The groups that no residuals could divide, by the laws of a model that is small and right."""
    try:
        return at_best(compilation)
    except CompileError:  # `compile` says why
        return None


def message(analysis: Analysis) -> str:
    """One line on what the structure could tell."""
    best, count = analysis.best, len(analysis.model.faults)
    if not analysis.sets.number:
        return "nothing is measured twice over, so no fault can be detected"
    return (
        f"at best {count - len(best.undetectable)} of {plural(count, 'fault')} can be detected,"
        f" in {plural(len(best.groups), 'group')}"
    )


def _result(analysis: Analysis, all_sets: bool) -> dict[str, object]:
    model, sets = analysis.model, analysis.sets
    result: dict[str, object] = {
        "model": model.name,
        "n_equations": len(model.equations),
        "n_unknowns": len(model.unknowns),
        "redundancy": sets.redundancy,
        "n_mso": sets.number,
        "complete": sets.complete,
        "n_integral": len(analysis.integral),
        "undetectable": named(model, analysis.best.undetectable),
        "groups": [named(model, g) for g in analysis.best.groups],
        "mso_groups": [named(model, g) for g in analysis.reached.groups],
        "least": analysis.least,
        "chosen": [_entry(model, chosen) for chosen in analysis.chosen],
    }
    if all_sets:
        result["sets"] = [[model.equations[e].name for e in mso] for mso in sets.all()]
    return result


def _entry(model: StructuralModel, chosen: Chosen) -> dict[str, object]:
    way = chosen.realisation
    return {
        "equations": [model.equations[e].name for e in chosen.equations],
        "faults": named(model, chosen.faults),
        "residual": model.equations[way.residual].name,
        "causality": way.causality,
        "loop": way.loop,
    }


def _lines(
    analysis: Analysis, all_sets: bool, laws: tuple[tuple[str, ...], ...] | None
) -> list[str]:
    model, columns = analysis.model, width()
    lines = [f"{model.name}: {message(analysis)}", *_counts(analysis)]
    if analysis.best.groups:
        lines += ["", "Told apart at best by the structure, whatever residuals are used"]
        for group in analysis.best.groups:
            lines += names(named(model, group), columns)
    if laws is not None and {frozenset(named(model, g)) for g in analysis.best.groups} != {
        frozenset(g) for g in laws
    }:
        lines += ["", f"Told apart at best by the laws themselves: {plural(len(laws), 'group')}"]
        for part in laws:
            lines += names(part, columns)
    if analysis.best.undetectable:
        lines += ["", "Undetectable"]
        lines += names(named(model, analysis.best.undetectable), columns)
    if len(analysis.reached.groups) < len(analysis.best.groups):
        lines += [
            "",
            f"MSO sets alone reach {plural(len(analysis.reached.groups), 'group')}; for the rest"
            " a fault must be",
            "eliminated between the equations that hold it.",
        ]
    if analysis.chosen:
        count = plural(len(analysis.chosen), "residual")
        how = "no fewer reach as much" if analysis.least else "they reach as much"
        lines += ["", f"Chosen: {count}, {how} as all MSO sets together"]
        for number, chosen in enumerate(analysis.chosen, 1):
            lines += _chosen(model, number, chosen, columns)
    if all_sets:
        lines += ["", "MSO sets"]
        for number, mso in enumerate(analysis.sets.all(), 1):
            held = [model.equations[e].name for e in mso]
            lines += names(held, columns, f"  {number:4}  ")
    return lines


def _counts(analysis: Analysis) -> list[str]:
    model, sets = analysis.model, analysis.sets
    size = f"{plural(len(model.equations), 'equation')}, {plural(len(model.unknowns), 'unknown')}"
    lines = [f"{size}, redundancy {sets.redundancy}"]
    if sets.number:
        few = "" if sets.complete else " (the search stopped there: --limit)"
        lines.append(f"{plural(sets.number, 'MSO set')}{few}")
        lines.append(f"{len(analysis.integral)} of low index, with nothing to differentiate")
    return lines


def _chosen(model: StructuralModel, number: int, chosen: Chosen, columns: int) -> list[str]:
    way = chosen.realisation
    loop = "" if way.loop == "none" else f", with {_article(way.loop)} loop"
    causality = {"algebraic": "no dynamics"}.get(way.causality, f"{way.causality} causality")
    lead = f"  s{number:<3} "
    return [
        f"{lead}{plural(len(chosen.equations), 'equation')}, residual"
        f" {model.equations[way.residual].name}: {causality}{loop}",
        *names(named(model, chosen.faults), columns, "       sees "),
    ]


def _article(loop: str) -> str:
    return f"an {loop}" if loop == "algebraic" else f"a {loop}"
