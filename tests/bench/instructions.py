"""Instructions of the generated step against the same filter written by hand (hand/step.c)."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
HAND = Path(__file__).parent / "hand"
STEPS = 2000


def build(folder: Path) -> Path:
    """The program that runs either step on the same samples; compiles the robot first."""
    robot = folder / "robot"
    compile_robot = ["-m", "bondgraph", "compile", str(ROOT / "models" / "khepera.bg")]
    command = [sys.executable, *compile_robot, "-o", str(robot)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    sources = [HAND / "main.c", HAND / "step.c", robot / "khepera_residuals.c"]
    program = folder / "step"
    command = ["gcc", "-std=c99", "-O2", f"-I{robot}", f"-I{HAND}", "-o", str(program)]
    subprocess.run([*command, *map(str, sources), "-lm"], check=True)
    return program


def counted(program: Path, which: str) -> float:
    """Instructions of one step, library calls included, by valgrind's callgrind."""
    function = {"hand": "hand_step", "generated": "khepera_step"}[which]
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    command += [f"--toggle-collect={function}", str(program), which, str(STEPS)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    found = re.search(r"Collected : (\d+)", done.stderr)
    assert found is not None, done.stderr
    return int(found[1]) / STEPS


def report() -> None:
    """One line: both counts and their ratio."""
    missing = [tool for tool in ("gcc", "valgrind") if shutil.which(tool) is None]
    if missing:
        print(f"Instructions of a step: not counted, {' and '.join(missing)} not installed")
        return
    with tempfile.TemporaryDirectory() as folder:
        program = build(Path(folder))
        own, hand = counted(program, "generated"), counted(program, "hand")
    print(f"Step of the five residuals: {own:.0f} instructions, by hand {hand:.0f}:", end=" ")
    print(f"{own / hand:.2f}x  <= 1.3x")
