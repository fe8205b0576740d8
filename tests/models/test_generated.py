"""generated/ is what the models become, byte for byte; `make update` writes it anew."""

from __future__ import annotations

from pathlib import Path

import pytest

import bondgraph
from bondgraph.backends.write import COSTS, MANIFEST

ROOT = Path(__file__).resolve().parents[2]
MODELS = sorted(path.stem for path in (ROOT / "models").glob("*.bg"))


@pytest.mark.parametrize("model", MODELS)
def test_generated_files_are_what_the_model_becomes(
    model: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    folder = ROOT / "generated" / model
    made = {a.path: a.text for a in bondgraph.compile(f"models/{model}.bg").artifacts}
    kept = {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()} - {MANIFEST}
    assert sorted(kept) == sorted(made), "run `make update` and read the difference"
    for path, text in made.items():
        found = COSTS.sub("", (folder / path).read_bytes().decode())  # these are measured
        assert found == text, f"generated/{model}/{path}: run `make update` and read the difference"


def test_nothing_is_left_in_generated() -> None:
    assert sorted(p.name for p in (ROOT / "generated").iterdir() if p.is_dir()) == MODELS
