"""`bondgraph sensors`: the places where one more sensor would help, and the cheapest that do."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from bondgraph.cli import console
from bondgraph.cli.structural import MODEL_HELP, named, open_structure
from bondgraph.cli.terminal_layout import names, width
from bondgraph.text.numerals import plural

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace

    from bondgraph.compilation import Compilation
    from bondgraph.ir.structural_model import StructuralModel
    from bondgraph.structural.placement import Candidate, Placement, Placing
    from bondgraph.structural.structural_isolability import Isolability

_SHOWN = 20  # places in the table of a report; the JSON has all


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `sensors`."""
    parser.add_argument("model", metavar="MODEL", help=MODEL_HELP)
    parser.add_argument("--json", action="store_true", help="print one JSON object (docs/json.md)")
    parser.add_argument(
        "--cost",
        metavar="NAME=COST",
        action="append",
        default=[],
        type=_cost,
        help="what a sensor at this junction, element or unknown costs (default: 1)",
    )
    parser.add_argument(
        "--elements", action="store_true", help="measure in and across elements too"
    )


def _cost(text: str) -> tuple[str, float]:
    name, _, number = text.rpartition("=")
    value = float(number)
    if not name or not 0 <= value < float("inf"):
        raise ValueError
    return name, value


_cost.__name__ = "NAME=COST"


def run(args: Namespace) -> int:
    """Rank the places, find the cheapest choice, print."""
    model, diagnostics, compilation = open_structure(args.model)
    costs = dict(args.cost)
    unknown = [name for name in costs if name not in _names(model, compilation)]
    if unknown:
        what = "unknown" if compilation is None else "junction or element"
        print(f"error: no {what} is called {unknown[0]}", file=sys.stderr)
        return 2
    candidates = _candidates(model, compilation, costs, args.elements)
    found = _Found(model, candidates, compilation is not None and not args.elements)
    return console.told(args.json, diagnostics, found.message(), found.result, found.lines)


def _names(model: StructuralModel, compilation: Compilation | None) -> set[str]:
    if compilation is None:
        return set(model.unknowns)
    return {node.path for node in compilation.graph.nodes}


def _candidates(
    model: StructuralModel,
    compilation: Compilation | None,
    costs: dict[str, float],
    elements: bool,
) -> tuple[Candidate, ...]:
    from bondgraph.passes.analysis.candidates import bond_graph_places, table_places

    if compilation is None:
        return table_places(model, costs)
    return bond_graph_places(compilation.equations, costs, elements)


class _Found:
    """All that there is to say about the places for sensors."""

    def __init__(
        self, model: StructuralModel, candidates: tuple[Candidate, ...], hint: bool
    ) -> None:
        from bondgraph.structural.placement import Placing, place

        self.model = model
        self.candidates = candidates
        self.hint = hint
        placing = Placing(model, candidates)
        self.now = placing.isolability()
        self.best = placing.isolability(range(len(candidates)))
        self.single = [placing.isolability([k]) for k in range(len(candidates))]
        self.ranked = sorted(range(len(candidates)), key=self._rank)
        self.placement: Placement = place(placing)
        #: candidates whose own failure could be told from all other faults in that placement
        self.watched = _watched(Placing(model, candidates, faulty=True), self.placement)

    def _rank(self, k: int) -> tuple[float, ...]:
        power = self.single[k]
        return (-len(power.groups), len(power.undetectable), self.candidates[k].cost, k)

    def message(self) -> str:
        """One line on what is, and what could be."""
        count = len(self.model.faults)
        return (
            f"at best {self._detected(self.now)} of {plural(count, 'fault')} can be detected,"
            f" in {plural(len(self.now.groups), 'group')}; with a sensor at every place"
            f" {self._detected(self.best)}, in {plural(len(self.best.groups), 'group')}"
        )

    def _detected(self, power: Isolability) -> int:
        return len(self.model.faults) - len(power.undetectable)

    def result(self) -> dict[str, object]:
        """The members of the JSON object."""
        model, placement = self.model, self.placement
        return {
            "model": model.name,
            "n_detectable": self._detected(self.now),
            "n_groups": len(self.now.groups),
            "candidates": [
                {
                    "sensor": self.candidates[k].name,
                    "cost": self.candidates[k].cost,
                    "n_detectable": self._detected(self.single[k]),
                    "n_groups": len(self.single[k].groups),
                    "detects": self._gained(k),
                }
                for k in self.ranked
            ],
            "placement": {
                "sensors": [self.candidates[k].name for k in placement.sensors],
                "cost": placement.cost,
                "least": placement.least,
                "self_isolable": list(self.watched),
            },
            "groups": [named(model, g) for g in self.best.groups],
            "undetectable": named(model, self.best.undetectable),
        }

    def _gained(self, k: int) -> list[str]:
        """The faults that only the added sensor lets detect."""
        left = set(self.single[k].undetectable)
        return named(self.model, tuple(f for f in self.now.undetectable if f not in left))

    def lines(self) -> list[str]:
        """The lines of the report."""
        model, columns = self.model, width()
        lines = [f"{model.name}: {self.message()}", *self._table()]
        placement = self.placement
        chosen = [self.candidates[k].name for k in placement.sensors]
        if chosen:
            how = "The cheapest" if placement.least else "A cheap choice"
            lines += ["", f"{how} that reaches as much as all (cost {placement.cost:g})"]
            lines += names(chosen, columns)
            blind = [name for name in chosen if name not in self.watched]
            if blind:
                lines += ["", "A failure of these would be taken for another fault"]
                lines += names(blind, columns)
        else:
            lines += ["", "No added sensor tells more faults apart"]
        together = [g for g in self.best.groups if len(g) > 1]
        if together:
            lines += ["", "No choice of these sensors tells apart"]
            for group in together:
                lines += names(named(model, group), columns)
        if self.best.undetectable:
            lines += ["", "No choice of these sensors detects"]
            lines += names(named(model, self.best.undetectable), columns)
        if self.hint and (together or self.best.undetectable):
            lines += ["", "`--elements` also tries sensors in and across the elements."]
        return lines

    def _table(self) -> list[str]:
        gaining = [k for k in self.ranked if self.single[k] != self.now]
        if not gaining:
            return []
        shown = gaining[:_SHOWN]
        longest = max(len(self.candidates[k].name) for k in shown)
        lines = ["", "One more sensor", f"  {'':{longest}}  cost  detected  groups"]
        for k in shown:
            candidate, power = self.candidates[k], self.single[k]
            detected, groups = self._detected(power), len(power.groups)
            lines.append(
                f"  {candidate.name:{longest}}  {candidate.cost:4g}  {detected:8}  {groups:6}"
            )
        rest = len(gaining) - len(shown)
        if rest:
            lines.append(f"  ... {plural(rest, 'place')} more: --json")
        return lines


def _watched(placing: Placing, placement: Placement) -> tuple[str, ...]:
    power = placing.isolability(placement.sensors)
    own = len(placing.model.faults)
    alone = {g[0] for g in power.groups if len(g) == 1}
    return tuple(placing.candidates[k].name for k in placement.sensors if own + k in alone)
