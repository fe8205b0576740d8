"""MSO sets of the published structures against the Fault Diagnosis Toolbox (C++ inside), in turn.

`BONDGRAPH_BENCH_PYTHON` names the interpreter that has the toolbox; `make bench` installs it in an
environment of its own, because it brings packages that nothing else here needs.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

STRUCTURES = Path(__file__).parents[2] / "models" / "structure"
NAMES = ("electric_motor", "three_tank", "induction_motor", "water_tank", "vep4_engine")

_CODES = {"": 1, "I": 2, "D": 3}

#: Run by the toolbox's own interpreter: matrices in, the number of sets and seconds out.
_THEIRS = """
import json, sys, time
import numpy as np
import faultdiagnosistoolbox as fdt
given = json.load(sys.stdin)
X = np.array(given["X"])
none = np.zeros((len(X), 0), dtype=int)
model = fdt.DiagnosisModel({"type": "MatrixStruc", "X": X, "F": none, "Z": none}, name="bench")
model.MSO()
seconds = []
for _ in range(given["runs"]):
    start = time.perf_counter()
    found = model.MSO()
    seconds.append(time.perf_counter() - start)
print(json.dumps({"sets": sorted(sorted(map(int, m)) for m in found), "seconds": seconds}))
"""


def interpreter() -> str | None:
    """The interpreter that has the toolbox, None where there is none."""
    python = os.environ.get("BONDGRAPH_BENCH_PYTHON", sys.executable)
    command = [python, "-c", "import faultdiagnosistoolbox"]
    try:
        done = subprocess.run(command, capture_output=True, check=False)
    except OSError:
        return None
    return python if done.returncode == 0 else None


def _seconds(work: Callable[[], object], runs: int) -> list[float]:
    seconds = []
    for _ in range(runs):
        start = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - start)
    return seconds


def compare(name: str, python: str, runs: int) -> tuple[int, float, float]:
    """The number of sets, and the median seconds of this package and of the toolbox.

    Both give a list of arrays of equations, and these must be the same.
    """
    from bondgraph.cli.structural import open_table
    from bondgraph.structural.mso import mso_sets

    model, _ = open_table(str(STRUCTURES / f"{name}.csv"))
    matrix = [[0] * len(model.unknowns) for _ in model.equations]
    for row, equation in zip(matrix, model.equations, strict=True):
        for v, mark in zip(equation.unknowns, equation.marks, strict=True):
            row[v] = _CODES[mark]
    own: list[float] = []
    theirs: list[float] = []
    found = mso_sets(model).all()
    for _ in range(3):
        own += _seconds(lambda: mso_sets(model).arrays(), runs)
        text = json.dumps({"X": matrix, "runs": runs})
        command = [python, "-c", _THEIRS]
        done = subprocess.run(command, input=text, capture_output=True, text=True, check=True)
        answer = json.loads(done.stdout.splitlines()[-1])
        assert answer["sets"] == sorted(map(list, found)), name
        theirs += answer["seconds"]
    return len(found), statistics.median(own), statistics.median(theirs)


def report(runs: int) -> None:
    """One line for each published structure, or that the toolbox is not there."""
    python = interpreter()
    if python is None:
        print("MSO sets: not compared, faultdiagnosistoolbox is not installed (make bench does)")
        return
    print("MSO sets of published structures, here and by the Fault Diagnosis Toolbox:")
    for name in NAMES:
        count, own, theirs = compare(name, python, runs)
        print(
            f"{name:28} {count:5} sets {own * 1e3:8.2f} ms  toolbox {theirs * 1e3:8.2f} ms"
            f"  {own / theirs:6.2f}x"
        )
