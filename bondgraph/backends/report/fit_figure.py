"""What a fit explains as a figure: a term of each residual, as measured and as predicted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from bondgraph.backends.drawing.style import palette
from bondgraph.backends.report.episode import Array, Episode, Panel, Trace
from bondgraph.backends.report.plots import signals
from bondgraph.text.tuples import NamedTuple


class Compared(NamedTuple):
    """A relation as two sides of it over time, both filtered; `time` (n,) in s, as the log has it.

    `measured` is the term with one parameter, `predicted` what all other terms say that it is; NaN
    where the residual is not valid. What is left between them is the residual.
    """

    residual: str
    parameter: str
    log: str
    time: Array
    measured: Array
    predicted: Array


def figure(title: str, compared: Sequence[Compared]) -> str:
    """The comparisons of one log above each other, as an SVG file of its own."""
    time = np.unique(np.concatenate([one.time for one in compared]))
    panels = []
    for one in compared:
        sides = [("measured", one.measured), ("predicted", one.predicted)]
        sides.append(("left", one.measured - one.predicted))
        traces = tuple(Trace(name, _on(time, one.time, value)) for name, value in sides)
        panels.append(Panel(f"{one.residual}: term of {one.parameter}", "", traces))
    drawn = signals(Episode(title, "", time, (), tuple(panels)), "fit")
    colours = "".join(f"--{name}:{value};" for name, value in palette().items())
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" style="{colours}background:var(--paper);'
        'font-family:sans-serif" '
    )
    return drawn.replace("<svg ", head, 1)


def _on(time: Array, own: Array, value: Array) -> Array:
    """Values at the times of the figure, NaN where there is none."""
    found = np.full(len(time), np.nan)
    found[np.searchsorted(time, own)] = value
    return found
