"""Compiles random graphs and counts the answers: python -m tests.random.run --count 10000.

Every run takes other graphs unless `--start` says which; `--write` puts the table into
docs/random_graphs.md, where the same command stands.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Iterable
from multiprocessing import get_context
from pathlib import Path
from random import Random, SystemRandom
from typing import NamedTuple

from hypothesis import HealthCheck, find, settings
from hypothesis import strategies as st
from hypothesis.errors import NoSuchExample

from tests import measured
from tests.random.graphs import Graph, generate
from tests.random.judge import OTHER_COUNT, PART, UNEXPLAINED, Verdict, judge

PAGE = Path(__file__).parents[2] / "docs" / "random_graphs.md"

#: Outcomes in the words of the page; others stand there as they are.
_WORDS = {
    "ok": "relations, as many as the rank says, verified exactly",
    OTHER_COUNT: "another count than the rank says, with products or switches",
    "no_arr": "no relation, as the rank says",
    PART: "a part of the relations, verified exactly, and what is missing",
    UNEXPLAINED: "a part of the relations, verified exactly, and some missing without a reason",
    "time-out": "no answer in time",
}
_NOT_VERIFIED = "relations, told to be not verified"


class Counted(NamedTuple):
    """The answers to many graphs, those with a wrong one, and a line for what is worth a look."""

    answers: Counter[str]
    wrong: tuple[int, ...]
    lines: tuple[str, ...]


_SECONDS = 60  # of processor time for one graph


def of_seed(seed: int) -> Graph:
    """The graph with a number."""
    return generate(Random(f"graph {seed}"))


def verdict(seed: int) -> tuple[int, Verdict]:
    """What the compiler says about the graph with a number, and whether it does so in time."""
    return seed, judge(of_seed(seed), _SECONDS)


def counted(verdicts: Iterable[tuple[int, Verdict]]) -> Counted:
    """Count answers as the page does."""
    answers: Counter[str] = Counter()
    lines, wrong = [], []
    for seed, found in verdicts:
        unverified = "verification-unavailable" in found.notes
        answers[_NOT_VERIFIED if unverified else _WORDS.get(found.outcome, found.outcome)] += 1
        if found.wrong:
            wrong.append(seed)
        if found.wrong or unverified:
            lines.append(f"{seed}: {found.outcome}: {found.wrong or 'not verified'}")
    return Counted(answers, tuple(wrong), tuple(lines))


def table(found: Counted) -> str:
    """The answers, the most frequent first, and how many of them are wrong, with their numbers."""
    rows = sorted(found.answers.items(), key=lambda pair: (-pair[1], pair[0]))
    rows.append(("all", found.answers.total()))
    rows.append((" ".join(["wrong", *map(str, found.wrong)]), len(found.wrong)))
    return "\n".join(["| Answer | Graphs |", "|---|---:|", *(f"| {a} | {n} |" for a, n in rows)])


def smallest(count: int) -> Graph | None:
    """The smallest graph that is answered wrongly, if any of so many is, shrunk by hypothesis."""
    options = settings(
        max_examples=count,
        deadline=None,
        database=None,
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
    )
    graphs = st.builds(generate, st.randoms(use_true_random=False))
    try:
        return find(graphs, lambda one: bool(judge(one, _SECONDS).wrong), settings=options)
    except NoSuchExample:
        return None


def main() -> int:
    """Status 1 if an answer is wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--start", type=int, help="the first graph; others each time without it")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--show", type=int, help="print one graph and the verdict on it")
    parser.add_argument("--smallest", action="store_true", help="shrink the first wrong one")
    parser.add_argument("--write", action="store_true", help="put the table into its page")
    options = parser.parse_args()
    if options.show is not None:
        graph = of_seed(options.show)
        print(graph.text, judge(graph), "relations by rank:", graph.relations())
        return 0
    if options.smallest:
        least = smallest(options.count)
        print("none is answered wrongly" if least is None else least.text)
        return int(least is not None)
    start = SystemRandom().randrange(10**9) if options.start is None else options.start
    command = f"python -m tests.random.run --start {start} --count {options.count}"
    print(command, flush=True)
    with get_context("spawn").Pool(options.jobs) as pool:
        seeds = range(start, start + options.count)
        found = counted(pool.imap(verdict, seeds, chunksize=20))
    print("\n".join((*found.lines, "", table(found))))
    if options.write:
        measured.write(PAGE, command, table(found))
    return int(len(found.wrong) > 0)


if __name__ == "__main__":
    sys.exit(main())
