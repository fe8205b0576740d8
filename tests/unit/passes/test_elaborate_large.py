"""Elaboration of models that are long rather than intricate."""

from __future__ import annotations

from tests.unit.passes.elaborating import body, graph
from tests.unit.passes.test_elaborate import CELL


def test_a_thousand_cells() -> None:
    text = CELL + "model T { Se:U -> Line:line(n = 1000) -> 0:out; out -> De:y; out -> R:r = 1 }"
    assert len(graph(text).nodes) == 4004


def test_a_long_chain_of_lets() -> None:
    lets = "\n".join(f"let a{i} = a{i + 1} + j.f" for i in range(3000))
    g = body(f"Se:U -> 1:j; j -> R:r = 1\n{lets}\nlet a3000 = 1")
    assert len(g.lets) == 3001


def test_a_long_sum() -> None:
    g = body(f"Se:U -> 1:j; j -> R:r = 1\nlet s = {' + '.join(['j.f'] * 150)}")
    assert repr(g.lets[0].value) == "150*j.f"
