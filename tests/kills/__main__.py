"""Monitors of every source, each killed with `kill -9` at a random moment; a quarter of an hour.

    python -m tests.kills [--times N] [--of SOURCE] [--seed N] [--write]

So many kills of each source (default: 200). The exit status is 1 if a verdict was lost, torn, or
said twice where that is not documented. With `--write` the table goes into docs/trust.md.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import sys
import tempfile
import time
from pathlib import Path
from random import Random

import pytest

from tests.kills.campaign import Episode, episode, tuned
from tests.kills.sources import KINDS
from tests.measured import ROOT, write
from tests.unit.runtime.monitoring.watch import Nursery

COMMAND = "python -m tests.kills --times {} --write"
_HEAD = "| source | kills | verdicts | put down, not printed | published twice |"


def main() -> int:
    """Run the campaign."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.kills",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--times", metavar="N", type=int, default=200)
    parser.add_argument("--of", metavar="SOURCE", default="", choices=["", *KINDS])
    parser.add_argument("--seed", metavar="N", type=int, default=1)
    parser.add_argument("--write", action="store_true")
    args = parser.parse_args()
    rows, wrong, skipped = [], 0, 0
    nursery = Nursery()
    with tempfile.TemporaryDirectory(prefix="kills-") as folder:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            tuning = tuned(Path(folder))
        for kind in KINDS:
            if args.of not in ("", kind):
                continue
            try:
                found = killed(kind, Path(folder), tuning, nursery, args.seed, args.times)
            except pytest.skip.Exception as reason:
                print(f"{kind}: skipped, {reason}")
                skipped += 1
                continue
            kills, verdicts, unsaid, twice = (sum(e[k] for e in found) for k in range(4))
            of = [w for e in found for w in e.wrong]
            wrong += len(of)
            rows.append(f"| {kind} | {kills} | {verdicts} | {unsaid} | {twice} |")
            print("\n".join([*of, f"{rows[-1]} {len(of)} wrong"]), flush=True)
    nursery.close()
    if args.write and not (wrong or skipped or args.of):
        table = "\n".join([_HEAD, "|---" * 5 + "|", *rows])
        write(ROOT / "docs" / "trust.md", COMMAND.format(args.times), table)
    return 1 if wrong else 0


def killed(
    kind: str, folder: Path, tuning: Path, nursery: Nursery, seed: int, times: int
) -> list[Episode]:
    """Episodes until there are so many kills."""
    found: list[Episode] = []
    start = time.monotonic()
    while (count := sum(e.kills for e in found)) < times:
        own = folder / f"{kind}-{len(found)}".replace(" ", "-")
        own.mkdir()
        draw = Random(f"{seed} {kind} {len(found)}")
        found.append(episode(kind, own, tuning, nursery, draw, min(8, times - count)))
        if sys.stderr.isatty():
            print(f"{kind}: {count}, {time.monotonic() - start:.0f} s", end="\r", file=sys.stderr)
    return found


if __name__ == "__main__":
    sys.exit(main())
