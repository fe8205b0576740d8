"""Generated C that watches machines which scipy simulates, healthy and with each fault in turn."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.elements.answers import answer
from tests.elements.running import code_of
from tests.elements.simulated import MACHINES, Machine, Row, watched

SEEN, UNSEEN = 5, 2  # times the healthy level


class Watch:
    """The code of a model, compiled once; it starts anew for each set of samples."""

    def __init__(self, name: str, machine: Machine, folder: Path) -> None:
        self.machine = machine
        self.code, spelling = code_of(name, folder)
        self.members = {spelling.knowns[k.name]: k.path for k in self.code.program.knowns}

    def __call__(self, fault: str = "") -> Row:
        """The residuals that are valid, a row for each sample."""
        m = self.machine
        told = watched(m, fault)
        assert self.code.configure(m.sample_time, m.bandwidth, 1.0) == 0
        rows = []
        for k in range(len(told[next(iter(told))])):
            now = {member: told[path][k] for member, path in self.members.items()}
            values, valid = self.code.step(**now)
            if all(valid):
                rows.append(values)
        assert len(rows) > len(told[next(iter(told))]) / 3
        return np.array(rows)


def level(rows: Row) -> Row:
    """Root of the mean square of each residual."""
    found: Row = np.sqrt(np.mean(rows**2, axis=0))
    return found


@pytest.mark.parametrize("name", MACHINES)
def test_the_code_sees_what_the_signature_says(name: str, tmp_path: Path) -> None:
    machine = MACHINES[name]
    said = answer(name)
    watch = Watch(name, machine, tmp_path)
    healthy = watch()
    quiet = level(healthy)
    faults = [*said["undetectable"], *[f for g in said["groups"] for f in g]]
    assert set(faults) == {*machine.params, *machine.inputs, *machine.read} - {"on"}
    for fault in faults:
        added = level(watch(fault) - healthy)
        for k, arr in enumerate(said["arrs"]):
            if fault in arr["signature"]:
                assert added[k] > SEEN * quiet[k], f"{arr['name']} does not see {fault}"
            else:
                assert added[k] < UNSEEN * quiet[k], f"{arr['name']} sees {fault}"
