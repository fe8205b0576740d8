"""Which residuals a model has and what they see: computed in a process of its own.

`python -m bondgraph.editor.residual_facts` reads one JSON object {path, text, texts} from its
input and prints {models: {name: {residuals, faults, groups, unseen} or {problem}}}. The language
server starts it when nobody types, at low priority, and ends it when the text changes.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Mapping
from typing import Any

from bondgraph.text.numerals import plural
from bondgraph.text.tuples import NamedTuple


class ModelResiduals(NamedTuple):
    """The residuals of one model as text, the faults that each sees, and the groups of faults.

    `problem` says why there are none.
    """

    residuals: Mapping[str, str]
    sees: Mapping[str, tuple[str, ...]]
    groups: tuple[tuple[str, ...], ...]
    unseen: tuple[str, ...]
    problem: str = ""


class ResidualFacts:
    """What the residuals of a text are, by model."""

    def __init__(self, models: Mapping[str, ModelResiduals]) -> None:
        self.models = models

    @staticmethod
    def from_json(text: str | bytes) -> ResidualFacts:
        """Read what the process printed."""
        found: dict[str, ModelResiduals] = {}
        for name, item in json.loads(text)["models"].items():
            found[name] = ModelResiduals(
                item["residuals"],
                {r: tuple(faults) for r, faults in item["sees"].items()},
                tuple(tuple(g) for g in item["groups"]),
                tuple(item["unseen"]),
                item["problem"],
            )
        return ResidualFacts(found)

    def summary(self, model: str) -> str:
        """How many residuals a model has and what they tell apart; "" where that is not known."""
        found = self.models.get(model)
        if found is None:
            return ""
        if found.problem:
            return f"no residuals: {found.problem}"
        seen = sum(map(len, found.groups))
        text = plural(len(found.residuals), "residual")
        if not found.residuals:
            return "no residual: the sensors make no equation redundant"
        return (
            f"{text} detect {seen} of {plural(seen + len(found.unseen), 'fault')}, "
            f"in {plural(len(found.groups), 'group')}"
        )

    def seen_by(self, fault: str) -> tuple[str, ...] | None:
        """The residuals that see a fault; None where it is none."""
        for found in self.models.values():
            if fault in found.unseen or any(fault in group for group in found.groups):
                return tuple(r for r, faults in found.sees.items() if fault in faults)
        return None

    def about(self, fault: str) -> str:
        """Which residuals see a fault and what it is not told apart from; "" where it is none."""
        seen = self.seen_by(fault)
        if seen is None:
            return ""
        if not seen:
            return f"no residual sees a fault of `{fault}`"
        text = f"a fault of `{fault}` moves {', '.join(seen)}"
        for found in self.models.values():
            for group in found.groups:
                if fault in group and len(group) > 1:
                    others = [f"`{f}`" for f in group if f != fault]
                    more = f" and {len(others) - 6} more" if len(others) > 6 else ""
                    text += f"; not told apart from {', '.join(others[:6])}{more}"
        return text


def residual_facts(path: str, text: str, texts: Mapping[str, str]) -> dict[str, Any]:
    """The facts of each model of a text that can be compiled, as plain data."""
    from bondgraph.editor.soundness import Edited, check_text
    from bondgraph.text.diagnostic import CompileError

    models: dict[str, Any] = {}
    _, found = check_text(path, text, texts)
    for part in found.sound:
        name = part.graph.name
        whole = Edited(part.source, part.model, part.options._replace(open_ports=False), texts)
        entry: dict[str, Any] = {
            "residuals": {}, "sees": {}, "groups": [], "unseen": [], "problem": "",
        }  # fmt: skip
        try:
            matrix = whole.signatures
            for relation in whole.residuals:
                entry["residuals"][relation.name] = relation.text
            entry["sees"] = {r: list(matrix.sees[r]) for r in matrix.residuals}
            entry["groups"] = [list(group) for group in matrix.groups]
            entry["unseen"] = list(matrix.undetectable)
        except CompileError as error:
            entry["problem"] = str(error)
        models[name] = entry
    return {"models": models}


def main() -> None:
    """Answer the one question on the input."""
    os.nice(10)
    asked = json.load(sys.stdin)
    json.dump(residual_facts(asked["path"], asked["text"], asked["texts"]), sys.stdout)


if __name__ == "__main__":
    main()
