"""Balances that say what others say, against ranks of matrices, and what they leave open."""

from __future__ import annotations

import numpy as np
import pytest

from bondgraph.algebra.nominal import Nominal
from bondgraph.algebra.numeric import evaluate
from bondgraph.compilation import Compilation
from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import Expr, Kind
from bondgraph.passes.elimination.rings import rings
from bondgraph.text.source import Source

_OTHER = (
    "Se:w -> 1:t -> 0:e\nt -> R:o = 1\ne -> 1:f -> 0:g\ne -> 1:h -> g\ng -> R:k = 1\ng -> De:j"
)
_OUTSIDE = "Se:u -> 1:s -> 0:a\ns -> R:r = 1\nb -> R:q = 2\nb -> De:v"


def _system(text: str) -> EquationSystem:
    return Compilation(Source("m.bg", f"bg 1\nmodel M {{\n{_OUTSIDE}\n{text}\n}}\n")).equations


def _found(system: EquationSystem) -> dict[int, Expr]:
    nominal = Nominal(system.graph)
    return rings(system, [(e, e.zero) for e in system.equations], nominal.value)


def _structure(system: EquationSystem) -> list[tuple[int, Equation]]:
    """The balances and the laws of two-ports, which conserve power."""
    nodes = system.graph.nodes
    return [
        (k, e) for k, e in enumerate(system.equations)
        if e.node >= 0 and (e.kind == "balance" or nodes[e.node].kind in ("TF", "GY"))
    ]  # fmt: skip


def _matrix(system: EquationSystem) -> np.ndarray:
    """Coefficients of its linear equations by differences of their values."""
    nominal = Nominal(system.graph)
    numbers = {v.name: nominal.value(v.symbol) for v in system.graph.values}
    names = [v.symbol.name for v in system.unknowns]

    def value(e: Equation, one: int) -> float:
        at = {name: float(k == one) for k, name in enumerate(names)}
        found = evaluate(e.zero, {**numbers, **at})  # type: ignore[dict-item]
        assert found is not None
        return float(found)

    return np.array([
        [value(e, k) - value(e, -1) for k in range(len(names))] for _, e in _structure(system)
    ])


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ("0:b <- a", 0),
        ("a -> 1:x -> 0:b\na -> 1:y -> b", 1),
        (f"a -> 1:x -> 0:b\na -> 1:y -> b\n{_OTHER}", 2),
        # an element in one of two ways: what flows there is told by its effort
        ("a -> 1:x -> 0:b\na -> 1:y -> b\ny -> R:p = 3", 0),
        # transformers that agree, or do not; that do by their numbers only
        ("a -> TF:x { e1 = 2*e2 } -> 0:b\na -> TF:y { e1 = 2*e2 } -> b", 1),
        ("a -> TF:x { e1 = 2*e2 } -> 0:b\na -> TF:y { e1 = 3*e2 } -> b", 0),
        ("param n = 4; param k = 2\na -> TF:x { e1 = n*e2 } -> 0:b\n"
         "a -> TF:y { e1 = k*e2 } -> 0:c -> 1:d -> TF:z { e1 = k*e2 } -> b", 1),
        ("param n = 4; param k = 2.0001\na -> TF:x { e1 = n*e2 } -> 0:b\n"
         "a -> TF:y { e1 = k*e2 } -> 0:c -> 1:d -> TF:z { e1 = k*e2 } -> b", 0),
        # gyrators turn efforts into flows, and two of them back
        ("a -> GY:x = 2 -> 1:m -> GY:y = 2 -> 0:b\na -> 1:z -> b", 1),
        ("a -> GY:x = 2 -> 1:m -> GY:y = 3 -> 0:b\na -> 1:z -> b", 0),
    ],
)  # fmt: skip
def test_as_many_say_nothing_as_the_rank_is_too_small(text: str, count: int) -> None:
    system = _system(text)
    matrix, found = _matrix(system), _found(system)
    assert len(matrix) - np.linalg.matrix_rank(matrix, tol=1e-7) == count == len(found)
    own = [k for k, _ in _structure(system)]
    assert set(found) <= set(own)
    # without those that are found the others say as much, and nothing twice
    rest = matrix[[at for at, k in enumerate(own) if k not in found]]
    assert np.linalg.matrix_rank(rest, tol=1e-7) == len(rest)
    # what is open is that of the other kind: told, it leaves no freedom
    assert len(set(found.values())) == count
    assert all(v.symbol.kind in (Kind.EFFORT, Kind.FLOW) for v in found.values())


@pytest.mark.parametrize(
    "text",
    ["a -> 1:x -> 0:b\na -> 1:y -> b", f"a -> 1:x -> 0:b\na -> 1:y -> b\n{_OTHER}",
     "a -> TF:x { e1 = 2*e2 } -> 0:b\na -> TF:y { e1 = 2*e2 } -> b"],
)  # fmt: skip
def test_what_is_open_may_be_told_to_be_zero(text: str) -> None:
    """All linear equations of the model: one freedom for each, gone with the variables told."""
    system = _system(text)
    nominal = Nominal(system.graph)
    numbers = {v.name: nominal.value(v.symbol) for v in system.graph.values}
    names = [v.symbol.name for v in system.unknowns]
    signals = {n.symbol.name: 0.0 for n in (*[i.symbol for i in system.graph.inputs],
                                            *[s.symbol for s in system.graph.sensors])}  # fmt: skip

    def row(e: Equation) -> list[float]:
        values = [
            evaluate(e.zero, {**numbers, **signals, **{n: float(n == one) for n in names}})  # type: ignore[dict-item]
            for one in names
        ]
        return [float(v) for v in values if v is not None]

    whole = np.array([row(e) for e in system.equations])
    found = _found(system)
    told = np.array([[float(n == v.symbol.name) for n in names] for v in found.values()])
    assert len(names) - np.linalg.matrix_rank(whole) == len(found) > 0
    assert np.linalg.matrix_rank(np.vstack([whole, told])) == len(names)
