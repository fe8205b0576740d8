"""Texts that reach what no text before has reached: python -m tests.fuzz.guided [KIND ...].

Each text is made of one that was kept. It is kept itself if the answer to it is a new one, or, of
a sample of texts whose lines are traced, if it reaches a line of the package that none has reached.
"""

from __future__ import annotations

import argparse
import random
import resource
import signal
import sys
import time
import traceback
from collections.abc import Sequence
from hashlib import sha256
from multiprocessing import get_context
from pathlib import Path
from types import FrameType
from typing import Any, NamedTuple

from tests.fuzz.mutate import ROOT, Mutator, corpus
from tests.fuzz.run import check
from tests.fuzz.targets import KINDS, WORDS, Kind
from tests.measured import write

KEPT = Path(__file__).with_name("corpus")
_SECONDS = 20.0  # that no text may take
_MEMORY = 1 << 30  # bytes that all of them together may add
#: Texts of a whole campaign, by kind; of all others 100 000.
_COUNTS = {"check": 1_000_000, "compile": 10_000}
_TRACED = 40  # one text in so many is traced
_PACKAGE = str(ROOT / "bondgraph")


class Result(NamedTuple):
    """Of one run: how many texts, how many answers and lines they reached, what broke."""

    kind: str
    texts: int
    sound: int  # of these, that nothing was wrong with
    answers: int
    lines: int
    slowest: float  # s
    memory: float  # MB that were added at most
    findings: dict[str, tuple[bytes, str]]
    seconds: float


class Slow(BaseException):
    """No answer in time; nothing that catches exceptions catches it."""


def _too_slow(*_: object) -> None:
    raise Slow


def changed(rng: random.Random, text: bytes, kept: Sequence[bytes], words: Sequence[str]) -> bytes:
    """Another text: words of the kind, bytes, lines and parts of others put in or left out."""
    for _ in range(rng.choice((1, 1, 2, 3, 6))):
        size = len(text)
        a = rng.randrange(size + 1)
        b = min(size, a + rng.choice((0, 1, 1, 2, 4, 16, 100)))
        match rng.randrange(9):
            case 0:
                text = text[:a] + bytes([rng.randrange(256)]) + text[b:]
            case 1:
                text = text[:a] + text[b:]
            case 2:
                word = rng.choice(words).encode("utf-8", "surrogatepass")
                text = text[:a] + word + text[b:]
            case 3:
                text = text[:b] + text[a:b] * rng.choice((1, 2, 50)) + text[b:]
            case 4:
                other = rng.choice(kept)
                c = rng.randrange(len(other) + 1)
                text = text[:a] + other[c : c + rng.choice((4, 20, 200))] + text[b:]
            case 5:
                lines = text.split(b"\n")
                lines.insert(rng.randrange(len(lines)), rng.choice(lines))
                text = b"\n".join(lines)
            case 6:
                lines = text.split(b"\n")
                del lines[rng.randrange(len(lines))]
                text = b"\n".join(lines)
            case 7:
                number = str(rng.choice((0, 1, -1, 2**31, 2**63, 1e308, 1e-320, rng.random())))
                text = text[:a] + number.encode() + text[b:]
            case _:
                text = text[: max(a, 1)]
    return text[:20_000]


class Lines:
    """The lines of the package that a call reaches."""

    def __init__(self) -> None:
        self.seen: set[tuple[str, int]] = set()

    def __call__(self, frame: FrameType, event: str, arg: object) -> Any:
        """See `sys.settrace`."""
        name = frame.f_code.co_filename
        if not name.startswith(_PACKAGE):
            return None
        self.seen.add((name, frame.f_lineno))
        return self


def kept_texts(name: str) -> list[bytes]:
    """The texts of a kind that earlier runs have kept, in order of their names."""
    return [p.read_bytes() for p in sorted((KEPT / name).glob("*"))]


def _kind(name: str) -> Kind:
    if name == "check":
        return Kind(lambda data: check(data.decode("utf-8", "surrogateescape")),
                    lambda: [t.encode() for t in corpus()])  # fmt: skip
    return KINDS[name]


