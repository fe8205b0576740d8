"""The step of the robot against one by hand, and on a Cortex-M4F: the table of docs/firmware.md."""

from __future__ import annotations

import argparse
import os
import tempfile
from pathlib import Path

from tests.bench import cortex, generators, instructions
from tests.bench.peers import interpreter
from tests.measured import ROOT, write

PAGE = ROOT / "docs" / "firmware.md"
COMMAND = "python -m tests.bench.step_costs --write"


def table() -> str:
    """A row for each kind of arithmetic, in Markdown."""
    os.environ.setdefault("BONDGRAPH_BENCH_PEERS", str(ROOT / ".venv" / "generators"))
    there = [(one, python) for one in generators.GENERATORS if (python := interpreter(one.peer))]
    if len(there) < len(generators.GENERATORS):
        raise SystemExit("the other generators are not installed: make .venv/generators.stamp")
    others = [one.peer.name for one, _ in there]
    rows = [
        f"| numbers, core | instructions a step | by hand | {' | '.join(others)} |"
        " code of step | coefficients | RAM |",
        "|---|---|---|" + "---|" * (len(others) + 3),
    ]
    blank = "| " * len(others)
    for name, options in (
        ("double, x86-64", ()),
        (f"the same with fused products (`{' '.join(instructions.FUSED)}`)", instructions.FUSED),
    ):
        with tempfile.TemporaryDirectory() as folder:
            program = instructions.build(Path(folder), *options)
            own, hand = (instructions.counted(program, who) for who in ("generated", "hand"))
        counts = [f"{generators.counted(g, python, *options):.0f}" for g, python in there]
        rows.append(f"| {name} | {own:.0f} | {hand:.0f} | {' | '.join(counts)} | | | |")
    board = cortex.measured()
    rows.append(
        f"| float, Cortex-M4F | {board.instructions:.0f} | {blank}| {board.text} B |"
        f" {board.coefficients} B | {board.memory} B |"
    )
    return "\n".join(rows)


def main() -> None:
    """Print the table; with `--write` put it into the page."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench.step_costs", description=__doc__)
    parser.add_argument("--write", action="store_true", help="put the table into docs/firmware.md")
    found = table()
    if parser.parse_args().write:
        write(PAGE, COMMAND, found)
    print(found)


if __name__ == "__main__":
    main()
