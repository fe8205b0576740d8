"""Mutants through the tests: python -m tests.mutants --count 300 --seed 1 --jobs 2.

Each mutant is put into a copy of the checkout, and the tests that reach its function are run there
until one fails: those of its name, those of its room in tests/unit, then the fastest of the others.
Most mutants die of the first, before the others are even imported. What no test notices is listed;
what nobody could notice is kept, with the reason, in `equivalent.toml`. With `--own` only the rooms
of the mutants that were drawn are asked: a file is to be watched by its own tests.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import shutil
import subprocess
import sys
import tomllib
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from pathlib import Path
from queue import Queue
from tempfile import TemporaryDirectory
from typing import NamedTuple

from tests.mutants.groups import GROUPS, ROOT, asked, examples, mirror, modules, own
from tests.mutants.mutate import Mutant, mutants

_KEPT = ROOT / "build" / "mutants"
_EQUIVALENT = Path(__file__).with_name("equivalent.toml")
_OUTCOMES = ("killed", "killed by others", "timed out", "equivalent", "survived")
_PYTEST = ("-q", "-x", "--tb=no", "--no-header", "-p", "no:cacheprovider")

say = partial(print, flush=True)


class Reach(NamedTuple):
    """What a test file reaches and how many seconds it takes."""

    test: str
    seconds: float
    functions: frozenset[str]


class Answer(NamedTuple):
    """What the tests say of a mutant, how many were asked if need be, and how many could be."""

    mutant: Mutant
    group: str
    outcome: str
    asked: int = 0
    known: int = 0


def drawn(
    count: int, seed: int, groups: list[str], only: str | None = None
) -> list[tuple[str, Mutant]]:
    """As many mutants of each group, by chance; those of other code change nothing in the draw.

    Where `only` one module is asked about, all are of that.
    """
    if only is not None:
        groups = [group for group in groups if only in modules(group)]
    found = []
    for i, group in enumerate(groups):
        share = count // len(groups) + (i < count % len(groups))
        names = modules(group) if only is None else [only]
        every = [m for name in names for m in mutants(name, (ROOT / name).read_bytes())]
        every.sort(key=lambda m: m.rank(seed))
        found += [(group, m) for m in every[:share]]
    return found


@cache
def judged() -> dict[tuple[str, str, str], str]:
    """The reasons why mutants are equivalent."""
    entries = tomllib.loads(_EQUIVALENT.read_text(encoding="utf-8"))["mutant"]
    return {(e["module"], e["line"], e["change"]): e["reason"] for e in entries}


def reached(test: str) -> Reach | None:
    """What a test file reaches, from the last time it was the same; None if it does not pass."""
    digest = hashlib.sha256((ROOT / test).read_bytes()).hexdigest()[:16]
    kept = _KEPT / "reach" / f"{test.replace('/', '.')}.{digest}.json"
    if not kept.exists():
        kept.parent.mkdir(parents=True, exist_ok=True)
        command = [sys.executable, "-m", "pytest", *_PYTEST, "-p", "tests.mutants.reach", test]
        environment = {**os.environ, "BONDGRAPH_REACH": str(kept), "PYTHONPATH": str(ROOT)}
        subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, check=False)
    found = json.loads(kept.read_text(encoding="utf-8"))
    if found["status"] != 0:
        say(f"not asked, as it does not pass: {test}")
        kept.unlink()
        return None
    return Reach(test, found["seconds"], frozenset(found["functions"]))


def rounds(mutant: Mutant, reaches: list[Reach]) -> list[list[Reach]]:
    """The tests that reach the function: of its name, of its room, the others.

    Each of the three may be empty. What only runs in processes of their own is seen by none: then
    those of its room may be asked.
    """
    name = f"{mutant.module}:{mutant.function}"
    room = [r for r in reaches if own(r.test, mutant.module)]
    fits = [r for r in reaches if name in r.functions] or room
    named = [r for r in room if r in fits and mirror(r.test, mutant.module)]
    room = [r for r in room if r in fits and r not in named]
    others = [r for r in fits if r not in named and r not in room]
    return [named, room, others]


def within(budget: float, tests: list[Reach]) -> list[Reach]:
    """The fastest ones, together no longer than `budget` seconds; one of them in any case."""
    found: list[Reach] = []
    for reach in sorted(tests, key=lambda r: r.seconds):
        if not found or sum(r.seconds for r in found) + reach.seconds <= budget:
            found.append(reach)
    return found


def copied(place: Path) -> Path:
    """A copy of the checkout, as it is on the disk."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT, capture_output=True, check=True, text=True,
    ).stdout  # fmt: skip
    for name in filter(None, listed.split("\0")):
        if (ROOT / name).is_file():
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, place / name)
    return place


def put(module: Path, source: bytes) -> None:
    """Write a module and forget its bytecode, which might look as new as the module."""
    module.write_bytes(source)
    for old in (module.parent / "__pycache__").glob(f"{module.stem}.*"):
        old.unlink()


