"""The examples in the docstrings run and give what they say."""

from __future__ import annotations

import doctest
import importlib
import inspect
import pkgutil
from functools import cached_property
from pathlib import Path

import pytest

import bondgraph

NAMES = [
    "bondgraph",
    *(
        m.name
        for m in pkgutil.walk_packages(bondgraph.__path__, "bondgraph.")
        if m.name != "bondgraph.__main__"
    ),
]


@pytest.mark.parametrize("name", NAMES)
def test_examples(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(Path(__file__).parents[2])
    module = importlib.import_module(name)
    finder, runner = doctest.DocTestFinder(), doctest.DocTestRunner()
    found = finder.find(module)
    for _, kind in inspect.getmembers(module, inspect.isclass):
        if kind.__module__ == name:  # the finder passes over cached properties
            own = [v.func for v in vars(kind).values() if isinstance(v, cached_property)]
            found += [test for func in own for test in finder.find(func, func.__qualname__, module)]
    for test in found:
        runner.run(test)
    assert runner.failures == 0
