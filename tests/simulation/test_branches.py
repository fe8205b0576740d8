"""Laws with a side that has no value: the machine takes the other one. Rates are found by hand."""

from __future__ import annotations

import math

import pytest

from bondgraph.compilation import Compilation
from bondgraph.runtime.simulation.machine import Machine
from bondgraph.runtime.simulation.parameters import Values
from bondgraph.text.source import Source


@pytest.mark.parametrize("v", [-4.0, 9.0])
@pytest.mark.parametrize("k", [-16.0, 16.0])
def test_the_rates_are_those_of_the_side_that_is_taken(v: float, k: float) -> None:
    """A mass of 2 kg at v, its momentum 2 v: D(p) = F - e(v)."""
    text = """bg 1
    model M {
        input F
        param k = 16
        1:m { <- Se:F; -> I:mass = 2; -> R:drag { LAW }; -> R:seal { e = if(k > 0, f*sqrt(k), f) } }
        m -> Df:w
    }""".replace("LAW", "e = if(f > 0, sqrt(f) + 1/(1 + sqrt(f)), -1)")
    compilation = Compilation(Source("m.bg", text))
    machine = Machine(compilation.state_equations(), Values(compilation.graph, {"k": k}))
    drag = math.sqrt(v) + 1 / (1 + math.sqrt(v)) if v > 0 else -1.0
    seal = 4 * v if k > 0 else v
    assert machine.rates(0.0, [2 * v], [5.0]) == pytest.approx([5.0 - drag - seal])
