"""Compiles random graphs and counts the answers: python -m tests.random.run --count 10000."""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from multiprocessing import get_context
from random import Random

from tests.random.graphs import Graph, generate
from tests.random.judge import Verdict, judge


def of_seed(seed: int) -> Graph:
    """The graph with a number."""
    return generate(Random(f"graph {seed}"))


def verdict(seed: int) -> tuple[int, Verdict]:
    """What the compiler says about the graph with a number."""
    return seed, judge(of_seed(seed))


def main() -> int:
    """Status 1 if an answer is wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--start", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--show", type=int, help="print one graph and the verdict on it")
    options = parser.parse_args()
    if options.show is not None:
        graph = of_seed(options.show)
        print(graph.text, judge(graph), "relations by rank:", graph.relations())
        return 0
    outcomes: Counter[str] = Counter()
    notes: Counter[str] = Counter()
    wrong = 0
    seeds = range(options.start, options.start + options.count)
    with get_context("spawn").Pool(options.jobs) as pool:
        for seed, found in pool.imap(verdict, seeds, chunksize=20):
            outcomes[found.outcome] += 1
            notes.update(found.notes)
            if found.wrong:
                wrong += 1
                print(f"{seed}: {found.outcome}: {found.wrong}", flush=True)
            elif "verification-unavailable" in found.notes:
                print(f"{seed}: not verified", flush=True)
    for title, counts in (("answers", outcomes), ("warnings", notes)):
        print(f"{title}: " + ", ".join(f"{n} {name}" for name, n in counts.most_common()))
    print(f"{options.count} graphs, {wrong} wrong")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