class Copy:
    """A copy of the checkout and a process that runs tests in it."""

    def __init__(self, place: Path) -> None:
        self.place = copied(place)
        environment = {**os.environ, "PYTHONPATH": str(place), "OPENBLAS_NUM_THREADS": "1"}
        self.process = subprocess.Popen(
            [sys.executable, "-m", "tests.mutants.serve"],
            cwd=place, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        )  # fmt: skip

    def ask(self, mutant: Mutant, asked: list[list[Reach]]) -> str:
        """Run the tests with the mutant, round by round; the copy is as before in the end."""
        source = (ROOT / mutant.module).read_bytes()
        put(self.place / mutant.module, mutant.applied(source))
        outcome = "survived"
        named, room, others = asked
        for kill, tests in (("killed", named), ("killed", room), ("killed by others", others)):
            if outcome == "survived" and (tests or tests is named):
                first = [examples(mutant.module)] if tests is named else []
                seconds = {r.test: r.seconds for r in tests}
                status = self.run(seconds, [*_PYTEST, *first, *seconds])
                late = kill if tests is others else "timed out"
                outcome = {"0": "survived", "timed out": late}.get(status, kill)
        put(self.place / mutant.module, source)
        return outcome

    def run(self, seconds: dict[str, float], arguments: list[str]) -> str:
        """The status of pytest; so many seconds of processor time are usual for each file."""
        assert self.process.stdin is not None and self.process.stdout is not None
        self.process.stdin.write(json.dumps([seconds, *arguments]) + "\n")
        self.process.stdin.flush()
        status = self.process.stdout.readline().strip()
        if status in ("4", "5"):
            raise RuntimeError(f"no tests ran: {' '.join(arguments)}")
        return status

    def close(self) -> None:
        """End the process."""
        self.process.communicate()


def answers(
    wanted: list[tuple[str, Mutant]], reaches: list[Reach], jobs: int, budget: float
) -> list[Answer]:
    """Ask about all mutants, several at a time, each in a copy of its own."""
    copies: Queue[Copy] = Queue()

    def answer(group: str, mutant: Mutant) -> Answer:
        if mutant.key in judged():
            return Answer(mutant, group, "equivalent")
        known = rounds(mutant, reaches)
        tests = [within(budget, round_) for round_ in known]
        copy = copies.get()
        try:
            outcome = copy.ask(mutant, tests)
        finally:
            copies.put(copy)
        say(f"{outcome}: {mutant.module}:{mutant.line}: {mutant.change}")
        return Answer(mutant, group, outcome, sum(map(len, tests)), sum(map(len, known)))

    with TemporaryDirectory(prefix="mutants") as folder:
        for job in range(jobs):
            copies.put(Copy(Path(folder, str(job))))
        with ThreadPoolExecutor(jobs) as pool:
            found = list(pool.map(lambda pair: answer(*pair), wanted))
        for _ in range(jobs):
            copies.get().close()
    return found


def share(found: list[Answer]) -> tuple[float, float, float]:
    """What part its own tests killed, and Wilson's interval of 95 % for it (1927).

    Equivalent mutants are nobody's to kill: they do not count. A test that does not end is noticed.

    >>> [f"{x:.3f}" for x in share([])]
    ['0.000', '0.000', '1.000']
    """
    counts = Counter(a.outcome for a in found)
    n = counts.total() - counts["equivalent"]
    if not n:
        return 0.0, 0.0, 1.0
    p, z2 = (counts["killed"] + counts["timed out"]) / n, 1.96**2
    middle, half = p + z2 / (2 * n), (z2 * (p * (1 - p) / n + z2 / (4 * n * n))) ** 0.5
    return p, (middle - half) / (1 + z2 / n), (middle + half) / (1 + z2 / n)


def table(found: list[Answer]) -> str:
    """A row for each group, and one for all."""
    rows = ["| group | " + " | ".join(_OUTCOMES) + " | by its own tests |", "|---|" + "---:|" * 6]
    for group in [*dict.fromkeys(a.group for a in found), ""]:
        those = [a for a in found if group in ("", a.group)]
        counts = Counter(a.outcome for a in those)
        killed, low, high = share(those)
        cells = [group or "all", *(str(counts[o]) for o in _OUTCOMES)]
        rows.append("| " + " | ".join(cells) + f" | {killed:.0%} ({low:.0%} to {high:.0%}) |")
    return "\n".join(rows)


def main() -> int:
    """Status 1 if their own tests killed fewer mutants than wanted."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", "--sample", type=int, default=300, help="mutants in all")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--groups", default=",".join(GROUPS), help="of: %(default)s")
    parser.add_argument("--only", metavar="PATH", help="mutants of this module and of no other")
    parser.add_argument("--budget", type=float, default=60.0, help="seconds of tests a round")
    parser.add_argument("--least", type=float, default=0.0, help="share to be killed by own tests")
    parser.add_argument("--own", action="store_true", help="ask the tests of such rooms only")
    parser.add_argument("--again", action="store_true", help="only those that survived last time")
    options = parser.parse_args()
    wanted = drawn(options.count, options.seed, options.groups.split(","), options.only)
    if not wanted:
        parser.error(f"no mutants of {options.only or options.groups}")
    last = _KEPT / "survived.json"
    if options.again:
        before = {tuple(key) for key in json.loads(last.read_text(encoding="utf-8"))}
        wanted = [(g, m) for g, m in wanted if m.key in before]
    tests = [t for t in asked() if not options.own or any(own(t, m.module) for _, m in wanted)]
    with ThreadPoolExecutor(options.jobs) as pool:
        reaches = [r for r in pool.map(reached, tests) if r is not None]
    found = answers(wanted, reaches, options.jobs, options.budget)
    say(f"\nseed {options.seed}, {len(found)} mutants\n\n{table(found)}")
    survived = [a for a in found if a.outcome in ("survived", "killed by others")]
    for mutant, _, outcome, some, known in survived:
        place = f"{mutant.module}:{mutant.line} in {mutant.function}"
        say(f"\n{place}: {some} of {known} test files were asked within the budget")
        say(f"    {mutant.text}\n    {mutant.change}\n    {outcome}")
    last.parent.mkdir(parents=True, exist_ok=True)
    last.write_text(json.dumps([a.mutant.key for a in survived], indent=0), encoding="utf-8")
    return int(share(found)[0] < options.least)
