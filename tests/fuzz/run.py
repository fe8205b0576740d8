"""Looks for models that make `check` fail instead of answering: python -m tests.fuzz.run."""

from __future__ import annotations

import argparse
import json
import resource
import signal
import sys
import time
import traceback
from collections import Counter
from collections.abc import Callable
from multiprocessing import get_context
from pathlib import Path
from typing import NamedTuple

from bondgraph.frontend.read import decode
from bondgraph.passes.elaboration import instantiate as limits
from bondgraph.pipeline import Compilation, Options
from bondgraph.text.diagnostic import CompileError, Report
from bondgraph.text.render import as_json, render
from bondgraph.text.source import Source
from tests.fuzz.mutate import BYTES, ENCODING, ROOT, Mutator, corpus

_SECONDS = 10  # no model of this size may take longer
_MEMORY = 4 << 30


class Finding(NamedTuple):
    """A text that broke the compiler, and how."""

    where: str
    trace: str
    text: str


class Slow(Exception):
    """The compiler did not answer in time."""


def check(text: str) -> str:
    """What `bondgraph check` does with a text; returns the code of the first error, or `sound`.

    Raises what the compiler raises besides `CompileError`, and AssertionError for an answer that
    names no place, gives no remedy or cannot be shown.
    """
    path = str(ROOT / "models" / "fuzz.bg")
    report = Report()
    source = decode(path, text.encode(ENCODING, BYTES), report)
    compilation = Compilation(source or Source(path, ""), options=Options(open_ports=True))
    answer = "sound"
    try:
        report.stop_on_error()
        assert compilation.integral.graph is not None
        diagnostics = tuple(compilation.report.diagnostics)
    except CompileError as error:
        diagnostics = error.diagnostics
        errors = [d for d in diagnostics if d.severity == "error"]
        assert errors, "a failure without an error"
        answer = errors[0].code
    for diagnostic in diagnostics:
        assert diagnostic.message and diagnostic.code, "an empty diagnostic"
        if diagnostic.severity == "error":
            assert diagnostic.labels, f"`{diagnostic.code}` names no place"
            assert diagnostic.help, f"`{diagnostic.code}` gives no remedy"
    render(diagnostics, color=True).encode()
    json.dumps(as_json(diagnostics))
    return answer


def attempt(text: str) -> tuple[str, Finding | None]:
    """Check one text under a time limit."""
    signal.signal(signal.SIGALRM, _too_slow)
    signal.setitimer(signal.ITIMER_REAL, _SECONDS)
    try:
        return check(text), None
    except Exception as error:
        frames = traceback.extract_tb(error.__traceback__)
        ours = [f for f in frames if "bondgraph" in f.filename] or list(frames)
        line = f"{Path(ours[-1].filename).name}:{ours[-1].lineno} in {ours[-1].name}"
        if isinstance(error, RecursionError | Slow | MemoryError):
            line = "deep, long or large"
        # without the part in quotes, which differs from model to model
        words = str(error).split("`")[0][:80]
        trace = "".join(traceback.format_exception(error, limit=-12))
        return "traceback", Finding(f"{type(error).__name__}: {words} ({line})", trace, text)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)


def _too_slow(*_: object) -> None:
    raise Slow(f"no answer within {_SECONDS} s")


def smallest(text: str, fails: Callable[[str], bool]) -> str:
    """Fewer and fewer lines, then characters, as long as the text still fails."""
    for separator in ("\n", ""):
        parts = text.split(separator) if separator else list(text)
        size = len(parts) // 2
        while size:
            at = 0
            while at < len(parts):
                shorter = parts[:at] + parts[at + size :]
                if fails(separator.join(shorter)):
                    parts = shorter
                else:
                    at += size
            size //= 2
        text = separator.join(parts)
    return text


def batch(job: tuple[int, int]) -> tuple[Counter[str], dict[str, Finding], dict[str, int]]:
    """Check `count` texts from one seed: the answers, one finding of each kind, their numbers."""
    seed, size = job
    mutator = Mutator(seed, corpus())
    answers: Counter[str] = Counter()
    findings: dict[str, Finding] = {}
    numbers: Counter[str] = Counter()
    for _ in range(size):
        answer, finding = attempt(mutator.text())
        answers[answer] += 1
        if finding is not None:
            numbers[finding.where] += 1
            old = findings.get(finding.where)
            if old is None or len(finding.text) < len(old.text):
                findings[finding.where] = finding
    return answers, findings, numbers


def main(argv: list[str] | None = None) -> int:
    """Run the fuzzer; the exit status is 1 if a text broke the compiler."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100_000, help="number of texts")
    parser.add_argument("--seed", type=int, default=1, help="another seed, other texts")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--answers", action="store_true", help="how often each code was answered")
    args = parser.parse_args(argv)
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, resource.RLIM_INFINITY))
    limits.PARTS = 60_000  # arrays of submodels may take their time, but not here
    step = 500
    jobs = [
        (args.seed * 1_000_003 + at, min(step, args.count - at))
        for at in range(0, args.count, step)
    ]
    started = time.perf_counter()
    answers: Counter[str] = Counter()
    findings: dict[str, Finding] = {}
    numbers: Counter[str] = Counter()
    with get_context("fork").Pool(args.jobs) as pool:
        for some_answers, some_findings, some_numbers in pool.imap(batch, jobs):
            answers += some_answers
            numbers.update(some_numbers)
            for where, finding in some_findings.items():
                if where not in findings or len(finding.text) < len(findings[where].text):
                    findings[where] = finding
            if sys.stderr.isatty():
                print(f"\r{answers.total()} texts, {answers['traceback']} tracebacks", end="",
                      file=sys.stderr)  # fmt: skip
    for where, finding in sorted(findings.items()):

        def fails(text: str, where: str = where) -> bool:
            again = attempt(text)[1]
            return again is not None and again.where == where

        print(f"\n=== {where}, {numbers[where]} times\n{finding.trace}--- for the model")
        short = finding.text if "deep" in where else smallest(finding.text, fails)
        print(ascii(short) if not short.isascii() else short)
    if args.answers:
        for answer, number in answers.most_common():
            print(f"{number:8} {answer}")
    taken = time.perf_counter() - started
    kinds = len(answers.keys() - {"sound", "traceback"})
    print(
        f"{answers.total()} texts, {answers['sound']} sound models, {kinds} kinds of error, "
        f"{answers['traceback']} tracebacks, {taken:.0f} s"
    )
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
