"""What a noun and an import cost: `python -m tests.bench.light`.

Processor time, medians of several: of one definition, and of an interpreter that imports, less that
of a bare one.
"""

from __future__ import annotations

import argparse
import resource
import statistics
import subprocess
import sys
import time
from pathlib import Path

from tests import measured

PAGE = Path(__file__).parents[2] / "docs" / "decisions" / "light-nouns.md"
COMMAND = "python -m tests.bench.light"
_CLASSES = 200
_FIELDS = "\n".join(f"    f{k}: int" for k in range(5))
_ROWS = {
    "`import dataclasses`": "import dataclasses",
    "`import sympy`": "import sympy",
    "`import networkx, scipy.optimize`": "import networkx, scipy.optimize",
}
_FROZEN = "@dataclass(frozen=True, slots=True)\nclass C:"
_TUPLE = "class C(NamedTuple):"
_NOUNS = {
    "one dataclass with five fields": ("from dataclasses import dataclass", _FROZEN),
    "one `typing.NamedTuple`": ("from typing import NamedTuple", _TUPLE),
    "one `bondgraph.text.tuples.NamedTuple`": (
        "from bondgraph.text.tuples import NamedTuple",
        _TUPLE,
    ),
}


def seconds(program: str) -> float:
    """Processor time of an interpreter that runs a program."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, "-c", program], check=True, cwd=measured.ROOT)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def defining(head: str, line: str) -> float:
    """Processor time of the definition of a class, compiled before as imported ones are."""
    code = compile(f"from __future__ import annotations\n{head}\n{line}\n{_FIELDS}", "c", "exec")
    exec(code, {"__name__": __name__})
    start = time.process_time()
    for _ in range(_CLASSES):
        exec(code, {"__name__": __name__})
    return (time.process_time() - start) / _CLASSES


def times(runs: int) -> dict[str, float]:
    """Milliseconds for each row."""
    found = {name: [defining(*noun) for _ in range(runs)] for name, noun in _NOUNS.items()}
    bare = statistics.median(seconds("pass") for _ in range(runs + 1))
    for name, program in _ROWS.items():
        found[name] = [seconds(program) - bare for _ in range(runs + 1)][1:]
    return {name: 1e3 * statistics.median(every) for name, every in found.items()}


def table(found: dict[str, float]) -> str:
    """The page's."""
    rows = [
        f"| {name} | {ms:.2f} |" if ms < 1.0 else f"| {name} | {ms:.0f} |"
        for name, ms in found.items()
    ]
    return "\n".join(["| | ms |", "|---|---:|", *rows])


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=11)
    parser.add_argument("--write", action="store_true", help="put the table into its page")
    options = parser.parse_args()
    text = table(times(options.runs))
    print(text)
    if options.write:
        measured.write(PAGE, COMMAND, text)


if __name__ == "__main__":
    main()
