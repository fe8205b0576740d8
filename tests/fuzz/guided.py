"""Texts that reach what no text before has reached: python -m tests.fuzz.guided [KIND ...].

Each kind is driven by libFuzzer (by way of atheris) in a process of its own, `one_kind`: a text
is made of one that was kept, and is kept itself if it passes a branch of the package that none had
passed, or one more often. A process that libFuzzer had to end is begun again with what was kept.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from hashlib import sha256
from importlib import import_module
from importlib.util import find_spec
from itertools import accumulate
from multiprocessing.pool import ThreadPool
from pathlib import Path
from typing import NamedTuple

from tests.fuzz.attempt import Finding, Kind, attempt, smallest
from tests.fuzz.counts import Counts
from tests.fuzz.mutate import ROOT
from tests.fuzz.targets import KINDS
from tests.measured import LEDGER, commit, write

KEPT = Path(__file__).with_name("corpus")
_BROKE = ROOT / "build" / "fuzz"  # where the texts of findings go
_SECONDS = 20  # that no text may take
_MEMORY = 1024  # MB that all of them together may add
_ENDS = 10  # processes of a kind that libFuzzer had to end, then it is enough
#: Texts of a whole campaign, by kind, and of all others.
_COUNTS = {"check": 1_000_000, "compile": 10_000}
_OTHERS = 100_000
_CORPUS = 40_000  # bytes that are kept of a kind
#: What a campaign has found so far, by kind: a run of some hours at a time, each with its commit.
_LEDGER = ROOT / LEDGER


class Result(NamedTuple):
    """Of one kind: how many texts, how many answers and branches they reached, what broke."""

    kind: str
    texts: int
    sound: int  # of these, that nothing was wrong with
    answers: int
    branches: int
    slowest: float  # s
    memory: float  # MB that were added at most
    findings: list[Finding]
    seconds: float


class Run(NamedTuple):
    """What is asked for: texts of a KIND of a module, by a seed, each within seconds, all of them
    within so many MB more; whether the corpus is to be made anew from what was found. `minutes`
    end it before its count."""

    kind: str
    count: int
    seed: int = 1
    module: str = "tests.fuzz.targets"
    seconds: int = _SECONDS
    memory: int = _MEMORY
    keep: bool = False
    minutes: float | None = None


def run(asked: Run) -> Result:
    """Give so many texts to a kind, in as many processes one after the other as that takes.

    What a process reads again that follows one that was ended counts as texts, too.
    """
    start = time.perf_counter()
    ended: list[Finding] = []
    branches = 0
    with tempfile.TemporaryDirectory(prefix="fuzz-") as place:
        folder = Path(place)
        for name in ("grown", "seeds"):
            (folder / name).mkdir()
        for text in first_texts(asked):
            (folder / "seeds" / _digest(text)).write_bytes(text)
        counts = Counts(folder / "counts")
        while (left := asked.count - counts.read()[0]) > 0 and len(ended) < _ENDS:
            options = [f"-atheris_runs={left}", f"-seed={asked.seed + len(ended)}",
                       f"-timeout={asked.seconds}", "grown", "seeds"]  # fmt: skip
            if asked.minutes is not None:
                rest = start + 60 * asked.minutes - time.perf_counter()
                if rest < 1:
                    break
                options.append(f"-max_total_time={round(rest)}")
            status, said = _process(asked, folder, options)
            branches = max([branches, *(int(n) for n in re.findall(r" cov: (\d+) ", said))])
            if counts.read()[0] < asked.count and status != 0:
                ended.append(_end(folder, status, said))
        found = [*ended, *_broken(folder / "findings")]
        answers = len((folder / "answers").read_text("utf-8").splitlines())
        texts, sound, slowest, memory = counts.read()
        if asked.keep:
            _keep(asked, folder)
    taken = time.perf_counter() - start
    return Result(asked.kind, texts, sound, answers, branches, slowest, memory, found, taken)


def first_texts(asked: Run) -> list[bytes]:
    """The seeds of a kind and what earlier runs have kept."""
    kinds: dict[str, Kind] = import_module(asked.module).KINDS
    return [*kinds[asked.kind].seeds(), *kept_texts(asked.kind)]


def kept_texts(name: str) -> list[bytes]:
    """The texts of a kind that earlier runs have kept, in order of their names."""
    return [p.read_bytes() for p in sorted((KEPT / name).glob("*"))]


def _process(asked: Run, folder: Path, options: Sequence[str]) -> tuple[int, str]:
    """Its exit status and what it said."""
    words = [asked.module, asked.kind, str(folder), str(asked.memory), *options]
    words = [str(folder / w) if w in ("grown", "seeds", "merged") else w for w in words]
    log = folder / "said"
    with log.open("w") as file:
        status = subprocess.run(
            [sys.executable, "-m", "tests.fuzz.one_kind", *words],
            cwd=ROOT, env=os.environ | {"PYTHONHASHSEED": "0"}, stdout=file, stderr=file,
        ).returncode  # fmt: skip
    return status, log.read_text("utf-8", "replace")


def _end(folder: Path, status: int, said: str) -> Finding:
    """Why libFuzzer ended a process, with the text that it left; raises RuntimeError for none."""
    left = [p for what in ("timeout", "oom", "crash") for p in folder.glob(f"{what}-*")]
    if not left:
        raise RuntimeError(f"status {status}, though no text broke it:\n{said[-4000:]}")
    what, text = left[0].name.split("-")[0], left[0].read_bytes()
    for path in left:
        path.unlink()
    for name in ("grown", "seeds"):  # which the next process reads
        for path in (folder / name).iterdir():
            if path.read_bytes() == text:
                path.unlink()
    lines = [line for line in said.splitlines() if not line.startswith(("#", "INFO: "))]
    return Finding(what, "\n".join(lines[-40:]) + "\n", text)


def _broken(folder: Path) -> list[Finding]:
    """What exceptions were, one of each kind."""
    return [
        Finding(p.stem, p.read_text("utf-8"), p.with_suffix("").read_bytes())
        for p in sorted(folder.glob("*.trace"))
    ]


def _keep(asked: Run, folder: Path) -> None:
    """Make the corpus of the smallest texts that pass all branches; of a few bytes in all."""
    (folder / "merged").mkdir()
    options = ["-merge=1", "-use_counters=0", "merged", "grown", "seeds"]
    status, said = _process(asked, folder, options)
    if status != 0:
        raise RuntimeError(f"libFuzzer could not merge:\n{said[-2000:]}")
    seeds = set(import_module(asked.module).KINDS[asked.kind].seeds())
    texts = sorted({p.read_bytes() for p in (folder / "merged").iterdir()} - seeds, key=len)
    kept = KEPT / asked.kind
    kept.mkdir(parents=True, exist_ok=True)
    for path in kept.iterdir():
        path.unlink()
    for text, size in zip(texts, accumulate(map(len, texts)), strict=True):
        if size <= _CORPUS:
            (kept / _digest(text)).write_bytes(text)


def _digest(text: bytes) -> str:
    return sha256(text).hexdigest()[:12]


class Entry(NamedTuple):
    """What the ledger keeps of a run."""

    commit: str
    texts: int
    sound: int
    answers: int
    branches: int
    findings: list[str]
    slowest: float
    memory: float


def ledger() -> dict[str, list[Entry]]:
    """The runs of the campaign so far, by kind."""
    kept = json.loads(_LEDGER.read_text("utf-8")) if _LEDGER.exists() else {}
    return {kind: [Entry(**entry) for entry in kept.get(kind, [])] for kind in KINDS}


def enter(found: Result) -> None:
    """Write a run into the ledger, and the table of all runs into the documentation."""
    every = ledger()
    whats = [f.what for f in found.findings]
    every[found.kind].append(
        Entry(commit(), found.texts, found.sound, found.answers, found.branches, whats,
              round(found.slowest, 2), round(found.memory))
    )  # fmt: skip
    kept = {kind: [e._asdict() for e in entries] for kind, entries in every.items() if entries}
    _LEDGER.write_text(json.dumps(kept, indent=1) + "\n", "utf-8")
    write(ROOT / "docs" / "trust.md", "python -m tests.fuzz.guided --campaign", table(every))


def table(every: Mapping[str, Sequence[Entry]]) -> str:
    """What was found by all runs, for a page of the documentation; most of answers and branches."""
    columns = "kind texts of runs sound answers branches findings slowest memory".split()
    rows = [f"| {' | '.join(columns)} |", "|---" * len(columns) + "|"]
    for kind, entries in every.items():
        texts, sound = sum(e.texts for e in entries), sum(e.sound for e in entries)
        most = [max((e[k] for e in entries), default=0) for k in (3, 4, 6, 7)]
        rows.append(
            f"| {kind} | {texts:,} | {_COUNTS.get(kind, _OTHERS):,} | {len(entries)} | {sound:,}"
            f" | {most[0]:,} | {most[1]:,} | {sum(len(e.findings) for e in entries)}"
            f" | {most[2]:.2f} s | {most[3]:.0f} MB |"
        )
    return "\n".join(rows)


def _tell(found: Result) -> None:
    """Print what a kind came to; texts that broke it are made small and written down."""
    print(f"{found.kind}: {found.texts} texts, {found.sound} sound, {found.answers} answers,"
          f" {found.branches} branches, {len(found.findings)} findings, slowest"
          f" {found.slowest:.2f} s, {found.memory:.0f} MB more, {found.seconds:.0f} s",
          flush=True)  # fmt: skip
    for what, trace, text in found.findings:

        def fails(shorter: bytes, what: str = what) -> bool:
            return attempt(KINDS[found.kind].read, shorter)[0] == what

        small = smallest(text, fails) if fails(text) else text
        _BROKE.mkdir(parents=True, exist_ok=True)
        path = _BROKE / f"{found.kind}-{_digest(small)}"
        path.write_bytes(small)
        print(f"=== {what}, in {path.relative_to(ROOT)}\n{trace}--- for\n{small[:1500]!r}")


def main() -> int:
    """Run some kinds and tell; the exit status is 1 where a text broke one."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=", ".join(KINDS))
    parser.add_argument("--count", type=int, help="of each kind (default: those of a campaign)")
    parser.add_argument("--share", type=float, default=1.0, help="of a campaign")
    parser.add_argument("--jobs", type=int, default=1, help="kinds at a time")
    parser.add_argument("--campaign", action="store_true",
                        help="what is missing of a campaign; its table goes into docs/trust.md")
    parser.add_argument("--minutes", type=float, help="a kind takes at most")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", action="store_true", help="make the corpus anew from all of it")
    args = parser.parse_args()
    if find_spec("atheris") is None:
        parser.error("atheris is not installed: it has wheels for Python 3.11 to 3.13 on Linux")
    done = ledger() if args.campaign else {}
    asked = []
    for kind in args.kinds or KINDS:
        entries = done.get(kind, [])
        count = args.count or round(_COUNTS.get(kind, _OTHERS) * args.share)
        count -= sum(e.texts for e in entries)
        seed = args.seed + 1000 * len(entries)  # a run that is ended goes on with the next seed
        if count > 0:
            asked.append(Run(kind, count, seed, keep=args.keep, minutes=args.minutes))
    broken = False
    with ThreadPool(args.jobs) as pool:
        for found in pool.imap_unordered(run, asked, 1):
            _tell(found)
            broken |= bool(found.findings)
            if args.campaign:
                enter(found)
    return int(broken)


if __name__ == "__main__":
    sys.exit(main())
