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

#: Run by the toolbox's own interpreter: a matrix a line in, its sets and seconds out. One process
#: answers for all structures, as the toolbox takes seconds to import.
_THEIRS = """
import json, sys, time
import numpy as np
import faultdiagnosistoolbox as fdt
for line in sys.stdin:
    given = json.loads(line)
    X = np.array(given["X"])
    none = np.zeros((len(X), 0), dtype=int)
    model = fdt.DiagnosisModel({"type": "MatrixStruc", "X": X, "F": none, "Z": none}, name="bench")
    model.MSO()
    seconds = []
    for _ in range(given["runs"]):
        start = time.perf_counter()
        found = model.MSO()
        seconds.append(time.perf_counter() - start)
    sets = sorted(sorted(map(int, m)) for m in found)
    print("\\n" + json.dumps({"sets": sets, "seconds": seconds}), flush=True)
"""


class Toolbox:
    """The toolbox in a process of its own, which answers while this one waits."""

    def __init__(self, python: str) -> None:
        self._process = subprocess.Popen(
            [python, "-c", _THEIRS], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def sets(self, matrix: list[list[int]], runs: int) -> tuple[list[list[int]], list[float]]:
        """The sets of a structure, each an ordered list of equations, and the seconds of each run.

        What the toolbox itself prints is passed over.
        """
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps({"X": matrix, "runs": runs}) + "\n")
        self._process.stdin.flush()
        for line in self._process.stdout:
            if line.startswith('{"sets"'):
                answer = json.loads(line)
                return answer["sets"], answer["seconds"]
        raise RuntimeError("the toolbox ended without an answer")

    def close(self) -> None:
        """End the process."""
        self._process.communicate()


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


def compare(name: str, toolbox: Toolbox, runs: int) -> tuple[int, float, float]:
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
        sets, seconds = toolbox.sets(matrix, runs)
        assert sets == sorted(map(list, found)), name
        theirs += seconds
    return len(found), statistics.median(own), statistics.median(theirs)


def report(runs: int) -> None:
    """One line for each published structure, or that the toolbox is not there."""
    python = interpreter()
    if python is None:
        print("MSO sets: not compared, faultdiagnosistoolbox is not installed (make bench does)")
        return
    print("MSO sets of published structures, here and by the Fault Diagnosis Toolbox:")
    toolbox = Toolbox(python)
    for name in NAMES:
        count, own, theirs = compare(name, toolbox, runs)
        print(
            f"{name:28} {count:5} sets {own * 1e3:8.2f} ms  toolbox {theirs * 1e3:8.2f} ms"
            f"  {own / theirs:6.2f}x"
        )
    toolbox.close()
