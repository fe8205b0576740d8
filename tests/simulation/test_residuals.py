"""The generated residuals on samples of the virtual machine: silent, and moved as the matrix says.

Elimination and state equations are two ways from the same equations; here they meet. Healthy
residuals are not zero: the filter joins samples by straight lines. With signals near 1 that change
over 0.3 s, sampled at 500 Hz, no residual of these models passes 6e-3, and a fault of a fifth moves
those that see it by more than five times their healthy level.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import bondgraph
from bondgraph.ir.expr import Kind
from bondgraph.runtime.monitoring.engine import Engine
from tests.simulation.machines import Array, read

QUIET, SEEN = 6e-3, 5
MODELS = Path(__file__).parents[1] / "adversary" / "models"

#: Each has something else: fields, dependent storages, loops, tables, unknown inputs, rings, ...
NAMES = [
    "accumulator", "arrays", "cubic_parallel", "dc_unknown_load", "magnetic_core", "mic",
    "node_of_diodes", "planetary", "relativistic", "rl_parallel_current", "table_law",
    "tf_ring_1", "two_tanh", "three_thermometers",
]  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_residuals_of_a_simulated_machine(name: str) -> None:
    compilation = bondgraph.compile(MODELS / f"{name}.bg", rate=500.0)
    graph = compilation.graph
    draw = np.random.default_rng(5)
    params = [v for v in graph.values if v.symbol.symbol.kind is Kind.PARAM and v.value is None]
    numbers = {v.name: float(draw.uniform(0.7, 1.4)) for v in params}
    lines = ["duration = 2.4", "sampling.rate = 500"]
    lines += [f'parameters."{n}" = {x!r}' for n, x in numbers.items()]
    for k, item in enumerate(graph.inputs):
        wave = f"1*({1 + 0.3 * k} + {0.4 + 0.1 * k}*sin({3 + k}*t) + 0.2*cos({1.3 + k / 3}*t))"
        lines.append(f'inputs."{item.name}" = "{wave}"')
    engine: Engine = compilation.engine(native=False)
    engine = engine.configured({n: x for n, x in numbers.items() if n in engine.parameters})

    def residuals(fault: str) -> Array:
        engine.reset()
        log = compilation.simulate(read(compilation, "\n".join([*lines, fault]))).log
        batch = engine.run(np.column_stack([log.columns[k.path] for k in engine.signals]))
        assert batch.valid[800:].all()
        return np.where(batch.valid, batch.value, 0)

    healthy = residuals("")
    quiet = np.abs(healthy).max(axis=0)
    assert (quiet < QUIET).all()
    nothing = {v.name for v in graph.values if v.value is graph.pool.zero}
    for fault in [f for f in graph.faults if f not in nothing][:5]:
        moved = np.abs(
            residuals(f'[[fault]]\nof = "{fault}"\nchange = "*= 1.2"\nat = 1\nramp = 0.5') - healthy
        ).max(axis=0)
        sees = np.array(compilation.signatures.row(fault), dtype=bool)
        assert (moved[sees] > SEEN * quiet[sees]).all(), fault
        assert (moved[~sees] < QUIET).all(), fault
