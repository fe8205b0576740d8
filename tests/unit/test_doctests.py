"""The examples in the docstrings run and give what they say."""

from __future__ import annotations

import doctest
import importlib
import pkgutil
from pathlib import Path

import pytest

import bondgraph

NAMES = [
    m.name
    for m in pkgutil.walk_packages(bondgraph.__path__, "bondgraph.")
    if m.name != "bondgraph.__main__"
]


@pytest.mark.parametrize("name", NAMES)
def test_examples(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(Path(__file__).parents[2])
    assert doctest.testmod(importlib.import_module(name)).failed == 0
