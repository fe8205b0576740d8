"""Generated C on samples of an exact power series: how far each residual moves, and by what.

The plant is `tests.adversary.plant.Simulator`: physics by hand, Taylor series of 40 digits.
Nothing of the elimination is used. The error of the samples is of fourth order: what is left of a
healthy plant is rounding, the start of an integral, or a bias of the filter. That is what a product
of a signal and a derivative adds which is no sum of total derivatives, whatever the sample time:
measured for the boost converter, it falls with the square of the bandwidth. The fourth derivative
of a signal near 1 has rounding errors of 1e-16 times the bandwidth to the fourth, and a third one
of 1e-7 at this bandwidth and sample time.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyval

from bondgraph.backends.identifiers import snake
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import load
from tests.adversary.plant import Plant, Simulator, plain
from tests.elements.answers import answer, compilation
from tests.elements.rows import Row
from tests.unit.backends.compilers import InC

FAULT = 1e-3  # of a quantity near 1


class Moves(NamedTuple):
    """The filtered residuals at the end: when healthy, and what each fault adds to them."""

    healthy: list[float]
    faults: dict[str, list[float]]
    signatures: list[list[str]]


def code_of(model: str, folder: Path) -> tuple[InC, Spelling]:
    """The generated code as a library, and what its structures call the signals."""
    found = compilation(model)
    found.write(folder, extras=["exact"])
    program = found.program
    return InC(program, folder, snake(program.name)), Spelling(program, load("c"))


def run(plant: Plant, folder: Path, row: Row) -> Moves:
    """Configure the code with the plant's parameters, and feed it the plant's signals."""
    found = answer(plant.name)
    code, spelling = code_of(plant.name, folder)
    program = code.program

    def own(name: str) -> str:
        return plant.alias.get(name, plain(name))

    orders = [o for a in found["arrs"] for o in a["orders"].values()]
    modes = dict.fromkeys(plant.modes.split(), True)
    sim = Simulator(plant, max(orders, default=0) + 16, modes=modes)
    healthy = sim.solve()
    params = {
        spelling.params[f.name]: float(sim.nominal[own(found["names"].get(f.name, f.name))][0])
        for f in program.params
    }
    members = {spelling.knowns[k.name]: own(k.path) for k in program.knowns}

    t = np.arange(round(row.seconds / row.sample_time)) * row.sample_time

    def ended(y: dict[str, Any], base: list[float]) -> list[float]:
        jets = {x: sim.signals[x] for x in sim.inputs} | y
        told = {
            m: [modes[x]] * len(t) if x in modes else polyval(t, np.array(jets[x], float)).tolist()
            for m, x in members.items()
        }
        assert code.configure(row.sample_time, row.bandwidth, 1.0, **params) == 0
        for now in zip(*told.values(), strict=True):
            values, valid = code.step(**dict(zip(told, now, strict=True)))
        assert all(valid), f"{plant.name}: a residual is not valid at the end"
        return [b - a for a, b in zip(base, values, strict=True)]

    level = ended(healthy, [0.0] * len(found["arrs"]))
    faults = {}
    said = [*found["undetectable"], *[f for g in found["groups"] for f in g]]
    for fault in said:
        y = sim.perturbed(own(fault), FAULT)
        assert y is not None, f"{plant.name}: the plant cannot have the fault {fault}"
        faults[fault] = ended(y, level)
    return Moves(level, faults, [a["signature"] for a in found["arrs"]])
