"""After each pass its stage keeps its promises: over every model file and random bond graphs."""

from __future__ import annotations

import pytest

from bondgraph.compilation import Compilation, compile
from bondgraph.text.diagnostic import CompileError
from bondgraph.text.source import Source
from tests.conftest import ROOT
from tests.promises import broken_stages
from tests.random.run import of_seed

_MODELS = sorted((ROOT / "models").glob("*.bg"))
_FILES = [*_MODELS, *sorted((ROOT / "tests").rglob("*.bg"))]
_BATCH = 20


@pytest.mark.parametrize("first", range(0, len(_FILES), _BATCH))
def test_every_model_file(first: int) -> None:
    wrong = {}
    for file in _FILES[first : first + _BATCH]:
        try:
            found = broken_stages(compile(file))
        except CompileError:  # cannot be read at all
            continue
        assert "program" in found or file not in _MODELS, file
        wrong |= {(file.name, stage): lines for stage, lines in found.items() if lines}
    assert wrong == {}


def test_every_model_with_observers() -> None:
    wrong = {}
    for file in _MODELS:
        found = broken_stages(compile(file, form="observer"))
        wrong |= {(file.name, stage): lines for stage, lines in found.items() if lines}
    assert wrong == {}


@pytest.mark.parametrize("first", range(0, 60, _BATCH))
def test_random_graphs(first: int) -> None:
    wrong = {}
    ends = 0
    for seed in range(first, first + _BATCH):
        found = broken_stages(Compilation(Source("random.bg", of_seed(seed).text)))
        wrong |= {(seed, stage): lines for stage, lines in found.items() if lines}
        ends += "program" in found
    assert wrong == {}
    assert ends > _BATCH // 2  # the others are refused with a reason
