"""How compile time grows with the model: microseconds a bond from text to signatures."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from bondgraph.compilation import Compilation
from bondgraph.text.source import Source
from tests.bench import families

MODELS = Path(__file__).parents[2] / "models"

STAGES = ("graph", "integral", "equations", "reduced", "signatures")


class Family(NamedTuple):
    """Models of growing size, the sizes of a short run and of a long one."""

    title: str
    text: Callable[[int], str]
    short: tuple[int, ...]
    long: tuple[int, ...]


FAMILIES = (
    Family("Cable, measured at its end", families.cable, (100, 1000), (100, 1000, 3500, 12_500)),
    Family("Chain of RLC cells, ten sensors", families.chain, (20, 200), (20, 200, 2000, 20_000)),
    Family("Tree of motors, each measured", families.tree, (10, 100), (10, 100, 316, 1000)),
    Family("Grid of resistors, two sensors", families.grid, (4, 8), (4, 8, 16, 32)),
)


def stages(text: str) -> tuple[int, dict[str, float]]:
    """The number of bonds of a model, and the seconds that each stage takes."""
    compilation = Compilation(Source(str(MODELS / "growth.bg"), text))
    seconds = {}
    for stage in STAGES:
        start = time.perf_counter()
        getattr(compilation, stage)
        seconds[stage] = time.perf_counter() - start
    return len(compilation.graph.bonds), seconds


def exponent(points: list[tuple[float, float]]) -> float:
    """The p of time = c * size**p that fits best in the logarithms (least squares)."""
    logs = [(math.log(x), math.log(y)) for x, y in points]
    mean_x = sum(x for x, _ in logs) / len(logs)
    mean_y = sum(y for _, y in logs) / len(logs)
    covariance = sum((x - mean_x) * (y - mean_y) for x, y in logs)
    return covariance / sum((x - mean_x) ** 2 for x, _ in logs)


def report(short: bool) -> None:
    """A table for each family: microseconds a bond for each stage and size, and the exponent."""
    stages(families.cable(3))  # imports are no part of the growth
    for family in FAMILIES:
        print(f"{family.title}, microseconds a bond:")
        print(f"{'bonds':>8} " + " ".join(f"{s:>11}" for s in (*STAGES, "all")))
        points = []
        for size in family.short if short else family.long:
            bonds, seconds = stages(family.text(size))
            whole = sum(seconds.values())
            points.append((float(bonds), whole))
            each = [*seconds.values(), whole]
            print(f"{bonds:8} " + " ".join(f"{s / bonds * 1e6:11.1f}" for s in each), flush=True)
        print(f"time grows as bonds ** {exponent(points):.2f}\n")
