"""The step of the robot against one by hand, and on a Cortex-M4F: the table of docs/firmware.md."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from tests.bench import cortex, instructions
from tests.measured import ROOT, write

PAGE = ROOT / "docs" / "firmware.md"
COMMAND = "python -m tests.bench.step_costs --write"


def table() -> str:
    """Three rows in Markdown."""
    rows = [
        "| numbers, core | instructions a step | by hand | code of step | coefficients | RAM |",
        "|---|---|---|---|---|---|",
    ]
    for name, options in (
        ("double, x86-64", ()),
        (f"the same with fused products (`{' '.join(instructions.FUSED)}`)", instructions.FUSED),
    ):
        with tempfile.TemporaryDirectory() as folder:
            program = instructions.build(Path(folder), *options)
            own, hand = (instructions.counted(program, who) for who in ("generated", "hand"))
        rows.append(f"| {name} | {own:.0f} | {hand:.0f} | | | |")
    board = cortex.measured()
    rows.append(
        f"| float, Cortex-M4F | {board.instructions:.0f} | | {board.text} B |"
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
