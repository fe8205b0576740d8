"""Texts that reach what no text before has reached: python -m tests.fuzz.guided [KIND ...].

Each kind is driven by libFuzzer (by way of atheris) in a process of its own, `one_kind`: a text
is made of one that was kept, and is kept itself if it passes a branch of the package that none had
passed, or one more often. A process that libFuzzer had to end is begun again with what was kept.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
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
from tests.measured import write

KEPT = Path(__file__).with_name("corpus")
_BROKE = ROOT / "build" / "fuzz"  # where the texts of findings go
_SECONDS = 20  # that no text may take
_MEMORY = 1024  # MB that all of them together may add
_ENDS = 10  # processes of a kind that libFuzzer had to end, then it is enough
#: Texts of a whole campaign, by kind; of all others 100 000.
_COUNTS = {"check": 1_000_000, "compile": 10_000}
_CORPUS = 40_000  # bytes that are kept of a kind


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
    within so many MB more; whether the corpus is to be made anew from what was found."""

    kind: str
    count: int
    seed: int = 1
    module: str = "tests.fuzz.targets"
    seconds: int = _SECONDS
    memory: int = _MEMORY
    keep: bool = False


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
            status, said = _process(asked, folder, options)
            branches = max([branches, *(int(n) for n in re.findall(r" cov: (\d+) ", said))])
            if counts.read()[0] < asked.count:
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


def table(found: Sequence[Result]) -> str:
    """What was found, for a page of the documentation."""
    rows = ["| kind | texts | sound | answers | branches | findings | slowest | memory |",
            "|---|---|---|---|---|---|---|---|"]  # fmt: skip
    rows += [
        f"| {r.kind} | {r.texts:,} | {r.sound:,} | {r.answers:,} | {r.branches:,}"
        f" | {len(r.findings)} | {r.slowest:.2f} s | {r.memory:.0f} MB |"
        for r in found
    ]
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
    parser.add_argument("--write", action="store_true", help="put the table into docs/trust.md")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", action="store_true", help="make the corpus anew from all of it")
    args = parser.parse_args()
    if find_spec("atheris") is None:
        parser.error("atheris is not installed: it has wheels for Python 3.11 to 3.13 on Linux")
    asked = [
        Run(n, args.count or round(_COUNTS.get(n, 100_000) * args.share), args.seed, keep=args.keep)
        for n in args.kinds or KINDS
    ]
    every = []
    with ThreadPool(args.jobs) as pool:
        for found in pool.imap(run, asked, 1):
            every.append(found)
            _tell(found)
    if args.write:
        command = f"python -m tests.fuzz.guided --share {args.share:g} --write"
        write(ROOT / "docs" / "trust.md", command, table(every))
    return 1 if any(r.findings for r in every) else 0


if __name__ == "__main__":
    sys.exit(main())
