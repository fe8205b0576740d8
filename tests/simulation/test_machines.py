"""Machines written as differential equations for `tests.elements`, against the virtual machine."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import pytest

import bondgraph
from tests.adversary.plant import HERE
from tests.elements.simulated import MACHINES, watched
from tests.simulation.machines import MODELS, near, read

#: What the storages hold at the start, from the states of the equations, and the commands.
STARTS: Mapping[str, Mapping[str, str]] = {
    "dc_encoder": {"L.p": "40*L", "J.p": "110*J"},
    "pendulum": {},
    "two_tanks": {"C1.q": "5000 Pa*A1/(rho*g)", "C2.q": "2500 Pa*A2/(rho*g)"},
    "stirred_reactor": {"V.q": "0.7*V", "H.q": "1.3*H"},
    "oven": {"Ch.q": "300 K*Ch", "Co.q": "295 K*Co"},
}
COMMANDS: Mapping[str, Mapping[str, str]] = {
    "dc_encoder": {"U": '"240 + 80*sin(5*t)"', "T": '"30 + 5*cos(2*t)"'},
    "pendulum": {"T": '"30 + 10*sin(3*t)"'},
    "two_tanks": {"Q": '"6e-5*(1 + 0.5*sin(0.1*t))"'},
    "stirred_reactor": {
        "q": '"1 + 0.3*sin(2*t)"', "cin": '"1.5 + 0.2*cos(3*t)"', "Tin": "1.1", "Tj": "0.8",
    },
    "oven": {"P": "900", "Ta": "293", "on": '"t < 60 or (t >= 130 and t < 210)"'},
}  # fmt: skip


@pytest.mark.parametrize("fault", [0, 1, 2], ids=["healthy", "first parameter", "last parameter"])
@pytest.mark.parametrize("name", MACHINES)
def test_the_virtual_machine_moves_as_its_equations(name: str, fault: int) -> None:
    machine = MACHINES[name]
    wrong = ["", next(iter(machine.params)), list(machine.params)[-1]][fault]
    told = watched(machine, wrong)
    path = MODELS / f"{name}.bg"
    compilation = bondgraph.compile(path if path.exists() else HERE / "models" / f"{name}.bg")
    lines = [f"duration = {machine.seconds!r}", f"sampling.rate = {1 / machine.sample_time!r}"]
    lines += [f'inputs."{n}" = {text}' for n, text in COMMANDS[name].items()]
    lines += [f'initial."{n}" = "{text}"' for n, text in STARTS[name].items()]
    for parameter, value in machine.params.items():
        changed = value if parameter != wrong else value * 1.2 if value else machine.shift
        lines.append(f'parameters."{parameter}" = {changed!r}')
    run = compilation.simulate(read(compilation, "\n".join(lines)))
    for sensor in machine.read:
        seen, wanted = run.truth.columns[sensor][:-1], np.array(told[sensor], dtype=float)
        if sensor in machine.counts:
            angle = seen * machine.counts[sensor]
            assert np.abs(angle - wanted - 0.5).max() < 0.5 + 1e-3 * math.sqrt(len(wanted))
        else:
            assert near(seen, wanted), sensor
