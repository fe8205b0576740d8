"""How many residuals SymPy derives from the equations, and why it stops at the others.

    python -m tests.derivations [--write]

With `--write` the table goes into `docs/derivations.md`.
"""

from __future__ import annotations

import signal
import sys
from collections import Counter
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from types import FrameType

import bondgraph
from bondgraph import CompileError
from tests.measured import ROOT, write

PAGE = ROOT / "docs" / "derivations.md"
FOLDERS = ("models", "tests/cases", "tests/case_studies", "tests/adversary/models")
PATIENCE = 120  # s, for one residual


class Slow(BaseException):
    """A derivation has taken too long; no `except Exception` on the way takes it."""


def outcomes(paths: Iterable[Path]) -> Counter[str]:
    """How many residuals of some models are derived ("") or not, by reason."""
    found: Counter[str] = Counter()
    for path in paths:
        with suppress(CompileError):
            c = bondgraph.compile(path)
            for relation in c.residuals:
                found[outcome(c, relation.name)] += 1
    return found


def outcome(c: bondgraph.Compilation, name: str) -> str:
    """"" where a residual is derived, else why not."""

    def late(number: int, frame: FrameType | None) -> None:
        raise Slow

    signal.signal(signal.SIGALRM, late)
    signal.alarm(PATIENCE)
    try:
        stopped = [d.stopped for d in c.derivation(name) if d.stopped]
    except Slow:
        return f"it takes longer than {PATIENCE} s"
    finally:
        signal.alarm(0)
    return stopped[0].rpartition(": ")[2] if stopped else ""


def table() -> str:
    """Markdown: a row for each folder of models."""
    lines = ["| models | residuals | derived | not shown to the end, because |",
             "|---|---|---|---|"]  # fmt: skip
    for folder in FOLDERS:
        found = outcomes(sorted((ROOT / folder).glob("**/*.bg")))
        whole = found.pop("", 0)
        why = "; ".join(f"{reason} ({n})" for reason, n in sorted(found.items()))
        lines.append(f"| `{folder}` | {whole + found.total()} | {whole} | {why} |")
    return "\n".join(lines)


if __name__ == "__main__":
    text = table()
    print(text)
    if "--write" in sys.argv:
        write(PAGE, "python -m tests.derivations --write", text)
