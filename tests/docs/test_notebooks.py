"""The notebooks of the documentation: executed as they stand, with the outputs that they show.

`pytest tests/docs/test_notebooks.py --update` writes them anew: derivations from their model, all
of them with the outputs of now.
"""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbclient import NotebookClient

import bondgraph

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = ROOT / "docs" / "notebooks"
#: The derivations among them, with model and residual.
DERIVATIONS = {
    "dc_motor_r1": ("models/dc_motor.bg", "r1"),
    "drive_r1": ("models/drive.bg", "r1"),
}
ALL = sorted([path.stem for path in NOTEBOOKS.glob("*.ipynb")] + [*DERIVATIONS])


def executed(text: str) -> Any:
    """The notebook with the outputs of its cells; raises if one of them fails."""
    book = nbformat.reads(text, as_version=4)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the tools that execute it
        client = NotebookClient(book, timeout=120, kernel_name="python3", record_timing=False)
        client.execute(cwd=str(ROOT))
    book.metadata = {"kernelspec": book.metadata["kernelspec"]}
    return book


def cells(book: Any) -> list[tuple[str, str, list[Any]]]:
    """What of a notebook counts: sources, and outputs without their numbers."""
    found = []
    for cell in book["cells"]:
        outputs = []
        for output in cell.get("outputs", ()):
            data = output.get("data", {}) or {"text/plain": output.get("text", "")}
            outputs.append({kind: "".join(text) for kind, text in data.items()})
        found.append((cell["cell_type"], "".join(cell["source"]), outputs))
    return found


def source(name: str) -> str:
    """A notebook as it is to be executed."""
    if name in DERIVATIONS:
        model, residual = DERIVATIONS[name]
        return bondgraph.compile(ROOT / model).derivation(residual).notebook
    return (NOTEBOOKS / f"{name}.ipynb").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", sorted(set(ALL)))
def test_notebooks_show_what_they_do(name: str, update: bool) -> None:
    path = NOTEBOOKS / f"{name}.ipynb"
    book = executed(source(name))
    if update:
        path.write_text(nbformat.writes(book) + "\n", encoding="utf-8")
    kept = json.loads(path.read_text(encoding="utf-8"))
    assert cells(book) == cells(kept)


@pytest.mark.parametrize("name", DERIVATIONS)
def test_derivations_end_with_the_residual(name: str) -> None:
    kept = json.loads((NOTEBOOKS / f"{name}.ipynb").read_text(encoding="utf-8"))
    code = [cell for cell in kept["cells"] if cell["cell_type"] == "code"]
    said = "".join(code[-1]["outputs"][0]["text"])
    assert said == f"the derived relation is {DERIVATIONS[name][1]} times 1\n"
    assert all(cell["execution_count"] for cell in code)
