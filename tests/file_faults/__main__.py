"""Every writer, with something happening at every operation on its files; half an hour or more.

    python -m tests.file_faults [--sample N] [--of NAME] [--write]
    python -m tests.file_faults --damage N

`--sample` takes so many points of each writer by chance. `--damage` flips bits and cuts ends
in N ways instead, of a journal and of a library that is kept. The exit status is 1 if anything is
wrong. With `--write` the table goes into docs/trust.md.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from pathlib import Path
from random import Random

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
    parser.add_argument("--damage", metavar="N", type=int, default=0)
    parser.add_argument("--write", action="store_true")
    args = parser.parse_args()
    if args.damage:
        return _damaged(args.damage)
    if not loaded():
        # Where there are files in memory: the power fails here by itself, a disk is only slower.
        memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
        with tempfile.TemporaryDirectory(prefix="faults-", dir=memory) as folder:
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
        few = 0 < args.sample < len(points)
        return sorted(Random(1).sample(points, args.sample)) if few else points

    bench = Bench(Path(os.environ["HOME"]))
    counts, wrong = campaign(bench, writers, chosen, lambda line: print(line, flush=True))
    total = sum(n for *_, n in counts)
    print(f"{total} points, {len(wrong)} wrong, {time.monotonic() - start:.0f} s")
    if args.write and not wrong:
        rows = [f"| {name} | {operations} | {n} |" for name, operations, n in counts]
        head = ["| writer | operations | points |", "|---|---|---|"]
        rows.append(f"| all | {sum(n for _, n, _ in counts)} | {total} |")
        write(ROOT / "docs" / "trust.md", COMMAND, "\n".join([*head, *rows]))
    return 1 if wrong else 0


def _damaged(count: int) -> int:
    """Damage a journal and a library of the C compiler; 1 if any of it does harm."""
    from bondgraph import compile
    from bondgraph.cache import user_cache
    from tests.file_faults import damage

    with tempfile.TemporaryDirectory(prefix="faults-") as folder:
        os.environ["XDG_CACHE_HOME"] = folder
        compile(str(ROOT / "models" / "dc_motor.bg")).engine(native=True)
        cache = user_cache("so", print)
        assert cache is not None
        (built,) = cache.folder.glob("*.so")
        data = built.read_bytes()
        (Path(folder) / "journal").mkdir()
        results = {
            "journal": damage.journal(Path(folder) / "journal" / "journal", count),
            f"library of {len(data)} bytes": damage.library(cache, data, count),
        }
    for name, (tried, wrong) in results.items():
        print("\n".join([*wrong, f"{name}: {tried} ways, {len(wrong)} wrong"]))
    return 1 if any(wrong for _, wrong in results.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