def run(name: str, count: int, seed: int, keep: int = 0) -> Result:
    """Give so many texts to a kind; the newest `keep` that were worth it go into the corpus."""
    kind = _kind(name)
    rng = random.Random(f"{name} {seed}")
    grown = Mutator(seed, corpus()) if name in ("check", "compile") else None
    kept = [*kind.seeds(), *kept_texts(name)]
    known = len(kept)
    fresh: list[bytes] = []
    answers: set[str] = set()
    sound = 0
    lines, findings = Lines(), {}
    slowest, before = 0.0, _resident()
    start = time.perf_counter()
    signal.signal(signal.SIGALRM, _too_slow)
    for k in range(count):
        if k < known:
            text = kept[k]
        elif grown is not None and rng.random() < 0.7:
            text = grown.text().encode("utf-8", "surrogateescape")
        else:
            text = changed(rng, rng.choice(kept), kept, (*kind.words, *WORDS))
        traced, reached = k % _TRACED == 0, len(lines.seen)
        begun = time.perf_counter()
        signal.setitimer(signal.ITIMER_REAL, _SECONDS)
        try:
            if traced:
                sys.settrace(lines)
            answer = kind.read(text)
        except (Exception, Slow) as error:
            sys.settrace(None)
            frames = traceback.extract_tb(error.__traceback__)
            frames = [f for f in frames if _PACKAGE in f.filename] or [frames[-1]]
            place = f"{Path(frames[-1].filename).name}:{frames[-1].name}"
            answer = f"{type(error).__name__} in {place}"
            trace = "".join(traceback.format_exception(error, limit=-8))
            if answer not in findings or len(text) < len(findings[answer][0]):
                findings[answer] = text, trace
        finally:
            sys.settrace(None)
            signal.setitimer(signal.ITIMER_REAL, 0)
        slowest = max(slowest, time.perf_counter() - begun)
        if k >= known and len(text) < 5_000 and (
            answer not in answers or (traced and len(lines.seen) > reached)
        ):
            kept.append(text)
            fresh.append(text)
        answers.add(answer)
        sound += answer.startswith(("sound", "compiled", "samples", "done", "begun"))
    if keep:
        folder = KEPT / name
        folder.mkdir(parents=True, exist_ok=True)
        for text in fresh[-keep:]:
            (folder / sha256(text).hexdigest()[:12]).write_bytes(text)
    taken = time.perf_counter() - start
    return Result(name, count, sound, len(answers), len(lines.seen), slowest, _resident() - before,
                  findings, taken)  # fmt: skip


def _resident() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def told(found: Sequence[Result]) -> str:
    """What was found, for a page of the documentation."""
    rows = ["| kind | texts | sound | answers | lines reached | findings | slowest | memory |",
            "|---|---|---|---|---|---|---|---|"]  # fmt: skip
    rows += [
        f"| {r.kind} | {r.texts:,} | {r.sound:,} | {r.answers:,} | {r.lines:,} | {len(r.findings)}"
        f" | {r.slowest:.2f} s | {r.memory:.0f} MB |"
        for r in found
    ]
    return "\n".join(rows)


def _job(job: tuple[str, int, int, int]) -> Result:
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY * 4, resource.RLIM_INFINITY))
    return run(*job)


def main() -> int:
    """Run some kinds and tell; the exit status is 1 where a text broke one."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help="check, " + ", ".join(KINDS))
    parser.add_argument("--count", type=int, help="of each kind (default: those of a campaign)")
    parser.add_argument("--share", type=float, default=1.0, help="of a campaign")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--write", action="store_true", help="put the table into docs/trust.md")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=int, default=0, help="so many texts for the corpus")
    args = parser.parse_args()
    names = args.kinds or ["check", *KINDS]
    counts = {n: args.count or round(_COUNTS.get(n, 100_000) * args.share) for n in names}
    bad = False
    every = []
    pool = get_context("spawn").Pool(args.jobs)
    for found in pool.imap(_job, [(n, counts[n], args.seed, args.keep) for n in names], 1):
        every.append(found)
        print(f"{found.kind}: {found.texts} texts, {found.sound} sound, {found.answers} answers,"
              f" {found.lines} lines reached, {len(found.findings)} findings, slowest"
              f" {found.slowest:.2f} s, {found.memory:.0f} MB more, {found.seconds:.0f} s",
              flush=True)  # fmt: skip
        for what, (text, trace) in found.findings.items():
            bad = True
            print(f"=== {what}\n{trace}--- for\n{text[:1500]!r}")
    pool.close()
    if args.write:
        command = f"python -m tests.fuzz.guided --share {args.share:g} --write"
        write(ROOT / "docs" / "trust.md", command, told(every))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
