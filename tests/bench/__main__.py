"""`make bench`: medians of the times that matter, each against a yardstick of the same run."""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from pathlib import Path

import bondgraph
from tests.bench import (
    alarm,
    batch,
    cortex,
    generators,
    growth,
    instructions,
    peers,
    simulation,
    toolbox,
    whole,
)
from tests.bench.clock import in_turn, python

ROOT = Path(__file__).parents[2]
ROBOT = str(ROOT / "models" / "khepera.bg")
LONG = str(ROOT / "tests" / "bench" / "cable1000.bg")


def row(what: str, own: float, yardstick: str, other: float, limit: str) -> None:
    """One line of the table: both medians, their ratio, and what is promised."""
    ratio = own / other
    print(f"{what:28} {own * 1e3:7.0f} ms  {yardstick:16} {other * 1e3:5.0f} ms", end="  ")
    print(f"{ratio:6.2f}x  {limit}")


def commands(runs: int) -> None:
    """Whole commands, from the start of the interpreter to its end."""
    with tempfile.TemporaryDirectory() as folder:
        bare, algebra, check, robot, long = in_turn(
            [
                python("-c", "pass"),
                python("-c", "import sympy"),
                python("-m", "bondgraph", "check", ROBOT),
                python("-m", "bondgraph", "compile", ROBOT, "-o", f"{folder}/robot"),
                python("-m", "bondgraph", "compile", LONG, "-o", f"{folder}/long"),
            ],
            runs,
        )
    start, sympy = bare.median, algebra.median
    budget = f"<= {(3 * start + 0.060) * 1e3:.0f} ms (3x + 60 ms)"
    row("check models/khepera.bg", check.median, "python -c pass", start, budget)
    row("compile models/khepera.bg", robot.median, "import sympy", sympy, "<= 2.5x")
    row("compile Cable(n = 1000)", long.median, "import sympy", sympy, "<= 10x")


def verification(runs: int) -> None:
    """The check that every compilation ends with, beside the stages before it; both once warm."""
    before, check = [], []
    for _ in range(runs + 1):
        compilation = bondgraph.compile(ROBOT)
        start = time.perf_counter()
        _ = compilation.signatures
        middle = time.perf_counter()
        _ = compilation.verification
        before.append(middle - start)
        check.append(time.perf_counter() - middle)
    own, other = statistics.median(check[1:]), statistics.median(before[1:])
    row("verify models/khepera.bg", own, "text to matrix", other, "")


def main() -> None:
    """Run all benchmarks; `--short` takes most things once, and smaller models."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench", description=__doc__)
    parser.add_argument("--short", action="store_true", help="most things once, smaller models")
    short = parser.parse_args().short
    taken = "Single runs" if short else "Medians of runs taken in turn"
    print(f"{taken} on this machine, in this run.\n")
    commands(1 if short else 11)
    verification(1 if short else 11)
    print()
    whole.report(short)
    whole.sharper(short)
    print()
    simulation.report(short)
    print()
    instructions.report()
    generators.report()
    cortex.report()
    print()
    batch.report(short)
    print()
    alarm.report(short)
    print()
    toolbox.report(1 if short else 7)
    print()
    if short:
        peers.report((1, 5, 100), limit=5.0)
    else:
        peers.report((1, 2, 5, 10, 20, 50, 200, 1000), limit=20.0)
    print()
    growth.report(short)


if __name__ == "__main__":
    main()
