"""Keeps what the compiler answers to a corpus, and compares two such records.

    python -m tests.answers record before.jsonl      # in the older tree
    python -m tests.answers record after.jsonl       # in the newer one
    python -m tests.answers compare before.jsonl after.jsonl

The corpus: every model file of the repository, 2 000 random graphs and 400 random real plants. A
record holds the JSON of each compilation, the operations of one step and the highest derivative.
"""

from __future__ import annotations

import argparse
import json
import signal
import sys
from collections import Counter
from collections.abc import Iterator
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from bondgraph.cli.result import result
from bondgraph.compilation import Compilation
from bondgraph.text.diagnostic import CompileError
from bondgraph.text.source import Source
from tests.random.run import of_seed as graph_of
from tests.real.draw import of_seed as plant_of

_ROOT = Path(__file__).parents[1]
_SECONDS = 60.0  # of processor time a model


def _slow(*_: object) -> None:
    raise TimeoutError


def corpus(graphs: int, plants: int) -> Iterator[tuple[str, int]]:
    """What is compiled: files by their path, random models by their number."""
    for folder in ("models", "tests", "docs"):
        for path in sorted((_ROOT / folder).rglob("*.bg")):
            yield str(path.relative_to(_ROOT)), -1
    yield from (("graph", seed) for seed in range(graphs))
    yield from (("plant", seed) for seed in range(plants))


def answered(job: tuple[str, int]) -> tuple[str, dict[str, Any]]:
    """The name of one model and what is answered to it."""
    what, seed = job
    name = what if seed < 0 else f"{what} {seed}"
    signal.signal(signal.SIGPROF, _slow)
    signal.setitimer(signal.ITIMER_PROF, _SECONDS)
    try:
        return name, _answer(what, seed)
    except TimeoutError:
        return name, {"status": "time-out"}
    except Exception as error:
        return name, {"status": f"{type(error).__name__}: {error}"}
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


def _answer(what: str, seed: int) -> dict[str, Any]:
    if seed < 0:
        text = (_ROOT / what).read_text(encoding="utf-8")
        source = Source(what, text)
    else:
        text = graph_of(seed).text if what == "graph" else plant_of(seed).text
        source = Source("random.bg", text)
    compilation = Compilation(source)
    try:
        found = result(compilation, [])
        found["verified"] = compilation.verification.method
        found["operations"] = len(compilation.program.step) if found["n_arr"] else 0
    except CompileError as error:
        codes = sorted({d.code for d in error.diagnostics if d.severity == "error"})
        return {"status": f"refused: {', '.join(codes)}"}
    orders = compilation.signatures.orders
    found["order"] = max((k for row in orders for k in row.values()), default=0)
    plain: dict[str, Any] = json.loads(json.dumps(found))  # as it is read back from a record
    return plain


def compare(before: Path, after: Path) -> int:
    """Print each difference; 1 if there is any."""
    old, new = ({r[0]: r[1] for r in map(json.loads, p.open())} for p in (before, after))
    kinds: Counter[str] = Counter()
    for name in [n for n in old if n in new]:
        words = list(_differences(old[name], new[name]))
        kinds["the same" if not words else "different"] += 1
        if words:
            print(f"{name}: {'; '.join(words)}")
    missing = [n for n in old if n not in new] + [n for n in new if n not in old]
    kinds["in one record only"] += len(missing)
    print(", ".join(f"{count} {kind}" for kind, count in kinds.items() if count))
    return int(set(kinds) != {"the same"})


def _differences(a: dict[str, Any], b: dict[str, Any]) -> Iterator[str]:
    for key in ("status", "n_arr", "order", "operations", "verified"):
        if a.get(key) != b.get(key):
            yield f"{key} {a.get(key)} -> {b.get(key)}"
    lost = [m["about"] for m in a.get("missing", [])], [m["about"] for m in b.get("missing", [])]
    if lost[0] != lost[1]:
        yield f"missing {lost[0]} -> {lost[1]}"
    forms = [[r["expr"] for r in x.get("arrs", [])] for x in (a, b)]
    if forms[0] != forms[1]:
        changed = sum(x != y for x, y in zip(*forms, strict=False))
        yield f"{changed} of {len(forms[0])} closed forms"
    for key in ("undetectable", "weak", "groups", "best", "modes", "diagnostics"):
        if a.get(key) != b.get(key):
            yield key


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__)
    commands = parser.add_subparsers(required=True, dest="command")
    recording = commands.add_parser("record")
    recording.add_argument("file", type=Path)
    recording.add_argument("--graphs", type=int, default=2000)
    recording.add_argument("--plants", type=int, default=400)
    recording.add_argument("--jobs", type=int, default=2)
    recording.add_argument("--only", type=Path, help="JSON of [name, number] pairs")
    comparing = commands.add_parser("compare")
    comparing.add_argument("before", type=Path)
    comparing.add_argument("after", type=Path)
    asked = parser.parse_args()
    if asked.command == "compare":
        return compare(asked.before, asked.after)
    jobs = [*corpus(asked.graphs, asked.plants)]
    if asked.only is not None:
        jobs = [(name, seed) for name, seed in json.loads(asked.only.read_text())]
    with asked.file.open("w") as file, get_context("spawn").Pool(asked.jobs) as pool:
        for answer in pool.imap(answered, jobs, chunksize=8):
            file.write(json.dumps(answer) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
