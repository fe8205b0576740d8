"""Pages of the gallery: each model of `models/` with its drawings, its ARRs and its signatures."""

from __future__ import annotations

from pathlib import Path

import bondgraph
from bondgraph.cli.summary import report

#: Letters of LaTeX up to which a relation fits on a page as a formula; the text has all of them.
_SHORT = 160


def lesson(model: Path) -> str:
    """The first comment of a model, which says what it teaches."""
    lines = []
    for line in model.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("# "))
    return " ".join(lines)


def page(model: Path) -> dict[str, str]:
    """The page of a model and its drawings, by their names."""
    name = model.stem
    c = bondgraph.compile(str(model))
    text = "\n".join(
        [
            f"# {name}.bg", "", lesson(model), "",
            "## Bond graph in preferred integral causality", "",
            f"![{name}, preferred integral causality](pictures/{name}_integral.svg)", "",
            "## Bond graph in preferred derivative causality, sensors dualised", "",
            f"![{name}, preferred derivative causality](pictures/{name}_derivative.svg)",
            "", "## ARRs and fault signatures", "", *_formulas(c),
            "```text", *report(c, []), "```", "",
            "## The model", "", "```bg", model.read_text(encoding="utf-8").rstrip(), "```", "",
        ]
    )  # fmt: skip
    return {
        f"{model.name}.md": text,
        f"pictures/{name}_integral.svg": c.drawing(False),
        f"pictures/{name}_derivative.svg": c.drawing(True),
    }


def index(models: list[Path]) -> str:
    """The front page of the gallery."""
    rows = [f"| [{m.stem}]({m.name}.md) | {lesson(m)} |" for m in models]
    entries = [f"{m.name}.md" for m in models]
    return "\n".join(
        [
            "# Gallery of models", "",
            "Each model of `models/`: bond graph, ARRs, fault signatures and text, made when this"
            " site was built.", "",
            "| Model | What it teaches |", "|---|---|", *rows, "",
            "```{toctree}", ":hidden:", "", *entries, "```", "",
        ]
    )  # fmt: skip


def _formulas(c: bondgraph.Compilation) -> list[str]:
    """The relations that fit on a page, as formulas."""
    lines = []
    for relation in c.residuals:
        if len(relation.latex) <= _SHORT:
            formula = f"{relation.name}\\colon\\quad 0 = {relation.latex}"
            lines += ["```math", formula, "```", ""]
    return lines
