"""State equations of a ladder by other Python tools, against residuals and signatures of ours.

`BONDGRAPH_BENCH_PEERS` names the environments that have them; `make bench` builds these. A run
that takes longer than the limit is stopped and told so.
"""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from tests.bench import growth

#: Run by the interpreter of the other tool: the number of cells in, seconds out.
_BONDGRAPHTOOLS = """
import sys, time
import BondGraphTools as bgt
start = time.perf_counter()
model = bgt.new(name="Ladder")
last = bgt.new("Se", value=1.0)
bgt.add(model, last)
for _ in range(int(sys.argv[1])):
    series, across = bgt.new("1"), bgt.new("0")
    R, L, C = bgt.new("R", value=2.0), bgt.new("I", value=1e-3), bgt.new("C", value=1e-6)
    bgt.add(model, series, across, R, L, C)
    for tail, head in ((last, series), (series, R), (series, L), (series, across), (across, C)):
        bgt.connect(tail, head)
    last = across
assert len(model.constitutive_relations) == 2 * int(sys.argv[1])
print(time.perf_counter() - start)
"""

_PYBONDGRAPH = """
import sys, time
import pyBondGraph as pbg
start = time.perf_counter()
graph = pbg.BondGraph()
last = pbg.SourceEffort("U", "u")
for i in range(int(sys.argv[1])):
    series, across = pbg.OneJunction(f"s{i}"), pbg.ZeroJunction(f"n{i}")
    R, L = pbg.Resistor(f"R{i}", f"R{i}"), pbg.Inductor(f"L{i}", f"L{i}")
    C = pbg.Capacitor(f"C{i}", f"C{i}")
    for tail, head in ((last, series), (series, R), (series, L), (series, across), (across, C)):
        graph.connect(tail, head)
    last = across
assert graph.get_state_space()[5] == 2 * int(sys.argv[1])
print(time.perf_counter() - start)
"""


class Peer(NamedTuple):
    """Another tool: its name, its module, its program."""

    name: str
    module: str
    program: str


PEERS = (
    Peer("BondGraphTools", "BondGraphTools", _BONDGRAPHTOOLS),
    Peer("pyBondGraph", "pyBondGraph", _PYBONDGRAPH),
)


def interpreter(peer: Peer) -> str | None:
    """The interpreter that has a tool, None where none has."""
    for folder in os.environ.get("BONDGRAPH_BENCH_PEERS", "").split(os.pathsep):
        python = Path(folder).absolute() / "bin" / "python"
        if folder and python.exists():
            done = subprocess.run(
                [python, "-c", f"import {peer.module}"], capture_output=True, check=False
            )
            if done.returncode == 0:
                return str(python)
    return None


def seconds(python: str, peer: Peer, cells: int, limit: float) -> float | None:
    """What the tool takes for a ladder, its imports excluded; None if it passes the limit."""
    command = [python, "-W", "ignore", "-c", peer.program, str(cells)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return None
    return float(done.stdout.splitlines()[-1])


def ladder(cells: int) -> str:
    """The same ladder for us, with the last voltage measured."""
    lines = ["bg 1", "model Ladder {", "    Se:u -> 0:n0"]
    for i in range(1, cells + 1):
        lines.append(f"    n{i - 1} -> 1:s{i} -> 0:n{i} -> C:C{i} = 1 uF")
        lines.append(f"    s{i} {{ -> R:R{i} = 2 Ohm; -> I:L{i} = 1 mH }}")
    return "\n".join([*lines, f"    n{cells} -> De:y", "}"]) + "\n"


def report(sizes: Sequence[int], limit: float) -> None:
    """A table: seconds of each tool for each number of cells, until it passes the limit in s."""
    found = {peer: interpreter(peer) for peer in PEERS}
    for peer, python in found.items():
        if python is None:
            print(f"{peer.name}: not compared, it is not installed (make bench tries)")
    there = {peer: python for peer, python in found.items() if python is not None}
    if not there:
        return
    growth.stages(ladder(2))  # imports excluded, as for the others
    print(f"Ladder of RLC cells: state equations by others, ARRs and FSM here; limit {limit:.0f} s")
    print(f"{'cells':>8} {'here':>12} " + " ".join(f"{p.name:>24}" for p in there))
    for cells in sizes:
        start = time.perf_counter()
        growth.stages(ladder(cells))
        own = time.perf_counter() - start
        line = f"{cells:8} {own:10.3f} s "
        for peer, python in list(there.items()):
            took = seconds(python, peer, cells, limit) if python else None
            if took is None:
                there[peer] = ""
                line += f" {'-':>24}"
            else:
                line += f" {took:12.3f} s {took / own:8.1f}x"
        print(line, flush=True)
