"""Every writer, with something happening at every operation on its files; half an hour.

    python -m tests.file_faults [--sample N] [--of NAME] [--write]

`--sample` takes so many points of each writer, spread evenly. The exit status is 1 if anything is
wrong. With `--write` the table goes into docs/trust.md.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from pathlib import Path

from tests.file_faults.interposer import Point, again, loaded
from tests.measured import ROOT, write

COMMAND = "python -m tests.file_faults --write"


def main() -> int:
    """Run the campaign in a process that has the library loaded."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.file_faults",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--sample", metavar="N", type=int, default=0)
    parser.add_argument("--of", metavar="NAME", default="")
    parser.add_argument("--write", action="store_true")
    args = parser.parse_args()
    if not loaded():
        with tempfile.TemporaryDirectory(prefix="faults-") as folder:
            root = Path(folder).resolve() / "root"
            for name in ("tmp", "cache"):
                (root / name).mkdir(parents=True)
            return again("tests.file_faults", root, sys.argv[1:])
    from tests.file_faults.campaign import Bench, campaign
    from tests.file_faults.writers import WRITERS

    del os.environ["LD_PRELOAD"]  # a compiler is no command of ours
    start = time.monotonic()
    writers = [w for w in WRITERS if args.of in w.name]

    def chosen(points: list[Point]) -> list[Point]:
        step = max(1, -(-len(points) // args.sample)) if args.sample else 1
        return points[::step]

    bench = Bench(Path(os.environ["HOME"]))
    counts, wrong = campaign(bench, writers, chosen, lambda line: print(line, flush=True))
    total = sum(n for *_, n in counts)
    print(f"{total} points, {len(wrong)} wrong, {time.monotonic() - start:.0f} s")
    if args.write and not wrong:
        rows = [f"| {name} | {operations} | {n} |" for name, operations, n in counts]
        head = ["| writer | operations | points |", "|---|---|---|"]
        write(ROOT / "docs" / "trust.md", COMMAND, "\n".join([*head, *rows]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
