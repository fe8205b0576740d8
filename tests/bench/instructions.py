"""Instructions of the generated step against the same filter written by hand (hand/step.c)."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

from tests.bench import linear_part

ROOT = Path(__file__).parents[2]
HAND = Path(__file__).parent / "hand"
SETTLED, STEPS = 1000, 500  # samples after which all filters have settled; that are counted
FUSED = ("-march=haswell", "-ffp-contract=fast")


def build(folder: Path, *options: str, cut: Callable[[str], str] = str) -> Path:
    """The program that runs either step on the same samples; compiles the robot first.

    `cut` makes another step of the generated C.
    """
    robot = folder / "robot"
    compile_robot = ["-m", "bondgraph", "compile", str(ROOT / "models" / "khepera.bg")]
    command = [sys.executable, *compile_robot, "-o", str(robot)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    own = robot / "khepera.c"
    own.write_text(cut(own.read_text(encoding="utf-8")), encoding="utf-8")
    sources = [HAND / "main.c", HAND / "step.c", own]
    program = folder / "step"
    command = ["gcc", "-std=c99", "-O2", *options, f"-I{robot}", f"-I{HAND}", "-o", str(program)]
    subprocess.run([*command, *map(str, sources), "-lm"], check=True)
    return program


def counted(program: Path, which: str) -> float:
    """Instructions of one settled step, `hand` or `generated`."""
    return each({"hand": "hand_step", "generated": "khepera_step"}[which], program, which)


def each(function: str, program: Path, *words: str) -> float:
    """Instructions of one settled call, library calls included, by valgrind's callgrind."""
    few, many = (_all(function, program, *words, str(n)) for n in (SETTLED, SETTLED + STEPS))
    return (many - few) / STEPS


def _all(function: str, program: Path, *words: str) -> int:
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    command += [f"--toggle-collect={function}", str(program), *words]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    found = re.search(r"Collected : (\d+)", done.stderr)
    assert found is not None, done.stderr
    return int(found[1])


def linear(*options: str, corrected: bool = True) -> float:
    """Instructions of the linear part of the generated step, see `linear_part`."""
    with tempfile.TemporaryDirectory() as folder:
        cut = partial(linear_part.of, corrected=corrected)
        return counted(build(Path(folder), *options, cut=cut), "generated")


def report() -> None:
    """One line for each kind of arithmetic: both counts and their ratio."""
    missing = [tool for tool in ("gcc", "valgrind") if shutil.which(tool) is None]
    if missing:
        print(f"Instructions of a step: not counted, {' and '.join(missing)} not installed")
        return
    for words, options in (("-O2", ()), (f"-O2 {' '.join(FUSED)}", FUSED)):
        with tempfile.TemporaryDirectory() as folder:
            program = build(Path(folder), *options)
            own, hand = counted(program, "generated"), counted(program, "hand")
        print(
            f"Step of the five residuals, double, {words}: {own:.0f} instructions, "
            f"by hand {hand:.0f}: {own / hand:.2f}x <= 1.1x"
        )
        plain, bare = linear(*options), linear(*options, corrected=False)
        print(f"  its linear part {plain:.0f}, {bare:.0f} without what corrects the hold")
