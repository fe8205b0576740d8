"""One hour of samples at 1 kHz with a disturbance every minute; some minutes.

    python -m tests.account [--minutes N] [--seed N] [--write]

The exit status is 1 if the account at the end is not, to the sample, what was done. With
`--write` the table goes into docs/trust.md.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from tests.account.replay import replayed, tuned
from tests.measured import ROOT, write

COMMAND = "python -m tests.account --write"


def main() -> int:
    """Run it."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.account",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--minutes", metavar="N", type=int, default=60)
    parser.add_argument("--seed", metavar="N", type=int, default=1)
    parser.add_argument("--write", action="store_true")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="account-") as name:
        folder = Path(name)
        found = replayed(folder, tuned(folder), args.minutes, args.seed)
    account = found.said[-1]["account"]
    samples, lines = account["samples"], account["lines"]
    blind = [f"{n} {s['blind']}" for n, s in account["residuals"].items()]
    warm = [f"{n} {s['warming up']}" for n, s in account["residuals"].items()]
    rows = ["| | |", "|---|---|", f"| samples read | {samples['read']} |"]
    rows += [f"| {name} | {n} |" for name, n in samples.items() if n and name != "read"]
    rows += [f"| lines that are none | {lines['garbage']} |"]
    rows += [f"| gaps, samples lost in them | {lines['gaps']}, {lines['lost']} |"]
    rows += [f"| samples on the grid | {found.expected.grid} |"]
    rows += [f"| of them blind | {', '.join(blind)} |", f"| warming up | {', '.join(warm)} |"]
    said = [f"{n} {event}" for event, n in account["verdicts"].items()]
    rows += [f"| verdicts | {', '.join(said)} |"]
    print("\n".join([*rows, *found.wrong]))
    print(f"{args.minutes} minutes, {len(found.wrong)} wrong, watched in {found.seconds:.0f} s;"
          f" {', '.join(f'{n} {c}' for c, n in found.expected.causes.items())}")  # fmt: skip
    if args.write and not found.wrong:
        write(ROOT / "docs" / "trust.md", COMMAND, "\n".join(rows))
    return 1 if found.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
