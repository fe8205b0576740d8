"""How compile time grows with the model: ladders of cable, from text to signatures."""

from __future__ import annotations

import time
from pathlib import Path

from bondgraph.pipeline import Compilation
from bondgraph.text.source import Source

MODELS = Path(__file__).parents[2] / "models"

LADDER = """bg 1
import Cable from "khepera.bg"
model Ladder {{
    Se:Uin -> Cable:line(n = {cells}) -> 0:out
    out {{ -> C:Cs = line.C; -> De:Us }}
}}
"""


def stages(cells: int) -> tuple[int, dict[str, float]]:
    """The number of bonds, and the seconds that each stage takes for a ladder of `cells`."""
    source = Source(str(MODELS / "ladder.bg"), LADDER.format(cells=cells))
    compilation = Compilation(source)
    seconds = {}
    for stage in ("graph", "integral", "equations", "reduced", "signatures"):
        start = time.perf_counter()
        getattr(compilation, stage)
        seconds[stage] = time.perf_counter() - start
    return len(compilation.graph.bonds), seconds


def report(sizes: tuple[int, ...]) -> None:
    """A table of microseconds a bond for each stage and size."""
    print("Ladders of cable, microseconds a bond:")
    head = None
    for cells in sizes:
        bonds, seconds = stages(cells)
        if head is None:
            head = list(seconds)
            print(f"{'bonds':>8} " + " ".join(f"{h:>11}" for h in [*head, "all"]))
        each = [*seconds.values(), sum(seconds.values())]
        print(f"{bonds:8} " + " ".join(f"{s / bonds * 1e6:11.1f}" for s in each))
