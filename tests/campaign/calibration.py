"""How often what was said with a probability was right: a table, an error, a diagram."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.text.tuples import NamedTuple

_EDGES = (0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 0.99, 1.0 + 1e-9)


class Stated(NamedTuple):
    """That a class of faults is the cause: with which probability, and whether it was."""

    probability: float
    right: bool


def stated(verdict: Verdict, groups: Sequence[Sequence[str]], cause: str) -> list[Stated]:
    """What a verdict says of each class that holds one of its candidates."""
    chance = {c.fault: c.probability for c in verdict.candidates}
    found = []
    for group in groups:
        own = sum(chance.get(fault, 0.0) for fault in group)
        if own > 0.0:
            found.append(Stated(own, cause in group))
    return found


class Bin(NamedTuple):
    """Statements between two probabilities: how many, their mean, the share that was right."""

    low: float
    high: float
    number: int
    mean: float
    right: float


def bins(said: Sequence[Stated]) -> list[Bin]:
    """The statements by probability, without bins that are empty."""
    found = []
    for low, high in pairwise(_EDGES):
        own = [one for one in said if low <= one.probability < high]
        if own:
            mean = sum(one.probability for one in own) / len(own)
            right = sum(one.right for one in own) / len(own)
            found.append(Bin(low, min(high, 1.0), len(own), mean, right))
    return found


def error(said: Sequence[Stated]) -> float:
    """The expected calibration error: by how much bins are off, each by what it holds.

    >>> error([Stated(0.8, True)] * 3 + [Stated(0.8, False)])
    0.05
    """
    off = sum(one.number * abs(one.mean - one.right) for one in bins(said))
    return round(off / max(len(said), 1), 4)


def table(said: Sequence[Stated]) -> list[str]:
    """The lines of a table, with the error below."""
    lines = ["| probability of a class | statements | mean | right |", "|---|---|---|---|"]
    lines += [f"| {one.low:g} to {one.high:g} | {one.number} | {one.mean:.3f} | {one.right:.3f} |"
              for one in bins(said)]  # fmt: skip
    sure = [one for one in said if one.probability > 0.9]
    wrong = sum(not one.right for one in sure)
    return [*lines, "", f"Expected calibration error {error(said):.3f};"
            f" of {len(sure)} statements above 0.9, {wrong} were wrong."]  # fmt: skip


def draw(said: Sequence[Stated], path: Path) -> None:
    """A reliability diagram: the share that was right over the stated probability.

    With Wilson's interval (1927) of 95 % for each bin.
    """
    from matplotlib.figure import Figure

    own = bins(said)
    count, mean, right = (np.array([one[j] for one in own], dtype=float) for j in (2, 3, 4))
    square = 1.96**2 / count
    middle = (right + square / 2) / (1 + square)
    wide = np.sqrt(square * (right * (1 - right) + square / 4)) / (1 + square)
    chart = Figure(figsize=(4.6, 4.4), layout="constrained")
    axis = chart.add_subplot()
    axis.plot([0, 1], [0, 1], color="0.7", linewidth=0.8)
    axis.vlines(mean, middle - wide, middle + wide, color="C0", linewidth=1)
    axis.plot(mean, right, "o-", color="C0", markersize=4, linewidth=1)
    for k, (x, y, n) in enumerate(zip(mean, right, count, strict=True)):
        beside = (5, -11) if k % 2 == 0 else (-18, 6)
        axis.annotate(f"{n:.0f}", (x, y), beside, textcoords="offset points", fontsize=8)
    axis.set(xlim=(0, 1.02), ylim=(0, 1.02), xlabel="probability that was said",
             ylabel="share that was right")  # fmt: skip
    axis.spines[["top", "right"]].set_visible(False)
    chart.savefig(path, metadata={"Date": None})
